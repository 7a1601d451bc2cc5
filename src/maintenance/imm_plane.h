/* SPDX-License-Identifier: MIT */
/*
 * imm_plane: coupled estimates without a height: x, y and their derivatives alone. What a state has of z is 0 there and stays so,
 * as plots of radars without heights tell nothing of it. Private to src/maintenance/imm*.c.
 *
 * The states of a plane are x y vx vy, and of the manoeuvring model ax ay.
 */
#ifndef RHOTRACK_IMM_PLANE_H
#define RHOTRACK_IMM_PLANE_H

#include "imm_axes.h"

#define RHO_PLANE_STEADY 4    /* states of a model */
#define RHO_PLANE_MANOEUVRE 6 /* of the other */

/* What an estimate expects of a sensor's range rates. */
struct plane_rate {
    float row[RHO_PLANE_STEADY]; /* its derivatives by x y vx vy */
    float expected_mps;
    float bend; /* variance of what these leave out (kalman.c) */
};

static inline int is_plane(const struct rho_imm *imm)
{
    return imm->is_coupled && !is_open(imm, 2);
}

/* 0: the estimate is in the sensor's own place, and expects none. */
int rho_imm_plane_see_rate(const float *state, const float *covariance,
                           const struct rho_sensor *sensor, struct plane_rate *rate);

/* spread := covariance row, for a place along the direction x y, or a range rate; returns row . spread. */
float rho_imm_plane_project(int num_states, const float *covariance, float x, float y,
                            float spread[RHO_PLANE_MANOEUVRE]);
float rho_imm_plane_project_rate(int num_states, const float *covariance,
                                 const float row[RHO_PLANE_STEADY],
                                 float spread[RHO_PLANE_MANOEUVRE]);

/*
 * A scalar update by what a projection has found: the variance `predicted` and what it spreads to. Errors: as
 * rho_linalg_update_along.
 */
enum rho_status rho_imm_plane_update(int num_states, float *state, float *covariance,
                                     const float spread[RHO_PLANE_MANOEUVRE], float predicted,
                                     float innovation, float variance);

#endif
