/* SPDX-License-Identifier: MIT */
/*
 * body_filter: the extent of a target from the plots that its scatterers give: how far they lie
 * from the reference point, along the body and across it.
 *
 * A plot that a target has given at a place of its body lies off by the variance
 *
 *     L^2 / 12 + R        along, and W^2 / 12 + R across,
 *
 * R its own noise, for scatterers that are spread over a rectangle of length L and width W. The
 * means of squares less R are smoothed over some 500 plots without noise; the length begins with
 * half of the longest body, which counts next to nothing, the width with a third of that, known to
 * 30 %. They belong to a frame that turns with the body. Across, a look's plots lie along a line
 * where the heading is off: its slope against the scatterers' own, which is learned, is taken off
 * as far as the heading's sigma says, and with it what it takes off the width.
 *
 * Scatterers stay on the body: N of them, each anywhere in its part, tell L with a sigma of
 * L / N^1.5 and the centre with L / (N^1.5 root 12), however long they are seen.
 *
 * Stack: 104 bytes at most.
 */
#ifndef RHOTRACK_BODY_FILTER_H
#define RHOTRACK_BODY_FILTER_H

#include <stdint.h>

#include "rhotrack/body.h"

#ifdef __cplusplus
extern "C" {
#endif

/* No extent is known: prior_m2 the variance of a place on it, on each axis. */
void rho_body_start(struct rho_body_filter *body, uint32_t track_id, float prior_m2);

/*
 * Sets the heading by a velocity (x, y) with its covariance xx, yx, yy, where the speed is three
 * times its sigma across the velocity. Constant cost.
 */
void rho_body_turn(struct rho_body_filter *body, const float velocity_mps[2],
                   const float covariance[3]);

/* A covariance of x and y in the directions of the body: along, cross, across. Constant cost. */
void rho_body_to_axes(const struct rho_body_filter *body, const float xx_yx_yy[3], float axes[3]);

/* The variance along with what it may be more, as long as few plots have told it. */
float rho_body_most_along_m2(const struct rho_body_filter *body);

/* Variances of a place on the body in x and y: xx, yx, yy. Constant cost. */
void rho_body_spread(const struct rho_body_filter *body, float xx_yx_yy[3]);

/* The plots of one look. */
struct rho_body_look {
    unsigned num_plots;
    float along_m2, across_m2;             /* sums of squared distances from the reference point */
    float cross_m2;                        /* ... and of their products */
    float noise_along_m2, noise_across_m2; /* sums of the plots' own variances */
};

/*
 * The mean of n plots, of the most that were ever seen at once, is off by this share of the
 * variance that the mean of n places anywhere on the body has. Constant cost.
 */
float rho_body_missed_share(const struct rho_body_filter *body, unsigned n);

/* After the reference point was updated with these plots. Constant cost. */
void rho_body_add(struct rho_body_filter *body, const struct rho_body_look *look);

/* What is known of the extent. Constant cost. */
void rho_body_shape(const struct rho_body_filter *body, struct rho_body *shape);

#ifdef __cplusplus
}
#endif

#endif
