/* SPDX-License-Identifier: MIT */
/*
 * scenario_simulation: simulates targets, noise, misses and clutter for experiments in C, from a
 * name, parameters and a seed. The command `simulate` uses scenes (scene/scene.h) instead.
 *
 * Scenarios: crossing, parallel, crossing-angle, traffic, formation; the passive ones are in
 * scenario_plots.h. The same seed gives the same data on every machine.
 */
#ifndef RHOTRACK_TOOL_SCENARIO_SIMULATION_H
#define RHOTRACK_TOOL_SCENARIO_SIMULATION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "settings/parameters.h"

struct truth_point {
    double t_s;
    int target_id; /* 0, 1, ... */
    double x_m, y_m, vx_mps, vy_mps;
    double z_m, vz_mps; /* 0 except in files with heights */
};

struct simulated_plot {
    double x_m, y_m;
    int target_id; /* -1: clutter */
    /* 0 unless the radar rotates: the plot's time and the polar measurement */
    double offset_s; /* from the scan's time */
    double range_m, azimuth_rad, range_rate_mps;
};

/* A rotating radar in the origin; each turn is a scan. */
struct scenario_radar {
    bool is_used; /* false: plots are Cartesian */
    bool has_range_rate;
    double sigma_range_m, sigma_azimuth_rad, sigma_range_rate_mps;
    double range_min_m, range_max_m; /* of the clutter, uniform in range and azimuth */
};

#define SCENARIO_SENSORS_MAX 4

/* Passive sensors, which look in all directions at each scan's time. */
struct scenario_passive {
    bool is_used; /* false: the simulation has plots instead */
    size_t num_sensors;
    struct {
        double x_m, y_m;
    } sensors[SCENARIO_SENSORS_MAX];
    double sigma_rad;
    double false_mean; /* mean number per sensor and scan, uniform within pi/2 of +x */
};

struct simulated_bearing {
    double bearing_rad; /* -pi .. pi */
    int target_id;      /* -1: false */
};

/* One look of one passive sensor; its bearings are in random order. */
struct simulated_look {
    double t_s;
    size_t sensor; /* index in passive.sensors; the sensor_id is one more */
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
    /* num_truth / num_scans; less than num_targets where targets appear or disappear */
    size_t targets_a_scan;
    double sigma_m;           /* noise that a tracker should assume */
    struct scenario_box area; /* area of the clutter */
    double interval_s;
    struct scenario_radar radar;
    struct scenario_passive passive;
    struct simulated_scan *scans; /* without plots if passive.is_used */
    struct simulated_look *looks; /* num_looks = num_scans x passive.num_sensors: by time, sensor */
    struct truth_point *truth;    /* by time, then target */
};

/*
 * Suggests the scenario's customary parameters, which --set overrides. An unknown name ends the
 * program with exit code 2 and the list of names.
 */
void scenario_suggest_parameters(const char *name, struct parameters *parameters);

/* Simulates one run; its data depend on seed and run only. End: simulation_free. */
struct simulation *scenario_simulate(const char *name, const struct parameters *parameters,
                                     uint64_t seed, uint64_t run);
void simulation_free(struct simulation *simulation);

#endif
