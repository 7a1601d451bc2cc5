/* SPDX-License-Identifier: MIT */
/*
 * scenario_bearings: targets that approach passive sensors around the origin, and the bearings that
 * these sensors measure.
 */
#include <math.h>

#include "base/common.h"
#include "scenario_plots.h"

#define PI 3.141592653589793
#define START_FAR_M 78000.0
#define END_X_MIN_M 2000.0
#define STREAM 11 /* of random numbers; no scenario in scenario_simulation.c has this one */

static const struct scenario_box starts = {
    .x_min_m = 20000.0, .x_max_m = 75000.0, .y_min_m = -50000.0, .y_max_m = 50000.0};

static const double places_m[SCENARIO_SENSORS_MAX][2] = {
    {0, -10000}, {0, 10000}, {10000, 0}, {-10000, 0}};

/* ---- targets --------------------------------------------------------------------------------- */

/* A random place and speed, with a heading within 45 degrees of the direction to the origin. */
static struct scenario_state draw_inbound_state(const struct parameters *parameters,
                                                struct random *random)
{
    double x_m = random_between(random, starts.x_min_m, starts.x_max_m);
    double y_m = random_between(random, starts.y_min_m, starts.y_max_m);
    double heading_rad = atan2(-y_m, -x_m) + random_between(random, -PI / 4.0, PI / 4.0);
    double speed_mps = random_between(random, parameters->value[PARAMETER_V_MIN_MPS],
                                      parameters->value[PARAMETER_V_MAX_MPS]);
    return (struct scenario_state){.x_m = x_m,
                                   .vx_mps = speed_mps * cos(heading_rad),
                                   .y_m = y_m,
                                   .vy_mps = speed_mps * sin(heading_rad)};
}

/* Draws until a target starts near enough and does not reach the sensors; exit 2 if none does. */
static struct scenario_state draw_approaching_target(const struct parameters *parameters,
                                                     double duration_s, struct random *random)
{
    for (int i = 0; i < 10000; i++) {
        struct scenario_state state = draw_inbound_state(parameters, random);
        if (hypot(state.x_m, state.y_m) <= START_FAR_M &&
            state.x_m + state.vx_mps * duration_s >= END_X_MIN_M) {
            return state;
        }
    }
    fail(EXIT_USAGE, "scenario passive: every target reaches the sensors before the run ends; "
                     "take fewer scans or slower targets");
}

static struct scenario_plan plan_passive(const struct scenario_bearings *of,
                                         const struct parameters *parameters, struct random *random)
{
    const double *value = parameters->value;
    struct scenario_plan plan = plan_allocate(
        of->num_targets, (size_t)(value[PARAMETER_NUM_SCANS] + 0.5), value[PARAMETER_INTERVAL_S]);
    double duration_s = plan.interval_s * ((double)plan.num_scans - 1.0);
    for (size_t target = 0; target < plan.num_targets; target++) {
        plan_set_straight_path(&plan, target,
                               draw_approaching_target(parameters, duration_s, random));
    }
    plan.passive = (struct scenario_passive){
        .is_used = true,
        .num_sensors = of->num_sensors,
        .sigma_rad = value[PARAMETER_SIGMA_RAD],
        .false_mean = of->false_mean,
    };
    for (size_t sensor = 0; sensor < plan.passive.num_sensors; sensor++) {
        plan.passive.sensors[sensor].x_m = places_m[sensor][0];
        plan.passive.sensors[sensor].y_m = places_m[sensor][1];
    }
    return plan;
}

void suggest_passive_parameters(struct parameters *parameters)
{
    const struct {
        enum parameter_id id;
        double value;
    } values[] = {{PARAMETER_NUM_SCANS, 8},        {PARAMETER_INTERVAL_S, 10},
                  {PARAMETER_TRUE_PD, 0.9},        {PARAMETER_SIGMA_RAD, 0.1 * PI / 180.0},
                  {PARAMETER_V_MIN_MPS, 150},      {PARAMETER_V_MAX_MPS, 350},
                  {PARAMETER_ACCEL_MAX_MPS2, 5},   {PARAMETER_AREA_X_MIN_M, 0},
                  {PARAMETER_AREA_X_MAX_M, 80000}, {PARAMETER_AREA_Y_MIN_M, -55000},
                  {PARAMETER_AREA_Y_MAX_M, 55000}};

    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        parameters_suggest(parameters, values[i].id, values[i].value);
    }
}

struct simulation *simulate_passive(const struct scenario_bearings *of,
                                    const struct parameters *parameters, uint64_t seed,
                                    uint64_t run)
{
    struct random random = random_start(seed, STREAM, run);
    struct scenario_plan plan = plan_passive(of, parameters, &random);
    struct simulation *simulation;

    plan.pd = parameters->value[PARAMETER_TRUE_PD];
    simulation = plan_simulate(&plan, &random);
    plan_free(&plan);
    return simulation;
}

/* ---- bearings -------------------------------------------------------------------------------- */

static void append_bearing(struct simulated_look *look, double bearing_rad, int target_id)
{
    look->bearings[look->num_bearings++] = (struct simulated_bearing){
        .bearing_rad = remainder(bearing_rad, 2.0 * PI), .target_id = target_id};
}

/*
 * A missed target takes as many random numbers as a detected one, so that the noise of other
 * targets does not depend on it.
 */
static void append_bearing_if_detected(const struct scenario_plan *plan,
                                       const struct truth_point *truth, struct simulated_look *look,
                                       struct random *random)
{
    double dx_m = truth->x_m - plan->passive.sensors[look->sensor].x_m;
    double dy_m = truth->y_m - plan->passive.sensors[look->sensor].y_m;
    bool is_seen = random_uniform(random) < plan->pd;
    double noise_rad = plan->passive.sigma_rad * random_normal(random);
    if (is_seen) {
        append_bearing(look, atan2(dy_m, dx_m) + noise_rad, truth->target_id);
    }
}

static void shuffle_bearings(struct simulated_look *look, struct random *random)
{
    for (size_t i = look->num_bearings; i > 1; i--) {
        size_t j = random_below(random, i);
        struct simulated_bearing swapped = look->bearings[i - 1];
        look->bearings[i - 1] = look->bearings[j];
        look->bearings[j] = swapped;
    }
}

static void simulate_look(const struct scenario_plan *plan, size_t scan,
                          struct simulated_look *look, struct random *random)
{
    uint64_t num_false = random_poisson(random, plan->passive.false_mean);
    look->bearings = must_calloc(plan->num_targets + num_false + 1, sizeof *look->bearings);
    for (size_t target = 0; target < plan->num_targets; target++) {
        append_bearing_if_detected(plan, plan_truth(plan, scan, target), look, random);
    }
    for (uint64_t i = 0; i < num_false; i++) {
        append_bearing(look, random_between(random, -PI / 2.0, PI / 2.0), -1);
    }
    shuffle_bearings(look, random);
}

void plan_simulate_looks(const struct scenario_plan *plan, size_t scan,
                         struct simulated_look *looks, struct random *random)
{
    for (size_t sensor = 0; sensor < plan->passive.num_sensors; sensor++) {
        looks[sensor].t_s = (double)scan * plan->interval_s;
        looks[sensor].sensor = sensor;
        simulate_look(plan, scan, &looks[sensor], random);
    }
}
