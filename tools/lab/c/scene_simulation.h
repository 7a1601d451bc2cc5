/* SPDX-License-Identifier: MIT */
/*
 * scene_simulation: scenes as experiments take them: parameters and scans in memory, what
 * `simulate` writes into files.
 */
#ifndef RHOTRACK_TOOL_SCENE_SIMULATION_H
#define RHOTRACK_TOOL_SCENE_SIMULATION_H

#include "rhotrack/tracker.h"
#include "scenario.h"
#include "scene/scene.h"
#include "scene/scene_observe.h"

/*
 * The defaults, and what scenario.ini would tell a tracker; of the sensor where there is one radar
 * alone.
 */
struct parameters scene_parameters(const struct scene *scene);

/*
 * A run of one radar that looks everywhere at once, or whose scan is a turn: times of scans are
 * where these begin. There are as many targets at each of them.
 */
struct simulation *scene_simulation(const struct scene *scene, uint64_t seed, uint64_t run);

/* A scan's time by its radar's clock. */
int64_t scene_scan_us(const struct scene_run *run, const struct scene_scan *scan);

/* A radar as a tracker may know it: its biases 0. */
struct rho_sensor scene_known_sensor(const struct scene_sensor *sensor);

/*
 * A scan of a radar, as files have it, by what is known of the radar: that many plots go into
 * `plots`. Exit 1 where these are more than RHO_MAX_PLOTS.
 */
struct rho_scan scene_scan(const struct scene_run *run, const struct scene_scan *scan,
                           const struct rho_sensor *known, struct rho_plot *plots);

#endif
