/* SPDX-License-Identifier: MIT */
/*
 * imm_plane_update: scalar updates of one model's estimate in the horizontal plane: x and y with
 * their derivatives. All elements of z are 0, and stay 0 as long as no plot has a height. Private
 * to src/estimation/imm*.c. The states of the plane are x y vx vy, and ax ay in the manoeuvring
 * model. `row` and `spread` hold them one after the other, `state` and `covariance` where struct
 * rho_imm has them.
 */
#ifndef RHOTRACK_IMM_PLANE_UPDATE_H
#define RHOTRACK_IMM_PLANE_UPDATE_H

#include "imm_axis_access.h"

/* Numbers of states on two axes, in the steady and in the manoeuvring model. */
enum { RHO_PLANE_STEADY = 2 * 2, RHO_PLANE_MANOEUVRE = 2 * 3 };

/* Predicted range rate of an estimate. */
struct plane_rate {
    float row[RHO_PLANE_STEADY]; /* derivatives of the range rate by x y vx vy */
    float expected_mps;
    float nonlinearity; /* variance that the linearisation leaves out (kalman.c) */
};

/* Predicts an estimate's range rate. Returns 0 where its position is the sensor's: it has none. */
int rho_imm_plane_rate(const float *state, const float *covariance, const struct rho_sensor *sensor,
                       struct plane_rate *rate);

/*
 * spread := covariances with the position along (x, y), or with a range rate; returns its variance.
 */
float rho_imm_plane_project_place(int num_states, const float *restrict p, float x, float y,
                                  float *restrict spread);
float rho_imm_plane_project_rate(int num_states, const float *restrict p, const float *restrict row,
                                 float *restrict spread);

/*
 * Updates an estimate with a scalar whose covariances `spread` and variance `predicted` a
 * projection gave. The noise variance is RHO_VARIANCE_MIN at least. Errors: SINGULAR, VALUE,
 * as rho_linalg_update_row; then the estimate must not be used any more.
 */
enum rho_status rho_imm_plane_update(int num_states, float *restrict state,
                                     float *restrict covariance, const float *restrict spread,
                                     float predicted, float innovation, float variance);

/* Raises variances to the floor after an update: an axis with less would look closed. */
void rho_imm_plane_floor_variances(int num_states, float *covariance);

#endif
