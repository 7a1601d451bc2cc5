/* SPDX-License-Identifier: MIT */
/*
 * scene_observe: what the sensors of a scene see in one run: scans in the order of their arrival,
 * each with its plots.
 *
 * Times are the true ones; a sensor's own clock is its time_bias_s ahead.
 */
#ifndef RHOTRACK_TOOL_SCENE_OBSERVE_H
#define RHOTRACK_TOOL_SCENE_OBSERVE_H

#include "scene/scene.h"

struct scene_plot {
    size_t scan; /* of its sensor, from 0 on */
    double t_s;
    double range_m, azimuth_rad,
        range_rate_mps;            /* as measured; of passive sensors the azimuth alone */
    double x_m, y_m, z_m;          /* of radars with sigma_m, in their place */
    double vx_mps, vy_mps, vz_mps; /* where they measure them */
    int target_id;                 /* -1: clutter */
};

struct scene_scan {
    size_t sensor, number; /* the number from 0 on, of this sensor */
    double end_s, received_s;
    double from_rad, to_rad; /* as the sensor says them; equal: all round */
    size_t num_plots;
    const struct scene_plot *plots;
};

struct scene_run {
    const struct scene *scene;
    uint64_t seed, run;
    size_t num_paths;
    struct scene_path *paths; /* a target's identity is its index */
    size_t num_scans;
    struct scene_scan *scans;
    struct scene_plot *plots[2 * SCENE_SENSORS_MAX];
};

struct scene_run *scene_observe(const struct scene *scene, uint64_t seed, uint64_t run);
void scene_run_free(struct scene_run *run);

/* Whether some sensor could see what is there, were it not for events. */
bool scene_covers_place(const struct scene *scene, double x_m, double y_m);

#endif
