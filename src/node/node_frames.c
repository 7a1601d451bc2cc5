/* SPDX-License-Identifier: MIT */
/* node_frames: scans of bearings to frames; when a frame closes, and when all begin anew. */
#include "node_parts.h"

/*
 * Makes the first frame wait for the largest number of passive sensors, until a scan of the next
 * frame comes or its time has passed: the number of sensors is unknown, and a frame closed by the
 * second sensor would make the scans of all others out of sequence.
 */
void rho_node_frames_reset(struct rho_node *node)
{
    struct rho_frames *frames = NODE_FRAMES(node);
    if (RHO_NODE_HAS_BEARINGS) {
        struct rho_frames_counters counters = frames->counters;
        (void)!rho_frames_init(frames, sizeof *frames, &frames->config);
        frames->config.sensors_min = RHO_MAX_PASSIVE_SENSORS;
        counters.scans_taken = 0; /* 0 tells the frames that they have no clock yet */
        frames->counters = counters;
    }
}

void rho_node_frames_restart(struct rho_node *node)
{
    if (RHO_NODE_HAS_PASSIVE) {
        struct rho_passive *passive = NODE_PASSIVE(node);
        (void)!rho_passive_init(passive, sizeof *passive, &passive->config);
    }
    if (rho_node_is_bearings_by_paper(node)) {
        struct rho_passive_paper *paper = NODE_PASSIVE_PAPER(node);
        (void)!rho_passive_paper_init(paper, sizeof *paper, &paper->config);
    }
}

const struct rho_frames_slot *rho_node_frames_open(const struct rho_node *node)
{
    const struct rho_frames *frames = NODE_FRAMES(node);
    return RHO_NODE_HAS_BEARINGS && frames->slots[frames->open].num_scans > 0
               ? &frames->slots[frames->open]
               : NULL;
}

int rho_node_frames_close(struct rho_node *node)
{
    node->frame_due_us = INT64_MAX;
    if (!rho_node_frames_open(node) || rho_frames_close(NODE_FRAMES(node)) != RHO_OK) {
        return 0;
    }
    node->has_closed = NODE_FRAME_CLOSED;
    return 1;
}

/*
 * 1 where a scan's sensor is near enough to all sensors of the frames: a search refuses frames
 * whose sensors are farther apart than its cells reach.
 */
static int is_near_others(const struct rho_node *node, const struct rho_bearing_scan *scan)
{
    const struct rho_frames *frames = NODE_FRAMES(node);
    const float apart_max_m = rho_node_is_bearings_by_paper(node)
                                  ? NODE_PASSIVE_PAPER(node)->batch.apart_max_m
                              : RHO_NODE_HAS_PASSIVE ? NODE_PASSIVE(node)->batch.apart_max_m
                                                     : RANGE_UNKNOWN_M;
    for (unsigned i = 0; i < frames->num_sensors; i++) {
        const struct rho_frames_sensor *other = &frames->sensors[i];
        const float x_m = other->x_m - scan->x_m, y_m = other->y_m - scan->y_m;
        if (other->sensor_id != scan->sensor_id &&
            x_m * x_m + y_m * y_m > apart_max_m * apart_max_m) {
            return 0;
        }
    }
    return 1;
}

/* Adds a scan to the open frame or the next one; returns 0 where it is refused. */
static int add_to_frame(struct rho_node *node, const struct rho_bearing_scan *scan)
{
    struct rho_frames *frames = NODE_FRAMES(node);
    if (!is_near_others(node, scan) || rho_frames_push(frames, scan) != RHO_OK) {
        return 0;
    }
    node->has_closed = frames->has_closed ? NODE_FRAME_CLOSED : NODE_FRAME_NONE;
    return 1;
}

/* Whether the frames are to begin anew: a silent sensor keeps the refused scan's sensor out. */
static int must_reset_after_refusal(const struct rho_node *node,
                                    const struct rho_bearing_scan *scan)
{
    const struct rho_frames *frames = NODE_FRAMES(node);
    for (unsigned i = 0; i < frames->num_sensors; i++) {
        int32_t sensor_id = frames->sensors[i].sensor_id;
        if (sensor_id != scan->sensor_id && !rho_node_sensor_is_heard(node, sensor_id)) {
            return 1;
        }
    }
    return 0;
}

static void describe_sensor(struct rho_node *node)
{
    struct rho_sensor sensor = node->item.sensor;
    if (node->item.has_sensor) {
        if (node->passive_range_max_m > 0.0f && sensor.range_max_m >= RANGE_UNKNOWN_M) {
            sensor.range_max_m = node->passive_range_max_m;
        }
        (void)rho_node_sensor_describe(node, &sensor);
    }
}

/* The open frame closes when no scan has come for tolerance_us and hold_us together. */
static void set_due_time(struct rho_node *node, int64_t now_us)
{
    int64_t hold_us = node->assembler.config.hold_us;
    int64_t wait_us = hold_us + NODE_FRAMES(node)->config.tolerance_us;
    node->frame_due_us = rho_node_frames_open(node) && hold_us > 0 && now_us < INT64_MAX - wait_us
                             ? now_us + wait_us
                             : INT64_MAX;
}

void rho_node_frames_push(struct rho_node *node, int64_t now_us)
{
    const struct rho_bearing_scan *scan = &node->item.bearings;
    int is_again = node->is_forgetting;
    node->is_forgetting = 0;
    if (RHO_NODE_HAS_BEARINGS && is_again) {
        rho_node_frames_reset(node);
        rho_node_frames_restart(node);
    }
    if (RHO_NODE_HAS_BEARINGS && add_to_frame(node, scan)) {
        describe_sensor(node);
        set_due_time(node, now_us);
    } else if (!is_again) {
        node->counters.bearings_refused = rho_count(node->counters.bearings_refused, 1);
        if (RHO_NODE_HAS_BEARINGS && must_reset_after_refusal(node, scan)) {
            node->is_forgetting = 1;
            (void)rho_node_frames_close(node);
        }
    }
    node->has_item = node->is_forgetting;
}
