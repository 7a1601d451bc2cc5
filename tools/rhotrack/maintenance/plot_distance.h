/* SPDX-License-Identifier: MIT */
/*
 * plot_distance: how far a plot is from a prediction, over everything that both have: place,
 * velocity, range rate.
 */
#ifndef RHOTRACK_TOOL_PLOT_DISTANCE_H
#define RHOTRACK_TOOL_PLOT_DISTANCE_H

#include <stdint.h>

#include "rhotrack/detail/kalman.h"
#include "rhotrack/types.h"

/*
 * Squared Mahalanobis distance, with the covariances of both; *dimensions (may be NULL) gets their
 * number. Heights and upward velocities count where the prediction has them too. NAN where the
 * covariance is not positive definite. The plot's offset is not looked at: predict to its own time
 * before. sensor NULL: at the origin.
 */
double plot_distance2(const struct rho_kalman *predicted, const struct rho_plot *plot,
                      uint32_t measures, const struct rho_sensor *sensor, int *dimensions);

#endif
