/* SPDX-License-Identifier: MIT */
#include "bearing_row.h"

#include "rhotrack/angle.h"

#define PI 3.1415927f /* the nearest float, a little more: -pi .. pi as numbers of a file */

/* ---- Columns ---- */

bool bearing_columns_are_there(const struct table *table)
{
    return table_find(table, "bearing_rad") >= 0 && table_find(table, "x_m") < 0 &&
           table_find(table, "range_m") < 0;
}

/* Other kinds of files have other columns: say so rather than that bearing_rad is missing. */
static void check_kind(const struct table *table)
{
    static const char *const others[][2] = {{"x_m", "plots, which are no bearings"},
                                            {"range_m", "polar plots, which are no bearings"},
                                            {"bearing_deg", "bearings are read in radians"}};

    if (table_find(table, "bearing_rad") >= 0) {
        return;
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (table_find(table, others[i][0]) >= 0) {
            table_fail(table, TABLE_HEADER, "%s (column '%s'): column 'bearing_rad' is missing",
                       others[i][1], others[i][0]);
        }
    }
}

struct bearing_columns bearing_columns_find(const struct table *table)
{
    check_kind(table);
    row_need_both(table, "sector_from_rad", "sector_to_rad");
    return (struct bearing_columns){
        .t_s = table_need(table, "t_s"),
        .sensor_id = table_need(table, "sensor_id"),
        .sensor_x_m = table_need(table, "sensor_x_m"),
        .sensor_y_m = table_need(table, "sensor_y_m"),
        .bearing_rad = table_need(table, "bearing_rad"),
        .sigma_rad = table_find(table, "sigma_rad"),
        .sector_from_rad = table_find(table, "sector_from_rad"),
        .sector_to_rad = table_find(table, "sector_to_rad"),
        .snr_db = table_find(table, "snr_db"),
        .scan = table_find(table, "scan"),
        .epoch = table_find(table, "epoch"),
    };
}

/* ---- Rows ---- */

/* What the sensor is said to measure too much of; its time comes off the scan's. */
static void take_off_bias(const struct parameters *parameters, struct bearing_row *row)
{
    double bias_rad =
        parameters_of_sensor(parameters, row->sensor_id, SENSOR_AZIMUTH_BIAS_RAD, 0.0);

    if (bias_rad < 0.0 || bias_rad > 0.0) {
        row->bearing.bearing_rad = rho_angle_difference(row->bearing.bearing_rad, (float)bias_rad);
    }
}

static bool read_bearing(const struct row_check *check, const struct bearing_columns *columns,
                         const struct parameters *parameters, struct bearing_row *row)
{
    double sigma_rad = parameters_of_sensor(parameters, row->sensor_id, SENSOR_SIGMA_RAD,
                                            parameters->value[PARAMETER_SIGMA_RAD]);

    row->has_bearing = true;
    if (!row_float(check, columns->bearing_rad, -PI, PI, &row->bearing.bearing_rad)) {
        return false;
    }
    take_off_bias(parameters, row);
    return row_sigma_rad(check, columns->sigma_rad, sigma_rad, &row->bearing.sigma_rad) &&
           row_snr(check, columns->snr_db, &row->bearing.snr_db);
}

bool bearing_row_read(const struct table *table, const struct bearing_columns *columns, size_t row,
                      const struct parameters *parameters, struct bearing_row *bearing_row,
                      char reason[ROW_REASON_BYTES])
{
    struct row_check check = {.table = table, .row = row};

    check.reason = reason;
    *bearing_row = (struct bearing_row){.has_bearing = false};
    if (!row_key(&check, columns->t_s, columns->sensor_id, &bearing_row->time_us,
                 &bearing_row->sensor_id) ||
        !row_number(&check, columns->scan, columns->epoch, &bearing_row->number) ||
        !row_position(&check, columns->sensor_x_m, &bearing_row->x_m) ||
        !row_position(&check, columns->sensor_y_m, &bearing_row->y_m) ||
        !row_sector(&check, columns->sector_from_rad, columns->sector_to_rad,
                    &bearing_row->sector_from_rad, &bearing_row->sector_to_rad)) {
        return false;
    }
    bearing_row->bias_us = parameters_time_bias_us(parameters, bearing_row->sensor_id);
    if (!row_right_time(&check, bearing_row->time_us, bearing_row->bias_us)) {
        return false;
    }
    return !row_has(&check, columns->bearing_rad) ||
           read_bearing(&check, columns, parameters, bearing_row);
}
