/* SPDX-License-Identifier: MIT */
/* What is measured updates the filter without input, and the inputs by what that leaves unexplained. */
#include <float.h>
#include <stddef.h>
#include <string.h>

#include "rhotrack/input.h"

#define NUM_AXES RHO_INPUT_AXES
#define NUM_STATES RHO_KALMAN_STATES

/* As in the filter: variances that something is taken off are raised by sixteen units of rounding. */
#define ROUNDING_ALLOWANCE (1.0f + 1.0f / 1048576.0f)

#define INPUT2_MAX 1.0e24f
#define SENSITIVITY2_MAX 1.0e24f

/* A scalar measurement, and how it is seen: P h, h P h^T + R, and its derivatives by the inputs, H N. */
struct sight {
    const float *row; /* NULL: an element of the state */
    int element;
    float value;    /* of an element */
    float noise;    /* R */
    float off;      /* measured minus predicted by the filter without input */
    float variance; /* h P h^T + R */
    float projected[NUM_STATES];
    float by_input[NUM_AXES];
};

static int is_zero(float v)
{
    return !(v < 0.0f || v > 0.0f);
}

static float noise_of(float variance)
{
    return variance < RHO_KALMAN_VARIANCE_MIN ? RHO_KALMAN_VARIANCE_MIN : variance;
}

static float at_least_floor(float variance)
{
    return variance > RHO_KALMAN_VARIANCE_MIN ? variance : RHO_KALMAN_VARIANCE_MIN;
}

static enum rho_status update_bare(struct rho_kalman *bare, const struct sight *sight)
{
    if (sight->row) {
        return rho_kalman_update_row(bare, sight->row, sight->off, sight->noise, NULL);
    }
    return rho_kalman_update(bare, sight->element, sight->value, sight->noise, NULL);
}

/* ---- recursive least squares, (11) and (12) --------------------------------------------------- */

/* M = (I - K H) N, a column. False where it is too large, or NaN. */
static int update_sensitivity(float m[NUM_STATES], const struct sight *sight, float by_input)
{
    const float factor = by_input / sight->variance;
    float size2 = 0.0f;

    for (int i = 0; i < NUM_STATES; i++) {
        m[i] -= factor * sight->projected[i];
        size2 += m[i] * m[i];
    }
    return size2 <= SENSITIVITY2_MAX;
}

/* The usual case: what was measured depends on the input of one axis, and that on no other's. */
static enum rho_status update_one(struct rho_input *input, const struct sight *sight, int a)
{
    const float v = input->variance[RHO_AT(a, a)], s = sight->by_input[a];
    const float variance = v * s * s + sight->variance;
    const float rest = sight->off - s * input->input_mps2[a];
    const float learned_mps2 = input->input_mps2[a] + v * s / variance * rest;
    float column[NUM_STATES];
    enum rho_status status;

    memcpy(column, input->sensitivity[a], sizeof column);
    if (!update_sensitivity(column, sight, s) || !(variance <= FLT_MAX) ||
        !(learned_mps2 * learned_mps2 <= INPUT2_MAX)) {
        return RHO_ERROR_VALUE;
    }
    status = update_bare(&input->bare, sight);
    if (status == RHO_OK) {
        memcpy(input->sensitivity[a], column, sizeof column);
        input->input_mps2[a] = learned_mps2;
        /* scaled, not differenced: no digit is lost */
        input->variance[RHO_AT(a, a)] = at_least_floor(v * (sight->variance / variance));
    }
    return status;
}

/* V and u. False where they are too large, or NaN. */
static int learn(struct rho_input *input, const struct sight *sight)
{
    float *v = input->variance, *u = input->input_mps2, vs[NUM_AXES];
    float variance = sight->variance, rest = sight->off;

    for (int a = 0; a < NUM_AXES; a++) {
        vs[a] = v[RHO_AT(a, 0)] * sight->by_input[0] + v[RHO_AT(a, 1)] * sight->by_input[1] +
                v[RHO_AT(a, 2)] * sight->by_input[2];
        variance += vs[a] * sight->by_input[a];
        rest -= sight->by_input[a] * u[a];
    }
    for (int a = 0; a < NUM_AXES; a++) {
        const float gain = vs[a] / variance;

        u[a] += gain * rest;
        for (int b = 0; b < a; b++) {
            v[RHO_AT(a, b)] -= gain * vs[b];
        }
        if (!is_zero(vs[a])) {
            v[RHO_AT(a, a)] = at_least_floor(v[RHO_AT(a, a)] * ROUNDING_ALLOWANCE - gain * vs[a]);
        }
    }
    return variance >= sight->variance && variance <= FLT_MAX &&
           u[0] * u[0] + u[1] * u[1] + u[2] * u[2] <= INPUT2_MAX;
}

static enum rho_status update_all(struct rho_input *input, const struct sight *sight)
{
    struct rho_input next = *input;
    enum rho_status status;

    if (!learn(&next, sight)) {
        return RHO_ERROR_VALUE;
    }
    for (int a = 0; a < NUM_AXES; a++) {
        if (!update_sensitivity(next.sensitivity[a], sight, sight->by_input[a])) {
            return RHO_ERROR_VALUE;
        }
    }
    status = update_bare(&next.bare, sight);
    if (status == RHO_OK) {
        *input = next;
    }
    return status;
}

/* Which input alone, correlated with no other, the measurement depends on; NUM_AXES: there is more to it. */
static int only_axis(const struct rho_input *input, const float by_input[NUM_AXES])
{
    const int x = !is_zero(by_input[0]), y = !is_zero(by_input[1]), z = !is_zero(by_input[2]);
    const int axis = x ? 0 : (y ? 1 : 2);
    const int b = (axis + 1) % NUM_AXES, c = (axis + 2) % NUM_AXES;

    if (x + y + z != 1 || !is_zero(input->variance[RHO_AT(axis, b)]) ||
        !is_zero(input->variance[RHO_AT(axis, c)])) {
        return NUM_AXES;
    }
    return axis;
}

static enum rho_status update(struct rho_input *input, const struct sight *sight)
{
    const float *s = sight->by_input;

    if (is_zero(s[0]) && is_zero(s[1]) && is_zero(s[2])) {
        return update_bare(&input->bare, sight);
    }
    const int axis = only_axis(input, s);
    return axis < NUM_AXES ? update_one(input, sight, axis) : update_all(input, sight);
}

/* ---- scalar measurements ---------------------------------------------------------------------- */

static enum rho_status update_element(struct rho_input *input, int element, float value,
                                      float variance)
{
    const struct rho_kalman *bare = &input->bare;
    struct sight sight;

    sight.row = NULL;
    sight.element = element;
    sight.value = value;
    sight.noise = variance;
    for (int i = 0; i < NUM_STATES; i++) {
        sight.projected[i] = bare->covariance[RHO_AT(element, i)];
    }
    for (int a = 0; a < NUM_AXES; a++) {
        sight.by_input[a] = input->sensitivity[a][element];
    }
    sight.variance = sight.projected[element] + noise_of(variance);
    sight.off = value - bare->state[element];
    return update(input, &sight);
}

static enum rho_status update_row(struct rho_input *input, const float row[6], float innovation,
                                  float variance)
{
    struct sight sight;

    sight.row = row;
    sight.element = 0;
    sight.value = 0.0f;
    sight.noise = variance;
    sight.variance =
        noise_of(variance) + rho_linalg_project6(input->bare.covariance, row, sight.projected);
    sight.off = innovation;
    for (int a = 0; a < NUM_AXES; a++) {
        sight.by_input[a] = 0.0f;
        for (int i = 0; i < NUM_STATES; i++) {
            sight.by_input[a] += row[i] * input->sensitivity[a][i];
        }
    }
    return update(input, &sight);
}

enum rho_status rho_input_update(struct rho_input *input, const struct rho_input_config *config,
                                 int element, float value, float variance)
{
    if (input == NULL || config == NULL) {
        return RHO_ERROR_NULL;
    }
    if (element < 0 || element >= NUM_STATES) {
        return RHO_ERROR_VALUE;
    }
    if (!config->is_estimated) {
        return rho_kalman_update(&input->bare, element, value, variance, NULL);
    }
    return update_element(input, element, value, variance);
}

enum rho_status rho_input_update_row(struct rho_input *input, const struct rho_input_config *config,
                                     const float row[6], float innovation, float variance)
{
    if (input == NULL || config == NULL || row == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!config->is_estimated) {
        return rho_kalman_update_row(&input->bare, row, innovation, variance, NULL);
    }
    return update_row(input, row, innovation, variance);
}

/* ---- positions -------------------------------------------------------------------------------- */

static enum rho_status measure_axis(struct rho_input *input, const struct rho_input_config *config,
                                    int axis, float place_m, float variance)
{
    if (!rho_kalman_is_open(&input->bare, axis)) {
        return rho_kalman_open_axis(&input->bare, axis, place_m, variance,
                                    config->velocity_variance);
    }
    return update_element(input, axis, place_m, variance);
}

/* Along the line of sight, across it, and upwards: the noise of each is its own. */
static enum rho_status measure_along(struct rho_input *input, const struct rho_measurement *seen,
                                     int num_axes)
{
    const float ca = seen->cos_azimuth, sa = seen->sin_azimuth;
    const int has_z = num_axes == NUM_AXES;
    const float ce = has_z ? seen->cos_elevation : 1.0f, se = has_z ? seen->sin_elevation : 0.0f;
    const float rows[NUM_AXES][NUM_STATES] = {
        {ce * ca, ce * sa, se}, {-sa, ca, 0.0f}, {-se * ca, -se * sa, ce}};
    enum rho_status status = RHO_OK;

    for (int k = 0; k < num_axes && status == RHO_OK; k++) {
        float off_m = 0.0f;
        for (int i = 0; i < num_axes; i++) {
            off_m += rows[k][i] * (seen->place_m[i] - input->bare.state[i]);
        }
        status = update_row(input, rows[k], off_m, seen->variance_m2[k]);
    }
    return status;
}

/* The first axes, all open or all closed. */
static enum rho_status measure_together(struct rho_input *input,
                                        const struct rho_input_config *config,
                                        const struct rho_measurement *seen, int num_axes)
{
    if (!rho_kalman_is_open(&input->bare, 0)) {
        return rho_kalman_update_position(&input->bare, seen, config->velocity_variance);
    }
    return measure_along(input, seen, num_axes);
}

/* x and y were measured before and z was not, or the other way round: as the filter does. */
static enum rho_status measure_apart(struct rho_input *input, const struct rho_input_config *config,
                                     const struct rho_measurement *seen)
{
    struct rho_measurement level = *seen;
    float covariance[6];
    enum rho_status status;

    rho_measurement_covariance(seen, covariance);
    level.variance_m2[0] = seen->cos_elevation * seen->cos_elevation * seen->variance_m2[0] +
                           seen->sin_elevation * seen->sin_elevation * seen->variance_m2[2];
    level.has_z = 0;
    status = measure_together(input, config, &level, 2);
    if (status == RHO_OK) {
        status = measure_axis(input, config, 2, seen->place_m[2], covariance[5]);
    }
    return status;
}

static int is_finite(float v)
{
    return v >= -FLT_MAX && v <= FLT_MAX;
}

static enum rho_status update_position(struct rho_input *input,
                                       const struct rho_input_config *config,
                                       const struct rho_measurement *seen)
{
    const int num_axes = seen->has_z ? NUM_AXES : 2;
    const int is_open = rho_kalman_is_open(&input->bare, 0);
    enum rho_status status = RHO_OK;

    for (int axis = 0; axis < num_axes; axis++) {
        if (!is_finite(seen->place_m[axis])) {
            return RHO_ERROR_VALUE;
        }
    }
    if (seen->is_isotropic) {
        for (int axis = 0; axis < num_axes && status == RHO_OK; axis++) {
            status =
                measure_axis(input, config, axis, seen->place_m[axis], seen->variance_m2[axis]);
        }
        return status;
    }
    if (is_open != rho_kalman_is_open(&input->bare, 1)) {
        return RHO_ERROR_VALUE;
    }
    if (seen->has_z && is_open != rho_kalman_is_open(&input->bare, 2)) {
        return measure_apart(input, config, seen);
    }
    return measure_together(input, config, seen, num_axes);
}

enum rho_status rho_input_update_position(struct rho_input *input,
                                          const struct rho_input_config *config,
                                          const struct rho_measurement *measurement)
{
    enum rho_status status;

    if (input == NULL || config == NULL || measurement == NULL) {
        return RHO_ERROR_NULL;
    }
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

/* ---- range rates and bearings ----------------------------------------------------------------- */

/* An innovation as the corrected estimate has it, as the filter without input would have it. */
static float without_input(const struct rho_input *input, const struct rho_kalman *corrected,
                           const float row[NUM_STATES], float innovation)
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

    if (input == NULL || config == NULL) {
        return RHO_ERROR_NULL;
    }
    rho_input_estimate(input, &corrected);
    if (!rho_kalman_see_range_rate(&corrected, sensor, rate_mps, variance, &seen)) {
        return RHO_OK;
    }
    const float off_mps = without_input(input, &corrected, seen.row, seen.innovation);
    return rho_input_update_row(input, config, seen.row, off_mps, seen.variance);
}

enum rho_status rho_input_update_bearing(struct rho_input *input,
                                         const struct rho_input_config *config, float x_m,
                                         float y_m, float bearing_rad, float sigma_rad)
{
    struct rho_kalman corrected;
    struct rho_kalman_bearing seen;

    if (input == NULL || config == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!is_finite(bearing_rad) || !(sigma_rad > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    rho_input_estimate(input, &corrected);
    if (!rho_kalman_see_bearing(&corrected, x_m, y_m, bearing_rad, sigma_rad, &seen)) {
        return RHO_OK;
    }
    const float off_m = without_input(input, &corrected, seen.row, seen.off_m);
    return rho_input_update_row(input, config, seen.row, off_m, seen.variance_m2);
}
