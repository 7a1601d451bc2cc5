/* SPDX-License-Identifier: MIT */
/*
 * experiment_two_radars: two radars that do not know of each other see the same aircraft: what
 * register finds of their biases, and what that is worth to the tracks.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_TWO_RADARS_H
#define RHOTRACK_TOOL_EXPERIMENT_TWO_RADARS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/grid.h"
#include "pipeline/pipeline.h"
#include "registration/register.h"
#include "scene/scene_observe.h"
#include "verdicts.h"

#define RADARS 2
#define RADARS_CASES 6

enum radars_biases { BIASES_LEFT = 0, BIASES_FOUND, BIASES_KNOWN };

/* Whose scans are tracked, with which biases taken off. */
struct radars_case {
    const char *name;
    unsigned radars; /* bits: 1 the first, 2 the second */
    enum radars_biases biases;
    bool is_as_arrived; /* scans are stepped as they arrive; else in the order of time */
};
extern const struct radars_case radars_cases[RADARS_CASES];
enum { CASE_FIRST = 0, CASE_SECOND, CASE_LEFT, CASE_FOUND, CASE_KNOWN, CASE_ARRIVED };

/* One case of one run; sums, to be added. */
struct radars_figures {
    double times, target_times; /* times looked at, targets in the radars' reach at them */
    double target_hours;
    double with_track; /* of the target_times */
    double switches, false_tracks, tracks;
    /* where both radars see: */
    double common_times;   /* targets at times */
    double duplicates;     /* tracks of a target beyond one */
    double errors, sum_m2; /* of the nearest track */
    double scans, late;    /* stepped, and refused as too late */
};

/* What register found in a run. */
struct radars_found {
    bool is_any; /* any target in common */
    double off[RADARS][NUM_REGISTER_KINDS], sigma[RADARS][NUM_REGISTER_KINDS];
    bool is_known[RADARS][NUM_REGISTER_KINDS];
    double targets, misfit;
};

struct radars_run {
    struct radars_figures figures[RADARS_CASES];
    struct radars_found found;
};

/* The scene, which the caller frees, and what a tracker is told of it. */
struct scene *radars_scene(void);

/* All cases of one run; reports: RHO_MAX_PLOTS plots of the chain are used. */
struct radars_run radars_run_all(const struct scene *scene, uint64_t seed, uint64_t run,
                                 struct pipeline *chain);

/* What register finds in a run. */
struct register_result radars_register(const struct scene_run *run,
                                       const struct parameters *parameters, struct pipeline *chain);

/* ---- over all runs: experiment_two_radars.c -------------------------------------------------- */

/* Errors of the biases of a kind, over runs and radars; NAN where none was known. */
struct radars_errors {
    size_t count, unknown;
    double rms, p95, worst, mean_sigma;
};

struct radars_summary {
    size_t num_runs;
    uint64_t seed;
    struct radars_figures figures[RADARS_CASES]; /* sums */
    struct radars_errors errors[NUM_REGISTER_KINDS];
    double variance; /* of all errors over their sigmas */
    const struct radars_run *runs;
};

double radars_rmse_m(const struct radars_figures *figures);

struct grid radars_tracks_grid(const struct radars_summary *summary);
struct grid radars_biases_grid(const struct radars_summary *summary);

/* FOLDER/index.html and its pictures. experiment_two_radars_page.c */
void radars_page(const struct radars_summary *summary, const struct verdicts *verdicts,
                 const char *folder);

#endif
