/* SPDX-License-Identifier: MIT */
/* plot_data: what the plot command draws: plots, tracks and truth from CSV files, told apart by their columns. */
#ifndef RHOTRACK_TOOL_PLOT_DATA_H
#define RHOTRACK_TOOL_PLOT_DATA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "parameters.h"

struct plot_point {
    int64_t time_us;
    int32_t id; /* of the track or target */
    double x_m, y_m;
    double vx_mps, vy_mps; /* 0 where not given */
    bool is_tentative;
};

/* By identity, then time (plots: as in the file). */
struct plot_points {
    struct plot_point *list;
    size_t count;
};

struct plot_data {
    struct plot_points plots, tracks, truth;
};

/* Reads the files; errors as `rhotrack: FILE:LINE: what is wrong`, exit 2. A track's rows while tentative are kept, but
 * tracks that were never confirmed are left out. The parameters say where the sensors of polar plots are, and what
 * their biases are. */
struct plot_data plot_data_read(char *const *paths, int num_paths,
                                const struct parameters *parameters);
void plot_data_free(struct plot_data *data);

/* The rows of one identity: from *at on; moves *at behind them. False at the end. */
bool plot_data_next(const struct plot_points *points, size_t *at, struct plot_points *one);

#endif
