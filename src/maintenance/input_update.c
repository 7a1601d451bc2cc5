/* SPDX-License-Identifier: MIT */
/* What a scalar tells updates the filter without input, and the inputs by what that leaves unexplained. */
#include <float.h>
#include <stddef.h>
#include <string.h>

#include "input_columns.h"
#include "rhotrack/input.h"

/* As in the filter: variances that something is taken off are raised by sixteen units of rounding. */
#define ROUNDING_ALLOWANCE (1.0f + 1.0f / 1048576.0f)

#define INPUT2_MAX 1.0e24f

/* Of (s / S)^2 P_ii: no covariance with the element is larger than the root of P_ii times that of the largest variance. */
#define MOVED2_MAX (SENSITIVITY2_MAX / RHO_KALMAN_VARIANCE_MAX)

/* Where row i of a packed 6 x 6 matrix lies. */
static const uint8_t row_places[NUM_STATES][NUM_STATES] = {
    {0, 1, 3, 6, 10, 15}, {1, 2, 4, 7, 11, 16},     {3, 4, 5, 8, 12, 17},
    {6, 7, 8, 9, 13, 18}, {10, 11, 12, 13, 14, 19}, {15, 16, 17, 18, 19, 20},
};

static float noise_of(float variance)
{
    return variance < RHO_KALMAN_VARIANCE_MIN ? RHO_KALMAN_VARIANCE_MIN : variance;
}

static float at_least_floor(float variance)
{
    return variance > RHO_KALMAN_VARIANCE_MIN ? variance : RHO_KALMAN_VARIANCE_MIN;
}

/* ---- any measurement ------------------------------------------------------------------------------ */

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

static enum rho_status update_bare(struct rho_kalman *bare, const struct sight *sight)
{
    if (sight->row) {
        return rho_kalman_update_row(bare, sight->row, sight->off, sight->noise, NULL);
    }
    return rho_kalman_update(bare, sight->element, sight->value, sight->noise, NULL);
}

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

/* V and u, (11) and (12). False where they are too large, or NaN. */
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

static enum rho_status update_row(struct rho_input *input, const float row[6], float innovation,
                                  float variance)
{
    struct sight sight = {.row = row, .noise = variance, .off = innovation};

    sight.variance =
        noise_of(variance) + rho_linalg_project6(input->bare.covariance, row, sight.projected);
    for (int a = 0; a < NUM_AXES; a++) {
        for (int i = 0; i < NUM_STATES; i++) {
            sight.by_input[a] += row[i] * input->sensitivity[a][i];
        }
    }
    return update_all(input, &sight);
}

static enum rho_status update_coupled(struct rho_input *input, int element, float value,
                                      float variance)
{
    struct sight sight = {.element = element,
                          .value = value,
                          .noise = variance,
                          .off = value - input->bare.state[element]};

    for (int i = 0; i < NUM_STATES; i++) {
        sight.projected[i] = input->bare.covariance[row_places[element][i]];
    }
    sight.variance = noise_of(variance) + sight.projected[element];
    for (int a = 0; a < NUM_AXES; a++) {
        sight.by_input[a] = input->sensitivity[a][element];
    }
    return update_all(input, &sight);
}

/* ---- an element that depends on the input of its own axis ----------------------------------------- */

/* True where an element depends on the input of its axis at most, and that on no other's: the usual case. */
static int is_apart(const struct rho_input *input, int element, int axis)
{
    static const uint8_t others[NUM_AXES][2] = {{1, 2}, {0, 2}, {0, 1}};
    const int b = others[axis][0], c = others[axis][1];

    return (bits_of(input->sensitivity[b][element]) | bits_of(input->sensitivity[c][element]) |
            bits_of(input->variance[RHO_AT(1, 0)]) | bits_of(input->variance[RHO_AT(2, 0)]) |
            bits_of(input->variance[RHO_AT(2, 1)])) == 0;
}

/* The same as update_all, (8) to (13), for one axis; written out, as a loop would take twice the time. */
static enum rho_status update_axis(struct rho_input *input, int axis, int element, float value,
                                   float variance)
{
    const float *p = input->bare.covariance;
    const uint8_t *place = row_places[element];
    float *m = input->sensitivity[axis];
    const float s = m[element], v = input->variance[RHO_AT(axis, axis)];
    const float bare = p[place[element]] + noise_of(variance), total = v * s * s + bare;
    const float rest = value - input->bare.state[element] - s * input->input_mps2[axis];
    const float learned_mps2 = input->input_mps2[axis] + v * s / total * rest;
    const float factor = s / bare;

    const float m0 = m[0] - factor * p[place[0]];
    const float m1 = m[1] - factor * p[place[1]];
    const float m2 = m[2] - factor * p[place[2]];
    const float m3 = m[3] - factor * p[place[3]];
    const float m4 = m[4] - factor * p[place[4]];
    const float m5 = m[5] - factor * p[place[5]];
    if (!(factor * factor * p[place[element]] <= MOVED2_MAX && total <= FLT_MAX &&
          learned_mps2 * learned_mps2 <= INPUT2_MAX)) {
        return RHO_ERROR_VALUE;
    }
    const enum rho_status status = rho_kalman_update(&input->bare, element, value, variance, NULL);
    if (status == RHO_OK) {
        m[0] = m0;
        m[1] = m1;
        m[2] = m2;
        m[3] = m3;
        m[4] = m4;
        m[5] = m5;
        input->input_mps2[axis] = learned_mps2;
        /* scaled, not differenced: no digit is lost */
        input->variance[RHO_AT(axis, axis)] = at_least_floor(v * (bare / total));
    }
    return status;
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
    const int axis = element < NUM_AXES ? element : element - NUM_AXES;
    if (!config->is_estimated) {
        return rho_kalman_update(&input->bare, element, value, variance, NULL);
    }
    if (!is_apart(input, element, axis)) {
        return update_coupled(input, element, value, variance);
    }
    if (is_zero(input->sensitivity[axis][element])) { /* it says nothing of inputs */
        return rho_kalman_update(&input->bare, element, value, variance, NULL);
    }
    return update_axis(input, axis, element, value, variance);
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
