/* SPDX-License-Identifier: MIT */
/*
 * second_plots: how often a sensor makes two plots of one target, and how far they lie apart.
 *
 * Long targets, side lobes and plot extractors that split a blip give a second plot near the first. Counted as clutter it is far
 * too rare there, and a second track starts beside the first. So the tracker learns, for each sensor, how many plots that nobody
 * claims lie near a plot that a confirmed track has claimed, beyond what clutter explains, and at what distances along and across
 * the line of sight, in the plots' standard deviations. From that follows the density of second plots about each claimed plot p:
 *
 *     rate q(z - p)
 *
 * It is added to the density of clutter that new tracks start against; and of two tracks of which the younger started beside the
 * elder, it tells whether they are one target with second plots or two targets. Nothing is forbidden: the plots of a target that
 * separates leave the distances that were learned. src/DESIGN.md ("Second plots of one target") derives it.
 */
#ifndef RHOTRACK_SECOND_PLOTS_H
#define RHOTRACK_SECOND_PLOTS_H

#include <stdint.h>

#include "rhotrack/config.h"

#if RHO_MAX_ECHOES > 0

/* Distances on an axis: up to 1, 2, 3, 4, 6, 8, 12, 16 standard deviations. */
#define RHO_SECOND_BINS 8

/* What one sensor's second plots are like: sums that fade. */
struct rho_second_plots {
    int32_t sensor_id;
    float looks; /* claimed plots of confirmed tracks; 0: the table is free */
    float plots; /* second plots near them */
    float along[RHO_SECOND_BINS], across[RHO_SECOND_BINS]; /* of these, by distance */
};

#endif
#endif
