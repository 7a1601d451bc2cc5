/* SPDX-License-Identifier: MIT */
#include "scenario_simulation.h"

#include <math.h>
#include <string.h>

#include "base/common.h"
#include "scenario_plots.h"

/* ---- names and customary parameters of scenarios --------------------------------------------- */

/*
 * Customary values of the parameters of a scenario; several scenarios may share them. true_pd 0:
 * targets are detected with the P_D that the tracker assumes, 0.95.
 */
struct customs {
    double num_scans, interval_s, sigma_m, true_pd, v_min_mps, v_max_mps, accel_max_mps2;
    struct scenario_box box;
    double clutter_per_km2;
    double clutter_per_scan; /* used where clutter_per_km2 is 0 */
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
static const struct customs formation = {.num_scans = 61,
                                         .interval_s = 10,
                                         .sigma_m = 50,
                                         .v_min_mps = 50,
                                         .v_max_mps = 300,
                                         .accel_max_mps2 = 6,
                                         .box = {-50000, 120000, -50000, 50000},
                                         .clutter_per_scan = 40};

static const struct scenario {
    const char *name;
    uint64_t stream; /* of random numbers; fixed, so that data stay the same */
    const struct customs *customs;
    struct scenario_plan (*plan)(const struct parameters *parameters, struct random *random);
} scenarios[] = {
    {.name = "crossing", .stream = 0, .customs = &paper_targets, .plan = plan_crossing},
    {.name = "parallel", .stream = 2, .customs = &pair, .plan = plan_parallel},
    {.name = "crossing-angle", .stream = 3, .customs = &pair, .plan = plan_pair_crossing_at_origin},
    {.name = "traffic", .stream = 7, .customs = &wide_traffic, .plan = plan_traffic},
    {.name = "formation", .stream = 16, .customs = &formation, .plan = plan_formation},
};

#define NUM_SCENARIOS (sizeof scenarios / sizeof scenarios[0])

static const struct scenario *must_find_scenario(const char *name)
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

void scenario_suggest_parameters(const char *name, struct parameters *parameters)
{
    const struct scenario *scenario = must_find_scenario(name);
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
    parameters_suggest(parameters, PARAMETER_TARGETS, 50);
    parameters_suggest(parameters, PARAMETER_SPACING_M,
                       scenario->plan == plan_formation ? 400.0 : 50.0);
    suggest_area(parameters, &scenario->customs->box);
    if (!(scenario->customs->true_pd > 0.0)) {
        parameters_suggest(parameters, PARAMETER_PD, 0.95);
    }
    if (scenario->plan == plan_formation) {
        parameters_suggest(parameters, PARAMETER_STEADY_S,
                           300); /* aircraft fly straight between turns */
    }
    parameters_suggest(parameters, PARAMETER_MERGE_M, 0);
    if (scenario->customs->clutter_per_km2 > 0.0) {
        parameters_suggest(parameters, PARAMETER_CLUTTER_PER_KM2,
                           scenario->customs->clutter_per_km2);
    } else {
        parameters_suggest(parameters, PARAMETER_CLUTTER_PER_SCAN,
                           scenario->customs->clutter_per_scan);
    }
}

/* ---- one run --------------------------------------------------------------------------------- */

struct simulation *scenario_simulate(const char *name, const struct parameters *parameters,
                                     uint64_t seed, uint64_t run)
{
    const struct scenario *scenario = must_find_scenario(name);
    struct random random = random_start(seed, scenario->stream, run);
    struct scenario_plan plan = scenario->plan(parameters, &random);
    enum parameter_id pd =
        parameters_has_value(parameters, PARAMETER_TRUE_PD) ? PARAMETER_TRUE_PD : PARAMETER_PD;

    plan.pd = parameters->value[pd];
    plan.sigma_m = plan.noise_m = parameters->value[PARAMETER_SIGMA_M];
    plan.merge_m = parameters->value[PARAMETER_MERGE_M];
    plan.box = plan_box_of_parameters(parameters);
    plan_grow_clutter_box(&plan, parameters);
    plan.clutter_mean = plan_clutter_mean(parameters, &plan.box);
    struct simulation *simulation = plan_simulate(&plan, &random);
    plan_free(&plan);
    return simulation;
}
