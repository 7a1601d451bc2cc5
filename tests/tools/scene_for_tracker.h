/* SPDX-License-Identifier: MIT */
/* What a tracker is given of a simulated scene, in memory: parameters, sensors and scans. */
#ifndef RHOTRACK_TESTS_SCENE_FOR_TRACKER_H
#define RHOTRACK_TESTS_SCENE_FOR_TRACKER_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "pipeline/pipeline.h"
#include "rhotrack/tracker.h"
#include "scene/scene.h"
#include "scene/scene_observe.h"

static inline void suggest_settings_of_scene(const struct scene *scene,
                                             struct parameters *parameters)
{
    char key[80], value[80], reason[PARAMETER_REASON_BYTES];

    for (const char *line = scene->settings; *line; line = strchr(line, '\n') + 1) {
        assert_int_equal(sscanf(line, "%79s = %79s", key, value), 2);
        assert_true(parameters_assign(parameters, key, value, SOURCE_METHOD, reason));
    }
}

static inline void suggest_parameters_of_radar(const struct scene_sensor *sensor,
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

/*
 * The defaults, changed by the settings that scenario.ini would give a tracker and, when the scene
 * has one sensor, by the values of that sensor.
 */
static inline struct parameters scene_parameters(const struct scene *scene)
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

/* A scan's time by its radar's clock, which includes the radar's time bias. */
static inline int64_t scene_scan_time_by_radar_clock_us(const struct scene_run *run,
                                                        const struct scene_scan *scan)
{
    return llround((scan->end_s + run->scene->sensors[scan->sensor].time_bias_s) * 1e6);
}

/* A radar as the scene tells it to a tracker, with biases of 0. */
static inline struct rho_sensor scene_sensor_without_biases(const struct scene_sensor *sensor)
{
    return (struct rho_sensor){.sensor_id = sensor->sensor_id,
                               .x_m = (float)sensor->told.x_m,
                               .y_m = (float)sensor->told.y_m,
                               .pd = (float)sensor->told.pd,
                               .range_min_m = (float)sensor->told.coverage.range_m.lo,
                               .range_max_m = (float)sensor->told.coverage.range_m.hi};
}

/*
 * Converts a scan of the scene for a tracker, as files have it, with the radar's known place; its
 * plots go into `plots`.
 */
static inline struct rho_scan scene_scan_for_tracker(const struct scene_run *run,
                                                     const struct scene_scan *scan,
                                                     const struct rho_sensor *known,
                                                     struct rho_plot *plots)
{
    const struct scene_sensor *sensor = &run->scene->sensors[scan->sensor];
    struct rho_scan out = {.time_us = scene_scan_time_by_radar_clock_us(run, scan),
                           .sensor_id = sensor->sensor_id,
                           .measures = sensor->has_range_rate ? RHO_MEASURES_RANGE_RATE : 0u,
                           .sector_from_rad = (float)scan->from_rad,
                           .sector_to_rad = (float)scan->to_rad,
                           .plots = plots};

    assert_in_range(scan->num_plots, 0, RHO_MAX_PLOTS);
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

        assert_int_equal(
            rho_measurement_from_polar(&polar, out.measures, known, &plots[out.num_plots++]),
            RHO_OK);
    }
    return out;
}

#endif
