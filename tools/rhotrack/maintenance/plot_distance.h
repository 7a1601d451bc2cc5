/* SPDX-License-Identifier: MIT */
/*
 * plot_distance: Mahalanobis distance of a plot from a prediction, over place, velocity and range
 * rate as far as the plot measures them.
 */
#ifndef RHOTRACK_TOOL_PLOT_DISTANCE_H
#define RHOTRACK_TOOL_PLOT_DISTANCE_H

#include <stdint.h>

#include "rhotrack/detail/kalman.h"
#include "rhotrack/types.h"

/*
 * Squared Mahalanobis distance, with the covariances of plot and prediction; *dimensions (may be
 * NULL) gets the number of compared dimensions. Heights and vertical velocities count where the
 * prediction knows the height, too. NAN where the covariance is not positive definite. `predicted`
 * must be at the plot's own time: offset_us is ignored. sensor NULL: at the origin.
 */
double plot_squared_mahalanobis(const struct rho_kalman *predicted, const struct rho_plot *plot,
                                uint32_t measures, const struct rho_sensor *sensor,
                                int *dimensions);

#endif
