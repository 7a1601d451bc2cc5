/* SPDX-License-Identifier: MIT */
#include "io/scans/bearing_reader.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/common.h"
#include "io/asterix/asterix_file.h"
#include "io/csv/measurement_row.h"
#include "io/log/lcm_log.h"
#include "io/log/log_scans.h"
#include "io/scans/merged_scan_files.h"

/* The scans of one time, to find duplicates: their sensors, files and lines. */
struct scans_of_time {
    int64_t time_us;
    size_t count;
    struct {
        int32_t sensor_id;
        const char *path;
        uint32_t line;
    } list[RHO_MAX_SENSORS];
};

struct bearing_reader {
    bool keep_going;
    int64_t tolerance_us;
    struct merged_scan_files files;
    struct passive_sensors known;
    /* the sensors of `known` in the order of sensor_id */
    struct frame_sensor sensors[RHO_MAX_SENSORS];
    struct scans_of_time before;
    struct rho_frame frame; /* the frame handed out, with its scans */
    struct rho_bearing_scan scans[RHO_MAX_SENSORS];
    struct sensor_scan next; /* first scan after the frame */
    bool has_next;
    uint64_t skip; /* number of frames left out at the beginning */
    uint64_t duplicates_skipped;
    struct bearing_reader_counts counts; /* counts of this pass through the files */
    struct bearing_reader_counts total;
};

bool bearing_reader_is_bearings(const char *path)
{
    struct stat status;
    struct table *table;
    bool is_bearings;

    if (lcm_log_is_log(path)) {
        return log_scans_kinds(path) == LOG_HAS_BEARINGS;
    }
    if (asterix_file_is_asterix(path)) {
        return false;
    }
    if (stat(path, &status) || !S_ISREG(status.st_mode)) {
        return false; /* a pipe could not be read again from its beginning */
    }
    table = table_read_header(path);
    is_bearings = measurement_row_is_bearings(table);
    table_free(table);
    return is_bearings;
}

/*
 * Handles a second scan of one sensor at one time: exit 2, or counts its rows as skipped and frees
 * it.
 */
static void fail_or_skip_duplicate_scan(struct bearing_reader *reader, struct sensor_scan *scan,
                                        size_t earlier)
{
    if (!reader->keep_going) {
        fail(EXIT_USAGE, "%s:%u: sensor %d has another scan at %.6f s: line %u of %s", scan->path,
             (unsigned)scan->line, (int)scan->bearings.sensor_id,
             (double)scan->bearings.time_us * 1e-6, (unsigned)reader->before.list[earlier].line,
             reader->before.list[earlier].path);
    }
    reader->duplicates_skipped += scan->bearings.num_bearings ? scan->bearings.num_bearings : 1;
    sensor_scan_free(scan);
}

/*
 * Whether the sensor already has a scan at this time, from another file; their order cannot be
 * told, so the later one is refused. Notes the scan otherwise.
 */
static bool refuse_if_duplicate_scan(struct bearing_reader *reader, struct sensor_scan *scan)
{
    struct scans_of_time *before = &reader->before;

    if (before->time_us != scan->bearings.time_us) {
        before->time_us = scan->bearings.time_us;
        before->count = 0;
    }
    for (size_t i = 0; i < before->count; i++) {
        if (before->list[i].sensor_id == scan->bearings.sensor_id) {
            fail_or_skip_duplicate_scan(reader, scan, i);
            return true;
        }
    }
    before->list[before->count].sensor_id = scan->bearings.sensor_id;
    before->list[before->count].path = scan->path;
    before->list[before->count++].line = scan->line;
    return false;
}

static bool read_next_scan(struct bearing_reader *reader, struct sensor_scan *scan)
{
    do {
        if (!merged_scan_files_next(&reader->files, scan)) {
            return false;
        }
    } while (refuse_if_duplicate_scan(reader, scan));
    reader->counts.scans++;
    reader->counts.bearings += scan->bearings.num_bearings;
    return true;
}

/*
 * Whether a scan that is not before the frame belongs to it: within the tolerance, of another
 * sensor.
 */
static bool belongs_to_frame(const struct bearing_reader *reader,
                             const struct rho_bearing_scan *scan)
{
    if (scan->time_us - reader->tolerance_us > reader->frame.time_us) {
        return false;
    }
    for (size_t i = 0; i < reader->frame.num_scans; i++) {
        if (reader->scans[i].sensor_id == scan->sensor_id) {
            return false;
        }
    }
    return true;
}

static void drop_frame(struct bearing_reader *reader)
{
    for (size_t i = 0; i < reader->frame.num_scans; i++) {
        free((void *)reader->scans[i].bearings);
    }
    reader->frame = (struct rho_frame){.num_scans = 0};
}

static int compare_scan_sensors(const void *a, const void *b)
{
    const struct rho_bearing_scan *first = a, *second = b;

    return (first->sensor_id > second->sensor_id) - (first->sensor_id < second->sensor_id);
}

/* Makes the next frame of the scans that follow. Returns false after the last. */
static bool make_next_frame(struct bearing_reader *reader)
{
    struct rho_frame *frame = &reader->frame;

    drop_frame(reader);
    if (!reader->has_next && !read_next_scan(reader, &reader->next)) {
        return false;
    }
    *frame = (struct rho_frame){.time_us = reader->next.bearings.time_us, .scans = reader->scans};
    do {
        reader->scans[frame->num_scans++] = reader->next.bearings;
        reader->has_next = read_next_scan(reader, &reader->next);
    } while (reader->has_next && belongs_to_frame(reader, &reader->next.bearings));
    qsort(reader->scans, frame->num_scans, sizeof *reader->scans, compare_scan_sensors);
    reader->counts.frames++;
    return true;
}

const struct rho_frame *bearing_reader_next(struct bearing_reader *reader)
{
    while (make_next_frame(reader)) {
        if (reader->counts.frames > reader->skip) {
            return &reader->frame;
        }
    }
    return NULL;
}

static int compare_sensors(const void *a, const void *b)
{
    const struct frame_sensor *first = a, *second = b;

    return (first->sensor_id > second->sensor_id) - (first->sensor_id < second->sensor_id);
}

static void sort_sensors(struct bearing_reader *reader)
{
    for (size_t i = 0; i < reader->known.count; i++) {
        reader->sensors[i] = reader->known.list[i].sensor;
    }
    qsort(reader->sensors, reader->known.count, sizeof *reader->sensors, compare_sensors);
}

static void rewind_files(struct bearing_reader *reader)
{
    for (int i = 0; i < reader->files.count; i++) {
        scan_source_rewind(reader->files.list[i].source);
    }
    reader->before.count = 0;
    reader->duplicates_skipped = 0;
    reader->counts = (struct bearing_reader_counts){.frames = 0};
}

/*
 * Reads all frames to count them and to find the sensors. Frames are counted by their number of
 * scans, since the number of sensors is known only at the end.
 */
static void count_frames_and_sensors(struct bearing_reader *reader, uint64_t file_bytes)
{
    uint64_t frames_of[RHO_MAX_SENSORS + 1] = {0};
    struct progress progress = progress_start("frames looked through", 0);

    while (make_next_frame(reader)) {
        frames_of[reader->frame.num_scans]++;
        progress_show_by_bytes(&progress, reader->counts.frames, bearing_reader_position(reader),
                               file_bytes);
    }
    progress_end(&progress);
    reader->total = reader->counts;
    for (size_t i = 0; i < reader->known.count; i++) {
        reader->total.frames_incomplete += frames_of[i];
    }
    reader->total.rows_skipped =
        reader->duplicates_skipped + merged_scan_files_rows_skipped(&reader->files);
    reader->known.is_closed = true;
    sort_sensors(reader);
}

struct bearing_reader *bearing_reader_open(char *const *paths, int num_paths,
                                           const struct parameters *parameters, bool keep_going)
{
    struct bearing_reader *reader = must_calloc(1, sizeof *reader);
    uint64_t bytes = 0;

    reader->keep_going = keep_going;
    reader->tolerance_us = llround(parameters->value[PARAMETER_FRAME_TOLERANCE_S] * 1e6);
    reader->files = merged_scan_files_open(paths, num_paths, parameters,
                                           (struct scan_source_options){.kind = RECORD_BEARINGS,
                                                                        .keep_going = keep_going,
                                                                        .known = &reader->known});
    for (int i = 0; i < num_paths; i++) {
        bytes += regular_file_size_or_zero(paths[i]);
    }
    count_frames_and_sensors(reader, bytes);
    rewind_files(reader);
    return reader;
}

void bearing_reader_need_two(const struct bearing_reader *reader)
{
    if (reader->known.count < 2) {
        const struct known_sensor *only = &reader->known.list[0];

        fail(EXIT_USAGE,
             "%s:%u: sensor %d is the only sensor: positions need bearings of two or more",
             only->path, (unsigned)only->line, (int)only->sensor.sensor_id);
    }
}

void bearing_reader_keep_last(struct bearing_reader *reader, uint64_t frames)
{
    /* sensors that look at times of their own have a frame each */
    if (reader->total.frames_incomplete == reader->total.frames) {
        frames *= reader->known.count;
    }
    print_if_only_last_taken(frames, reader->total.frames, "frames");
    reader->skip = reader->total.frames > frames ? reader->total.frames - frames : 0;
}

uint64_t bearing_reader_num_frames(const struct bearing_reader *reader)
{
    return reader->total.frames;
}

uint64_t bearing_reader_position(const struct bearing_reader *reader)
{
    return merged_scan_files_bytes_read(&reader->files);
}

const struct frame_sensor *bearing_reader_sensors(const struct bearing_reader *reader,
                                                  size_t *count)
{
    *count = reader->known.count;
    return reader->sensors;
}

struct bearing_reader_counts bearing_reader_counts(const struct bearing_reader *reader)
{
    return reader->total;
}

void bearing_reader_report(const struct bearing_reader *reader)
{
    print_rows_skipped(reader->total.rows_skipped);
    /* where all do, sensors look at times of their own */
    if (reader->total.frames_incomplete > 0 &&
        reader->total.frames_incomplete < reader->total.frames) {
        fprintf(stderr, "rhotrack: %" PRIu64 " of %" PRIu64 " frames miss a sensor\n",
                reader->total.frames_incomplete, reader->total.frames);
    }
}

void bearing_reader_close(struct bearing_reader *reader)
{
    if (!reader) {
        return;
    }
    drop_frame(reader);
    if (reader->has_next) {
        sensor_scan_free(&reader->next);
    }
    merged_scan_files_close(&reader->files);
    free(reader);
}
