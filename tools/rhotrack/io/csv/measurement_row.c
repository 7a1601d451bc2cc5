/* SPDX-License-Identifier: MIT */
#include "io/csv/measurement_row.h"

#include <math.h>

#include "io/csv/row_cells.h"
#include "io/csv/sensor_names.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/measurement.h"

/* A row being read and checked. */
struct row_reading {
    struct row_check cells;
    const struct measurement_columns *columns;
    const struct parameters *parameters;
};

static bool has_bearings_alone(const struct columns *columns)
{
    return columns->at[COL_BEARING_RAD] >= 0 && columns->at[COL_X_M] < 0 &&
           columns->at[COL_RANGE_M] < 0;
}

bool measurement_row_is_bearings(const struct table *table)
{
    const struct columns columns = columns_find(table);

    return has_bearings_alone(&columns);
}

static void check_bearing_columns(struct columns *columns, const struct parameters *parameters)
{
    /* Refuses plots by name, rather than with a missing bearing_rad. */
    static const struct {
        enum column_id column;
        const char *text;
    } others[] = {{COL_X_M, "plots, not bearings"}, {COL_RANGE_M, "polar plots, not bearings"}};

    for (size_t i = 0; columns->at[COL_BEARING_RAD] < 0 && i < sizeof others / sizeof *others;
         i++) {
        if (columns->at[others[i].column] >= 0) {
            table_fail_at_row(columns->table, TABLE_HEADER,
                              "%s (column '%s'): column 'bearing_rad' is missing", others[i].text,
                              column_name(others[i].column));
        }
    }
    columns_need_both(columns, COL_SECTOR_FROM_RAD, COL_SECTOR_TO_RAD);
    columns_refuse_two_units(columns, COL_ELEVATION_RAD);
    (void)columns_need(columns, COL_T_S);
    if (parameters->num_sensors != 1) {
        (void)columns_need(columns, COL_SENSOR_ID);
    }
    if (parameters->num_sensors == 0 && columns->at[COL_SENSOR_LAT_DEG] < 0) {
        (void)columns_need(columns, COL_SENSOR_X_M);
        (void)columns_need(columns, COL_SENSOR_Y_M);
    }
    columns_need_both(columns, COL_SENSOR_X_M, COL_SENSOR_Y_M);
    (void)columns_need(columns, COL_BEARING_RAD);
    columns->at[COL_RECEIVED_S] = -1;
}

static void leave_cartesian_columns(struct columns *columns)
{
    static const enum column_id cartesian[] = {COL_Y_M, COL_Z_M, COL_VX_MPS, COL_VY_MPS,
                                               COL_VZ_MPS};

    for (size_t i = 0; i < sizeof cartesian / sizeof *cartesian; i++) {
        columns->at[cartesian[i]] = -1;
    }
}

static void check_plot_columns(struct columns *columns, bool needs_sensor)
{
    const bool is_polar = columns->at[COL_RANGE_M] >= 0;

    if (has_bearings_alone(columns)) {
        table_fail_at_row(columns->table, TABLE_HEADER,
                          "bearings (column 'bearing_rad') cannot be read from a pipe; for plots, "
                          "columns 'x_m' and 'y_m' are missing");
    }
    (void)columns_need(columns, COL_T_S);
    if (needs_sensor) {
        (void)columns_need(columns, COL_SENSOR_ID);
    }
    if (!is_polar && columns->at[COL_LAT_DEG] < 0) {
        (void)columns_need(columns, COL_X_M);
        (void)columns_need(columns, COL_Y_M);
    }
    columns_refuse_both(columns, COL_RANGE_M, COL_X_M);
    columns_refuse_two_units(columns, COL_AZIMUTH_RAD);
    columns_refuse_two_units(columns, COL_ELEVATION_RAD);
    if (is_polar) {
        (void)columns_need(columns, COL_AZIMUTH_RAD);
        leave_cartesian_columns(columns);
    }
    columns_need_both(columns, COL_SENSOR_X_M, COL_SENSOR_Y_M);
    columns_need_both(columns, COL_VX_MPS, COL_VY_MPS);
    columns_need_both(columns, COL_SECTOR_FROM_RAD, COL_SECTOR_TO_RAD);
}

struct measurement_columns measurement_columns_find(const struct table *table,
                                                    const struct parameters *parameters,
                                                    enum record_kind kind, bool needs_sensor)
{
    struct measurement_columns columns = {.in_file = columns_find(table),
                                          .is_bearings = kind == RECORD_BEARINGS};

    if (columns.is_bearings) {
        check_bearing_columns(&columns.in_file, parameters);
    } else {
        check_plot_columns(&columns.in_file, needs_sensor && parameters->num_sensors > 1);
    }
    columns.geodetic = geodetic_open(table, parameters);
    return columns;
}

void measurement_columns_free(struct measurement_columns *columns)
{
    geodetic_close(columns->geodetic);
    columns->geodetic = NULL;
}

static bool read_speed(const struct row_reading *reading, enum column_id column, float *value)
{
    return row_read_float(&reading->cells, column, -RHO_LIMIT_SPEED_MPS, RHO_LIMIT_SPEED_MPS,
                          value);
}

static bool read_velocity(const struct row_reading *reading, struct measurement_row *row)
{
    bool has_vx = row_has_cell(&reading->cells, COL_VX_MPS),
         has_vy = row_has_cell(&reading->cells, COL_VY_MPS);
    bool has_vz = row_has_cell(&reading->cells, COL_VZ_MPS);

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
    return read_speed(reading, COL_VX_MPS, &row->plot.vx_mps) &&
           read_speed(reading, COL_VY_MPS, &row->plot.vy_mps) &&
           (!has_vz || read_speed(reading, COL_VZ_MPS, &row->plot.vz_mps));
}

/* Reads a sigma: the row's own, else `otherwise`, the sensor's or the common one. */
static bool read_sigma(const struct row_reading *reading, enum column_id column, double otherwise,
                       float *value)
{
    if (row_has_cell(&reading->cells, column)) {
        return row_read_float(&reading->cells, column, RHO_LIMIT_SIGMA_MIN, RHO_LIMIT_SIGMA_MAX,
                              value);
    }
    *value = (float)otherwise;
    return true;
}

/* A parameter of the sensor, else the common one. */
static double value_of_sensor(const struct row_reading *reading, int32_t sensor_id,
                              enum sensor_parameter_id own, enum parameter_id common)
{
    return parameters_value_of_sensor(reading->parameters, sensor_id, own,
                                      reading->parameters->value[common]);
}

/* Reads a range rate, if the row has one, and its sigma. */
static bool read_range_rate(const struct row_reading *reading, int32_t sensor_id,
                            uint32_t *measures, float *rate_mps, float *sigma_mps)
{
    if (!row_has_cell(&reading->cells, COL_RANGE_RATE_MPS)) {
        return true;
    }
    *measures |= RHO_MEASURES_RANGE_RATE;
    return read_speed(reading, COL_RANGE_RATE_MPS, rate_mps) &&
           read_sigma(reading, COL_SIGMA_RANGE_RATE_MPS,
                      value_of_sensor(reading, sensor_id, SENSOR_SIGMA_RANGE_RATE_MPS,
                                      PARAMETER_SIGMA_RANGE_RATE_MPS),
                      sigma_mps);
}

static bool read_place(const struct row_reading *reading, struct rho_plot *plot, bool *has_z)
{
    if (geodetic_has_places(reading->columns->geodetic)) {
        double place_m[3];

        if (!geodetic_read_place(reading->columns->geodetic, &reading->cells, place_m, has_z)) {
            return false;
        }
        plot->x_m = (float)place_m[0];
        plot->y_m = (float)place_m[1];
        plot->z_m = (float)place_m[2];
        return true;
    }
    *has_z = row_has_cell(&reading->cells, COL_Z_M);
    return row_read_position(&reading->cells, COL_X_M, &plot->x_m) &&
           row_read_position(&reading->cells, COL_Y_M, &plot->y_m) &&
           (!*has_z || row_read_position(&reading->cells, COL_Z_M, &plot->z_m));
}

#define PI 3.141592653589793

static bool read_range(const struct row_reading *reading, float *range_m)
{
    return row_read_position(&reading->cells, COL_RANGE_M, range_m) &&
           (*range_m > 0.0f || row_refuse_cell(&reading->cells, COL_RANGE_M, "is not above 0"));
}

/* Reads an azimuth or bearing. */
static bool read_azimuth(const struct row_reading *reading, enum column_id column,
                         float *azimuth_rad)
{
    if (!columns_has_degrees(&reading->columns->in_file, column)) {
        return row_read_and_wrap_angle_rad(&reading->cells, column, azimuth_rad);
    }
    if (!row_read_float(&reading->cells, column, -(float)ROW_ANGLE_MAX, (float)ROW_ANGLE_MAX,
                        azimuth_rad)) {
        return false;
    }
    *azimuth_rad = (float)column_radians(column, (double)*azimuth_rad);
    return true;
}

static bool read_elevation(const struct row_reading *reading, uint32_t *measures,
                           float *elevation_rad, float *azimuth_rad)
{
    const bool is_degrees = columns_has_degrees(&reading->columns->in_file, COL_ELEVATION_RAD);
    const float turn = is_degrees ? 180.0f : (float)PI;
    double folded_rad[2];

    if (!row_has_cell(&reading->cells, COL_ELEVATION_RAD)) {
        return true;
    }
    *measures |= RHO_MEASURES_Z;
    if (!row_read_float(&reading->cells, COL_ELEVATION_RAD, -0.5f * turn, turn, elevation_rad)) {
        return false;
    }
    if (is_degrees) {
        *elevation_rad = (float)column_radians(COL_ELEVATION_RAD, (double)*elevation_rad);
    }
    folded_rad[0] = (double)*elevation_rad;
    folded_rad[1] = (double)*azimuth_rad;
    columns_fold_over_zenith(&folded_rad[0], &folded_rad[1]);
    *elevation_rad = (float)folded_rad[0];
    *azimuth_rad = (float)folded_rad[1];
    return true;
}

static bool read_sigma_elevation(const struct row_reading *reading, int32_t sensor_id,
                                 float *sigma_rad)
{
    return row_read_sigma_rad(&reading->cells, COL_SIGMA_ELEVATION_RAD,
                              value_of_sensor(reading, sensor_id, SENSOR_SIGMA_ELEVATION_RAD,
                                              PARAMETER_SIGMA_ELEVATION_RAD),
                              sigma_rad);
}

static bool read_polar_sigmas(const struct row_reading *reading, int32_t sensor_id,
                              struct rho_polar_plot *polar)
{
    return read_sigma(
               reading, COL_SIGMA_RANGE_M,
               value_of_sensor(reading, sensor_id, SENSOR_SIGMA_RANGE_M, PARAMETER_SIGMA_RANGE_M),
               &polar->sigma_range_m) &&
           row_read_sigma_rad(&reading->cells, COL_SIGMA_AZIMUTH_RAD,
                              value_of_sensor(reading, sensor_id, SENSOR_SIGMA_AZIMUTH_RAD,
                                              PARAMETER_SIGMA_AZIMUTH_RAD),
                              &polar->sigma_azimuth_rad) &&
           read_sigma_elevation(reading, sensor_id, &polar->sigma_elevation_rad);
}

/* Whether the noise of a Cartesian plot is along and across the line of sight of its sensor. */
static bool has_polar_noise(const struct row_reading *reading, int32_t sensor_id)
{
    return !row_has_cell(&reading->cells, COL_SIGMA_M) &&
           ((row_has_cell(&reading->cells, COL_SIGMA_RANGE_M) &&
             row_has_cell(&reading->cells, COL_SIGMA_AZIMUTH_RAD)) ||
            parameters_states_polar_noise(reading->parameters, sensor_id));
}

/* Sets the sigmas of a Cartesian plot as those of the polar plot that it was made of. */
static bool read_sight_line_sigmas(const struct row_reading *reading, struct measurement_row *row)
{
    struct rho_plot *plot = &row->plot, noise;
    const double x_m = (double)plot->x_m - (double)row->sensor.x_m,
                 y_m = (double)plot->y_m - (double)row->sensor.y_m,
                 z_m = row->measures & RHO_MEASURES_Z ? (double)plot->z_m - (double)row->sensor.z_m
                                                      : 0.0;
    /* nearer than that there is no line of sight */
    struct rho_polar_plot polar = {
        .range_m = (float)fmax(hypot(hypot(x_m, y_m), z_m), (double)RHO_RANGE_LEAST_M),
        .elevation_rad = (float)atan2(z_m, hypot(x_m, y_m))};

    if (!read_polar_sigmas(reading, row->sensor_id, &polar)) {
        return false;
    }
    if (rho_measurement_from_polar(&polar, row->measures & RHO_MEASURES_Z, NULL, &noise) !=
        RHO_OK) {
        return row_refuse(&reading->cells, "the place is too far from the sensor");
    }
    plot->sigma_range_m = noise.sigma_range_m;
    plot->sigma_cross_m = noise.sigma_cross_m;
    plot->sigma_up_m = noise.sigma_up_m;
    return true;
}

static bool read_sigmas(const struct row_reading *reading, struct measurement_row *row)
{
    const int32_t id = row->sensor_id;
    struct rho_plot *plot = &row->plot;

    if (!read_sigma(reading, COL_SIGMA_MPS,
                    value_of_sensor(reading, id, SENSOR_SIGMA_MPS, PARAMETER_SIGMA_MPS),
                    &plot->sigma_mps)) {
        return false;
    }
    if (has_polar_noise(reading, id)) {
        return read_sight_line_sigmas(reading, row);
    }
    if (!read_sigma(reading, COL_SIGMA_M,
                    value_of_sensor(reading, id, SENSOR_SIGMA_M, PARAMETER_SIGMA_M),
                    &plot->sigma_range_m)) {
        return false;
    }
    plot->sigma_cross_m = plot->sigma_up_m = plot->sigma_range_m;
    return true;
}

static bool read_cartesian_plot(const struct row_reading *reading, struct measurement_row *row)
{
    bool has_z = false;

    row->has_measurement = true;
    if (!read_place(reading, &row->plot, &has_z)) {
        return false;
    }
    row->measures = has_z ? RHO_MEASURES_Z : 0;
    return read_velocity(reading, row) && read_sigmas(reading, row) &&
           read_range_rate(reading, row->sensor_id, &row->measures, &row->plot.range_rate_mps,
                           &row->plot.sigma_range_rate_mps) &&
           row_read_snr(&reading->cells, &row->plot.snr_db);
}

/*
 * Turns the radar's angles from its own level frame to the local frame; a target height in the row
 * gives the elevation.
 */
static bool convert_to_local_frame(const struct row_reading *reading,
                                   const struct measurement_row *row, uint32_t *measures,
                                   struct rho_polar_plot *polar)
{
    struct geodetic_polar seen = {
        .sensor_id = row->sensor_id,
        .frame = row->frame,
        .place_m = {(double)row->sensor.x_m, (double)row->sensor.y_m, (double)row->sensor.z_m},
        .look = {(double)polar->range_m, (double)polar->azimuth_rad, (double)polar->elevation_rad},
        .has_elevation = (*measures & RHO_MEASURES_Z) != 0,
        .sigma_range_m = (double)polar->sigma_range_m,
        .sigma_elevation_rad = (double)polar->sigma_elevation_rad};

    if (!geodetic_turn_polar(reading->columns->geodetic, &reading->cells, &seen)) {
        return false;
    }
    polar->azimuth_rad = (float)seen.look.azimuth_rad;
    polar->elevation_rad = (float)seen.look.elevation_rad;
    polar->sigma_elevation_rad = (float)seen.sigma_elevation_rad;
    *measures |= seen.has_elevation ? RHO_MEASURES_Z : 0;
    return true;
}

static bool read_polar_plot(const struct row_reading *reading, struct measurement_row *row)
{
    struct rho_polar_plot polar = {0};
    struct rho_sensor seen_from = row->sensor;

    seen_from.time_bias_s = 0.0f; /* the time bias is subtracted from the scan's time instead */
    row->has_measurement = true;
    row->measures = 0;
    if (!read_range(reading, &polar.range_m) ||
        !read_azimuth(reading, COL_AZIMUTH_RAD, &polar.azimuth_rad) ||
        !read_elevation(reading, &row->measures, &polar.elevation_rad, &polar.azimuth_rad) ||
        !read_polar_sigmas(reading, row->sensor_id, &polar) ||
        !convert_to_local_frame(reading, row, &row->measures, &polar) ||
        !read_range_rate(reading, row->sensor_id, &row->measures, &polar.range_rate_mps,
                         &polar.sigma_range_rate_mps) ||
        !row_read_snr(&reading->cells, &polar.snr_db)) {
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

/*
 * Sets the sensor's position from its radar frame, and turns the row's sector, which counts from
 * the radar's own east; sectors in the parameters have been turned already.
 */
static void set_radar_place(struct measurement_row *row)
{
    const double *place_m = radar_axes_place_m(row->frame);
    float turn_rad = (float)radar_axes_turn_rad(row->frame);

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
                                          struct measurement_row *row)
{
    const struct measurement_columns *columns = reading->columns;
    bool has_place = row_has_cell(&reading->cells, COL_SENSOR_X_M) ||
                     row_has_cell(&reading->cells, COL_SENSOR_Y_M);
    bool has_height = row_has_cell(&reading->cells, COL_SENSOR_Z_M);

    row->has_sensor = parameters_to_sensor(reading->parameters, row->sensor_id, &row->sensor) ||
                      columns->in_file.at[COL_SENSOR_X_M] >= 0 ||
                      columns->in_file.at[COL_SENSOR_Z_M] >= 0;
    parameters_sensor_or_default(reading->parameters, row->sensor_id, &row->sensor);
    row->bias_us = rho_measurement_time_bias_us(&row->sensor);
    if (!geodetic_radar_frame(columns->geodetic, &reading->cells, row->sensor_id, &row->frame)) {
        return false;
    }
    if (row->frame) {
        row->has_sensor = true;
        set_radar_place(row);
        return true;
    }
    return (!has_place || (row_read_position(&reading->cells, COL_SENSOR_X_M, &row->sensor.x_m) &&
                           row_read_position(&reading->cells, COL_SENSOR_Y_M, &row->sensor.y_m))) &&
           (!has_height || row_read_position(&reading->cells, COL_SENSOR_Z_M, &row->sensor.z_m));
}

/* The place of the sensor of bearings: in the row, else as it is described. */
static bool read_passive_place(const struct row_reading *reading, struct measurement_row *row)
{
    static const enum column_id columns[] = {COL_SENSOR_X_M, COL_SENSOR_Y_M, COL_SENSOR_Z_M};
    static const enum sensor_parameter_id ids[] = {SENSOR_X_M, SENSOR_Y_M, SENSOR_Z_M};
    const struct row_check *check = &reading->cells;
    float *const place_m[] = {&row->sensor.x_m, &row->sensor.y_m, &row->sensor.z_m};

    if (!geodetic_radar_frame(reading->columns->geodetic, check, row->sensor_id, &row->frame)) {
        return false;
    }
    for (int i = 0; i < 3 && !row->frame; i++) {
        const double told_m = parameters_value_of_sensor(reading->parameters, row->sensor_id,
                                                         ids[i], i < 2 ? (double)NAN : 0.0);

        if (row_has_cell(check, columns[i])) {
            if (!row_read_position(check, columns[i], place_m[i])) {
                return false;
            }
        } else if (isnan(told_m) && check->columns->at[columns[i]] >= 0 &&
                   reading->parameters->num_sensors == 0) {
            return row_refuse_cell(check, columns[i], "");
        } else if (isnan(told_m)) {
            return row_refuse(check,
                              "sensor_x_m, sensor_y_m are empty, and [sensor %d] has no place",
                              (int)row->sensor_id);
        } else {
            *place_m[i] = (float)told_m;
        }
    }
    return true;
}

static void turn_bearing_to_local_frame(struct measurement_row *row, uint32_t measures)
{
    struct radar_look look = {1.0, (double)row->bearing.bearing_rad,
                              (double)row->bearing.elevation_rad};

    radar_axes_look_to_common(row->frame, (measures & RHO_MEASURES_Z) != 0, &look);
    row->bearing.bearing_rad = (float)look.azimuth_rad;
    row->bearing.elevation_rad = (float)look.elevation_rad;
}

static bool read_bearing(const struct row_reading *reading, struct measurement_row *row)
{
    const struct row_check *check = &reading->cells;
    const double bias_rad = parameters_value_of_sensor(reading->parameters, row->sensor_id,
                                                       SENSOR_AZIMUTH_BIAS_RAD, 0.0);

    row->has_measurement = true;
    if (!read_azimuth(reading, COL_BEARING_RAD, &row->bearing.bearing_rad) ||
        !read_elevation(reading, &row->measures, &row->bearing.elevation_rad,
                        &row->bearing.bearing_rad) ||
        ((row->measures & RHO_MEASURES_Z) &&
         !read_sigma_elevation(reading, row->sensor_id, &row->bearing.sigma_elevation_rad))) {
        return false;
    }
    if (row->frame) {
        turn_bearing_to_local_frame(row, row->measures);
    }
    row->measures = 0; /* of bearings each says itself whether it has an elevation */
    /* the time bias is subtracted from the scan's time instead */
    if (bias_rad < 0.0 || bias_rad > 0.0) {
        row->bearing.bearing_rad = rho_angle_difference(row->bearing.bearing_rad, (float)bias_rad);
    }
    return row_read_sigma_rad(
               check, COL_SIGMA_RAD,
               value_of_sensor(reading, row->sensor_id, SENSOR_SIGMA_RAD, PARAMETER_SIGMA_RAD),
               &row->bearing.sigma_rad) &&
           row_read_snr(check, &row->bearing.snr_db);
}

static bool read_bearings_row(const struct row_reading *reading, struct measurement_row *row)
{
    const struct row_check *check = &reading->cells;

    if (!row_read_sector(check, &row->sector_from_rad, &row->sector_to_rad) ||
        !read_passive_place(reading, row)) {
        return false;
    }
    if (row->frame) {
        set_radar_place(row);
    }
    row->bias_us = parameters_time_bias_us(reading->parameters, row->sensor_id);
    return row_check_unbiased_time(check, row->time_us, row->bias_us) &&
           ((!row_has_cell(check, COL_BEARING_RAD) && !row_has_cell(check, COL_ELEVATION_RAD)) ||
            read_bearing(reading, row));
}

static bool has_plot(const struct row_check *check)
{
    static const enum column_id measured[] = {
        COL_X_M,     COL_Y_M,     COL_Z_M,         COL_VX_MPS,        COL_VY_MPS,
        COL_VZ_MPS,  COL_RANGE_M, COL_AZIMUTH_RAD, COL_ELEVATION_RAD, COL_RANGE_RATE_MPS,
        COL_LAT_DEG, COL_LON_DEG, COL_ALT_M};
    bool has_any = false;

    for (size_t i = 0; i < sizeof measured / sizeof *measured; i++) {
        has_any |= row_has_cell(check, measured[i]);
    }
    return has_any;
}

static bool read_plots_row(const struct row_reading *reading, struct measurement_row *row)
{
    const struct row_check *check = &reading->cells;

    if (!row_read_sector(check, &row->sector_from_rad, &row->sector_to_rad) ||
        !set_sensor_at_position_of_row(reading, row) ||
        !row_check_unbiased_time(check, row->time_us, row->bias_us)) {
        return false;
    }
    if (!has_plot(check)) {
        return true;
    }
    return reading->columns->in_file.at[COL_RANGE_M] >= 0 ? read_polar_plot(reading, row)
                                                          : read_cartesian_plot(reading, row);
}

bool measurement_row_read(const struct measurement_columns *columns, size_t row,
                          const struct parameters *parameters, struct measurement_row *record,
                          char reason[ROW_REASON_BYTES])
{
    struct row_reading reading = {.cells = {.columns = &columns->in_file, .row = row},
                                  .columns = columns,
                                  .parameters = parameters};

    reading.cells.reason = reason;
    *record = (struct measurement_row){.line = columns->in_file.table->lines[row]};
    record->sensor_id = parameters_lone_sensor_id(parameters);
    return row_read_time(&reading.cells, COL_T_S, &record->time_us) &&
           (columns->in_file.at[COL_SENSOR_ID] < 0 ||
            sensor_names_read(&reading.cells, parameters, &record->sensor_id)) &&
           row_read_received(&reading.cells, &record->received_us) &&
           row_read_scan_number(&reading.cells, &record->number) &&
           (columns->is_bearings ? read_bearings_row(&reading, record)
                                 : read_plots_row(&reading, record));
}
