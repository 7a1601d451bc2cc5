/* SPDX-License-Identifier: MIT */
/*
 * body_extent_filter: estimates a target's length and width from plots of its scatterers: from
 * their distances to the reference point, along the body and across it.
 *
 * The distance of a plot of some place of the body has the variance
 *
 *     L^2 / 12 + R        along, and W^2 / 12 + R across,
 *
 * where R is the plot's noise, for scatterers that are spread over a rectangle of length L and
 * width W. The means of squares less R are smoothed over some 500 plots without noise. The prior
 * length is half of the longest body, with next to no weight; the prior width is that over the
 * aspect, known to 30 %. Both belong to a frame that turns with the body. If the heading is wrong,
 * a look's plots lie along a sloping line. The part of the slope that the heading's sigma explains,
 * beyond the learned slope of the scatterers themselves, is subtracted, and the width is corrected
 * for it.
 *
 * Scatterers stay on the body: N of them, each anywhere in its part, determine L with a sigma of
 * L / N^1.5 and the centre with L / (N^1.5 root 12), however long they are seen.
 *
 * Constant cost. Stack: 104 bytes at most.
 */
#ifndef RHOTRACK_BODY_EXTENT_FILTER_H
#define RHOTRACK_BODY_EXTENT_FILTER_H

#include <stdint.h>

#include "rhotrack/body.h"

RHO_BEGIN_C

/*
 * Starts a body whose extent is unknown. prior_m2: variance of a place on it, on each axis; aspect:
 * usual length over width of such bodies, 1 or more.
 */
void rho_body_filter_init(struct rho_body_filter *body, uint32_t track_id, float prior_m2,
                          float aspect);

/* Sets the heading and its sigma. The first one tells the width of a body from its length. */
void rho_body_set_heading(struct rho_body_filter *body, float cos_heading, float sin_heading,
                          float sigma_rad);

/* Sets the heading by a velocity and its covariance xx, yx, yy, if over four of its sigmas. */
void rho_body_set_heading_if_moving(struct rho_body_filter *body, const float velocity_mps[2],
                                    const float covariance[3]);

/* Rotates a covariance of x and y into the axes of a heading: along, cross term, across. */
void rho_body_rotate_covariance(float cos_heading, float sin_heading, const float xx_yx_yy[3],
                                float axes[3]);

/* Upper bound of the variance along the body, for gates: the prior's share falls with plots. */
float rho_body_along_bound_m2(const struct rho_body_filter *body);

/* Covariance of a random place on the body, in x and y: xx, yx, yy. Constant cost. */
void rho_body_place_covariance(const struct rho_body_filter *body, float xx_yx_yy[3]);

/* Sums over the plots of one body in one look. */
struct rho_body_look {
    unsigned num_plots;
    /* sums of the plots' squared distances from the reference point, along the body and across */
    float along_m2, across_m2;
    /* sum of products of the plots' distances along and across */
    float cross_m2;
    float noise_along_m2, noise_across_m2; /* sums of the plots' own variances */
};

/*
 * The mean of n plots has this share of the variance that the mean of n random places on the body
 * would have: it falls with n as a share of the most plots that a look ever had, as scatterers stay
 * the same.
 */
float rho_body_mean_variance_share(const struct rho_body_filter *body, unsigned n);

/* Updates the extent by a look's plots, after the reference point was updated with them. */
void rho_body_add_plots(struct rho_body_filter *body, const struct rho_body_look *look);

/* Fills *shape with length, width, heading and their sigmas. Constant cost. */
void rho_body_shape(const struct rho_body_filter *body, struct rho_body *shape);

RHO_END_C

#endif
