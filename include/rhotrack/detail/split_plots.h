/* SPDX-License-Identifier: MIT */
/*
 * split_plots: how often a sensor makes two plots of one target, and how far they lie apart.
 *
 * Long targets, side lobes and plot extractors that split a blip give a second plot near the first.
 * As clutter such a plot would be far too rare, and a second track would start beside the first. So
 * the tracker learns for each sensor how many unclaimed plots lie near the claimed plot of a
 * confirmed track, beyond what clutter explains, and at what distances along and across the line of
 * sight, in standard deviations of the plots. The density of second plots about each claimed plot p
 * is then
 *
 *     rate q(z - p)
 *
 * It is added to the density of clutter against which new tracks start. Of two tracks, the younger
 * of which started beside the older, it tells whether they are one target with second plots or two
 * targets. Two targets that separate stay two: their plots leave the distances that were learned.
 * src/DESIGN.md ("Second plots of one target") derives it.
 */
#ifndef RHOTRACK_SPLIT_PLOTS_H
#define RHOTRACK_SPLIT_PLOTS_H

#include <stdint.h>

#include "rhotrack/config.h"

/* Distances on an axis: up to 1, 2, 3, 4, 6, 8, 12, 16 standard deviations. */
#define RHO_SECOND_BINS 8

/* Statistics of one sensor's second plots: sums that fade. */
struct rho_second_plots {
    int32_t sensor_id;
    float looks; /* claimed plots of confirmed tracks; 0: the table is free */
    float plots; /* second plots near them */
    float along[RHO_SECOND_BINS], across[RHO_SECOND_BINS]; /* of these, by distance */
};

#endif
