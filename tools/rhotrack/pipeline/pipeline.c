/* SPDX-License-Identifier: MIT */
#include "pipeline/pipeline.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "settings/initiation_methods.h"

#define WINDOWS_MAX 256 /* windows of a sensor, or of two that share one */

static void allocate_one_more_initiator(struct pipeline *pipeline)
{
    pipeline->initiators =
        must_make_room_for_one(pipeline->initiators, pipeline->num_allocated, &pipeline->capacity,
                               sizeof *pipeline->initiators);
    pipeline->initiators[pipeline->num_allocated++].initiator =
        must_alloc(sizeof(struct rho_initiator));
}

struct pipeline pipeline_allocate(void)
{
    struct pipeline pipeline = {.tracker = must_alloc(sizeof(struct rho_tracker)),
                                .report = must_alloc(sizeof(struct rho_report)),
                                .plots = must_calloc(RHO_MAX_PLOTS, sizeof(struct rho_plot))};

    allocate_one_more_initiator(&pipeline);
    pipeline.initiator = pipeline.initiators[0].initiator;
    return pipeline;
}

void pipeline_free(struct pipeline *pipeline)
{
    for (size_t i = 0; i < pipeline->num_allocated; i++) {
        free(pipeline->initiators[i].initiator);
    }
    free(pipeline->initiators);
    free(pipeline->passive);
    free(pipeline->starts);
    free(pipeline->paper);
    free(pipeline->zones);
    free(pipeline->learning);
    free(pipeline->tracker);
    free(pipeline->report);
    free(pipeline->plots);
}

static void suggest_paper_methods_or_fail(struct parameters *parameters, const char *name)
{
    if (strcmp(name, "paper") != 0) {
        fail(EXIT_USAGE, "--pipeline '%s' is not paper", name);
    }
    parameters_suggest(parameters, PARAMETER_METHOD, METHOD_NHT - METHOD_KERNEL);
    parameters_suggest(parameters, PARAMETER_BEARINGS_METHOD,
                       METHOD_PASSIVE_PAPER - METHOD_PASSIVE);
    parameters_suggest(parameters, PARAMETER_GATE, RHO_TRACKER_HOUGH);
    parameters_suggest(parameters, PARAMETER_INPUT_ESTIMATION, 1);
}

void pipeline_options_to_parameters(struct parameters *parameters,
                                    const struct pipeline_options *options)
{
    if (options->pipeline) {
        suggest_paper_methods_or_fail(parameters, options->pipeline);
    }
    if (options->method) {
        parameters_set_method(parameters, options->method);
    }
    if (options->gate) {
        parameters_set_gate(parameters, options->gate);
    }
    if (parameters->value[PARAMETER_GATE] >= RHO_NUM_TRACKER_GATES) {
        fail(EXIT_USAGE, "gate none, which draws plots at random, is only for `maintain`; use "
                         "best, hough or nearest");
    }
    if (track_start_method(parameters) != METHOD_KERNEL) {
        struct rho_paper_starts_config customary;

        rho_paper_starts_config_default(&customary, RHO_HOUGH_NHT_C);
        parameters_suggest(parameters, PARAMETER_SCANS, customary.scans);
        method_suggest_parameters(track_start_method(parameters), parameters);
    }
}

/* Adds the initiator of a sensor's window, in memory of an earlier run where there is some. */
static struct pipeline_initiator *add_initiator(struct pipeline *pipeline, int32_t sensor_id)
{
    struct pipeline_initiator *added;

    if (pipeline->num_initiators == pipeline->num_allocated) {
        allocate_one_more_initiator(pipeline);
    }
    added = &pipeline->initiators[pipeline->num_initiators++];
    added->sensor_id = sensor_id;
    must_succeed(rho_initiator_init(added->initiator, sizeof *added->initiator, &pipeline->start),
                 "initiator");
    return added;
}

/*
 * Pushes a scan held in one window into another; plots that already started tracks are marked as
 * claimed.
 */
static void copy_held_scan_to_initiator(struct rho_initiator *initiator,
                                        const struct rho_window_scan *held)
{
    struct rho_plot *plots = must_calloc(held->num_plots + 1u, sizeof *plots);
    uint8_t *fates = must_calloc(held->num_plots + 1u, sizeof *fates);
    uint32_t left_unused = 0;

    for (unsigned i = 0; i < held->num_plots; i++) {
        plots[i] = rho_window_unpack_plot(held, i);
        fates[i] = held->marks[i] & RHO_WINDOW_INITIATED ? RHO_FATE_CLAIMED : RHO_FATE_HELD;
    }
    const struct rho_scan scan = {.time_us = held->time_us,
                                  .sensor_id = held->sensor.sensor_id,
                                  .measures = held->measures,
                                  .sector_from_rad = held->sector_from_rad,
                                  .sector_to_rad = held->sector_to_rad,
                                  .num_plots = held->num_plots,
                                  .plots = plots};
    must_succeed(rho_initiator_push(initiator, &scan, rho_window_sensor_if_described(held), fates,
                                    &left_unused),
                 "initiator");
    free(plots);
    free(fates);
}

/*
 * Copies a sensor's scans from the windows it shared into its new window, so that its targets can
 * start tracks from them.
 */
static void copy_scans_from_shared_windows(struct pipeline *pipeline,
                                           const struct pipeline_initiator *added)
{
    for (size_t i = 0; pipeline->initiators + i < added; i++) {
        struct rho_window *shared = &pipeline->initiators[i].initiator->window;

        for (unsigned m = 0; m < shared->num_scans; m++) {
            const struct rho_window_scan *held = rho_window_scan_at(shared, m);

            if (held->sensor.sensor_id == added->sensor_id) {
                copy_held_scan_to_initiator(added->initiator, held);
            }
        }
    }
}

/*
 * Adds the initiator of a sensor's window, or gives the one that all sensors beyond the windows
 * share: each takes megabytes, and a file may name any number of sensors.
 */
static struct pipeline_initiator *add_or_share_initiator(struct pipeline *pipeline,
                                                         int32_t sensor_id)
{
    struct pipeline_initiator *of;

    if (pipeline->num_initiators > WINDOWS_MAX) {
        return &pipeline->initiators[WINDOWS_MAX];
    }
    if (pipeline->num_initiators == WINDOWS_MAX) {
        fprintf(stderr,
                "rhotrack: %d initiation windows are in use: sensor %" PRId32 " and further ones "
                "share another, from which hardly any track starts\n",
                WINDOWS_MAX, sensor_id);
    }
    of = add_initiator(pipeline, sensor_id);
    copy_scans_from_shared_windows(pipeline, of);
    return of;
}

/*
 * Finds or adds the initiator of a window. The first initiator exists before its sensor is known.
 */
struct rho_initiator *pipeline_find_or_add_initiator(struct pipeline *pipeline, int32_t sensor_id)
{
    struct pipeline_initiator *of = NULL;

    if (pipeline->has_one_initiator) {
        return pipeline->initiator;
    }
    if (!pipeline->has_sensor) {
        pipeline->has_sensor = true;
        pipeline->initiators[0].sensor_id = sensor_id;
    }
    for (size_t i = 0; i < pipeline->num_initiators && !of; i++) {
        of = pipeline->initiators[i].sensor_id == sensor_id ? &pipeline->initiators[i] : NULL;
    }
    if (!of) {
        of = add_or_share_initiator(pipeline, sensor_id);
    }
    pipeline->initiator = of->initiator;
    return pipeline->initiator;
}

struct rho_initiator *pipeline_initiator_of_sensor(struct pipeline *pipeline,
                                                   const struct rho_scan *scan)
{
    return pipeline_find_or_add_initiator(pipeline, pipeline->has_pairs
                                                        ? pipeline_window_sensor_id(pipeline, scan)
                                                        : scan->sensor_id);
}

/* Opens track starts by the papers' Hough methods, with cells for plots within range_max_m. */
static void open_paper_starts_if_chosen(struct pipeline *pipeline,
                                        const struct parameters *parameters)
{
    struct parameters fitted = *parameters;
    struct rho_paper_starts_config config;
    const double range_m = parameters->value[PARAMETER_RANGE_MAX_M];

    if (track_start_method(parameters) == METHOD_KERNEL) {
        return;
    }
    method_widen_cells_to_range(&fitted, range_m);
    config = (struct rho_paper_starts_config){
        .hough = method_hough_config(track_start_method(parameters), &fitted, range_m),
        .scans = (uint16_t)parameters->value[PARAMETER_SCANS],
        .scans_min = (uint16_t)parameters->value[PARAMETER_MIN_SCANS]};
    if (!pipeline->starts) {
        pipeline->starts = must_alloc(sizeof *pipeline->starts);
    }
    must_succeed(rho_paper_starts_init(pipeline->starts, sizeof *pipeline->starts, &config),
                 "method");
}

/* Creates the zones once: they keep their counts across a reset of the tracker. */
static void open_zones_once(struct pipeline *pipeline, const struct parameters *parameters)
{
    if (parameters->num_zones > 0 && !pipeline->zones) {
        pipeline->zones = must_alloc(sizeof *pipeline->zones);
        parameters_to_zones(parameters, pipeline->zones);
    }
}

/* Creates the learning of walls once: it is kept across a reset of the tracker. */
static void open_wall_learning_once(struct pipeline *pipeline, const struct parameters *parameters)
{
    if (parameters->value[PARAMETER_LEARN_REFLECTORS] > 0 && !pipeline->learning) {
        pipeline->learning = must_alloc(sizeof *pipeline->learning);
        must_succeed(rho_reflector_learning_init(pipeline->learning, sizeof *pipeline->learning),
                     "learn_reflectors");
    }
}

static void keep_settings_for_snapshot(struct pipeline *pipeline,
                                       const struct parameters *parameters)
{
    pipeline->settings = parameters_to_settings(parameters);
    if (!pipeline->is_told) {
        pipeline->is_told = true;
        pipeline->told = pipeline->settings;
    }
}

void pipeline_open(struct pipeline *pipeline, const struct parameters *parameters)
{
    struct rho_tracker_config maintain;

    keep_settings_for_snapshot(pipeline, parameters);
    parameters_to_initiator(parameters, &pipeline->start);
    parameters_to_tracker(parameters, &maintain);
    pipeline->has_pairs = parameters->value[PARAMETER_INITIATORS] == INITIATORS_PAIRS;
    pipeline->has_one_initiator = parameters->value[PARAMETER_INITIATORS] == INITIATORS_ONE;
    pipeline->has_sensor = false;
    pipeline->num_named = parameters->num_sensors;
    for (size_t i = 0; i < parameters->num_sensors; i++) {
        pipeline->named[i] = parameters->sensors[i].sensor_id;
    }
    pipeline->num_initiators = 0;
    pipeline->initiator = add_initiator(pipeline, 0)->initiator;
    must_succeed(rho_tracker_init(pipeline->tracker, sizeof *pipeline->tracker, &maintain),
                 "tracker");
    must_succeed(rho_tracker_set_reflectors(pipeline->tracker, parameters->reflectors,
                                            parameters->num_reflectors),
                 "reflectors");
    must_succeed(
        rho_tracker_set_body_max(pipeline->tracker, (float)parameters->value[PARAMETER_BODY_MAX_M]),
        "body_max_m");
    open_paper_starts_if_chosen(pipeline, parameters);
    open_zones_once(pipeline, parameters);
    open_wall_learning_once(pipeline, parameters);
}

void pipeline_reconfigure(struct pipeline *pipeline, const struct parameters *parameters)
{
    struct rho_tracker_config maintain;

    keep_settings_for_snapshot(pipeline, parameters);
    parameters_to_initiator(parameters, &pipeline->start);
    parameters_to_tracker(parameters, &maintain);
    must_succeed(rho_tracker_reconfigure(pipeline->tracker, &maintain), "tracker");
    for (size_t i = 0; i < pipeline->num_initiators; i++) {
        must_succeed(rho_initiator_reconfigure(pipeline->initiators[i].initiator, &pipeline->start),
                     "initiator");
    }
}

static void open_passive_paper(struct pipeline *pipeline, const struct parameters *parameters)
{
    struct parameters customary = *parameters;
    struct rho_passive_paper_config config;

    method_suggest_parameters(METHOD_PASSIVE_PAPER, &customary);
    config = method_passive_paper_config(&customary);
    if (!pipeline->paper) {
        pipeline->paper = must_alloc(sizeof *pipeline->paper);
    }
    must_succeed(rho_passive_paper_init(pipeline->paper, sizeof *pipeline->paper, &config),
                 "passive-paper");
}

void pipeline_open_passive(struct pipeline *pipeline, const struct parameters *parameters)
{
    struct parameters customary = *parameters;

    method_suggest_parameters(METHOD_PASSIVE, &customary);
    struct rho_passive_config config = method_passive_config(&customary);
    if (!pipeline->passive) {
        pipeline->passive = must_alloc(sizeof *pipeline->passive);
    }
    must_succeed(rho_passive_init(pipeline->passive, sizeof *pipeline->passive, &config),
                 "passive");
    if (method_of_bearings(parameters) == METHOD_PASSIVE_PAPER) {
        open_passive_paper(pipeline, parameters);
    }
}

void pipeline_reopen_passive_paper(struct pipeline *pipeline)
{
    if (pipeline->paper) {
        const struct rho_passive_paper_config config = pipeline->paper->config;

        must_succeed(rho_passive_paper_init(pipeline->paper, sizeof *pipeline->paper, &config),
                     "passive-paper");
    }
}

void pipeline_start_paper_tracks(struct pipeline *pipeline, const struct rho_scan *scan,
                                 const struct rho_frame *frame)
{
    if (scan && pipeline->starts) {
        must_succeed(
            rho_paper_starts_step(pipeline->starts, pipeline->tracker, scan, pipeline->report),
            "method");
    } else if (frame && pipeline->paper &&
               rho_passive_paper_step(pipeline->paper, pipeline->tracker, frame,
                                      pipeline->report) != RHO_OK) {
        pipeline_reopen_passive_paper(pipeline); /* the frame's sensors do not fit the batch */
    }
}

void pipeline_learn_walls(struct pipeline *pipeline, const struct rho_scan *scan)
{
    if (pipeline->learning) {
        must_succeed(rho_reflector_learning_step(pipeline->learning, pipeline->tracker, scan,
                                                 pipeline->report),
                     "learn_reflectors");
    }
}

void pipeline_count_tracks_in_zones(struct pipeline *pipeline)
{
    if (pipeline->zones) {
        must_succeed(rho_zones_step(pipeline->zones, pipeline->report), "zones");
    }
}

void pipeline_step(struct pipeline *pipeline, const struct rho_scan *scan)
{
    struct rho_initiator *initiator =
        pipeline->starts ? NULL : pipeline_initiator_of_sensor(pipeline, scan);

    must_succeed(rho_tracker_step(pipeline->tracker, initiator, scan, pipeline->report), "step");
    pipeline_start_paper_tracks(pipeline, scan, NULL);
    pipeline_learn_walls(pipeline, scan);
    pipeline_count_tracks_in_zones(pipeline);
}

void pipeline_step_frame(struct pipeline *pipeline, const struct rho_frame *frame)
{
    struct rho_passive *passive = pipeline->paper ? NULL : pipeline->passive;

    must_succeed(rho_tracker_step_frame(pipeline->tracker, passive, frame, pipeline->report),
                 "step");
    pipeline_start_paper_tracks(pipeline, NULL, frame);
    pipeline_count_tracks_in_zones(pipeline);
}
