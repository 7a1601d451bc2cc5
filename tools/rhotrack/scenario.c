/* SPDX-License-Identifier: MIT */
#include "scenario.h"

#include <math.h>
#include <string.h>

#include "common.h"
#include "scenario_plan.h"

#define DEG_RAD 0.017453292519943295

/* ---- their names and customary parameters ----------------------------------------------------- */

static const struct scenario {
    const char *name, *text;
    struct scenario_plan (*plan)(const struct parameters *parameters, struct random *random);
    /* or, where that is NULL, what turning radars saw */
    struct simulation *(*simulate)(const struct parameters *parameters, struct random *random);
    /* true_pd 0: what is assumed */
    double num_scans, interval_s, sigma_m, true_pd, v_min_mps, v_max_mps, accel_max_mps2;
    struct scenario_box box;
    double clutter_per_km2; /* where positive, else: */
    double clutter_per_scan;
} scenarios[] = {
    {"crossing",
     "three targets, two of which cross (the paper's Table 1)",
     plan_crossing,
     NULL,
     7,
     2,
     10,
     0.99,
     100,
     400,
     5,
     {0, 4000, -1000, 1500},
     1,
     0},
    {"radar",
     "the real plots of three aircraft (the paper's Table 3) in clutter",
     plan_radar,
     NULL,
     RADAR_TABLE_SCANS,
     RADAR_TABLE_INTERVAL_S,
     RADAR_TABLE_SIGMA_M,
     1.0,
     100,
     400,
     5,
     {-25000, -1000, 13000, 29000},
     0,
     100},
    {"parallel",
     "two targets side by side, spacing_m apart",
     plan_parallel,
     NULL,
     7,
     2,
     10,
     0.99,
     100,
     400,
     5,
     {-2500, 2500, -2500, 2500},
     1,
     0},
    {"crossing-angle",
     "two targets that meet at crossing_deg",
     plan_crossing_angle,
     NULL,
     7,
     2,
     10,
     0.99,
     100,
     400,
     5,
     {-2500, 2500, -2500, 2500},
     1,
     0},
    {"same-line",
     "two targets on one line, spacing_m apart, with speeds of their own",
     plan_same_line,
     NULL,
     7,
     2,
     10,
     0.99,
     100,
     400,
     5,
     {-2500, 2500, -2500, 2500},
     1,
     0},
    {"clutter",
     "no target at all",
     plan_clutter_alone,
     NULL,
     7,
     2,
     10,
     0.99,
     100,
     400,
     5,
     {0, 4000, -1000, 1500},
     10,
     0},
    {"slow-turn",
     "one target that turns by turn_deg a scan",
     plan_slow_turn,
     NULL,
     20,
     2,
     10,
     0.99,
     100,
     400,
     10,
     {-2500, 2500, -2500, 2500},
     1,
     0},
    {"traffic",
     "many straight targets in a large area",
     plan_traffic,
     NULL,
     120,
     10,
     50,
     0.99,
     50,
     300,
     5,
     {-250000, 250000, -250000, 250000},
     0,
     950},
    {"polar",
     "a turning radar: straight targets at 20 to 60 km, plots in range and azimuth, each at its "
     "own time",
     plan_polar,
     NULL,
     15,
     4,
     100,
     0.99,
     100,
     400,
     5,
     {-65000, 65000, -65000, 65000},
     0,
     100},
    {"passive-two",
     "two passive sensors: bearings of two targets that come towards them",
     plan_passive,
     NULL,
     8,
     10,
     10,
     1,
     150,
     350,
     5,
     {0, 80000, -55000, 55000},
     0,
     0},
    {"passive-three",
     "the same with a third sensor",
     plan_passive,
     NULL,
     8,
     10,
     10,
     1,
     150,
     350,
     5,
     {0, 80000, -55000, 55000},
     0,
     0},
    {"passive-clutter",
     "two passive sensors, four targets, misses and false bearings",
     plan_passive,
     NULL,
     8,
     10,
     10,
     0.9,
     150,
     350,
     5,
     {0, 80000, -55000, 55000},
     0,
     0},
    {"popup",
     "one target in a beam that pulls accel_g upwards, over, and level again",
     plan_popup,
     NULL,
     161,
     0.25,
     10,
     1,
     100,
     1000,
     0,
     {10000, 60000, 5000, 45000},
     0,
     4},
    {"weave",
     "the same to the sides",
     plan_weave,
     NULL,
     161,
     0.25,
     10,
     1,
     100,
     1000,
     0,
     {10000, 60000, 5000, 45000},
     0,
     4},
    {"hard-turn",
     "the same in level turns",
     plan_hard_turn,
     NULL,
     161,
     0.25,
     10,
     1,
     100,
     1000,
     0,
     {10000, 60000, 5000, 45000},
     0,
     4},
    {"air-traffic",
     "aircraft that take off, turn, hold, cross, land, come and go: always so many in the air",
     plan_air_traffic,
     NULL,
     120,
     10,
     50,
     0,
     50,
     300,
     6,
     {-250000, 250000, -250000, 250000},
     0,
     100},
    {"formation",
     "two aircraft that come together, fly side by side for half the time, and part",
     plan_formation,
     NULL,
     61,
     10,
     50,
     0,
     50,
     300,
     6,
     {-50000, 120000, -50000, 50000},
     0,
     40},
    {"two-radars",
     "two turning radars with biases, and the aircraft that both see; a share of it arrives late",
     NULL,
     simulate_two_radars,
     60,
     10,
     50,
     0,
     50,
     300,
     6,
     {-150000, 180000, -150000, 150000},
     0,
     20},
    {"rotating",
     "a turning radar by sectors: targets at 20 to 60 km, some of which turn gently",
     NULL,
     simulate_rotating,
     15,
     4,
     100,
     0.99,
     100,
     400,
     5,
     {-65000, 65000, -65000, 65000},
     0,
     100},
    {"doppler",
     "as polar, with range rates, ambiguous ones too, and clutter that stands still",
     plan_doppler,
     NULL,
     15,
     4,
     100,
     0.99,
     100,
     400,
     5,
     {-65000, 65000, -65000, 65000},
     0,
     100},
};

#define NUM_SCENARIOS (sizeof scenarios / sizeof scenarios[0])

const char *scenario_name(size_t index)
{
    return index < NUM_SCENARIOS ? scenarios[index].name : NULL;
}

const char *scenario_text(size_t index)
{
    return index < NUM_SCENARIOS ? scenarios[index].text : NULL;
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

/* Bearings instead of plots. */
static void suggest_passive(const char *name, struct parameters *parameters)
{
    bool has_clutter = strcmp(name, "passive-clutter") == 0;
    parameters_suggest(parameters, PARAMETER_SENSORS, strcmp(name, "passive-three") == 0 ? 3 : 2);
    parameters_suggest(parameters, PARAMETER_TARGETS, has_clutter ? 4 : 2);
    parameters_suggest(parameters, PARAMETER_FALSE_ALARMS, has_clutter ? 1 : 0);
    parameters_suggest(parameters, PARAMETER_SIGMA_RAD, 0.1 * DEG_RAD);
}

static bool is_beam(const struct scenario *scenario)
{
    return scenario->plan == plan_popup || scenario->plan == plan_weave ||
           scenario->plan == plan_hard_turn;
}

static bool is_radar(const struct scenario *scenario)
{
    return scenario->plan == plan_polar || scenario->plan == plan_doppler ||
           scenario->simulate == simulate_rotating;
}

static double spacing_of(const struct scenario *scenario)
{
    if (scenario->plan == plan_formation) {
        return 400.0;
    }
    return scenario->plan == plan_same_line ? 300.0 : 50.0;
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
    parameters_suggest(parameters, PARAMETER_NUM_SCANS, scenario->num_scans);
    parameters_suggest(parameters, PARAMETER_INTERVAL_S, scenario->interval_s);
    parameters_suggest(parameters, PARAMETER_SIGMA_M, scenario->sigma_m);
    if (scenario->true_pd > 0.0) {
        parameters_suggest(parameters, PARAMETER_TRUE_PD, scenario->true_pd);
    }
    parameters_suggest(parameters, PARAMETER_V_MIN_MPS, scenario->v_min_mps);
    parameters_suggest(parameters, PARAMETER_V_MAX_MPS, scenario->v_max_mps);
    if (scenario->accel_max_mps2 > 0.0) {
        parameters_suggest(parameters, PARAMETER_ACCEL_MAX_MPS2, scenario->accel_max_mps2);
    }
    parameters_suggest(parameters, PARAMETER_TARGETS, is_radar(scenario) ? 3 : 50);
    parameters_suggest(parameters, PARAMETER_SPEED_MPS, 250);
    parameters_suggest(parameters, PARAMETER_SECOND_SPEED_MPS, 250);
    parameters_suggest(parameters, PARAMETER_CROSSING_DEG, 10);
    parameters_suggest(parameters, PARAMETER_TURN_DEG, 2);
    parameters_suggest(parameters, PARAMETER_SPACING_M, spacing_of(scenario));
    suggest_area(parameters, &scenario->box);
    if (is_radar(scenario)) {
        parameters_suggest(parameters, PARAMETER_RANGE_RATE, scenario->plan == plan_doppler);
        if (scenario->plan == plan_doppler) {
            parameters_suggest(parameters, PARAMETER_SIGMA_RANGE_M, 40);
            parameters_suggest(parameters, PARAMETER_SIGMA_AZIMUTH_RAD, 0.007);
        }
        suggest_radar(parameters, scenario->box.x_max_m);
    }
    if (!(scenario->true_pd > 0.0)) {
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
    if (scenario->plan == plan_passive) {
        suggest_passive(name, parameters);
    }
    if (is_beam(scenario)) {
        suggest_beam(parameters);
    }
    if (scenario->clutter_per_km2 > 0.0) {
        parameters_suggest(parameters, PARAMETER_CLUTTER_PER_KM2, scenario->clutter_per_km2);
    } else {
        parameters_suggest(parameters, PARAMETER_CLUTTER_PER_SCAN, scenario->clutter_per_scan);
    }
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

    if (!(scenario->true_pd > 0.0)) {
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
    struct random random = random_start(seed, (uint64_t)(scenario - scenarios), run);
    if (scenario->simulate != NULL) {
        /* cppcheck-suppress returnDanglingLifetime ; what is returned has nothing of it */
        return scenario->simulate(parameters, &random);
    }
    struct scenario_plan plan = scenario->plan(parameters, &random);
    plan.pd = value_or(parameters, PARAMETER_TRUE_PD, PARAMETER_PD);
    plan.sigma_m = parameters->value[PARAMETER_SIGMA_M];
    /* real plots bring their own noise */
    plan.noise_m = scenario->plan == plan_radar
                       ? 0.0
                       : value_or(parameters, PARAMETER_TRUE_SIGMA_M, PARAMETER_SIGMA_M);
    plan.box = plan_box_of(parameters);
    plan_grow_box(&plan, parameters);
    plan.clutter_mean = plan_clutter_mean(parameters, &plan.box);
    add_sky(&plan, scenario, parameters, &random);
    struct simulation *simulation = plan_simulate(&plan, &random);
    plan_free(&plan);
    return simulation;
}
