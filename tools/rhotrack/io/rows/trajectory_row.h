/* SPDX-License-Identifier: MIT */
/*
 * trajectory_row: reads one row of a truth or tracks file: a target or track at one time.
 *
 * Errors as `rhotrack: FILE:LINE: what is wrong`, exit 2.
 */
#ifndef RHOTRACK_TOOL_TRAJECTORY_ROW_H
#define RHOTRACK_TOOL_TRAJECTORY_ROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/geodetic_columns.h"
#include "settings/parameters.h"

struct trajectory_row {
    int64_t time_us;
    int32_t id; /* identity of the target or track */
    int status; /* RHO_MESSAGE_TRACK_...; confirmed for a target */
    double x_m, y_m, z_m;
    double vx_mps, vy_mps, vz_mps; /* vx and vy NAN where not given; z and vz 0 where not given */
    /* xx, yx, yy of the position, then of the velocity; NAN where not given */
    double covariance[6];
};

struct trajectory_columns {
    struct columns in_file;
    bool has_z;
    struct geodetic_columns *geodetic; /* of a truth; NULL for tracks */
};

/*
 * Finds the columns of tracks (track_id), else of a truth (target_id); to be released by
 * trajectory_columns_free.
 */
struct trajectory_columns trajectory_columns_find(const struct table *table,
                                                  const struct parameters *parameters);
void trajectory_columns_free(struct trajectory_columns *columns);

/* Whether the row has a position. */
bool trajectory_row_has_place(const struct trajectory_columns *columns, size_t row);

struct trajectory_row trajectory_row_read(const struct trajectory_columns *columns, size_t row);

#endif
