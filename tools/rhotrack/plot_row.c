/* SPDX-License-Identifier: MIT */
#include "plot_row.h"

#include <stdarg.h>
#include <stdio.h>

/* A row on its way through the checks. */
struct checking {
    const struct table *table;
    const struct plot_columns *columns;
    size_t row;
    char *reason;
};

/* ---- Columns ---- */

/* Other kinds of plot files have other columns: say so rather than that x_m is missing. */
static void check_kind(const struct table *table)
{
    static const char *const others[][2] = {
        {"range_m", "polar plots"}, {"bearing_rad", "bearings"}, {"lat_deg", "geographic plots"}};

    if (table_find(table, "x_m") >= 0) {
        return;
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (table_find(table, others[i][0]) >= 0) {
            table_fail(table, TABLE_HEADER,
                       "%s (column '%s'): this version reads Cartesian plots, columns 'x_m' and "
                       "'y_m' are missing",
                       others[i][1], others[i][0]);
        }
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

    check_kind(table);
    columns = (struct plot_columns){
        .t_s = table_need(table, "t_s"),
        .sensor_id = table_need(table, "sensor_id"),
        .x_m = table_need(table, "x_m"),
        .y_m = table_need(table, "y_m"),
        .z_m = table_find(table, "z_m"),
        .vx_mps = table_find(table, "vx_mps"),
        .vy_mps = table_find(table, "vy_mps"),
        .vz_mps = table_find(table, "vz_mps"),
        .sigma_m = table_find(table, "sigma_m"),
        .sigma_mps = table_find(table, "sigma_mps"),
        .sector_from_rad = table_find(table, "sector_from_rad"),
        .sector_to_rad = table_find(table, "sector_to_rad"),
        .snr_db = table_find(table, "snr_db"),
    };
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
    plot->sigma_range_rate_mps = plot->sigma_mps;
    return true;
}

static bool read_snr(const struct checking *checking, struct plot_row *row)
{
    int column = checking->columns->snr_db;

    return !is_there(checking, column) ||
           read_float(checking, column, -1000.0f, 1000.0f, &row->plot.snr_db);
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
           read_snr(checking, row);
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
    const int measured[] = {columns->x_m,    columns->y_m,    columns->z_m,
                            columns->vx_mps, columns->vy_mps, columns->vz_mps};
    bool has_measurement = false;

    checking.reason = reason;
    *plot_row = (struct plot_row){.has_plot = false};
    if (!read_key(&checking, plot_row) || !read_sector(&checking, plot_row)) {
        return false;
    }
    for (size_t i = 0; i < sizeof measured / sizeof *measured; i++) {
        has_measurement |= is_there(&checking, measured[i]);
    }
    return !has_measurement || read_plot(&checking, parameters, plot_row);
}
