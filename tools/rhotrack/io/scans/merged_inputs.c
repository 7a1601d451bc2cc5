/* SPDX-License-Identifier: MIT */
#include "io/scans/merged_inputs.h"

#include <stdlib.h>

#include "base/common.h"
#include "io/log/lcm_log.h"
#include "io/log/log_scans.h"
#include "io/scans/bearing_reader.h"
#include "io/scans/plot_reader.h"

struct merged_inputs {
    struct plot_reader *scan_reader;       /* NULL: no files of plots */
    struct bearing_reader *bearing_reader; /* NULL: no files of bearings */
    /* next scan, and next looks of one time out of the reader's frame, read ahead */
    const struct rho_scan *scan;
    const struct rho_sensor *sensor;
    const struct rho_frame *frame; /* NULL: all its looks were handed out */
    int64_t taken_us;              /* time of its looks that were taken last */
    struct rho_frame looks;
    struct rho_bearing_scan *scans; /* room for the looks */
    bool has_scan, has_looks;       /* what was read ahead has not been handed out */
    uint64_t bytes;                 /* bytes of all files; 0: not known */
};

/* Kinds of scans in a file, LOG_HAS_... or-ed: a table has one kind, a log may have both. */
static unsigned kinds_in_file(const char *path)
{
    unsigned kinds;

    if (!lcm_log_is_log(path)) {
        return bearing_reader_is_bearings(path) ? LOG_HAS_BEARINGS : LOG_HAS_PLOTS;
    }
    kinds = log_scans_kinds(path);
    return kinds ? kinds : LOG_HAS_PLOTS; /* the reader of plots reports what is missing */
}

/* Lists the paths of files that hold a kind of scans, in the given order. Returns their number. */
static int paths_of_kind(char *const *paths, int num_paths, unsigned kind, char **chosen)
{
    int count = 0;

    for (int i = 0; i < num_paths; i++) {
        if (kinds_in_file(paths[i]) & kind) {
            chosen[count++] = paths[i];
        }
    }
    return count;
}

/* Reads the next scan of plots unless one is waiting to be handed out. */
static void read_ahead_next_plot_scan(struct merged_inputs *inputs)
{
    if (inputs->scan_reader && !inputs->has_scan) {
        inputs->scan = plot_reader_next(inputs->scan_reader);
        inputs->sensor = inputs->scan ? plot_reader_sensor(inputs->scan_reader) : NULL;
        inputs->has_scan = inputs->scan;
    }
}

/* Takes the earliest looks of the frame that were not taken, those of one time. */
static void take_looks_of_one_time(struct merged_inputs *inputs)
{
    const struct rho_frame *whole = inputs->frame;
    int64_t time_us = INT64_MAX;

    inputs->looks.num_scans = 0;
    for (uint32_t i = 0; i < whole->num_scans; i++) {
        if (whole->scans[i].time_us > inputs->taken_us && whole->scans[i].time_us < time_us) {
            time_us = whole->scans[i].time_us;
        }
    }
    inputs->looks.time_us = inputs->taken_us = time_us;
    for (uint32_t i = 0; i < whole->num_scans; i++) {
        if (whole->scans[i].time_us == time_us) {
            inputs->scans[inputs->looks.num_scans++] = whole->scans[i];
        }
    }
    inputs->looks.scans = inputs->scans;
    inputs->has_looks = inputs->looks.num_scans > 0;
}

/* Reads the next looks of bearings of one time, unless some wait to be handed out. */
static void read_ahead_next_looks(struct merged_inputs *inputs)
{
    if (!inputs->bearing_reader || inputs->has_looks) {
        return;
    }
    if (inputs->frame) {
        take_looks_of_one_time(inputs);
    }
    if (!inputs->has_looks) {
        inputs->frame = bearing_reader_next(inputs->bearing_reader);
        if (inputs->frame) {
            inputs->taken_us = INT64_MIN;
            inputs->scans = must_realloc(inputs->scans, ((size_t)inputs->frame->num_scans + 1) *
                                                            sizeof *inputs->scans);
            take_looks_of_one_time(inputs);
        }
    }
}

/*
 * Sum of the files' sizes; a log of both kinds is read by two readers, and counts twice. 0: not
 * known.
 */
static uint64_t sum_reader_bytes(char *const *paths, int num_paths)
{
    uint64_t sum = 0;

    for (int i = 0; i < num_paths; i++) {
        uint64_t bytes = regular_file_size_or_zero(paths[i]);

        if (bytes == 0) {
            return 0;
        }
        sum += kinds_in_file(paths[i]) == (LOG_HAS_PLOTS | LOG_HAS_BEARINGS) ? 2 * bytes : bytes;
    }
    return sum;
}

struct merged_inputs *merged_inputs_open(char *const *paths, int num_paths,
                                         const struct parameters *parameters, bool keep_going)
{
    struct merged_inputs *inputs = must_calloc(1, sizeof *inputs);
    char **sorted = must_calloc((size_t)num_paths + 1, sizeof *sorted);
    int count = paths_of_kind(paths, num_paths, LOG_HAS_PLOTS, sorted);

    if (count > 0) {
        inputs->scan_reader = plot_reader_open(sorted, count, parameters, keep_going);
    }
    count = paths_of_kind(paths, num_paths, LOG_HAS_BEARINGS, sorted);
    if (count > 0) {
        inputs->bearing_reader = bearing_reader_open(sorted, count, parameters, keep_going);
        if (!inputs->scan_reader) {
            bearing_reader_need_two(inputs->bearing_reader);
        }
    }
    free(sorted);
    inputs->bytes = sum_reader_bytes(paths, num_paths);
    read_ahead_next_plot_scan(inputs);
    read_ahead_next_looks(inputs);
    return inputs;
}

struct merged_inputs *merged_inputs_follow_plots(char *path, const struct parameters *parameters,
                                                 bool keep_going)
{
    struct merged_inputs *inputs = must_calloc(1, sizeof *inputs);

    inputs->scan_reader = plot_reader_follow(path, parameters, keep_going);
    return inputs;
}

struct plot_reader *merged_inputs_scan_reader(struct merged_inputs *inputs)
{
    return inputs->scan_reader;
}

bool merged_inputs_have_plots(const struct merged_inputs *inputs)
{
    return inputs->scan_reader;
}

bool merged_inputs_have_bearings(const struct merged_inputs *inputs)
{
    return inputs->bearing_reader;
}

struct input merged_inputs_next(struct merged_inputs *inputs)
{
    read_ahead_next_plot_scan(inputs);
    read_ahead_next_looks(inputs);
    if (inputs->has_scan &&
        (!inputs->has_looks || inputs->scan->time_us <= inputs->looks.time_us)) {
        inputs->has_scan = false;
        return (struct input){.scan = inputs->scan, .sensor = inputs->sensor};
    }
    if (inputs->has_looks) {
        inputs->has_looks = false;
        return (struct input){.frame = &inputs->looks};
    }
    return (struct input){.scan = NULL};
}

const struct frame_sensor *merged_inputs_passive_sensors(const struct merged_inputs *inputs,
                                                         size_t *count)
{
    *count = 0;
    return inputs->bearing_reader ? bearing_reader_sensors(inputs->bearing_reader, count) : NULL;
}

uint64_t merged_inputs_bytes_read(const struct merged_inputs *inputs)
{
    return (inputs->scan_reader ? plot_reader_position(inputs->scan_reader) : 0) +
           (inputs->bearing_reader ? bearing_reader_position(inputs->bearing_reader) : 0);
}

uint64_t merged_inputs_total_bytes(const struct merged_inputs *inputs)
{
    return inputs->bytes;
}

struct merged_inputs_counts merged_inputs_counts(const struct merged_inputs *inputs)
{
    struct merged_inputs_counts counts = {0};

    if (inputs->scan_reader) {
        struct plot_reader_counts scans = plot_reader_counts(inputs->scan_reader);

        counts.scans = scans.scans;
        counts.plots = scans.plots;
        counts.rows_skipped = scans.rows_skipped;
    }
    if (inputs->bearing_reader) {
        struct bearing_reader_counts frames = bearing_reader_counts(inputs->bearing_reader);

        counts.frames = frames.frames;
        counts.frames_incomplete = frames.frames_incomplete;
        counts.plots += frames.bearings;
        counts.rows_skipped += frames.rows_skipped;
    }
    counts.steps = counts.scans + counts.frames;
    return counts;
}

void merged_inputs_close(struct merged_inputs *inputs)
{
    if (!inputs) {
        return;
    }
    if (inputs->scan_reader) {
        plot_reader_close(inputs->scan_reader);
    }
    bearing_reader_close(inputs->bearing_reader);
    free(inputs->scans);
    free(inputs);
}
