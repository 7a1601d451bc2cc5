/* SPDX-License-Identifier: MIT */
#include "scene_simulation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/portable_math.h"
#include "pipeline/pipeline.h"

/* ---- parameters of a tracker ----------------------------------------------------------------- */

static void suggest_settings_of_scene(const struct scene *scene, struct parameters *parameters)
{
    char key[80], value[80], reason[PARAMETER_REASON_BYTES];

    for (const char *line = scene->settings; *line; line = strchr(line, '\n') + 1) {
        if (sscanf(line, "%79s = %79s", key, value) != 2 ||
            !parameters_assign(parameters, key, value, SOURCE_METHOD, reason)) {
            fail(EXIT_RUNTIME, "%s: setting %s", scene->name, key);
        }
    }
}

static void suggest_parameters_of_radar(const struct scene_sensor *sensor,
                                        struct parameters *parameters)
{
    const struct scene_stated *told = &sensor->told;

    parameters_suggest(parameters, PARAMETER_INTERVAL_S, sensor->turn_s);
    parameters_suggest(parameters, PARAMETER_PD, told->pd);
    if (sensor->is_cartesian) {
        parameters_suggest(parameters, PARAMETER_SIGMA_M, told->sigma_m);
        return;
    }
    parameters_suggest(parameters, PARAMETER_SIGMA_RANGE_M, told->sigma_range_m);
    parameters_suggest(parameters, PARAMETER_SIGMA_AZIMUTH_RAD, told->sigma_azimuth_rad);
    if (sensor->has_range_rate) {
        parameters_suggest(parameters, PARAMETER_SIGMA_RANGE_RATE_MPS, told->sigma_range_rate_mps);
    }
    parameters_suggest(parameters, PARAMETER_RANGE_MIN_M, told->coverage.range_m.lo);
    parameters_suggest(parameters, PARAMETER_RANGE_MAX_M, told->coverage.range_m.hi);
}

struct parameters scene_parameters(const struct scene *scene)
{
    struct parameters parameters;

    parameters_set_defaults(&parameters);
    suggest_settings_of_scene(scene, &parameters);
    for (int i = 0; scene->has_area && i < 4; i++) {
        parameters_suggest(&parameters, (enum parameter_id)(PARAMETER_AREA_X_MIN_M + i),
                           scene->area_m[i]);
    }
    if (scene->num_sensors == 1) {
        suggest_parameters_of_radar(&scene->sensors[0], &parameters);
    }
    return parameters;
}

/* ---- one radar's scans and the truth --------------------------------------------------------- */

static struct simulated_plot simulated_plot_of_scene(const struct scene_sensor *sensor,
                                                     const struct scene_plot *plot, double scan_s)
{
    if (sensor->is_cartesian) {
        return (struct simulated_plot){
            .x_m = plot->x_m, .y_m = plot->y_m, .target_id = plot->target_id};
    }
    return (struct simulated_plot){.x_m = plot->range_m * portable_cos(plot->azimuth_rad),
                                   .y_m = plot->range_m * portable_sin(plot->azimuth_rad),
                                   .target_id = plot->target_id,
                                   .offset_s = plot->t_s - scan_s,
                                   .range_m = plot->range_m,
                                   .azimuth_rad = plot->azimuth_rad,
                                   .range_rate_mps = plot->range_rate_mps};
}

static struct simulated_scan simulated_scan_of_scene(const struct scene_sensor *sensor,
                                                     const struct scene_scan *scan)
{
    struct simulated_scan out = {.t_s = scan->end_s - (sensor->turns ? sensor->turn_s : 0.0),
                                 .num_plots = scan->num_plots,
                                 .plots = must_calloc(scan->num_plots + 1, sizeof *out.plots)};

    for (size_t i = 0; i < scan->num_plots; i++) {
        out.plots[i] = simulated_plot_of_scene(sensor, &scan->plots[i], out.t_s);
    }
    return out;
}

static void add_truth_at_time(const struct scene_run *run, double t_s,
                              struct simulation *simulation, size_t *room)
{
    for (size_t i = 0; i < run->num_paths; i++) {
        if (t_s >= run->paths[i].from_s && t_s < run->paths[i].until_s) {
            struct motion at = path_motion_at(&run->paths[i], t_s);

            simulation->truth = must_make_room_for_one(simulation->truth, simulation->num_truth,
                                                       room, sizeof *simulation->truth);
            simulation->truth[simulation->num_truth++] = (struct truth_point){.t_s = t_s,
                                                                              .target_id = (int)i,
                                                                              .x_m = at.x_m,
                                                                              .y_m = at.y_m,
                                                                              .vx_mps = at.vx_mps,
                                                                              .vy_mps = at.vy_mps};
        }
    }
}

static struct scenario_radar scenario_radar_of_sensor(const struct scene_sensor *sensor)
{
    return (struct scenario_radar){.is_used = !sensor->is_cartesian,
                                   .has_range_rate = sensor->has_range_rate,
                                   .sigma_range_m = sensor->sigma_range_m,
                                   .sigma_azimuth_rad = sensor->sigma_azimuth_rad,
                                   .sigma_range_rate_mps = sensor->sigma_range_rate_mps,
                                   .range_min_m = sensor->coverage.range_m.lo,
                                   .range_max_m = sensor->coverage.range_m.hi};
}

struct simulation *scene_simulate_one_radar(const struct scene *scene, uint64_t seed,
                                            uint64_t run_number)
{
    const struct scene_sensor *sensor = &scene->sensors[0];
    struct scene_run *run = scene_observe(scene, seed, run_number);
    struct simulation *simulation = must_calloc(1, sizeof *simulation);
    size_t room = 0;

    *simulation = (struct simulation){
        .num_scans = run->num_scans,
        .num_targets = run->num_paths,
        .sigma_m = sensor->told.sigma_m,
        .area = {scene->area_m[0], scene->area_m[1], scene->area_m[2], scene->area_m[3]},
        .interval_s = sensor->turn_s,
        .radar = scenario_radar_of_sensor(sensor),
        .scans = must_calloc(run->num_scans + 1, sizeof *simulation->scans)};
    for (size_t i = 0; i < run->num_scans; i++) {
        simulation->scans[i] = simulated_scan_of_scene(sensor, &run->scans[i]);
        add_truth_at_time(run, simulation->scans[i].t_s, simulation, &room);
        simulation->targets_a_scan = i == 0 ? simulation->num_truth : simulation->targets_a_scan;
    }
    if (scene->num_sensors != 1 || sensor->sectors > 1 ||
        simulation->num_truth != simulation->num_scans * simulation->targets_a_scan) {
        fail(EXIT_RUNTIME, "%s: not one radar, or not always as many targets", scene->name);
    }
    scene_run_free(run);
    return simulation;
}

/* ---- scans for a tracker --------------------------------------------------------------------- */

int64_t scene_scan_time_us(const struct scene_run *run, const struct scene_scan *scan)
{
    return llround((scan->end_s + run->scene->sensors[scan->sensor].time_bias_s) * 1e6);
}

struct rho_sensor scene_sensor_without_biases(const struct scene_sensor *sensor)
{
    return (struct rho_sensor){.sensor_id = sensor->sensor_id,
                               .x_m = (float)sensor->told.x_m,
                               .y_m = (float)sensor->told.y_m,
                               .pd = (float)sensor->told.pd,
                               .range_min_m = (float)sensor->told.coverage.range_m.lo,
                               .range_max_m = (float)sensor->told.coverage.range_m.hi};
}

struct rho_scan scene_scan_for_tracker(const struct scene_run *run, const struct scene_scan *scan,
                                       const struct rho_sensor *known, struct rho_plot *plots)
{
    const struct scene_sensor *sensor = &run->scene->sensors[scan->sensor];
    struct rho_scan out = {.time_us = scene_scan_time_us(run, scan),
                           .sensor_id = sensor->sensor_id,
                           .measures = sensor->has_range_rate ? RHO_MEASURES_RANGE_RATE : 0u,
                           .sector_from_rad = (float)scan->from_rad,
                           .sector_to_rad = (float)scan->to_rad,
                           .plots = plots};

    if (scan->num_plots > RHO_MAX_PLOTS) {
        fail(EXIT_RUNTIME, "a scan of more than %d plots", RHO_MAX_PLOTS);
    }
    for (size_t i = 0; i < scan->num_plots; i++) {
        const struct scene_plot *plot = &scan->plots[i];
        int64_t time_us = llround((plot->t_s + sensor->time_bias_s) * 1e6);
        struct rho_polar_plot polar = {.offset_us = (int32_t)(time_us - out.time_us),
                                       .range_m = (float)plot->range_m,
                                       .azimuth_rad = (float)plot->azimuth_rad,
                                       .range_rate_mps = (float)plot->range_rate_mps,
                                       .sigma_range_m = (float)sensor->told.sigma_range_m,
                                       .sigma_azimuth_rad = (float)sensor->told.sigma_azimuth_rad,
                                       .sigma_range_rate_mps =
                                           (float)sensor->told.sigma_range_rate_mps};

        must_succeed(
            rho_measurement_from_polar(&polar, out.measures, known, &plots[out.num_plots++]),
            "rho_measurement_from_polar");
    }
    return out;
}
