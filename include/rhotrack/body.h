/* SPDX-License-Identifier: MIT */
/*
 * body: targets that give several plots a scan: trucks for a traffic radar, ships for a harbour's.
 *
 * A body is the extent of such a target. A tracker that is told the length of the longest body
 * groups the plots of a scan before tracks claim them (RHO_BODIES). Each plot goes to the track
 * whose body explains it best: by its place in the body's frame, with the variances of a place on
 * the body, of the plot and of the prediction, up to 3 standard deviations on each axis; and by its
 * range rate. The other plots are grouped where they are no farther from each other than the
 * longest body, and their range rates agree. A group becomes one plot at the mean of its plots,
 * with the variance
 *
 *     (B + R) / n       B of a place on the body, R of a plot, n plots
 *
 * for gates, claims and starts. So a point target's plot stays as it is, and every plot has the
 * fate of its group. The extent is then estimated from the track's plots (random matrix in the
 * frame of the velocity): M. Feldmann, D. Franken, W. Koch, Tracking of Extended Objects and Group
 * Targets Using Random Matrices, IEEE Transactions on Signal Processing 59 (2011), 1409-1420.
 *
 * Two targets that are near each other from their first plots on are taken for one body, until it
 * is surely wider than the widest body (0.3 of its length or of half the longest, but 2.5 m at
 * least), or longer than the longest body, or its range rates show parts that move apart
 * (src/step/split_bodies.c, src/bodies/body_split_evidence.c). Whether two tracks are of one target
 * or of two is told by likelihoods: of the look's plots by two bodies, over those by one
 * (src/bodies/duplicate_tracks.c). A body that turns at once keeps its plots where all their range
 * rates say so (src/bodies/sudden_turns.c). Plots of one body in two sectors of a turn are two
 * groups.
 *
 * Stack: 128 bytes at most.
 */
#ifndef RHOTRACK_BODY_H
#define RHOTRACK_BODY_H

#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

struct rho_tracker;

#define RHO_LIMIT_BODY_M 5000.0f /* the longest body that a tracker can be told */

/* Estimate of the variance of a place on a body, on one axis. */
struct rho_body_side {
    float mean_m2;     /* mean of the plots' squared places, less their noise; may be 0 or less */
    float weight;      /* weight of the mean: each plot without noise adds 5, one with noise less */
    float variance_m4; /* variance of the mean */
    float prior_share; /* weight of the prior in the mean, 0 .. 1 */
};

#define RHO_BODY_SUMS 10

/* Evidence by looks with several plots on limbs, or two targets; it fades over 80 looks. */
struct rho_body_doubt {
    float looks, long_looks; /* looks; looks with plots farther apart than the longest body */
    float steady_looks;      /* looks with range rates since the heading last turned */
    float time_s;            /* duration of the steady looks */
    float cos_heading, sin_heading;
    /* over the steady looks, of range rates, places and noise: rows in src/bodies/bodies.h */
    float sums[RHO_BODY_SUMS];
    int64_t time_us; /* time of the last look */
};

/* Estimate of the extent of a track's body, within the tracker. */
struct rho_body_filter {
    uint32_t track_id;
    float along_m2, across_m2; /* variances of a place on the body, along and across the heading */
    float prior_m2;            /* prior of both variances, while no heading is known */
    float aspect;              /* prior length over prior width, 1 or more */
    struct rho_body_side along, across;
    /* slope of the line of scatterers against the heading, and 1 / its variance */
    float slope, slope_weight;
    float cos_heading, sin_heading;
    float heading_sigma_rad;
    float plots;         /* plots that the extent was estimated from */
    float plots_a_look;  /* mean number of plots in a look that has any, smoothed */
    float two_nat;       /* ln evidence that its target is not that of an older track beside it */
    uint16_t most_plots; /* largest number of plots in one scan */
    uint8_t has_heading;
    struct rho_body_doubt doubt;
};

/* The body of a track: a rectangle, with its length along the heading. */
struct rho_body {
    float length_m, width_m, heading_rad;
    float sigma_length_m, sigma_width_m, sigma_heading_rad;
    /* sigma of the body's centre about the track's place, which is the mean of its plots */
    float sigma_along_m, sigma_across_m;
    float plots; /* plots that the body was estimated from, the newest; about 500 at most */
};

/*
 * Sets the length of the longest body: targets may then give several plots a scan. 0: targets are
 * points, as after rho_tracker_init. Applies from the next step on. Plots of a scan beyond
 * RHO_MAX_PLOTS are NO_ROOM then. Errors: NULL, STATE (not initialised), VALUE (not 0 ..
 * RHO_LIMIT_BODY_M), CAPACITY (other than 0 without RHO_BODIES). Constant cost.
 */
RHO_MUST_CHECK enum rho_status rho_tracker_set_body_max(struct rho_tracker *tracker,
                                                        float length_max_m);

/*
 * True of a track that has a body. track: its index in the report. 0 where there is no such track,
 * or no scan had two plots of it so far. Constant cost.
 */
int rho_tracker_has_body(const struct rho_tracker *tracker, unsigned track);

/* Computes a track's body. Returns 0, with *body unchanged, without one. Constant cost. */
int rho_tracker_body_of(const struct rho_tracker *tracker, unsigned track, struct rho_body *body);

RHO_END_C

#endif
