/* SPDX-License-Identifier: MIT */
/*
 * second_plots: how often a sensor makes two plots of one target, and how far they lie apart.
 *
 * Long targets, side lobes and plot extractors that split a blip give a second plot near the first.
 * Clutter explains such plots badly, as they come far more often, so that a second track would
 * start beside the first. So the tracker learns for each sensor how many unclaimed plots, beyond
 * those of clutter, lie near the claimed plot of a confirmed track, and the density q of their
 * distances along and across the line of sight, in standard deviations of the plots. The density
 * of second plots at z near each claimed plot p is then
 *
 *     rate q(z - p)
 *
 * It is added to the density of clutter against which new tracks start. Where a younger track
 * started beside an older one, it also tells whether both are of one target with second plots or of
 * two targets. Two targets that separate stay two, as their plots leave the learned distances.
 * src/DESIGN.md ("Second plots of one target") derives it.
 */
#ifndef RHOTRACK_SECOND_PLOTS_H
#define RHOTRACK_SECOND_PLOTS_H

#include <stdint.h>

#include "rhotrack/config.h"

/* Bins of the distance of a second plot on an axis, up to 1, 2, 3, 4, 6, 8, 12, 16 sigmas. */
#define RHO_SECOND_BINS 8

/* Statistics of one sensor's second plots: sums, halved now and then. */
struct rho_second_plots {
    float looks; /* claimed plots of confirmed tracks */
    float plots; /* second plots near these claimed plots */
    float along[RHO_SECOND_BINS], across[RHO_SECOND_BINS]; /* second plots by distance */
};

#endif
