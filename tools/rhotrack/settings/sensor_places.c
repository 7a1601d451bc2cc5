/* SPDX-License-Identifier: MIT */
/*
 * sensor_places: the origin of the local frame, and sensors' places given as latitude
 * and longitude.
 */
#include <math.h>
#include <stddef.h>

#include "base/common.h"
#include "io/csv/local_frame.h"
#include "settings/parameters.h"

const char parameters_no_origin[] = "origin_lat_deg and origin_lon_deg are not set; they are the "
                                    "origin of the local frame (--set or --config)";

static bool is_sensor_value_set(const struct sensor_parameters *sensor, enum sensor_parameter_id id)
{
    return sensor->source[id] != SOURCE_UNSET;
}

static const struct sensor_parameters *find_sensor_on_earth(const struct parameters *parameters,
                                                            int32_t sensor_id)
{
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        const struct sensor_parameters *sensor = &parameters->sensors[i];

        if (sensor->sensor_id == sensor_id && is_sensor_value_set(sensor, SENSOR_LAT_DEG)) {
            return sensor;
        }
    }
    return NULL;
}

bool parameters_has_origin(const struct parameters *parameters)
{
    bool has_lat = parameters_has_value(parameters, PARAMETER_ORIGIN_LAT_DEG);
    bool has_lon = parameters_has_value(parameters, PARAMETER_ORIGIN_LON_DEG);

    if (has_lat != has_lon) {
        fail(EXIT_USAGE, "%s is set without %s", has_lat ? "origin_lat_deg" : "origin_lon_deg",
             has_lat ? "origin_lon_deg" : "origin_lat_deg");
    }
    return has_lat;
}

struct local_frame *parameters_open_local_frame(const struct parameters *parameters)
{
    const double *value = parameters->value;

    return local_frame_open(value[PARAMETER_ORIGIN_LAT_DEG], value[PARAMETER_ORIGIN_LON_DEG],
                            value[PARAMETER_ORIGIN_ALT_M]);
}

/*
 * True where a sensor has a place by latitude and longitude. Exit 2 where that is incomplete, given
 * in metres as well, or has no origin.
 */
static bool has_place_on_earth(const struct sensor_parameters *sensor, bool has_origin)
{
    bool has_lat = is_sensor_value_set(sensor, SENSOR_LAT_DEG),
         has_lon = is_sensor_value_set(sensor, SENSOR_LON_DEG);
    int id = (int)sensor->sensor_id;

    if (!has_lat && !has_lon && !is_sensor_value_set(sensor, SENSOR_ALT_M)) {
        return false;
    }
    if (!has_lat || !has_lon) {
        fail(EXIT_USAGE, "sensor %d: lat_deg, lon_deg and alt_m go together: %s is not set", id,
             has_lat ? "lon_deg" : "lat_deg");
    }
    if (is_sensor_value_set(sensor, SENSOR_X_M) || is_sensor_value_set(sensor, SENSOR_Y_M) ||
        is_sensor_value_set(sensor, SENSOR_Z_M)) {
        fail(EXIT_USAGE, "sensor %d: its place is given twice, in metres and by lat_deg, lon_deg",
             id);
    }
    if (!has_origin) {
        fail(EXIT_USAGE, "sensor %d: lat_deg and lon_deg: %s", id, parameters_no_origin);
    }
    return true;
}

static void set_place_value(struct sensor_parameters *sensor, enum sensor_parameter_id id,
                            double value)
{
    sensor->value[id] = value;
    sensor->source[id] = sensor->source[SENSOR_LAT_DEG];
}

static void locate_sensor(const struct parameters *parameters, const struct local_frame *origin,
                          struct sensor_parameters *sensor)
{
    double geodetic[3] = {0, 0, 0}, place_m[3];
    struct local_frame *own;

    parameters_sensor_geodetic(parameters, sensor->sensor_id, geodetic);
    local_frame_to_local(origin, geodetic, place_m);
    if (!(hypot(hypot(place_m[0], place_m[1]), place_m[2]) <= (double)RHO_LIMIT_POSITION_M)) {
        fail(EXIT_USAGE, "sensor %d: lat_deg and lon_deg are more than %.0f km from the origin",
             (int)sensor->sensor_id, (double)RHO_LIMIT_POSITION_M / 1000);
    }
    own = local_frame_open(geodetic[0], geodetic[1], geodetic[2]);
    sensor->turn_rad = local_frame_convergence_rad(own, origin);
    local_frame_close(own);
    set_place_value(sensor, SENSOR_X_M, place_m[0]);
    set_place_value(sensor, SENSOR_Y_M, place_m[1]);
    set_place_value(sensor, SENSOR_Z_M, place_m[2]);
}

void parameters_locate_sensors(struct parameters *parameters)
{
    const bool has_origin = parameters_has_origin(parameters);
    struct local_frame *origin = NULL;

    for (size_t i = 0; i < parameters->num_sensors; i++) {
        if (has_place_on_earth(&parameters->sensors[i], has_origin)) {
            origin = origin ? origin : parameters_open_local_frame(parameters);
            locate_sensor(parameters, origin, &parameters->sensors[i]);
        }
    }
    local_frame_close(origin);
}

bool parameters_sensor_geodetic(const struct parameters *parameters, int32_t sensor_id,
                                double geodetic[3])
{
    const struct sensor_parameters *sensor = find_sensor_on_earth(parameters, sensor_id);

    if (!sensor) {
        return false;
    }
    geodetic[0] = sensor->value[SENSOR_LAT_DEG];
    geodetic[1] = sensor->value[SENSOR_LON_DEG];
    geodetic[2] = is_sensor_value_set(sensor, SENSOR_ALT_M)
                      ? sensor->value[SENSOR_ALT_M]
                      : parameters->value[PARAMETER_ORIGIN_ALT_M];
    return true;
}

double parameters_convergence_rad(const struct parameters *parameters, int32_t sensor_id)
{
    const struct sensor_parameters *sensor = find_sensor_on_earth(parameters, sensor_id);

    return sensor ? sensor->turn_rad : 0.0;
}
