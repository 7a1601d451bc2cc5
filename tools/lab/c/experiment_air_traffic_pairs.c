/* SPDX-License-Identifier: MIT */
/*
 * experiment_air_traffic_pairs: two aircraft that cross, or fly side by side: who is who
 * afterwards?
 */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_air_traffic.h"

/*
 * At the end of a run, without a track: fewer scans are a target that was missed, and is in doubt.
 */
#define LOST_SCANS 4

static struct parameters parameters_of(const struct air_pair *of)
{
    struct parameters parameters;

    parameters_default(&parameters);
    scenario_suggest("formation", &parameters);
    /* as dense on its area as 1000 plots on that of air-traffic */
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_SCAN, 68);
    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, of->num_scans);
    parameters_suggest(&parameters, PARAMETER_SPACING_M, fmax(1.0, of->spacing_m));
    parameters_suggest(&parameters, PARAMETER_MERGE_M, of->merge_m);
    return parameters;
}

/* A scan at which they are apart; true where both have a track. */
static bool evaluate_scan(struct evaluation *evaluation, const struct simulation *simulation,
                          size_t scan, const struct air_points *tracks, double apart_m,
                          struct air_points *truth)
{
    size_t times = 0;

    air_points_truth(truth, simulation, scan);
    if (hypot(truth->points[0].x_m - truth->points[1].x_m,
              truth->points[0].y_m - truth->points[1].y_m) < apart_m) {
        return false;
    }
    evaluation_time(evaluation, llround(simulation->scans[scan].t_s * 1e6), truth->points,
                    truth->count, tracks->points, tracks->count);
    const struct evaluation_scan *over_time = evaluation_over_time(evaluation, &times);
    return over_time[times - 1].pairs == 2;
}

struct air_pair_result air_pair_run(const struct air_pair *of, uint64_t seed, uint64_t run,
                                    struct pipeline *chain)
{
    struct parameters parameters = parameters_of(of);
    struct simulation *simulation = scenario_simulate(of->scenario, &parameters, seed, run);
    struct evaluation *evaluation = evaluation_start(air_cutoffs_m[0]);
    struct air_points tracks = {0}, truth = {0};
    size_t without = 0; /* scans since both had a track */

    pipeline_open(chain, &parameters);
    for (size_t i = 0; i < simulation->num_scans; i++) {
        struct rho_scan scan = air_scan(simulation, i, chain);
        pipeline_step(chain, &scan);
        tracks.count = 0;
        air_points_add(&tracks, chain->report, 0);
        without = evaluate_scan(evaluation, simulation, i, &tracks, of->apart_m, &truth)
                      ? 0
                      : without + 1;
    }
    struct evaluation_result result = evaluation_result(evaluation);
    evaluation_free(evaluation);
    free(tracks.points);
    free(truth.points);
    simulation_free(simulation);
    return (struct air_pair_result){.kept = result.switches == 0,
                                    .lost = without >= LOST_SCANS,
                                    .switches = (double)result.switches,
                                    .completeness = result.completeness};
}
