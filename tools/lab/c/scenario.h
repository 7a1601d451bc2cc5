/* SPDX-License-Identifier: MIT */
/*
 * scenario: targets, noise, misses and clutter of experiments in C, from a name, parameters and a
 * seed. What `simulate` offers are scenes (scene/scene.h).
 *
 * Scenarios: crossing, parallel, crossing-angle, traffic, formation; the passive ones are in
 * scenario_plan.h. The same seed gives the same data on every machine.
 */
#ifndef RHOTRACK_TOOL_SCENARIO_H
#define RHOTRACK_TOOL_SCENARIO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "settings/parameters.h"

struct truth_point {
    double t_s;
    int target_id; /* 0, 1, ... */
    double x_m, y_m, vx_mps, vy_mps;
    double z_m, vz_mps; /* 0 but in files that have heights */
};

struct simulated_plot {
    double x_m, y_m;
    int target_id; /* -1: clutter */
    /* of a rotating radar, else 0: when the antenna looked there, and what it measured */
    double offset_s; /* after the scan's time */
    double range_m, azimuth_rad, range_rate_mps;
};

/* A radar in the origin that turns, a scan a turn. */
struct scenario_radar {
    bool is_used; /* else plots are Cartesian */
    bool has_range_rate;
    double sigma_range_m, sigma_azimuth_rad, sigma_range_rate_mps;
    double range_min_m, range_max_m; /* of the clutter, which is uniform in range and azimuth */
};

#define SCENARIO_SENSORS_MAX 4

/* Passive sensors, which look all round at each scan's time. */
struct scenario_passive {
    bool is_used; /* else there are plots */
    size_t num_sensors;
    struct {
        double x_m, y_m;
    } sensors[SCENARIO_SENSORS_MAX];
    double sigma_rad;
    double false_mean; /* false bearings a sensor and scan, uniform within pi/2 of +x */
};

struct simulated_bearing {
    double bearing_rad; /* -pi .. pi */
    int target_id;      /* -1: false */
};

/* One look of one passive sensor, in random order. */
struct simulated_look {
    double t_s;
    size_t sensor; /* index of passive.sensors; its number in files is one more */
    size_t num_bearings;
    struct simulated_bearing *bearings;
};

struct simulated_scan {
    double t_s;
    size_t num_plots;
    struct simulated_plot *plots;
};

struct scenario_box {
    double x_min_m, x_max_m, y_min_m, y_max_m;
};

struct simulation {
    size_t num_scans, num_targets, num_truth, num_looks;
    /* num_truth = num_scans x targets_a_scan; less than num_targets where they come and go */
    size_t targets_a_scan;
    double sigma_m;           /* noise that a tracker should reckon with */
    struct scenario_box area; /* clutter is spread over it */
    double interval_s;
    struct scenario_radar radar;
    struct scenario_passive passive;
    struct simulated_scan *scans; /* without plots where passive is used */
    struct simulated_look *looks; /* num_looks = num_scans x passive.num_sensors: by time, sensor */
    struct truth_point *truth;    /* by time, then target */
};

/*
 * The scenario's customary parameters (suggested, so that --set wins). Unknown name: exit 2 with
 * the list.
 */
void scenario_suggest(const char *name, struct parameters *parameters);

/* One run: the data of (seed, run), the same whatever other runs are made. */
struct simulation *scenario_simulate(const char *name, const struct parameters *parameters,
                                     uint64_t seed, uint64_t run);
void simulation_free(struct simulation *simulation);

#endif
