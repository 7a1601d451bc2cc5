/* SPDX-License-Identifier: MIT */
/*
 * standby: two nodes of which one publishes. A node with --standby hears the same sensors, keeps
 * its own tracks, and publishes nothing while another node does. Where that has been silent for
 * STANDBY_SILENT_US it publishes itself. Each node has an epoch of its own, so that no two lists
 * are of one epoch and step.
 *
 *     standby_note_message(&standby, &message, now_us);     for each message that is received
 *     standby_hear(&standby, &message, now_us, &epoch, to); for each one of another node
 *     if (standby_take_turn(&standby, is_all, now_us, to))  once in each turn: it publishes anew
 *     if (standby_may_send(&standby, now_us))               before each message is sent
 *
 * Where two publish, after a cut cable, one that heard nobody meanwhile falls silent, as its tracks
 * are old, and so does one that has just begun; another one only if it is spoken against for
 * STANDBY_RIVAL_US, as by a node without --standby. A node that was stopped for STANDBY_STOPPED_US
 * (a debugger, a suspended machine) publishes again when it has read all that was said, if no other
 * node was among it.
 *
 * Nothing proves who publishes: a forged datagram each two seconds keeps such a node silent
 * (SECURITY.md).
 */
#ifndef RHOTRACK_TOOL_STANDBY_H
#define RHOTRACK_TOOL_STANDBY_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "transport/transport.h"

enum {
    STANDBY_SILENT_US = 2100000,  /* two words of a node, one a second, and what they take */
    STANDBY_CHANCE_US = 250000,   /* longer by up to so much: of two, one is the first */
    STANDBY_TURN_US = 250000,     /* a turn at least each, so that a stop shows */
    STANDBY_STOPPED_US = 1000000, /* less than what the other one waits after a last word */
    STANDBY_DEAF_US = 1500000,    /* heard nobody for so long: it was cut off */
    STANDBY_RIVAL_US = 1500000    /* the other one has had a word of this one, and goes on */
};

/* All zero: a node without --standby, which publishes always. */
struct standby {
    bool is_on;
    bool is_publishing;
    bool was_stopped;              /* and may not yet have read all that was said meanwhile */
    bool is_heard;                 /* another node, `other`, is why it is silent */
    struct transport_sender other; /* the node heard last */
    int64_t began_us;              /* monotonic time at which it began to publish */
    int64_t heard_us;              /* monotonic times: another node's last word, or the start */
    int64_t wait_us;               /* of silence after heard_us */
    int64_t turn_us;               /* of the last message or turn */
    int64_t any_us, deaf_us; /* of the last message of others; of the last one after a pause */
    int64_t rival_us;        /* the first word of another one that publishes as well */
};

/*
 * A node with --standby, silent at first. Exit 2 where the transport of the URL does not tell
 * senders.
 */
struct standby standby_open(int64_t now_us, const char *url);

/*
 * Takes note of a message of another node; prints a line where this one falls silent by it. Returns
 * true where the message tells the other's epoch, and this node is silent.
 */
bool standby_hear(struct standby *standby, const struct transport_message *message, int64_t now_us,
                  int32_t *epoch, FILE *to);

/*
 * True where the node begins to publish, or does so again after a stop: it tells its state at once
 * then. Prints a line where it begins.
 *   has_read_all  no message is left to receive
 */
bool standby_take_turn(struct standby *standby, bool has_read_all, int64_t now_us, FILE *to);

/* Takes note of a message of whomever, before standby_hear. */
void standby_note_message(struct standby *standby, const struct transport_message *message,
                          int64_t now_us);

bool standby_may_send(const struct standby *standby, int64_t now_us);

/* Monotonic time of the next turn at the latest; INT64_MAX: none is due. */
int64_t standby_due_us(const struct standby *standby);

#endif
