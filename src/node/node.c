/* SPDX-License-Identifier: MIT */
/* node: messages in, and what is stepped next: scans of plots or bearings, restarts. */
#include "rhotrack/node.h"

#include "node_parts.h"

/*
 * Values of is_making_room: when the assembler has no room for a message (WANTED), one scan is
 * stepped (MADE), and the caller gives the message again.
 */
enum { ROOM_ENOUGH = 0, ROOM_WANTED, ROOM_MADE };

/* Refuses a scan whose sensor the tracker does not take: the sensor's position would be unknown. */
static enum rho_node_due give_scan(struct rho_node *node)
{
    const struct rho_scan_assembler_item *item = &node->item;
    if (item->has_sensor && !rho_node_sensor_describe(node, &item->sensor)) {
        node->counters.scans_refused = rho_count(node->counters.scans_refused, 1);
        node->counters.plots_refused =
            rho_count(node->counters.plots_refused, item->scan.num_plots);
        return RHO_NODE_NOTHING;
    }
    node->scan = item->scan;
    return RHO_NODE_SCAN;
}

/* A bearing scan says its sensor's place itself. */
static enum rho_node_due give_bearings(struct rho_node *node)
{
    struct rho_sensor sensor = node->item.sensor;
    if (node->item.has_sensor) {
        if (node->passive_range_max_m > 0.0f && sensor.range_max_m >= RANGE_UNKNOWN_M) {
            sensor.range_max_m = node->passive_range_max_m;
        }
        (void)rho_node_sensor_describe(node, &sensor);
    }
    return RHO_NODE_BEARINGS;
}

/* Takes the fetched scan, after the restart that it tells. */
static enum rho_node_due take_item(struct rho_node *node)
{
    if (node->item.is_restart) {
        node->item.is_restart = 0;
        return RHO_NODE_RESTART;
    }
    node->has_item = 0;
    if (!RHO_SCAN_ASSEMBLER_IS(node->item.kind, RHO_SCAN_ASSEMBLER_BEARINGS)) {
        return give_scan(node);
    }
    return RHO_NODE_HAS_BEARINGS ? give_bearings(node) : RHO_NODE_NOTHING;
}

/* 1 where the first scan after a snapshot is jump_max_us older: it is of another clock. */
static int is_of_another_clock(const struct rho_node *node)
{
    const struct rho_tracker *tracker = &node->tracker;
    int64_t time_us = RHO_SCAN_ASSEMBLER_IS(node->item.kind, RHO_SCAN_ASSEMBLER_BEARINGS)
                          ? node->item.bearings.time_us
                          : node->item.scan.time_us;
    return node->is_restored && tracker->has_time &&
           time_us < tracker->time_us - node->assembler.config.jump_max_us;
}

/* Fetches a due scan. Returns 0 where none is due. */
static int fetch_item(struct rho_node *node, int64_t now_us)
{
    struct rho_scan_assembler *assembler = &node->assembler;
    const uint8_t room = node->is_making_room;
    node->is_making_room = room == ROOM_WANTED ? ROOM_MADE : ROOM_ENOUGH;
    if (room == ROOM_MADE) {
        return 0;
    }
    if (rho_scan_assembler_next(assembler, now_us, &node->item)) {
        if (room == ROOM_WANTED && assembler->is_pressed &&
            now_us - node->item.heard_us < assembler->config.hold_us) {
            node->counters.scans_early = rho_count(node->counters.scans_early, 1);
        }
        node->item.is_restart |= is_of_another_clock(node);
        node->is_restored = 0;
        node->has_item = 1;
        return 1;
    }
    return 0;
}

static void do_due(struct rho_node *node, enum rho_node_due due)
{
    if (due == RHO_NODE_RESTART) {
        rho_node_commands_refuse(node, INT64_MAX);
        node->counters.restarts = rho_count(node->counters.restarts, 1);
        rho_node_restart(node);
        node->done = RHO_NODE_RESTART;
    } else if (due == RHO_NODE_SCAN) {
        (void)!rho_node_chain_scan(node, &node->scan, 1); /* `done` says whether it was stepped */
    } else if (RHO_NODE_HAS_BEARINGS) {
        (void)!rho_node_chain_bearings(node, &node->item.bearings); /* likewise */
    }
}

/* Goes on until something is done, or nothing is due. */
static void do_next(struct rho_node *node, int64_t now_us)
{
    int has_more = 1;
    while (has_more && node->done == RHO_NODE_NOTHING) {
        enum rho_node_due due = RHO_NODE_NOTHING;
        if (node->has_item) {
            due = take_item(node);
        } else {
            has_more = fetch_item(node, now_us);
        }
        if (due != RHO_NODE_NOTHING) {
            do_due(node, due);
        }
    }
}

enum rho_node_due rho_node_next(struct rho_node *node, int64_t now_us)
{
    if (!rho_node_is_ready(node)) {
        return RHO_NODE_NOTHING;
    }
    if (now_us != INT64_MAX) {
        node->now_us = now_us;
    }
    rho_node_answers_drop(node);
    if (now_us > INT64_MIN + COMMAND_WAIT_US) {
        rho_node_commands_refuse(node, now_us - COMMAND_WAIT_US);
    }
    node->done = RHO_MAX_COMMANDS > 0 && NODE_OPERATOR(node)->num_answers > 0 ? RHO_NODE_ANSWER
                                                                              : RHO_NODE_NOTHING;
    do_next(node, now_us);
    rho_node_answers_show(node);
    return (enum rho_node_due)node->done;
}

enum rho_status rho_node_take(struct rho_node *node, const char *channel, const uint8_t *data,
                              size_t size, int64_t now_us)
{
    enum rho_status status;
    if (!rho_node_is_ready(node)) {
        return node ? RHO_ERROR_STATE : RHO_ERROR_NULL;
    }
    if (RHO_MAX_COMMANDS > 0 && channel && data &&
        rho_node_commands_take(node, channel, data, size, now_us)) {
        return RHO_OK;
    }
    node->now_us = now_us;
    status = rho_scan_assembler_take(&node->assembler, channel, data, size, now_us);
    node->is_making_room = status == RHO_ERROR_CAPACITY ? ROOM_WANTED : ROOM_ENOUGH;
    return status;
}

int64_t rho_node_due_us(const struct rho_node *node)
{
    int64_t due_us = INT64_MAX;
    if (rho_node_is_ready(node)) {
        due_us = rho_scan_assembler_due_us(&node->assembler);
        due_us = rho_node_answers_due(node, due_us);
    }
    return due_us;
}

void rho_node_count_time(struct rho_node *node, int64_t took_us)
{
    uint32_t step_us = took_us < 0 ? 0 : took_us < INT32_MAX ? (uint32_t)took_us : INT32_MAX;
    if (node) {
        node->timing.sum_us = rho_count(node->timing.sum_us, step_us);
        node->timing.max_us = step_us > node->timing.max_us ? step_us : node->timing.max_us;
        node->timing.steps++;
    }
}
