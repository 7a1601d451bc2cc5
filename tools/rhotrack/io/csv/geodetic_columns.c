/* SPDX-License-Identifier: MIT */
#include "io/csv/geodetic_columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"

#define LON_MIN_DEG (-180.0)
#define LON_MAX_DEG 360.0
#define ALT_MIN_M (-1e4)
#define ALT_MAX_M 1e6

/* A radar's frame, kept while the radar does not move. */
struct kept_radar {
    int32_t sensor_id;
    bool has_own_north;
    double geodetic[3];
    struct radar_axes *frame;
};

/* What the columns of one table say, and the radars' frames. */
struct geodetic_columns {
    const struct parameters *parameters;
    struct local_frame *origin; /* frame of the origin; NULL until it is needed */
    bool is_polar, has_lat, has_sensor_lat;
    /* ring of frames: a further radar replaces the oldest one */
    struct kept_radar radars[RHO_MAX_SENSORS];
    size_t num_radars; /* number of radars ever kept */
};

/* Refuses columns that exclude each other. */
static void refuse_columns(const struct columns *columns, bool is_polar)
{
    static const enum column_id polar[][2] = {
        {COL_RANGE_M, COL_LAT_DEG}, {COL_RANGE_M, COL_LON_DEG}, {COL_ALT_M, COL_ELEVATION_RAD}};
    static const enum column_id places[][2] = {{COL_LAT_DEG, COL_X_M}, {COL_LAT_DEG, COL_Y_M},
                                               {COL_LAT_DEG, COL_Z_M}, {COL_LON_DEG, COL_X_M},
                                               {COL_LON_DEG, COL_Y_M}, {COL_LON_DEG, COL_Z_M}};
    static const enum column_id sensors[][2] = {{COL_SENSOR_LAT_DEG, COL_SENSOR_X_M},
                                                {COL_SENSOR_LAT_DEG, COL_SENSOR_Y_M},
                                                {COL_SENSOR_LAT_DEG, COL_SENSOR_Z_M},
                                                {COL_SENSOR_ALT_M, COL_SENSOR_Z_M}};

    for (size_t i = 0; is_polar && i < sizeof polar / sizeof *polar; i++) {
        columns_refuse_both(columns, polar[i][0], polar[i][1]);
    }
    for (size_t i = 0; !is_polar && i < sizeof places / sizeof *places; i++) {
        columns_refuse_both(columns, places[i][0], places[i][1]);
    }
    if (!is_polar) {
        columns_need_both(columns, COL_LAT_DEG, COL_LON_DEG);
    }
    if (!is_polar && columns->at[COL_LAT_DEG] < 0) {
        columns_need_both(columns, COL_LAT_DEG, COL_ALT_M);
    }
    for (size_t i = 0; i < sizeof sensors / sizeof *sensors; i++) {
        columns_refuse_both(columns, sensors[i][0], sensors[i][1]);
    }
    columns_need_both(columns, COL_SENSOR_LAT_DEG, COL_SENSOR_LON_DEG);
}

static void need_origin(const struct columns *columns, const struct parameters *parameters,
                        enum column_id column)
{
    if (!parameters_has_origin(parameters) && columns->at[column] >= 0) {
        table_fail_at_row(columns->table, TABLE_HEADER, "column '%s': %s", column_name(column),
                          parameters_no_origin);
    }
}

struct geodetic_columns *geodetic_open(const struct table *table,
                                       const struct parameters *parameters)
{
    const struct columns columns = columns_find(table);
    struct geodetic_columns *geodetic = must_calloc(1, sizeof *geodetic);

    *geodetic = (struct geodetic_columns){.parameters = parameters,
                                          .is_polar = columns.at[COL_RANGE_M] >= 0,
                                          .has_lat = columns.at[COL_LAT_DEG] >= 0,
                                          .has_sensor_lat = columns.at[COL_SENSOR_LAT_DEG] >= 0 ||
                                                            parameters->num_sensors > 0};
    refuse_columns(&columns, geodetic->is_polar);
    need_origin(&columns, parameters, COL_LAT_DEG);
    need_origin(&columns, parameters, COL_SENSOR_LAT_DEG);
    return geodetic;
}

void geodetic_close(struct geodetic_columns *geodetic)
{
    if (!geodetic) {
        return;
    }
    for (size_t i = 0; i < RHO_MAX_SENSORS; i++) {
        radar_axes_close(geodetic->radars[i].frame);
    }
    local_frame_close(geodetic->origin);
    free(geodetic);
}

/* Frame of the origin, made when a position first needs it, since PROJ starts slowly. */
static const struct local_frame *origin_frame(struct geodetic_columns *geodetic)
{
    if (!geodetic->origin) {
        geodetic->origin = parameters_open_local_frame(geodetic->parameters);
    }
    return geodetic->origin;
}

bool geodetic_has_places(const struct geodetic_columns *geodetic)
{
    return geodetic && !geodetic->is_polar && geodetic->has_lat;
}

bool geodetic_has_sensor_places(const struct geodetic_columns *geodetic)
{
    return geodetic && geodetic->has_sensor_lat;
}

/* Reads latitude, longitude, and height where the row has it; else the height stays as it was. */
static bool read_lat_lon_alt(const struct row_check *check, enum column_id lat_deg,
                             enum column_id lon_deg, enum column_id alt_m, double geodetic[3])
{
    return row_read_double(check, lat_deg, -90, 90, &geodetic[0]) &&
           row_read_double(check, lon_deg, LON_MIN_DEG, LON_MAX_DEG, &geodetic[1]) &&
           (!row_has_cell(check, alt_m) ||
            row_read_double(check, alt_m, ALT_MIN_M, ALT_MAX_M, &geodetic[2]));
}

static bool check_distance_to_origin(const struct row_check *check, enum column_id lat_deg,
                                     const double geodetic[3], const double place_m[3])
{
    double distance_m = hypot(hypot(place_m[0], place_m[1]), place_m[2]);

    return distance_m <= (double)RHO_LIMIT_POSITION_M ||
           row_refuse(check, "%s %.9g, %.9g is %.0f km from the origin, farther than %.0f km",
                      column_name(lat_deg), geodetic[0], geodetic[1], distance_m / 1000,
                      (double)RHO_LIMIT_POSITION_M / 1000);
}

bool geodetic_read_place(struct geodetic_columns *geodetic, const struct row_check *check,
                         double place_m[3], bool *has_alt)
{
    double on_earth[3] = {0, 0, geodetic->parameters->value[PARAMETER_ORIGIN_ALT_M]};

    *has_alt = row_has_cell(check, COL_ALT_M);
    if (!read_lat_lon_alt(check, COL_LAT_DEG, COL_LON_DEG, COL_ALT_M, on_earth)) {
        return false;
    }
    local_frame_to_local(origin_frame(geodetic), on_earth, place_m);
    if (!check_distance_to_origin(check, COL_LAT_DEG, on_earth, place_m)) {
        return false;
    }
    place_m[2] = *has_alt ? place_m[2] : 0.0;
    return true;
}

static struct kept_radar *find_radar_slot(struct geodetic_columns *geodetic, int32_t sensor_id,
                                          bool has_own_north)
{
    for (size_t i = 0; i < RHO_MAX_SENSORS; i++) {
        struct kept_radar *radar = &geodetic->radars[i];

        if (radar->frame && radar->sensor_id == sensor_id &&
            radar->has_own_north == has_own_north) {
            return radar;
        }
    }
    return &geodetic->radars[geodetic->num_radars++ % RHO_MAX_SENSORS];
}

static bool is_same_place(const double one[3], const double other[3])
{
    for (int i = 0; i < 3; i++) {
        if (one[i] < other[i] || one[i] > other[i]) {
            return false;
        }
    }
    return true;
}

/* The radar's frame; it is made anew where the slot is another radar's, or the radar has moved. */
static const struct radar_axes *get_or_make_radar_frame(struct geodetic_columns *geodetic,
                                                        int32_t sensor_id, bool has_own_north,
                                                        const double on_earth[3])
{
    struct kept_radar *radar = find_radar_slot(geodetic, sensor_id, has_own_north);

    if (!radar->frame || radar->sensor_id != sensor_id || radar->has_own_north != has_own_north ||
        !is_same_place(radar->geodetic, on_earth)) {
        radar_axes_close(radar->frame);
        radar->frame = radar_axes_open(origin_frame(geodetic), on_earth, has_own_north);
        radar->sensor_id = sensor_id;
        radar->has_own_north = has_own_north;
        memcpy(radar->geodetic, on_earth, sizeof radar->geodetic);
    }
    return radar->frame;
}

/*
 * Reads the radar's latitude, longitude and height from the row, else from the parameters. *is_said
 * is false where neither gives them.
 */
static bool find_radar_place(const struct geodetic_columns *geodetic, const struct row_check *check,
                             int32_t sensor_id, double on_earth[3], bool *is_said)
{
    const struct parameters *parameters = geodetic->parameters;
    bool has_known = parameters_sensor_geodetic(parameters, sensor_id, on_earth);

    *is_said = row_has_cell(check, COL_SENSOR_LAT_DEG) || row_has_cell(check, COL_SENSOR_LON_DEG);
    if (*is_said) {
        on_earth[2] = has_known ? on_earth[2] : parameters->value[PARAMETER_ORIGIN_ALT_M];
        return read_lat_lon_alt(check, COL_SENSOR_LAT_DEG, COL_SENSOR_LON_DEG, COL_SENSOR_ALT_M,
                                on_earth);
    }
    *is_said =
        has_known && !row_has_cell(check, COL_SENSOR_X_M) && !row_has_cell(check, COL_SENSOR_Y_M);
    if (*is_said && row_has_cell(check, COL_SENSOR_Z_M)) {
        return row_refuse(check, "sensor_z_m is given, but the sensor's place is in lat_deg and "
                                 "lon_deg; give sensor_alt_m instead");
    }
    if (*is_said && row_has_cell(check, COL_SENSOR_ALT_M)) {
        return row_read_double(check, COL_SENSOR_ALT_M, ALT_MIN_M, ALT_MAX_M, &on_earth[2]);
    }
    return *is_said || !row_has_cell(check, COL_SENSOR_ALT_M) ||
           row_refuse(
               check,
               "sensor_alt_m is given without sensor_lat_deg or the sensor's parameter lat_deg");
}

bool geodetic_radar_frame(struct geodetic_columns *geodetic, const struct row_check *check,
                          int32_t sensor_id, const struct radar_axes **frame)
{
    double on_earth[3] = {0, 0, 0};
    bool is_said = false;

    *frame = NULL;
    if (!find_radar_place(geodetic, check, sensor_id, on_earth, &is_said)) {
        return false;
    }
    if (is_said) {
        *frame = get_or_make_radar_frame(geodetic, sensor_id, true, on_earth);
    }
    return !is_said || check_distance_to_origin(check, COL_SENSOR_LAT_DEG, on_earth,
                                                radar_axes_place_m(*frame));
}

/* The radar's frame; with an origin also for a radar whose position is given in metres. */
static const struct radar_axes *frame_of_polar_plot(struct geodetic_columns *geodetic,
                                                    const struct geodetic_polar *polar)
{
    double on_earth[3];

    if (polar->frame || !parameters_has_origin(geodetic->parameters)) {
        return polar->frame;
    }
    local_frame_to_geodetic(origin_frame(geodetic), polar->place_m, on_earth);
    return get_or_make_radar_frame(geodetic, polar->sensor_id, false, on_earth);
}

static bool read_target_height(const struct geodetic_columns *geodetic,
                               const struct row_check *check, const struct geodetic_polar *polar,
                               struct radar_height *height)
{
    const struct parameters *parameters = geodetic->parameters;

    height->sigma_range_m = polar->sigma_range_m;
    height->sigma_alt_m = parameters_value_of_sensor(
        parameters, polar->sensor_id, SENSOR_SIGMA_ALT_M, parameters->value[PARAMETER_SIGMA_ALT_M]);
    return row_read_double(check, COL_ALT_M, ALT_MIN_M, ALT_MAX_M, &height->alt_m) &&
           (!row_has_cell(check, COL_SIGMA_ALT_M) ||
            row_read_double(check, COL_SIGMA_ALT_M, (double)RHO_LIMIT_SIGMA_MIN,
                            (double)RHO_LIMIT_SIGMA_MAX, &height->sigma_alt_m));
}

/*
 * Computes the elevation from the target's height and the range without its bias, since the bias is
 * subtracted from the range later.
 */
static bool set_elevation_from_height(struct geodetic_columns *geodetic,
                                      const struct row_check *check, struct geodetic_polar *polar)
{
    double range_m = polar->look.range_m;
    double bias_m = parameters_value_of_sensor(geodetic->parameters, polar->sensor_id,
                                               SENSOR_RANGE_BIAS_M, 0.0);
    struct radar_height height;

    if (!read_target_height(geodetic, check, polar, &height)) {
        return false;
    }
    polar->look.range_m -= bias_m;
    polar->has_elevation =
        polar->look.range_m > 0 &&
        radar_axes_height_elevation(frame_of_polar_plot(geodetic, polar), polar->place_m[2],
                                    &height, &polar->look, &polar->sigma_elevation_rad);
    polar->look.range_m = range_m;
    return polar->has_elevation ||
           row_refuse(check, "alt_m %.9g differs from the radar's height by more than range_m %.9g",
                      height.alt_m, range_m);
}

bool geodetic_turn_polar(struct geodetic_columns *geodetic, const struct row_check *check,
                         struct geodetic_polar *polar)
{
    if (row_has_cell(check, COL_ALT_M)) {
        return set_elevation_from_height(geodetic, check, polar);
    }
    if (polar->frame) {
        radar_axes_look_to_common(polar->frame, polar->has_elevation, &polar->look);
    }
    return true;
}
