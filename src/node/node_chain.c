/* SPDX-License-Identifier: MIT */
/*
 * node_chain: the chain of a step: initiator, step, starts by the papers' methods, walls, commands,
 * zones. The one place where they follow one another.
 */
#include "node_parts.h"

/* What follows the step and its track starts; commands change the tracks that zones count. */
static enum rho_status end_step(struct rho_node *node, enum rho_status status)
{
    node->counters.steps = rho_count(node->counters.steps, 1);
    node->step = node->step == INT32_MAX ? INT32_MIN : node->step + 1;
    if (RHO_MAX_COMMANDS > 0) {
        rho_node_commands_run(node);
        rho_node_answers_show(node);
    }
    if (RHO_MAX_ZONES > 0 && NODE_ZONES(node)->num_zones > 0) {
        (void)!rho_zones_step(NODE_ZONES(node), &node->report); /* takes any report of a step */
    }
    return status;
}

enum rho_status rho_node_chain_scan(struct rho_node *node, const struct rho_scan *scan, int is_live)
{
    const int is_by_paper = rho_node_is_plots_by_paper(node);
    struct rho_initiator *initiator = NULL;
    enum rho_status status;
    if (RHO_SEARCHES && !is_by_paper) {
        initiator = rho_node_windows_find(node, scan, is_live);
    }
    status = rho_tracker_step(&node->tracker, initiator, scan, &node->report);
    if (status != RHO_OK) {
        node->counters.scans_refused = rho_count(node->counters.scans_refused, 1);
        return status;
    }
    node->done = RHO_NODE_SCAN;
    if (RHO_PAPERS && is_by_paper) {
        status =
            rho_paper_starts_step(NODE_PAPER_STARTS(node), &node->tracker, scan, &node->report);
    }
    if (RHO_LEARNS_REFLECTORS && node->options.learns_reflectors) {
        (void)!rho_reflector_learning_step(NODE_LEARNING(node), &node->tracker, scan,
                                           &node->report); /* the report is of this scan */
    }
    return end_step(node, status);
}

enum rho_status rho_node_chain_bearings(struct rho_node *node, const struct rho_bearing_scan *scan)
{
    const int is_by_paper = rho_node_is_bearings_by_paper(node);
    const enum rho_status status = rho_tracker_step_bearings(
        &node->tracker, is_by_paper ? NULL : NODE_PASSIVE(node), scan, &node->report);
    if (status != RHO_OK) {
        node->counters.bearings_refused = rho_count(node->counters.bearings_refused, 1);
        return status;
    }
    node->done = RHO_NODE_BEARINGS;
    if (is_by_paper && rho_passive_paper_step(NODE_PASSIVE_PAPER(node), &node->tracker, scan,
                                              &node->report) != RHO_OK) {
        /* the sensor is too far from the others, or one too many */
        node->counters.bearings_refused = rho_count(node->counters.bearings_refused, 1);
    }
    return end_step(node, RHO_OK);
}

/* Begins a step that the caller asks for: the last one's messages are gone. */
static enum rho_status begin_step(struct rho_node *node, const void *given)
{
    const enum rho_status status = node_check(node, given);
    if (status == RHO_OK) {
        rho_node_answers_drop(node);
        node->done = RHO_NODE_NOTHING;
    }
    return status;
}

enum rho_status rho_node_step_scan(struct rho_node *node, const struct rho_scan *scan)
{
    const enum rho_status status = begin_step(node, scan);
    return status == RHO_OK ? rho_node_chain_scan(node, scan, 0) : status;
}

enum rho_status rho_node_step_bearings(struct rho_node *node, const struct rho_bearing_scan *scan)
{
    const enum rho_status status = begin_step(node, scan);
    return status != RHO_OK        ? status
           : RHO_NODE_HAS_BEARINGS ? rho_node_chain_bearings(node, scan)
                                   : RHO_ERROR_TYPE;
}
