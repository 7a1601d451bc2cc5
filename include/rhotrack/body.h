/* SPDX-License-Identifier: MIT */
/*
 * body: targets that give several plots a scan: trucks for a traffic radar, ships for a harbour's.
 *
 * A tracker that is told the longest body groups the plots of a scan before tracks claim them
 * (RHO_BODIES). Each plot goes to the track whose body explains it best: by its place in the
 * body's frame, with the variances of a place on the body, of the plot and of the prediction, up
 * to 3 standard deviations on each axis; and by its range rate. The others are grouped where they
 * are no farther from each other than the longest body, and their range rates agree. A group is
 * one plot at its mean, with the noise
 *
 *     (B + R) / n       B of a place on the body, R of a plot, n plots
 *
 * for gates, claims and starts. So point targets are tracked as ever, and every plot has the fate
 * of its group. The extent is then estimated from the track's plots (random matrix in the frame of
 * the velocity): M. Feldmann, D. Franken, W. Koch, Tracking of Extended Objects and Group Targets
 * Using Random Matrices, IEEE Transactions on Signal Processing 59 (2011), 1409-1420.
 *
 * Two targets that are near each other from their first plots on are one body, until it is surely
 * wider than 0.3 of the longest, or longer than that, or its range rates say that its parts move
 * apart (src/step/split_bodies.c, src/bodies/body_doubt.c). Of two tracks whose bodies stay on
 * each other the younger ends. Plots of one body in two sectors of a turn are two groups.
 *
 * Stack: 128 bytes at most.
 */
#ifndef RHOTRACK_BODY_H
#define RHOTRACK_BODY_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

struct rho_tracker;

#define RHO_LIMIT_BODY_M 5000.0f /* the longest body that a tracker can be told */

/* One axis of a body, as its plots tell it. */
struct rho_body_side {
    float mean_m2;     /* of squares, less noise; it may be 0 or less */
    float weight;      /* evidence behind the mean, in plots: one without noise counts 1 */
    float variance_m4; /* of the mean */
    float prior_share; /* of the mean that is still the prior's */
};

/*
 * What looks of several plots say of two targets that are taken for one body. All fades over some
 * 80 of them.
 */
struct rho_body_doubt {
    float looks, long_looks; /* ... that are longer than any body */
    float steady_looks;      /* since the heading last turned; with range rates */
    float time_s;            /* that they took */
    float cos_heading, sin_heading;
    float plots_beyond_one; /* of each look */
    /*
     * about a look's mean: squares of places along the line of sight and across it, and their
     * product; of range rates; and of these with both places; what noise is expected to add
     */
    float far_m2, side_m2, cross_m2, rates_m2ps2, far_m2ps, side_m2ps;
    float side_noise_m2, rate_noise_m2ps2;
    /* what an error of the velocity across the line of sight may add to range rates */
    float unknown_m2ps2;
    float doubled;      /* scans in which its body lay on that of an older track; fades, too */
    int64_t time_us;    /* of the last look */
    int64_t doubled_us; /* of the last such scan */
};

/* The extent of a track, within the tracker. */
struct rho_body_filter {
    uint32_t track_id;
    float along_m2, across_m2; /* variances of a place on the body */
    float prior_m2;            /* of one of which nothing is known */
    struct rho_body_side along, across;
    float slope, slope_weight; /* how far its scatterers seem turned, and 1 / variance */
    float cos_heading, sin_heading;
    float heading_sigma_rad;
    float plots;         /* that all this comes from */
    uint16_t most_plots; /* of one scan */
    uint8_t has_heading;
    struct rho_body_doubt doubt;
};

/* The body of a track: a rectangle, its length along the heading. */
struct rho_body {
    float length_m, width_m, heading_rad;
    float sigma_length_m, sigma_width_m, sigma_heading_rad;
    /* sigma of its centre about the track's place, which is the mean of what was seen */
    float sigma_along_m, sigma_across_m;
    float plots; /* that this comes from: about 500 at most, the newest ones */
};

/*
 * Targets may give several plots a scan, and are length_max_m long at most; 0: they are points, as
 * after rho_tracker_init. Applies from the next step on. Of scans that have more than
 * RHO_MAX_PLOTS plots the others are NO_ROOM then.
 * Errors: NULL, STATE (not initialised), VALUE (not 0 .. RHO_LIMIT_BODY_M), CAPACITY (other than 0
 * without RHO_BODIES). Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_set_body_max(struct rho_tracker *tracker,
                                                        float length_max_m);

/*
 * track: place among the tracker's tracks, which is that in the report. 0, and *body is unchanged:
 * no such track, or no scan of two plots of it yet. Constant cost.
 */
int rho_tracker_body_of(const struct rho_tracker *tracker, unsigned track, struct rho_body *body);

#ifdef __cplusplus
}
#endif

#endif
