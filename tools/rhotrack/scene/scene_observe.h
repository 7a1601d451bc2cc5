/* SPDX-License-Identifier: MIT */
/*
 * scene_observe: simulates the sensors of a scene in one run: scans with their plots, in the order
 * of arrival.
 *
 * Times are true times; a sensor's own clock is ahead of them by its time_bias_s.
 */
#ifndef RHOTRACK_TOOL_SCENE_OBSERVE_H
#define RHOTRACK_TOOL_SCENE_OBSERVE_H

#include "scene/scene.h"

struct scene_plot {
    size_t scan; /* number of the sensor's scan, from 0 */
    double t_s;
    double range_m, azimuth_rad,
        range_rate_mps;            /* measured values; of passive sensors only the azimuth */
    double elevation_rad;          /* measured value of passive sensors with sigma_elevation_rad */
    double x_m, y_m, z_m;          /* measured position, of Cartesian radars only */
    double vx_mps, vy_mps, vz_mps; /* measured velocity, where the radar measures it */
    int target_id;                 /* target of the plot; -1: clutter */
};

struct scene_scan {
    size_t sensor, number; /* index of the sensor, and number of its scan from 0 */
    double end_s, received_s;
    double from_rad, to_rad; /* sector as reported by the sensor; equal: full circle */
    size_t num_plots;
    const struct scene_plot *plots;
};

struct scene_run {
    const struct scene *scene;
    uint64_t seed, run;
    size_t num_paths;
    struct scene_path *paths; /* true paths; a target's id is its index */
    size_t num_scans;
    struct scene_scan *scans;
    struct scene_plot *plots[2 * SCENE_SENSORS_MAX];
};

struct scene_run *scene_observe(const struct scene *scene, uint64_t seed, uint64_t run);
void scene_run_free(struct scene_run *run);

/* Whether a place is in the coverage of any sensor; outages and masks are ignored. */
bool scene_covers_place(const struct scene *scene, double x_m, double y_m);

#endif
