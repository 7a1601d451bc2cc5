/* SPDX-License-Identifier: MIT */
/* input_estimation_plot: updates filter and inputs with a plot, split into scalars. */
#include <stddef.h>

#include "input_sensitivity.h"
#include "rhotrack/detail/input_estimation.h"

/* Updates one axis with a position; opens a closed one. */
static enum rho_status update_axis(struct rho_input *input, const struct rho_input_config *config,
                                   int axis, float place_m, float variance)
{
    if (!rho_kalman_has_axis(&input->bare, axis)) {
        return rho_kalman_open_axis(&input->bare, axis, place_m, variance,
                                    config->velocity_variance);
    }
    return rho_input_update_element(input, config, axis, place_m, variance);
}

/*
 * Updates the first num_axes axes with a position along the line of sight, across it, and upwards:
 * the noise on these axes is independent. The axes are all open, or all closed, and then opened.
 */
static enum rho_status update_in_noise_frame(struct rho_input *input,
                                             const struct rho_input_config *config,
                                             const struct rho_measurement *seen, int num_axes)
{
    const float ca = seen->cos_azimuth, sa = seen->sin_azimuth;
    const int has_z = num_axes == NUM_AXES;
    const float ce = has_z ? seen->cos_elevation : 1.0f, se = has_z ? seen->sin_elevation : 0.0f;
    const float rows[NUM_AXES][NUM_STATES] = {
        {ce * ca, ce * sa, se}, {-sa, ca, 0.0f}, {-se * ca, -se * sa, ce}};
    enum rho_status status = RHO_OK;
    if (!rho_kalman_has_axis(&input->bare, RHO_X)) {
        return rho_kalman_update_position(&input->bare, seen, config->velocity_variance);
    }
    for (int k = 0; k < num_axes && status == RHO_OK; k++) {
        float innovation_m = 0.0f;
        for (int i = 0; i < num_axes; i++) {
            innovation_m += rows[k][i] * (seen->place_m[i] - input->bare.state[i]);
        }
        status = rho_input_update_row(input, config, rows[k], innovation_m, seen->variance_m2[k]);
    }
    return status;
}

static enum rho_status update_position(struct rho_input *input,
                                       const struct rho_input_config *config,
                                       const struct rho_measurement *seen)
{
    const int num_axes = seen->has_z ? NUM_AXES : 2;
    const int is_open = rho_kalman_has_axis(&input->bare, RHO_X);
    enum rho_status status = RHO_OK;
    if (!rho_are_finite(seen->place_m, (size_t)num_axes)) {
        return RHO_ERROR_VALUE;
    }
    if (seen->is_isotropic) {
        for (int axis = 0; axis < num_axes && status == RHO_OK; axis++) {
            status = update_axis(input, config, axis, seen->place_m[axis], seen->variance_m2[axis]);
        }
        return status;
    }
    if (is_open != rho_kalman_has_axis(&input->bare, RHO_Y)) {
        return RHO_ERROR_VALUE;
    }
    if (!seen->has_z || is_open == rho_kalman_has_axis(&input->bare, RHO_Z)) {
        return update_in_noise_frame(input, config, seen, num_axes);
    }
    /* only one of (x, y) and z is open: z is updated apart, as rho_kalman_update_position does */
    struct rho_measurement level = *seen;
    float covariance[6];
    rho_measurement_covariance(seen, covariance);
    level.variance_m2[0] = rho_measurement_ground_m2(seen);
    level.has_z = 0;
    status = update_in_noise_frame(input, config, &level, 2);
    return status == RHO_OK
               ? update_axis(input, config, RHO_Z, seen->place_m[2], covariance[RHO_ZZ])
               : status;
}

enum rho_status rho_input_update_position(struct rho_input *input,
                                          const struct rho_input_config *config,
                                          const struct rho_measurement *measurement)
{
    enum rho_status status;
    struct rho_input next = *input;
    if (config->is_estimated) {
        status = update_position(&next, config, measurement);
    } else {
        status = rho_kalman_update_position(&next.bare, measurement, config->velocity_variance);
    }
    if (status == RHO_OK) {
        *input = next;
    }
    return status;
}

/* Converts an innovation of the corrected estimate to that of the filter without input. */
static float bare_filter_innovation(const struct rho_input *input,
                                    const struct rho_kalman *corrected, const float row[NUM_STATES],
                                    float innovation)
{
    for (int i = 0; i < NUM_STATES; i++) {
        innovation += row[i] * (corrected->state[i] - input->bare.state[i]);
    }
    return innovation;
}

enum rho_status rho_input_update_range_rate(struct rho_input *input,
                                            const struct rho_input_config *config,
                                            const struct rho_sensor *sensor, float rate_mps,
                                            float variance)
{
    struct rho_kalman corrected;
    struct rho_kalman_row seen;
    rho_input_estimate(input, &corrected);
    if (!rho_kalman_linearise_rate(&corrected, sensor, rate_mps, variance, &seen) ||
        !rho_kalman_can_unfold(&corrected, sensor, &seen)) {
        return RHO_OK;
    }
    const float innovation_mps =
        bare_filter_innovation(input, &corrected, seen.row, seen.innovation);
    return rho_input_update_row(input, config, seen.row, innovation_mps, seen.variance);
}

enum rho_status rho_input_update_bearing(struct rho_input *input,
                                         const struct rho_input_config *config, float x_m,
                                         float y_m, float bearing_rad, float sigma_rad)
{
    struct rho_kalman corrected;
    struct rho_kalman_bearing seen;
    rho_input_estimate(input, &corrected);
    if (!rho_kalman_linearise_bearing(&corrected, x_m, y_m, bearing_rad, sigma_rad, &seen)) {
        return RHO_OK;
    }
    const float innovation_m = bare_filter_innovation(input, &corrected, seen.row, seen.off_m);
    return rho_input_update_row(input, config, seen.row, innovation_m, seen.variance_m2);
}

enum rho_status rho_input_update_slope(struct rho_input *input,
                                       const struct rho_input_config *config,
                                       const struct rho_slope *slope)
{
    struct rho_kalman corrected;
    struct rho_kalman_bearing seen;
    rho_input_estimate(input, &corrected);
    if (!rho_kalman_linearise_slope(&corrected, slope, &seen)) {
        return RHO_OK;
    }
    if (!rho_kalman_has_axis(&input->bare, RHO_Z)) {
        return rho_kalman_open_height(&input->bare, &seen, config->velocity_variance);
    }
    const float innovation_m = bare_filter_innovation(input, &corrected, seen.row, seen.off_m);
    return rho_input_update_row(input, config, seen.row, innovation_m, seen.variance_m2);
}
