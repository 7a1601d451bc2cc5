/* SPDX-License-Identifier: MIT */
/*
 * bearing_mix: the bearings of one look of which at most one is a target's, as one filter expects
 * them: probabilistic data association ("Bearings are weighed" in src/DESIGN.md).
 *
 * Each model of each hypothesis mixes them for itself: what lies beside a straight flight may lie
 * on a turn. How well it explains the look, misses included, then changes its probability.
 *
 * Stack: 40 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_BEARING_MIX_H
#define RHOTRACK_BEARING_MIX_H

#include "rhotrack/config.h"
#include "rhotrack/detail/kalman.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

/* The bearings of one look, weighed for one track. The scan is referred to, not copied. */
struct rho_weighed_bearings {
    const struct rho_bearing_scan *scan;
    /* of each bearing: pd over the density of false ones, rad; 0: it is none of the track's */
    float weight[RHO_MAX_BEARINGS];
    float miss;             /* probability that the look does not show the target */
    struct rho_slope slope; /* of the bearing that is claimed; sigma 0: none */
    /* variance of lasting errors, for expecting a bearing; and as it counts in estimates */
    float lasting_rad2, lasting_in_estimate_rad2;
};

/* A bearing as a filter at its time expects it: how far off, and the variance of that. */
struct rho_expected_bearing {
    float off_rad, variance_rad2;
    float nis;     /* the larger one of bearing and slope */
    float density; /* a radian, and a slope of 1 where one is measured */
};

/*
 * Fills *expected with bearing i of a look as an estimate at its time expects it. Returns 0 where
 * that is nearer than a metre to the sensor. Cost: 300 instructions, 450 with a slope. Stack: 330
 * bytes.
 */
int rho_bearing_expect(const struct rho_kalman *estimate, const struct rho_weighed_bearings *look,
                       unsigned i, struct rho_expected_bearing *expected);

/* Sums over the bearings that one filter has mixed, by their probability densities. */
struct rho_bearing_mix {
    float hit; /* of the weights */
    float off_rad, square_rad2, noise_rad2, variance_rad2;
};

/* Adds bearing i of a look as the filter expects it. Cost: 40 instructions. */
void rho_bearing_mix_add(struct rho_bearing_mix *mix, const struct rho_weighed_bearings *look,
                         unsigned i, const struct rho_expected_bearing *expected);

/*
 * The one bearing that changes the filter as all of them do, or a miss, as far as their weights
 * allow: how far it is off, and its sigma. Returns 0 where they tell next to nothing.
 */
int rho_bearing_mix_as_one(const struct rho_bearing_mix *mix, float miss, float *off_rad,
                           float *sigma_rad);

RHO_END_C

#endif
