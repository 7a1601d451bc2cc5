/* SPDX-License-Identifier: MIT */
/*
 * experiment_polar: the scene `polar` as a radar's user meets it: initiation from seven turns, and
 * tracks over all of them, with each plot's own covariance or one isotropic sigma, with and without
 * range rate.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_POLAR_H
#define RHOTRACK_TOOL_EXPERIMENT_POLAR_H

#include <stdbool.h>
#include <stddef.h>

#include "pipeline/pipeline.h"
#include "rhotrack/initiator.h"
#include "rhotrack/measurement.h"
#include "rhotrack/tracker.h"
#include "scenario.h"

#define POLAR_TURNS_MAX 32
#define POLAR_WINDOW 7 /* turns that initiation sees */
#define POLAR_PROMPT 5 /* turns in which a track is wanted where it matters */
#define POLAR_TARGETS_MAX 32
#define POLAR_LEVELS 2

/* Mean clutter plots a turn. */
extern const double polar_clutter[POLAR_LEVELS];

/* What the library is told of a plot's noise and range rate. */
struct polar_case {
    const char *name;
    bool is_isotropic; /* the larger sigma of each plot, along and across */
    bool has_range_rate;
    double span_mps; /* its range rates are known up to multiples of it; 0: all */
};
#define POLAR_CASES 4
extern const struct polar_case polar_cases[POLAR_CASES];

/*
 * Tracks against targets after each turn, from the confirmation on. Sums of squared errors: of the
 * library's position, its part along the line of sight, and of the reference filter's position; of
 * the library's velocity.
 */
struct polar_errors {
    double sum_m2[POLAR_TURNS_MAX], along_m2[POLAR_TURNS_MAX], reference_m2[POLAR_TURNS_MAX];
    double sum_m2ps2[POLAR_TURNS_MAX];
    size_t count[POLAR_TURNS_MAX];
};

/* One case of one run. */
struct polar_result {
    /* initiation, batch of POLAR_WINDOW turns */
    int targets, found, clairvoyant, false_candidates;
    double found_m; /* sum of the found targets' mean errors */
    double search_us;
    /* the tracker over all turns */
    int prompt;        /* targets with a confirmed track after POLAR_PROMPT turns */
    int tracked;       /* targets with a confirmed track at the last turn */
    int false_tracks;  /* confirmed ones that are no target's */
    double confirm_at; /* sum over confirmed targets of the turns seen until then, 1 = first */
    int confirmed;
    struct polar_errors errors;
};

/*
 * A run with so much clutter and range rates, and what a tracker is told: `rhotrack simulate polar
 * --set clutter.0.plots=...`. pd 0: the scene's.
 */
struct simulation *polar_simulation(double clutter, double pd, uint64_t seed, uint64_t run,
                                    struct parameters *parameters);

/* The radar as the case tells of it; without a span the library is told nothing. */
struct rho_sensor polar_sensor(const struct polar_case *of, const struct parameters *parameters);

/* The scan as the case tells it to the library; plots has room for it. */
struct rho_scan polar_scan(const struct polar_case *of, const struct simulation *simulation,
                           size_t turn, struct rho_plot *plots);

/* The batch search of the first turns; returns its time. The result is in the bench's initiator. */
double polar_search(const struct polar_case *of, const struct parameters *parameters,
                    const struct simulation *simulation, struct pipeline *chain);

/* The part of the tracker: fills tracked, false_tracks, confirm_at, confirmed and errors. */
void polar_track(const struct polar_case *of, const struct parameters *parameters,
                 const struct simulation *simulation, struct pipeline *chain,
                 struct polar_result *result);

/* All of one case on one run's data. */
struct polar_result polar_run(const struct polar_case *of, const struct parameters *parameters,
                              const struct simulation *simulation, struct pipeline *chain);

/* True position of a target at a time. */
struct truth_point polar_truth(const struct simulation *simulation, size_t target, double t_s);

#endif
