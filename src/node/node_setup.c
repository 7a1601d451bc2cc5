/* SPDX-License-Identifier: MIT */
/* node_setup: configurations of a node's parts, their start, restart and change. */
#include <string.h>

#include "../settings/policy.h"
#include "node_parts.h"
#include "rhotrack/body.h"

static void set_paper_defaults(struct rho_node_config *config, const struct rho_settings *settings)
{
    struct rho_hough_config *hough = &config->paper_starts.hough;
    struct rho_passive_paper_config *passive = &config->passive_paper;
    const float cell_m = 2.0f * settings->range_max_m / (float)(RHO_MAX_RHO_CELLS - 2);
    rho_paper_starts_config_default(&config->paper_starts, RHO_HOUGH_NHT_C);
    hough->v_min_mps = settings->v_min_mps;
    hough->v_max_mps = settings->v_max_mps;
    /* the paper's cells where they cover the range, else wider ones */
    if (cell_m > hough->rho_cell_m) {
        hough->eps_rho_m *= cell_m / hough->rho_cell_m;
        hough->rho_cell_m = cell_m;
    }
    hough->rho_max_m = 0.5f * (float)(RHO_MAX_RHO_CELLS - 1) * hough->rho_cell_m;
    if (RHO_NODE_HAS_BEARINGS) {
        rho_passive_paper_config_default(passive);
        passive->range_max_m = config->passive.range_max_m; /* the range of both searches */
        passive->rho_cell_m = PASSIVE_SPAN * passive->range_max_m / (float)RHO_PAPER_RHO_CELLS;
    }
}

void rho_node_config_default(struct rho_node_config *config, const struct rho_settings *settings)
{
    struct rho_scan_assembler_noise *noise = &config->assembler.other.noise;
    memset(config, 0, sizeof *config);
    rho_tracker_config_default(&config->tracker);
    rho_scan_assembler_config_default(&config->assembler);
    rho_settings_apply_sensor(settings, &config->assembler.other.sensor);
    noise->sigma_range_m = settings->sigma_range_m;
    noise->sigma_azimuth_rad = settings->sigma_azimuth_rad;
    noise->sigma_elevation_rad = settings->sigma_elevation_rad;
    noise->sigma_range_rate_mps = settings->sigma_range_rate_mps;
    noise->sigma_rad = settings->sigma_rad;
    if (RHO_SEARCHES) {
        rho_initiator_config_default(&config->initiator);
    }
    if (RHO_NODE_HAS_PASSIVE) {
        rho_passive_config_default(&config->passive);
    }
    rho_settings_apply(settings, &config->tracker, RHO_SEARCHES ? &config->initiator : NULL,
                       RHO_NODE_HAS_BEARINGS ? &config->passive : NULL);
    if (RHO_NODE_HAS_BEARINGS) {
        config->passive_range_max_m = settings->range_max_m;
    }
    if (RHO_PAPERS) {
        set_paper_defaults(config, settings);
        config->options.is_plots_by_paper = config->options.is_bearings_by_paper = !(RHO_SEARCHES);
    }
}

static enum rho_status init_bearings(struct rho_node *node, const struct rho_node_config *config)
{
    enum rho_status status = RHO_OK;
    node->options.is_bearings_by_paper = config->options.is_bearings_by_paper;
    node->passive_range_max_m = config->passive_range_max_m;
    if (RHO_NODE_HAS_PASSIVE) {
        status = rho_passive_init(NODE_PASSIVE(node), sizeof *NODE_PASSIVE(node), &config->passive);
    }
    if (rho_node_is_bearings_by_paper(node) && status == RHO_OK) {
        status = rho_passive_paper_init(NODE_PASSIVE_PAPER(node), sizeof *NODE_PASSIVE_PAPER(node),
                                        &config->passive_paper);
    }
    return status;
}

static enum rho_status init_tracking(struct rho_node *node, const struct rho_node_config *config)
{
    enum rho_status status =
        rho_tracker_init(&node->tracker, sizeof node->tracker, &config->tracker);
    if (RHO_BODIES && status == RHO_OK) {
        status = rho_tracker_set_body_max(&node->tracker, config->body_max_m);
    }
    if (status == RHO_OK) {
        status = rho_node_windows_init(node, &config->initiator);
    }
    if (rho_node_is_plots_by_paper(node) && status == RHO_OK) {
        status = rho_paper_starts_init(NODE_PAPER_STARTS(node), sizeof *NODE_PAPER_STARTS(node),
                                       &config->paper_starts);
    }
    if (RHO_LEARNS_REFLECTORS && node->options.learns_reflectors && status == RHO_OK) {
        status = rho_reflector_learning_init(NODE_LEARNING(node), sizeof *NODE_LEARNING(node));
    }
    return status;
}

static int has_unknown_parts(const struct rho_node_config *config)
{
    return (RHO_MAX_WINDOWS > 1 && config->options.windows >= RHO_NUM_NODE_WINDOWS) ||
           (RHO_BODIES && !rho_is_within(config->body_max_m, 0.0f, RHO_LIMIT_BODY_M)) ||
           (!RHO_BODIES && config->body_max_m > 0.0f) ||
           (RHO_NODE_HAS_BEARINGS &&
            !rho_is_within(config->passive_range_max_m, 0.0f, RANGE_UNKNOWN_M)) ||
           (!(RHO_PAPERS) &&
            (config->options.is_plots_by_paper || config->options.is_bearings_by_paper)) ||
           (!(RHO_LEARNS_REFLECTORS) && config->options.learns_reflectors) ||
           (RHO_MAX_COMMANDS == 0 && config->options.takes_commands);
}

enum rho_status rho_node_configure(struct rho_node *node, const struct rho_node_config *config)
{
    enum rho_status status = node_check(node, config);
    if (status != RHO_OK) {
        return status;
    }
    memset(&node->item, 0, offsetof(struct rho_node, report) - offsetof(struct rho_node, item));
    node->epoch = config->epoch;
    node->options = config->options;
    if (RHO_MAX_COMMANDS > 0) {
        NODE_OPERATOR(node)->num_commands = NODE_OPERATOR(node)->num_answers = 0;
        NODE_OPERATOR(node)->num_shown = 0;
    }
    memset(&node->report, 0, sizeof node->report);
    status = has_unknown_parts(config) ? RHO_ERROR_CONFIG : init_tracking(node, config);
    if (status == RHO_OK) {
        status =
            rho_scan_assembler_init(&node->assembler, sizeof node->assembler, &config->assembler);
    }
    if (RHO_NODE_HAS_BEARINGS && status == RHO_OK) {
        status = init_bearings(node, config);
    }
    if (status != RHO_OK) {
        node->magic = 0;
    }
    return status;
}

enum rho_status rho_node_configure_bearings(struct rho_node *node,
                                            const struct rho_node_config *config)
{
    enum rho_status status = node_check(node, config);
    if (status == RHO_OK && !RHO_NODE_HAS_BEARINGS) {
        return RHO_ERROR_TYPE;
    }
    if (status == RHO_OK) {
        status = has_unknown_parts(config) ? RHO_ERROR_CONFIG : init_bearings(node, config);
        node->magic = status == RHO_OK ? RHO_NODE_MAGIC : 0;
    }
    return status;
}

enum rho_status rho_node_init(struct rho_node *node, size_t size,
                              const struct rho_settings *settings)
{
    struct rho_node_config config;
    enum rho_status status = RHO_OK;
    if (!node || !settings) {
        return RHO_ERROR_NULL;
    }
    if (size != sizeof *node) {
        return RHO_ERROR_SIZE;
    }
    /* large parts that are not used are left alone: their pages need no memory then */
    memset(node, 0, offsetof(struct rho_node, report));
    /* both what an operator sets and a snapshot are refused where any setting is */
    if (RHO_MAX_COMMANDS > 0 && rho_settings_check(settings, NULL) != RHO_OK) {
        return RHO_ERROR_CONFIG;
    }
    if (RHO_MAX_ZONES > 0) {
        status = rho_zones_init(NODE_ZONES(node), sizeof *NODE_ZONES(node));
    }
    node->told = node->settings = *settings;
    node->magic = RHO_NODE_MAGIC;
    rho_node_config_default(&config, settings);
    return status == RHO_OK ? rho_node_configure(node, &config) : status;
}

enum rho_status rho_node_add_zone(struct rho_node *node, const struct rho_zone *zone)
{
    const enum rho_status status = node_check(node, node);
    return status != RHO_OK    ? status
           : RHO_MAX_ZONES > 0 ? rho_zones_add(NODE_ZONES(node), zone)
                               : RHO_ERROR_CAPACITY;
}

/* The configurations were taken before: no init can refuse them. */
void rho_node_restart(struct rho_node *node)
{
    (void)!rho_tracker_restart(&node->tracker);
    if (RHO_SEARCHES) {
        (void)!rho_node_windows_init(node, &NODE_INITIATOR(node)->config);
    }
    if (rho_node_is_plots_by_paper(node)) {
        struct rho_paper_starts *starts = NODE_PAPER_STARTS(node);
        (void)!rho_paper_starts_init(starts, sizeof *starts, &starts->config);
    }
    if (RHO_NODE_HAS_PASSIVE) {
        struct rho_passive *passive = NODE_PASSIVE(node);
        (void)!rho_passive_init(passive, sizeof *passive, &passive->config);
    }
    if (rho_node_is_bearings_by_paper(node)) {
        struct rho_passive_paper *paper = NODE_PASSIVE_PAPER(node);
        (void)!rho_passive_paper_init(paper, sizeof *paper, &paper->config);
    }
    node->epoch = node->epoch == INT32_MAX ? 0 : node->epoch + 1;
}

enum rho_status rho_node_reconfigure(struct rho_node *node, const struct rho_node_config *config)
{
    enum rho_status status = node_check(node, config);
    if (status != RHO_OK) {
        return status;
    }
    const struct rho_tracker_config before = node->tracker.config;
    status = rho_tracker_reconfigure(&node->tracker, &config->tracker);
    for (unsigned i = 0; rho_node_window(node, i) && status == RHO_OK; i++) {
        status = rho_initiator_reconfigure(rho_node_window(node, i), &config->initiator);
    }
    if (status != RHO_OK) { /* the first window has refused what all would */
        (void)!rho_tracker_reconfigure(&node->tracker, &before);
    }
    return status;
}
