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

/* Columns of one table, as indices, -1 where it has no such column; and the radars' frames. */
struct geodetic_columns {
    const struct parameters *parameters;
    struct local_frame *origin; /* frame of the origin; NULL until it is needed */
    bool is_polar;
    int lat_deg, lon_deg, alt_m, sigma_alt_m;
    int sensor_x_m, sensor_y_m, sensor_z_m, sensor_lat_deg, sensor_lon_deg, sensor_alt_m;
    /* ring of frames: a further radar replaces the oldest one */
    struct kept_radar radars[RHO_MAX_SENSORS];
    size_t num_radars; /* number of radars ever kept */
};

/* ---- Columns ---- */

static void refuse_both_columns(const struct table *table, const char *first, const char *second)
{
    if (table_find_column(table, first) >= 0 && table_find_column(table, second) >= 0) {
        table_fail_at_row(table, TABLE_HEADER, "columns '%s' and '%s' exclude each other", first,
                          second);
    }
}

static void refuse_column_pairs(const struct table *table, const char *const (*pairs)[2],
                                size_t count)
{
    for (size_t i = 0; i < count; i++) {
        refuse_both_columns(table, pairs[i][0], pairs[i][1]);
    }
}

static void refuse_column_without(const struct table *table, const char *name, const char *other)
{
    if (table_find_column(table, name) >= 0 && table_find_column(table, other) < 0) {
        table_fail_at_row(table, TABLE_HEADER, "no column '%s' beside '%s'", other, name);
    }
}

static void refuse_range_beside_lat_alt_beside_elevation(const struct table *table)
{
    static const char *const pairs[][2] = {{"range_m", "lat_deg"},
                                           {"range_m", "lon_deg"},
                                           {"alt_m", "elevation_rad"},
                                           {"alt_m", "elevation_deg"}};

    refuse_column_pairs(table, pairs, sizeof pairs / sizeof *pairs);
}

static void refuse_conflicting_geodetic_place_columns(const struct table *table)
{
    static const char *const pairs[][2] = {{"lat_deg", "x_m"}, {"lat_deg", "y_m"},
                                           {"lat_deg", "z_m"}, {"lon_deg", "x_m"},
                                           {"lon_deg", "y_m"}, {"lon_deg", "z_m"}};

    refuse_column_pairs(table, pairs, sizeof pairs / sizeof *pairs);
    row_need_both_columns_or_neither(table, "lat_deg", "lon_deg");
    refuse_column_without(table, "alt_m", "lat_deg");
}

static void refuse_conflicting_sensor_place_columns(const struct table *table)
{
    static const char *const pairs[][2] = {{"sensor_lat_deg", "sensor_x_m"},
                                           {"sensor_lat_deg", "sensor_y_m"},
                                           {"sensor_lat_deg", "sensor_z_m"},
                                           {"sensor_alt_m", "sensor_z_m"}};

    refuse_column_pairs(table, pairs, sizeof pairs / sizeof *pairs);
    row_need_both_columns_or_neither(table, "sensor_lat_deg", "sensor_lon_deg");
}

static void need_origin(const struct table *table, const struct parameters *parameters,
                        const char *column)
{
    if (!parameters_has_origin(parameters) && table_find_column(table, column) >= 0) {
        table_fail_at_row(table, TABLE_HEADER, "column '%s': %s", column, parameters_no_origin);
    }
}

struct geodetic_columns *geodetic_columns_open(const struct table *table,
                                               const struct parameters *parameters)
{
    struct geodetic_columns *geodetic = must_calloc(1, sizeof *geodetic);

    *geodetic =
        (struct geodetic_columns){.parameters = parameters,
                                  .is_polar = table_find_column(table, "range_m") >= 0,
                                  .lat_deg = table_find_column(table, "lat_deg"),
                                  .lon_deg = table_find_column(table, "lon_deg"),
                                  .alt_m = table_find_column(table, "alt_m"),
                                  .sigma_alt_m = table_find_column(table, "sigma_alt_m"),
                                  .sensor_x_m = table_find_column(table, "sensor_x_m"),
                                  .sensor_y_m = table_find_column(table, "sensor_y_m"),
                                  .sensor_z_m = table_find_column(table, "sensor_z_m"),
                                  .sensor_lat_deg = table_find_column(table, "sensor_lat_deg"),
                                  .sensor_lon_deg = table_find_column(table, "sensor_lon_deg"),
                                  .sensor_alt_m = table_find_column(table, "sensor_alt_m")};
    if (geodetic->is_polar) {
        refuse_range_beside_lat_alt_beside_elevation(table);
    } else {
        refuse_conflicting_geodetic_place_columns(table);
    }
    refuse_conflicting_sensor_place_columns(table);
    need_origin(table, parameters, "lat_deg");
    need_origin(table, parameters, "sensor_lat_deg");
    return geodetic;
}

void geodetic_columns_close(struct geodetic_columns *geodetic)
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

bool geodetic_columns_has_place_columns(const struct geodetic_columns *geodetic)
{
    return geodetic && !geodetic->is_polar && geodetic->lat_deg >= 0;
}

/* ---- Cells ---- */

/* Reads latitude, longitude, and height where the row has it; else the height stays as it was. */
static bool read_lat_lon_alt(const struct row_check *check, int lat_deg, int lon_deg, int alt_m,
                             double geodetic[3])
{
    return row_read_double(check, lat_deg, -90, 90, &geodetic[0]) &&
           row_read_double(check, lon_deg, LON_MIN_DEG, LON_MAX_DEG, &geodetic[1]) &&
           (!row_has_cell(check, alt_m) ||
            row_read_double(check, alt_m, ALT_MIN_M, ALT_MAX_M, &geodetic[2]));
}

static bool check_distance_to_origin(const struct row_check *check, int lat_deg,
                                     const double geodetic[3], const double place_m[3])
{
    double distance_m = hypot(hypot(place_m[0], place_m[1]), place_m[2]);

    return distance_m <= (double)RHO_LIMIT_POSITION_M ||
           row_refuse(check, "%s %.9g, %.9g is %.0f km from the origin, farther than %.0f km",
                      check->table->names[lat_deg], geodetic[0], geodetic[1], distance_m / 1000,
                      (double)RHO_LIMIT_POSITION_M / 1000);
}

bool geodetic_columns_row_has_place(const struct geodetic_columns *geodetic,
                                    const struct row_check *check)
{
    return row_has_cell(check, geodetic->lat_deg) || row_has_cell(check, geodetic->lon_deg) ||
           row_has_cell(check, geodetic->alt_m);
}

bool geodetic_columns_read_place(struct geodetic_columns *geodetic, const struct row_check *check,
                                 double place_m[3], bool *has_alt)
{
    double on_earth[3] = {0, 0, geodetic->parameters->value[PARAMETER_ORIGIN_ALT_M]};

    *has_alt = row_has_cell(check, geodetic->alt_m);
    if (!read_lat_lon_alt(check, geodetic->lat_deg, geodetic->lon_deg, geodetic->alt_m, on_earth)) {
        return false;
    }
    local_frame_to_local(origin_frame(geodetic), on_earth, place_m);
    if (!check_distance_to_origin(check, geodetic->lat_deg, on_earth, place_m)) {
        return false;
    }
    place_m[2] = *has_alt ? place_m[2] : 0.0;
    return true;
}

/* ---- Radars ---- */

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
    bool has_known = parameters_geodetic_place_of_sensor(parameters, sensor_id, on_earth);

    *is_said = row_has_cell(check, geodetic->sensor_lat_deg) ||
               row_has_cell(check, geodetic->sensor_lon_deg);
    if (*is_said) {
        on_earth[2] = has_known ? on_earth[2] : parameters->value[PARAMETER_ORIGIN_ALT_M];
        return read_lat_lon_alt(check, geodetic->sensor_lat_deg, geodetic->sensor_lon_deg,
                                geodetic->sensor_alt_m, on_earth);
    }
    *is_said = has_known && !row_has_cell(check, geodetic->sensor_x_m) &&
               !row_has_cell(check, geodetic->sensor_y_m);
    if (*is_said && row_has_cell(check, geodetic->sensor_z_m)) {
        return row_refuse(check, "sensor_z_m is given, but the sensor's place is in lat_deg and "
                                 "lon_deg; give sensor_alt_m instead");
    }
    if (*is_said && row_has_cell(check, geodetic->sensor_alt_m)) {
        return row_read_double(check, geodetic->sensor_alt_m, ALT_MIN_M, ALT_MAX_M, &on_earth[2]);
    }
    return *is_said || !row_has_cell(check, geodetic->sensor_alt_m) ||
           row_refuse(
               check,
               "sensor_alt_m is given without sensor_lat_deg or the sensor's parameter lat_deg");
}

bool geodetic_columns_find_radar_frame(struct geodetic_columns *geodetic,
                                       const struct row_check *check, int32_t sensor_id,
                                       const struct radar_axes **frame)
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
    return !row_has_cell(check, geodetic->sensor_lat_deg) ||
           check_distance_to_origin(check, geodetic->sensor_lat_deg, on_earth,
                                    radar_axes_place_m(*frame));
}

/* ---- Polar plots ---- */

/* The radar's frame; with an origin also for a radar whose position is given in metres. */
static const struct radar_axes *frame_of_polar_plot(struct geodetic_columns *geodetic,
                                                    const struct geodetic_columns_polar *polar)
{
    double on_earth[3];

    if (polar->frame || !parameters_has_origin(geodetic->parameters)) {
        return polar->frame;
    }
    local_frame_to_geodetic(origin_frame(geodetic), polar->place_m, on_earth);
    return get_or_make_radar_frame(geodetic, polar->sensor_id, false, on_earth);
}

static bool read_target_height(const struct geodetic_columns *geodetic,
                               const struct row_check *check,
                               const struct geodetic_columns_polar *polar,
                               struct radar_height *height)
{
    const struct parameters *parameters = geodetic->parameters;

    height->sigma_range_m = polar->sigma_range_m;
    height->sigma_alt_m = parameters_value_of_sensor(
        parameters, polar->sensor_id, SENSOR_SIGMA_ALT_M, parameters->value[PARAMETER_SIGMA_ALT_M]);
    return row_read_double(check, geodetic->alt_m, ALT_MIN_M, ALT_MAX_M, &height->alt_m) &&
           (!row_has_cell(check, geodetic->sigma_alt_m) ||
            row_read_double(check, geodetic->sigma_alt_m, (double)RHO_LIMIT_SIGMA_MIN,
                            (double)RHO_LIMIT_SIGMA_MAX, &height->sigma_alt_m));
}

/*
 * Computes the elevation from the target's height and the range without its bias, since the bias is
 * subtracted from the range later.
 */
static bool set_elevation_from_height(struct geodetic_columns *geodetic,
                                      const struct row_check *check,
                                      struct geodetic_columns_polar *polar)
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
        radar_axes_elevation_from_height(frame_of_polar_plot(geodetic, polar), polar->place_m[2],
                                         &height, &polar->look, &polar->sigma_elevation_rad);
    polar->look.range_m = range_m;
    return polar->has_elevation ||
           row_refuse(check, "alt_m %.9g differs from the radar's height by more than range_m %.9g",
                      height.alt_m, range_m);
}

bool geodetic_columns_turn_polar_to_local_frame(struct geodetic_columns *geodetic,
                                                const struct row_check *check,
                                                struct geodetic_columns_polar *polar)
{
    if (row_has_cell(check, geodetic->alt_m)) {
        return set_elevation_from_height(geodetic, check, polar);
    }
    if (polar->frame) {
        radar_axes_look_to_common(polar->frame, polar->has_elevation, &polar->look);
    }
    return true;
}
