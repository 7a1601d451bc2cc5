/* SPDX-License-Identifier: MIT */
/*
 * scenario_plan: what is to be simulated, before chance comes in: paths, noise, misses, clutter.
 *
 * The named scenarios and the experiments' cases are plans.
 */
#ifndef RHOTRACK_TOOL_SCENARIO_PLAN_H
#define RHOTRACK_TOOL_SCENARIO_PLAN_H

#include "base/random.h"
#include "scenario.h"

struct scenario_plan {
    size_t num_scans, num_targets; /* targets at a time */
    size_t num_identities;         /* over all scans; num_targets where none comes or goes */
    double interval_s;
    double sigma_m; /* as the tracker is told */
    double noise_m; /* that is added to the positions, each axis */
    double pd;
    double merge_m;                  /* two targets that are closer give one plot; 0: they do not */
    struct scenario_box box;         /* of the clutter */
    double clutter_mean;             /* plots a scan */
    struct scenario_box spot;        /* more clutter there */
    double spot_mean;                /* plots a scan; 0: none */
    struct scenario_passive passive; /* where it is used: its noise, its clutter */
    struct truth_point *truth;       /* num_scans x num_targets, by time, then target */
};

/* A state at the first scan. */
struct scenario_state {
    double x_m, vx_mps, y_m, vy_mps;
};

/* Room for the paths, times and identities set; the rest zero. */
struct scenario_plan plan_start(size_t num_targets, size_t num_scans, double interval_s);
void plan_free(struct scenario_plan *plan);

struct truth_point *plan_truth(const struct scenario_plan *plan, size_t scan, size_t target);

/* The state of a target at a scan. */
void plan_put(const struct scenario_plan *plan, size_t scan, size_t target,
              struct scenario_state state);

/* The area that the parameters say, and whether a place is in it. */
struct scenario_box plan_box_of(const struct parameters *parameters);
bool plan_box_holds(const struct scenario_box *box, double x_m, double y_m);
void plan_grow_box(struct scenario_plan *plan, const struct parameters *parameters);

/* Plots a scan, of that box. */
double plan_clutter_mean(const struct parameters *parameters, const struct scenario_box *box);

/* Straight at constant velocity. */
void plan_straight(struct scenario_plan *plan, size_t target, struct scenario_state start);

/* Puts the plots of a scan in random order. */
void plan_shuffle(struct simulated_scan *scan, struct random *random);

/* So many plots, uniform in the box. */
void plan_clutter(struct simulated_scan *scan, const struct scenario_box *box, uint64_t count,
                  struct random *random);

/* Plots by chance: detections with noise, clutter, shuffled in each scan. */
struct simulation *plan_simulate(const struct scenario_plan *plan, struct random *random);

/* The small scenarios, and traffic. scenario_paths.c */
struct scenario_plan plan_crossing(const struct parameters *parameters, struct random *random);
struct scenario_plan plan_parallel(const struct parameters *parameters, struct random *random);
struct scenario_plan plan_crossing_angle(const struct parameters *parameters,
                                         struct random *random);
struct scenario_plan plan_formation(const struct parameters *parameters, struct random *random);
struct scenario_plan plan_traffic(const struct parameters *parameters, struct random *random);

/*
 * How many, at most SCENARIO_SENSORS_MAX sensors, and the mean of false bearings a sensor and scan.
 */
struct scenario_bearings {
    size_t num_sensors, num_targets;
    double false_mean;
};

/*
 * Targets that come towards the origin, and what sensors there see: eight scans with misses, where
 * the parameters are those suggested. scenario_bearings.c
 */
void suggest_passive(struct parameters *parameters);
struct simulation *simulate_passive(const struct scenario_bearings *of,
                                    const struct parameters *parameters, uint64_t seed,
                                    uint64_t run);

/* What the plan's passive sensors see at scan `index`: a look a sensor. scenario_bearings.c */
void plan_look_of_sensors(const struct scenario_plan *plan, size_t index,
                          struct simulated_look *looks, struct random *random);

#endif
