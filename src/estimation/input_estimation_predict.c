/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/input_estimation.h"

#include <float.h>
#include <string.h>

#include "input_sensitivity.h"
#include "rhotrack/detail/approx.h"

/* Quantile of the normal distribution: Abramowitz and Stegun, 26.2.23: error <= 4.5e-4. */
float rho_input_threshold_sigmas(float confidence)
{
    if (!(confidence >= 0.0f && confidence < 1.0f)) {
        return rho_log(-1.0f); /* the result is NaN */
    }
    const float t = rho_sqrt(-2.0f * rho_log(0.5f * (1.0f - confidence)));
    return t - (2.515517f + t * (0.802853f + t * 0.010328f)) /
                   (1.0f + t * (1.432788f + t * (0.189269f + t * 0.001308f)));
}

void rho_input_config_default(struct rho_input_config *config)
{
    *config = (struct rho_input_config){
        .is_estimated = 1,
        .model = RHO_INPUT_LITERAL,
        .sigma_mps2 = 22.36068f, /* the root of 500 */
        .threshold = 1.959964f,
        .gamma = 1.0f,
        .noise_m = 1.0f,
        .noise_mps = 1.0f,
        .velocity_variance = 490000.0f,
    };
}

int rho_input_is_usable(const struct rho_input_config *config)
{
    return config->model < RHO_NUM_INPUT_MODELS &&
           rho_is_within(config->sigma_mps2, 1.0e-3f, 1.0e5f) && config->threshold > 0.0f &&
           config->threshold <= FLT_MAX && config->gamma > 0.0f && config->gamma <= 1.0f &&
           rho_is_within(config->noise_density, 0.0f, FLT_MAX) &&
           rho_is_within(config->noise_m, 0.0f, 1.0e6f) &&
           rho_is_within(config->noise_mps, 0.0f, 1.0e6f) &&
           rho_is_within(config->velocity_variance, RHO_VARIANCE_MIN, RHO_VARIANCE_MAX) &&
           rho_is_within(config->initial_variance, 0.0f, RHO_VARIANCE_MAX) &&
           !(config->initial_variance > 0.0f && config->initial_variance < RHO_VARIANCE_MIN);
}

/*
 * Adds the effects M u and M V M^T of the correlated inputs on these axes to an estimate. With V =
 * L D L^T the covariance is a sum over the columns of M L, each with its element of D.
 */
static void add_correlated_input_effects(struct rho_kalman *estimate, const struct rho_input *input,
                                         uint32_t axes)
{
    float v[RHO_TRIANGLE(NUM_AXES)], column[NUM_STATES];
    memcpy(v, input->variance, sizeof v);
    for (int a = 0; a < NUM_AXES; a++) {
        const float *m = input->sensitivity[a];
        const float pivot = v[RHO_AT(a, a)];
        if (!includes_axis(axes, a)) {
            continue;
        }
        add_input_effect(estimate, m, a, input->input_mps2[a], 0.0f);
        if (!(pivot > 0.0f)) {
            continue;
        }
        memcpy(column, m, sizeof column);
        for (int b = a + 1; b < NUM_AXES; b++) {
            const float share = includes_axis(axes, b) ? v[RHO_AT(b, a)] / pivot : 0.0f;
            for (int i = 0; i < NUM_STATES; i++) {
                column[i] += share * input->sensitivity[b][i];
            }
            for (int c = b; c < NUM_AXES; c++) {
                v[RHO_AT(c, b)] -= share * v[RHO_AT(c, a)];
            }
        }
        add_input_effect(estimate, column, a, 0.0f, pivot);
    }
}

/* Adds the effects of these axes' inputs, and their uncertainty, to an estimate without input. */
static void add_input_effects(struct rho_kalman *estimate, const struct rho_input *input,
                              uint32_t axes)
{
    if (!are_inputs_independent(input->variance)) {
        add_correlated_input_effects(estimate, input, axes);
        return;
    }
    for (int a = 0; a < NUM_AXES; a++) {
        if (includes_axis(axes, a)) {
            add_input_effect(estimate, input->sensitivity[a], a, input->input_mps2[a],
                             input->variance[rho_linalg_row6[a][a]]);
        }
    }
}

void rho_input_estimate(const struct rho_input *input, struct rho_kalman *estimate)
{
    *estimate = input->bare;
    add_input_effects(estimate, input, input->present);
}

void rho_input_gate_estimate(const struct rho_input *input, struct rho_kalman *estimate)
{
    *estimate = input->bare;
    add_input_effects(estimate, input, INPUT_ALL_PRESENT);
}

enum rho_status rho_input_start(struct rho_input *input, const struct rho_input_config *config,
                                const struct rho_kalman *estimate)
{
    if (!rho_input_is_usable(config)) {
        return RHO_ERROR_CONFIG;
    }
    const float variance = config->sigma_mps2 * config->sigma_mps2;
    memset(input, 0, sizeof *input);
    input->bare = *estimate;
    for (int axis = 0; axis < NUM_AXES; axis++) {
        input->variance[RHO_AT(axis, axis)] = variance;
    }
    return RHO_OK;
}

/* N = F M + D; back in time N = F^-1 (M - D). Returns the sum of squares of N's elements. */
static float predict_sensitivities(struct rho_input *input, const struct rho_input_config *config,
                                   float dt_s)
{
    const int is_literal = config->model == RHO_INPUT_LITERAL;
    const float half_m = 0.5f * dt_s * dt_s, whole_m = dt_s < 0.0f ? dt_s * dt_s : 0.0f;
    const float moved_m = is_literal ? whole_m : half_m;
    float size2 = 0.0f;
    for (int a = 0; a < NUM_AXES; a++) {
        float *n = input->sensitivity[a];
        n[RHO_X] += dt_s * n[RHO_VX];
        n[RHO_Y] += dt_s * n[RHO_VY];
        n[RHO_Z] += dt_s * n[RHO_VZ];
        if (input->bare.covariance[RHO_AT(a, a)] > 0.0f) { /* the axis is open */
            n[a] += moved_m;
            n[a + NUM_AXES] += dt_s;
        }
        size2 += n[RHO_X] * n[RHO_X] + n[RHO_Y] * n[RHO_Y] + n[RHO_Z] * n[RHO_Z] +
                 n[RHO_VX] * n[RHO_VX] + n[RHO_VY] * n[RHO_VY] + n[RHO_VZ] * n[RHO_VZ];
    }
    return size2;
}

/* Forgetting: V / gamma where an input is, V(0) at most; covariances by the factors' roots. */
static void grow_present_input_variances(struct rho_input *input,
                                         const struct rho_input_config *config)
{
    const float most = config->sigma_mps2 * config->sigma_mps2;
    float *v = input->variance;
    for (int a = 0; a < NUM_AXES; a++) {
        const float before = v[RHO_AT(a, a)];
        const float wider = before / config->gamma;
        const float after = wider < most ? wider : most;
        if (!includes_axis(input->present, a) || !(after > before)) {
            continue;
        }
        v[RHO_AT(a, a)] = after;
        const int b = (a + 1) % NUM_AXES, c = (a + 2) % NUM_AXES;
        if (!is_zero(v[RHO_AT(a, b)]) || !is_zero(v[RHO_AT(a, c)])) {
            const float factor = rho_sqrt(after / before);
            v[RHO_AT(a, b)] *= factor;
            v[RHO_AT(a, c)] *= factor;
        }
    }
}

static enum rho_status predict_inputs(struct rho_input *input,
                                      const struct rho_input_config *config, float dt_s)
{
    const float *v = input->variance;
    struct rho_kalman estimate;
    if (dt_s > 0.0f && config->gamma < 1.0f) {
        grow_present_input_variances(input, config);
    }
    const float size2 = predict_sensitivities(input, config, dt_s);
    if (!(size2 <= SQUARE_MAX)) {
        return RHO_ERROR_VALUE;
    }
    /* inputs add at most size2 trace V to a variance: below a thousandth of the limit no check */
    if (!input->present ||
        size2 * (v[RHO_XX] + v[RHO_YY] + v[RHO_ZZ]) <= 1.0e-3f * RHO_VARIANCE_MAX) {
        return RHO_OK;
    }
    rho_input_estimate(input, &estimate);
    for (int i = 0; i < NUM_STATES; i++) {
        if (!(estimate.covariance[RHO_AT(i, i)] <= RHO_VARIANCE_MAX)) {
            return RHO_ERROR_VALUE;
        }
    }
    return RHO_OK;
}

/* Adds the paper's Q to each open axis. False where a variance exceeds its limit, or is NaN. */
static int add_noise(struct rho_kalman *bare, const struct rho_input_config *config)
{
    for (int axis = 0; axis < NUM_AXES; axis++) {
        float *place = &bare->covariance[RHO_AT(axis, axis)];
        float *speed = &bare->covariance[RHO_AT(NUM_AXES + axis, NUM_AXES + axis)];
        if (rho_kalman_has_axis(bare, axis)) {
            *place += config->noise_m * config->noise_m;
            *speed += config->noise_mps * config->noise_mps;
        }
        if (!(*place <= RHO_VARIANCE_MAX && *speed <= RHO_VARIANCE_MAX)) {
            return 0;
        }
    }
    return 1;
}

enum rho_status rho_input_predict(struct rho_input *input, const struct rho_input_config *config,
                                  float dt_s)
{
    const struct rho_input before = *input;
    enum rho_status status = rho_kalman_predict(&input->bare, dt_s, config->noise_density);
    if (status == RHO_OK && dt_s > 0.0f && !add_noise(&input->bare, config)) {
        status = RHO_ERROR_VALUE;
    }
    if (status == RHO_OK && config->is_estimated) {
        status = predict_inputs(input, config, dt_s);
    }
    if (status != RHO_OK) {
        *input = before;
    }
    return status;
}
