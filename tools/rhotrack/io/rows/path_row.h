/* SPDX-License-Identifier: MIT */
/*
 * trajectory_row: reads one row of a truth or tracks file: a target or track at one time.
 *
 * Errors as `rhotrack: FILE:LINE: what is wrong`, exit 2.
 */
#ifndef RHOTRACK_TOOL_PATH_ROW_H
#define RHOTRACK_TOOL_PATH_ROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/geodetic.h"
#include "io/csv/table.h"
#include "settings/parameters.h"

struct path_row {
    int64_t time_us;
    int32_t id; /* identity of the target or track */
    int status; /* RHO_MESSAGE_TRACK_...; confirmed for a target */
    double x_m, y_m, z_m;
    double vx_mps, vy_mps, vz_mps; /* vx and vy NAN where not given; z and vz 0 where not given */
    /* xx, yx, yy of the position, then of the velocity; NAN where not given */
    double covariance[6];
};

/* Column indices, -1 where the file has no such column. */
struct path_columns {
    const struct table *table;
    int time, id, status, x, y, z, vx, vy, vz;
    int covariance[6];
    struct geodetic *geodetic; /* of a truth with latitudes and longitudes */
};

/*
 * Finds the columns of tracks (track_id), else of a truth (target_id); to be released by
 * trajectory_columns_free.
 */
struct path_columns path_columns_find(const struct table *table,
                                      const struct parameters *parameters);
void path_columns_end(struct path_columns *columns);

/* Whether the row has a position. */
bool path_row_has_place(const struct path_columns *columns, size_t row);

struct path_row path_row_read(const struct path_columns *columns, size_t row);

#endif
