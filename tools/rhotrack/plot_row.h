/* SPDX-License-Identifier: MIT */
/* plot_row: one row of a plot file, checked: its time, its sensor, and its plot if it has one. */
#ifndef RHOTRACK_TOOL_PLOT_ROW_H
#define RHOTRACK_TOOL_PLOT_ROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geodetic.h"
#include "parameters.h"
#include "rhotrack/types.h"
#include "row_check.h"
#include "table.h"

struct plot_row {
    int64_t time_us;          /* as it stands in the row */
    int32_t bias_us;          /* the sensor's time bias, which is still in */
    int64_t received_us;      /* where the file has that column */
    struct row_number number; /* of the scan */
    int32_t sensor_id;
    float sector_from_rad, sector_to_rad; /* of the scan; both 0 where not given */
    bool has_plot;
    uint32_t measures;    /* RHO_MEASURES_... of the plot */
    struct rho_plot plot; /* its offset is 0 */
    bool has_sensor;      /* the sensor below is described */
    struct rho_sensor sensor;
    const struct radar_frame
        *frame; /* of a sensor whose place is said on the earth; until the next row */
};

/*
 * Columns of a plot file by index, -1 where it has none. Either x_m and y_m are there, or range_m and an azimuth, or latitude
 * and longitude.
 */
struct plot_columns {
    int t_s, received_s;
    int sensor_id, x_m, y_m, z_m, vx_mps, vy_mps, vz_mps, sigma_m, sigma_mps;
    int range_m, azimuth_rad, azimuth_deg, elevation_rad, elevation_deg;
    int range_rate_mps;
    int sigma_range_m, sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps;
    int sensor_x_m, sensor_y_m, sensor_z_m;
    int sector_from_rad, sector_to_rad, snr_db, scan, epoch;
    struct geodetic *geodetic;
};

/*
 * Finds the columns; exit 2 where one is missing that is needed, or the file holds bearings; sensor_id is where needs_sensor, else all
 * is sensor 0's. To be freed before the parameters go.
 */
struct plot_columns plot_columns_find(const struct table *table,
                                      const struct parameters *parameters, bool needs_sensor);
void plot_columns_free(struct plot_columns *columns);

/* Reads a row. Returns false and the reason where it is bad. */
#define PLOT_ROW_REASON_BYTES ROW_REASON_BYTES
bool plot_row_read(const struct table *table, const struct plot_columns *columns, size_t row,
                   const struct parameters *parameters, struct plot_row *plot_row,
                   char reason[PLOT_ROW_REASON_BYTES]);

#endif
