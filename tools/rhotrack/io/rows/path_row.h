/* SPDX-License-Identifier: MIT */
/*
 * path_row: one row of a truth or tracks file: a target or track at a time.
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
    int32_t id; /* of the target or track */
    int status; /* RHO_MESSAGE_TRACK_...; of a target confirmed */
    double x_m, y_m, z_m;
    double vx_mps, vy_mps, vz_mps; /* vx and vy NAN where not given; z and vz 0 */
    double covariance[6];          /* xx, yx, yy of the place, then of the velocity; NAN */
};

/* Columns by index, -1 where the file has none. */
struct path_columns {
    const struct table *table;
    int time, id, status, x, y, z, vx, vy, vz;
    int covariance[6];
    struct geodetic *geodetic; /* of a truth by latitude and longitude */
};

/* Columns of tracks (track_id), else of a truth (target_id). To be ended. */
struct path_columns path_columns_find(const struct table *table,
                                      const struct parameters *parameters);
void path_columns_end(struct path_columns *columns);

/* The row has a place. */
bool path_row_has_place(const struct path_columns *columns, size_t row);

struct path_row path_row_read(const struct path_columns *columns, size_t row);

#endif
