/* SPDX-License-Identifier: MIT */
#include "chain.h"

#include <math.h>
#include <stdlib.h>

#include "common.h"
#include "method.h"
#include "random.h"

void must_succeed(enum rho_status status, const char *what)
{
    if (status != RHO_OK) {
        fail(EXIT_RUNTIME, "%s: the library says '%s'", what, rho_status_name(status));
    }
}

static void allocate_initiator(struct chain *chain)
{
    chain->initiators = must_grow(chain->initiators, chain->num_allocated, &chain->capacity,
                                  sizeof *chain->initiators);
    chain->initiators[chain->num_allocated++].initiator = must_alloc(sizeof(struct rho_initiator));
}

struct chain chain_start(void)
{
    struct chain chain = {.tracker = must_alloc(sizeof(struct rho_tracker)),
                          .report = must_alloc(sizeof(struct rho_report)),
                          .plots = must_calloc(RHO_MAX_PLOTS, sizeof(struct rho_plot))};

    allocate_initiator(&chain);
    chain.initiator = chain.initiators[0].initiator;
    return chain;
}

void chain_free(struct chain *chain)
{
    for (size_t i = 0; i < chain->num_allocated; i++) {
        free(chain->initiators[i].initiator);
    }
    free(chain->initiators);
    free(chain->passive);
    free(chain->tracker);
    free(chain->report);
    free(chain->plots);
}

void chain_set_gate(struct parameters *parameters, const char *gate)
{
    if (gate) {
        parameters_set_gate(parameters, gate);
    }
    if (parameters->value[PARAMETER_GATE] >= RHO_NUM_TRACKER_GATES) {
        fail(EXIT_USAGE, "gate none draws plots at random: that is for `maintain`; there are best, "
                         "hough and nearest");
    }
}

/* Memory of an earlier run is used again. */
static struct chain_initiator *add_initiator(struct chain *chain, int32_t sensor_id)
{
    struct chain_initiator *added;

    if (chain->num_initiators == chain->num_allocated) {
        allocate_initiator(chain);
    }
    added = &chain->initiators[chain->num_initiators++];
    added->sensor_id = sensor_id;
    must_succeed(rho_initiator_init(added->initiator, sizeof *added->initiator, &chain->start),
                 "initiator");
    return added;
}

/* The held scan goes into another window too, but for the plots that have started tracks. */
static void push_held(struct rho_initiator *initiator, const struct rho_window_scan *held)
{
    struct rho_plot *plots = must_calloc(held->num_plots + 1u, sizeof *plots);
    uint8_t *fates = must_calloc(held->num_plots + 1u, sizeof *fates);
    uint32_t left_unused = 0;

    for (unsigned i = 0; i < held->num_plots; i++) {
        plots[i] = rho_window_plot_of(held, i);
        fates[i] = held->marks[i] & RHO_WINDOW_INITIATED ? RHO_FATE_CLAIMED : RHO_FATE_HELD;
    }
    const struct rho_scan scan = {.time_us = held->time_us,
                                  .sensor_id = held->sensor.sensor_id,
                                  .measures = held->measures,
                                  .sector_from_rad = held->sector_from_rad,
                                  .sector_to_rad = held->sector_to_rad,
                                  .num_plots = held->num_plots,
                                  .plots = plots};
    must_succeed(rho_initiator_push(initiator, &scan, rho_window_sensor(held), fates, &left_unused),
                 "initiator");
    free(plots);
    free(fates);
}

/*
 * A sensor that leaves the window that it shared takes its scans along: its targets start from
 * these.
 */
static void take_along(struct chain *chain, const struct chain_initiator *added)
{
    for (size_t i = 0; chain->initiators + i < added; i++) {
        struct rho_window *shared = &chain->initiators[i].initiator->window;

        for (unsigned m = 0; m < shared->num_scans; m++) {
            const struct rho_window_scan *held = rho_window_scan_at(shared, m);

            if (held->sensor.sensor_id == added->sensor_id) {
                push_held(added->initiator, held);
            }
        }
    }
}

/* The first one is there before its sensor is known. */
struct rho_initiator *chain_initiator(struct chain *chain, int32_t sensor_id)
{
    struct chain_initiator *of = NULL;

    if (chain->has_one_initiator) {
        return chain->initiator;
    }
    if (!chain->has_sensor) {
        chain->has_sensor = true;
        chain->initiators[0].sensor_id = sensor_id;
    }
    for (size_t i = 0; i < chain->num_initiators && !of; i++) {
        of = chain->initiators[i].sensor_id == sensor_id ? &chain->initiators[i] : NULL;
    }
    if (!of) {
        of = add_initiator(chain, sensor_id);
        take_along(chain, of);
    }
    chain->initiator = of->initiator;
    return chain->initiator;
}

struct rho_initiator *chain_initiator_of(struct chain *chain, const struct rho_scan *scan)
{
    return chain_initiator(chain,
                           chain->has_pairs ? chain_window_of(chain, scan) : scan->sensor_id);
}

void chain_open(struct chain *chain, const struct parameters *parameters)
{
    struct rho_tracker_config maintain;
    parameters_to_initiator(parameters, &chain->start);
    parameters_to_tracker(parameters, &maintain);
    chain->has_pairs = parameters->value[PARAMETER_INITIATORS] == INITIATORS_PAIRS;
    chain->has_one_initiator = parameters->value[PARAMETER_INITIATORS] == INITIATORS_ONE;
    chain->has_sensor = false;
    chain->num_named = parameters->num_sensors;
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        chain->named[i] = parameters->sensors[i].sensor_id;
    }
    chain->num_initiators = 0;
    chain->initiator = add_initiator(chain, 0)->initiator;
    must_succeed(rho_tracker_init(chain->tracker, sizeof *chain->tracker, &maintain), "tracker");
}

void chain_open_passive(struct chain *chain, const struct parameters *parameters)
{
    struct parameters customary = *parameters;

    method_suggest(METHOD_PASSIVE, &customary);
    struct rho_passive_config config = method_passive(&customary);
    if (!chain->passive) {
        chain->passive = must_alloc(sizeof *chain->passive);
    }
    must_succeed(rho_passive_init(chain->passive, sizeof *chain->passive, &config), "passive");
}

void chain_step(struct chain *chain, const struct rho_scan *scan)
{
    must_succeed(
        rho_tracker_step(chain->tracker, chain_initiator_of(chain, scan), scan, chain->report),
        "step");
}

void chain_step_frame(struct chain *chain, const struct rho_frame *frame)
{
    must_succeed(rho_tracker_step_frame(chain->tracker, chain->passive, frame, chain->report),
                 "step");
}

struct rho_plot chain_plot(double x_m, double y_m, double sigma_m)
{
    return (struct rho_plot){.x_m = (float)x_m,
                             .y_m = (float)y_m,
                             .sigma_range_m = (float)sigma_m,
                             .sigma_cross_m = (float)sigma_m,
                             .sigma_up_m = (float)sigma_m};
}

size_t chain_fill_clutter(struct chain *chain, const struct parameters *parameters, double mean,
                          struct random *random)
{
    size_t count = random_poisson(random, mean);
    double sigma_m = parameters->value[PARAMETER_SIGMA_M];

    count = count < RHO_MAX_PLOTS ? count : RHO_MAX_PLOTS;
    for (size_t i = 0; i < count; i++) {
        double x_m = random_between(random, parameters->value[PARAMETER_AREA_X_MIN_M],
                                    parameters->value[PARAMETER_AREA_X_MAX_M]);
        double y_m = random_between(random, parameters->value[PARAMETER_AREA_Y_MIN_M],
                                    parameters->value[PARAMETER_AREA_Y_MAX_M]);
        chain->plots[i] = chain_plot(x_m, y_m, sigma_m);
    }
    return count;
}

struct rho_bearing_scan chain_look(const struct scenario_passive *passive,
                                   const struct simulated_look *look, struct rho_bearing *bearings,
                                   size_t most)
{
    size_t count = look->num_bearings < most ? look->num_bearings : most;

    for (size_t i = 0; i < count; i++) {
        bearings[i] = (struct rho_bearing){.bearing_rad = (float)look->bearings[i].bearing_rad,
                                           .sigma_rad = (float)passive->sigma_rad};
    }
    return (struct rho_bearing_scan){.time_us = llround(look->t_s * 1e6),
                                     .sensor_id = (int32_t)look->sensor + 1,
                                     .x_m = (float)passive->sensors[look->sensor].x_m,
                                     .y_m = (float)passive->sensors[look->sensor].y_m,
                                     .num_bearings = (uint32_t)count,
                                     .bearings = bearings};
}
