/* SPDX-License-Identifier: MIT */
/*
 * imm_update: updates both models with a plot, by scalar updates: axis by axis while the axes are
 * independent, else by rows along the axes of the plot's noise.
 */
#include <float.h>

#include "imm_plane_update.h"
#include "rhotrack/detail/approx.h"

/* Factor by which a variance is raised before it is reduced, against rounding, as in linalg.c. */
#define ROUNDING_ALLOWANCE (1.0f + 1.0f / 1048576.0f)

/* Raises a variance of an open axis to the floor: with less the axis would look closed. */
static float at_least_floor(float variance)
{
    return variance > RHO_KALMAN_VARIANCE_MIN ? variance : RHO_KALMAN_VARIANCE_MIN;
}

/* ---- independent axes ------------------------------------------------------------------------ */

/* Factors of a scalar update: 1 / S, and the share R / S of the measured variance that remains. */
struct update_factors {
    float inverse, kept;
};

/* Factors for a predicted variance and the variance of the measurement's noise. */
static inline struct update_factors update_factors_of(float predicted, float variance)
{
    const float inverse = 1.0f / (predicted + variance);
    return (struct update_factors){inverse, variance * inverse};
}

/*
 * Updates position and velocity of one axis by a position. The measured element's row is scaled by
 * R / S instead of being reduced by a difference: no digits cancel.
 */
static inline void apply_position_update(struct axis *at, const struct update_factors *by,
                                         float step)
{
    const float gain_v = at->vp * by->inverse;
    at->p += at->pp * step;
    at->v += at->vp * step;
    at->vv = at_least_floor(at->vv * ROUNDING_ALLOWANCE - gain_v * at->vp);
    at->pp = at_least_floor(at->pp * by->kept);
    at->vp *= by->kept;
}

static inline void apply_velocity_measurement(struct axis *at, const struct update_factors *by,
                                              float step)
{
    const float gain_p = at->vp * by->inverse;
    at->p += at->vp * step;
    at->v += at->vv * step;
    at->pp = at_least_floor(at->pp * ROUNDING_ALLOWANCE - gain_p * at->vp);
    at->vv = at_least_floor(at->vv * by->kept);
    at->vp *= by->kept;
}

/*
 * Updates the acceleration of one axis, before position and velocity. with_seen: covariance of the
 * acceleration with the measured element; with_other: with the other element; vp: covariance of
 * these two elements.
 */
static inline void update_axis_acceleration_by_measurement(struct accel *at, float *with_seen,
                                                           float *with_other, float vp,
                                                           const struct update_factors *by,
                                                           float step)
{
    const float gain = *with_seen * by->inverse;
    at->a += *with_seen * step;
    *with_other -= gain * vp;
    at->aa = at_least_floor(at->aa * ROUNDING_ALLOWANCE - gain * *with_seen);
    *with_seen *= by->kept;
}

/*
 * Updates one axis by its position; more: its acceleration, NULL for the steady model. The result
 * is a check: not finite if anything computed is not. S is never 0, as the noise variance is at
 * least the floor.
 */
static inline float update_axis_position_get_finiteness_check(struct axis *at, struct accel *more,
                                                              float place_m, float variance)
{
    const struct update_factors by = update_factors_of(at->pp, variance);
    const float off = place_m - at->p, step = off * by.inverse;
    const float check = at->pp >= 0.0f ? off * step + at->pp : FLT_MAX + FLT_MAX;
    if (more) {
        update_axis_acceleration_by_measurement(more, &more->ap, &more->av, at->vp, &by, step);
    }
    apply_position_update(at, &by, step);
    return check + at->p + at->v;
}

/*
 * Updates one axis by its velocity. Returns a check as update_axis_position_get_finiteness_check
 * does.
 */
static inline float update_axis_velocity_finite_if_ok(struct axis *at, struct accel *more,
                                                      float speed_mps, float variance)
{
    const struct update_factors by = update_factors_of(at->vv, variance);
    const float off = speed_mps - at->v, step = off * by.inverse;
    const float check = at->vv >= 0.0f ? off * step + at->vv : FLT_MAX + FLT_MAX;
    if (more) {
        update_axis_acceleration_by_measurement(more, &more->av, &more->ap, at->vp, &by, step);
    }
    apply_velocity_measurement(at, &by, step);
    return check + at->p + at->v;
}

/* Updates both models by the position, axis by axis. The result is not finite after a failure. */
static float update_positions_get_finiteness_check(struct rho_imm *imm, int num_axes,
                                                   const struct rho_imm_plot *seen)
{
    struct rho_kalman *kalman = &imm->steady;
    const float variance = at_least_floor(seen->position.variance_m2[0]);
    float check = 0.0f;
    for (int axis = 0; axis < num_axes; axis++) {
        const float place_m = seen->position.place_m[axis];
        struct axis steady = load_axis(kalman->state, kalman->covariance, axis);
        struct axis at = load_axis(imm->state, imm->covariance, axis);
        struct accel more = load_accel(imm, axis);
        check += update_axis_position_get_finiteness_check(&steady, 0, place_m, variance);
        check += update_axis_position_get_finiteness_check(&at, &more, place_m, variance) + more.a;
        store_axis(kalman->state, kalman->covariance, axis, &steady);
        store_axis(imm->state, imm->covariance, axis, &at);
        store_accel(imm, axis, &more);
    }
    return check;
}

/* Updates both models by the velocity, axis by axis. The result is not finite after a failure. */
static float update_velocities_get_finiteness_check(struct rho_imm *imm, int num_axes,
                                                    const struct rho_imm_plot *seen)
{
    struct rho_kalman *kalman = &imm->steady;
    const float variance = at_least_floor(seen->plot->sigma_mps * seen->plot->sigma_mps);
    float check = 0.0f;
    for (int axis = 0; axis < num_axes; axis++) {
        const float speed_mps = plot_velocity_component(seen->plot, axis);
        struct axis steady = load_axis(kalman->state, kalman->covariance, axis);
        struct axis at = load_axis(imm->state, imm->covariance, axis);
        struct accel more = load_accel(imm, axis);
        check += update_axis_velocity_finite_if_ok(&steady, 0, speed_mps, variance);
        check += update_axis_velocity_finite_if_ok(&at, &more, speed_mps, variance) + more.a;
        store_axis(kalman->state, kalman->covariance, axis, &steady);
        store_axis(imm->state, imm->covariance, axis, &at);
        store_accel(imm, axis, &more);
    }
    return check;
}

static enum rho_status update_independent_axes(struct rho_imm *imm, int num_axes,
                                               const struct rho_imm_plot *seen)
{
    float check = update_positions_get_finiteness_check(imm, num_axes, seen);
    if (seen->measures & RHO_MEASURES_VELOCITY) {
        check += update_velocities_get_finiteness_check(imm, num_axes, seen);
    }
    return rho_is_finite(check) ? RHO_OK : RHO_ERROR_SINGULAR;
}

/* ---- coupled axes ---------------------------------------------------------------------------- */

/* Raises the manoeuvring model's variances that are not 0: 0 marks a closed axis. */
static void raise_manoeuvre_variances_to_floor(struct rho_imm *imm)
{
    for (int i = 0; i < RHO_IMM_STATES; i++) {
        float *variance = &imm->covariance[RHO_AT(i, i)];
        if (*variance < RHO_KALMAN_VARIANCE_MIN && (*variance > 0.0f || *variance < 0.0f)) {
            *variance = RHO_KALMAN_VARIANCE_MIN;
        }
    }
}

static float dot_position(const float *row, const float *state)
{
    return row[RHO_X] * state[RHO_X] + row[RHO_Y] * state[RHO_Y] + row[RHO_Z] * state[RHO_Z];
}

/* Scalar update of both models by the position along a direction. */
static enum rho_status update_position_along(struct rho_imm *imm, const float direction[3],
                                             const float place_m[3], float variance)
{
    float row[RHO_KALMAN_STATES] = {direction[0], direction[1], direction[2], 0.0f, 0.0f, 0.0f};
    float innovation_m[3], noise = at_least_floor(variance);
    for (int i = 0; i < 3; i++) {
        innovation_m[i] = place_m[i] - imm->steady.state[i];
    }
    enum rho_status status =
        rho_kalman_update_row(&imm->steady, row, dot_position(direction, innovation_m), noise, 0);
    if (status != RHO_OK) {
        return status;
    }
    for (int i = 0; i < 3; i++) {
        innovation_m[i] = place_m[i] - imm->state[i];
    }
    return rho_linalg_update_row(RHO_IMM_STATES, imm->state, imm->covariance, 3, row,
                                 dot_position(direction, innovation_m), noise);
}

/* Updates both models by one element of the state. */
static enum rho_status update_both_models_by_element(struct rho_imm *imm, int element, float value,
                                                     float variance)
{
    float noise = at_least_floor(variance);
    enum rho_status status = rho_kalman_update(&imm->steady, element, value, noise, 0);
    return status == RHO_OK ? rho_linalg_update_element(RHO_IMM_STATES, imm->state, imm->covariance,
                                                        element, value - imm->state[element], noise)
                            : status;
}

/* Variance of the range along the ground, from the variances along the line of sight and up. */
static float ground_range_variance(const struct rho_measurement *seen)
{
    return seen->has_z ? seen->cos_elevation * seen->cos_elevation * seen->variance_m2[0] +
                             seen->sin_elevation * seen->sin_elevation * seen->variance_m2[2]
                       : seen->variance_m2[0];
}

/*
 * Updates both models with a position along the axes of its noise. If either plot or estimate has
 * no height, the range along the ground is used.
 */
static enum rho_status update_position_along_noise_axes(struct rho_imm *imm, int num_axes,
                                                        const struct rho_measurement *seen)
{
    const float ca = seen->cos_azimuth, sa = seen->sin_azimuth;
    const int has_z = num_axes == NUM_AXES;
    const float ce = has_z ? seen->cos_elevation : 1.0f, se = has_z ? seen->sin_elevation : 0.0f;
    const float along[3] = {ce * ca, ce * sa, se}, cross[3] = {-sa, ca, 0.0f};
    const float up[3] = {-se * ca, -se * sa, ce};
    const float variance = has_z ? seen->variance_m2[0] : ground_range_variance(seen);
    const float *place_m = seen->place_m;
    enum rho_status status = update_position_along(imm, cross, place_m, seen->variance_m2[1]);
    if (status == RHO_OK && has_z) {
        status = update_position_along(imm, up, place_m, seen->variance_m2[2]);
    }
    return status == RHO_OK ? update_position_along(imm, along, place_m, variance) : status;
}

static enum rho_status update_velocity(struct rho_imm *imm, int num_axes,
                                       const struct rho_plot *plot)
{
    enum rho_status status = RHO_OK;
    for (int axis = 0; axis < num_axes && status == RHO_OK; axis++) {
        status =
            update_both_models_by_element(imm, NUM_AXES + axis, plot_velocity_component(plot, axis),
                                          plot->sigma_mps * plot->sigma_mps);
    }
    return status;
}

/* Each model linearises the range rate at its estimate after the position update. */
static enum rho_status update_range_rate(struct rho_imm *imm, const struct rho_imm_plot *seen)
{
    const float rate_mps = seen->plot->range_rate_mps;
    const float variance =
        at_least_floor(seen->plot->sigma_range_rate_mps * seen->plot->sigma_range_rate_mps);
    struct rho_kalman at;
    struct rho_kalman_row rate;
    load_kinematics(&at, imm->state, imm->covariance);
    enum rho_status status =
        rho_kalman_update_range_rate(&imm->steady, seen->sensor, rate_mps, variance);
    if (status != RHO_OK ||
        !rho_kalman_linearise_range_rate(&at, seen->sensor, rate_mps, variance, &rate) ||
        !rho_kalman_can_unfold_range_rate(&at, seen->sensor, &rate)) {
        return status;
    }
    return rho_linalg_update_row(RHO_IMM_STATES, imm->state, imm->covariance, RHO_KALMAN_STATES,
                                 rate.row, rate.innovation, rate.variance);
}

static enum rho_status update_coupled_axes(struct rho_imm *imm, int num_axes,
                                           const struct rho_imm_plot *seen)
{
    enum rho_status status = RHO_OK;
    if (!seen->position.is_isotropic) {
        status = update_position_along_noise_axes(imm, num_axes, &seen->position);
    } else {
        for (int axis = 0; axis < num_axes && status == RHO_OK; axis++) {
            status = update_both_models_by_element(imm, axis, seen->position.place_m[axis],
                                                   seen->position.variance_m2[0]);
        }
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_VELOCITY)) {
        status = update_velocity(imm, num_axes, seen->plot);
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        status = update_range_rate(imm, seen);
    }
    raise_manoeuvre_variances_to_floor(imm);
    return status;
}

/* ---- without a height ------------------------------------------------------------------------ */

static enum rho_status update_plane_position_along(struct rho_imm *imm, float x, float y,
                                                   const float place_m[3], float variance)
{
    const float noise = at_least_floor(variance);
    float *steady = imm->steady.state, *state = imm->state, spread[RHO_PLANE_MANOEUVRE];
    float predicted = rho_imm_plane_project_along_direction(RHO_PLANE_STEADY,
                                                            imm->steady.covariance, x, y, spread);
    enum rho_status status = rho_imm_plane_update(
        RHO_PLANE_STEADY, steady, imm->steady.covariance, spread, predicted,
        x * (place_m[0] - steady[RHO_X]) + y * (place_m[1] - steady[RHO_Y]), noise);
    if (status != RHO_OK) {
        return status;
    }
    predicted =
        rho_imm_plane_project_along_direction(RHO_PLANE_MANOEUVRE, imm->covariance, x, y, spread);
    return rho_imm_plane_update(RHO_PLANE_MANOEUVRE, state, imm->covariance, spread, predicted,
                                x * (place_m[0] - state[RHO_X]) + y * (place_m[1] - state[RHO_Y]),
                                noise);
}

/* Updates one model with a range rate, linearised at its estimate after the position update. */
static enum rho_status update_plane_range_rate(int num_states, float *state, float *covariance,
                                               const struct rho_imm_plot *seen)
{
    const float sigma_mps = seen->plot->sigma_range_rate_mps;
    float spread[RHO_PLANE_MANOEUVRE];
    struct plane_rate rate;
    if (!rho_imm_plane_predict_range_rate(state, covariance, seen->sensor, &rate)) {
        return RHO_OK;
    }
    const float predicted =
        rho_imm_plane_project_range_rate(num_states, covariance, rate.row, spread);
    const float variance = at_least_floor(sigma_mps * sigma_mps) + rate.nonlinearity;
    float off_mps = seen->plot->range_rate_mps - rate.expected_mps;
    if (rho_measurement_has_ambiguous_range_rates(seen->sensor)) {
        if (!rho_measurement_can_unfold_range_rate(seen->sensor, predicted + variance)) {
            return RHO_OK;
        }
        off_mps = rho_measurement_range_rate_innovation_mps(
            seen->sensor, seen->plot->range_rate_mps, rate.expected_mps);
    }
    return rho_imm_plane_update(num_states, state, covariance, spread, predicted, off_mps,
                                variance);
}

/*
 * Updates both models without a height. Of a plot with a height, the range along the ground is
 * used.
 */
static enum rho_status update_in_plane(struct rho_imm *imm, const struct rho_imm_plot *seen)
{
    const struct rho_measurement *at = &seen->position;
    const float ca = at->cos_azimuth, sa = at->sin_azimuth;
    enum rho_status status =
        update_plane_position_along(imm, -sa, ca, at->place_m, at->variance_m2[1]);
    if (status == RHO_OK) {
        status = update_plane_position_along(imm, ca, sa, at->place_m, ground_range_variance(at));
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        status = update_plane_range_rate(RHO_PLANE_STEADY, imm->steady.state,
                                         imm->steady.covariance, seen);
        if (status == RHO_OK) {
            status =
                update_plane_range_rate(RHO_PLANE_MANOEUVRE, imm->state, imm->covariance, seen);
        }
    }
    rho_imm_plane_floor_variances(RHO_PLANE_STEADY, imm->steady.covariance);
    rho_imm_plane_floor_variances(RHO_PLANE_MANOEUVRE, imm->covariance);
    return status;
}

/* ---- public ---------------------------------------------------------------------------------- */

/* Opens the third axis of both models with the plot's height. */
static enum rho_status open_height_axis(struct rho_imm *imm, const struct rho_imm_model *model,
                                        const struct rho_imm_plot *seen)
{
    const float noise = seen->covariance[RHO_ZZ];
    enum rho_status status =
        rho_kalman_open_axis(&imm->steady, RHO_Z, seen->position.place_m[2], at_least_floor(noise),
                             model->speed_sigma_mps * model->speed_sigma_mps);
    if (status != RHO_OK) {
        return status;
    }
    imm->state[RHO_Z] = seen->position.place_m[2];
    imm->covariance[COVARIANCE_AT(RHO_Z, 0, RHO_Z, 0)] = at_least_floor(noise);
    imm->covariance[COVARIANCE_AT(RHO_Z, 1, RHO_Z, 1)] =
        model->speed_sigma_mps * model->speed_sigma_mps;
    imm->covariance[COVARIANCE_AT(RHO_Z, 2, RHO_Z, 2)] =
        at_least_floor(model->accel_sigma_mps2 * model->accel_sigma_mps2);
    return RHO_OK;
}

enum rho_status rho_imm_update(struct rho_imm *imm, const struct rho_imm_model *model,
                               const struct rho_imm_plot *seen, const struct rho_imm_match *match)
{
    if (!imm || !model || !seen || !match) {
        return RHO_ERROR_NULL;
    }
    const int opens = seen->position.has_z && !has_estimate_on_axis(imm, RHO_Z);
    const int num_axes = seen->position.has_z && !opens ? 3 : 2;
    const int is_simple = !imm->is_coupled && seen->position.is_isotropic &&
                          !(seen->measures & RHO_MEASURES_RANGE_RATE);
    const int is_in_plane =
        !has_estimate_on_axis(imm, RHO_Z) && !(seen->measures & RHO_MEASURES_VELOCITY);
    imm->is_coupled |= !is_simple;
    enum rho_status status = is_simple     ? update_independent_axes(imm, num_axes, seen)
                             : is_in_plane ? update_in_plane(imm, seen)
                                           : update_coupled_axes(imm, num_axes, seen);
    if (status == RHO_OK && opens) {
        status = open_height_axis(imm, model, seen);
    }
    imm->probability = match->probability;
    return status;
}

enum rho_status rho_imm_update_bearing(struct rho_imm *imm, float x_m, float y_m, float bearing_rad,
                                       float sigma_rad, float *gain_nat)
{
    struct rho_kalman at;
    struct rho_kalman_bearing bearings[2];
    float variance[2], projected[RHO_KALMAN_STATES];
    if (!imm || !gain_nat) {
        return RHO_ERROR_NULL;
    }
    if (!rho_is_finite(bearing_rad) || !(sigma_rad > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    load_kinematics(&at, imm->state, imm->covariance);
    *gain_nat = 0.0f;
    if (!rho_kalman_linearise_bearing(&imm->steady, x_m, y_m, bearing_rad, sigma_rad,
                                      &bearings[0]) ||
        !rho_kalman_linearise_bearing(&at, x_m, y_m, bearing_rad, sigma_rad, &bearings[1])) {
        return RHO_OK;
    }
    variance[0] = rho_linalg_project6(imm->steady.covariance, bearings[0].row, projected) +
                  bearings[0].variance_m2;
    variance[1] =
        rho_linalg_project6(at.covariance, bearings[1].row, projected) + bearings[1].variance_m2;
    imm->is_coupled = 1;
    enum rho_status status = rho_kalman_update_row(&imm->steady, bearings[0].row, bearings[0].off_m,
                                                   bearings[0].variance_m2, 0);
    if (status == RHO_OK) {
        status = rho_linalg_update_row(RHO_IMM_STATES, imm->state, imm->covariance, 2,
                                       bearings[1].row, bearings[1].off_m, bearings[1].variance_m2);
    }
    raise_manoeuvre_variances_to_floor(imm);
    if (status == RHO_OK) {
        const float innovations_m[2] = {bearings[0].off_m, bearings[1].off_m};
        rho_imm_update_probability(imm, innovations_m, variance, gain_nat);
    }
    return status;
}
