/* SPDX-License-Identifier: MIT */
#include "rhotrack/input.h"

#include <float.h>
#include <stddef.h>

#include "rhotrack/approx.h"

#define NUM_AXES RHO_INPUT_AXES
#define NUM_STATES RHO_KALMAN_STATES
#define ALL_PRESENT 7u

#define SIGMA_MIN_MPS2 1.0e-3f
#define SIGMA_MAX_MPS2 1.0e5f
#define NOISE_MAX 1.0e6f

/* Sensitivities grow no farther than that, so that their squares times any variance are finite. */
#define SENSITIVITY2_MAX 1.0e24f

/* What is added to a covariance carries some units of float32's rounding, and the variances get sixteen. */
#define ROUNDING_SHARE (1.0f / 1048576.0f)

/* What inputs may add to a variance before one looks whether it is beyond the filter's limit. */
#define ADDED_EASILY (1.0e-3f * RHO_KALMAN_VARIANCE_MAX)

static const struct rho_input nothing = {.present = 0};

/* ---- configuration ---------------------------------------------------------------------------- */

/* M. Abramowitz, I. Stegun, Handbook of Mathematical Functions, 26.2.23: absolute error <= 4.5e-4. */
float rho_input_threshold(float confidence)
{
    if (!(confidence >= 0.0f && confidence < 1.0f)) {
        return rho_log(-1.0f); /* NaN */
    }
    const float t = rho_sqrt(-2.0f * rho_log(0.5f * (1.0f - confidence)));
    return t - (2.515517f + t * (0.802853f + t * 0.010328f)) /
                   (1.0f + t * (1.432788f + t * (0.189269f + t * 0.001308f)));
}

void rho_input_config_default(struct rho_input_config *config)
{
    static const struct rho_input_config paper = {.is_estimated = 1,
                                                  .model = RHO_INPUT_LITERAL,
                                                  .sigma_mps2 = 22.36068f, /* the root of 500 */
                                                  .threshold = 1.959964f,
                                                  .gamma = 1.0f,
                                                  .noise_density = 0.0f,
                                                  .noise_m = 1.0f,
                                                  .noise_mps = 1.0f,
                                                  .velocity_variance = 490000.0f};

    if (config != NULL) {
        *config = paper;
    }
}

static int is_noise(float sigma)
{
    return sigma >= 0.0f && sigma <= NOISE_MAX;
}

int rho_input_is_usable(const struct rho_input_config *config)
{
    return config != NULL && config->model < RHO_NUM_INPUT_MODELS &&
           config->sigma_mps2 >= SIGMA_MIN_MPS2 && config->sigma_mps2 <= SIGMA_MAX_MPS2 &&
           config->threshold > 0.0f && config->threshold <= FLT_MAX && config->gamma > 0.0f &&
           config->gamma <= 1.0f && config->noise_density >= 0.0f &&
           config->noise_density <= FLT_MAX && is_noise(config->noise_m) &&
           is_noise(config->noise_mps) && config->velocity_variance >= RHO_KALMAN_VARIANCE_MIN &&
           config->velocity_variance <= RHO_KALMAN_VARIANCE_MAX;
}

/* ---- the estimate with its inputs ------------------------------------------------------------- */

static int is_in(uint32_t axes, int axis)
{
    return (axes >> axis & 1u) != 0;
}

/* p := p + factor m m^T */
static void add_square(float p[RHO_TRIANGLE(NUM_STATES)], const float m[NUM_STATES], float factor)
{
    for (int i = 0; i < NUM_STATES; i++) {
        const float scaled = factor * m[i];
        float *row = &p[RHO_TRIANGLE(i)];

        for (int j = 0; j <= i; j++) {
            row[j] += scaled * m[j];
        }
        row[i] += scaled * m[i] * ROUNDING_SHARE;
    }
}

static int is_zero(float v)
{
    return !(v < 0.0f || v > 0.0f);
}

/*
 * M V M^T of these inputs as a sum of squares, V = L D L^T: the first input's column takes with it what the others are
 * expected to be where it is one, and what they are beyond that comes by itself.
 */
static void add_inputs(struct rho_kalman *estimate, const struct rho_input *input, uint32_t axes)
{
    float v[RHO_TRIANGLE(NUM_AXES)], column[NUM_STATES];

    for (int k = 0; k < RHO_TRIANGLE(NUM_AXES); k++) {
        v[k] = input->variance[k];
    }
    for (int a = 0; a < NUM_AXES; a++) {
        const float *m = input->sensitivity[a];
        const float pivot = v[RHO_AT(a, a)];

        if (!is_in(axes, a) || !(pivot > 0.0f)) {
            continue;
        }
        for (int i = 0; i < NUM_STATES; i++) {
            estimate->state[i] += m[i] * input->input_mps2[a];
            column[i] = m[i];
        }
        for (int b = a + 1; b < NUM_AXES; b++) {
            const float covariance = v[RHO_AT(b, a)];

            if (!is_in(axes, b) || is_zero(covariance)) {
                continue;
            }
            const float share = covariance / pivot;
            for (int i = 0; i < NUM_STATES; i++) {
                column[i] += share * input->sensitivity[b][i];
            }
            for (int c = b; c < NUM_AXES; c++) {
                v[RHO_AT(c, b)] -= share * v[RHO_AT(c, a)];
            }
        }
        add_square(estimate->covariance, column, pivot);
    }
}

void rho_input_estimate(const struct rho_input *input, struct rho_kalman *estimate)
{
    *estimate = input->bare;
    add_inputs(estimate, input, input->present);
}

void rho_input_expect(const struct rho_input *input, struct rho_kalman *estimate)
{
    *estimate = input->bare;
    add_inputs(estimate, input, ALL_PRESENT);
}

/* ---- start and prediction --------------------------------------------------------------------- */

enum rho_status rho_input_start(struct rho_input *input, const struct rho_input_config *config,
                                const struct rho_kalman *estimate)
{
    if (input == NULL || config == NULL || estimate == NULL) {
        return RHO_ERROR_NULL;
    }
    if (!rho_input_is_usable(config)) {
        return RHO_ERROR_CONFIG;
    }
    const float variance = config->sigma_mps2 * config->sigma_mps2;
    const struct rho_kalman bare = *estimate; /* may be the object's own */
    *input = nothing;
    input->bare = bare;
    for (int axis = 0; axis < NUM_AXES; axis++) {
        input->variance[RHO_AT(axis, axis)] = variance;
    }
    return RHO_OK;
}

/* N = F M + D; back in time N = F^-1 (M - D). Returns the sum of its squares. */
static float predict_sensitivity(struct rho_input *input, const struct rho_input_config *config,
                                 float dt_s)
{
    const int is_literal = config->model == RHO_INPUT_LITERAL;
    const float half_m = 0.5f * dt_s * dt_s, whole_m = dt_s < 0.0f ? dt_s * dt_s : 0.0f;
    const float moved_m = is_literal ? whole_m : half_m;
    float size2 = 0.0f;

    for (int a = 0; a < NUM_AXES; a++) {
        float *n = input->sensitivity[a];

        for (int i = 0; i < NUM_AXES; i++) {
            n[i] += dt_s * n[i + NUM_AXES];
        }
        if (rho_kalman_is_open(&input->bare, a)) {
            n[a] += moved_m;
            n[a + NUM_AXES] += dt_s;
        }
        for (int i = 0; i < NUM_STATES; i++) {
            size2 += n[i] * n[i];
        }
    }
    return size2;
}

/* V / gamma, but no variance beyond V(0); covariances take half of what their variances do. */
static void forget(struct rho_input *input, const struct rho_input_config *config)
{
    const float most = config->sigma_mps2 * config->sigma_mps2;
    float *v = input->variance;

    for (int a = 0; a < NUM_AXES; a++) {
        const float before = v[RHO_AT(a, a)];
        const float wider = before / config->gamma;
        const float after = wider < most ? wider : most;

        if (!is_in(input->present, a) || !(after > before)) {
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

/* No variance that the inputs add to is larger than size2 trace V: mostly that says it, and the estimate need not be made. */
static int is_certain_enough(const struct rho_input *input, float size2)
{
    const float *v = input->variance;
    const float most = size2 * (v[RHO_AT(0, 0)] + v[RHO_AT(1, 1)] + v[RHO_AT(2, 2)]);
    struct rho_kalman estimate;

    if (!(size2 <= SENSITIVITY2_MAX)) {
        return 0;
    }
    if (!input->present || most <= ADDED_EASILY) {
        return 1;
    }
    rho_input_estimate(input, &estimate);
    for (int i = 0; i < NUM_STATES; i++) {
        if (!(estimate.covariance[RHO_AT(i, i)] <= RHO_KALMAN_VARIANCE_MAX)) {
            return 0;
        }
    }
    return 1;
}

enum rho_status rho_input_predict(struct rho_input *input, const struct rho_input_config *config,
                                  float dt_s)
{
    enum rho_status status;

    if (input == NULL || config == NULL) {
        return RHO_ERROR_NULL;
    }
    struct rho_input next = *input;
    status = rho_kalman_predict(&next.bare, dt_s, config->noise_density);
    if (status == RHO_OK && dt_s > 0.0f) {
        status = rho_kalman_add_noise(&next.bare, config->noise_m * config->noise_m,
                                      config->noise_mps * config->noise_mps);
    }
    if (status != RHO_OK) {
        return status;
    }
    if (config->is_estimated) {
        if (dt_s > 0.0f && config->gamma < 1.0f) {
            forget(&next, config);
        }
        const float size2 = predict_sensitivity(&next, config, dt_s);
        if (!is_certain_enough(&next, size2)) {
            return RHO_ERROR_VALUE;
        }
    }
    *input = next;
    return RHO_OK;
}

/* ---- onset and stop --------------------------------------------------------------------------- */

static void start_anew(struct rho_input *input, int axis, float variance)
{
    for (int i = 0; i < NUM_STATES; i++) {
        input->sensitivity[axis][i] = 0.0f;
    }
    for (int b = 0; b < NUM_AXES; b++) {
        input->variance[RHO_AT(axis, b)] = 0.0f;
    }
    input->input_mps2[axis] = 0.0f;
    input->variance[RHO_AT(axis, axis)] = variance;
}

/* A variance less what another explains; rounding must not take all of it. */
static float remaining(float variance, float explained)
{
    const float rest = variance - explained, least = variance * ROUNDING_SHARE;

    return rest > least ? rest : least;
}

/* There never was an input on this axis: the others are what they are, given that. */
static void rule_out(struct rho_input *input, int axis)
{
    const int b = (axis + 1) % NUM_AXES, c = (axis + 2) % NUM_AXES;
    float *v = input->variance;
    const float vb = v[RHO_AT(axis, b)], vc = v[RHO_AT(axis, c)];
    const float share_b = vb / v[RHO_AT(axis, axis)], share_c = vc / v[RHO_AT(axis, axis)];

    if (is_zero(vb) && is_zero(vc)) {
        return;
    }
    input->input_mps2[b] -= share_b * input->input_mps2[axis];
    input->input_mps2[c] -= share_c * input->input_mps2[axis];
    v[RHO_AT(b, b)] = remaining(v[RHO_AT(b, b)], share_b * vb);
    v[RHO_AT(c, c)] = remaining(v[RHO_AT(c, c)], share_c * vc);
    v[RHO_AT(b, c)] -= share_b * vc;
}

/*
 * The input of this axis has been, and is no more: what it did goes into the estimate. Expressed by those of the other
 * axes, u = s_b u_b + s_c u_c + rest: their sensitivities take their shares over, and only the rest, which they do not
 * explain, is taken in, so that the filter's estimate and they stay independent.
 */
static void take_in(struct rho_input *input, int axis)
{
    const int b = (axis + 1) % NUM_AXES, c = (axis + 2) % NUM_AXES;
    const float *v = input->variance, *m = input->sensitivity[axis];
    const float vb = v[RHO_AT(axis, b)], vc = v[RHO_AT(axis, c)];
    float rest_mps2 = input->input_mps2[axis], variance = v[RHO_AT(axis, axis)];

    if (!is_zero(vb) || !is_zero(vc)) {
        const float bb = v[RHO_AT(b, b)], bc = v[RHO_AT(b, c)];
        const float pivot = remaining(v[RHO_AT(c, c)], bc / bb * bc);
        const float share_c = (vc - bc / bb * vb) / pivot;
        const float share_b = (vb - share_c * bc) / bb;

        rest_mps2 -= share_b * input->input_mps2[b] + share_c * input->input_mps2[c];
        variance = remaining(variance, share_b * vb + share_c * vc);
        for (int i = 0; i < NUM_STATES; i++) {
            input->sensitivity[b][i] += share_b * m[i];
            input->sensitivity[c][i] += share_c * m[i];
        }
    }
    for (int i = 0; i < NUM_STATES; i++) {
        input->bare.state[i] += m[i] * rest_mps2;
    }
    add_square(input->bare.covariance, m, variance);
}

static float significance2(const struct rho_input *input, int axis)
{
    const float u = input->input_mps2[axis];

    return u / input->variance[RHO_AT(axis, axis)] * u;
}

/* Of these axes, at least one; of equals the first. */
static int find_weakest(const struct rho_input *input, uint32_t axes)
{
    int weakest = is_in(axes, 0) ? 0 : (is_in(axes, 1) ? 1 : 2);
    float least = significance2(input, weakest);

    for (int axis = weakest + 1; axis < NUM_AXES; axis++) {
        if (is_in(axes, axis) && significance2(input, axis) < least) {
            weakest = axis;
            least = significance2(input, axis);
        }
    }
    return weakest;
}

void rho_input_decide(struct rho_input *input, const struct rho_input_config *config)
{
    if (input == NULL || config == NULL || !config->is_estimated) {
        return;
    }
    const float limit2 = config->threshold * config->threshold;
    uint32_t left = ALL_PRESENT;

    while (left) {
        const int axis = find_weakest(input, left);

        if (significance2(input, axis) > limit2) {
            break;
        }
        if (is_in(input->present, axis)) {
            take_in(input, axis);
        } else {
            rule_out(input, axis);
        }
        start_anew(input, axis, config->sigma_mps2 * config->sigma_mps2);
        left &= ~(1u << axis);
    }
    input->present = left;
}
