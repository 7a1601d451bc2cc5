/* SPDX-License-Identifier: MIT */
/* maintain: one track alone, from the first plot on, never dropped. */
#include <cjson/cJSON.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "commands.h"
#include "io/output/tracks_output.h"
#include "io/scans/frame_reader.h"
#include "io/scans/scan_reader.h"
#include "pipeline/maintainer.h"
#include "rhotrack/measurement.h"
#include "rhotrack/track.h"

struct maintaining {
    struct maintainer *maintainer;
    enum maintainer_gate gate;
    const struct parameters *parameters;
    struct random random; /* for the gate none */
    bool is_started;
    struct rho_track_report track; /* the newest row */
    uint64_t fates[RHO_NUM_FATES];
    uint64_t scans; /* that were stepped */
    int64_t sum_us, max_us;
};

/* ---- What was asked for ---- */

/* --gate, else the parameter. */
static enum maintainer_gate gate_of(struct command_line *line)
{
    if (line->gate) {
        parameters_set_gate(&line->parameters, line->gate);
    }
    return (enum maintainer_gate)line->parameters.value[PARAMETER_GATE];
}

static void check_velocity(const struct maintaining *maintaining, const struct rho_scan *scan)
{
    const double *value = maintaining->parameters->value;

    if (maintaining->gate != MAINTAIN_HOUGH || scan->num_plots == 0) {
        return;
    }
    if (!(scan->measures & RHO_MEASURES_VELOCITY)) {
        fail(EXIT_USAGE,
             "--gate hough looks at velocities, and the scan at %.6f s has none: columns 'vx_mps' "
             "and 'vy_mps' are wanted",
             (double)scan->time_us * 1e-6);
    }
    if (!(scan->measures & RHO_MEASURES_Z) && !((unsigned)value[PARAMETER_PLANES] & 1u)) {
        fail(EXIT_USAGE,
             "--gate hough: the scan at %.6f s has no heights, so that planes must hold xy",
             (double)scan->time_us * 1e-6);
    }
}

static void warn_unused(const struct command_line *line, enum maintainer_gate gate)
{
    if (gate == MAINTAIN_BEST && line->no_input_estimation) {
        fputs("rhotrack: --no-input-estimation says nothing to --gate best\n", stderr);
    }
}

/* A literal input moves no place: where nothing else is measured it is never seen. */
static void warn_blind(const struct command_line *line, enum maintainer_gate gate,
                       const struct rho_scan *first)
{
    if (gate != MAINTAIN_BEST && !line->no_input_estimation &&
        !(first->measures & (RHO_MEASURES_VELOCITY | RHO_MEASURES_RANGE_RATE)) &&
        line->parameters.value[PARAMETER_INPUT_MODEL] <= 0.0) {
        fputs("rhotrack: places alone do not show the inputs of input_model literal; "
              "--set input_model=physical does\n",
              stderr);
    }
}

/* ---- Steps ---- */

static void count_fates(struct maintaining *maintaining, const struct rho_scan *scan, int row)
{
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        bool is_valid = rho_measurement_is_valid(&scan->plots[i], scan->measures);
        enum rho_fate fate = (int64_t)i == row ? RHO_FATE_CLAIMED
                             : !is_valid       ? RHO_FATE_INVALID
                             : i > MAINTAINER_ROW_MAX && maintaining->gate == MAINTAIN_BEST
                                 ? RHO_FATE_NO_ROOM
                                 : RHO_FATE_HELD;

        maintaining->fates[fate]++;
    }
}

static void count_look(struct rho_track_report *track, const struct rho_scan *scan, int row)
{
    uint16_t *count = row >= 0 ? &track->hits : &track->misses;

    *count = (uint16_t)(*count + (*count < UINT16_MAX));
    track->status = row >= 0 ? RHO_TRACK_CONFIRMED : RHO_TRACK_COASTING;
    if (row >= 0) {
        track->sensor_id = scan->sensor_id;
    }
}

/* A scan that did not look where the track is says nothing of it. */
static bool looks(const struct maintaining *maintaining, const struct rho_scan *scan,
                  const struct rho_sensor *sensor)
{
    double place_m[3];

    maintainer_where(maintaining->maintainer, place_m);
    return rho_measurement_covers(sensor, scan->sector_from_rad, scan->sector_to_rad,
                                  (float)place_m[0], (float)place_m[1]);
}

static double pd_of(const struct maintaining *maintaining, const struct rho_sensor *sensor)
{
    return sensor ? (double)sensor->pd : maintaining->parameters->value[PARAMETER_PD];
}

static int update(struct maintaining *maintaining, const struct rho_scan *scan,
                  const struct rho_sensor *sensor)
{
    int row = -1;

    maintainer_predict(maintaining->maintainer, scan->time_us);
    if (looks(maintaining, scan, sensor)) {
        row = maintainer_update(maintaining->maintainer, scan, sensor, NAN,
                                pd_of(maintaining, sensor), &maintaining->random);
        count_look(&maintaining->track, scan, row);
    }
    return row;
}

/* No track starts while no scan has a plot. */
static void step(struct maintaining *maintaining, const struct rho_scan *scan,
                 const struct rho_sensor *sensor)
{
    int64_t start_us = clock_us(), took_us;
    int row = -1;

    if (maintaining->is_started) {
        row = update(maintaining, scan, sensor);
    } else if (scan->num_plots > 0) {
        row = 0;
        maintaining->is_started = true;
        maintainer_start(maintaining->maintainer, scan->time_us, &scan->plots[0], scan->measures,
                         sensor);
        count_look(&maintaining->track, scan, row);
    }
    took_us = clock_us() - start_us;
    maintaining->scans++;
    maintaining->sum_us += took_us;
    maintaining->max_us = took_us > maintaining->max_us ? took_us : maintaining->max_us;
    maintaining->track.plot = row;
    count_fates(maintaining, scan, row);
}

static void fill_row(struct maintaining *maintaining)
{
    struct rho_track_report *track = &maintaining->track;
    struct rho_track sigmas = {.track_id = 1};
    struct maintainer_estimate estimate;

    maintainer_estimate(maintaining->maintainer, &estimate);
    memcpy(track->state, estimate.kalman.state, sizeof track->state);
    memcpy(track->covariance, estimate.kalman.covariance, sizeof track->covariance);
    memcpy(track->accel_mps2, estimate.accel_mps2, sizeof track->accel_mps2);
    sigmas.kalman = estimate.kalman;
    track->sigma_m = rho_track_sigma_m(&sigmas);
    track->sigma_mps = rho_track_sigma_mps(&sigmas);
}

static void step_all(struct maintaining *maintaining, struct scan_reader *reader,
                     const struct command_line *line, struct tracks_output *tracks)
{
    struct progress progress = progress_start("scans", 0);
    uint64_t bytes = file_bytes(line->arguments[0]);
    const struct rho_scan *scan;

    while ((scan = scan_reader_next(reader))) {
        bool was_started = maintaining->is_started;

        check_velocity(maintaining, scan);
        step(maintaining, scan, scan_reader_sensor(reader));
        if (maintaining->is_started && !was_started) {
            warn_blind(line, maintaining->gate, scan);
        }
        if (maintaining->is_started && tracks) {
            fill_row(maintaining);
            tracks_output_track(tracks, scan->time_us, &maintaining->track);
        }
        progress_show_bytes(&progress, maintaining->scans, scan_reader_position(reader), bytes);
    }
    progress_end(&progress);
}

/* ---- What it comes to ---- */

static double mean_us(const struct maintaining *maintaining)
{
    return (double)maintaining->sum_us / (double)maintaining->scans;
}

static void print_summary(const struct maintaining *maintaining,
                          const struct scan_reader_counts *counts)
{
    fprintf(stderr,
            "rhotrack: %" PRIu64 " scans, %" PRIu64 " plots: %u claimed, %u misses, %lu updates "
            "refused",
            maintaining->scans, counts->plots, (unsigned)maintaining->track.hits,
            (unsigned)maintaining->track.misses, maintainer_refused(maintaining->maintainer));
    if (counts->rows_skipped) {
        fprintf(stderr, ", %" PRIu64 " bad rows skipped", counts->rows_skipped);
    }
    fprintf(stderr, "; %.0f us a scan, %" PRId64 " at most\n", mean_us(maintaining),
            maintaining->max_us);
}

static cJSON *fates_json(const struct maintaining *maintaining)
{
    cJSON *object = cJSON_CreateObject();

    for (int i = 0; i < RHO_NUM_FATES; i++) {
        cJSON_AddNumberToObject(object, rho_fate_name((enum rho_fate)i),
                                (double)maintaining->fates[i]);
    }
    return object;
}

static void print_json(const struct maintaining *maintaining, const struct command_line *line,
                       const struct scan_reader_counts *counts)
{
    struct parameter_text gate = parameters_text(PARAMETER_GATE);
    char word[PARAMETER_VALUE_BYTES];
    cJSON *object = cJSON_CreateObject();

    cJSON_AddStringToObject(object, "gate", parameters_value_text(&gate, maintaining->gate, word));
    cJSON_AddBoolToObject(object, "input_estimation",
                          maintaining->gate != MAINTAIN_BEST && !line->no_input_estimation);
    cJSON_AddNumberToObject(object, "scans", (double)maintaining->scans);
    cJSON_AddNumberToObject(object, "plots", (double)counts->plots);
    cJSON_AddNumberToObject(object, "rows_skipped", (double)counts->rows_skipped);
    cJSON_AddNumberToObject(object, "tracks_confirmed", 1);
    cJSON_AddNumberToObject(object, "misses", maintaining->track.misses);
    cJSON_AddItemToObject(object, "fates", fates_json(maintaining));
    cJSON_AddNumberToObject(object, "mean_us", mean_us(maintaining));
    cJSON_AddNumberToObject(object, "max_us", (double)maintaining->max_us);
    cJSON_AddNumberToObject(object, "state_bytes",
                            (double)maintainer_state_bytes(maintaining->maintainer));
    cJSON_AddNumberToObject(object, "updates_refused",
                            (double)maintainer_refused(maintaining->maintainer));
    json_print(object);
}

static struct scan_reader *open_reader(const struct command_line *line)
{
    if (frame_reader_is_bearings(line->arguments[0])) {
        fail(EXIT_USAGE, "%s: maintain takes plots, and these are bearings", line->arguments[0]);
    }
    return scan_reader_open(line->arguments, 1, &line->parameters, line->keep_going);
}

int command_maintain(struct command_line *line)
{
    bool has_file = line->output || !line->json;
    struct maintaining maintaining = {.gate = gate_of(line),
                                      .parameters = &line->parameters,
                                      .random = random_start(line->seed, 0, 0),
                                      .track = {.track_id = 1}};
    struct scan_reader *reader;
    struct scan_reader_counts counts;
    struct tracks_output *tracks;

    warn_unused(line, maintaining.gate);
    maintaining.maintainer =
        maintainer_new(maintaining.gate, !line->no_input_estimation, &line->parameters);
    reader = open_reader(line);
    tracks =
        has_file ? tracks_output_open(line->output, &line->parameters, line->covariance) : NULL;
    step_all(&maintaining, reader, line, tracks);
    counts = scan_reader_counts(reader);
    if (counts.plots == 0) {
        fail(EXIT_USAGE, "%s: not one plot to start the track from", line->arguments[0]);
    }
    tracks_output_close(tracks);
    print_summary(&maintaining, &counts);
    if (line->json) {
        print_json(&maintaining, line, &counts);
    }
    scan_reader_close(reader);
    maintainer_free(maintaining.maintainer);
    return 0;
}
