/* SPDX-License-Identifier: MIT */
/*
 * reflectors: walls, guard rails and quays that show targets a second time.
 *
 * A smooth wall sends part of an echo round: a sensor sees the target's image behind the wall, as
 * far behind as the target is before it, with the velocity and the range rate of the image.
 *
 *      image  x        x' = x - 2 n (n . (x - a))      n: normal of the wall, a: a place on it
 *             :
 *      =======:====|   the wall, from .. to            Only where the line of sight to the image
 *            /:    |                                   crosses the wall it is seen.
 *     sensor  target
 *
 * Of walls that are told, or learned (reflector_learning.h), the tracker knows where the images of
 * its tracks would be. Plots that no track claims, and are where the image of one is, with its
 * range rate where that is measured, are GHOST (enum rho_fate): they start nothing. A young track
 * that moves as the image of another one ends. A target behind the wall is found where its motion
 * differs from the image's.
 *
 * Stack: 88 bytes at most.
 */
#ifndef RHOTRACK_REFLECTORS_H
#define RHOTRACK_REFLECTORS_H

#include "rhotrack/config.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rho_tracker;

/* A straight wall, between two places at least so far apart. */
#define RHO_REFLECTOR_LEAST_M 1.0f
struct rho_reflector {
    float from_x_m, from_y_m, to_x_m, to_y_m;
};

/*
 * Tells a tracker all walls that it is to know, from the next step on.
 *   reflectors  num_reflectors of them, 0 .. RHO_MAX_REFLECTORS; copied. NULL for 0
 * Errors: NULL, STATE (not initialised), CAPACITY, VALUE (a place that is no coordinate, or two too
 * near each other); nothing is changed. Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_set_reflectors(struct rho_tracker *tracker,
                                                          const struct rho_reflector *reflectors,
                                                          unsigned num_reflectors);

#ifdef __cplusplus
}
#endif

#endif
