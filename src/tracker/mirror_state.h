/* SPDX-License-Identifier: MIT */
/* mirror_state: image of a target's state in a wall. Private to src/tracker and src/walls. */
#ifndef RHOTRACK_MIRROR_STATE_H
#define RHOTRACK_MIRROR_STATE_H

#include "rhotrack/detail/kalman.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/types.h"

/*
 * Reflects a state and its covariance in a wall. Returns 0, with *image undefined, where the line
 * of sight to the image does not cross the wall, lengthened by the slack at both ends.
 *   sensor      the sensor that looks; NULL: at the origin
 *   crossing_m  place along the wall, from its beginning, where the line of sight crosses it
 */
int rho_reflector_mirror_state(const struct rho_reflector *reflector,
                               const struct rho_sensor *sensor, float slack_m,
                               const struct rho_kalman *of, struct rho_kalman *image,
                               float *crossing_m);

#endif
