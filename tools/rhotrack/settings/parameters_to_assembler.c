/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>

#include "base/common.h"
#include "settings/parameters.h"

static struct rho_scan_assembler_noise sensor_noise(const struct parameters *parameters,
                                                    int32_t sensor_id)
{
    const double *value = parameters->value;

#define OF_SENSOR(id)                                                                              \
    (float)parameters_value_of_sensor(parameters, sensor_id, SENSOR_##id, value[PARAMETER_##id])
    return (struct rho_scan_assembler_noise){.sigma_m = OF_SENSOR(SIGMA_M),
                                             .sigma_mps = OF_SENSOR(SIGMA_MPS),
                                             .sigma_range_m = OF_SENSOR(SIGMA_RANGE_M),
                                             .sigma_azimuth_rad = OF_SENSOR(SIGMA_AZIMUTH_RAD),
                                             .sigma_elevation_rad = OF_SENSOR(SIGMA_ELEVATION_RAD),
                                             .sigma_range_rate_mps =
                                                 OF_SENSOR(SIGMA_RANGE_RATE_MPS),
                                             .sigma_rad = OF_SENSOR(SIGMA_RAD)};
#undef OF_SENSOR
}

static struct rho_scan_assembler_sensor
assembler_sensor_of_parameters(const struct parameters *parameters, int32_t sensor_id)
{
    struct rho_scan_assembler_sensor known = {.noise = sensor_noise(parameters, sensor_id)};

    parameters_sensor_or_default(parameters, sensor_id, &known.sensor);
    return known;
}

/* Number of a sensor that no parameter mentions, outside the range of messages' sensor numbers. */
#define NO_SENSOR INT32_MAX

static enum rho_status set_sensors_of_assembler(const struct parameters *parameters,
                                                struct rho_scan_assembler *assembler)
{
    enum rho_status status = RHO_OK;

    for (size_t i = 0; i < parameters->num_sensors && status == RHO_OK; i++) {
        struct rho_scan_assembler_sensor known =
            assembler_sensor_of_parameters(parameters, parameters->sensors[i].sensor_id);

        status = rho_scan_assembler_set_sensor(assembler, &known);
    }
    return status;
}

void parameters_update_assembler(const struct parameters *parameters,
                                 struct rho_scan_assembler *assembler)
{
    struct rho_sensor any;

    assembler->config.gives_other = parameters_to_sensor(parameters, NO_SENSOR, &any);
    assembler->config.other = assembler_sensor_of_parameters(parameters, NO_SENSOR);
    must_succeed(set_sensors_of_assembler(parameters, assembler), "assembler");
}

void parameters_to_assembler(const struct parameters *parameters,
                             struct rho_scan_assembler *assembler)
{
    const double *value = parameters->value;
    struct rho_sensor any;
    struct rho_scan_assembler_config config = {
        .hold_us = llround(value[PARAMETER_HOLD_MS] * 1e3),
        .late_max_us = llround(value[PARAMETER_LATE_MAX_S] * 1e6),
        .jump_max_us = llround(value[PARAMETER_JUMP_MAX_S] * 1e6),
        .flood_per_s = (uint32_t)value[PARAMETER_FLOOD_PER_S],
        .follow_scans = (uint16_t)value[PARAMETER_FOLLOW_SCANS],
        .stranger_plots_per_s = (uint32_t)value[PARAMETER_STRANGER_PLOTS_PER_S],
        .num_allowed = parameters->num_allowed,
        .gives_other = parameters_to_sensor(parameters, NO_SENSOR, &any),
        .other = assembler_sensor_of_parameters(parameters, NO_SENSOR),
    };
    enum rho_status status;

    memcpy(config.allowed, parameters->allowed, sizeof config.allowed);
    status = rho_scan_assembler_init(assembler, sizeof *assembler, &config);
    must_succeed(status == RHO_OK ? set_sensors_of_assembler(parameters, assembler) : status,
                 "assembler");
}
