/* SPDX-License-Identifier: MIT */
/*
 * prometheus_metrics: all counters and measured values of a live node, in the Prometheus text
 * format, version 0.0.4. Names begin with rhotrack_ and end with a unit; each has HELP and TYPE
 * lines.
 */
#ifndef RHOTRACK_TOOL_PROMETHEUS_METRICS_H
#define RHOTRACK_TOOL_PROMETHEUS_METRICS_H

#include <stdio.h>

#include "live/command_gate.h"
#include "live/node_core.h"
#include "settings/parameters.h"
#include "transport/transport.h"

/* Objects and counts of a node from which the metrics are written. */
struct prometheus_metrics_source {
    const struct node_core *core;
    const struct transport *transport;
    const struct command_gate *gate;
    const struct parameters *parameters; /* parameters at the start: names of sensors */
    bool is_publishing;                  /* false: another node does (--standby) */
    uint64_t messages_in;                /* messages received, without those that nodes publish */
    struct node_core_losses losses;      /* losses of the node's inputs and outputs */
    /* answers with this page; refused requests and slow clients */
    uint64_t pages_sent, clients_refused;
};

void prometheus_metrics_write(FILE *out, const struct prometheus_metrics_source *source);

#endif
