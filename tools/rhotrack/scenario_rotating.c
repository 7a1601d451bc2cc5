/* SPDX-License-Identifier: MIT */
#include "scenario_rotating.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "scenario_plan.h"
#include "scenario_record.h"

#define TURN_MPS2 2.0
#define DRAFTS_MAX 10000
#define STEP_S 1.0 /* between places that are looked at */

/* ---- flights ---------------------------------------------------------------------------------- */

/* Along an arc, or straight. */
static void fly(struct truth_point *at, double speed_mps, double *heading_rad, double turn_radps,
                double dt_s)
{
    double turn_rad = turn_radps * dt_s, arc_m = speed_mps * dt_s;
    double chord_m =
        fabs(turn_rad) > 1e-12 ? arc_m * sin(turn_rad / 2.0) / (turn_rad / 2.0) : arc_m;

    at->x_m += chord_m * cos(*heading_rad + turn_rad / 2.0);
    at->y_m += chord_m * sin(*heading_rad + turn_rad / 2.0);
    *heading_rad += turn_rad;
}

static struct truth_point along(const struct rotating_flight *flight, double t_s)
{
    struct truth_point at = {.t_s = t_s, .x_m = flight->x_m, .y_m = flight->y_m};
    double heading_rad = flight->heading_rad, speed_mps = flight->speed_mps;
    double before_s = fmin(t_s, flight->turn_from_s);
    double turning_s = fmin(t_s, flight->turn_until_s) - before_s;

    fly(&at, speed_mps, &heading_rad, 0.0, before_s);
    if (turning_s > 0.0) {
        fly(&at, speed_mps, &heading_rad, flight->turn_radps, turning_s);
        fly(&at, speed_mps, &heading_rad, 0.0, t_s - flight->turn_from_s - turning_s);
    }
    at.vx_mps = speed_mps * cos(heading_rad);
    at.vy_mps = speed_mps * sin(heading_rad);
    return at;
}

struct truth_point rotating_truth(const struct rotating_scene *scene, size_t flight, double t_s)
{
    struct truth_point truth = along(&scene->flights[flight], t_s);

    truth.target_id = (int)flight;
    return truth;
}

static bool watch(const void *context, size_t target, double t_s, struct truth_point *truth)
{
    *truth = rotating_truth(context, target, t_s);
    return true;
}

struct antenna_targets rotating_targets(const struct rotating_scene *scene)
{
    return (struct antenna_targets){.count = scene->num_flights, .context = scene, .at = watch};
}

static bool stays(const struct rotating_flight *flight, double duration_s)
{
    for (int i = 0; i * STEP_S <= duration_s; i++) {
        const struct truth_point at = along(flight, i * STEP_S);
        double range_m = hypot(at.x_m, at.y_m);

        if (range_m < POLAR_NEAR_M || range_m > POLAR_FAR_M) {
            return false;
        }
    }
    return true;
}

/* A turn lasts a third of the time, and begins in the second third. */
static struct rotating_flight draw_flight(const struct parameters *parameters, double duration_s,
                                          bool turns, struct random *random)
{
    for (int i = 0; i < DRAFTS_MAX; i++) {
        struct scenario_state start = plan_straight_around(parameters, duration_s, random);
        struct rotating_flight flight = {.x_m = start.x_m,
                                         .y_m = start.y_m,
                                         .speed_mps = hypot(start.vx_mps, start.vy_mps),
                                         .heading_rad = atan2(start.vy_mps, start.vx_mps)};
        double side = random_uniform(random) < 0.5 ? 1.0 : -1.0;

        flight.turn_from_s = random_between(random, duration_s / 3.0, duration_s * 2.0 / 3.0);
        flight.turn_until_s = flight.turn_from_s + duration_s / 3.0;
        flight.turn_radps = turns ? side * TURN_MPS2 / flight.speed_mps : 0.0;
        if (stays(&flight, duration_s)) {
            return flight;
        }
    }
    fail(EXIT_USAGE, "scenario rotating: no target can stay within 20 to 60 km for the whole run; "
                     "take fewer scans or slower targets");
}

/* ---- the scene -------------------------------------------------------------------------------- */

static struct scenario_antenna antenna_of(const struct parameters *parameters)
{
    const double *value = parameters->value;

    return (struct scenario_antenna){
        .sensor_id = 1,
        .turn_s = value[PARAMETER_INTERVAL_S],
        .sectors = (size_t)value[PARAMETER_SECTORS_PER_TURN],
        .pd = value[parameters_is_set(parameters, PARAMETER_TRUE_PD) ? PARAMETER_TRUE_PD
                                                                     : PARAMETER_PD],
        .range_min_m = value[PARAMETER_RANGE_MIN_M],
        .range_max_m = value[PARAMETER_RANGE_MAX_M],
        .has_range_rate = value[PARAMETER_RANGE_RATE] > 0.0,
        .sigma_range_m = value[PARAMETER_SIGMA_RANGE_M],
        .sigma_azimuth_rad = value[PARAMETER_SIGMA_AZIMUTH_RAD],
        .sigma_range_rate_mps = value[PARAMETER_SIGMA_RANGE_RATE_MPS],
        .clutter_mean = value[PARAMETER_CLUTTER_PER_SCAN],
        .clutter_rate_max_mps = value[PARAMETER_V_MAX_MPS],
    };
}

struct rotating_scene rotating_draw(const struct parameters *parameters, struct random *random)
{
    struct rotating_scene scene = {.antenna = antenna_of(parameters),
                                   .num_turns = (size_t)parameters->value[PARAMETER_NUM_SCANS],
                                   .num_flights = (size_t)parameters->value[PARAMETER_TARGETS]};
    double duration_s = scene.antenna.turn_s * (double)scene.num_turns;

    scene.flights = must_calloc(scene.num_flights + 1, sizeof *scene.flights);
    for (size_t i = 0; i < scene.num_flights; i++) {
        scene.flights[i] = draw_flight(parameters, duration_s, i % 2 == 1, random);
    }
    return scene;
}

void rotating_free(struct rotating_scene *scene)
{
    free(scene->flights);
    scene->flights = NULL;
}

/* ---- the scenario ----------------------------------------------------------------------------- */

/* Ambiguous ones are known up to multiples of the span. */
static void fold(const struct parameters *parameters, struct antenna_view *view)
{
    double span_mps = parameters->value[PARAMETER_RANGE_RATE_SPAN_MPS];

    for (size_t i = 0; i < view->num_sectors && span_mps > 0.0; i++) {
        for (size_t k = 0; k < view->sectors[i].num_plots; k++) {
            struct antenna_plot *plot = &view->sectors[i].plots[k];

            plot->range_rate_mps = remainder(plot->range_rate_mps, span_mps);
        }
    }
}

struct simulation *simulate_rotating(const struct parameters *parameters, struct random *random)
{
    struct simulation *simulation = must_calloc(1, sizeof *simulation);
    struct rotating_scene scene = rotating_draw(parameters, random);
    struct antenna_targets targets = rotating_targets(&scene);

    simulation->num_targets = simulation->targets_a_scan = scene.num_flights;
    simulation->interval_s = scene.antenna.turn_s;
    simulation->area = plan_box_of(parameters);
    simulation->record = must_calloc(1, sizeof *simulation->record);
    record_watch(simulation->record, &scene.antenna, &targets, scene.num_turns, random);
    fold(parameters, &simulation->record->views[0]);
    record_arrive(simulation->record, 0.0, 0.0, random);
    simulation->truth =
        record_truth(simulation->record, &targets, &simulation->num_truth, &simulation->num_times);
    rotating_free(&scene);
    return simulation;
}
