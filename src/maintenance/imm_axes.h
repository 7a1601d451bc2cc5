/* SPDX-License-Identifier: MIT */
/*
 * The axes of the two models, as imm*.c see them. Private to src/maintenance/imm*.c.
 *
 * The steady model's triangle is the first 21 elements of the manoeuvring one's: positions and velocities have the same
 * places in both.
 */
#ifndef RHOTRACK_IMM_AXES_H
#define RHOTRACK_IMM_AXES_H

#include "rhotrack/imm.h"

#define NUM_AXES 3

/* Covariance of one axis' derivative d with the same or another axis' derivative e. */
#define PLACE(axis, d, other, e) RHO_AT(NUM_AXES *(d) + (axis), NUM_AXES * (e) + (other))

/* One axis by itself: position, velocity and, of the manoeuvring model, acceleration. */
struct axis {
    float x[3];
    float p[RHO_TRIANGLE(3)]; /* pp, vp, vv, ap, av, aa */
};

static inline void take_axis(struct axis *out, const float *state, const float *covariance,
                             int axis, int num)
{
    for (int i = 0; i < num; i++) {
        out->x[i] = state[NUM_AXES * i + axis];
        for (int j = 0; j <= i; j++) {
            out->p[RHO_AT(i, j)] = covariance[PLACE(axis, i, axis, j)];
        }
    }
}

static inline void put_axis(const struct axis *in, float *state, float *covariance, int axis,
                            int num)
{
    for (int i = 0; i < num; i++) {
        state[NUM_AXES * i + axis] = in->x[i];
        for (int j = 0; j <= i; j++) {
            covariance[PLACE(axis, i, axis, j)] = in->p[RHO_AT(i, j)];
        }
    }
}

static inline int is_open(const struct rho_imm *imm, int axis)
{
    return imm->covariance[RHO_AT(axis, axis)] > 0.0f;
}

/* A scalar that both models had predicted, `off` and with so much variance: moves their probabilities. imm_match.c */
void rho_imm_judge_scalar(struct rho_imm *imm, const float off[2], const float variance[2],
                          float *gain_nat);

#endif
