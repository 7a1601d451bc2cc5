/* SPDX-License-Identifier: MIT */
#include "inputs.h"

#include <stdlib.h>

#include "common.h"
#include "frame_reader.h"
#include "lcm_log.h"
#include "log_scans.h"
#include "scan_reader.h"

struct inputs {
    struct scan_reader *scan_reader;   /* or NULL */
    struct frame_reader *frame_reader; /* or NULL */
    /* the next of each kind */
    const struct rho_scan *scan;
    const struct rho_sensor *sensor;
    const struct rho_frame *frame;
    bool scan_is_taken; /* the next one overwrites it: not before the caller is done */
};

/* What a file holds: a table has one kind, a log may have both. */
static unsigned kinds_of(const char *path)
{
    unsigned kinds;

    if (!lcm_log_is_log(path)) {
        return frame_reader_is_bearings(path) ? LOG_HAS_BEARINGS : LOG_HAS_PLOTS;
    }
    kinds = log_scans_kinds(path);
    return kinds ? kinds : LOG_HAS_PLOTS; /* whose reader says what is missing */
}

/* The paths that hold a kind, in their order. Returns how many. */
static int sort_paths(char *const *paths, int num_paths, unsigned kind, char **sorted)
{
    int count = 0;

    for (int i = 0; i < num_paths; i++) {
        if (kinds_of(paths[i]) & kind) {
            sorted[count++] = paths[i];
        }
    }
    return count;
}

static void next_scan(struct inputs *inputs)
{
    inputs->scan = inputs->scan_reader ? scan_reader_next(inputs->scan_reader) : NULL;
    inputs->sensor = inputs->scan ? scan_reader_sensor(inputs->scan_reader) : NULL;
}

static void next_frame(struct inputs *inputs)
{
    inputs->frame = inputs->frame_reader ? frame_reader_next(inputs->frame_reader) : NULL;
}

struct inputs *inputs_open(char *const *paths, int num_paths, const struct parameters *parameters,
                           bool keep_going)
{
    struct inputs *inputs = must_calloc(1, sizeof *inputs);
    char **sorted = must_calloc((size_t)num_paths + 1, sizeof *sorted);
    int count = sort_paths(paths, num_paths, LOG_HAS_PLOTS, sorted);

    if (count > 0) {
        inputs->scan_reader = scan_reader_open(sorted, count, parameters, keep_going);
    }
    count = sort_paths(paths, num_paths, LOG_HAS_BEARINGS, sorted);
    if (count > 0) {
        inputs->frame_reader = frame_reader_open(sorted, count, parameters, keep_going);
        if (!inputs->scan_reader) {
            frame_reader_need_pair(inputs->frame_reader);
        }
    }
    free(sorted);
    next_scan(inputs);
    next_frame(inputs);
    return inputs;
}

bool inputs_have_plots(const struct inputs *inputs)
{
    return inputs->scan_reader;
}

bool inputs_have_bearings(const struct inputs *inputs)
{
    return inputs->frame_reader;
}

struct input inputs_next(struct inputs *inputs)
{
    struct input input = {NULL, NULL, NULL};

    if (inputs->scan_is_taken) {
        next_scan(inputs);
    }
    inputs->scan_is_taken =
        inputs->scan && (!inputs->frame || inputs->scan->time_us <= inputs->frame->time_us);
    if (inputs->scan_is_taken) {
        input.scan = inputs->scan;
        input.sensor = inputs->sensor;
    } else {
        input.frame = inputs->frame;
        next_frame(inputs); /* frames stay valid */
    }
    return input;
}

const struct frame_sensor *inputs_passive_sensors(const struct inputs *inputs, size_t *count)
{
    *count = 0;
    return inputs->frame_reader ? frame_reader_sensors(inputs->frame_reader, count) : NULL;
}

struct inputs_counts inputs_counts(const struct inputs *inputs)
{
    struct inputs_counts counts = {0};

    if (inputs->scan_reader) {
        struct scan_reader_counts scans = scan_reader_counts(inputs->scan_reader);

        counts.scans = scans.scans;
        counts.plots = scans.plots;
        counts.rows_skipped = scans.rows_skipped;
    }
    if (inputs->frame_reader) {
        struct frame_reader_counts frames = frame_reader_counts(inputs->frame_reader);

        counts.frames = frames.frames;
        counts.frames_incomplete = frames.frames_incomplete;
        counts.plots += frames.bearings;
        counts.rows_skipped += frames.rows_skipped;
    }
    counts.steps = counts.scans + counts.frames;
    return counts;
}

void inputs_close(struct inputs *inputs)
{
    if (!inputs) {
        return;
    }
    if (inputs->scan_reader) {
        scan_reader_close(inputs->scan_reader);
    }
    frame_reader_close(inputs->frame_reader);
    free(inputs);
}
