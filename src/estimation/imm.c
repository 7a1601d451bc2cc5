/* SPDX-License-Identifier: MIT */
/* imm: the two motion models, their transition over an interval, mixing and prediction. */
#include "rhotrack/detail/imm.h"

#include <float.h>
#include <string.h>

#include "imm_axis_access.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

void rho_imm_model_default(struct rho_imm_model *model, float accel_max_mps2, float v_max_mps)
{
    const float accel = DRIVE_SHARE * accel_max_mps2, quiet = QUIET_SHARE * accel_max_mps2;
    const float turn_s =
        accel_max_mps2 * TURN_MAX_S > v_max_mps ? v_max_mps / accel_max_mps2 : TURN_MAX_S;
    const float memory_s = MEMORY_SHARE * turn_s, sojourn_s = SOJOURN_SHARE * turn_s;
    *model = (struct rho_imm_model){
        .quiet_density = quiet * quiet < QUIET_DENSITY ? quiet * quiet : QUIET_DENSITY,
        .calm_density = quiet * quiet < CALM_DENSITY ? quiet * quiet : CALM_DENSITY,
        .memory_s = memory_s > MEMORY_MIN_S ? memory_s : MEMORY_MIN_S,
        .maneuver_s = sojourn_s > SOJOURN_MIN_S ? sojourn_s : SOJOURN_MIN_S,
        .calm_s = RHO_IMM_CALM_S,
        .settle_s = SETTLE_S,
        .speed_sigma_mps = v_max_mps,
        .accel_sigma_mps2 = accel_max_mps2,
    };
    model->steady_s = model->maneuver_s;
    model->drive_density = 2.0f * accel * accel / model->memory_s;
}

int rho_imm_model_is_usable(const struct rho_imm_model *model)
{
    return rho_is_within(model->quiet_density, 0.0f, 1e8f) &&
           rho_is_within(model->calm_density, 0.0f, model->quiet_density) &&
           rho_is_within(model->drive_density, 0.0f, 1e8f) &&
           rho_is_within(model->memory_s, 1e-3f, 1e6f) &&
           rho_is_within(model->steady_s, 1e-3f, 1e6f) &&
           rho_is_within(model->maneuver_s, 1e-3f, 1e6f) &&
           rho_is_within(model->calm_s, 0.0f, 1e6f) &&
           rho_is_within(model->settle_s, model->calm_s > 0.0f ? 1e-3f : 0.0f, 1e6f) &&
           rho_is_within(model->speed_sigma_mps, 1e-3f, RHO_LIMIT_SPEED_MPS) &&
           rho_is_within(model->accel_sigma_mps2, 0.0f, 1e4f) &&
           rho_is_within(model->speed_max_mps, 0.0f, RHO_LIMIT_SPEED_MPS);
}

/* Weights and nodes of four-point Gauss-Legendre quadrature on 0 .. 1: exact to power 7. */
static const float gauss_weight[4] = {0.17392742f, 0.32607258f, 0.32607258f, 0.17392742f};
static const float gauss_node[4] = {0.06943184f, 0.33000948f, 0.66999052f, 0.93056816f};

/*
 * Position, velocity and acceleration at time t after a unit of acceleration at time 0, with x = t
 * / memory within +-1/2: t^2 (x - 1 + e^-x) / x^2, t (1 - e^-x) / x, e^-x. Computed by series, as
 * the closed forms cancel for small x.
 */
static void acceleration_response(float t_s, float memory_s, float out[3])
{
    float x = t_s / memory_s;
    /* sum over k of (-x)^k / (k + 2)!, nested; the next term is below rounding for |x| <= 1/2 */
    float rest = 1.0f / 40320.0f * -x + 1.0f / 5040.0f;
    rest = rest * -x + 1.0f / 720.0f;
    rest = rest * -x + 1.0f / 120.0f;
    rest = rest * -x + 1.0f / 24.0f;
    rest = rest * -x + 1.0f / 6.0f;
    rest = rest * -x + 0.5f;
    out[0] = t_s * t_s * rest;
    out[1] = t_s * (1.0f - x * rest);
    out[2] = 1.0f - x * (1.0f - x * rest);
}

static void set_response(struct rho_imm_step *step, const struct rho_imm_model *model, float dt_s)
{
    float response[3];
    acceleration_response(dt_s, model->memory_s, response);
    step->position_by_accel = response[0];
    step->velocity_by_accel = response[1];
    step->accel_by_accel = response[2];
    memset(step->noise, 0, sizeof step->noise);
    for (int k = 0; dt_s > 0.0f && k < 4; k++) {
        const float weight = gauss_weight[k] * dt_s * model->drive_density;
        acceleration_response(gauss_node[k] * dt_s, model->memory_s, response);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j <= i; j++) {
                step->noise[RHO_AT(i, j)] += weight * response[i] * response[j];
            }
        }
    }
}

/* Predicts one axis' covariance of the manoeuvring model without process noise: F P F^T. */
static inline void propagate_axis_covariance(struct axis *at, struct accel *by,
                                             const struct rho_imm_step *step)
{
    const float dt = step->dt_s, f = step->position_by_accel, g = step->velocity_by_accel,
                h = step->accel_by_accel;
    const float pp = at->pp + dt * at->vp + f * by->ap, pv = at->vp + dt * at->vv + f * by->av;
    const float pa = by->ap + dt * by->av + f * by->aa;
    const float vv = at->vv + g * by->av, va = by->av + g * by->aa;
    at->pp = pp + dt * pv + f * pa;
    at->vp = pv + g * pa;
    at->vv = vv + g * va;
    by->ap = h * pa;
    by->av = h * va;
    by->aa = h * h * by->aa;
}

/* Doubles the interval of the manoeuvring model's transition: two steps in a row. */
static void double_step(struct rho_imm_step *step)
{
    float *noise = step->noise;
    struct axis at = {.pp = noise[0], .vp = noise[1], .vv = noise[2]};
    struct accel by = {.ap = noise[3], .av = noise[4], .aa = noise[5]};
    propagate_axis_covariance(&at, &by, step);
    noise[0] += at.pp;
    noise[1] += at.vp;
    noise[2] += at.vv;
    noise[3] += by.ap;
    noise[4] += by.av;
    noise[5] += by.aa;
    step->position_by_accel +=
        step->dt_s * step->velocity_by_accel + step->position_by_accel * step->accel_by_accel;
    step->velocity_by_accel += step->velocity_by_accel * step->accel_by_accel;
    step->accel_by_accel *= step->accel_by_accel;
    step->dt_s *= 2.0f;
}

/* Probability that an exponentially distributed time with mean mean_s has passed. */
static float change_probability(float dt_s, float mean_s)
{
    return 1.0f - rho_exp(-dt_s / mean_s);
}

/*
 * Transition probabilities of the Markov chain over the step's interval. A manoeuvre of a calm
 * target is counted even if it has ended within the step: after a long gap no other term holds its
 * effect. The mean time between manoeuvres of a calm target is at least that of an agile one.
 */
static void set_transitions(struct rho_imm_step *step, const struct rho_imm_model *model)
{
    const float begins = step->dt_s / model->steady_s, ends = step->dt_s / model->maneuver_s;
    step->begins = step->ends = step->calm_begins = step->settles = step->odds_over = 0.0f;
    if (step->dt_s > 0.0f) {
        if (model->calm_s > 0.0f) {
            step->calm_begins = change_probability(
                step->dt_s, model->calm_s > model->steady_s ? model->calm_s : model->steady_s);
            step->settles = change_probability(step->dt_s, model->settle_s);
            step->odds_over = ODDS_OVER;
        }
        const float moved = 1.0f - rho_exp(-(begins + ends));
        step->begins = begins / (begins + ends) * moved;
        step->ends = ends / (begins + ends) * moved;
        step->calm_begins = step->calm_begins < step->begins ? step->calm_begins : step->begins;
    }
}

void rho_imm_prepare_step(struct rho_imm_step *step, const struct rho_imm_model *model, float dt_s)
{
    int doublings = 0;
    step->dt_s = dt_s;
    while (doublings < 40 &&
           !(step->dt_s <= 0.5f * model->memory_s && step->dt_s >= -0.5f * model->memory_s)) {
        step->dt_s *= 0.5f;
        doublings++;
    }
    set_response(step, model, step->dt_s);
    for (; doublings > 0; doublings--) {
        double_step(step);
    }
    step->dt_s = dt_s;
    step->quiet_density = model->quiet_density;
    step->calm_density = model->calm_density;
    const float noisy_s = dt_s > 0.0f ? dt_s : 0.0f;
    step->quiet_noise[0] = noisy_s * noisy_s * noisy_s * (1.0f / 3.0f);
    step->quiet_noise[1] = 0.5f * noisy_s * noisy_s;
    step->quiet_noise[2] = noisy_s;
    set_transitions(step, model);
}

void rho_imm_start(struct rho_imm *imm, const struct rho_imm_model *model,
                   const struct rho_kalman *estimate)
{
    memset(imm, 0, sizeof *imm);
    imm->steady = *estimate;
    memcpy(imm->state, estimate->state, sizeof estimate->state);
    memcpy(imm->covariance, estimate->covariance, sizeof estimate->covariance);
    for (int axis = 0; axis < RHO_AXES; axis++) {
        if (rho_kalman_has_axis(estimate, axis)) {
            imm->covariance[COVARIANCE_AT(axis, 2, axis, 2)] =
                model->accel_sigma_mps2 * model->accel_sigma_mps2 + RHO_VARIANCE_MIN;
        }
    }
    for (int axis = 1; axis < RHO_AXES; axis++) {
        for (int other = 0; other < axis; other++) {
            for (int k = 0; k < 4; k++) {
                float covariance = estimate->covariance[COVARIANCE_AT(axis, k / 2, other, k % 2)];
                imm->is_coupled |= (uint8_t)(covariance > 0.0f || covariance < 0.0f);
            }
        }
    }
    imm->probability = 0.5f;
    imm->calm = model->calm_s / (model->calm_s + RHO_IMM_CALM_S);
}

/* Weights of one model's mixed moments: itself, the other, and the product of differences. */
struct mixing {
    float own, other, spread;
};

/* Weights with which each model's estimate is mixed with the other's. */
struct mixing_weights {
    struct mixing steady, manoeuvre;
};

/* Predicts the Markov chain's probabilities, and returns the weights for mixing the models. */
static struct mixing_weights update_markov_chain(struct rho_imm *imm,
                                                 const struct rho_imm_step *step)
{
    const float was = imm->probability, was_steady = 1.0f - was;
    const float calm = was_steady * imm->calm, agile = was_steady - calm;
    const float begins = calm * step->calm_begins + agile * step->begins;
    const float ends = was < step->odds_over * was_steady ? 0.0f : was * step->ends;
    /* sums instead of differences from 1: no cancellation if a model is nearly certain */
    const float calm_stays = calm * (1.0f - step->calm_begins);
    const float agile_stays = agile * (1.0f - step->begins);
    const float stay = calm_stays + agile_stays, is = begins + (was - ends);
    /* FLT_MIN: no division by 0, as a state may have probability 0 after rounding */
    const float is_steady = ends + stay + FLT_MIN;
    const float steady = ends / is_steady, manoeuvre = begins / (is + FLT_MIN);
    imm->calm = (calm_stays + agile_stays * step->settles) / is_steady;
    imm->probability = is;
    return (struct mixing_weights){
        .steady = {1.0f - steady, steady, steady * (1.0f - steady)},
        .manoeuvre = {1.0f - manoeuvre, manoeuvre, manoeuvre * (1.0f - manoeuvre)},
    };
}

static inline float mixed_moment(const struct mixing *by, float own, float other, float product)
{
    return by->own * own + by->other * other + by->spread * product;
}

/* Mixes the estimates of both models on one axis. */
static inline void mix_axis(struct axis *steady, struct axis *manoeuvre, struct accel *more,
                            const struct mixing_weights *by)
{
    const struct mixing *s = &by->steady, *m = &by->manoeuvre;
    const float p = manoeuvre->p - steady->p, v = manoeuvre->v - steady->v, a = more->a;
    const struct axis was = *steady;
    if (s->other > 0.0f) {
        steady->p += s->other * p;
        steady->v += s->other * v;
        steady->pp = mixed_moment(s, was.pp, manoeuvre->pp, p * p);
        steady->vp = mixed_moment(s, was.vp, manoeuvre->vp, v * p);
        steady->vv = mixed_moment(s, was.vv, manoeuvre->vv, v * v);
    }
    manoeuvre->p -= m->other * p;
    manoeuvre->v -= m->other * v;
    manoeuvre->pp = mixed_moment(m, manoeuvre->pp, was.pp, p * p);
    manoeuvre->vp = mixed_moment(m, manoeuvre->vp, was.vp, v * p);
    manoeuvre->vv = mixed_moment(m, manoeuvre->vv, was.vv, v * v);
    more->a -= m->other * a;
    more->ap = m->own * more->ap + m->spread * a * p;
    more->av = m->own * more->av + m->spread * a * v;
    more->aa = m->own * more->aa + m->spread * a * a;
}

/* Mixes both models' covariances of two axes; a, b: differences of the models on these axes. */
static inline void mix_axis_pair(struct axis_pair *steady, struct axis_pair *manoeuvre,
                                 const struct model_difference *a, const struct model_difference *b,
                                 const struct mixing_weights *by)
{
    const struct mixing *s = &by->steady, *m = &by->manoeuvre;
    const struct axis_pair was = *steady;
    steady->pp = mixed_moment(s, was.pp, manoeuvre->pp, a->p * b->p);
    steady->pv = mixed_moment(s, was.pv, manoeuvre->pv, a->p * b->v);
    steady->vp = mixed_moment(s, was.vp, manoeuvre->vp, a->v * b->p);
    steady->vv = mixed_moment(s, was.vv, manoeuvre->vv, a->v * b->v);
    manoeuvre->pp = mixed_moment(m, manoeuvre->pp, was.pp, a->p * b->p);
    manoeuvre->pv = mixed_moment(m, manoeuvre->pv, was.pv, a->p * b->v);
    manoeuvre->vp = mixed_moment(m, manoeuvre->vp, was.vp, a->v * b->p);
    manoeuvre->vv = mixed_moment(m, manoeuvre->vv, was.vv, a->v * b->v);
    /* the steady model's acceleration is 0 with variance 0 */
    manoeuvre->pa = m->own * manoeuvre->pa + m->spread * a->p * b->a;
    manoeuvre->va = m->own * manoeuvre->va + m->spread * a->v * b->a;
    manoeuvre->ap = m->own * manoeuvre->ap + m->spread * a->a * b->p;
    manoeuvre->av = m->own * manoeuvre->av + m->spread * a->a * b->v;
    manoeuvre->aa = m->own * manoeuvre->aa + m->spread * a->a * b->a;
}

/* A variance raised by thirty-two units of rounding, as in kalman.c, and to the least; or NaN. */
static inline float predicted_variance(float variance)
{
    return rho_larger(RHO_VARIANCE_MIN, variance * (1.0f + RHO_ROUNDING_UNITS(32)));
}

/* Predicts the manoeuvring model's covariances of two axes, F C F^T: columns, then rows. */
static inline void propagate_cross_covariance(struct axis_pair *at, const struct rho_imm_step *step)
{
    const float dt = step->dt_s, f = step->position_by_accel, g = step->velocity_by_accel,
                h = step->accel_by_accel;
    const float pp = at->pp + dt * at->vp + f * at->ap, pv = at->pv + dt * at->vv + f * at->av;
    const float pa = at->pa + dt * at->va + f * at->aa;
    const float vp = at->vp + g * at->ap, vv = at->vv + g * at->av, va = at->va + g * at->aa;
    const float ap = h * at->ap, av = h * at->av, aa = h * at->aa;
    *at = (struct axis_pair){
        .pp = pp + dt * pv + f * pa,
        .pv = pv + g * pa,
        .pa = h * pa,
        .vp = vp + dt * vv + f * va,
        .vv = vv + g * va,
        .va = h * va,
        .ap = ap + dt * av + f * aa,
        .av = av + g * aa,
        .aa = h * aa,
    };
}

static inline struct model_difference model_difference(const struct rho_imm *imm, int axis)
{
    return (struct model_difference){
        .p = imm->state[axis] - imm->steady.state[axis],
        .v = imm->state[RHO_AXES + axis] - imm->steady.state[RHO_AXES + axis],
        .a = imm->state[2 * RHO_AXES + axis],
    };
}

/*
 * Predicts both models' covariances of an axis with an earlier one; called before the axes
 * themselves are mixed, as mixing needs their differences.
 */
static void predict_cross_covariance(struct rho_imm *imm, int axis, int other,
                                     const struct mixing_weights *by,
                                     const struct rho_imm_step *step)
{
    float *p = imm->covariance, *q = imm->steady.covariance;
    const uint8_t *rows = pair_rows[axis + other - 1];
    struct axis_pair steady = load_steady_axis_pair(q, rows), manoeuvre = load_axis_pair(p, rows);
    if (by) {
        const struct model_difference a = model_difference(imm, axis),
                                      b = model_difference(imm, other);
        mix_axis_pair(&steady, &manoeuvre, &a, &b, by);
    }
    const float pv = steady.pv + step->dt_s * steady.vv;
    steady.vp += step->dt_s * steady.vv;
    steady.pp += step->dt_s * (steady.pv + steady.vp);
    steady.pv = pv;
    propagate_cross_covariance(&manoeuvre, step);
    store_steady_axis_pair(q, rows, &steady);
    store_axis_pair(p, rows, &manoeuvre);
}

/*
 * The steady model's noise density. Where range rates tell, agile targets may turn gently; few do
 * as long as calm ones are as probable.
 */
static inline float steady_density(const struct rho_imm *imm, const struct rho_imm_step *step)
{
    const float agile2 = (1.0f - imm->calm) * (1.0f - imm->calm);
    return imm->has_rates
               ? step->calm_density +
                     agile2 * agile2 * (TURN_NOISE * step->quiet_density - step->calm_density)
               : step->quiet_density + imm->calm * (step->calm_density - step->quiet_density);
}

/* The models are mixed before the prediction if their weights are given. */
static enum rho_status predict_models(struct rho_imm *imm, const struct rho_imm_step *step,
                                      const struct mixing_weights *by)
{
    if (!(step->dt_s >= -RHO_KALMAN_STEP_MAX_S && step->dt_s <= RHO_KALMAN_STEP_MAX_S)) {
        return RHO_ERROR_VALUE;
    }
    if (imm->is_coupled) {
        predict_cross_covariance(imm, RHO_Y, RHO_X, by, step);
        if (has_estimate_on_axis(imm, RHO_Z)) {
            predict_cross_covariance(imm, RHO_Z, RHO_X, by, step);
            predict_cross_covariance(imm, RHO_Z, RHO_Y, by, step);
        }
    }
    struct rho_kalman *kalman = &imm->steady;
    const float dt = step->dt_s, *noise = step->noise;
    const float density = steady_density(imm, step);
    const float quiet_noise[RHO_TRIANGLE(2)] = {density * step->quiet_noise[0],
                                                density * step->quiet_noise[1],
                                                density * step->quiet_noise[2]};
    float state_sum = 0.0f; /* finite if all states are */
    int is_good = 1;
    const float unseen_ms = (float)imm->unseen_ms + 1e3f * step->quiet_noise[2];
    imm->unseen_ms = unseen_ms < 65535.0f ? (uint16_t)unseen_ms : 65535;
    for (int axis = 0; axis < RHO_AXES; axis++) {
        if (!has_estimate_on_axis(imm, axis)) {
            /* NaN: neither open nor closed */
            is_good &= imm->covariance[RHO_AT(axis, axis)] >= 0.0f;
            continue;
        }
        struct axis at = load_axis(kalman->state, kalman->covariance, axis);
        struct axis manoeuvre = load_axis(imm->state, imm->covariance, axis);
        struct accel more = load_accel(imm, axis);
        if (by) {
            mix_axis(&at, &manoeuvre, &more, by);
        }
        /* F x and F P F^T + Q, of the steady model, then of the manoeuvring one */
        at.p += dt * at.v;
        at.pp = predicted_variance(at.pp + dt * (2.0f * at.vp + dt * at.vv) + quiet_noise[0]);
        at.vp += dt * at.vv + quiet_noise[1];
        at.vv = predicted_variance(at.vv + quiet_noise[2]);
        manoeuvre.p += dt * manoeuvre.v + step->position_by_accel * more.a;
        manoeuvre.v += step->velocity_by_accel * more.a;
        more.a *= step->accel_by_accel;
        propagate_axis_covariance(&manoeuvre, &more, step);
        manoeuvre.pp = predicted_variance(manoeuvre.pp + noise[0]);
        manoeuvre.vp += noise[1];
        manoeuvre.vv = predicted_variance(manoeuvre.vv + noise[2]);
        more.ap += noise[3];
        more.av += noise[4];
        more.aa = predicted_variance(more.aa + noise[5]);
        store_axis(kalman->state, kalman->covariance, axis, &at);
        store_axis(imm->state, imm->covariance, axis, &manoeuvre);
        store_accel(imm, axis, &more);
        is_good &= at.pp + at.vv <= RHO_VARIANCE_MAX;
        is_good &= manoeuvre.pp + manoeuvre.vv + more.aa <= RHO_VARIANCE_MAX;
        state_sum += at.p + at.v + manoeuvre.p + manoeuvre.v + more.a;
    }
    return is_good && rho_is_finite(state_sum) ? RHO_OK : RHO_ERROR_VALUE;
}

enum rho_status rho_imm_predict_unmixed(struct rho_imm *imm, const struct rho_imm_step *step)
{
    return predict_models(imm, step, 0);
}

enum rho_status rho_imm_predict(struct rho_imm *imm, const struct rho_imm_step *step)
{
    if (!(step->begins + step->ends > 0.0f)) {
        return predict_models(imm, step, 0);
    }
    const struct mixing_weights by = update_markov_chain(imm, step);
    return predict_models(imm, step, &by);
}

void rho_imm_estimate(const struct rho_imm *imm, struct rho_kalman *estimate, float accel_mps2[3])
{
    const float m = imm->probability, s = 1.0f - m;
    float difference[RHO_KALMAN_STATES];
    int place = 0;
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        difference[i] = imm->state[i] - imm->steady.state[i];
        estimate->state[i] = imm->steady.state[i] + m * difference[i];
        for (int j = 0; j <= i; j++, place++) {
            estimate->covariance[place] = s * imm->steady.covariance[place] +
                                          m * imm->covariance[place] +
                                          s * m * difference[i] * difference[j];
        }
    }
    for (int axis = 0; accel_mps2 && axis < RHO_AXES; axis++) {
        accel_mps2[axis] = m * imm->state[2 * RHO_AXES + axis];
    }
}
