/* SPDX-License-Identifier: MIT */
/*
 * double_filter: an extended Kalman filter of a radar in the origin, or of bearings, in double
 * precision with full matrices and polar rows: what the library's own filter is measured against.
 * Written from the textbook, and shares no code with it.
 */
#ifndef RHOTRACK_TOOL_DOUBLE_FILTER_H
#define RHOTRACK_TOOL_DOUBLE_FILTER_H

#include "scenario.h"

struct double_filter {
    double t_s;
    double state[4];         /* x, y, vx, vy */
    double covariance[4][4]; /* of it */
};

/*
 * Opens at a plot: its place, a velocity of zero with this standard deviation, each axis; then its
 * range rate.
 */
struct double_filter double_filter_open(const struct scenario_radar *radar, double t_s,
                                        const struct simulated_plot *plot, double speed_sigma_mps);

/* To another time with white acceleration of this density, m^2/s^3; backwards without noise. */
void double_filter_predict(struct double_filter *filter, double t_s, double noise_density);

/* Range, azimuth and, where the radar has it, range rate. */
void double_filter_update(struct double_filter *filter, const struct scenario_radar *radar,
                          const struct simulated_plot *plot);

/* A bearing from a place. */
void double_filter_update_bearing(struct double_filter *filter, double x_m, double y_m,
                                  double bearing_rad, double sigma_rad);

#endif
