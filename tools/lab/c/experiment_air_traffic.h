/* SPDX-License-Identifier: MIT */
/*
 * experiment_air_traffic: the whole chain on the scene air-traffic, beside the same filter with
 * true association.
 *
 * Parts: `grid` (aircraft and clutter), `stress` (what else goes wrong), `pairs` (two close
 * together), `operation` (detection against false tracks), `clutter` (false tracks an hour without
 * a target), `rivals` (Stone Soup).
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_AIR_TRAFFIC_H
#define RHOTRACK_TOOL_EXPERIMENT_AIR_TRAFFIC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/grid.h"
#include "evaluation/evaluation.h"
#include "pipeline/pipeline.h"
#include "scenario.h"
#include "scene/scene.h"
#include "verdicts.h"

/* ---- traffic --------------------------------------------------------------------------------- */

#define AIR_CUTOFFS 2
extern const double air_cutoffs_m[AIR_CUTOFFS]; /* the first is the one that tables show */

#define AIR_FOUND_SCANS 12 /* of a target's life, in which it may be found */
#define AIR_SETS 3

enum air_group { AIR_GRID = 0, AIR_STRESS, AIR_OPERATION };

struct air_case {
    enum air_group group;
    const char *name;
    double targets, clutter; /* targets 0: clutter alone, which is not simulated */
    size_t num_scans;
    size_t share; /* one run of so many of the experiment's */
    bool has_limit;
    const char *sets[AIR_SETS]; /* of the scene, as `simulate` takes them; NULL past the last */
};
extern const struct air_case air_cases[];
size_t air_num_cases(void);

/* Means over the scans of a run, and over runs. */
struct air_figures {
    double gospa_m, localisation_m, missed, false_a_scan;
    double completeness, switches, fragments, delay_scans, rmse_m;
    double nees, nees_inside, velocity_ratio, velocity_inside; /* as of evaluation.h */
};

/* One case of one run, or all of them: counts are sums then, figures means. */
struct air_result {
    struct air_figures tracks[AIR_CUTOFFS], limit[AIR_CUTOFFS];
    double us, max_us; /* a scan; of several runs the least mean, and its longest */
    double plots;      /* a scan */
    double min_scans;  /* hits that started a track in most scans */
    double false_tracks, hours;
    double alarms, alarm_hours; /* operation: false tracks with the same clutter alone */
    /* by scans since its first one: targets that lived so long, and had had a track by then */
    double alive[AIR_FOUND_SCANS], found[AIR_FOUND_SCANS];
};

/* This thread's time of the processor, in which other programs on the machine do not count. */
double air_clock_us(void);

/* The scene of a case, which the caller frees, and what a tracker is told of it. */
struct scene *air_scene(const struct air_case *of);

/* Of an evaluation's result; and for means over runs: adds (squares of distances), then divides. */
struct air_figures air_figures_of(const struct evaluation *evaluation);
void air_figures_add(struct air_figures *sum, const struct air_figures *of);
void air_figures_divide(struct air_figures *sum, double runs);

/* A simulation through the chain, evaluated; and its limit. */
struct air_result air_simulated(const struct parameters *parameters,
                                const struct simulation *simulation, bool has_limit,
                                struct pipeline *chain);
struct air_result air_run(const struct air_case *of, uint64_t seed, uint64_t run,
                          struct pipeline *chain);

/* The targets or the tracks of one scan, in memory that grows. Targets replace what is there. */
struct air_points {
    size_t count, capacity;
    struct evaluation_point *points;
};
void air_points_truth(struct air_points *truth, const struct simulation *simulation, size_t scan);
void air_points_add(struct air_points *points, const struct rho_report *report, int32_t first_id);

/* A simulated scan as the library takes it, plots in the chain's memory. */
struct rho_scan air_scan(const struct simulation *simulation, size_t index, struct pipeline *chain);

/*
 * With true association: a tracker for each target that gets this target's plots alone, and starts
 * tracks at min_scans hits in the window, whatever the score. Fills num_scans lists.
 */
void air_limit(const struct parameters *parameters, const struct simulation *simulation,
               unsigned min_scans, struct pipeline *chain, struct air_points *scans);

/* ---- pairs ----------------------------------------------------------------------------------- */

struct air_pair {
    const char *name, *scenario;
    double num_scans, spacing_m, merge_m;
    double apart_m;    /* times at which they are closer do not count: who is who? */
    double kept_least; /* bar of `kept`; NAN: none */
};
#define AIR_PAIRS 6
extern const struct air_pair air_pairs[AIR_PAIRS];

/* Shares of the runs. */
struct air_pair_result {
    double kept;                   /* no target's track became another */
    double lost;                   /* at the last four scans never both had a track */
    double switches, completeness; /* means */
};

struct air_pair_result air_pair_run(const struct air_pair *of, uint64_t seed, uint64_t run,
                                    struct pipeline *chain);

/* ---- clutter alone --------------------------------------------------------------------------- */

#define AIR_ALARM_SCANS 500 /* a run */
#define AIR_ALARMS 5

struct air_alarm {
    double clutter, wanted_per_hour;
};
extern const struct air_alarm air_alarms[AIR_ALARMS];

struct air_alarm_result {
    double scans, hours, confirmed, low_per_hour, high_per_hour, us, min_scans;
};

struct air_alarm_result air_alarm_run(const struct air_alarm *of, uint64_t seed, uint64_t run,
                                      struct pipeline *chain);

/* ---- Stone Soup ------------------------------------------------------------------------------ */

#define AIR_RIVALS 2
#define AIR_RIVAL_SCANS 120
#define AIR_RIVAL_RUNS 2 /* at most */

struct air_rival {
    const char *name;
    struct air_figures figures;
    double us;
};

struct air_rivals {
    size_t num_runs;
    const char *missing; /* NULL, or why there are none, and how to get them */
    struct air_rival own, others[AIR_RIVALS];
};

/*
 * Runs it on files in FOLDER/stonesoup, and rhotrack on the same plots: so many runs, or
 * AIR_RIVAL_RUNS.
 */
struct air_rivals air_rivals_run(uint64_t seed, size_t num_runs, const char *folder,
                                 struct pipeline *chain);

/* ---- all of it ------------------------------------------------------------------------------- */

struct air_report {
    uint64_t seed;
    size_t num_runs;
    unsigned parts;             /* AIR_PART_... */
    struct air_result *results; /* by case; NULL where neither grid nor stress nor operation */
    struct air_pair_result pairs[AIR_PAIRS];
    size_t pair_runs;
    struct air_alarm_result alarms[AIR_ALARMS];
    struct air_rivals rivals;
    struct verdicts verdicts;
};

enum {
    AIR_PART_GRID = 1,
    AIR_PART_STRESS = 2,
    AIR_PART_OPERATION = 4,
    AIR_PART_PAIRS = 8,
    AIR_PART_CLUTTER = 16,
    AIR_PART_RIVALS = 32,
    AIR_PART_ALL = 63
};

/* 0 where there is no such part. */
unsigned air_part_named(const char *name);

/* The parts' figures; folder for the rivals' files. */
struct air_report air_measure(uint64_t seed, size_t num_runs, unsigned parts, const char *folder);
void air_report_free(struct air_report *report);

void air_judge(struct air_report *report);

/* Tables of the parts, with their heads; NULL past the last, or where the part was not measured. */
#define AIR_TABLES 7
struct air_table {
    const char *heading, *text;
    struct grid grid;
};
/* Fills tables of what was measured; returns how many. */
size_t air_tables(const struct air_report *report, struct air_table tables[AIR_TABLES]);

/* FOLDER/index.html and its pictures. */
void air_page(const struct air_report *report, const char *folder);

#endif
