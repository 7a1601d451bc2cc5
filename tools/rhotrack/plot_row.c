/* SPDX-License-Identifier: MIT */
#include "plot_row.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "rhotrack/measurement.h"

/* A row on its way through the checks. */
struct checking {
    const struct table *table;
    const struct plot_columns *columns;
    size_t row;
    char *reason;
};

/* ---- Columns ---- */

/* Other kinds of files have other columns: say so rather than that x_m is missing. */
static void check_kind(const struct table *table)
{
    static const char *const others[][2] = {{"bearing_rad", "bearings"},
                                            {"lat_deg", "geographic plots"}};

    if (table_find(table, "x_m") >= 0 || table_find(table, "range_m") >= 0) {
        return;
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (table_find(table, others[i][0]) >= 0) {
            table_fail(table, TABLE_HEADER,
                       "%s (column '%s'): this version reads Cartesian and polar plots, columns "
                       "'x_m' and 'y_m' are missing",
                       others[i][1], others[i][0]);
        }
    }
}

static void check_not_both(const struct table *table, int first, int second)
{
    if (first >= 0 && second >= 0) {
        table_fail(table, TABLE_HEADER, "both '%s' and '%s' are there", table->names[first],
                   table->names[second]);
    }
}

/* Columns that mean something only together. */
static void check_pair(const struct table *table, int first, int second, const char *name,
                       const char *beside)
{
    if (first >= 0 && second < 0) {
        table_fail(table, TABLE_HEADER, "no column '%s' beside '%s'", name, beside);
    }
}

struct plot_columns plot_columns_find(const struct table *table)
{
    struct plot_columns columns;
    bool is_polar;

    check_kind(table);
    is_polar = table_find(table, "range_m") >= 0;
    columns = (struct plot_columns){
        .t_s = table_need(table, "t_s"),
        .sensor_id = table_need(table, "sensor_id"),
        .x_m = is_polar ? table_find(table, "x_m") : table_need(table, "x_m"),
        .y_m = is_polar ? -1 : table_need(table, "y_m"),
        .z_m = is_polar ? -1 : table_find(table, "z_m"),
        .vx_mps = is_polar ? -1 : table_find(table, "vx_mps"),
        .vy_mps = is_polar ? -1 : table_find(table, "vy_mps"),
        .vz_mps = is_polar ? -1 : table_find(table, "vz_mps"),
        .sigma_m = table_find(table, "sigma_m"),
        .sigma_mps = table_find(table, "sigma_mps"),
        .range_m = table_find(table, "range_m"),
        .azimuth_rad = table_find(table, "azimuth_rad"),
        .azimuth_deg = table_find(table, "azimuth_deg"),
        .elevation_rad = table_find(table, "elevation_rad"),
        .elevation_deg = table_find(table, "elevation_deg"),
        .range_rate_mps = table_find(table, "range_rate_mps"),
        .sigma_range_m = table_find(table, "sigma_range_m"),
        .sigma_azimuth_rad = table_find(table, "sigma_azimuth_rad"),
        .sigma_elevation_rad = table_find(table, "sigma_elevation_rad"),
        .sigma_range_rate_mps = table_find(table, "sigma_range_rate_mps"),
        .sensor_x_m = table_find(table, "sensor_x_m"),
        .sensor_y_m = table_find(table, "sensor_y_m"),
        .sensor_z_m = table_find(table, "sensor_z_m"),
        .sector_from_rad = table_find(table, "sector_from_rad"),
        .sector_to_rad = table_find(table, "sector_to_rad"),
        .snr_db = table_find(table, "snr_db"),
    };
    check_not_both(table, columns.range_m, columns.x_m);
    check_not_both(table, columns.azimuth_rad, columns.azimuth_deg);
    check_not_both(table, columns.elevation_rad, columns.elevation_deg);
    if (is_polar && columns.azimuth_deg < 0) {
        (void)table_need(table, "azimuth_rad");
    }
    check_pair(table, columns.sensor_x_m, columns.sensor_y_m, "sensor_y_m", "sensor_x_m");
    check_pair(table, columns.sensor_y_m, columns.sensor_x_m, "sensor_x_m", "sensor_y_m");
    check_pair(table, columns.vx_mps, columns.vy_mps, "vy_mps", "vx_mps");
    check_pair(table, columns.vy_mps, columns.vx_mps, "vx_mps", "vy_mps");
    check_pair(table, columns.sector_from_rad, columns.sector_to_rad, "sector_to_rad",
               "sector_from_rad");
    check_pair(table, columns.sector_to_rad, columns.sector_from_rad, "sector_from_rad",
               "sector_to_rad");
    return columns;
}

/* ---- Cells ---- */

static bool refuse(const struct checking *checking, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static bool refuse(const struct checking *checking, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(checking->reason, PLOT_ROW_REASON_BYTES, format, arguments);
    va_end(arguments);
    return false;
}

static bool refuse_cell(const struct checking *checking, int column, const char *why)
{
    const char *cell = table_cell(checking->table, checking->row, column);
    const char *name = checking->table->names[column];

    if (!*cell) {
        return refuse(checking, "%s is empty", name);
    }
    return refuse(checking, "%s '%.40s' %s", name, cell, why);
}

static bool is_there(const struct checking *checking, int column)
{
    return column >= 0 && *table_cell(checking->table, checking->row, column);
}

static bool read_float(const struct checking *checking, int column, float min, float max,
                       float *value)
{
    const char *cell = table_cell(checking->table, checking->row, column);
    double number;
    const char *why = table_number(cell, &number);

    if (why) {
        return refuse_cell(checking, column, why);
    }
    if (number < (double)min || number > (double)max) {
        return refuse(checking, "%s %.40s is outside %.9g .. %.9g", checking->table->names[column],
                      cell, (double)min, (double)max);
    }
    *value = (float)number;
    return true;
}

static bool read_position(const struct checking *checking, int column, float *value)
{
    return read_float(checking, column, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M, value);
}

static bool read_speed(const struct checking *checking, int column, float *value)
{
    return read_float(checking, column, -RHO_LIMIT_SPEED_MPS, RHO_LIMIT_SPEED_MPS, value);
}

/* ---- Rows ---- */

static bool read_velocity(const struct checking *checking, struct plot_row *row)
{
    const struct plot_columns *columns = checking->columns;
    bool has_vx = is_there(checking, columns->vx_mps), has_vy = is_there(checking, columns->vy_mps);
    bool has_vz = is_there(checking, columns->vz_mps);

    if (!has_vx && !has_vy && !has_vz) {
        return true;
    }
    if (!has_vx || !has_vy) {
        return refuse(checking, "%s is missing beside the other velocity",
                      has_vx ? "vy_mps" : "vx_mps");
    }
    if (!has_vz && (row->measures & RHO_MEASURES_Z)) {
        return refuse(checking, "vz_mps is missing beside z_m and vx_mps");
    }
    row->measures |= RHO_MEASURES_VELOCITY;
    return read_speed(checking, columns->vx_mps, &row->plot.vx_mps) &&
           read_speed(checking, columns->vy_mps, &row->plot.vy_mps) &&
           (!has_vz || read_speed(checking, columns->vz_mps, &row->plot.vz_mps));
}

/* A sigma: the row's own, else the sensor's, else the one for all. */
static bool read_sigma(const struct checking *checking, int column, double otherwise, float *value)
{
    if (is_there(checking, column)) {
        return read_float(checking, column, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX, value);
    }
    *value = (float)otherwise;
    return true;
}

/* A range rate, if the row has one, and its sigma. */
static bool read_range_rate(const struct checking *checking, const struct parameters *parameters,
                            int32_t sensor_id, uint32_t *measures, float *rate_mps,
                            float *sigma_mps)
{
    double otherwise = parameters_of_sensor(parameters, sensor_id, SENSOR_SIGMA_RANGE_RATE_MPS,
                                            parameters->value[PARAMETER_SIGMA_RANGE_RATE_MPS]);

    if (!is_there(checking, checking->columns->range_rate_mps)) {
        return true;
    }
    *measures |= RHO_MEASURES_RANGE_RATE;
    return read_speed(checking, checking->columns->range_rate_mps, rate_mps) &&
           read_sigma(checking, checking->columns->sigma_range_rate_mps, otherwise, sigma_mps);
}

static bool read_sigmas(const struct checking *checking, const struct parameters *parameters,
                        struct plot_row *row)
{
    double sigma_m = parameters_of_sensor(parameters, row->sensor_id, SENSOR_SIGMA_M,
                                          parameters->value[PARAMETER_SIGMA_M]);
    double sigma_mps = parameters_of_sensor(parameters, row->sensor_id, SENSOR_SIGMA_MPS,
                                            parameters->value[PARAMETER_SIGMA_MPS]);
    struct rho_plot *plot = &row->plot;

    if (!read_sigma(checking, checking->columns->sigma_m, sigma_m, &plot->sigma_range_m) ||
        !read_sigma(checking, checking->columns->sigma_mps, sigma_mps, &plot->sigma_mps)) {
        return false;
    }
    plot->sigma_cross_m = plot->sigma_up_m = plot->sigma_range_m;
    return true;
}

static bool read_snr(const struct checking *checking, float *snr_db)
{
    int column = checking->columns->snr_db;

    return !is_there(checking, column) || read_float(checking, column, -1000.0f, 1000.0f, snr_db);
}

static bool read_plot(const struct checking *checking, const struct parameters *parameters,
                      struct plot_row *row)
{
    const struct plot_columns *columns = checking->columns;
    bool has_z = is_there(checking, columns->z_m);

    row->has_plot = true;
    if (!read_position(checking, columns->x_m, &row->plot.x_m) ||
        !read_position(checking, columns->y_m, &row->plot.y_m) ||
        (has_z && !read_position(checking, columns->z_m, &row->plot.z_m))) {
        return false;
    }
    row->measures = has_z ? RHO_MEASURES_Z : 0;
    return read_velocity(checking, row) && read_sigmas(checking, parameters, row) &&
           read_range_rate(checking, parameters, row->sensor_id, &row->measures,
                           &row->plot.range_rate_mps, &row->plot.sigma_range_rate_mps) &&
           read_snr(checking, &row->plot.snr_db);
}

/* ---- Polar rows ---- */

#define DEG_RAD 0.017453292519943295
#define PI 3.141592653589793

static bool read_range(const struct checking *checking, float *range_m)
{
    int column = checking->columns->range_m;

    if (!read_float(checking, column, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M, range_m)) {
        return false;
    }
    return *range_m > 0.0f || refuse_cell(checking, column, "is not above 0");
}

/* Clockwise from north, in degrees, as counter-clockwise from east in radians. */
static float from_compass(float azimuth_deg)
{
    double azimuth_rad = PI / 2 - (double)azimuth_deg * DEG_RAD;

    return (float)remainder(azimuth_rad, 2 * PI);
}

static bool read_azimuth(const struct checking *checking, float *azimuth_rad)
{
    const struct plot_columns *columns = checking->columns;
    float azimuth_deg = 0.0f;

    if (columns->azimuth_deg < 0) {
        return read_float(checking, columns->azimuth_rad, -(float)PI, (float)PI, azimuth_rad);
    }
    if (!read_float(checking, columns->azimuth_deg, -360.0f, 360.0f, &azimuth_deg)) {
        return false;
    }
    *azimuth_rad = from_compass(azimuth_deg);
    return true;
}

static bool read_elevation(const struct checking *checking, uint32_t *measures,
                           float *elevation_rad)
{
    const struct plot_columns *columns = checking->columns;

    if (is_there(checking, columns->elevation_rad)) {
        *measures |= RHO_MEASURES_Z;
        return read_float(checking, columns->elevation_rad, -(float)(PI / 2), (float)(PI / 2),
                          elevation_rad);
    }
    if (is_there(checking, columns->elevation_deg)) {
        *measures |= RHO_MEASURES_Z;
        if (!read_float(checking, columns->elevation_deg, -90.0f, 90.0f, elevation_rad)) {
            return false;
        }
        *elevation_rad = (float)((double)*elevation_rad * DEG_RAD);
    }
    return true;
}

static bool read_sigma_rad(const struct checking *checking, int column, double otherwise,
                           float *value)
{
    if (is_there(checking, column)) {
        return read_float(checking, column, RHO_LIMIT_SIGMA_RAD_MIN, RHO_LIMIT_SIGMA_RAD_MAX,
                          value);
    }
    *value = (float)otherwise;
    return true;
}

static bool read_polar_sigmas(const struct checking *checking, const struct parameters *parameters,
                              int32_t sensor_id, struct rho_polar_plot *polar)
{
    const struct plot_columns *columns = checking->columns;
    const double *value = parameters->value;

    return read_sigma(checking, columns->sigma_range_m,
                      parameters_of_sensor(parameters, sensor_id, SENSOR_SIGMA_RANGE_M,
                                           value[PARAMETER_SIGMA_RANGE_M]),
                      &polar->sigma_range_m) &&
           read_sigma_rad(checking, columns->sigma_azimuth_rad,
                          parameters_of_sensor(parameters, sensor_id, SENSOR_SIGMA_AZIMUTH_RAD,
                                               value[PARAMETER_SIGMA_AZIMUTH_RAD]),
                          &polar->sigma_azimuth_rad) &&
           read_sigma_rad(checking, columns->sigma_elevation_rad,
                          parameters_of_sensor(parameters, sensor_id, SENSOR_SIGMA_ELEVATION_RAD,
                                               value[PARAMETER_SIGMA_ELEVATION_RAD]),
                          &polar->sigma_elevation_rad);
}

static bool read_polar(const struct checking *checking, const struct parameters *parameters,
                       struct plot_row *row)
{
    struct rho_polar_plot polar = {0};

    row->has_plot = true;
    row->measures = 0;
    if (!read_range(checking, &polar.range_m) || !read_azimuth(checking, &polar.azimuth_rad) ||
        !read_elevation(checking, &row->measures, &polar.elevation_rad) ||
        !read_polar_sigmas(checking, parameters, row->sensor_id, &polar) ||
        !read_range_rate(checking, parameters, row->sensor_id, &row->measures,
                         &polar.range_rate_mps, &polar.sigma_range_rate_mps) ||
        !read_snr(checking, &polar.snr_db)) {
        return false;
    }
    if (rho_measurement_from_polar(&polar, row->measures, &row->sensor, &row->plot) != RHO_OK) {
        return refuse(checking,
                      "range_m %.9g at azimuth %.9g rad is no place that is believed, "
                      "once the sensor's place and biases are taken into account",
                      (double)polar.range_m, (double)polar.azimuth_rad);
    }
    return true;
}

/* ---- Sensors ---- */

/*
 * The sensor as it was described, at the place that the row says. In a file with places every row describes it: an
 * empty cell means the place that was described, not that of the scan before.
 */
static bool read_sensor(const struct checking *checking, const struct parameters *parameters,
                        struct plot_row *row)
{
    const struct plot_columns *columns = checking->columns;
    bool has_place =
        is_there(checking, columns->sensor_x_m) || is_there(checking, columns->sensor_y_m);
    bool has_height = is_there(checking, columns->sensor_z_m);

    row->has_sensor = parameters_to_sensor(parameters, row->sensor_id, &row->sensor) ||
                      columns->sensor_x_m >= 0 || columns->sensor_z_m >= 0;
    parameters_to_any_sensor(parameters, row->sensor_id, &row->sensor);
    return (!has_place || (read_position(checking, columns->sensor_x_m, &row->sensor.x_m) &&
                           read_position(checking, columns->sensor_y_m, &row->sensor.y_m))) &&
           (!has_height || read_position(checking, columns->sensor_z_m, &row->sensor.z_m));
}

static bool read_sector(const struct checking *checking, struct plot_row *row)
{
    static const float turn = 6.2831855f;
    int from = checking->columns->sector_from_rad, to = checking->columns->sector_to_rad;

    if (!is_there(checking, from) && !is_there(checking, to)) {
        return true;
    }
    return read_float(checking, from, -turn, turn, &row->sector_from_rad) &&
           read_float(checking, to, -turn, turn, &row->sector_to_rad);
}

static bool read_key(const struct checking *checking, struct plot_row *row)
{
    const struct plot_columns *columns = checking->columns;
    const char *why;

    why = table_time_us(table_cell(checking->table, checking->row, columns->t_s), &row->time_us);
    if (why) {
        return refuse_cell(checking, columns->t_s, why);
    }
    why = table_int32(table_cell(checking->table, checking->row, columns->sensor_id),
                      &row->sensor_id);
    return why ? refuse_cell(checking, columns->sensor_id, why) : true;
}

bool plot_row_read(const struct table *table, const struct plot_columns *columns, size_t row,
                   const struct parameters *parameters, struct plot_row *plot_row,
                   char reason[PLOT_ROW_REASON_BYTES])
{
    struct checking checking = {.table = table, .columns = columns, .row = row};
    const int measured[] = {
        columns->x_m,           columns->y_m,           columns->z_m,
        columns->vx_mps,        columns->vy_mps,        columns->vz_mps,
        columns->range_m,       columns->azimuth_rad,   columns->azimuth_deg,
        columns->elevation_rad, columns->elevation_deg, columns->range_rate_mps};
    bool has_measurement = false;

    checking.reason = reason;
    *plot_row = (struct plot_row){.has_plot = false};
    if (!read_key(&checking, plot_row) || !read_sector(&checking, plot_row) ||
        !read_sensor(&checking, parameters, plot_row)) {
        return false;
    }
    for (size_t i = 0; i < sizeof measured / sizeof *measured; i++) {
        has_measurement |= is_there(&checking, measured[i]);
    }
    if (!has_measurement) {
        return true;
    }
    return columns->range_m >= 0 ? read_polar(&checking, parameters, plot_row)
                                 : read_plot(&checking, parameters, plot_row);
}
