/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "chain.h"
#include "parameters.h"
#include "table.h"

static struct rho_feed_noise noise_of(const struct parameters *parameters, int32_t sensor_id)
{
    const double *value = parameters->value;

#define OF_SENSOR(id)                                                                              \
    (float)parameters_of_sensor(parameters, sensor_id, SENSOR_##id, value[PARAMETER_##id])
    return (struct rho_feed_noise){.sigma_m = OF_SENSOR(SIGMA_M),
                                   .sigma_mps = OF_SENSOR(SIGMA_MPS),
                                   .sigma_range_m = OF_SENSOR(SIGMA_RANGE_M),
                                   .sigma_azimuth_rad = OF_SENSOR(SIGMA_AZIMUTH_RAD),
                                   .sigma_elevation_rad = OF_SENSOR(SIGMA_ELEVATION_RAD),
                                   .sigma_range_rate_mps = OF_SENSOR(SIGMA_RANGE_RATE_MPS),
                                   .sigma_rad = OF_SENSOR(SIGMA_RAD)};
#undef OF_SENSOR
}

static struct rho_feed_sensor describe(const struct parameters *parameters, int32_t sensor_id)
{
    struct rho_feed_sensor known = {.noise = noise_of(parameters, sensor_id)};

    parameters_to_any_sensor(parameters, sensor_id, &known.sensor);
    return known;
}

bool parameters_allow(struct parameters *parameters, const char *value,
                      enum parameter_source source, char reason[PARAMETER_REASON_BYTES])
{
    static const char between[] = " \t,";
    int16_t allowed[RHO_MAX_SENSORS] = {0};
    uint16_t count = 0;
    int32_t sensor_id;

    for (value += strspn(value, between); *value; value += strspn(value, between)) {
        const int bytes = (int)strcspn(value, between);
        char digits[16];

        snprintf(digits, sizeof digits, "%.*s", bytes, value);
        if (bytes >= (int)sizeof digits || table_int32(digits, &sensor_id) ||
            sensor_id != (int16_t)sensor_id) {
            snprintf(reason, PARAMETER_REASON_BYTES,
                     "sensors_allowed '%.*s' is no number of a sensor", bytes < 60 ? bytes : 60,
                     value);
            return false;
        }
        if (count == RHO_MAX_SENSORS) {
            snprintf(reason, PARAMETER_REASON_BYTES, "sensors_allowed: more than %d sensors",
                     RHO_MAX_SENSORS);
            return false;
        }
        allowed[count++] = (int16_t)sensor_id;
        value += bytes;
    }
    if (source >= parameters->allowed_source) {
        memcpy(parameters->allowed, allowed, sizeof allowed);
        parameters->num_allowed = count;
        parameters->allowed_source = source;
    }
    return true;
}

/* A sensor that nobody described: one beyond those that can have messages. */
#define NO_SENSOR INT32_MAX

void parameters_to_feed(const struct parameters *parameters, struct rho_feed *feed)
{
    const double *value = parameters->value;
    struct rho_sensor any;
    struct rho_feed_config config = {
        .hold_us = llround(value[PARAMETER_HOLD_MS] * 1e3),
        .late_max_us = llround(value[PARAMETER_LATE_MAX_S] * 1e6),
        .jump_max_us = llround(value[PARAMETER_JUMP_MAX_S] * 1e6),
        .flood_per_s = (uint32_t)value[PARAMETER_FLOOD_PER_S],
        .follow_scans = (uint16_t)value[PARAMETER_FOLLOW_SCANS],
        .stranger_plots_per_s = (uint32_t)value[PARAMETER_STRANGER_PLOTS_PER_S],
        .num_allowed = parameters->num_allowed,
        .is_told = parameters_to_sensor(parameters, NO_SENSOR, &any),
        .other = describe(parameters, NO_SENSOR),
    };
    enum rho_status status;

    memcpy(config.allowed, parameters->allowed, sizeof config.allowed);
    status = rho_feed_init(feed, sizeof *feed, &config);

    for (size_t i = 0; i < parameters->num_sensors && status == RHO_OK; i++) {
        struct rho_feed_sensor known = describe(parameters, parameters->sensors[i].sensor_id);

        status = rho_feed_set_sensor(feed, &known);
    }
    must_succeed(status, "feed");
}
