/* SPDX-License-Identifier: MIT */
/*
 * node_sensor_warnings: prints when a sensor of a live node becomes suspect or silent, or its clock
 * is off the others', and when that ends, once per change. A sensor is reported after follow_scans
 * scans: anyone on the network can send a few.
 */
#ifndef RHOTRACK_TOOL_NODE_SENSOR_WARNINGS_H
#define RHOTRACK_TOOL_NODE_SENSOR_WARNINGS_H

#include <stdbool.h>
#include <stdio.h>

#include "live/node_core.h"

struct node_sensor {
    int16_t sensor_id;
    int8_t kind; /* kind of measurements, as in sensor_t */
    bool is_doubted, is_silent, has_two_senders, is_off_clock;
};

/* States of the sensors at the last call; all zero at the start. */
struct node_sensors {
    unsigned count;
    struct node_sensor of[RHO_MAX_SENSORS];
};

/*
 * Lists the sensors of node_core_list_sensors that have sent at least follow_scans scans. Returns
 * their number.
 */
unsigned node_sensors_list_established(const struct node_core *core,
                                       struct rho_message_sensor sensors[RHO_MAX_SENSORS]);

/*
 * Prints one line for each change of a sensor's state since the last call; `to` NULL: prints
 * nothing.
 */
void node_sensors_print_changes(struct node_sensors *sensors, const struct node_core *core,
                                FILE *to);

/* For the summary at the end: prints one line for each sensor that is not well. */
void node_sensors_print_all(const struct node_core *core, FILE *to);

#endif
