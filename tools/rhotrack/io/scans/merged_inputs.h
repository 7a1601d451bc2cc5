/* SPDX-License-Identifier: MIT */
/*
 * merged_inputs: reads files of plots and files of bearings together, merged by time, as
 * scans of plots and frames of bearings, looks of one time; at equal times the scan of plots comes
 * first. Memory does not grow with the files.
 */
#ifndef RHOTRACK_TOOL_MERGED_INPUTS_H
#define RHOTRACK_TOOL_MERGED_INPUTS_H

#include <stdbool.h>

#include "rhotrack/types.h"
#include "settings/parameters.h"

struct merged_inputs;

/* The next scan of plots or frame of bearings; the other is NULL. Both NULL: the end. */
struct input {
    const struct rho_scan *scan;
    const struct rho_sensor *sensor; /* sensor of the scan; NULL: no description was given */
    const struct rho_frame *frame;
};

struct merged_inputs_counts {
    /* steps: scans of plots, and frames; plots: bearings count too */
    uint64_t steps, scans, plots;
    uint64_t frames, frames_incomplete; /* frames without a scan of every sensor of the files */
    uint64_t rows_skipped;
};

/*
 * Opens the files, each by the kind that its header tells. Errors are those of the readers, of
 * bearings at once, of plots when reading gets there. Without files of plots, fewer than two
 * passive sensors are an error, exit 2.
 */
struct merged_inputs *merged_inputs_open(char *const *paths, int num_paths,
                                         const struct parameters *parameters, bool keep_going);

/* Opens one CSV file of plots that may grow, or a pipe (plot_reader.h). */
struct merged_inputs *merged_inputs_follow_plots(char *path, const struct parameters *parameters,
                                                 bool keep_going);
struct plot_reader *
merged_inputs_scan_reader(struct merged_inputs *inputs); /* the reader of the plots */

bool merged_inputs_have_plots(const struct merged_inputs *inputs);
bool merged_inputs_have_bearings(const struct merged_inputs *inputs);

/* Reads the next scan or frame, valid until the next call. */
struct input merged_inputs_next(struct merged_inputs *inputs);

/*
 * The passive sensors of the files, *count of them in the order of sensor_id; NULL where there are
 * none.
 */
struct frame_sensor;
const struct frame_sensor *merged_inputs_passive_sensors(const struct merged_inputs *inputs,
                                                         size_t *count);

/* Bytes of the files that were read, and bytes of all files, 0 where that is not known. */
uint64_t merged_inputs_bytes_read(const struct merged_inputs *inputs);
uint64_t merged_inputs_total_bytes(const struct merged_inputs *inputs);

/* Counts: of plots those read so far, of bearings those of the whole files. */
struct merged_inputs_counts merged_inputs_counts(const struct merged_inputs *inputs);
void merged_inputs_close(struct merged_inputs *inputs);

#endif
