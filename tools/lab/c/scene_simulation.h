/* SPDX-License-Identifier: MIT */
/*
 * scene_simulation: gives experiments the parameters and scans of a scene in memory, where the
 * command `simulate` writes them into files.
 */
#ifndef RHOTRACK_TOOL_SCENE_SIMULATION_H
#define RHOTRACK_TOOL_SCENE_SIMULATION_H

#include "rhotrack/tracker.h"
#include "scenario.h"
#include "scene/scene.h"
#include "scene/scene_observe.h"

/*
 * The defaults, changed by the settings that scenario.ini would give a tracker and, when the scene
 * has one sensor, by the values of that sensor.
 */
struct parameters scene_parameters(const struct scene *scene);

/*
 * Simulates a run of a scene with one radar, whose scan is a turn or a look at all directions at
 * once; a scan's time is its begin. Exit 1 where the number of targets changes between scans.
 */
struct simulation *scene_simulate_one_radar(const struct scene *scene, uint64_t seed,
                                            uint64_t run_number);

/* A scan's time by its radar's clock, which includes the radar's time bias. */
int64_t scene_scan_time_us(const struct scene_run *run, const struct scene_scan *scan);

/* A radar as the scene tells it to a tracker, with biases of 0. */
struct rho_sensor scene_sensor_without_biases(const struct scene_sensor *sensor);

/*
 * Converts a scan of the scene for a tracker, as files have it, with the radar's known place; its
 * plots go into `plots`. Exit 1 where there are more than RHO_MAX_PLOTS.
 */
struct rho_scan scene_scan_for_tracker(const struct scene_run *run, const struct scene_scan *scan,
                                       const struct rho_sensor *known, struct rho_plot *plots);

#endif
