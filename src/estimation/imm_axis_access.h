/* SPDX-License-Identifier: MIT */
/*
 * imm_axis_access: loads and stores the estimates of both models axis by axis. Private to
 * src/estimation/imm*.c. The covariance of the steady model has the layout of the first 21 elements
 * of the manoeuvring model's: positions and velocities have the same indices in both. The code is
 * written out over named elements, as it runs for each hypothesis of each track.
 */
#ifndef RHOTRACK_IMM_AXIS_ACCESS_H
#define RHOTRACK_IMM_AXIS_ACCESS_H

#include <string.h>

#include "rhotrack/detail/imm.h"

/* Index of the covariance of derivative d (0, 1, 2) of an axis with derivative e of any axis. */
#define COVARIANCE_AT(axis, d, other, e) RHO_AT(RHO_AXES *(d) + (axis), RHO_AXES * (e) + (other))

/* Position and velocity of one axis, of either model, with their covariance. */
struct axis {
    float p, v;
    float pp, vp, vv;
};

/* Acceleration of one axis, with its covariances; in the steady model 0 with variance 0. */
struct accel {
    float a;
    float ap, av, aa;
};

/* Index of an axis' covariance with its position, in rows of position, velocity, acceleration. */
static const uint8_t axis_rows[RHO_AXES][3] = {
    {COVARIANCE_AT(0, 0, 0, 0), COVARIANCE_AT(0, 1, 0, 0), COVARIANCE_AT(0, 2, 0, 0)},
    {COVARIANCE_AT(1, 0, 1, 0), COVARIANCE_AT(1, 1, 1, 0), COVARIANCE_AT(1, 2, 1, 0)},
    {COVARIANCE_AT(2, 0, 2, 0), COVARIANCE_AT(2, 1, 2, 0), COVARIANCE_AT(2, 2, 2, 0)},
};

/* Loads position and velocity of one axis; in a row an axis' elements are RHO_AXES apart. */
static inline struct axis load_axis(const float *state, const float *covariance, int axis)
{
    const float *by_v = &covariance[axis_rows[axis][1]];
    return (struct axis){.p = state[axis],
                         .v = state[RHO_AXES + axis],
                         .pp = covariance[axis_rows[axis][0]],
                         .vp = by_v[0],
                         .vv = by_v[RHO_AXES]};
}

static inline void store_axis(float *state, float *covariance, int axis, const struct axis *in)
{
    float *by_v = &covariance[axis_rows[axis][1]];
    state[axis] = in->p;
    state[RHO_AXES + axis] = in->v;
    covariance[axis_rows[axis][0]] = in->pp;
    by_v[0] = in->vp;
    by_v[RHO_AXES] = in->vv;
}

static inline struct accel load_accel(const struct rho_imm *imm, int axis)
{
    const float *by_a = &imm->covariance[axis_rows[axis][2]];
    return (struct accel){.a = imm->state[2 * RHO_AXES + axis],
                          .ap = by_a[0],
                          .av = by_a[RHO_AXES],
                          .aa = by_a[2 * RHO_AXES]};
}

static inline void store_accel(struct rho_imm *imm, int axis, const struct accel *in)
{
    float *by_a = &imm->covariance[axis_rows[axis][2]];
    imm->state[2 * RHO_AXES + axis] = in->a;
    by_a[0] = in->ap;
    by_a[RHO_AXES] = in->av;
    by_a[2 * RHO_AXES] = in->aa;
}

/*
 * Covariances of two axes: the first letter is the derivative of the later axis, the second that of
 * the earlier one. The steady model has the elements without a.
 */
struct axis_pair {
    float pp, pv, pa;
    float vp, vv, va;
    float ap, av, aa;
};

/* Estimate of the manoeuvring model minus that of the steady model, on one axis. */
struct model_difference {
    float p, v, a;
};

/*
 * Indices in the triangle of an axis pair's pp; pv; pa va; vp vv; ap av aa (the first of each
 * group), for the axes y and x, z and x, z and y.
 */
static const uint8_t pair_rows[RHO_AXES][5] = {
    {COVARIANCE_AT(1, 0, 0, 0), COVARIANCE_AT(1, 0, 0, 1), COVARIANCE_AT(1, 0, 0, 2),
     COVARIANCE_AT(1, 1, 0, 0), COVARIANCE_AT(1, 2, 0, 0)},
    {COVARIANCE_AT(2, 0, 0, 0), COVARIANCE_AT(2, 0, 0, 1), COVARIANCE_AT(2, 0, 0, 2),
     COVARIANCE_AT(2, 1, 0, 0), COVARIANCE_AT(2, 2, 0, 0)},
    {COVARIANCE_AT(2, 0, 1, 0), COVARIANCE_AT(2, 0, 1, 1), COVARIANCE_AT(2, 0, 1, 2),
     COVARIANCE_AT(2, 1, 1, 0), COVARIANCE_AT(2, 2, 1, 0)},
};

static inline struct axis_pair load_steady_axis_pair(const float *covariance, const uint8_t rows[5])
{
    const float *by_v = &covariance[rows[3]];
    return (struct axis_pair){
        .pp = covariance[rows[0]], .pv = covariance[rows[1]], .vp = by_v[0], .vv = by_v[RHO_AXES]};
}

static inline void store_steady_axis_pair(float *covariance, const uint8_t rows[5],
                                          const struct axis_pair *in)
{
    float *by_v = &covariance[rows[3]];
    covariance[rows[0]] = in->pp;
    covariance[rows[1]] = in->pv;
    by_v[0] = in->vp;
    by_v[RHO_AXES] = in->vv;
}

static inline struct axis_pair load_axis_pair(const float *covariance, const uint8_t rows[5])
{
    const float *with_a = &covariance[rows[2]], *by_a = &covariance[rows[4]];
    struct axis_pair out = load_steady_axis_pair(covariance, rows);
    out.pa = with_a[0];
    out.va = with_a[RHO_AXES];
    out.ap = by_a[0];
    out.av = by_a[RHO_AXES];
    out.aa = by_a[2 * RHO_AXES];
    return out;
}

static inline void store_axis_pair(float *covariance, const uint8_t rows[5],
                                   const struct axis_pair *in)
{
    float *with_a = &covariance[rows[2]], *by_a = &covariance[rows[4]];
    store_steady_axis_pair(covariance, rows, in);
    with_a[0] = in->pa;
    with_a[RHO_AXES] = in->va;
    by_a[0] = in->ap;
    by_a[RHO_AXES] = in->av;
    by_a[2 * RHO_AXES] = in->aa;
}

/* Copies the positions and velocities of a model into a six-state filter. */
static inline void load_kinematics(struct rho_kalman *to, const float *state,
                                   const float *covariance)
{
    memcpy(to->state, state, sizeof to->state);
    memcpy(to->covariance, covariance, sizeof to->covariance);
}

static inline int has_estimate_on_axis(const struct rho_imm *imm, int axis)
{
    return imm->covariance[RHO_AT(axis, axis)] > 0.0f;
}

static inline float plot_velocity_component(const struct rho_plot *plot, int axis)
{
    return axis == 0 ? plot->vx_mps : axis == 1 ? plot->vy_mps : plot->vz_mps;
}

/*
 * Bayes update of the manoeuvring model's probability by the likelihoods that both models give what
 * was seen (imm_likelihood.c). Returns the likelihood over both.
 */
float rho_imm_weigh_models(float *probability, const float likelihood[2]);

#endif
