/* SPDX-License-Identifier: MIT */
/*
 * node_tally: everything that a node counts and that says of a loss, by name: for its complaints
 * and its last words.
 */
#ifndef RHOTRACK_TOOL_NODE_TALLY_H
#define RHOTRACK_TOOL_NODE_TALLY_H

#include <stdbool.h>
#include <stdint.h>

#include "live/node_core.h"
#include "transport/transport.h"

#define NODE_TALLIES 41

enum node_tally_kind {
    NODE_TALLY_USUAL = 0, /* of the tracker's usual work, or told otherwise */
    NODE_TALLY_FAULT,     /* of messages or the network */
    NODE_TALLY_MAY_FALL   /* the same, but what it counts may come after all */
};

struct node_tally {
    const char *name;
    uint64_t count;
    enum node_tally_kind kind;
    bool is_of_message; /* it rises where a sensor's message is taken, and nowhere else */
};

/* All of them, always in the same order. */
void node_tally_all(const struct node_core *core, const struct transport *transport,
                    struct node_tally tallies[NODE_TALLIES]);

#endif
