/* SPDX-License-Identifier: MIT */
/* node_messages: what a node publishes, after each step and from time to time. */
#include "../wire/message_clamps.h"
#include "node_parts.h"
#include "rhotrack/publish.h"

static unsigned num_answers(const struct rho_node *node)
{
    return RHO_MAX_COMMANDS > 0 ? NODE_OPERATOR(node)->num_shown : 0;
}

static unsigned num_bodies(const struct rho_node *node)
{
    return RHO_BODIES ? rho_publish_num_body_parts(&node->tracker, &node->report) : 0;
}

static unsigned num_events(const struct rho_node *node)
{
    return RHO_MAX_ZONES > 0 && NODE_ZONES(node)->num_zones > 0 && NODE_ZONES(node)->num_events > 0;
}

uint16_t rho_node_num_messages(const struct rho_node *node)
{
    unsigned num = 0;
    if (rho_node_is_ready(node)) {
        num = num_answers(node);
        if (node->done == RHO_NODE_SCAN || node->done == RHO_NODE_BEARINGS) {
            num += rho_publish_num_parts(&node->report) + 1u + num_bodies(node) + num_events(node);
        }
    }
    return (uint16_t)num;
}

const char *rho_node_channel(const struct rho_node *node, uint16_t part)
{
    unsigned of, peaks;
    if (part >= rho_node_num_messages(node)) {
        return NULL;
    }
    of = part - num_answers(node);
    peaks = rho_publish_num_parts(&node->report);
    if (RHO_MAX_COMMANDS > 0 && part < num_answers(node)) {
        return NODE_OPERATOR(node)->answers[part].is_setting ? RHO_MESSAGE_SETTING_ANSWER_CHANNEL
                                                             : RHO_MESSAGE_COMMAND_ANSWER_CHANNEL;
    }
    if (RHO_BODIES && of > peaks && of <= peaks + num_bodies(node)) {
        return RHO_MESSAGE_BODY_LIST_CHANNEL;
    }
    if (RHO_MAX_ZONES > 0 && of > peaks) {
        return RHO_MESSAGE_ZONE_EVENT_LIST_CHANNEL;
    }
    return of < peaks ? RHO_MESSAGE_TRACK_LIST_CHANNEL : RHO_MESSAGE_PEAK_LIST_CHANNEL;
}

static enum rho_status publish_events(const struct rho_node *node, uint8_t *buffer, size_t capacity,
                                      size_t *size)
{
    struct rho_message_zone_event_list list;
    rho_publish_zone_events(NODE_ZONES(node), &list);
    list.scan = node->step;
    list.epoch = node->epoch;
    return rho_message_zone_event_list_encode(&list, buffer, capacity, size);
}

/* The candidates of the search that the last step made; of the papers' methods there are none. */
static enum rho_status publish_peaks(const struct rho_node *node, uint8_t *buffer, size_t capacity,
                                     size_t *size)
{
    const int is_bearings = RHO_NODE_HAS_BEARINGS && node->done == RHO_NODE_BEARINGS;
    const struct rho_initiator *initiator =
        RHO_SEARCHES && !is_bearings ? rho_node_windows_newest(node) : NULL;
    const struct rho_passive *passive =
        RHO_NODE_HAS_PASSIVE && is_bearings && !rho_node_is_bearings_by_paper(node)
            ? NODE_PASSIVE(node)
            : NULL;
    return rho_publish_peaks(initiator, passive, node->report.time_us, node->step, buffer, capacity,
                             size);
}

enum rho_status rho_node_publish(const struct rho_node *node, uint16_t part, uint8_t *buffer,
                                 size_t capacity, size_t *size)
{
    unsigned of = part, peaks;
    if (!rho_node_is_ready(node)) {
        return node ? RHO_ERROR_STATE : RHO_ERROR_NULL;
    }
    if (part >= rho_node_num_messages(node)) {
        return RHO_ERROR_VALUE;
    }
    if (RHO_MAX_COMMANDS > 0 && of < num_answers(node)) {
        const struct rho_node_answer *answer = &NODE_OPERATOR(node)->answers[of];
        return answer->is_setting
                   ? rho_message_setting_answer_encode(&answer->setting, buffer, capacity, size)
                   : rho_message_command_answer_encode(&answer->command, buffer, capacity, size);
    }
    of -= num_answers(node);
    peaks = rho_publish_num_parts(&node->report);
    if (of < peaks) {
        return rho_publish_tracks(&node->report, node->step, node->epoch, (uint16_t)of, buffer,
                                  capacity, size);
    }
    if (RHO_BODIES && of > peaks && of <= peaks + num_bodies(node)) {
        return rho_publish_bodies(&node->tracker, &node->report, node->step, node->epoch,
                                  (uint16_t)(of - peaks - 1u), buffer, capacity, size);
    }
    if (RHO_MAX_ZONES > 0 && of > peaks) {
        return publish_events(node, buffer, capacity, size);
    }
    return publish_peaks(node, buffer, capacity, size);
}

void rho_node_status(struct rho_node *node, struct rho_message_status *status)
{
    if (!rho_node_is_ready(node) || !status) {
        return;
    }
    rho_publish_status(&node->assembler, &node->tracker,
                       RHO_SEARCHES ? rho_node_windows_newest(node) : NULL, status);
    status->scan = node->step;
    status->epoch = node->epoch;
    status->plots_in = rho_clamp_sum_to_int32(status->plots_in, node->counters.plots_refused);
    status->inputs_no_room =
        rho_clamp_sum_to_int32(status->inputs_no_room, node->counters.plots_refused);
    if (node->timing.steps > 0) {
        status->step_us = (float)node->timing.sum_us / (float)node->timing.steps;
        status->step_max_us = (float)node->timing.max_us;
    }
    node->timing = (struct rho_node_timing){0};
}

void rho_node_work(const struct rho_node *node, struct rho_message_work *work)
{
    if (rho_node_is_ready(node) && work) {
        rho_publish_work(&node->tracker, work);
        work->scan = node->step;
        work->epoch = node->epoch;
        work->num_steps = node->counters.steps;
    }
}

int rho_node_learned(struct rho_node *node, struct rho_message_learned *learned)
{
    const struct rho_tracker *tracker = rho_node_is_ready(node) ? &node->tracker : NULL;
    const unsigned place =
        tracker && node->next_learned < tracker->num_sensors ? node->next_learned : 0;
    if (!rho_publish_learned(tracker, place, learned)) {
        return 0;
    }
    node->next_learned = (uint8_t)(place + 1u);
    learned->scan = node->step;
    learned->epoch = node->epoch;
    return 1;
}

enum rho_status rho_node_life(const struct rho_node *node, uint16_t part, uint8_t *buffer,
                              size_t capacity, size_t *size)
{
    if (!rho_node_is_ready(node)) {
        return node ? RHO_ERROR_STATE : RHO_ERROR_NULL;
    }
    return rho_publish_life(&node->tracker, node->step, node->epoch, part, buffer, capacity, size);
}
