/* SPDX-License-Identifier: MIT */
/*
 * experiment_initiation: the cases of the track-initiation experiment, one run of them, and what
 * came out.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_INITIATION_H
#define RHOTRACK_TOOL_EXPERIMENT_INITIATION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/initiator.h"
#include "scenario_plan.h"

#define INITIATION_SCANS 7
#define INITIATION_TARGETS_MAX 3

enum initiation_paths {
    PATHS_NONE,
    PATHS_CROSSING,   /* the paper's Table 1 */
    PATHS_RADAR,      /* the paper's Table 3 */
    PATHS_STRAIGHT,   /* start[] */
    PATHS_TURN,       /* start[0], 2 degrees a scan */
    PATHS_ACCELERATE, /* start[0], 10 m/s^2 along the path */
    PATHS_WANDER,     /* Table 1, velocity changes of 10 m/s a scan */
};

/* What must hold; a bar that is not set (NAN) is only reported. */
struct initiation_bars {
    double found_min;  /* of the targets (or of the runs where all were found) */
    double false_max;  /* tracks a run */
    double behind_max; /* found may be so far below the clairvoyant fit */
};

struct initiation_case {
    const char *group, *name;
    enum initiation_paths paths;
    struct scenario_state start[2];
    size_t num_starts;
    struct scenario_box box;
    double clutter_per_km2, clutter_per_scan;
    struct scenario_box spot;
    double spot_per_km2; /* beyond the clutter around */
    double true_pd;
    uint16_t min_scans;
    double score_min_nat, process_noise_mps2;
    double tolerance_m; /* found: mean position error over the scans at most this */
    bool all_count;     /* found_min is of the runs where all targets were found */
    struct initiation_bars bars;
};

size_t initiation_num_cases(void);
const struct initiation_case *initiation_case_at(size_t index);

/* The case's plan; the caller frees it. */
struct scenario_plan initiation_plan(const struct initiation_case *of, struct random *random);

struct initiation_run {
    int targets, found, clairvoyant;
    int tracks, false_tracks;
    double error_m; /* sum of the found targets' mean errors */
    double time_us; /* of the search */
    struct rho_initiator_work work;
};

/*
 * One run, with the generator of (seed, case, run). The initiator is only memory; it holds the
 * result.
 */
struct initiation_run initiation_run(const struct initiation_case *of,
                                     struct rho_initiator *initiator, struct random *random);

/* The same for given data; plan may be NULL where no target is known. */
struct initiation_run initiation_judge(const struct initiation_case *of,
                                       const struct scenario_plan *plan,
                                       const struct simulation *simulation,
                                       struct rho_initiator *initiator);

struct initiation_summary {
    const struct initiation_case *of;
    size_t runs;
    double pd, all_found, clairvoyant; /* NAN without targets */
    double false_a_run, error_m;
    double time_us;                         /* median */
    double seeds, lookups, distances, fits; /* means */
    double seeds_max, lookups_max, distances_max;
};

struct initiation_summary initiation_summarise(const struct initiation_case *of,
                                               const struct initiation_run *runs, size_t num_runs);

/* One figure with its bar. */
struct initiation_verdict {
    const char *what;
    double value, bar;
    bool is_held;
};

/* The verdicts of a case: at most 3. Returns how many. */
size_t initiation_verdicts(const struct initiation_summary *summary,
                           struct initiation_verdict verdicts[3]);

#endif
