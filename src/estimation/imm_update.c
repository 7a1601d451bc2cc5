/* SPDX-License-Identifier: MIT */
/* imm_update: updates both models by scalars: of each axis, or rows along the noise's axes. */
#include <float.h>

#include "imm_plane_update.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

/* An axis with position and velocity exchanged, so that a velocity is measured as a position is. */
static inline struct axis exchanged(struct axis at)
{
    return (struct axis){.p = at.v, .v = at.p, .pp = at.vv, .vp = at.vp, .vv = at.pp};
}

static inline struct accel exchanged_accel(struct accel at)
{
    return (struct accel){.a = at.a, .ap = at.av, .av = at.ap, .aa = at.aa};
}

/*
 * Updates one axis by its position, or by its velocity with the elements exchanged; more: its
 * acceleration, NULL for the steady model. The measured element's row is scaled by R / S instead of
 * being reduced by a difference: no digits cancel. S is never 0, as the noise variance is at least
 * the floor. The result is a check: not finite if anything computed is not.
 */
static inline float update_axis(struct axis *at, struct accel *more, float place_m, float variance)
{
    const float inverse = 1.0f / (at->pp + variance), kept = variance * inverse;
    const float off = place_m - at->p, step = off * inverse, gain_v = at->vp * inverse;
    const float check = at->pp >= 0.0f ? off * step + at->pp : FLT_MAX + FLT_MAX;
    if (more) {
        const float gain = more->ap * inverse;
        more->a += more->ap * step;
        more->av -= gain * at->vp;
        more->aa = rho_kalman_floored(more->aa * RHO_ROUNDING_ALLOWANCE - gain * more->ap);
        more->ap *= kept;
    }
    at->p += at->pp * step;
    at->v += at->vp * step;
    at->vv = rho_kalman_floored(at->vv * RHO_ROUNDING_ALLOWANCE - gain_v * at->vp);
    at->pp = rho_kalman_floored(at->pp * kept);
    at->vp *= kept;
    return check + at->p + at->v;
}

/* Updates both models axis by axis; a single axis has independent noise. */
static enum rho_status update_independent_axes(struct rho_imm *imm, int num_axes,
                                               const struct rho_imm_plot *seen)
{
    struct rho_kalman *kalman = &imm->steady;
    const float variance = rho_kalman_floored(seen->position.variance_m2[0]);
    const float speed_variance = rho_kalman_floored(seen->plot->sigma_mps * seen->plot->sigma_mps);
    float check = 0.0f; /* finite if everything is */
    for (int axis = 0; axis < num_axes; axis++) {
        const float place_m = seen->position.place_m[axis];
        struct axis steady = load_axis(kalman->state, kalman->covariance, axis);
        struct axis at = load_axis(imm->state, imm->covariance, axis);
        struct accel more = load_accel(imm, axis);
        check += update_axis(&steady, 0, place_m, variance);
        check += update_axis(&at, &more, place_m, variance) + more.a;
        if (seen->measures & RHO_MEASURES_VELOCITY) {
            const float speed_mps = plot_velocity_component(seen->plot, axis);
            steady = exchanged(steady);
            at = exchanged(at);
            more = exchanged_accel(more);
            check += update_axis(&steady, 0, speed_mps, speed_variance);
            check += update_axis(&at, &more, speed_mps, speed_variance) + more.a;
            steady = exchanged(steady);
            at = exchanged(at);
            more = exchanged_accel(more);
        }
        store_axis(kalman->state, kalman->covariance, axis, &steady);
        store_axis(imm->state, imm->covariance, axis, &at);
        store_accel(imm, axis, &more);
    }
    return rho_is_finite(check) ? RHO_OK : RHO_ERROR_SINGULAR;
}

/* Innovation of a state's position along a direction. */
static float innovation_along(const float *row, const float place_m[3], const float *state)
{
    return row[RHO_X] * (place_m[RHO_X] - state[RHO_X]) +
           row[RHO_Y] * (place_m[RHO_Y] - state[RHO_Y]) +
           row[RHO_Z] * (place_m[RHO_Z] - state[RHO_Z]);
}

/* Scalar update of both models by the position along a direction. */
static enum rho_status update_position_along(struct rho_imm *imm, const float direction[3],
                                             const float place_m[3], float variance)
{
    float row[RHO_KALMAN_STATES] = {direction[0], direction[1], direction[2], 0.0f, 0.0f, 0.0f};
    const float noise = rho_kalman_floored(variance);
    enum rho_status status = rho_kalman_update_row(
        &imm->steady, row, innovation_along(row, place_m, imm->steady.state), noise);
    return status == RHO_OK
               ? rho_linalg_update_row(RHO_IMM_STATES, imm->state, imm->covariance, 3, row,
                                       innovation_along(row, place_m, imm->state), noise)
               : status;
}

/*
 * Bayes update of the probability that a steady target is calm, by a range rate with innovation
 * off_mps of the variance given, of which `noise` is the measurement's. Since the last plot a
 * gentle turn has made the velocity uncertain by `turned` more than calm flight; the prediction had
 * agile^4 of that (imm.c).
 */
static void update_calm(struct rho_imm *imm, const struct rho_imm_model *model, float off_mps,
                        float variance, float noise)
{
    const float agile = 1.0f - imm->calm, agile2 = agile * agile;
    imm->has_rates = model->calm_s > 0.0f; /* 0: there are no calm targets */
    if (agile < 2.0f * AGILE_MIN && off_mps * off_mps < variance) {
        return; /* as calm as it gets */
    }
    const float unseen_s = 1e-3f * (float)imm->unseen_ms;
    const float turned = (TURN_NOISE * model->quiet_density - model->calm_density) * unseen_s;
    const float calm = rho_larger(noise, variance - agile2 * agile2 * turned);
    const float inverse = 1.0f / (calm * (calm + turned));
    const float gain_nat = 0.5f * off_mps * off_mps * turned * inverse;
    /* (1 + gain / 16)^16 for e^gain: less where a plot is far off, and a third of the time */
    const float root =
        1.0f + (1.0f / 16.0f) * (gain_nat < TURN_GAIN_MAX_NAT ? gain_nat : TURN_GAIN_MAX_NAT);
    const float power_4 = root * root * (root * root), power_8 = power_4 * power_4;
    const float odds = calm * rho_sqrt(inverse) * (power_8 * power_8);
    const float news = unseen_s < TURN_LASTS_S ? unseen_s * (1.0f / TURN_LASTS_S) : 1.0f;
    const float share = imm->calm / (imm->calm + agile * (1.0f - news + news * odds));
    imm->calm = share < 1.0f - AGILE_MIN ? share : 1.0f - AGILE_MIN;
}

/* Updates both models by one element of the state. */
static enum rho_status update_element(struct rho_imm *imm, int element, float value, float variance)
{
    float noise = rho_kalman_floored(variance);
    enum rho_status status = rho_kalman_update(&imm->steady, element, value, noise, 0);
    return status == RHO_OK ? rho_linalg_update_element(RHO_IMM_STATES, imm->state, imm->covariance,
                                                        element, value - imm->state[element], noise)
                            : status;
}

static enum rho_status update_coupled_axes(struct rho_imm *imm, const struct rho_imm_model *model,
                                           int num_axes, const struct rho_imm_plot *seen)
{
    const struct rho_measurement *at = &seen->position;
    enum rho_status status = RHO_OK;
    if (!at->is_isotropic) {
        /* along the axes of the noise; along the ground if plot or estimate has no height */
        const int has_z = num_axes == RHO_AXES;
        const float ca = at->cos_azimuth, sa = at->sin_azimuth;
        const float ce = has_z ? at->cos_elevation : 1.0f, se = has_z ? at->sin_elevation : 0.0f;
        const float along[3] = {ce * ca, ce * sa, se}, cross[3] = {-sa, ca, 0.0f};
        const float up[3] = {-se * ca, -se * sa, ce};
        const float variance = has_z ? at->variance_m2[0] : rho_measurement_ground_m2(at);
        status = update_position_along(imm, cross, at->place_m, at->variance_m2[1]);
        if (status == RHO_OK && has_z) {
            status = update_position_along(imm, up, at->place_m, at->variance_m2[2]);
        }
        if (status == RHO_OK) {
            status = update_position_along(imm, along, at->place_m, variance);
        }
    } else {
        for (int axis = 0; axis < num_axes && status == RHO_OK; axis++) {
            status = update_element(imm, axis, at->place_m[axis], at->variance_m2[0]);
        }
    }
    if (seen->measures & RHO_MEASURES_VELOCITY) {
        for (int axis = 0; axis < num_axes && status == RHO_OK; axis++) {
            status = update_element(imm, RHO_AXES + axis, plot_velocity_component(seen->plot, axis),
                                    seen->plot->sigma_mps * seen->plot->sigma_mps);
        }
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        /* each model linearises the range rate at its estimate after the position update */
        const float rate_mps = seen->plot->range_rate_mps;
        const float variance =
            rho_kalman_floored(seen->plot->sigma_range_rate_mps * seen->plot->sigma_range_rate_mps);
        struct rho_kalman manoeuvre;
        struct rho_kalman_row rate;
        float projected[RHO_KALMAN_STATES];
        load_kinematics(&manoeuvre, imm->state, imm->covariance);
        if (rho_kalman_linearise_rate(&imm->steady, seen->sensor, rate_mps, variance, &rate) &&
            rho_kalman_can_unfold(&imm->steady, seen->sensor, &rate)) {
            update_calm(imm, model, rate.innovation,
                        rho_linalg_project6(imm->steady.covariance, rate.row, projected) +
                            rate.variance,
                        rate.variance);
            status = rho_kalman_update_row(&imm->steady, rate.row, rate.innovation, rate.variance);
        }
        if (status == RHO_OK &&
            rho_kalman_linearise_rate(&manoeuvre, seen->sensor, rate_mps, variance, &rate) &&
            rho_kalman_can_unfold(&manoeuvre, seen->sensor, &rate)) {
            status =
                rho_linalg_update_row(RHO_IMM_STATES, imm->state, imm->covariance,
                                      RHO_KALMAN_STATES, rate.row, rate.innovation, rate.variance);
        }
    }
    rho_kalman_floor_variances(imm->covariance, RHO_IMM_STATES);
    return status;
}

static enum rho_status update_plane_place(struct rho_imm *imm, float x, float y,
                                          const float place_m[3], float variance)
{
    const float noise = rho_kalman_floored(variance);
    float *steady = imm->steady.state, *state = imm->state, spread[RHO_PLANE_MANOEUVRE];
    float predicted =
        rho_imm_plane_project_place(RHO_PLANE_STEADY, imm->steady.covariance, x, y, spread);
    enum rho_status status = rho_imm_plane_update(
        RHO_PLANE_STEADY, steady, imm->steady.covariance, spread, predicted,
        x * (place_m[0] - steady[RHO_X]) + y * (place_m[1] - steady[RHO_Y]), noise);
    if (status != RHO_OK) {
        return status;
    }
    predicted = rho_imm_plane_project_place(RHO_PLANE_MANOEUVRE, imm->covariance, x, y, spread);
    return rho_imm_plane_update(RHO_PLANE_MANOEUVRE, state, imm->covariance, spread, predicted,
                                x * (place_m[0] - state[RHO_X]) + y * (place_m[1] - state[RHO_Y]),
                                noise);
}

/* Updates one model with a range rate, linearised at its estimate after the position update. */
static enum rho_status update_plane_rate(struct rho_imm *imm, const struct rho_imm_model *model,
                                         int num_states, const struct rho_imm_plot *seen)
{
    const int is_steady = num_states == RHO_PLANE_STEADY;
    float *state = is_steady ? imm->steady.state : imm->state;
    float *covariance = is_steady ? imm->steady.covariance : imm->covariance;
    const float sigma_mps = seen->plot->sigma_range_rate_mps;
    float spread[RHO_PLANE_MANOEUVRE];
    struct plane_rate rate;
    if (!rho_imm_plane_rate(state, covariance, seen->sensor, &rate)) {
        return RHO_OK;
    }
    const float predicted = rho_imm_plane_project_rate(num_states, covariance, rate.row, spread);
    const float variance = rho_kalman_floored(sigma_mps * sigma_mps) + rate.nonlinearity;
    float off_mps = seen->plot->range_rate_mps - rate.expected_mps;
    if (rho_measurement_is_ambiguous(seen->sensor)) {
        if (!rho_measurement_can_unfold(seen->sensor, predicted + variance)) {
            return RHO_OK;
        }
        off_mps = rho_measurement_innovation_mps(seen->sensor, seen->plot->range_rate_mps,
                                                 rate.expected_mps);
    }
    if (is_steady) {
        update_calm(imm, model, off_mps, predicted + variance, variance);
    }
    return rho_imm_plane_update(num_states, state, covariance, spread, predicted, off_mps,
                                variance);
}

/* Updates both models without a height, by a plot's range along the ground. */
static enum rho_status update_in_plane(struct rho_imm *imm, const struct rho_imm_model *model,
                                       const struct rho_imm_plot *seen)
{
    const struct rho_measurement *at = &seen->position;
    const float ca = at->cos_azimuth, sa = at->sin_azimuth;
    enum rho_status status = update_plane_place(imm, -sa, ca, at->place_m, at->variance_m2[1]);
    if (status == RHO_OK) {
        status = update_plane_place(imm, ca, sa, at->place_m, rho_measurement_ground_m2(at));
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        status = update_plane_rate(imm, model, RHO_PLANE_STEADY, seen);
        if (status == RHO_OK) {
            status = update_plane_rate(imm, model, RHO_PLANE_MANOEUVRE, seen);
        }
    }
    rho_imm_plane_floor_variances(RHO_PLANE_STEADY, imm->steady.covariance);
    rho_imm_plane_floor_variances(RHO_PLANE_MANOEUVRE, imm->covariance);
    return status;
}

/* Gives both models a height, as rho_kalman_open_height; steady, manoeuvre: as they see it. */
static enum rho_status open_height(struct rho_imm *imm, const struct rho_imm_model *model,
                                   const struct rho_kalman_bearing *steady,
                                   const struct rho_kalman_bearing *manoeuvre)
{
    const float speed_variance = model->speed_sigma_mps * model->speed_sigma_mps;
    const float x = -manoeuvre->row[RHO_X], y = -manoeuvre->row[RHO_Y];
    float *p = imm->covariance, with_z[RHO_IMM_STATES];
    for (int i = 0; i < RHO_IMM_STATES; i++) {
        with_z[i] = x * p[RHO_AT(RHO_X, i)] + y * p[RHO_AT(RHO_Y, i)];
    }
    with_z[RHO_Z] = rho_kalman_floored(
        (x * with_z[RHO_X] + y * with_z[RHO_Y]) * RHO_ROUNDING_ALLOWANCE + manoeuvre->variance_m2);
    with_z[RHO_AXES + RHO_Z] = with_z[2 * RHO_AXES + RHO_Z] = 0.0f;
    imm->state[RHO_Z] += manoeuvre->off_m;
    for (int i = 0; i < RHO_IMM_STATES; i++) {
        p[RHO_AT(RHO_Z, i)] = with_z[i];
    }
    p[COVARIANCE_AT(RHO_Z, 1, RHO_Z, 1)] = speed_variance;
    p[COVARIANCE_AT(RHO_Z, 2, RHO_Z, 2)] =
        rho_kalman_floored(model->accel_sigma_mps2 * model->accel_sigma_mps2);
    return rho_kalman_open_height(&imm->steady, steady, speed_variance);
}

enum rho_status rho_imm_update(struct rho_imm *imm, const struct rho_imm_model *model,
                               const struct rho_imm_plot *seen, const struct rho_imm_match *match)
{
    const int opens = seen->position.has_z && !has_estimate_on_axis(imm, RHO_Z);
    const int num_axes = seen->position.has_z && !opens ? 3 : 2;
    const int is_simple = !imm->is_coupled && seen->position.is_isotropic &&
                          !(seen->measures & RHO_MEASURES_RANGE_RATE);
    const int is_in_plane =
        !has_estimate_on_axis(imm, RHO_Z) && !(seen->measures & RHO_MEASURES_VELOCITY);
    imm->is_coupled |= !is_simple;
    enum rho_status status = is_simple     ? update_independent_axes(imm, num_axes, seen)
                             : is_in_plane ? update_in_plane(imm, model, seen)
                                           : update_coupled_axes(imm, model, num_axes, seen);
    if (status == RHO_OK && opens) {
        const struct rho_kalman_bearing height = {.row = {[RHO_Z] = 1.0f},
                                                  .off_m = seen->position.place_m[2],
                                                  .variance_m2 =
                                                      rho_kalman_floored(seen->covariance[RHO_ZZ])};
        status = open_height(imm, model, &height, &height);
    }
    imm->probability = match->probability;
    imm->unseen_ms = 0;
    return status;
}

/* The estimate of a model, 0 the steady one; scratch is for the other's. */
static const struct rho_kalman *estimate_of(struct rho_kalman *scratch, const struct rho_imm *imm,
                                            int model)
{
    if (model == 0) {
        return &imm->steady;
    }
    load_kinematics(scratch, imm->state, imm->covariance);
    return scratch;
}

int rho_imm_score_bearing(const struct rho_imm *imm, const struct rho_weighed_bearings *look,
                          unsigned i, float *density, float *variance_rad2)
{
    struct rho_expected_bearing by[2];
    struct rho_kalman at;
    float probability = imm->probability;
    for (int k = 0; k < 2; k++) {
        if (!rho_bearing_expect(estimate_of(&at, imm, k), look, i, &by[k])) {
            return 0;
        }
    }
    const float densities[2] = {by[0].density, by[1].density};
    *density = rho_imm_weigh_models(&probability, densities);
    *variance_rad2 =
        by[0].variance_rad2 + probability * (by[1].variance_rad2 - by[0].variance_rad2);
    return by[0].nis <= RHO_IMM_GATE || by[1].nis <= RHO_IMM_GATE;
}

void rho_imm_mix_bearing(const struct rho_imm *imm, const struct rho_weighed_bearings *look,
                         unsigned i, struct rho_bearing_mix mixes[2])
{
    struct rho_expected_bearing by[2];
    struct rho_kalman at;
    if (rho_bearing_expect(estimate_of(&at, imm, 0), look, i, &by[0]) &&
        rho_bearing_expect(estimate_of(&at, imm, 1), look, i, &by[1])) {
        rho_bearing_mix_add(&mixes[0], look, i, &by[0]);
        rho_bearing_mix_add(&mixes[1], look, i, &by[1]);
    }
}

/* Updates one model's estimate with the mix of a look's bearings that it expects. */
static enum rho_status update_by_mix(struct rho_imm *imm, int model,
                                     const struct rho_weighed_bearings *look,
                                     const struct rho_bearing_mix *mix)
{
    struct rho_kalman at;
    struct rho_kalman_bearing seen;
    float off_rad, sigma_rad;
    if (!rho_bearing_mix_as_one(mix, look->miss, &off_rad, &sigma_rad) ||
        !rho_kalman_linearise_bearing(estimate_of(&at, imm, model), look->scan->x_m,
                                      look->scan->y_m, 0.0f, sigma_rad, &seen)) {
        return RHO_OK;
    }
    imm->is_coupled = 1;
    return model == 0 ? rho_kalman_update_row(&imm->steady, seen.row, off_rad * seen.range_m,
                                              seen.variance_m2)
                      : rho_linalg_update_row(RHO_IMM_STATES, imm->state, imm->covariance, 2,
                                              seen.row, off_rad * seen.range_m, seen.variance_m2);
}

enum rho_status rho_imm_update_bearings(struct rho_imm *imm,
                                        const struct rho_weighed_bearings *look,
                                        const struct rho_bearing_mix mixes[2], float *gain_nat)
{
    const float likelihood[2] = {look->miss + mixes[0].hit, look->miss + mixes[1].hit};
    *gain_nat = 0.0f;
    if (!rho_are_finite(likelihood, 2)) {
        return RHO_ERROR_VALUE;
    }
    enum rho_status status = update_by_mix(imm, 0, look, &mixes[0]);
    if (status == RHO_OK) {
        status = update_by_mix(imm, 1, look, &mixes[1]);
    }
    rho_kalman_floor_variances(imm->covariance, RHO_IMM_STATES);
    if (status == RHO_OK) {
        *gain_nat = rho_log(rho_imm_weigh_models(&imm->probability, likelihood) + FLT_MIN);
    }
    return status;
}

enum rho_status rho_imm_update_slope(struct rho_imm *imm, const struct rho_imm_model *model,
                                     const struct rho_slope *slope)
{
    struct rho_kalman at;
    struct rho_kalman_bearing seen, steady;
    load_kinematics(&at, imm->state, imm->covariance);
    if (!rho_kalman_linearise_slope(&imm->steady, slope, &steady) ||
        !rho_kalman_linearise_slope(&at, slope, &seen)) {
        return RHO_OK;
    }
    imm->is_coupled = 1;
    if (!has_estimate_on_axis(imm, RHO_Z)) {
        return open_height(imm, model, &steady, &seen);
    }
    enum rho_status status =
        rho_kalman_update_row(&imm->steady, steady.row, steady.off_m, steady.variance_m2);
    if (status == RHO_OK) {
        status = rho_linalg_update_row(RHO_IMM_STATES, imm->state, imm->covariance, 3, seen.row,
                                       seen.off_m, seen.variance_m2);
    }
    rho_kalman_floor_variances(imm->covariance, RHO_IMM_STATES);
    return status;
}
