/* SPDX-License-Identifier: MIT */
/*
 * experiment_doppler: what range rates are worth. The clutter at which the scene `doppler` without
 * them just meets its bars is looked for; then ten times as much, with range rates, ambiguous ones,
 * and none.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_DOPPLER_H
#define RHOTRACK_TOOL_EXPERIMENT_DOPPLER_H

#include "base/grid.h"
#include "experiment_polar.h"
#include "verdicts.h"

#define DOPPLER_PD_MIN 0.95
#define DOPPLER_FALSE_MAX 0.1
#define DOPPLER_TIMES 10.0 /* as much clutter */

#define DOPPLER_CASES 4
extern const struct polar_case doppler_cases[DOPPLER_CASES]; /* the first is without range rates */

#define DOPPLER_LEVELS 7
extern const double
    doppler_clutter[DOPPLER_LEVELS]; /* where the limit without range rates is looked for */

/* One case at one clutter level over all runs. */
struct doppler_figures {
    const struct polar_case *of;
    double clutter, static_clutter;
    double found, false_a_run, search_ms; /* a batch of seven turns */
    double prompt, tracked, false_tracks,
        confirm_at; /* the tracker: after five turns, at the end, a run, mean turn */
    double rmse_m, rmse_mps;
};

struct doppler_figures doppler_measure(const struct polar_case *of, double clutter,
                                       double static_clutter, uint64_t seed, size_t num_runs);

/* Without range rates the bars are met here; by batch and tracker. */
bool doppler_meets(const struct doppler_figures *figures);

struct doppler_result {
    size_t num_levels; /* measured without range rates: up to the first that misses */
    struct doppler_figures levels[DOPPLER_LEVELS];
    double limit; /* clutter a turn; 0: missed at the lowest */
    struct doppler_figures at_limit[DOPPLER_CASES], beyond[DOPPLER_CASES];
    struct doppler_figures still; /* beyond, half of the clutter stands still */
};

struct doppler_result doppler_run(uint64_t seed, size_t num_runs);

struct grid doppler_grid(const struct doppler_result *result);
struct verdicts doppler_verdicts(const struct doppler_result *result);

/* FOLDER/index.html and its picture. */
void doppler_page(const struct doppler_result *result, const struct verdicts *verdicts,
                  size_t num_runs, uint64_t seed, const char *folder);

#endif
