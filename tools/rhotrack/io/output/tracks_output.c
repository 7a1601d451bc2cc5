/* SPDX-License-Identifier: MIT */
#include "io/output/tracks_output.h"

#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/asterix/asterix_track_writer.h"
#include "io/csv/tracks_writer.h"
#include "io/log/lcm_log.h"
#include "io/output/geojson_tracks_writer.h"
#include "pipeline/pipeline.h"
#include "rhotrack/publish.h"

#define EPOCH 1 /* a file is the output of one tracker, started once */

struct tracks_output {
    struct output output;
    const char *path;
    bool is_log, has_header;
    struct tracks_columns columns;
    struct lcm_log_writer log;
    struct asterix_track_writer *asterix; /* NULL: the output is not ASTERIX */
    int32_t step;
    struct rho_report *single; /* report of a step with a single track, allocated when needed */
    struct geojson *map;       /* GeoJSON writer; NULL: the output is not GeoJSON */
};

bool tracks_output_path_is_log(const char *path)
{
    return path && path_ends_with(path, ".lcm");
}

static struct tracks_output *make_tracks_output(const char *path, struct output output,
                                                const struct parameters *parameters,
                                                bool with_covariance)
{
    struct tracks_output *tracks = must_calloc(1, sizeof *tracks);

    tracks->path = path;
    tracks->is_log = tracks_output_path_is_log(path);
    tracks->columns.covariance = with_covariance;
    tracks->output = output;
    tracks->log = (struct lcm_log_writer){.file = tracks->output.file};
    if (asterix_track_writer_is_path(path)) {
        tracks->asterix = asterix_track_writer_open(output.file, parameters);
    }
    return tracks;
}

struct tracks_output *tracks_output_open(const char *path, const struct parameters *parameters,
                                         bool with_covariance)
{
    struct tracks_output *tracks;

    if (geojson_path_is_geojson(path) && with_covariance) {
        fail(EXIT_USAGE, "%s: GeoJSON cannot hold covariances (--covariance)", path);
    }
    asterix_track_writer_check(path, with_covariance);
    output_refuse_other_format(path, "NAME.csv, NAME.lcm, NAME.geojson and NAME.ast");
    tracks = make_tracks_output(path, output_open(path), parameters, with_covariance);
    tracks->map =
        geojson_path_is_geojson(path) ? geojson_open(tracks->output.file, parameters) : NULL;
    return tracks;
}

struct tracks_output *tracks_output_open_in_place(const char *path,
                                                  const struct parameters *parameters,
                                                  bool with_covariance)
{
    if (geojson_path_is_geojson(path)) {
        fail(EXIT_USAGE,
             "%s: GeoJSON is complete only at the end and cannot be written in place; write a CSV "
             "file and `convert` it",
             path);
    }
    asterix_track_writer_check(path, with_covariance);
    return make_tracks_output(path, output_open_in_place(path), parameters, with_covariance);
}

void tracks_output_add_body_columns(struct tracks_output *tracks, const struct rho_tracker *tracker)
{
    tracks->columns.bodies = tracker;
}

/*
 * Writes the CSV header before the first row, so that an error before leaves no header on standard
 * output.
 */
static void write_header_once(struct tracks_output *tracks)
{
    if (!tracks->is_log && !tracks->map && !tracks->asterix && !tracks->has_header) {
        tracks->has_header = true;
        tracks_write_header(tracks->output.file, tracks->columns);
    }
}

void tracks_output_flush(struct tracks_output *tracks)
{
    write_header_once(tracks);
    output_flush(&tracks->output);
}

/* Writes a track list to the log or as ASTERIX. */
static void write_list_message(struct tracks_output *tracks, int64_t time_us, const uint8_t *data,
                               size_t size)
{
    struct rho_message_track_list message;

    if (tracks->is_log) {
        lcm_log_must_write(&tracks->log, tracks->path, time_us, RHO_MESSAGE_TRACK_LIST_CHANNEL,
                           data, size);
    } else {
        must_succeed(rho_message_track_list_decode(data, size, &message), "track_list");
        asterix_track_writer_add(tracks->asterix, &message);
    }
}

static void write_track_list(struct tracks_output *tracks, const struct rho_report *report)
{
    uint8_t buffer[RHO_MESSAGE_TRACK_LIST_MAX_SIZE];
    size_t size;

    tracks->step++;
    for (uint16_t part = 0; part < rho_publish_num_parts(report); part++) {
        must_succeed(
            rho_publish_tracks(report, tracks->step, EPOCH, part, buffer, sizeof buffer, &size),
            "publish");
        write_list_message(tracks, report->time_us, buffer, size);
    }
}

/* Writes the bodies of a step's tracks, to an LCM log alone. */
static void write_bodies(struct tracks_output *tracks, const struct rho_report *report)
{
    const struct rho_tracker *tracker = tracks->columns.bodies;
    uint8_t buffer[RHO_MESSAGE_BODY_LIST_MAX_SIZE];
    size_t size;

    for (uint16_t part = 0; part < rho_publish_num_body_parts(tracker, report); part++) {
        must_succeed(rho_publish_bodies(tracker, report, tracks->step, EPOCH, part, buffer,
                                        sizeof buffer, &size),
                     "publish");
        lcm_log_must_write(&tracks->log, tracks->path, report->time_us,
                           RHO_MESSAGE_BODY_LIST_CHANNEL, buffer, size);
    }
}

static void add_track_to_geojson(struct geojson *map, int64_t time_us,
                                 const struct rho_track_report *track)
{
    struct geojson_row row = {.time_us = time_us,
                              .track_id = (int32_t)track->track_id,
                              .status = rho_track_status_name(track->status),
                              .sigma_m = track->sigma_m,
                              .hits = track->hits,
                              .misses = track->misses};

    memcpy(row.state, track->state, sizeof row.state);
    geojson_add_row(map, &row);
}

void tracks_output_write_report(struct tracks_output *tracks, const struct rho_report *report)
{
    if (tracks->map) {
        /* tracks that are not in the report have ended */
        for (int i = 0; i < report->num_tracks; i++) {
            add_track_to_geojson(tracks->map, report->time_us, &report->tracks[i]);
        }
        geojson_end_time(tracks->map);
    } else if (tracks->is_log || tracks->asterix) {
        write_track_list(tracks, report);
        if (tracks->is_log) {
            write_bodies(tracks, report);
        }
    } else {
        write_header_once(tracks);
        tracks_write_report(tracks->output.file, report, tracks->columns);
    }
}

int32_t tracks_output_step_number(const struct tracks_output *tracks)
{
    return tracks->step;
}

int32_t tracks_output_epoch(void)
{
    return EPOCH;
}

void tracks_output_log_message(struct tracks_output *tracks, int64_t time_us, const char *channel,
                               const uint8_t *data, size_t size)
{
    lcm_log_must_write(&tracks->log, tracks->path, time_us, channel, data, size);
}

void tracks_output_write_track(struct tracks_output *tracks, int64_t time_us,
                               const struct rho_track_report *track)
{
    if (tracks->map) {
        add_track_to_geojson(tracks->map, time_us, track);
        return;
    }
    if (!tracks->is_log && !tracks->asterix) {
        write_header_once(tracks);
        tracks_write_row(tracks->output.file, time_us, track, 0, tracks->columns);
        return;
    }
    if (!tracks->single) {
        tracks->single = must_calloc(1, sizeof *tracks->single);
    }
    tracks->single->time_us = time_us;
    tracks->single->num_tracks = 1;
    tracks->single->tracks[0] = *track;
    write_track_list(tracks, tracks->single);
}

void tracks_output_close(struct tracks_output *tracks)
{
    if (tracks) {
        write_header_once(tracks);
        if (tracks->map) {
            geojson_end_and_free(tracks->map);
        }
        output_close(&tracks->output);
        asterix_track_writer_free(tracks->asterix);
        free(tracks->single);
        free(tracks);
    }
}
