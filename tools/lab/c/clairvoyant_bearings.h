/* SPDX-License-Identifier: MIT */
/*
 * clairvoyant_bearings: the constant velocity that bearings make most likely, for somebody who
 * knows which bearings are the target's; in double precision. The measure of what initiation loses
 * by not knowing.
 */
#ifndef RHOTRACK_TOOL_CLAIRVOYANT_BEARINGS_H
#define RHOTRACK_TOOL_CLAIRVOYANT_BEARINGS_H

#include <stddef.h>

/* Of velocities, each axis: weak, so that few bearings have an answer, too. */
#define CLAIRVOYANT_BELIEF_MPS 500.0

struct clairvoyant_bearing {
    double t_s; /* after the time that the state is for */
    double sensor_x_m, sensor_y_m;
    double bearing_rad, sigma_rad;
};

struct clairvoyant_course {
    double state[4]; /* x, y, vx, vy at time 0 */
    double covariance[4][4];
};

/*
 * Gauss-Newton from a state nearby, such as the truth. Fewer bearings than unknowns: what they do
 * not say is not finite.
 */
struct clairvoyant_course clairvoyant_bearings_fit(const struct clairvoyant_bearing *bearings,
                                                   size_t num_bearings, const double start[4]);

/*
 * off' inverse(covariance) off: chi-square of 4 degrees of freedom where the covariance is right.
 */
double clairvoyant_nees(const double off[4], const double covariance[4][4]);

#endif
