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

/*
 * The six states' covariances with a place along the direction x y, or with a range rate, by its row; those with accelerations
 * where num_states has them. Return the variance.
 */
float rho_imm_plane_project(int num_states, const float *restrict covariance, float x, float y,
                            float *restrict spread);
float rho_imm_plane_project_rate(int num_states, const float *restrict covariance,
                                 const float *restrict row, float *restrict spread);

/*
 * A scalar update by what a projection has found: spread, and the variance `predicted`. variance: RHO_KALMAN_VARIANCE_MIN at
 * least. Errors: SINGULAR, VALUE, as rho_linalg_update_along; then the estimate is of no more use.
 */
enum rho_status rho_imm_plane_update(int num_states, float *restrict state,
                                     float *restrict covariance, const float *restrict spread,
                                     float predicted, float innovation, float variance);

/* After the updates: no variance of an open axis falls below the floor, as it would look closed. */
void rho_imm_plane_keep_floors(int num_states, float *covariance);

#endif
