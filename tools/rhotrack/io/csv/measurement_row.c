/* SPDX-License-Identifier: MIT */
#include "io/csv/measurement_row.h"

#include "io/csv/row_cells_read_and_check.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/measurement.h"

/* A row being read and checked. */
struct row_reading {
    struct row_check cells;
    const struct measurement_row_columns *columns;
};

/* ---- Columns ---- */

bool measurement_row_table_has_bearings(const struct table *table)
{
    return table_find_column(table, "bearing_rad") >= 0 && table_find_column(table, "x_m") < 0 &&
           table_find_column(table, "range_m") < 0;
}

/* Refuses bearings by name, rather than with a missing x_m. */
static void refuse_bearings_as_plots(const struct table *table)
{
    if (table_find_column(table, "x_m") < 0 && table_find_column(table, "range_m") < 0 &&
        table_find_column(table, "bearing_rad") >= 0) {
        table_fail_at_row(table, TABLE_HEADER,
                          "bearings (column 'bearing_rad') cannot be read from a pipe; for plots, "
                          "columns 'x_m' and 'y_m' are missing");
    }
}

static void check_not_both_columns(const struct table *table, int first, int second)
{
    if (first >= 0 && second >= 0) {
        table_fail_at_row(table, TABLE_HEADER, "columns '%s' and '%s' exclude each other",
                          table->names[first], table->names[second]);
    }
}

/* Refuses plots by name, rather than with a missing bearing_rad. */
static void refuse_plots_as_bearings(const struct table *table)
{
    static const char *const others[][2] = {{"x_m", "plots, not bearings"},
                                            {"range_m", "polar plots, not bearings"}};

    if (table_find_column(table, "bearing_rad") >= 0) {
        return;
    }
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        if (table_find_column(table, others[i][0]) >= 0) {
            table_fail_at_row(table, TABLE_HEADER,
                              "%s (column '%s'): column 'bearing_rad' is missing", others[i][1],
                              others[i][0]);
        }
    }
}

static struct measurement_row_columns find_bearing_columns(const struct table *table)
{
    refuse_plots_as_bearings(table);
    row_need_both_columns_or_neither(table, "sector_from_rad", "sector_to_rad");
    return (struct measurement_row_columns){
        .is_bearings = true,
        .t_s = table_need_column(table, "t_s"),
        .received_s = -1,
        .sensor_id = table_need_column(table, "sensor_id"),
        .sensor_x_m = table_need_column(table, "sensor_x_m"),
        .sensor_y_m = table_need_column(table, "sensor_y_m"),
        .bearing_rad = table_need_column(table, "bearing_rad"),
        .sigma_rad = table_find_column(table, "sigma_rad"),
        .sector_from_rad = table_find_column(table, "sector_from_rad"),
        .sector_to_rad = table_find_column(table, "sector_to_rad"),
        .snr_db = table_find_column(table, "snr_db"),
        .scan = table_find_column(table, "scan"),
        .epoch = table_find_column(table, "epoch"),
    };
}

static struct measurement_row_columns
find_plot_columns(const struct table *table, const struct parameters *parameters, bool needs_sensor)
{
    struct measurement_row_columns columns;
    bool is_polar, has_no_xy;

    refuse_bearings_as_plots(table);
    is_polar = table_find_column(table, "range_m") >= 0;
    has_no_xy = is_polar || table_find_column(table, "lat_deg") >= 0;
    columns = (struct measurement_row_columns){
        .t_s = table_need_column(table, "t_s"),
        .received_s = table_find_column(table, "received_s"),
        .sensor_id = needs_sensor && parameters->num_sensors > 0
                         ? table_need_column(table, "sensor_id")
                         : table_find_column(table, "sensor_id"),
        .x_m = has_no_xy ? table_find_column(table, "x_m") : table_need_column(table, "x_m"),
        .y_m = has_no_xy ? -1 : table_need_column(table, "y_m"),
        .z_m = is_polar ? -1 : table_find_column(table, "z_m"),
        .vx_mps = is_polar ? -1 : table_find_column(table, "vx_mps"),
        .vy_mps = is_polar ? -1 : table_find_column(table, "vy_mps"),
        .vz_mps = is_polar ? -1 : table_find_column(table, "vz_mps"),
        .sigma_m = table_find_column(table, "sigma_m"),
        .sigma_mps = table_find_column(table, "sigma_mps"),
        .range_m = table_find_column(table, "range_m"),
        .azimuth_rad = table_find_column(table, "azimuth_rad"),
        .azimuth_deg = table_find_column(table, "azimuth_deg"),
        .elevation_rad = table_find_column(table, "elevation_rad"),
        .elevation_deg = table_find_column(table, "elevation_deg"),
        .range_rate_mps = table_find_column(table, "range_rate_mps"),
        .sigma_range_m = table_find_column(table, "sigma_range_m"),
        .sigma_azimuth_rad = table_find_column(table, "sigma_azimuth_rad"),
        .sigma_elevation_rad = table_find_column(table, "sigma_elevation_rad"),
        .sigma_range_rate_mps = table_find_column(table, "sigma_range_rate_mps"),
        .sensor_x_m = table_find_column(table, "sensor_x_m"),
        .sensor_y_m = table_find_column(table, "sensor_y_m"),
        .sensor_z_m = table_find_column(table, "sensor_z_m"),
        .sector_from_rad = table_find_column(table, "sector_from_rad"),
        .sector_to_rad = table_find_column(table, "sector_to_rad"),
        .snr_db = table_find_column(table, "snr_db"),
        .scan = table_find_column(table, "scan"),
        .epoch = table_find_column(table, "epoch"),
    };
    check_not_both_columns(table, columns.range_m, columns.x_m);
    check_not_both_columns(table, columns.azimuth_rad, columns.azimuth_deg);
    check_not_both_columns(table, columns.elevation_rad, columns.elevation_deg);
    if (is_polar && columns.azimuth_deg < 0) {
        (void)table_need_column(table, "azimuth_rad");
    }
    row_need_both_columns_or_neither(table, "sensor_x_m", "sensor_y_m");
    row_need_both_columns_or_neither(table, "vx_mps", "vy_mps");
    row_need_both_columns_or_neither(table, "sector_from_rad", "sector_to_rad");
    columns.geodetic = geodetic_columns_open(table, parameters);
    return columns;
}

struct measurement_row_columns measurement_row_columns_find(const struct table *table,
                                                            const struct parameters *parameters,
                                                            enum record_kind kind,
                                                            bool needs_sensor)
{
    return kind == RECORD_BEARINGS ? find_bearing_columns(table)
                                   : find_plot_columns(table, parameters, needs_sensor);
}

void measurement_row_columns_free(struct measurement_row_columns *columns)
{
    geodetic_columns_close(columns->geodetic);
    columns->geodetic = NULL;
}

/* ---- Cells ---- */

static bool read_speed(const struct row_reading *reading, int column, float *value)
{
    return row_read_float(&reading->cells, column, -RHO_LIMIT_SPEED_MPS, RHO_LIMIT_SPEED_MPS,
                          value);
}

/* ---- Rows ---- */

static bool read_velocity(const struct row_reading *reading, struct measurement_row *row)
{
    const struct measurement_row_columns *columns = reading->columns;
    bool has_vx = row_has_cell(&reading->cells, columns->vx_mps),
         has_vy = row_has_cell(&reading->cells, columns->vy_mps);
    bool has_vz = row_has_cell(&reading->cells, columns->vz_mps);

    if (!has_vx && !has_vy && !has_vz) {
        return true;
    }
    if (!has_vx || !has_vy) {
        return row_refuse(&reading->cells, "%s is missing beside the other velocity",
                          has_vx ? "vy_mps" : "vx_mps");
    }
    if (!has_vz && (row->measures & RHO_MEASURES_Z)) {
        return row_refuse(&reading->cells, "vz_mps is missing beside z_m and vx_mps");
    }
    row->measures |= RHO_MEASURES_VELOCITY;
    return read_speed(reading, columns->vx_mps, &row->plot.vx_mps) &&
           read_speed(reading, columns->vy_mps, &row->plot.vy_mps) &&
           (!has_vz || read_speed(reading, columns->vz_mps, &row->plot.vz_mps));
}

/* Reads a sigma: the row's own, else `otherwise`, the sensor's or the common one. */
static bool read_sigma(const struct row_reading *reading, int column, double otherwise,
                       float *value)
{
    if (row_has_cell(&reading->cells, column)) {
        return row_read_float(&reading->cells, column, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX,
                              value);
    }
    *value = (float)otherwise;
    return true;
}

/* Reads a range rate, if the row has one, and its sigma. */
static bool read_range_rate(const struct row_reading *reading, const struct parameters *parameters,
                            int32_t sensor_id, uint32_t *measures, float *rate_mps,
                            float *sigma_mps)
{
    double otherwise =
        parameters_value_of_sensor(parameters, sensor_id, SENSOR_SIGMA_RANGE_RATE_MPS,
                                   parameters->value[PARAMETER_SIGMA_RANGE_RATE_MPS]);

    if (!row_has_cell(&reading->cells, reading->columns->range_rate_mps)) {
        return true;
    }
    *measures |= RHO_MEASURES_RANGE_RATE;
    return read_speed(reading, reading->columns->range_rate_mps, rate_mps) &&
           read_sigma(reading, reading->columns->sigma_range_rate_mps, otherwise, sigma_mps);
}

static bool read_sigmas(const struct row_reading *reading, const struct parameters *parameters,
                        struct measurement_row *row)
{
    double sigma_m = parameters_value_of_sensor(parameters, row->sensor_id, SENSOR_SIGMA_M,
                                                parameters->value[PARAMETER_SIGMA_M]);
    double sigma_mps = parameters_value_of_sensor(parameters, row->sensor_id, SENSOR_SIGMA_MPS,
                                                  parameters->value[PARAMETER_SIGMA_MPS]);
    struct rho_plot *plot = &row->plot;

    if (!read_sigma(reading, reading->columns->sigma_m, sigma_m, &plot->sigma_range_m) ||
        !read_sigma(reading, reading->columns->sigma_mps, sigma_mps, &plot->sigma_mps)) {
        return false;
    }
    plot->sigma_cross_m = plot->sigma_up_m = plot->sigma_range_m;
    return true;
}

static bool read_geodetic_place(const struct row_reading *reading, struct rho_plot *plot,
                                bool *has_z)
{
    double place_m[3];

    if (!geodetic_columns_read_place(reading->columns->geodetic, &reading->cells, place_m, has_z)) {
        return false;
    }
    plot->x_m = (float)place_m[0];
    plot->y_m = (float)place_m[1];
    plot->z_m = (float)place_m[2];
    return true;
}

static bool read_place(const struct row_reading *reading, struct rho_plot *plot, bool *has_z)
{
    const struct measurement_row_columns *columns = reading->columns;

    if (geodetic_columns_has_place_columns(columns->geodetic)) {
        return read_geodetic_place(reading, plot, has_z);
    }
    *has_z = row_has_cell(&reading->cells, columns->z_m);
    return row_read_position(&reading->cells, columns->x_m, &plot->x_m) &&
           row_read_position(&reading->cells, columns->y_m, &plot->y_m) &&
           (!*has_z || row_read_position(&reading->cells, columns->z_m, &plot->z_m));
}

static bool read_cartesian_plot(const struct row_reading *reading,
                                const struct parameters *parameters, struct measurement_row *row)
{
    bool has_z = false;

    row->has_measurement = true;
    if (!read_place(reading, &row->plot, &has_z)) {
        return false;
    }
    row->measures = has_z ? RHO_MEASURES_Z : 0;
    return read_velocity(reading, row) && read_sigmas(reading, parameters, row) &&
           read_range_rate(reading, parameters, row->sensor_id, &row->measures,
                           &row->plot.range_rate_mps, &row->plot.sigma_range_rate_mps) &&
           row_read_snr(&reading->cells, reading->columns->snr_db, &row->plot.snr_db);
}

/* ---- Polar rows ---- */

#define DEG_RAD 0.017453292519943295
#define PI 3.141592653589793

static bool read_range(const struct row_reading *reading, float *range_m)
{
    int column = reading->columns->range_m;

    if (!row_read_float(&reading->cells, column, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M,
                        range_m)) {
        return false;
    }
    return *range_m > 0.0f || row_refuse_cell(&reading->cells, column, "is not above 0");
}

static bool read_azimuth(const struct row_reading *reading, float *azimuth_rad)
{
    const struct measurement_row_columns *columns = reading->columns;
    float azimuth_deg = 0.0f;

    if (columns->azimuth_deg < 0) {
        return row_read_and_wrap_angle_rad(&reading->cells, columns->azimuth_rad, azimuth_rad);
    }
    if (!row_read_float(&reading->cells, columns->azimuth_deg, -(float)ROW_ANGLE_MAX,
                        (float)ROW_ANGLE_MAX, &azimuth_deg)) {
        return false;
    }
    *azimuth_rad = (float)row_radians_from_compass_deg((double)azimuth_deg);
    return true;
}

static bool read_elevation(const struct row_reading *reading, uint32_t *measures,
                           float *elevation_rad)
{
    const struct measurement_row_columns *columns = reading->columns;

    if (row_has_cell(&reading->cells, columns->elevation_rad)) {
        *measures |= RHO_MEASURES_Z;
        return row_read_float(&reading->cells, columns->elevation_rad, -(float)(PI / 2),
                              (float)(PI / 2), elevation_rad);
    }
    if (row_has_cell(&reading->cells, columns->elevation_deg)) {
        *measures |= RHO_MEASURES_Z;
        if (!row_read_float(&reading->cells, columns->elevation_deg, -90.0f, 90.0f,
                            elevation_rad)) {
            return false;
        }
        *elevation_rad = (float)((double)*elevation_rad * DEG_RAD);
    }
    return true;
}

static bool read_polar_sigmas(const struct row_reading *reading,
                              const struct parameters *parameters, int32_t sensor_id,
                              struct rho_polar_plot *polar)
{
    const struct measurement_row_columns *columns = reading->columns;
    const double *value = parameters->value;

    return read_sigma(reading, columns->sigma_range_m,
                      parameters_value_of_sensor(parameters, sensor_id, SENSOR_SIGMA_RANGE_M,
                                                 value[PARAMETER_SIGMA_RANGE_M]),
                      &polar->sigma_range_m) &&
           row_read_sigma_rad(&reading->cells, columns->sigma_azimuth_rad,
                              parameters_value_of_sensor(parameters, sensor_id,
                                                         SENSOR_SIGMA_AZIMUTH_RAD,
                                                         value[PARAMETER_SIGMA_AZIMUTH_RAD]),
                              &polar->sigma_azimuth_rad) &&
           row_read_sigma_rad(&reading->cells, columns->sigma_elevation_rad,
                              parameters_value_of_sensor(parameters, sensor_id,
                                                         SENSOR_SIGMA_ELEVATION_RAD,
                                                         value[PARAMETER_SIGMA_ELEVATION_RAD]),
                              &polar->sigma_elevation_rad);
}

/*
 * Turns the radar's angles from its own level frame to the local frame; a target height in the row
 * gives the elevation.
 */
static bool convert_to_local_frame(const struct row_reading *reading,
                                   const struct measurement_row *row, uint32_t *measures,
                                   struct rho_polar_plot *polar)
{
    struct geodetic_columns_polar seen = {
        .sensor_id = row->sensor_id,
        .frame = row->frame,
        .place_m = {(double)row->sensor.x_m, (double)row->sensor.y_m, (double)row->sensor.z_m},
        .look = {(double)polar->range_m, (double)polar->azimuth_rad, (double)polar->elevation_rad},
        .has_elevation = (*measures & RHO_MEASURES_Z) != 0,
        .sigma_range_m = (double)polar->sigma_range_m,
        .sigma_elevation_rad = (double)polar->sigma_elevation_rad};

    if (!geodetic_columns_turn_polar_to_local_frame(reading->columns->geodetic, &reading->cells,
                                                    &seen)) {
        return false;
    }
    polar->azimuth_rad = (float)seen.look.azimuth_rad;
    polar->elevation_rad = (float)seen.look.elevation_rad;
    polar->sigma_elevation_rad = (float)seen.sigma_elevation_rad;
    *measures |= seen.has_elevation ? RHO_MEASURES_Z : 0;
    return true;
}

static bool read_polar_plot(const struct row_reading *reading, const struct parameters *parameters,
                            struct measurement_row *row)
{
    struct rho_polar_plot polar = {0};
    struct rho_sensor seen_from = row->sensor;

    seen_from.time_bias_s = 0.0f; /* the time bias is subtracted from the scan's time instead */
    row->has_measurement = true;
    row->measures = 0;
    if (!read_range(reading, &polar.range_m) || !read_azimuth(reading, &polar.azimuth_rad) ||
        !read_elevation(reading, &row->measures, &polar.elevation_rad) ||
        !read_polar_sigmas(reading, parameters, row->sensor_id, &polar) ||
        !convert_to_local_frame(reading, row, &row->measures, &polar) ||
        !read_range_rate(reading, parameters, row->sensor_id, &row->measures, &polar.range_rate_mps,
                         &polar.sigma_range_rate_mps) ||
        !row_read_snr(&reading->cells, reading->columns->snr_db, &polar.snr_db)) {
        return false;
    }
    if (rho_measurement_from_polar(&polar, row->measures, &seen_from, &row->plot) != RHO_OK) {
        return row_refuse(&reading->cells,
                          "range_m %.9g at azimuth %.9g rad is not a valid position once the "
                          "sensor's place and biases are applied",
                          (double)polar.range_m, (double)polar.azimuth_rad);
    }
    return true;
}

/* ---- Sensors ---- */

/*
 * Sets the sensor's position from its radar frame, and turns the row's sector, which counts from
 * the radar's own east; sectors in the parameters have been turned already.
 */
static void set_radar_place_and_rotate_sector_to_local(struct measurement_row *row)
{
    const double *place_m = radar_axes_place_m(row->frame);
    float turn_rad = (float)radar_axes_turn_rad(row->frame);

    row->has_sensor = true;
    row->sensor.x_m = (float)place_m[0];
    row->sensor.y_m = (float)place_m[1];
    row->sensor.z_m = (float)place_m[2];
    if (row->sector_from_rad != 0.0f || row->sector_to_rad != 0.0f) {
        row->sector_from_rad = rho_angle_wrap(row->sector_from_rad + turn_rad);
        row->sector_to_rad = rho_angle_wrap(row->sector_to_rad + turn_rad);
    }
}

/*
 * Reads the sensor: its description in the parameters, at the position that the row gives. In a
 * file with positions every row gives one: an empty cell means the position in the parameters, not
 * that of the scan before.
 */
static bool set_sensor_at_position_of_row(const struct row_reading *reading,
                                          const struct parameters *parameters,
                                          struct measurement_row *row)
{
    const struct measurement_row_columns *columns = reading->columns;
    bool has_place = row_has_cell(&reading->cells, columns->sensor_x_m) ||
                     row_has_cell(&reading->cells, columns->sensor_y_m);
    bool has_height = row_has_cell(&reading->cells, columns->sensor_z_m);

    row->has_sensor = parameters_to_sensor(parameters, row->sensor_id, &row->sensor) ||
                      columns->sensor_x_m >= 0 || columns->sensor_z_m >= 0;
    parameters_to_sensor_or_defaults(parameters, row->sensor_id, &row->sensor);
    row->bias_us = rho_measurement_time_bias_us(&row->sensor);
    if (!geodetic_columns_find_radar_frame(columns->geodetic, &reading->cells, row->sensor_id,
                                           &row->frame)) {
        return false;
    }
    if (row->frame) {
        set_radar_place_and_rotate_sector_to_local(row);
        return true;
    }
    return (!has_place ||
            (row_read_position(&reading->cells, columns->sensor_x_m, &row->sensor.x_m) &&
             row_read_position(&reading->cells, columns->sensor_y_m, &row->sensor.y_m))) &&
           (!has_height ||
            row_read_position(&reading->cells, columns->sensor_z_m, &row->sensor.z_m));
}

/* ---- Bearings ---- */

/* Subtracts the sensor's azimuth bias; the time bias is subtracted from the scan's time. */
static void subtract_azimuth_bias_from_bearing(const struct parameters *parameters,
                                               struct measurement_row *row)
{
    double bias_rad =
        parameters_value_of_sensor(parameters, row->sensor_id, SENSOR_AZIMUTH_BIAS_RAD, 0.0);

    if (bias_rad < 0.0 || bias_rad > 0.0) {
        row->bearing.bearing_rad = rho_angle_difference(row->bearing.bearing_rad, (float)bias_rad);
    }
}

static bool read_bearing(const struct row_reading *reading, const struct parameters *parameters,
                         struct measurement_row *row)
{
    const struct row_check *check = &reading->cells;
    const struct measurement_row_columns *columns = reading->columns;
    double sigma_rad = parameters_value_of_sensor(parameters, row->sensor_id, SENSOR_SIGMA_RAD,
                                                  parameters->value[PARAMETER_SIGMA_RAD]);

    row->has_measurement = true;
    if (!row_read_and_wrap_angle_rad(check, columns->bearing_rad, &row->bearing.bearing_rad)) {
        return false;
    }
    subtract_azimuth_bias_from_bearing(parameters, row);
    return row_read_sigma_rad(check, columns->sigma_rad, sigma_rad, &row->bearing.sigma_rad) &&
           row_read_snr(check, columns->snr_db, &row->bearing.snr_db);
}

static bool read_bearings_row(const struct row_reading *reading,
                              const struct parameters *parameters, struct measurement_row *row)
{
    const struct row_check *check = &reading->cells;
    const struct measurement_row_columns *columns = reading->columns;

    if (!row_read_position(check, columns->sensor_x_m, &row->sensor.x_m) ||
        !row_read_position(check, columns->sensor_y_m, &row->sensor.y_m) ||
        !row_read_sector(check, columns->sector_from_rad, columns->sector_to_rad,
                         &row->sector_from_rad, &row->sector_to_rad)) {
        return false;
    }
    row->bias_us = parameters_time_bias_us(parameters, row->sensor_id);
    return row_check_unbiased_time(check, row->time_us, row->bias_us) &&
           (!row_has_cell(check, columns->bearing_rad) || read_bearing(reading, parameters, row));
}

/* ---- All ---- */

static bool has_plot(const struct row_reading *reading)
{
    const struct measurement_row_columns *columns = reading->columns;
    const int measured[] = {
        columns->x_m,           columns->y_m,           columns->z_m,
        columns->vx_mps,        columns->vy_mps,        columns->vz_mps,
        columns->range_m,       columns->azimuth_rad,   columns->azimuth_deg,
        columns->elevation_rad, columns->elevation_deg, columns->range_rate_mps};
    bool has_any = geodetic_columns_row_has_place(columns->geodetic, &reading->cells);

    for (size_t i = 0; i < sizeof measured / sizeof *measured; i++) {
        has_any |= row_has_cell(&reading->cells, measured[i]);
    }
    return has_any;
}

static bool read_plots_row(const struct row_reading *reading, const struct parameters *parameters,
                           struct measurement_row *row)
{
    const struct row_check *check = &reading->cells;
    const struct measurement_row_columns *columns = reading->columns;

    if (!row_read_sector(check, columns->sector_from_rad, columns->sector_to_rad,
                         &row->sector_from_rad, &row->sector_to_rad) ||
        !set_sensor_at_position_of_row(reading, parameters, row) ||
        !row_check_unbiased_time(check, row->time_us, row->bias_us)) {
        return false;
    }
    if (!has_plot(reading)) {
        return true;
    }
    return columns->range_m >= 0 ? read_polar_plot(reading, parameters, row)
                                 : read_cartesian_plot(reading, parameters, row);
}

bool measurement_row_read(const struct table *table, const struct measurement_row_columns *columns,
                          size_t row, const struct parameters *parameters,
                          struct measurement_row *record, char reason[ROW_REASON_BYTES])
{
    struct row_reading reading = {.cells = {.table = table, .row = row}, .columns = columns};

    reading.cells.reason = reason;
    *record = (struct measurement_row){.line = table->lines[row]};
    return row_read_time_and_sensor(&reading.cells, columns->t_s, columns->sensor_id,
                                    &record->time_us, &record->sensor_id) &&
           row_read_received(&reading.cells, columns->received_s, &record->received_us) &&
           row_read_scan_number(&reading.cells, columns->scan, columns->epoch, &record->number) &&
           (columns->is_bearings ? read_bearings_row(&reading, parameters, record)
                                 : read_plots_row(&reading, parameters, record));
}
