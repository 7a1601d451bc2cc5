/* SPDX-License-Identifier: MIT */
/* node_sensors: describes sensors to the tracker, which forgets silent ones for want of room. */
#include "node_parts.h"

/* 1 where the assembler has accepted a scan of the sensor in the last jump_max_us. */
static int is_heard(const struct rho_node *node, int32_t sensor_id)
{
    const struct rho_scan_assembler *assembler = &node->assembler;
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_scan_assembler_source *source = &assembler->sources[i];
        if (source->is_used && source->sensor_id == sensor_id &&
            rho_elapsed_us(node->now_us, source->heard_us) <=
                (uint64_t)assembler->config.jump_max_us) {
            return 1;
        }
    }
    return 0;
}

static void forget_silent_sensors(struct rho_node *node)
{
    struct rho_tracker *tracker = &node->tracker;
    for (unsigned i = tracker->num_sensors; i-- > 0;) {
        int32_t sensor_id = tracker->sensors[i].sensor.sensor_id;
        if (!is_heard(node, sensor_id) && rho_tracker_forget_sensor(tracker, sensor_id) == RHO_OK) {
            node->counters.sensors_forgotten = rho_count(node->counters.sensors_forgotten, 1);
        }
    }
}

int rho_node_sensor_describe(struct rho_node *node, const struct rho_sensor *sensor)
{
    enum rho_status status = rho_tracker_set_sensor(&node->tracker, sensor);
    if (status == RHO_ERROR_CAPACITY) {
        forget_silent_sensors(node);
        status = rho_tracker_set_sensor(&node->tracker, sensor);
    }
    node->counters.sensors_refused = rho_count(node->counters.sensors_refused, status != RHO_OK);
    return status == RHO_OK;
}
