/* SPDX-License-Identifier: MIT */
/*
 * senders: who sends a sensor's messages. A sensor that is sent from two places at once is named:
 * its scans are mixed, and each sender's look like the other's restart. That is certain once the
 * first one is heard again, which may take a turn of the radar; so another sender is told at once
 * where the first one has been silent for no longer than such a turn. A sender that is started anew
 * has another port, and the one before is not heard again: that is none.
 */
#ifndef RHOTRACK_TOOL_SENDERS_H
#define RHOTRACK_TOOL_SENDERS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "transport/transport.h"

enum { SENDERS_CHANNELS = 64, SENDERS_NODES = 8, SENDERS_LINES = 8 };

struct sender_channel {
    char name[64];
    struct transport_sender last, before; /* of its messages: of other addresses or ports */
    bool is_named;                        /* this pair */
    int64_t heard_us, longest_us;         /* the last one, and its longest pause; 0: not known */
    int64_t told_us;                      /* of another sender; 0: never */
};

/* All zero at the start. Channels beyond SENDERS_CHANNELS are not watched. */
struct senders {
    unsigned num_channels, num_nodes;
    int64_t lines_us; /* clock_us: from here on they count */
    unsigned lines;
    struct sender_channel channels[SENDERS_CHANNELS];
    struct transport_sender nodes[SENDERS_NODES]; /* those that were named */
};

/* False: no sensor's channel. Anyone on the network names channels. */
bool senders_read_sensor_id(const char *channel, int16_t *sensor_id);

/*
 * A message has come. One line where a second sender of a sensor is certain, as the first one is
 * heard again, or another node publishes: once a pair, once a node, and SENDERS_LINES a second at
 * most. One line a minute of a sensor where it may be.
 *   now_us  clock_us; above 0
 *   to      NULL: nothing is written
 */
void senders_note_message(struct senders *senders, const struct transport_message *message,
                          int64_t now_us, FILE *to);

#endif
