/* SPDX-License-Identifier: MIT */
/*
 * gate: which plots may be a track's?
 *
 * nearest: the squared Mahalanobis distance of the plot from the predicted position, with the plot's noise and the
 * prediction's covariance, against a chi-square limit of 99.9 %.
 */
#ifndef RHOTRACK_GATE_H
#define RHOTRACK_GATE_H

#include "rhotrack/kalman.h"
#include "rhotrack/status.h"
#include "rhotrack/types.h"

#define RHO_GATE_CHI2_2D 13.8155f /* 99.9 % of two-dimensional normal innovations */
#define RHO_GATE_CHI2_3D 16.2662f /* of three-dimensional ones */

/* A track's prediction at a scan's time, as its gate sees it. */
struct rho_gate {
    float position_m[3], velocity_mps[3];
    float covariance[6]; /* of the position: xx, yx, yy, zx, zy, zz */
    int has_z;           /* the third axis is open */
};

struct rho_gate_result {
    float distance2; /* squared Mahalanobis distance */
    float log_det;   /* ln det of the innovation covariance, m^2 an axis */
    int has_z;       /* three dimensions, else two */
};

/* Takes the prediction over. Constant cost. */
void rho_gate_open(struct rho_gate *gate, const struct rho_kalman *predicted);

/*
 * Tests a valid plot of a scan that measures `measures`. Returns 1 and fills *result where the plot is in the gate, else
 * 0 (also where the covariance is not positive definite). z counts where both have it. The prediction moves on
 * with the plot's own time. Cost: about 60 instructions, and a square root and a logarithm for plots in the gate.
 * Stack: 96 bytes.
 */
int rho_gate_test(const struct rho_gate *gate, const struct rho_plot *plot, uint32_t measures,
                  struct rho_gate_result *result);

#endif
