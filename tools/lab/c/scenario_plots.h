/* SPDX-License-Identifier: MIT */
/*
 * scenario_plots: the inputs of a simulation before random numbers are drawn: paths,
 * noise, misses, clutter. The named scenarios and the experiments' cases are plans.
 */
#ifndef RHOTRACK_TOOL_SCENARIO_TRUTH_TO_PLOTS_H
#define RHOTRACK_TOOL_SCENARIO_TRUTH_TO_PLOTS_H

#include "base/random.h"
#include "scenario_simulation.h"

struct scenario_plan {
    size_t num_scans, num_targets; /* num_targets: in each scan */
    size_t num_identities;         /* number of different targets over all scans */
    double interval_s;
    double sigma_m; /* noise that the tracker assumes */
    double noise_m; /* true standard deviation on each axis */
    double pd;
    double merge_m;                  /* two targets closer than this give one plot; 0: never */
    struct scenario_box box;         /* area of the clutter */
    double clutter_mean;             /* mean number of clutter plots a scan in the box */
    struct scenario_box spot;        /* area of additional clutter */
    double spot_mean;                /* mean number of clutter plots a scan in the spot; 0: none */
    struct scenario_passive passive; /* if used, bearings replace plots and clutter */
    struct truth_point *truth;       /* num_scans x num_targets, by time, then target */
};

/* Position and velocity of a target in the plane. */
struct scenario_state {
    double x_m, vx_mps, y_m, vy_mps;
};

/* Allocates the truth, with times and identities; P_D is 1, all else 0. End: plan_free. */
struct scenario_plan plan_allocate(size_t num_targets, size_t num_scans, double interval_s);
void plan_free(struct scenario_plan *plan);

struct truth_point *plan_truth(const struct scenario_plan *plan, size_t scan, size_t target);

/* Sets the true state of a target at a scan. */
void plan_set_truth(const struct scenario_plan *plan, size_t scan, size_t target,
                    struct scenario_state state);

/* The area of the parameters, and whether a place is in it. */
struct scenario_box plan_box_of_parameters(const struct parameters *parameters);
bool plan_box_holds(const struct scenario_box *box, double x_m, double y_m);
void plan_grow_clutter_box(struct scenario_plan *plan, const struct parameters *parameters);

/* The mean number of clutter plots a scan in the box, by the parameters. */
double plan_clutter_mean(const struct parameters *parameters, const struct scenario_box *box);

/* Sets the truth of a target at all scans: straight from `start` at constant velocity. */
void plan_set_straight_path(struct scenario_plan *plan, size_t target, struct scenario_state start);

/* Puts the plots of a scan in random order. */
void plan_shuffle_plots(struct simulated_scan *scan, struct random *random);

/* Appends clutter plots, uniform in the box, for which the scan must have room. */
void plan_add_clutter(struct simulated_scan *scan, const struct scenario_box *box, uint64_t count,
                      struct random *random);

/* Draws the plots or bearings of all scans: detections with noise and clutter, shuffled. */
struct simulation *plan_simulate(const struct scenario_plan *plan, struct random *random);

/* The plans of the named scenarios (scenario_paths.c). */
struct scenario_plan plan_crossing(const struct parameters *parameters, struct random *random);
struct scenario_plan plan_parallel(const struct parameters *parameters, struct random *random);
struct scenario_plan plan_pair_crossing_at_origin(const struct parameters *parameters,
                                                  struct random *random);
struct scenario_plan plan_formation(const struct parameters *parameters, struct random *random);
struct scenario_plan plan_traffic(const struct parameters *parameters, struct random *random);

/*
 * Numbers of sensors (at most SCENARIO_SENSORS_MAX) and targets, and the mean number of false
 * bearings per sensor and scan.
 */
struct scenario_bearings {
    size_t num_sensors, num_targets;
    double false_mean;
};

/*
 * Suggests parameters of a passive scenario (eight scans with misses), and simulates targets that
 * approach the origin and the bearings that sensors there measure (scenario_bearings.c).
 */
void suggest_passive_parameters(struct parameters *parameters);
struct simulation *simulate_passive(const struct scenario_bearings *of,
                                    const struct parameters *parameters, uint64_t seed,
                                    uint64_t run);

/* Simulates one look of each of the plan's passive sensors (scenario_bearings.c). */
void plan_simulate_looks(const struct scenario_plan *plan, size_t scan,
                         struct simulated_look *looks, struct random *random);

#endif
