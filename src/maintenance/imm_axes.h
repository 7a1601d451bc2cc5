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

/* One axis by itself: position, velocity and, of the manoeuvring model, acceleration. */
struct axis {
    float p, v, a;
    float pp, vp, vv, ap, av, aa;
};

/* Where an axis' covariances lie: pp, vp, vv, ap, av, aa. */
static const uint8_t axis_places[NUM_AXES][6] = {
    {PLACE(0, 0, 0, 0), PLACE(0, 1, 0, 0), PLACE(0, 1, 0, 1), PLACE(0, 2, 0, 0), PLACE(0, 2, 0, 1),
     PLACE(0, 2, 0, 2)},
    {PLACE(1, 0, 1, 0), PLACE(1, 1, 1, 0), PLACE(1, 1, 1, 1), PLACE(1, 2, 1, 0), PLACE(1, 2, 1, 1),
     PLACE(1, 2, 1, 2)},
    {PLACE(2, 0, 2, 0), PLACE(2, 1, 2, 0), PLACE(2, 1, 2, 1), PLACE(2, 2, 2, 0), PLACE(2, 2, 2, 1),
     PLACE(2, 2, 2, 2)},
};

/* The steady model's axis has an acceleration of 0. */
static inline struct axis take_steady(const struct rho_kalman *steady, int axis)
{
    const uint8_t *at = axis_places[axis];
    return (struct axis){.p = steady->state[axis],
                         .v = steady->state[NUM_AXES + axis],
                         .pp = steady->covariance[at[0]],
                         .vp = steady->covariance[at[1]],
                         .vv = steady->covariance[at[2]]};
}

static inline void put_steady(struct rho_kalman *steady, int axis, const struct axis *in)
{
    const uint8_t *at = axis_places[axis];
    steady->state[axis] = in->p;
    steady->state[NUM_AXES + axis] = in->v;
    steady->covariance[at[0]] = in->pp;
    steady->covariance[at[1]] = in->vp;
    steady->covariance[at[2]] = in->vv;
}

static inline struct axis take_manoeuvre(const struct rho_imm *imm, int axis)
{
    const uint8_t *at = axis_places[axis];
    return (struct axis){.p = imm->state[axis],
                         .v = imm->state[NUM_AXES + axis],
                         .a = imm->state[2 * NUM_AXES + axis],
                         .pp = imm->covariance[at[0]],
                         .vp = imm->covariance[at[1]],
                         .vv = imm->covariance[at[2]],
                         .ap = imm->covariance[at[3]],
                         .av = imm->covariance[at[4]],
                         .aa = imm->covariance[at[5]]};
}

static inline void put_manoeuvre(struct rho_imm *imm, int axis, const struct axis *in)
{
    const uint8_t *at = axis_places[axis];
    imm->state[axis] = in->p;
    imm->state[NUM_AXES + axis] = in->v;
    imm->state[2 * NUM_AXES + axis] = in->a;
    imm->covariance[at[0]] = in->pp;
    imm->covariance[at[1]] = in->vp;
    imm->covariance[at[2]] = in->vv;
    imm->covariance[at[3]] = in->ap;
    imm->covariance[at[4]] = in->av;
    imm->covariance[at[5]] = in->aa;
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
