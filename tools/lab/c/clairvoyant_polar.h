/* SPDX-License-Identifier: MIT */
/*
 * clairvoyant_polar: the straight-line fit, with the covariance that polar plots truly have, of
 * somebody who knows which plots are the target's; in double precision. The measure of what
 * initiation loses by not knowing.
 */
#ifndef RHOTRACK_TOOL_CLAIRVOYANT_POLAR_H
#define RHOTRACK_TOOL_CLAIRVOYANT_POLAR_H

#include <stdbool.h>
#include <stddef.h>

#include "clairvoyant.h"
#include "scenario.h"

/*
 * Only what a fit of CLAIRVOYANT_PLOTS_MAX scans needs: interval_s, sigma_m and process_noise_mps2
 * are not looked at.
 */
struct clairvoyant_polar {
    const struct clairvoyant_model *model;
    const struct scenario_radar *radar; /* in the origin */
    bool has_range_rate;                /* it counts */
    double clutter_mean;                /* plots a turn, uniform in range and azimuth */
};

/*
 * Least squares through 3 .. CLAIRVOYANT_PLOTS_MAX plots of a target at their own times, and the
 * initiator's score with the clutter's true density. Range rates are linearised where the places
 * alone put the track.
 */
struct clairvoyant_fit clairvoyant_polar_fit(const struct clairvoyant_polar *of,
                                             const double *times_s,
                                             const struct simulated_plot *plots, size_t num_plots);

#endif
