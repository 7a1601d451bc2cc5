/* SPDX-License-Identifier: MIT */
/*
 * node_sensors: says when a sensor of a live tracker becomes suspect or falls silent, and when
 * that is over; each change once. A sensor that has sent too few scans to be believed is not spoken
 * of: anybody may send one.
 */
#ifndef RHOTRACK_TOOL_NODE_SENSORS_H
#define RHOTRACK_TOOL_NODE_SENSORS_H

#include <stdbool.h>
#include <stdio.h>

#include "live/node_core.h"

struct node_sensor {
    int16_t sensor_id;
    int8_t kind; /* of sensor_t */
    bool is_doubted, is_silent, has_two_senders;
};

/* The sensors as they were last; all zero at the start. */
struct node_sensors {
    unsigned count;
    struct node_sensor of[RHO_MAX_SENSORS];
};

/* The sensors of node_core_list_sensors that have sent follow_scans scans. Returns their number. */
unsigned node_sensors_established(const struct node_core *core,
                                  struct rho_message_sensor sensors[RHO_MAX_SENSORS]);

/* One line a change since the last call; NULL: nothing is written. */
void node_sensors_print_changes(struct node_sensors *sensors, const struct node_core *core,
                                FILE *to);

/* The last words: one line a sensor that is suspect or silent. */
void node_sensors_print_bad(const struct node_core *core, FILE *to);

#endif
