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
    must_succeed(rho_node_configure_bearings(pipeline->node, &config), "passive");
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

/* What the looks of a frame tell together, but for tracks: those of the last look count. */
struct frame_report {
    uint32_t num_ended, fates_total[RHO_NUM_FATES], ended[RHO_MAX_TRACKS];
    uint8_t fates[RHO_MAX_PLOTS];
};

/* first: number of bearings of the looks before it in the frame */
static void add_look_to_frame(struct frame_report *of_frame, const struct rho_report *report,
                              uint32_t first)
{
    for (unsigned i = 0; i < report->num_ended && of_frame->num_ended < RHO_MAX_TRACKS; i++) {
        of_frame->ended[of_frame->num_ended++] = report->ended[i];
    }
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        of_frame->fates_total[fate] += report->fates_total[fate];
    }
    for (uint32_t i = 0; i < report->num_plots && first + i < RHO_MAX_PLOTS; i++) {
        of_frame->fates[first + i] = report->fates[i];
    }
}

/* A look of a frame. */
struct look {
    const struct rho_bearing_scan *scan;
};

static int compare_looks_by_time(const void *a, const void *b)
{
    const struct rho_bearing_scan *first = ((const struct look *)a)->scan;
    const struct rho_bearing_scan *second = ((const struct look *)b)->scan;

    return first->time_us != second->time_us
               ? (first->time_us > second->time_us) - (first->time_us < second->time_us)
               : (first > second) - (first < second);
}

void pipeline_step_frame(struct pipeline *pipeline, const struct rho_frame *frame,
                         void (*after_look)(void *context), void *context)
{
    struct rho_report *report = &pipeline->node->report;
    struct frame_report of_frame = {.num_ended = 0};
    struct look *looks = must_calloc((size_t)frame->num_scans + 1, sizeof *looks);
    uint32_t num_bearings = 0;

    for (uint32_t i = 0; i < frame->num_scans; i++) {
        looks[i].scan = &frame->scans[i];
    }
    qsort(looks, frame->num_scans, sizeof *looks, compare_looks_by_time);
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        uint32_t first = 0;

        must_succeed(rho_node_step_bearings(pipeline->node, looks[i].scan), "step");
        for (const struct rho_bearing_scan *before = frame->scans; before < looks[i].scan;
             before++) {
            first += before->num_bearings;
        }
        add_look_to_frame(&of_frame, report, first);
        num_bearings += looks[i].scan->num_bearings;
        if (after_look) {
            after_look(context);
        }
    }
    free(looks);
    report->num_plots = num_bearings;
    report->num_ended = (uint16_t)of_frame.num_ended;
    memcpy(report->ended, of_frame.ended, sizeof report->ended);
    memcpy(report->fates_total, of_frame.fates_total, sizeof report->fates_total);
    memcpy(report->fates, of_frame.fates, sizeof report->fates);
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
