/* SPDX-License-Identifier: MIT */
/*
 * record: one row of plots or bearings, checked, as the library takes it: its time, its sensor, and
 * what was measured, if anything was. Scans are gathered from records (scan_gather.h).
 */
#ifndef RHOTRACK_TOOL_RECORD_H
#define RHOTRACK_TOOL_RECORD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/geodetic.h"
#include "io/csv/row_check.h"
#include "io/csv/table.h"
#include "rhotrack/types.h"
#include "settings/parameters.h"

enum record_kind { RECORD_PLOTS, RECORD_BEARINGS };

struct record {
    int64_t time_us;          /* the row's own time, bias_us still in it */
    int32_t bias_us;          /* the sensor's time bias, which is still in */
    int64_t received_us;      /* where the file has that column */
    struct row_number number; /* of the scan */
    int32_t sensor_id;
    uint32_t line;                        /* of the file */
    float sector_from_rad, sector_to_rad; /* the scan's sector; both 0: not given */
    bool has_measurement;
    uint32_t measures;          /* RHO_MEASURES_... of the plot */
    struct rho_plot plot;       /* or, its offset is 0 in both, */
    struct rho_bearing bearing; /* by the kind */
    bool has_sensor;            /* the sensor below is described; its place is set in any case */
    struct rho_sensor sensor;
    /* of a sensor whose place is said on the earth; until the next row */
    const struct radar_frame *frame;
};

/*
 * Columns by index, -1 where the file has none. Of plots either x_m and y_m are there, or range_m
 * and an azimuth, or latitude and longitude.
 */
struct record_columns {
    bool is_bearings;
    int t_s, received_s;
    int sensor_id, x_m, y_m, z_m, vx_mps, vy_mps, vz_mps, sigma_m, sigma_mps;
    int range_m, azimuth_rad, azimuth_deg, elevation_rad, elevation_deg;
    int range_rate_mps;
    int sigma_range_m, sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps;
    int sensor_x_m, sensor_y_m, sensor_z_m;
    int bearing_rad, sigma_rad;
    int sector_from_rad, sector_to_rad, snr_db, scan, epoch;
    struct geodetic *geodetic;
};

/* The file holds bearings, and neither places nor ranges. */
bool record_table_has_bearings(const struct table *table);

/*
 * Finds the columns; exit 2 where one is missing that is needed, or the file holds the other kind.
 * Plots need sensor_id where needs_sensor and the parameters describe a
 * sensor, else all is sensor 0's; bearings always do. To be freed
 * before the parameters go.
 */
struct record_columns record_columns_find(const struct table *table,
                                          const struct parameters *parameters,
                                          enum record_kind kind, bool needs_sensor);
void record_columns_free(struct record_columns *columns);

/* Reads a row. Returns false and the reason where it is bad. */
bool record_read(const struct table *table, const struct record_columns *columns, size_t row,
                 const struct parameters *parameters, struct record *record,
                 char reason[ROW_REASON_BYTES]);

#endif
