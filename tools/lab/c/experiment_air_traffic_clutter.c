/* SPDX-License-Identifier: MIT */
/*
 * experiment_air_traffic_clutter: scans without a target, in which every confirmed track is false.
 */
#include <math.h>

#include "base/common.h"
#include "base/random.h"
#include "experiment_air_traffic.h"
#include "lab_input.h"
#include "scene_simulation.h"

struct air_alarm_result air_alarm_run(const struct air_alarm *of, uint64_t seed, uint64_t run,
                                      struct pipeline *chain)
{
    const struct air_case like = {.sets = {NULL}};
    struct scene *scene = air_scene(&like);
    struct parameters parameters = scene_parameters(scene);
    struct random random = random_start(seed, (uint64_t)of->clutter, run);
    double interval_s = parameters.value[PARAMETER_INTERVAL_S];
    struct air_alarm_result result = {.scans = AIR_ALARM_SCANS,
                                      .hours = AIR_ALARM_SCANS * interval_s / 3600.0};

    scene_free(scene);
    parameters_suggest(&parameters, PARAMETER_FALSE_TRACKS_PER_HOUR, of->wanted_per_hour);
    pipeline_open(chain, &parameters);
    for (size_t i = 0; i < AIR_ALARM_SCANS; i++) {
        size_t count = lab_fill_clutter(chain, &parameters, of->clutter, &random);
        struct rho_scan scan = {.time_us = llround((double)i * interval_s * 1e6),
                                .num_plots = (uint32_t)count,
                                .plots = chain->plots};
        double start_us = air_clock_us();
        pipeline_step(chain, &scan);
        result.us += (air_clock_us() - start_us) / AIR_ALARM_SCANS;
        result.min_scans += chain->initiator->min_scans / (double)AIR_ALARM_SCANS;
    }
    result.confirmed = chain->tracker->counters.tracks_confirmed;
    return result;
}
