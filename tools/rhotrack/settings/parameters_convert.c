/* SPDX-License-Identifier: MIT */
/* parameters_convert: converts parameters to the library's settings and configurations. */
#include <math.h>

#include "base/common.h"
#include "rhotrack/detail/measurement.h"
#include "settings/parameters.h"

/* Bounds of the learned factor on sigmas where no source stated the noise. */
#define UNSTATED_MIN 0.1f
#define UNSTATED_MAX 10.0f

#define INTERVAL_MIN_S 1e-3

/* Fields of struct rho_settings that equal the parameter of the same name. */
#define SAME_FIELDS(FIELD)                                                                         \
    FIELD(V_MIN_MPS, v_min_mps, float)                                                             \
    FIELD(V_MAX_MPS, v_max_mps, float)                                                             \
    FIELD(ACCEL_MAX_MPS2, accel_max_mps2, float)                                                   \
    FIELD(PD, pd, float)                                                                           \
    FIELD(SIGMA_RANGE_M, sigma_range_m, float)                                                     \
    FIELD(SIGMA_AZIMUTH_RAD, sigma_azimuth_rad, float)                                             \
    FIELD(SIGMA_ELEVATION_RAD, sigma_elevation_rad, float)                                         \
    FIELD(SIGMA_RANGE_RATE_MPS, sigma_range_rate_mps, float)                                       \
    FIELD(SIGMA_RAD, sigma_rad, float)                                                             \
    FIELD(RANGE_MIN_M, range_min_m, float)                                                         \
    FIELD(RANGE_MAX_M, range_max_m, float)                                                         \
    FIELD(FALSE_TRACKS_PER_HOUR, false_tracks_per_hour, float)                                     \
    FIELD(SCANS, scans, uint16_t)                                                                  \
    FIELD(MIN_SCANS, min_scans, uint16_t)                                                          \
    FIELD(COAST_SCANS_MAX, coast_scans_max, uint16_t)                                              \
    FIELD(STANDING, standing, uint32_t)                                                            \
    FIELD(WORK_MAX, work_max, uint32_t)

struct rho_settings parameters_to_settings(const struct parameters *parameters)
{
    const double *value = parameters->value;
    struct rho_settings settings;

    parameters_check_together(parameters);
    rho_settings_default(&settings);
#define TAKE(id, name, type) settings.name = (type)value[PARAMETER_##id];
    SAME_FIELDS(TAKE)
#undef TAKE
    settings.scan_interval_s =
        (float)fmax(value[PARAMETER_LATE_MAX_S] / PARAMETER_LATE_SCANS, INTERVAL_MIN_S);
    settings.area_is_fixed = parameters_has_value(parameters, PARAMETER_AREA_X_MIN_M);
    settings.area.x_min_m = (float)value[PARAMETER_AREA_X_MIN_M];
    settings.area.x_max_m = (float)value[PARAMETER_AREA_X_MAX_M];
    settings.area.y_min_m = (float)value[PARAMETER_AREA_Y_MIN_M];
    settings.area.y_max_m = (float)value[PARAMETER_AREA_Y_MAX_M];
    return settings;
}

/* True where, with these settings, each sensor's smallest range is below its largest. */
static bool are_sensor_ranges_valid(const struct parameters *parameters,
                                    const struct rho_settings *settings)
{
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        const int32_t id = parameters->sensors[i].sensor_id;

        if (parameters_value_of_sensor(parameters, id, SENSOR_RANGE_MIN_M,
                                       (double)settings->range_min_m) >=
            parameters_value_of_sensor(parameters, id, SENSOR_RANGE_MAX_M,
                                       (double)settings->range_max_m)) {
            return false;
        }
    }
    return true;
}

bool parameters_adopt_settings(struct parameters *parameters, const struct rho_settings *settings)
{
    const struct rho_settings before = parameters_to_settings(parameters);
    const struct {
        enum parameter_id id;
        double before, value;
    } fields[] = {
#define CHANGE(id, name, type) {PARAMETER_##id, (double)before.name, (double)settings->name},
        SAME_FIELDS(CHANGE)
#undef CHANGE
            {PARAMETER_LATE_MAX_S, PARAMETER_LATE_SCANS * (double)before.scan_interval_s,
             fmin(PARAMETER_LATE_SCANS * (double)settings->scan_interval_s,
                  PARAMETER_LATE_LIMIT_S)},
    };

    if (!are_sensor_ranges_valid(parameters, settings)) {
        return false;
    }
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        if (fields[i].value < fields[i].before || fields[i].value > fields[i].before) {
            parameters->value[fields[i].id] = fields[i].value;
            parameters->source[fields[i].id] = SOURCE_SET;
        }
    }
    return true;
}

void parameters_to_initiator(const struct parameters *parameters,
                             struct rho_initiator_config *config)
{
    const double *value = parameters->value;
    const struct rho_settings settings = parameters_to_settings(parameters);

    rho_initiator_config_default(config);
    rho_settings_apply(&settings, NULL, config, NULL);
    config->process_noise_mps2 = (float)value[PARAMETER_PROCESS_NOISE_MPS2];
    if (parameters_has_value(parameters, PARAMETER_TURN_MPS2)) {
        config->turn_mps2 = (float)value[PARAMETER_TURN_MPS2];
    }
    if (parameters_has_value(parameters, PARAMETER_SCORE_MIN_NAT)) {
        config->score_min_nat = (float)value[PARAMETER_SCORE_MIN_NAT];
        config->false_tracks_per_hour = 0.0f;
    }
}

/*
 * Configuration of input estimation in the tracker. The process noise follows accel_max_mps2,
 * unless filter_noise_m or filter_noise_mps set the noise of a scan.
 */
static void parameters_to_input_config(const struct parameters *parameters,
                                       struct rho_input_config *config)
{
    const double *value = parameters->value;
    float accel_mps2 = 0.5f * (float)value[PARAMETER_ACCEL_MAX_MPS2];
    bool has_own_noise = parameters_has_value(parameters, PARAMETER_FILTER_NOISE_M) ||
                         parameters_has_value(parameters, PARAMETER_FILTER_NOISE_MPS);

    config->is_estimated = value[PARAMETER_INPUT_ESTIMATION] > 0.0;
    config->model = value[PARAMETER_INPUT_MODEL] > 0.0 ? RHO_INPUT_PHYSICAL : RHO_INPUT_LITERAL;
    config->gamma = (float)value[PARAMETER_GAMMA];
    config->sigma_mps2 = (float)value[PARAMETER_INPUT_SIGMA_MPS2];
    config->threshold = rho_input_threshold_sigmas((float)value[PARAMETER_ONSET_CONFIDENCE]);
    config->noise_density = has_own_noise ? 0.0f : accel_mps2 * accel_mps2;
    config->noise_m = has_own_noise ? (float)value[PARAMETER_FILTER_NOISE_M] : 0.0f;
    config->noise_mps = has_own_noise ? (float)value[PARAMETER_FILTER_NOISE_MPS] : 0.0f;
    config->velocity_variance = (float)(value[PARAMETER_V_MAX_MPS] * value[PARAMETER_V_MAX_MPS]);
    config->initial_variance = (float)value[PARAMETER_INITIAL_VARIANCE];
}

static bool is_parameter_set(const struct parameters *parameters, enum parameter_id id)
{
    return parameters->source[id] > SOURCE_DEFAULT;
}

bool parameters_states_polar_noise(const struct parameters *parameters, int32_t sensor_id)
{
    static const struct {
        enum sensor_parameter_id own;
        enum parameter_id common;
    } sigmas[] = {{SENSOR_SIGMA_M, PARAMETER_SIGMA_M},
                  {SENSOR_SIGMA_RANGE_M, PARAMETER_SIGMA_RANGE_M},
                  {SENSOR_SIGMA_AZIMUTH_RAD, PARAMETER_SIGMA_AZIMUTH_RAD}};
    bool states[3];

    for (int i = 0; i < 3; i++) {
        states[i] = is_parameter_set(parameters, sigmas[i].common) ||
                    !isnan(parameters_value_of_sensor(parameters, sensor_id, sigmas[i].own, NAN));
    }
    return !states[0] && states[1] && states[2];
}

/* True where a source set the position noise, for all sensors or for one. */
static bool is_noise_stated(const struct parameters *parameters)
{
    static const enum parameter_id sigmas[] = {PARAMETER_SIGMA_M, PARAMETER_SIGMA_RANGE_M,
                                               PARAMETER_SIGMA_AZIMUTH_RAD};
    bool says = false;

    for (size_t i = 0; i < sizeof sigmas / sizeof *sigmas; i++) {
        says |= is_parameter_set(parameters, sigmas[i]) &&
                parameters->source[sigmas[i]] != SOURCE_PRESET; /* a kind's noise, not this one's */
    }
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        const int32_t id = parameters->sensors[i].sensor_id;

        says |= !isnan(parameters_value_of_sensor(parameters, id, SENSOR_SIGMA_M, NAN)) ||
                !isnan(parameters_value_of_sensor(parameters, id, SENSOR_SIGMA_RANGE_M, NAN)) ||
                !isnan(parameters_value_of_sensor(parameters, id, SENSOR_SIGMA_AZIMUTH_RAD, NAN));
    }
    return says;
}

/*
 * Sets the bounds of learned noise and pd. Wide bounds hold where the noise was not stated:
 * defaults may be far from the radar's true noise.
 */
static void set_learning_bounds(const struct parameters *parameters,
                                struct rho_tracker_config *config)
{
    const double *value = parameters->value;
    const bool says = is_noise_stated(parameters);

    config->learn_noise_min = says || is_parameter_set(parameters, PARAMETER_LEARN_NOISE_MIN)
                                  ? (float)value[PARAMETER_LEARN_NOISE_MIN]
                                  : UNSTATED_MIN;
    config->learn_noise_max = says || is_parameter_set(parameters, PARAMETER_LEARN_NOISE_MAX)
                                  ? (float)value[PARAMETER_LEARN_NOISE_MAX]
                                  : UNSTATED_MAX;
    config->learn_pd_min = (float)value[PARAMETER_LEARN_PD_MIN];
}

void parameters_to_tracker(const struct parameters *parameters, struct rho_tracker_config *config)
{
    const double *value = parameters->value;
    const struct rho_settings settings = parameters_to_settings(parameters);

    rho_tracker_config_default(config);
    rho_settings_apply(&settings, config, NULL, NULL);
    config->steady_s = (float)value[PARAMETER_STEADY_S];
    config->late_max_s = (float)value[PARAMETER_LATE_MAX_S];
    set_learning_bounds(parameters, config);
    config->gate = (uint8_t)value[PARAMETER_GATE];
    config->planes = (uint8_t)value[PARAMETER_PLANES];
    config->theta_cell_rad = (float)(value[PARAMETER_GATE_THETA_DEG] * (3.141592653589793 / 180.0));
    config->hough_window_m = (float)value[PARAMETER_GATE_WINDOW_M];
    parameters_to_input_config(parameters, &config->input);
}

double parameters_range_max_m(const struct parameters *parameters, int32_t sensor_id)
{
    return parameters_value_of_sensor(parameters, sensor_id, SENSOR_RANGE_MAX_M,
                                      parameters->value[PARAMETER_RANGE_MAX_M]);
}

/*
 * Rotates a sector from the sensor's own axes into the local frame. Equal ends (the whole circle)
 * stay equal.
 */
static void rotate_sector(struct rho_sensor *sensor, double turn_rad)
{
    const double turn = 6.283185307179586;

    if (turn_rad < 0 || turn_rad > 0) {
        sensor->sector_from_rad =
            (float)remainder((double)sensor->sector_from_rad + turn_rad, turn);
        sensor->sector_to_rad = (float)remainder((double)sensor->sector_to_rad + turn_rad, turn);
    }
}

void parameters_sensor_or_default(const struct parameters *parameters, int32_t sensor_id,
                                  struct rho_sensor *sensor)
{
    const double *value = parameters->value;
    double range_max_m = is_parameter_set(parameters, PARAMETER_RANGE_MAX_M)
                             ? value[PARAMETER_RANGE_MAX_M]
                             : 2.0 * (double)RHO_LIMIT_POSITION_M;

#define OF_SENSOR(id, otherwise)                                                                   \
    (float)parameters_value_of_sensor(parameters, sensor_id, id, otherwise)
    *sensor = (struct rho_sensor){
        .sensor_id = sensor_id,
        .x_m = OF_SENSOR(SENSOR_X_M, 0),
        .y_m = OF_SENSOR(SENSOR_Y_M, 0),
        .z_m = OF_SENSOR(SENSOR_Z_M, 0),
        .pd = OF_SENSOR(SENSOR_PD, value[PARAMETER_PD]),
        .range_min_m = OF_SENSOR(SENSOR_RANGE_MIN_M, value[PARAMETER_RANGE_MIN_M]),
        .range_max_m = OF_SENSOR(SENSOR_RANGE_MAX_M, range_max_m),
        .sector_from_rad = OF_SENSOR(SENSOR_SECTOR_FROM_RAD, 0),
        .sector_to_rad = OF_SENSOR(SENSOR_SECTOR_TO_RAD, 0),
        .range_bias_m = OF_SENSOR(SENSOR_RANGE_BIAS_M, 0),
        .azimuth_bias_rad = OF_SENSOR(SENSOR_AZIMUTH_BIAS_RAD, 0),
        .time_bias_s = OF_SENSOR(SENSOR_TIME_BIAS_S, 0),
        .range_rate_span_mps =
            OF_SENSOR(SENSOR_RANGE_RATE_SPAN_MPS, value[PARAMETER_RANGE_RATE_SPAN_MPS]),
        .notch_mps = OF_SENSOR(SENSOR_NOTCH_MPS, value[PARAMETER_NOTCH_MPS]),
        .blind_speed_mps = OF_SENSOR(SENSOR_BLIND_SPEED_MPS, value[PARAMETER_BLIND_SPEED_MPS]),
        .resolution_range_m =
            OF_SENSOR(SENSOR_RESOLUTION_RANGE_M, value[PARAMETER_RESOLUTION_RANGE_M]),
        .resolution_azimuth_rad =
            OF_SENSOR(SENSOR_RESOLUTION_AZIMUTH_RAD, value[PARAMETER_RESOLUTION_AZIMUTH_RAD]),
        .resolution_range_rate_mps =
            OF_SENSOR(SENSOR_RESOLUTION_RANGE_RATE_MPS, value[PARAMETER_RESOLUTION_RANGE_RATE_MPS]),
    };
#undef OF_SENSOR
    rotate_sector(sensor, parameters_convergence_rad(parameters, sensor_id));
}

int32_t parameters_time_bias_us(const struct parameters *parameters, int32_t sensor_id)
{
    const struct rho_sensor sensor = {.time_bias_s = (float)parameters_value_of_sensor(
                                          parameters, sensor_id, SENSOR_TIME_BIAS_S, 0.0)};

    return rho_measurement_time_bias_us(&sensor);
}

void parameters_time_bias_range_us(const struct parameters *parameters, int32_t *least_us,
                                   int32_t *largest_us)
{
    *least_us = *largest_us = 0;
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        int32_t bias_us = parameters_time_bias_us(parameters, parameters->sensors[i].sensor_id);

        *least_us = bias_us < *least_us ? bias_us : *least_us;
        *largest_us = bias_us > *largest_us ? bias_us : *largest_us;
    }
}

bool parameters_to_sensor(const struct parameters *parameters, int32_t sensor_id,
                          struct rho_sensor *sensor)
{
    if (!parameters_has_sensor(parameters, sensor_id) &&
        !is_parameter_set(parameters, PARAMETER_RANGE_MIN_M) &&
        !is_parameter_set(parameters, PARAMETER_RANGE_MAX_M) &&
        !(parameters->value[PARAMETER_RANGE_RATE_SPAN_MPS] > 0.0) &&
        !(parameters->value[PARAMETER_NOTCH_MPS] > 0.0) &&
        !(parameters->value[PARAMETER_RESOLUTION_RANGE_M] > 0.0) &&
        !(parameters->value[PARAMETER_RESOLUTION_AZIMUTH_RAD] > 0.0)) {
        return false;
    }
    parameters_sensor_or_default(parameters, sensor_id, sensor);
    return true;
}

void must_set_sensor(struct rho_tracker *tracker, const struct rho_sensor *sensor)
{
    const enum rho_status status = rho_tracker_set_sensor(tracker, sensor);

    if (status == RHO_ERROR_CAPACITY) {
        fail(EXIT_USAGE, "more than %d sensors with places or limits of their own",
             RHO_MAX_SENSORS);
    }
    must_succeed(status, "sensor");
}
