/* SPDX-License-Identifier: MIT */
/* input_estimation_update: updates the filter without input, and the inputs, with a scalar. */
#include <float.h>
#include <stddef.h>

#include "input_sensitivity.h"
#include "rhotrack/detail/input_estimation.h"

/*
 * Limit of (s / S)^2 P_ii, s the sensitivity of element i: keeps the change of all sensitivities
 * within SQUARE_MAX, as a covariance with element i is at most sqrt(P_ii) times the largest sigma.
 */
#define MOVED2_MAX (SQUARE_MAX / RHO_VARIANCE_MAX)

/* A scalar measurement with row h: P h, h P h^T + R, and its derivatives H N by the inputs. */
struct scalar_measurement {
    const float *row; /* measured row h; NULL: an element of the state was measured */
    int element;
    float value;    /* measured value of the element */
    float noise;    /* R, variance of the noise */
    float off;      /* innovation: measured minus predicted by the filter without input */
    float variance; /* innovation variance h P h^T + R */
    float projected[NUM_STATES];
    float by_input[NUM_AXES];
};

/* Updates u and its covariance V, the paper's (11), (12). False where too large, or NaN. */
static int update_inputs(struct rho_input *input, const struct scalar_measurement *scalar)
{
    float *v = input->variance, *u = input->input_mps2, vs[NUM_AXES];
    float variance = scalar->variance, rest = scalar->off;
    for (int a = 0; a < NUM_AXES; a++) {
        vs[a] = v[RHO_AT(a, RHO_X)] * scalar->by_input[RHO_X] +
                v[RHO_AT(a, RHO_Y)] * scalar->by_input[RHO_Y] +
                v[RHO_AT(a, RHO_Z)] * scalar->by_input[RHO_Z];
        variance += vs[a] * scalar->by_input[a];
        rest -= scalar->by_input[a] * u[a];
    }
    for (int a = 0; a < NUM_AXES; a++) {
        const float gain = vs[a] / variance;
        u[a] += gain * rest;
        for (int b = 0; b < a; b++) {
            v[RHO_AT(a, b)] -= gain * vs[b];
        }
        if (!is_zero(vs[a])) {
            v[RHO_AT(a, a)] =
                rho_kalman_floored(v[RHO_AT(a, a)] * RHO_ROUNDING_ALLOWANCE - gain * vs[a]);
        }
    }
    return variance >= scalar->variance && variance <= FLT_MAX &&
           u[0] * u[0] + u[1] * u[1] + u[2] * u[2] <= SQUARE_MAX;
}

static enum rho_status update_all(struct rho_input *input, const struct scalar_measurement *scalar)
{
    struct rho_input next = *input;
    if (!update_inputs(&next, scalar)) {
        return RHO_ERROR_VALUE;
    }
    /* M = (I - K H) N, column by column; refused where one gets too large, or NaN */
    for (int a = 0; a < NUM_AXES; a++) {
        const float factor = scalar->by_input[a] / scalar->variance;
        float *m = next.sensitivity[a], size2 = 0.0f;
        for (int i = 0; i < NUM_STATES; i++) {
            m[i] -= factor * scalar->projected[i];
            size2 += m[i] * m[i];
        }
        if (!(size2 <= SQUARE_MAX)) {
            return RHO_ERROR_VALUE;
        }
    }
    const enum rho_status status =
        scalar->row
            ? rho_kalman_update_row(&next.bare, scalar->row, scalar->off, scalar->noise)
            : rho_kalman_update(&next.bare, scalar->element, scalar->value, scalar->noise, NULL);
    if (status == RHO_OK) {
        *input = next;
    }
    return status;
}

/*
 * Updates filter and input of one axis with an element that depends on no other input: does what
 * update_all does, the paper's (8) to (13), written out, as a loop would take twice the time.
 */
static enum rho_status update_axis_with_own_input(struct rho_input *input, int axis, int element,
                                                  float value, float variance)
{
    const float *p = input->bare.covariance;
    const uint8_t *index = rho_linalg_row6[element];
    float *m = input->sensitivity[axis];
    const float s = m[element], v = input->variance[RHO_AT(axis, axis)];
    const float bare = p[index[element]] + rho_kalman_floored(variance), total = v * s * s + bare;
    const float rest = value - input->bare.state[element] - s * input->input_mps2[axis];
    const float learned_mps2 = input->input_mps2[axis] + v * s / total * rest;
    const float factor = s / bare;
    const float x = m[RHO_X] - factor * p[index[RHO_X]];
    const float y = m[RHO_Y] - factor * p[index[RHO_Y]];
    const float z = m[RHO_Z] - factor * p[index[RHO_Z]];
    const float vx = m[RHO_VX] - factor * p[index[RHO_VX]];
    const float vy = m[RHO_VY] - factor * p[index[RHO_VY]];
    const float vz = m[RHO_VZ] - factor * p[index[RHO_VZ]];
    if (!(factor * factor * p[index[element]] <= MOVED2_MAX && total <= FLT_MAX &&
          learned_mps2 * learned_mps2 <= SQUARE_MAX)) {
        return RHO_ERROR_VALUE;
    }
    const enum rho_status status = rho_kalman_update(&input->bare, element, value, variance, NULL);
    if (status == RHO_OK) {
        m[RHO_X] = x;
        m[RHO_Y] = y;
        m[RHO_Z] = z;
        m[RHO_VX] = vx;
        m[RHO_VY] = vy;
        m[RHO_VZ] = vz;
        input->input_mps2[axis] = learned_mps2;
        /* scaled instead of being reduced by a difference: no digits cancel */
        input->variance[RHO_AT(axis, axis)] = rho_kalman_floored(v * (bare / total));
    }
    return status;
}

enum rho_status rho_input_update_element(struct rho_input *input,
                                         const struct rho_input_config *config, int element,
                                         float value, float variance)
{
    if (element < 0 || element >= NUM_STATES) {
        return RHO_ERROR_VALUE;
    }
    const int axis = element < NUM_AXES ? element : element - NUM_AXES;
    if (!config->is_estimated) {
        return rho_kalman_update(&input->bare, element, value, variance, NULL);
    }
    /* usually the element depends on no other axis' input, and the inputs are uncorrelated */
    const int b = axis == 0 ? 1 : 0, c = axis == 2 ? 1 : 2;
    if (are_inputs_independent(input->variance) &&
        (rho_size_bits(input->sensitivity[b][element]) |
         rho_size_bits(input->sensitivity[c][element])) == 0) {
        return is_zero(input->sensitivity[axis][element])
                   ? rho_kalman_update(&input->bare, element, value, variance, NULL)
                   : update_axis_with_own_input(input, axis, element, value, variance);
    }
    struct scalar_measurement scalar = {.element = element,
                                        .value = value,
                                        .noise = variance,
                                        .off = value - input->bare.state[element]};
    for (int i = 0; i < NUM_STATES; i++) {
        scalar.projected[i] = input->bare.covariance[rho_linalg_row6[element][i]];
    }
    scalar.variance = rho_kalman_floored(variance) + scalar.projected[element];
    for (int a = 0; a < NUM_AXES; a++) {
        scalar.by_input[a] = input->sensitivity[a][element];
    }
    return update_all(input, &scalar);
}

enum rho_status rho_input_update_row(struct rho_input *input, const struct rho_input_config *config,
                                     const float row[6], float innovation, float variance)
{
    if (!config->is_estimated) {
        return rho_kalman_update_row(&input->bare, row, innovation, variance);
    }
    struct scalar_measurement scalar = {.row = row, .noise = variance, .off = innovation};
    scalar.variance = rho_kalman_floored(variance) +
                      rho_linalg_project6(input->bare.covariance, row, scalar.projected);
    for (int a = 0; a < NUM_AXES; a++) {
        for (int i = 0; i < NUM_STATES; i++) {
            scalar.by_input[a] += row[i] * input->sensitivity[a][i];
        }
    }
    return update_all(input, &scalar);
}
