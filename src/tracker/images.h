/* SPDX-License-Identifier: MIT */
/*
 * images: where a wall shows a target a second time. Private to src/tracker and src/walls.
 */
#ifndef RHOTRACK_IMAGES_H
#define RHOTRACK_IMAGES_H

#include "rhotrack/detail/kalman.h"
#include "rhotrack/reflectors.h"
#include "rhotrack/types.h"

/*
 * The image of a state, with its covariance. 0, and *image is of no use: the line of sight to the
 * image does not cross the wall, within the slack on either end.
 *   sensor      that looks; NULL: from the origin
 *   crossing_m  where it crosses, along the wall from its beginning; filled where there is an image
 */
int rho_reflector_image(const struct rho_reflector *reflector, const struct rho_sensor *sensor,
                        float slack_m, const struct rho_kalman *of, struct rho_kalman *image,
                        float *crossing_m);

#endif
