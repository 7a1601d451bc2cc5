/* SPDX-License-Identifier: MIT */
/*
 * node_loss_counts: the counts of all losses of a live node with their names, for warnings, the
 * summary and the metrics.
 */
#ifndef RHOTRACK_TOOL_NODE_LOSS_COUNTS_H
#define RHOTRACK_TOOL_NODE_LOSS_COUNTS_H

#include <stdbool.h>
#include <stdint.h>

#include "live/command_gate.h"
#include "live/node_core.h"
#include "transport/transport.h"

#define NODE_TALLIES 38

enum node_tally_kind {
    NODE_TALLY_USUAL = 0, /* counts events of normal operation; no warning */
    NODE_TALLY_FAULT,     /* counts faults of messages or of the network: a rise is a warning */
    /* counts faults that may be undone: a scan counted as lost may still arrive */
    NODE_TALLY_MAY_FALL
};

struct node_loss_counts {
    const char *name;
    uint64_t count;
    enum node_tally_kind kind;
    bool is_of_message; /* the count rises only while a sensor's message is taken */
};

/* Collects all tallies, always in the same order. */
void node_loss_counts_collect(const struct node_core *core, const struct transport *transport,
                              const struct command_gate *gate,
                              struct node_loss_counts tallies[NODE_TALLIES]);

#endif
