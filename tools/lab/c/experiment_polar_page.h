/* SPDX-License-Identifier: MIT */
/*
 * experiment_polar_page: the figures of the polar experiment, and their page with pictures of gates
 * and errors.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_POLAR_PAGE_H
#define RHOTRACK_TOOL_EXPERIMENT_POLAR_PAGE_H

#include "base/grid.h"
#include "experiment_polar.h"
#include "verdicts.h"

#define POLAR_SUMMARIES (POLAR_LEVELS * POLAR_CASES)

/* One case at one clutter level over all runs. */
struct polar_summary {
    const struct polar_case *of;
    double clutter;
    double found, clairvoyant; /* shares of the targets */
    double false_a_run, found_m, search_ms;
    double tracked, false_tracks_a_run;
    double confirm_at; /* mean turn, 1 = first */
    double rmse_m, along_m, reference_m;
    struct polar_errors errors;
};

/* POLAR_SUMMARIES of them in new memory, by level, then case. */
struct polar_summary *polar_summaries(uint64_t seed, size_t num_runs);

struct grid polar_initiation_grid(const struct polar_summary *summaries);
struct grid polar_tracks_grid(const struct polar_summary *summaries);
struct verdicts polar_verdicts(const struct polar_summary *summaries);

/* FOLDER/index.html and its pictures. */
void polar_page(const struct polar_summary *summaries, const struct verdicts *verdicts,
                size_t num_runs, uint64_t seed, const char *folder);

#endif
