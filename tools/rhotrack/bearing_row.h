/* SPDX-License-Identifier: MIT */
/* bearing_row: one row of a bearings file, checked: its time, its sensor's place, and its bearing if it has one. */
#ifndef RHOTRACK_TOOL_BEARING_ROW_H
#define RHOTRACK_TOOL_BEARING_ROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "parameters.h"
#include "rhotrack/types.h"
#include "row_check.h"
#include "table.h"

struct bearing_row {
    int64_t time_us;          /* as it stands in the row */
    int32_t bias_us;          /* the sensor's time bias, which is still in */
    struct row_number number; /* of the scan */
    int32_t sensor_id;
    float x_m, y_m;                       /* of the sensor */
    float sector_from_rad, sector_to_rad; /* of the scan; both 0 where not given */
    bool has_bearing;
    struct rho_bearing bearing;
};

/* Columns of a bearings file by index, -1 where it has none. */
struct bearing_columns {
    int t_s, sensor_id, sensor_x_m, sensor_y_m, bearing_rad;
    int sigma_rad, sector_from_rad, sector_to_rad, snr_db, scan, epoch;
};

/* The file holds bearings, and neither places nor ranges. */
bool bearing_columns_are_there(const struct table *table);

/* Finds the columns; exit 2 where one is missing that is needed. */
struct bearing_columns bearing_columns_find(const struct table *table);

/* Reads a row. Returns false and the reason where it is bad. */
bool bearing_row_read(const struct table *table, const struct bearing_columns *columns, size_t row,
                      const struct parameters *parameters, struct bearing_row *bearing_row,
                      char reason[ROW_REASON_BYTES]);

#endif
