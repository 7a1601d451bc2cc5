/* SPDX-License-Identifier: MIT */
/* node_step: what the node's parts for plots and for bearings have in common. */
#ifndef NODE_STEP_H
#define NODE_STEP_H

#include "rhotrack/tracker.h"

/* The searches of a step; either may be NULL. */
struct node_searched {
    const struct rho_initiator *initiator;
    const struct rho_passive *passive;
};

/* One step of the tracker, with its messages. */
void node_step_scan(const struct rho_scan *scan);
void node_step_frame(struct rho_passive *passive, const struct rho_frame *frame);

/* The sensors' clock was set: tracks do not go on across that, the tracker's counters do. */
void node_restart(void);

/* Tells the tracker who saw a scan. Returns 0 where it has no room for another sensor. */
int node_describe(const struct rho_sensor *sensor);

#endif
