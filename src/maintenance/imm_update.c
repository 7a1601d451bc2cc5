/* SPDX-License-Identifier: MIT */
/*
 * imm_update: both models take a plot, by scalar updates: axis by axis while the axes are independent, else by rows along
 * the axes of the plot's noise.
 */
#include <float.h>

#include "imm_plane.h"
#include "rhotrack/approx.h"

/* As in linalg.c. */
#define ROUNDING_ALLOWANCE (1.0f + 1.0f / 1048576.0f)

static int is_finite(float v)
{
    return v >= -FLT_MAX && v <= FLT_MAX;
}

/* No variance of an open axis falls below the floor: it would look closed. */
static float at_least(float variance)
{
    return variance > RHO_KALMAN_VARIANCE_MIN ? variance : RHO_KALMAN_VARIANCE_MIN;
}

/* ---- independent axes ------------------------------------------------------------------------- */

/* What an update divides by, and the share of the measured variance that is left. */
struct divisor {
    float inverse, kept;
};

static inline struct divisor divide_by(float predicted, float variance)
{
    const float inverse = 1.0f / (predicted + variance);
    return (struct divisor){inverse, variance * inverse};
}

/* The measured row is scaled, not differenced: no digit is lost. */
static inline void take_position(struct axis *at, const struct divisor *by, float step)
{
    const float gain_v = at->vp * by->inverse;
    at->p += at->pp * step;
    at->v += at->vp * step;
    at->vv = at_least(at->vv * ROUNDING_ALLOWANCE - gain_v * at->vp);
    at->pp = at_least(at->pp * by->kept);
    at->vp *= by->kept;
}

static inline void take_velocity(struct axis *at, const struct divisor *by, float step)
{
    const float gain_p = at->vp * by->inverse;
    at->p += at->vp * step;
    at->v += at->vv * step;
    at->pp = at_least(at->pp * ROUNDING_ALLOWANCE - gain_p * at->vp);
    at->vv = at_least(at->vv * by->kept);
    at->vp *= by->kept;
}

/*
 * Before either: the acceleration, by its covariance with what was measured (ap or av) and with the other (av or ap), and by
 * vp between these two.
 */
static inline void follow(struct accel *at, float *with_seen, float *with_other, float vp,
                          const struct divisor *by, float step)
{
    const float gain = *with_seen * by->inverse;
    at->a += *with_seen * step;
    *with_other -= gain * vp;
    at->aa = at_least(at->aa * ROUNDING_ALLOWANCE - gain * *with_seen);
    *with_seen *= by->kept;
}

/*
 * The position of one axis of a model was measured; more: NULL for the steady one. What is not finite shows in what is
 * returned. The divisor is never 0, as a noise is at least the floor.
 */
static inline float see_position(struct axis *at, struct accel *more, float place_m, float variance)
{
    const struct divisor by = divide_by(at->pp, variance);
    const float off = place_m - at->p, step = off * by.inverse;
    const float check = at->pp >= 0.0f ? off * step + at->pp : FLT_MAX + FLT_MAX;
    if (more) {
        follow(more, &more->ap, &more->av, at->vp, &by, step);
    }
    take_position(at, &by, step);
    return check + at->p + at->v;
}

/* The velocity was. */
static inline float see_velocity(struct axis *at, struct accel *more, float speed_mps,
                                 float variance)
{
    const struct divisor by = divide_by(at->vv, variance);
    const float off = speed_mps - at->v, step = off * by.inverse;
    const float check = at->vv >= 0.0f ? off * step + at->vv : FLT_MAX + FLT_MAX;
    if (more) {
        follow(more, &more->av, &more->ap, at->vp, &by, step);
    }
    take_velocity(at, &by, step);
    return check + at->p + at->v;
}

static float update_positions(struct rho_imm *imm, int num_axes, const struct rho_imm_plot *seen)
{
    struct rho_kalman *kalman = &imm->steady;
    const float variance = at_least(seen->position.variance_m2[0]);
    float check = 0.0f;
    for (int axis = 0; axis < num_axes; axis++) {
        const float place_m = seen->position.place_m[axis];
        struct axis steady = take_axis(kalman->state, kalman->covariance, axis);
        struct axis at = take_axis(imm->state, imm->covariance, axis);
        struct accel more = take_accel(imm, axis);
        check += see_position(&steady, 0, place_m, variance);
        check += see_position(&at, &more, place_m, variance) + more.a;
        put_axis(kalman->state, kalman->covariance, axis, &steady);
        put_axis(imm->state, imm->covariance, axis, &at);
        put_accel(imm, axis, &more);
    }
    return check;
}

static float update_velocities(struct rho_imm *imm, int num_axes, const struct rho_imm_plot *seen)
{
    struct rho_kalman *kalman = &imm->steady;
    const float variance = at_least(seen->plot->sigma_mps * seen->plot->sigma_mps);
    float check = 0.0f;
    for (int axis = 0; axis < num_axes; axis++) {
        const float speed_mps = velocity_of(seen->plot, axis);
        struct axis steady = take_axis(kalman->state, kalman->covariance, axis);
        struct axis at = take_axis(imm->state, imm->covariance, axis);
        struct accel more = take_accel(imm, axis);
        check += see_velocity(&steady, 0, speed_mps, variance);
        check += see_velocity(&at, &more, speed_mps, variance) + more.a;
        put_axis(kalman->state, kalman->covariance, axis, &steady);
        put_axis(imm->state, imm->covariance, axis, &at);
        put_accel(imm, axis, &more);
    }
    return check;
}

static enum rho_status update_axes(struct rho_imm *imm, int num_axes,
                                   const struct rho_imm_plot *seen)
{
    float check = update_positions(imm, num_axes, seen);
    if (seen->measures & RHO_MEASURES_VELOCITY) {
        check += update_velocities(imm, num_axes, seen);
    }
    return is_finite(check) ? RHO_OK : RHO_ERROR_SINGULAR;
}

/* ---- coupled axes ----------------------------------------------------------------------------- */

static void keep_floors(struct rho_imm *imm)
{
    for (int i = 0; i < RHO_IMM_STATES; i++) {
        float *variance = &imm->covariance[RHO_AT(i, i)];
        if (*variance < RHO_KALMAN_VARIANCE_MIN && (*variance > 0.0f || *variance < 0.0f)) {
            *variance = RHO_KALMAN_VARIANCE_MIN;
        }
    }
}

static float dot(const float *row, const float *state)
{
    return row[0] * state[0] + row[1] * state[1] + row[2] * state[2];
}

/* A place along one direction: both models. */
static enum rho_status update_along(struct rho_imm *imm, const float direction[3],
                                    const float place_m[3], float variance)
{
    float row[RHO_KALMAN_STATES] = {direction[0], direction[1], direction[2], 0.0f, 0.0f, 0.0f};
    float off_m[3], noise = at_least(variance);
    for (int i = 0; i < 3; i++) {
        off_m[i] = place_m[i] - imm->steady.state[i];
    }
    enum rho_status status =
        rho_kalman_update_row(&imm->steady, row, dot(direction, off_m), noise, 0);
    if (status != RHO_OK) {
        return status;
    }
    for (int i = 0; i < 3; i++) {
        off_m[i] = place_m[i] - imm->state[i];
    }
    return rho_linalg_update_along(RHO_IMM_STATES, imm->state, imm->covariance, 3, row,
                                   dot(direction, off_m), noise);
}

/* One element of the state, the same in both models. */
static enum rho_status update_element(struct rho_imm *imm, int element, float value, float variance)
{
    float noise = at_least(variance);
    enum rho_status status = rho_kalman_update(&imm->steady, element, value, noise, 0);
    return status == RHO_OK ? rho_linalg_update_at(RHO_IMM_STATES, imm->state, imm->covariance,
                                                   element, value - imm->state[element], noise)
                            : status;
}

/* Along the ground: a plot without heights has none. */
static float level_variance(const struct rho_measurement *seen)
{
    return seen->has_z ? seen->cos_elevation * seen->cos_elevation * seen->variance_m2[0] +
                             seen->sin_elevation * seen->sin_elevation * seen->variance_m2[2]
                       : seen->variance_m2[0];
}

/* Where only one of plot and estimate has heights, the plot counts as level, with the noise that it has there. */
static enum rho_status update_directions(struct rho_imm *imm, int num_axes,
                                         const struct rho_measurement *seen)
{
    const float ca = seen->cos_azimuth, sa = seen->sin_azimuth;
    const int has_z = num_axes == NUM_AXES;
    const float ce = has_z ? seen->cos_elevation : 1.0f, se = has_z ? seen->sin_elevation : 0.0f;
    const float along[3] = {ce * ca, ce * sa, se}, cross[3] = {-sa, ca, 0.0f};
    const float up[3] = {-se * ca, -se * sa, ce};
    const float variance = has_z ? seen->variance_m2[0] : level_variance(seen);
    const float *place_m = seen->place_m;
    enum rho_status status = update_along(imm, cross, place_m, seen->variance_m2[1]);
    if (status == RHO_OK && has_z) {
        status = update_along(imm, up, place_m, seen->variance_m2[2]);
    }
    return status == RHO_OK ? update_along(imm, along, place_m, variance) : status;
}

static enum rho_status update_velocity(struct rho_imm *imm, int num_axes,
                                       const struct rho_plot *plot)
{
    enum rho_status status = RHO_OK;
    for (int axis = 0; axis < num_axes && status == RHO_OK; axis++) {
        status = update_element(imm, NUM_AXES + axis, velocity_of(plot, axis),
                                plot->sigma_mps * plot->sigma_mps);
    }
    return status;
}

/* Each model's own view of the rate, linearised where the place has just been found. */
static enum rho_status update_range_rate(struct rho_imm *imm, const struct rho_imm_plot *seen)
{
    const float rate_mps = seen->plot->range_rate_mps;
    const float variance =
        at_least(seen->plot->sigma_range_rate_mps * seen->plot->sigma_range_rate_mps);
    struct rho_kalman at;
    struct rho_kalman_row rate;
    take_leading(&at, imm->state, imm->covariance);
    enum rho_status status =
        rho_kalman_update_range_rate(&imm->steady, seen->sensor, rate_mps, variance);
    if (status != RHO_OK ||
        !rho_kalman_see_range_rate(&at, seen->sensor, rate_mps, variance, &rate) ||
        !rho_kalman_tells_range_rate(&at, seen->sensor, &rate)) {
        return status;
    }
    return rho_linalg_update_along(RHO_IMM_STATES, imm->state, imm->covariance, RHO_KALMAN_STATES,
                                   rate.row, rate.innovation, rate.variance);
}

static enum rho_status update_coupled(struct rho_imm *imm, int num_axes,
                                      const struct rho_imm_plot *seen)
{
    enum rho_status status = RHO_OK;
    if (!seen->position.is_isotropic) {
        status = update_directions(imm, num_axes, &seen->position);
    } else {
        for (int axis = 0; axis < num_axes && status == RHO_OK; axis++) {
            status = update_element(imm, axis, seen->position.place_m[axis],
                                    seen->position.variance_m2[0]);
        }
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_VELOCITY)) {
        status = update_velocity(imm, num_axes, seen->plot);
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        status = update_range_rate(imm, seen);
    }
    keep_floors(imm);
    return status;
}

/* ---- without a height ------------------------------------------------------------------------ */

static enum rho_status update_plane_along(struct rho_imm *imm, float x, float y,
                                          const float place_m[3], float variance)
{
    const float noise = at_least(variance);
    float *steady = imm->steady.state, *state = imm->state, spread[RHO_PLANE_MANOEUVRE];
    float predicted = rho_imm_plane_project(RHO_PLANE_STEADY, imm->steady.covariance, x, y, spread);
    enum rho_status status =
        rho_imm_plane_update(RHO_PLANE_STEADY, steady, imm->steady.covariance, spread, predicted,
                             x * (place_m[0] - steady[0]) + y * (place_m[1] - steady[1]), noise);
    if (status != RHO_OK) {
        return status;
    }
    predicted = rho_imm_plane_project(RHO_PLANE_MANOEUVRE, imm->covariance, x, y, spread);
    return rho_imm_plane_update(RHO_PLANE_MANOEUVRE, state, imm->covariance, spread, predicted,
                                x * (place_m[0] - state[0]) + y * (place_m[1] - state[1]), noise);
}

/* By one model's view of the rate, linearised where the place has just been found. */
static enum rho_status update_plane_rate(int num_states, float *state, float *covariance,
                                         const struct rho_imm_plot *seen)
{
    const float sigma_mps = seen->plot->sigma_range_rate_mps;
    float spread[RHO_PLANE_MANOEUVRE];
    struct plane_rate rate;
    if (!rho_imm_plane_see_rate(state, covariance, seen->sensor, &rate)) {
        return RHO_OK;
    }
    const float predicted = rho_imm_plane_project_rate(num_states, covariance, rate.row, spread);
    const float variance = at_least(sigma_mps * sigma_mps) + rate.bend;
    float off_mps = seen->plot->range_rate_mps - rate.expected_mps;
    if (rho_measurement_has_span(seen->sensor)) {
        if (!rho_measurement_is_range_rate_clear(seen->sensor, predicted + variance)) {
            return RHO_OK;
        }
        off_mps = rho_measurement_range_rate_error_mps(seen->sensor, seen->plot->range_rate_mps,
                                                       rate.expected_mps);
    }
    return rho_imm_plane_update(num_states, state, covariance, spread, predicted, off_mps,
                                variance);
}

/* A plot with a height counts as level, with the noise that it has there. */
static enum rho_status update_plane(struct rho_imm *imm, const struct rho_imm_plot *seen)
{
    const struct rho_measurement *at = &seen->position;
    const float ca = at->cos_azimuth, sa = at->sin_azimuth;
    enum rho_status status = update_plane_along(imm, -sa, ca, at->place_m, at->variance_m2[1]);
    if (status == RHO_OK) {
        status = update_plane_along(imm, ca, sa, at->place_m, level_variance(at));
    }
    if (status == RHO_OK && (seen->measures & RHO_MEASURES_RANGE_RATE)) {
        status =
            update_plane_rate(RHO_PLANE_STEADY, imm->steady.state, imm->steady.covariance, seen);
        if (status == RHO_OK) {
            status = update_plane_rate(RHO_PLANE_MANOEUVRE, imm->state, imm->covariance, seen);
        }
    }
    rho_imm_plane_keep_floors(RHO_PLANE_STEADY, imm->steady.covariance);
    rho_imm_plane_keep_floors(RHO_PLANE_MANOEUVRE, imm->covariance);
    return status;
}

/* ---- public ----------------------------------------------------------------------------------- */

/* The third axis begins with what the plot says of it. */
static enum rho_status open_height(struct rho_imm *imm, const struct rho_imm_model *model,
                                   const struct rho_imm_plot *seen)
{
    const float noise = seen->covariance[RHO_AT(2, 2)];
    enum rho_status status =
        rho_kalman_open_axis(&imm->steady, 2, seen->position.place_m[2], at_least(noise),
                             model->speed_sigma_mps * model->speed_sigma_mps);
    if (status != RHO_OK) {
        return status;
    }
    imm->state[2] = seen->position.place_m[2];
    imm->covariance[PLACE(2, 0, 2, 0)] = at_least(noise);
    imm->covariance[PLACE(2, 1, 2, 1)] = model->speed_sigma_mps * model->speed_sigma_mps;
    imm->covariance[PLACE(2, 2, 2, 2)] =
        at_least(model->accel_sigma_mps2 * model->accel_sigma_mps2);
    return RHO_OK;
}

enum rho_status rho_imm_update(struct rho_imm *imm, const struct rho_imm_model *model,
                               const struct rho_imm_plot *seen, const struct rho_imm_match *match)
{
    if (!imm || !model || !seen || !match) {
        return RHO_ERROR_NULL;
    }
    const int opens = seen->position.has_z && !is_open(imm, 2);
    const int num_axes = seen->position.has_z && !opens ? 3 : 2;
    const int is_simple = !imm->is_coupled && seen->position.is_isotropic &&
                          !(seen->measures & RHO_MEASURES_RANGE_RATE);
    const int is_in_plane = !is_open(imm, 2) && !(seen->measures & RHO_MEASURES_VELOCITY);
    imm->is_coupled |= !is_simple;
    enum rho_status status = is_simple     ? update_axes(imm, num_axes, seen)
                             : is_in_plane ? update_plane(imm, seen)
                                           : update_coupled(imm, num_axes, seen);
    if (status == RHO_OK && opens) {
        status = open_height(imm, model, seen);
    }
    imm->probability = match->probability;
    return status;
}

enum rho_status rho_imm_update_bearing(struct rho_imm *imm, float x_m, float y_m, float bearing_rad,
                                       float sigma_rad, float *gain_nat)
{
    struct rho_kalman at;
    struct rho_kalman_bearing views[2];
    float variance[2], projected[RHO_KALMAN_STATES];
    if (!imm || !gain_nat) {
        return RHO_ERROR_NULL;
    }
    if (!is_finite(bearing_rad) || !(sigma_rad > 0.0f)) {
        return RHO_ERROR_VALUE;
    }
    take_leading(&at, imm->state, imm->covariance);
    *gain_nat = 0.0f;
    if (!rho_kalman_see_bearing(&imm->steady, x_m, y_m, bearing_rad, sigma_rad, &views[0]) ||
        !rho_kalman_see_bearing(&at, x_m, y_m, bearing_rad, sigma_rad, &views[1])) {
        return RHO_OK;
    }
    variance[0] =
        rho_linalg_project6(imm->steady.covariance, views[0].row, projected) + views[0].variance_m2;
    variance[1] =
        rho_linalg_project6(at.covariance, views[1].row, projected) + views[1].variance_m2;
    imm->is_coupled = 1;
    enum rho_status status =
        rho_kalman_update_row(&imm->steady, views[0].row, views[0].off_m, views[0].variance_m2, 0);
    if (status == RHO_OK) {
        status = rho_linalg_update_along(RHO_IMM_STATES, imm->state, imm->covariance, 2,
                                         views[1].row, views[1].off_m, views[1].variance_m2);
    }
    keep_floors(imm);
    if (status == RHO_OK) {
        const float offs_m[2] = {views[0].off_m, views[1].off_m};
        rho_imm_judge_scalar(imm, offs_m, variance, gain_nat);
    }
    return status;
}
