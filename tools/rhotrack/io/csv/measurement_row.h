/* SPDX-License-Identifier: MIT */
/*
 * measurement_row: reads one row of plots or bearings, checked and converted to the library's form:
 * its time, its sensor, and its measurement, if it has one. Scans are gathered from records
 * (rows_to_scans.h).
 */
#ifndef RHOTRACK_TOOL_MEASUREMENT_ROW_H
#define RHOTRACK_TOOL_MEASUREMENT_ROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/csv/csv_table.h"
#include "io/csv/geodetic_columns.h"
#include "io/csv/row_cells.h"
#include "rhotrack/types.h"
#include "settings/parameters.h"

enum record_kind { RECORD_PLOTS, RECORD_BEARINGS };

struct measurement_row {
    int64_t time_us;           /* the row's own time, the sensor's time bias not yet subtracted */
    int32_t bias_us;           /* time bias of the sensor, still contained in time_us */
    int64_t received_us;       /* reception time, where the file has that column */
    struct scan_number number; /* number of the scan */
    int32_t sensor_id;
    uint32_t line;                        /* line in the file */
    float sector_from_rad, sector_to_rad; /* sector of the scan; both 0: not given */
    bool has_measurement;
    uint32_t measures;          /* RHO_MEASURES_... of the plot */
    struct rho_plot plot;       /* measurement of RECORD_PLOTS; its offset is 0 */
    struct rho_bearing bearing; /* measurement of RECORD_BEARINGS; its offset is 0 */
    /* a description of the sensor was given; its position is set in any case */
    bool has_sensor;
    struct rho_sensor sensor;
    /* frame of a radar placed by latitude and longitude, or NULL; valid until the next row */
    const struct radar_axes *frame;
};

/*
 * The columns of a file. A file of plots has either x_m and y_m, or range_m and an azimuth, or
 * latitude and longitude; columns that its kind does not use count as missing.
 */
struct measurement_columns {
    struct columns in_file;
    bool is_bearings;
    struct geodetic_columns *geodetic; /* NULL for bearings */
};

/* Whether the file holds bearings, and neither Cartesian nor polar plots. */
bool measurement_row_is_bearings(const struct table *table);

/*
 * Finds the columns; exit 2 where a needed column is missing, or the file holds the other kind.
 * Plots need sensor_id where needs_sensor and the parameters describe a sensor, else all are of
 * sensor 0; bearings always need it. To be freed before the parameters.
 */
struct measurement_columns measurement_columns_find(const struct table *table,
                                                    const struct parameters *parameters,
                                                    enum record_kind kind, bool needs_sensor);
void measurement_columns_free(struct measurement_columns *columns);

/* Reads a row. Returns false and sets the reason where the row is bad. */
bool measurement_row_read(const struct measurement_columns *columns, size_t row,
                          const struct parameters *parameters, struct measurement_row *record,
                          char reason[ROW_REASON_BYTES]);

#endif
