/* SPDX-License-Identifier: MIT */
/*
 * experiment_passive: the experiments of the passive Hough transform paper
 * (rhotrack/detail/crossing.h) and what goes beyond it: what pruning does to ghosts and targets,
 * the paper's method (rhotrack/passive_paper.h), the default (rhotrack/passive.h).
 *
 * The paper gives no scan interval, noise, cells, threshold, false alarms or misses; the cases' are
 * ours. References were measured by an independent implementation in double precision, 50 to 300
 * runs a case.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_PASSIVE_H
#define RHOTRACK_TOOL_EXPERIMENT_PASSIVE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "clairvoyant_bearings.h"
#include "rhotrack/detail/ghost.h"
#include "rhotrack/passive.h"
#include "rhotrack/passive_paper.h"
#include "scenario_plan.h"

#define PASSIVE_SCANS 8
#define PASSIVE_INTERVAL_S 10.0
#define PASSIVE_TARGETS_MAX 6
#define PASSIVE_RULES 3 /* enum rho_ghost_rule */
#define PASSIVE_RANGE_MAX_M 100000.0

/* ---- scenes ---------------------------------------------------------------------------------- */

enum passive_region {
    PASSIVE_AHEAD,     /* as in the passive scenarios */
    PASSIVE_EXTENSION, /* on the extension of the first two sensors' base, which they cross */
    PASSIVE_NEAR       /* 15 to 35 km */
};

struct passive_setting {
    size_t sensors, targets;
    double sigma_deg, pd;
    double false_mean; /* bearings a look */
    enum passive_region region;
    bool has_unequal_intervals; /* 0.3 to 1.7 times the interval */
};

/* One run: what flies, and what the sensors see of it. */
struct passive_scene {
    const struct passive_setting *of;
    struct scenario_plan plan;
    struct simulation *simulation; /* its looks' times are not used */
    double times_s[PASSIVE_SCANS];
};

struct passive_scene passive_scene_draw(const struct passive_setting *of, struct random *random);
void passive_scene_free(struct passive_scene *scene);

/* A target at any time. */
struct truth_point passive_truth(const struct passive_scene *scene, size_t target, double t_s);

/* Half way between the first scan and the last. */
double passive_middle_s(const struct passive_scene *scene);

const struct simulated_look *passive_look(const struct passive_scene *scene, size_t scan,
                                          size_t sensor);

/* A frame with all that it points to. */
#define PASSIVE_LOOK_MAX 64
struct passive_frame {
    struct rho_frame frame;
    struct rho_bearing_scan scans[SCENARIO_SENSORS_MAX];
    struct rho_bearing bearings[SCENARIO_SENSORS_MAX][PASSIVE_LOOK_MAX];
    uint8_t fates[SCENARIO_SENSORS_MAX * PASSIVE_LOOK_MAX]; /* HELD */
};

/* What the sensors of the mask (bit 0: the first) see in a scan. */
void passive_frame_fill(struct passive_frame *frame, const struct passive_scene *scene, size_t scan,
                        unsigned sensors);
#define PASSIVE_ALL_SENSORS (~0u)

/* The line of a target's path, or of any. */
struct passive_line {
    double rho_m, theta_rad; /* 0 <= theta < pi */
};
struct passive_line passive_line_of(double x_m, double y_m, double vx_mps, double vy_mps);

/*
 * How far lines are from each other: |difference| of theta, and of rho with the sign that goes with
 * it.
 */
struct passive_line passive_line_off(const struct passive_line *a, const struct passive_line *b);

/* The base of a pair of sensors, and the ghost matrix of their bearings in one scan. */
struct rho_crossing_base passive_base(const struct passive_scene *scene, size_t a, size_t b);
struct rho_ghost_matrix passive_matrix(const struct passive_scene *scene, size_t scan, size_t a,
                                       size_t b, enum rho_ghost_rule rule);

/* Bearing i of sensor a and j of b are the same target's. */
bool passive_is_target(const struct passive_scene *scene, size_t scan, size_t a, size_t i, size_t b,
                       size_t j);

/* ---- pruning --------------------------------------------------------------------------------- */

/* Shares of the ghosts and of the targets' crossings. */
struct passive_pruned {
    double ghosts, targets;
};

struct passive_pruning_case {
    const char *name;
    struct passive_setting setting;
    struct passive_pruned reference[PASSIVE_RULES];
};
extern const struct passive_pruning_case passive_pruning_cases[];
extern const size_t passive_num_pruning_cases;

struct passive_pruning_run {
    size_t ghosts, targets; /* crossings of all scans */
    size_t ghosts_removed[PASSIVE_RULES], targets_lost[PASSIVE_RULES];
};
struct passive_pruning_run passive_pruning_run(const struct passive_pruning_case *of,
                                               struct random *random);

/* ---- the paper's method ---------------------------------------------------------------------- */

struct passive_found {
    double share;        /* of the targets */
    double ghosts_a_run; /* lines or tracks that are no target's */
    double exact;        /* share of the runs: all found, and no ghost */
};

struct passive_paper_case {
    const char *name;
    struct passive_setting setting;
    unsigned votes_min;
    bool has_rule[PASSIVE_RULES];
    struct passive_found reference[PASSIVE_RULES];
};
extern const struct passive_paper_case passive_paper_cases[];
extern const size_t passive_num_paper_cases;

/* Targets with a line within 6 degrees and 3 km of theirs, and lines with no such target. */
struct passive_matched {
    size_t found, ghosts;
};
struct passive_matched passive_lines_match(const struct rho_passive_paper *paper,
                                           const struct passive_scene *scene);

struct passive_paper_run {
    size_t targets;
    struct passive_matched by_rule[PASSIVE_RULES];
};
struct passive_paper_run passive_paper_run(const struct passive_paper_case *of,
                                           struct rho_passive_paper *paper, struct random *random);

/* A search of a scene with the mask's sensors: the lines are the paper's. */
void passive_paper_search(struct rho_passive_paper *paper, const struct passive_scene *scene,
                          unsigned sensors, unsigned votes_min, enum rho_ghost_rule rule);

/* ---- the default ----------------------------------------------------------------------------- */

struct passive_default_case {
    const char *name;
    struct passive_setting setting;
    struct passive_found reference;
    double reference_rms_m;
    double found_min, ghosts_max; /* bars; NAN: none */
    bool has_time_bar;
};
extern const struct passive_default_case passive_default_cases[];
extern const size_t passive_num_default_cases;

/* A found target: errors at mid-batch of the track, and of the fit that knows its bearings. */
struct passive_hit {
    double off_m, fit_off_m;
    struct passive_line line_off, fit_line_off;
    double nees; /* of the state at the newest scan */
    bool is_own; /* none of its bearings is false or another target's */
};

struct passive_default_run {
    size_t found, ghosts;
    struct passive_hit hits[PASSIVE_TARGETS_MAX]; /* `found` of them */
    double search_us;                             /* of the processor */
};
struct passive_default_run passive_default_run(const struct passive_default_case *of,
                                               struct rho_passive *passive, struct random *random);

#endif
