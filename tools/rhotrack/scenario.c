/* SPDX-License-Identifier: MIT */
#include "scenario.h"

#include <math.h>
#include <string.h>

#include "common.h"
#include "scenario_plan.h"

/* ---- their names and customary parameters ----------------------------------------------------- */

/* What scenarios are customarily drawn with; several may share it. true_pd 0: what is assumed. */
struct customs {
    double num_scans, interval_s, sigma_m, true_pd, v_min_mps, v_max_mps, accel_max_mps2;
    struct scenario_box box;
    double clutter_per_km2; /* where positive, else: */
    double clutter_per_scan;
};

static const struct customs paper_targets = {.num_scans = 7,
                                             .interval_s = 2,
                                             .sigma_m = 10,
                                             .true_pd = 0.99,
                                             .v_min_mps = 100,
                                             .v_max_mps = 400,
                                             .accel_max_mps2 = 5,
                                             .box = {0, 4000, -1000, 1500},
                                             .clutter_per_km2 = 1};
static const struct customs pair = {.num_scans = 7,
                                    .interval_s = 2,
                                    .sigma_m = 10,
                                    .true_pd = 0.99,
                                    .v_min_mps = 100,
                                    .v_max_mps = 400,
                                    .accel_max_mps2 = 5,
                                    .box = {-2500, 2500, -2500, 2500},
                                    .clutter_per_km2 = 1};
static const struct customs wide_traffic = {.num_scans = 120,
                                            .interval_s = 10,
                                            .sigma_m = 50,
                                            .true_pd = 0.99,
                                            .v_min_mps = 50,
                                            .v_max_mps = 300,
                                            .accel_max_mps2 = 5,
                                            .box = {-250000, 250000, -250000, 250000},
                                            .clutter_per_scan = 950};
static const struct customs turning_radar = {.num_scans = 15,
                                             .interval_s = 4,
                                             .sigma_m = 100,
                                             .true_pd = 0.99,
                                             .v_min_mps = 100,
                                             .v_max_mps = 400,
                                             .accel_max_mps2 = 5,
                                             .box = {-65000, 65000, -65000, 65000},
                                             .clutter_per_scan = 100};
static const struct customs air_traffic = {.num_scans = 120,
                                           .interval_s = 10,
                                           .sigma_m = 50,
                                           .v_min_mps = 50,
                                           .v_max_mps = 300,
                                           .accel_max_mps2 = 6,
                                           .box = {-250000, 250000, -250000, 250000},
                                           .clutter_per_scan = 100};
static const struct customs formation = {.num_scans = 61,
                                         .interval_s = 10,
                                         .sigma_m = 50,
                                         .v_min_mps = 50,
                                         .v_max_mps = 300,
                                         .accel_max_mps2 = 6,
                                         .box = {-50000, 120000, -50000, 50000},
                                         .clutter_per_scan = 40};
static const struct customs two_radars = {.num_scans = 60,
                                          .interval_s = 10,
                                          .sigma_m = 50,
                                          .v_min_mps = 50,
                                          .v_max_mps = 300,
                                          .accel_max_mps2 = 6,
                                          .box = {-150000, 180000, -150000, 150000},
                                          .clutter_per_scan = 20};

static const struct scenario {
    const char *name, *text; /* no text: an experiment's own; simulate has a scene of that name */
    uint64_t stream;         /* of random numbers: its place when there were more */
    const struct customs *customs;
    struct scenario_plan (*plan)(const struct parameters *parameters, struct random *random);
    /* or, where that is NULL, what turning radars saw */
    struct simulation *(*simulate)(const struct parameters *parameters, struct random *random);
} scenarios[] = {
    {.name = "crossing", .stream = 0, .customs = &paper_targets, .plan = plan_crossing},
    {.name = "parallel", .stream = 2, .customs = &pair, .plan = plan_parallel},
    {.name = "crossing-angle", .stream = 3, .customs = &pair, .plan = plan_crossing_angle},
    {.name = "traffic", .stream = 7, .customs = &wide_traffic, .plan = plan_traffic},
    {.name = "polar",
     .stream = 8,
     .text = "a turning radar: straight targets at 20 to 60 km, plots in range and azimuth, each "
             "at its own time",
     .customs = &turning_radar,
     .plan = plan_polar},
    {.name = "air-traffic",
     .stream = 15,
     .text =
         "aircraft that take off, turn, hold, cross, land, come and go: always so many in the air",
     .customs = &air_traffic,
     .plan = plan_air_traffic},
    {.name = "formation", .stream = 16, .customs = &formation, .plan = plan_formation},
    {.name = "two-radars",
     .stream = 17,
     .text = "two turning radars with biases, and the aircraft that both see; a share of it "
             "arrives late",
     .customs = &two_radars,
     .simulate = simulate_two_radars},
    {.name = "rotating",
     .stream = 18,
     .text = "a turning radar by sectors: targets at 20 to 60 km, some of which turn gently",
     .customs = &turning_radar,
     .simulate = simulate_rotating},
    {.name = "doppler",
     .stream = 19,
     .text = "as polar, with range rates, ambiguous ones too, and clutter that stands still",
     .customs = &turning_radar,
     .plan = plan_doppler},
};

#define NUM_SCENARIOS (sizeof scenarios / sizeof scenarios[0])

static const struct scenario *offered(size_t index)
{
    for (size_t i = 0; i < NUM_SCENARIOS; i++) {
        if (scenarios[i].text && index-- == 0) {
            return &scenarios[i];
        }
    }
    return NULL;
}

const char *scenario_name(size_t index)
{
    return offered(index) ? offered(index)->name : NULL;
}

const char *scenario_text(size_t index)
{
    return offered(index) ? offered(index)->text : NULL;
}

static const struct scenario *find_scenario(const char *name)
{
    char list[512] = "";
    size_t length = 0;
    for (size_t i = 0; i < NUM_SCENARIOS && length < sizeof list; i++) {
        if (strcmp(scenarios[i].name, name) == 0) {
            return &scenarios[i];
        }
        length += (size_t)snprintf(list + length, sizeof list - length, "%s%s", i == 0 ? "" : ", ",
                                   scenarios[i].name);
    }
    fail(EXIT_USAGE, "no scenario `%s`; there are: %s", name, list);
}

static void suggest_area(struct parameters *parameters, const struct scenario_box *box)
{
    const enum parameter_id sides[] = {PARAMETER_AREA_X_MIN_M, PARAMETER_AREA_X_MAX_M,
                                       PARAMETER_AREA_Y_MIN_M, PARAMETER_AREA_Y_MAX_M};
    const double values[] = {box->x_min_m, box->x_max_m, box->y_min_m, box->y_max_m};
    for (int i = 0; i < 4; i++) {
        parameters_suggest(parameters, sides[i], values[i]);
    }
}

static bool is_radar(const struct scenario *scenario)
{
    return scenario->plan == plan_polar || scenario->plan == plan_doppler ||
           scenario->simulate == simulate_rotating;
}

/*
 * What a tracker is told of air traffic's motion: by GOSPA on its seed 3, as the process noise of the rivals that
 * `experiment air-traffic` compares with was chosen (tests/bench).
 */
static void suggest_motion(struct parameters *parameters)
{
    parameters_suggest(parameters, PARAMETER_STEADY_S, 60);
    parameters_suggest(parameters, PARAMETER_PROCESS_NOISE_MPS2, 2);
}

/* Nothing of it happens unless somebody wants it. */
static void suggest_sky(struct parameters *parameters)
{
    parameters_suggest(parameters, PARAMETER_FADES_PER_HOUR, 0);
    parameters_suggest(parameters, PARAMETER_FADE_SCANS, 3);
    parameters_suggest(parameters, PARAMETER_SPOTS, 0);
    parameters_suggest(parameters, PARAMETER_SPOT_CLUTTER, 0);
    parameters_suggest(parameters, PARAMETER_PERSISTENT_SOURCES, 0);
    parameters_suggest(parameters, PARAMETER_MERGE_M, 0);
}

void scenario_suggest(const char *name, struct parameters *parameters)
{
    const struct scenario *scenario = find_scenario(name);
    parameters_suggest(parameters, PARAMETER_NUM_SCANS, scenario->customs->num_scans);
    parameters_suggest(parameters, PARAMETER_INTERVAL_S, scenario->customs->interval_s);
    parameters_suggest(parameters, PARAMETER_SIGMA_M, scenario->customs->sigma_m);
    if (scenario->customs->true_pd > 0.0) {
        parameters_suggest(parameters, PARAMETER_TRUE_PD, scenario->customs->true_pd);
    }
    parameters_suggest(parameters, PARAMETER_V_MIN_MPS, scenario->customs->v_min_mps);
    parameters_suggest(parameters, PARAMETER_V_MAX_MPS, scenario->customs->v_max_mps);
    if (scenario->customs->accel_max_mps2 > 0.0) {
        parameters_suggest(parameters, PARAMETER_ACCEL_MAX_MPS2, scenario->customs->accel_max_mps2);
    }
    parameters_suggest(parameters, PARAMETER_TARGETS, is_radar(scenario) ? 3 : 50);
    parameters_suggest(parameters, PARAMETER_SPACING_M,
                       scenario->plan == plan_formation ? 400.0 : 50.0);
    suggest_area(parameters, &scenario->customs->box);
    if (is_radar(scenario)) {
        parameters_suggest(parameters, PARAMETER_RANGE_RATE, scenario->plan == plan_doppler);
        if (scenario->plan == plan_doppler) {
            parameters_suggest(parameters, PARAMETER_SIGMA_RANGE_M, 40);
            parameters_suggest(parameters, PARAMETER_SIGMA_AZIMUTH_RAD, 0.007);
        }
        suggest_radar(parameters, scenario->customs->box.x_max_m);
    }
    if (!(scenario->customs->true_pd > 0.0)) {
        parameters_suggest(parameters, PARAMETER_PD, 0.95);
    }
    if (scenario->simulate == simulate_two_radars) {
        suggest_two_radars(parameters);
    }
    if (scenario->plan == plan_air_traffic) {
        parameters_suggest(parameters, PARAMETER_CROSSING_SHARE, 0.2);
        suggest_motion(parameters);
    }
    if (scenario->plan == plan_formation) {
        parameters_suggest(parameters, PARAMETER_STEADY_S,
                           300); /* and the aircraft keep to a course */
    }
    suggest_sky(parameters);
    if (scenario->customs->clutter_per_km2 > 0.0) {
        parameters_suggest(parameters, PARAMETER_CLUTTER_PER_KM2,
                           scenario->customs->clutter_per_km2);
    } else {
        parameters_suggest(parameters, PARAMETER_CLUTTER_PER_SCAN,
                           scenario->customs->clutter_per_scan);
    }
}

bool scenario_is_known(const char *name)
{
    size_t i = 0;

    while (scenario_name(i) != NULL && strcmp(scenario_name(i), name) != 0) {
        i++;
    }
    return scenario_name(i) != NULL;
}

/* ---- one run ---------------------------------------------------------------------------------- */

static double value_or(const struct parameters *parameters, enum parameter_id id,
                       enum parameter_id otherwise)
{
    return parameters->value[parameters_is_set(parameters, id) ? id : otherwise];
}

/* Scenarios with a sky of their own, or where close targets are to give one plot. */
static void add_sky(struct scenario_plan *plan, const struct scenario *scenario,
                    const struct parameters *parameters, struct random *random)
{
    bool is_traffic = scenario->plan == plan_air_traffic;
    bool can_merge = scenario->plan == plan_parallel || scenario->plan == plan_crossing_angle ||
                     scenario->plan == plan_formation;

    if (!(scenario->customs->true_pd > 0.0)) {
        plan->told_pd = parameters->value[PARAMETER_PD];
    }
    if (is_traffic || (can_merge && parameters->value[PARAMETER_MERGE_M] > 0.0)) {
        plan_sky(plan, parameters, random);
    }
}

struct simulation *scenario_simulate(const char *name, const struct parameters *parameters,
                                     uint64_t seed, uint64_t run)
{
    const struct scenario *scenario = find_scenario(name);
    struct random random = random_start(seed, scenario->stream, run);
    if (scenario->simulate != NULL) {
        /* cppcheck-suppress returnDanglingLifetime ; what is returned has nothing of it */
        return scenario->simulate(parameters, &random);
    }
    struct scenario_plan plan = scenario->plan(parameters, &random);
    plan.pd = value_or(parameters, PARAMETER_TRUE_PD, PARAMETER_PD);
    plan.sigma_m = parameters->value[PARAMETER_SIGMA_M];
    plan.noise_m = value_or(parameters, PARAMETER_TRUE_SIGMA_M, PARAMETER_SIGMA_M);
    plan.box = plan_box_of(parameters);
    plan_grow_box(&plan, parameters);
    plan.clutter_mean = plan_clutter_mean(parameters, &plan.box);
    add_sky(&plan, scenario, parameters, &random);
    struct simulation *simulation = plan_simulate(&plan, &random);
    plan_free(&plan);
    return simulation;
}
