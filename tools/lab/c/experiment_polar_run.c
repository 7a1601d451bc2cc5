/* SPDX-License-Identifier: MIT */
/*
 * experiment_polar_run: one case of one run: a batch search of the first turns, and the tracker
 * over all.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "clairvoyant_polar.h"
#include "experiment_polar.h"
#include "scene_simulation.h"

#define MIN_SCANS 5
#define SCORE_MIN_NAT 0.0
#define PD 0.99 /* assumed, and true */
#define TOLERANCE_M                                                                                \
    500.0 /* a candidate within is the target's: a plot's error is up to 180 m across */

const double polar_clutter[POLAR_LEVELS] = {100.0, 1000.0};

const struct polar_case polar_cases[POLAR_CASES] = {
    {"own covariance", false, false, 0.0},
    {"one isotropic sigma", true, false, 0.0},
    {"own covariance, range rate", false, true, 0.0},
    {"one isotropic sigma, range rate", true, true, 0.0},
};

struct simulation *polar_simulation(double clutter, double pd, uint64_t seed, uint64_t run,
                                    struct parameters *parameters)
{
    char plots[40], detected[40];
    const char *sets[] = {"radars.0.sigma_range_rate_mps=1", plots, detected};
    struct scene *scene;
    struct simulation *simulation;

    snprintf(plots, sizeof plots, "clutter.0.plots=%g", clutter);
    snprintf(detected, sizeof detected, "radars.0.pd=%g", pd);
    scene = scene_find("polar", sets, pd > 0.0 ? 3 : 2);
    *parameters = scene_parameters(scene);
    parameters_suggest(parameters, PARAMETER_CLUTTER_PER_SCAN, clutter);
    simulation = scene_simulation(scene, seed, run);
    scene_free(scene);
    return simulation;
}

/* ---- the data -------------------------------------------------------------------------------- */

struct truth_point polar_truth(const struct simulation *simulation, size_t target, double t_s)
{
    struct truth_point truth =
        simulation->truth[target]; /* at the first turn; paths are straight */
    truth.x_m += truth.vx_mps * (t_s - truth.t_s);
    truth.y_m += truth.vy_mps * (t_s - truth.t_s);
    truth.t_s = t_s;
    return truth;
}

/* What is measured of a range rate where it is ambiguous. */
static double told_mps(const struct polar_case *of, double rate_mps)
{
    return of->span_mps > 0.0 ? remainder(rate_mps, of->span_mps) : rate_mps;
}

struct rho_sensor polar_sensor(const struct polar_case *of, const struct parameters *parameters)
{
    struct rho_sensor sensor;
    parameters_to_any_sensor(parameters, 0, &sensor);
    sensor.range_rate_span_mps = (float)of->span_mps;
    return sensor;
}

static void convert(const struct polar_case *of, const struct scenario_radar *radar,
                    const struct simulated_plot *from, struct rho_plot *plot)
{
    struct rho_polar_plot polar = {
        .offset_us = (int32_t)lround(from->offset_s * 1e6),
        .range_m = (float)from->range_m,
        .azimuth_rad = (float)from->azimuth_rad,
        .range_rate_mps = (float)told_mps(of, from->range_rate_mps),
        .sigma_range_m = (float)radar->sigma_range_m,
        .sigma_azimuth_rad = (float)radar->sigma_azimuth_rad,
        .sigma_range_rate_mps = (float)radar->sigma_range_rate_mps,
    };
    must_succeed(rho_measurement_from_polar(
                     &polar, of->has_range_rate ? RHO_MEASURES_RANGE_RATE : 0u, NULL, plot),
                 "rho_measurement_from_polar");
    if (of->is_isotropic) {
        plot->sigma_range_m = plot->sigma_cross_m = rho_plot_sigma_m(plot);
    }
}

struct rho_scan polar_scan(const struct polar_case *of, const struct simulation *simulation,
                           size_t turn, struct rho_plot *plots)
{
    const struct simulated_scan *from = &simulation->scans[turn];
    for (size_t i = 0; i < from->num_plots; i++) {
        convert(of, &simulation->radar, &from->plots[i], &plots[i]);
    }
    return (struct rho_scan){.time_us = llround(from->t_s * 1e6),
                             .measures = of->has_range_rate ? RHO_MEASURES_RANGE_RATE : 0u,
                             .num_plots = (uint32_t)from->num_plots,
                             .plots = plots};
}

/* ---- initiation ------------------------------------------------------------------------------ */

static struct rho_initiator_config batch_config(const struct simulation *simulation,
                                                const struct parameters *parameters)
{
    struct rho_initiator_config config;
    parameters_to_initiator(parameters, &config);
    config.scans = POLAR_WINDOW;
    config.min_scans = MIN_SCANS;
    config.score_min_nat = (float)SCORE_MIN_NAT;
    config.pd = (float)PD;
    config.area_is_fixed = 1;
    config.area =
        (struct rho_extent){(float)simulation->area.x_min_m, (float)simulation->area.x_max_m,
                            (float)simulation->area.y_min_m, (float)simulation->area.y_max_m};
    return config;
}

double polar_search(const struct polar_case *of, const struct parameters *parameters,
                    const struct simulation *simulation, struct pipeline *chain)
{
    struct rho_initiator_config config = batch_config(simulation, parameters);
    uint8_t *fates = must_calloc(RHO_MAX_PLOTS, 1);
    uint32_t unused = 0;
    struct rho_sensor sensor = polar_sensor(of, parameters);
    sensor.pd = (float)PD;
    must_succeed(rho_initiator_init(chain->initiator, sizeof *chain->initiator, &config),
                 "initiator");
    for (size_t turn = 0; turn < POLAR_WINDOW; turn++) {
        struct rho_scan scan = polar_scan(of, simulation, turn, chain->plots);
        memset(fates, RHO_FATE_HELD, RHO_MAX_PLOTS);
        must_succeed(rho_initiator_push(chain->initiator, &scan,
                                        of->span_mps > 0.0 ? &sensor : NULL, fates, &unused),
                     "push");
    }
    free(fates);
    int64_t start_us = clock_us();
    must_succeed(rho_initiator_search(chain->initiator, RHO_SEARCH_BATCH), "search");
    return (double)(clock_us() - start_us);
}

/* Mean distance over the window between a candidate and a target. */
static double candidate_error_m(const struct simulation *simulation, size_t target,
                                const struct rho_candidate *candidate)
{
    double newest_s = simulation->interval_s * (POLAR_WINDOW - 1), sum_m = 0.0;
    for (size_t turn = 0; turn < POLAR_WINDOW; turn++) {
        double t_s = simulation->interval_s * (double)turn;
        struct truth_point truth = polar_truth(simulation, target, t_s);
        sum_m += hypot(candidate->x_m + candidate->vx_mps * (t_s - newest_s) - truth.x_m,
                       candidate->y_m + candidate->vy_mps * (t_s - newest_s) - truth.y_m);
    }
    return sum_m / POLAR_WINDOW;
}

/*
 * Targets are tens of kilometres apart: the nearest candidate within the tolerance is the target's.
 */
static void match(const struct simulation *simulation, const struct rho_initiator *initiator,
                  struct polar_result *result)
{
    for (size_t target = 0; target < simulation->num_targets; target++) {
        double best_m = TOLERANCE_M;
        bool is_found = false;
        for (unsigned i = 0; i < initiator->num_candidates; i++) {
            double error_m = candidate_error_m(simulation, target, &initiator->candidates[i]);
            if (error_m <= best_m) {
                best_m = error_m;
                is_found = true;
            }
        }
        result->found += is_found;
        result->found_m += is_found ? best_m : 0.0;
    }
    result->false_candidates = initiator->num_candidates - result->found;
}

/* One a turn: a target at the turn's border may be seen twice. */
static size_t plots_of(const struct simulation *simulation, int target,
                       double times_s[POLAR_WINDOW], struct simulated_plot plots[POLAR_WINDOW])
{
    size_t count = 0;
    for (size_t turn = 0; turn < POLAR_WINDOW; turn++) {
        const struct simulated_scan *scan = &simulation->scans[turn];
        for (size_t i = 0; i < scan->num_plots; i++) {
            if (scan->plots[i].target_id == target) {
                times_s[count] = scan->t_s + scan->plots[i].offset_s;
                plots[count++] = scan->plots[i];
                break;
            }
        }
    }
    return count;
}

static int clairvoyant_found(const struct polar_case *of, const struct parameters *parameters,
                             const struct simulation *simulation)
{
    const struct scenario_box *box = &simulation->area;
    struct clairvoyant_model model = {.num_scans = POLAR_WINDOW,
                                      .pd = PD,
                                      .area_m2 = (box->x_max_m - box->x_min_m) *
                                                 (box->y_max_m - box->y_min_m),
                                      .v_min_mps = parameters->value[PARAMETER_V_MIN_MPS],
                                      .v_max_mps = parameters->value[PARAMETER_V_MAX_MPS]};
    struct clairvoyant_polar polar = {.model = &model,
                                      .radar = &simulation->radar,
                                      .has_range_rate = of->has_range_rate,
                                      .clutter_mean =
                                          parameters->value[PARAMETER_CLUTTER_PER_SCAN]};
    int found = 0;
    for (size_t target = 0; target < simulation->num_targets; target++) {
        double times_s[POLAR_WINDOW];
        struct simulated_plot plots[POLAR_WINDOW];
        size_t count = plots_of(simulation, (int)target, times_s, plots);
        if (count < MIN_SCANS) {
            continue;
        }
        struct clairvoyant_fit fit = clairvoyant_polar_fit(&polar, times_s, plots, count);
        double speed_mps = hypot(fit.vx_mps, fit.vy_mps);
        found += fit.score_nat >= SCORE_MIN_NAT && speed_mps >= model.v_min_mps &&
                 speed_mps <= model.v_max_mps;
    }
    return found;
}

/* ---- all of it ------------------------------------------------------------------------------- */

struct polar_result polar_run(const struct polar_case *of, const struct parameters *parameters,
                              const struct simulation *simulation, struct pipeline *chain)
{
    struct polar_result result = {.targets = (int)simulation->num_targets};
    result.search_us = polar_search(of, parameters, simulation, chain);
    match(simulation, chain->initiator, &result);
    result.clairvoyant = clairvoyant_found(of, parameters, simulation);
    polar_track(of, parameters, simulation, chain, &result);
    return result;
}
