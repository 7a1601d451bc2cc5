/* SPDX-License-Identifier: MIT */
/*
 * clairvoyant: the straight-line fit of somebody who knows which plots are the target's, in double
 * precision.
 *
 * No initiation can, on average, find much more than this fit with the same score and threshold
 * would accept: it is the measure of what the initiator loses by not knowing.
 */
#ifndef RHOTRACK_TOOL_CLAIRVOYANT_H
#define RHOTRACK_TOOL_CLAIRVOYANT_H

#include <stddef.h>

#define CLAIRVOYANT_PLOTS_MAX 12

struct clairvoyant_plot {
    double t_s, x_m, y_m;
    double density_per_m2; /* of clutter there, a scan */
};

struct clairvoyant_model {
    size_t num_scans; /* of the window */
    double interval_s;
    double sigma_m, process_noise_mps2;
    double pd;
    double area_m2;
    double v_min_mps, v_max_mps;
};

struct clairvoyant_fit {
    double vx_mps, vy_mps;
    double chi2, score_nat;
};

/*
 * Generalised least squares through 3 .. CLAIRVOYANT_PLOTS_MAX plots of increasing time, and the
 * initiator's score.
 */
struct clairvoyant_fit clairvoyant_fit(const struct clairvoyant_model *model,
                                       const struct clairvoyant_plot *plots, size_t num_plots);

#endif
