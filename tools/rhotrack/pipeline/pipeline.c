/* SPDX-License-Identifier: MIT */
#include "pipeline/pipeline.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "settings/initiation_methods.h"

struct pipeline pipeline_allocate(void)
{
    return (struct pipeline){.node = must_calloc(1, sizeof(struct rho_node)),
                             .plots = must_calloc(RHO_MAX_PLOTS, sizeof(struct rho_plot))};
}

void pipeline_free(struct pipeline *pipeline)
{
    for (size_t i = 0; i < pipeline->num_storage; i++) {
        free(pipeline->storage[i]);
    }
    free(pipeline->storage);
    free(pipeline->node);
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

/* ---- Configuration ---- */

/* Track starts by the papers' Hough methods, with cells for plots within range_max_m. */
static struct rho_paper_starts_config paper_starts_config(const struct parameters *parameters)
{
    struct parameters fitted = *parameters;
    const double range_m = parameters->value[PARAMETER_RANGE_MAX_M];

    method_widen_cells_to_range(&fitted, range_m);
    return (struct rho_paper_starts_config){
        .hough = method_hough_config(track_start_method(parameters), &fitted, range_m),
        .scans = (uint16_t)parameters->value[PARAMETER_SCANS],
        .scans_min = (uint16_t)parameters->value[PARAMETER_MIN_SCANS]};
}

static struct rho_node_config config_of_parameters(const struct pipeline *pipeline,
                                                   const struct parameters *parameters)
{
    const double *value = parameters->value;
    const struct rho_settings settings = parameters_to_settings(parameters);
    struct rho_node_config config;

    rho_node_config_default(&config, &settings);
    parameters_to_initiator(parameters, &config.initiator);
    parameters_to_tracker(parameters, &config.tracker);
    rho_passive_config_default(&config.passive); /* until pipeline_open_passive */
    config.body_max_m = (float)value[PARAMETER_BODY_MAX_M];
    config.options.windows = (uint8_t)value[PARAMETER_INITIATORS];
    config.options.learns_reflectors = value[PARAMETER_LEARN_REFLECTORS] > 0;
    config.options.is_plots_by_paper = track_start_method(parameters) != METHOD_KERNEL;
    if (config.options.is_plots_by_paper) {
        config.paper_starts = paper_starts_config(parameters);
    }
    config.epoch = pipeline->epoch;
    config.options.takes_commands = pipeline->takes_commands;
    return config;
}

static void init_node_once(struct pipeline *pipeline, const struct parameters *parameters,
                           const struct rho_settings *settings)
{
    if (!pipeline->is_open) {
        pipeline->is_open = true;
        must_succeed(rho_node_init(pipeline->node, sizeof *pipeline->node, settings), "node");
        parameters_to_zones(parameters, &pipeline->node->zones);
    }
}

void pipeline_open(struct pipeline *pipeline, const struct parameters *parameters)
{
    struct rho_node *node = pipeline->node;
    const struct rho_node_config config = config_of_parameters(pipeline, parameters);
    const struct rho_settings settings = parameters_to_settings(parameters);

    init_node_once(pipeline, parameters, &settings);
    node->settings = settings;
    must_succeed(rho_node_configure(node, &config), "tracker");
    must_succeed(rho_tracker_set_reflectors(&node->tracker, parameters->reflectors,
                                            parameters->num_reflectors),
                 "reflectors");
    if (pipeline->is_live) {
        parameters_to_assembler(parameters, &node->assembler);
    }
}

void pipeline_reconfigure(struct pipeline *pipeline, const struct parameters *parameters)
{
    const struct rho_node_config config = config_of_parameters(pipeline, parameters);

    pipeline->node->settings = parameters_to_settings(parameters);
    must_succeed(rho_node_reconfigure(pipeline->node, &config), "tracker");
    if (pipeline->is_live) {
        parameters_update_assembler(parameters, &pipeline->node->assembler);
    }
}

static void set_frames_config(struct rho_frames_config *config, const struct parameters *parameters)
{
    const double *value = parameters->value;

    config->tolerance_us = llround(value[PARAMETER_FRAME_TOLERANCE_S] * 1e6);
    config->jump_max_us = llround(value[PARAMETER_JUMP_MAX_S] * 1e6);
    config->follow_scans = (uint16_t)value[PARAMETER_FOLLOW_SCANS];
}

void pipeline_open_passive(struct pipeline *pipeline, const struct parameters *parameters)
{
    struct rho_node_config config = config_of_parameters(pipeline, parameters);
    struct parameters customary = *parameters;

    method_suggest_parameters(METHOD_PASSIVE, &customary);
    config.passive = method_passive_config(&customary);
    config.options.is_bearings_by_paper = method_of_bearings(parameters) == METHOD_PASSIVE_PAPER;
    if (config.options.is_bearings_by_paper) {
        customary = *parameters;
        method_suggest_parameters(METHOD_PASSIVE_PAPER, &customary);
        config.passive_paper = method_passive_paper_config(&customary);
    }
    config.passive_range_max_m = (float)parameters->value[PARAMETER_RANGE_MAX_M];
    if (pipeline->is_live) {
        set_frames_config(&config.frames, parameters);
    }
    if (rho_node_configure_bearings(pipeline->node, &config) != RHO_OK) {
        fail(EXIT_USAGE, "node: frame_tolerance_s has to be 10 s at most, and below jump_max_s");
    }
    pipeline->has_bearings = true;
}

/* ---- Steps ---- */

void pipeline_add_storage(struct pipeline *pipeline, unsigned num_windows)
{
    for (unsigned i = 0; i < num_windows; i++) {
        const size_t size = rho_node_storage_size(1);

        pipeline->storage =
            must_make_room_for_one(pipeline->storage, pipeline->num_storage,
                                   &pipeline->storage_room, sizeof *pipeline->storage);
        pipeline->storage[pipeline->num_storage] = must_alloc(size);
        must_succeed(
            rho_node_add_storage(pipeline->node, pipeline->storage[pipeline->num_storage++], size),
            "initiator");
    }
}

void pipeline_give_storage(struct pipeline *pipeline)
{
    if (rho_node_wants_storage(pipeline->node)) {
        pipeline_add_storage(pipeline, 1);
    }
}

void pipeline_warn_shared_windows(const struct pipeline *pipeline, uint32_t shared_before,
                                  int32_t sensor_id)
{
    if (shared_before == 0 && pipeline->node->windows.shared > 0) {
        fprintf(stderr,
                "rhotrack: %d initiation windows are in use: sensor %" PRId32 " and further ones "
                "share another, from which hardly any track starts\n",
                RHO_MAX_WINDOWS - 1, sensor_id);
    }
}

void pipeline_step(struct pipeline *pipeline, const struct rho_scan *scan)
{
    const uint32_t shared_before = pipeline->node->windows.shared;

    pipeline_give_storage(pipeline);
    must_succeed(rho_node_step_scan(pipeline->node, scan), "step");
    pipeline_warn_shared_windows(pipeline, shared_before, scan->sensor_id);
}

void pipeline_step_frame(struct pipeline *pipeline, const struct rho_frame *frame)
{
    must_succeed(rho_node_step_frame(pipeline->node, frame), "step");
}

/* ---- Parts ---- */

const struct rho_zones *pipeline_zones(const struct pipeline *pipeline)
{
    return pipeline->node->zones.num_zones > 0 ? &pipeline->node->zones : NULL;
}

const struct rho_reflector_learning *pipeline_learning(const struct pipeline *pipeline)
{
    return pipeline->node->options.learns_reflectors ? &pipeline->node->learning : NULL;
}

struct rho_paper_starts *pipeline_paper_starts(const struct pipeline *pipeline)
{
    return pipeline->node->options.is_plots_by_paper ? &pipeline->node->paper_starts : NULL;
}

struct rho_passive_paper *pipeline_passive_paper(const struct pipeline *pipeline)
{
    return pipeline->node->options.is_bearings_by_paper ? &pipeline->node->passive_paper : NULL;
}
