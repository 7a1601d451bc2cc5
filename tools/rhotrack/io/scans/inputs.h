/* SPDX-License-Identifier: MIT */
/*
 * inputs: files of plots and files of bearings, any of both, merged by time: scans and frames in
 * one order. Of one time a scan of plots comes first. Memory does not grow with the files.
 */
#ifndef RHOTRACK_TOOL_INPUTS_H
#define RHOTRACK_TOOL_INPUTS_H

#include <stdbool.h>

#include "rhotrack/types.h"
#include "settings/parameters.h"

struct inputs;

/* One of both; the other is NULL. Both NULL: the end. */
struct input {
    const struct rho_scan *scan;
    const struct rho_sensor
        *sensor; /* who saw the scan; NULL where nothing was said of the sensor */
    const struct rho_frame *frame;
};

struct inputs_counts {
    uint64_t steps, scans, plots;       /* steps: scans of plots, and frames; plots: bearings too */
    uint64_t frames, frames_incomplete; /* a sensor of the files is missing in these */
    uint64_t rows_skipped;
};

/*
 * Opens the files, each by what its header says it holds; errors as the readers have them, of
 * bearings at once, of plots where reading gets there. Bearings alone take two sensors at least.
 */
struct inputs *inputs_open(char *const *paths, int num_paths, const struct parameters *parameters,
                           bool keep_going);

/* One CSV file of plots that may grow, or a pipe (scan_reader.h). */
struct inputs *inputs_follow(char *path, const struct parameters *parameters, bool keep_going);
struct scan_reader *inputs_scan_reader(struct inputs *inputs); /* who follows it */

bool inputs_have_plots(const struct inputs *inputs);
bool inputs_have_bearings(const struct inputs *inputs);

/* Valid until the next call. */
struct input inputs_next(struct inputs *inputs);

/* Passive sensors of the files, in the order of sensor_id: *count of them. */
struct frame_sensor;
const struct frame_sensor *inputs_passive_sensors(const struct inputs *inputs, size_t *count);

/* Bytes of the files that were read, and that there are; the latter 0 where that is not known. */
uint64_t inputs_bytes_read(const struct inputs *inputs);
uint64_t inputs_total_bytes(const struct inputs *inputs);

/* Of plots what was read so far, of bearings all. */
struct inputs_counts inputs_counts(const struct inputs *inputs);
void inputs_close(struct inputs *inputs);

#endif
