/* SPDX-License-Identifier: MIT */
/*
 * The axes of the two models, as imm*.c see them. Private to src/maintenance/imm*.c.
 *
 * The steady model's triangle is the first 21 elements of the manoeuvring one's: positions and velocities have the same
 * places in both. Straight code over named elements, not loops: it runs for each hypothesis of each track.
 */
#ifndef RHOTRACK_IMM_AXES_H
#define RHOTRACK_IMM_AXES_H

#include <string.h>

#include "rhotrack/imm.h"

#define NUM_AXES 3

/* Covariance of one axis' derivative d with the same or another axis' derivative e. */
#define PLACE(axis, d, other, e) RHO_AT(NUM_AXES *(d) + (axis), NUM_AXES * (e) + (other))

/* One axis by itself, of either model. */
struct axis {
    float p, v;
    float pp, vp, vv;
};

/* What the manoeuvring model has beside these; the steady one's acceleration is 0, and known to be. */
struct accel {
    float a;
    float ap, av, aa;
};

/* Where an axis' own covariances begin in the triangle's rows of its position, velocity and acceleration. */
static const uint8_t axis_rows[NUM_AXES][3] = {
    {PLACE(0, 0, 0, 0), PLACE(0, 1, 0, 0), PLACE(0, 2, 0, 0)},
    {PLACE(1, 0, 1, 0), PLACE(1, 1, 1, 0), PLACE(1, 2, 1, 0)},
    {PLACE(2, 0, 2, 0), PLACE(2, 1, 2, 0), PLACE(2, 2, 2, 0)},
};

/* In such a row the next derivative of the same axis lies NUM_AXES further on. */
static inline struct axis take_axis(const float *state, const float *covariance, int axis)
{
    const float *by_v = &covariance[axis_rows[axis][1]];
    return (struct axis){.p = state[axis],
                         .v = state[NUM_AXES + axis],
                         .pp = covariance[axis_rows[axis][0]],
                         .vp = by_v[0],
                         .vv = by_v[NUM_AXES]};
}

static inline void put_axis(float *state, float *covariance, int axis, const struct axis *in)
{
    float *by_v = &covariance[axis_rows[axis][1]];
    state[axis] = in->p;
    state[NUM_AXES + axis] = in->v;
    covariance[axis_rows[axis][0]] = in->pp;
    by_v[0] = in->vp;
    by_v[NUM_AXES] = in->vv;
}

static inline struct accel take_accel(const struct rho_imm *imm, int axis)
{
    const float *by_a = &imm->covariance[axis_rows[axis][2]];
    return (struct accel){.a = imm->state[2 * NUM_AXES + axis],
                          .ap = by_a[0],
                          .av = by_a[NUM_AXES],
                          .aa = by_a[2 * NUM_AXES]};
}

static inline void put_accel(struct rho_imm *imm, int axis, const struct accel *in)
{
    float *by_a = &imm->covariance[axis_rows[axis][2]];
    imm->state[2 * NUM_AXES + axis] = in->a;
    by_a[0] = in->ap;
    by_a[NUM_AXES] = in->av;
    by_a[2 * NUM_AXES] = in->aa;
}

/*
 * The covariances of two axes: of the later one's derivative with the earlier one's. The steady
 * model has those without a.
 */
struct pair {
    float pp, pv, pa;
    float vp, vv, va;
    float ap, av, aa;
};

/* From the steady model's estimate to the manoeuvring one's, on one axis. */
struct way {
    float p, v, a;
};

/*
 * Where they begin in the triangle's rows, of axes 1 and 0, 2 and 0, 2 and 1: pp; pv; pa va; vp vv;
 * ap av aa.
 */
static const uint8_t pair_rows[NUM_AXES][5] = {
    {PLACE(1, 0, 0, 0), PLACE(1, 0, 0, 1), PLACE(1, 0, 0, 2), PLACE(1, 1, 0, 0), PLACE(1, 2, 0, 0)},
    {PLACE(2, 0, 0, 0), PLACE(2, 0, 0, 1), PLACE(2, 0, 0, 2), PLACE(2, 1, 0, 0), PLACE(2, 2, 0, 0)},
    {PLACE(2, 0, 1, 0), PLACE(2, 0, 1, 1), PLACE(2, 0, 1, 2), PLACE(2, 1, 1, 0), PLACE(2, 2, 1, 0)},
};

static inline struct pair take_steady_pair(const float *covariance, const uint8_t rows[5])
{
    const float *by_v = &covariance[rows[3]];
    return (struct pair){
        .pp = covariance[rows[0]], .pv = covariance[rows[1]], .vp = by_v[0], .vv = by_v[NUM_AXES]};
}

static inline void put_steady_pair(float *covariance, const uint8_t rows[5], const struct pair *in)
{
    float *by_v = &covariance[rows[3]];
    covariance[rows[0]] = in->pp;
    covariance[rows[1]] = in->pv;
    by_v[0] = in->vp;
    by_v[NUM_AXES] = in->vv;
}

static inline struct pair take_pair(const float *covariance, const uint8_t rows[5])
{
    const float *with_a = &covariance[rows[2]], *by_a = &covariance[rows[4]];
    struct pair out = take_steady_pair(covariance, rows);
    out.pa = with_a[0];
    out.va = with_a[NUM_AXES];
    out.ap = by_a[0];
    out.av = by_a[NUM_AXES];
    out.aa = by_a[2 * NUM_AXES];
    return out;
}

static inline void put_pair(float *covariance, const uint8_t rows[5], const struct pair *in)
{
    float *with_a = &covariance[rows[2]], *by_a = &covariance[rows[4]];
    put_steady_pair(covariance, rows, in);
    with_a[0] = in->pa;
    with_a[NUM_AXES] = in->va;
    by_a[0] = in->ap;
    by_a[NUM_AXES] = in->av;
    by_a[2 * NUM_AXES] = in->aa;
}

/* Positions and velocities of a model: the first states, and the first elements of the covariance. */
static inline void take_leading(struct rho_kalman *to, const float *state, const float *covariance)
{
    memcpy(to->state, state, sizeof to->state);
    memcpy(to->covariance, covariance, sizeof to->covariance);
}

static inline int is_open(const struct rho_imm *imm, int axis)
{
    return imm->covariance[RHO_AT(axis, axis)] > 0.0f;
}

static inline float velocity_of(const struct rho_plot *plot, int axis)
{
    return axis == 0 ? plot->vx_mps : axis == 1 ? plot->vy_mps : plot->vz_mps;
}

/* A scalar that both models had predicted, `off` and with so much variance: moves their probabilities. imm_match.c */
void rho_imm_judge_scalar(struct rho_imm *imm, const float off[2], const float variance[2],
                          float *gain_nat);

#endif
