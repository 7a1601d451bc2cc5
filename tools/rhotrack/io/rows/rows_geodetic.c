/* SPDX-License-Identifier: MIT */
#include "io/rows/rows_geodetic.h"

#include <math.h>

#define TURN 6.283185307179586

struct rows_geodetic rows_geodetic_open(const struct table *table, const struct rows_kind *kind,
                                        const struct parameters *parameters)
{
    bool has_any = kind != &rows_kind_tracks;

    return (struct rows_geodetic){.kind = kind,
                                  .parameters = parameters,
                                  .geodetic = has_any ? geodetic_open(table, parameters) : NULL};
}

void rows_geodetic_close(struct rows_geodetic *geodetic)
{
    geodetic_close(geodetic->geodetic);
    geodetic->geodetic = NULL;
}

bool rows_geodetic_replaces(const struct rows_geodetic *geodetic, const struct rows_column *column)
{
    return column->id == COL_SENSOR_X_M || column->id == COL_SENSOR_Y_M
               ? geodetic_has_sensor_places(geodetic->geodetic)
               : geodetic_has_places(geodetic->geodetic) &&
                     (column->id == COL_X_M || column->id == COL_Y_M);
}

static double *cell_of(const struct rows_geodetic *geodetic, double *cells, enum column_id column)
{
    return &cells[rows_column_index(geodetic->kind, column)];
}

static void put_float_cell(const struct rows_geodetic *geodetic, double *cells,
                           enum column_id column, double value)
{
    *cell_of(geodetic, cells, column) = (double)(float)value;
}

static double cell_or(double cell, double otherwise)
{
    return rows_is_cell_empty(cell) ? otherwise : cell;
}

static bool fill_place_cells(const struct rows_geodetic *geodetic, const struct row_check *check,
                             double *cells)
{
    double place_m[3];
    bool has_alt;

    if (geodetic->kind->has_sensor && !row_has_cell(check, COL_LAT_DEG) &&
        !row_has_cell(check, COL_LON_DEG) && !row_has_cell(check, COL_ALT_M)) {
        return true; /* a scan without detections */
    }
    if (!geodetic_read_place(geodetic->geodetic, check, place_m, &has_alt)) {
        return false;
    }
    put_float_cell(geodetic, cells, COL_X_M, place_m[0]);
    put_float_cell(geodetic, cells, COL_Y_M, place_m[1]);
    if (has_alt) {
        put_float_cell(geodetic, cells, COL_Z_M, place_m[2]);
    }
    return true;
}

static void rotate_angle_cell(double *cell, double turn_rad)
{
    if (!rows_is_cell_empty(*cell)) {
        *cell = (double)(float)remainder(*cell + turn_rad, TURN);
    }
}

static struct geodetic_polar read_polar_cells(const struct rows_geodetic *geodetic,
                                              int32_t sensor_id, double *cells)
{
    const struct parameters *parameters = geodetic->parameters;
    double sigma_range_m = parameters_value_of_sensor(parameters, sensor_id, SENSOR_SIGMA_RANGE_M,
                                                      parameters->value[PARAMETER_SIGMA_RANGE_M]);
    double elevation_rad = *cell_of(geodetic, cells, COL_ELEVATION_RAD);

    return (struct geodetic_polar){
        .sensor_id = sensor_id,
        .place_m = {cell_or(*cell_of(geodetic, cells, COL_SENSOR_X_M), 0),
                    cell_or(*cell_of(geodetic, cells, COL_SENSOR_Y_M), 0),
                    cell_or(*cell_of(geodetic, cells, COL_SENSOR_Z_M), 0)},
        .look = {*cell_of(geodetic, cells, COL_RANGE_M), *cell_of(geodetic, cells, COL_AZIMUTH_RAD),
                 cell_or(elevation_rad, 0)},
        .has_elevation = !rows_is_cell_empty(elevation_rad),
        .sigma_range_m = cell_or(*cell_of(geodetic, cells, COL_SIGMA_RANGE_M), sigma_range_m)};
}

/*
 * Whether range and angles are in range for the conversion to the local frame. Empty cells, and
 * cells out of range, are refused later, as in any file.
 */
static bool are_range_and_angles_in_limits(const struct geodetic_polar *polar)
{
    const double half_turn = (double)3.1415927f; /* the float nearest to pi, as files may have it */

    return polar->look.range_m > 0 && fabs(polar->look.azimuth_rad) <= half_turn &&
           fabs(polar->look.elevation_rad) <= half_turn / 2;
}

/* Turns azimuth and elevation to the local frame. */
static bool turn_polar_cells(const struct rows_geodetic *geodetic, const struct row_check *check,
                             const struct radar_axes *frame, int32_t sensor_id, double *cells)
{
    struct geodetic_polar polar = read_polar_cells(geodetic, sensor_id, cells);
    bool had_elevation = polar.has_elevation;

    polar.frame = frame;
    if (!are_range_and_angles_in_limits(&polar)) {
        return true;
    }
    if (!geodetic_turn_polar(geodetic->geodetic, check, &polar)) {
        return false;
    }
    put_float_cell(geodetic, cells, COL_AZIMUTH_RAD, polar.look.azimuth_rad);
    if (polar.has_elevation) {
        put_float_cell(geodetic, cells, COL_ELEVATION_RAD, polar.look.elevation_rad);
    }
    if (polar.has_elevation && !had_elevation) {
        put_float_cell(geodetic, cells, COL_SIGMA_ELEVATION_RAD, polar.sigma_elevation_rad);
    }
    return true;
}

static void turn_bearing_cells(const struct rows_geodetic *geodetic, const struct radar_axes *frame,
                               double *cells)
{
    const double elevation_rad = *cell_of(geodetic, cells, COL_ELEVATION_RAD);
    const bool has_elevation = !rows_is_cell_empty(elevation_rad);
    struct radar_look look = {1.0, *cell_of(geodetic, cells, COL_BEARING_RAD),
                              has_elevation ? elevation_rad : 0.0};

    if (!rows_is_cell_empty(look.azimuth_rad)) {
        radar_axes_look_to_common(frame, has_elevation, &look);
        put_float_cell(geodetic, cells, COL_BEARING_RAD, look.azimuth_rad);
    }
    if (has_elevation) {
        put_float_cell(geodetic, cells, COL_ELEVATION_RAD, look.elevation_rad);
    }
}

bool rows_geodetic_fill_cells(const struct rows_geodetic *geodetic, const struct row_check *check,
                              int32_t sensor_id, double *cells)
{
    const struct radar_axes *frame = NULL;

    if (!geodetic->geodetic) {
        return true;
    }
    if (geodetic->kind->has_sensor &&
        !geodetic_radar_frame(geodetic->geodetic, check, sensor_id, &frame)) {
        return false;
    }
    if (frame) {
        /*
         * Sets the radar's position, and turns the sector, which counts from the radar's own east,
         * to the local frame.
         */
        const double *place_m = radar_axes_place_m(frame);

        rotate_angle_cell(cell_of(geodetic, cells, COL_SECTOR_FROM_RAD),
                          radar_axes_turn_rad(frame));
        rotate_angle_cell(cell_of(geodetic, cells, COL_SECTOR_TO_RAD), radar_axes_turn_rad(frame));
        if (geodetic->kind == &rows_kind_polar || geodetic->kind == &rows_kind_bearings) {
            put_float_cell(geodetic, cells, COL_SENSOR_X_M, place_m[0]);
            put_float_cell(geodetic, cells, COL_SENSOR_Y_M, place_m[1]);
            put_float_cell(geodetic, cells, COL_SENSOR_Z_M, place_m[2]);
        }
    }
    if (frame && geodetic->kind == &rows_kind_bearings) {
        turn_bearing_cells(geodetic, frame, cells);
    }
    return geodetic->kind == &rows_kind_polar
               ? turn_polar_cells(geodetic, check, frame, sensor_id, cells)
               : !geodetic_has_places(geodetic->geodetic) ||
                     fill_place_cells(geodetic, check, cells);
}
