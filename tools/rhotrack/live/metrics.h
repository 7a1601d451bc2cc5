/* SPDX-License-Identifier: MIT */
/*
 * metrics: all that a node counts and measures, in the text form of Prometheus, version 0.0.4.
 * Names begin with rhotrack_, units are in the names, and each has its HELP and TYPE.
 */
#ifndef RHOTRACK_TOOL_METRICS_H
#define RHOTRACK_TOOL_METRICS_H

#include <stdio.h>

#include "live/node_core.h"
#include "settings/parameters.h"
#include "transport/transport.h"

/* What the parts of a node know. */
struct metrics_source {
    const struct node_core *core;
    const struct transport *transport;
    const struct parameters *parameters;  /* as it was started: names of sensors */
    uint64_t messages_in;                 /* of other programs */
    struct node_core_losses losses;       /* of inputs and outputs */
    uint64_t pages_sent, clients_refused; /* of this text */
};

void metrics_write(FILE *out, const struct metrics_source *source);

#endif
