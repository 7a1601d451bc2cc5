/* SPDX-License-Identifier: MIT */
/*
 * duplicate_senders: warns where two programs send as the same sensor. Their scans are mixed, and
 * each one's scans look like a restart of the other. Two senders are certain once the first is
 * heard again after the second, which may take a revolution of the radar; so a new sender is
 * already reported as possible where the first was heard within one revolution. A restarted sender
 * has a new port, and its old one stays silent: that is no second sender.
 */
#ifndef RHOTRACK_TOOL_DUPLICATE_SENDERS_H
#define RHOTRACK_TOOL_DUPLICATE_SENDERS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "transport/transport.h"

enum { SENDERS_CHANNELS = 64, SENDERS_NODES = 8, SENDERS_LINES = 8 };

struct sender_channel {
    char name[64];
    struct transport_sender last, before; /* the channel's last sender, and the one before */
    bool is_named;                        /* a warning of this pair of senders was printed */
    int64_t since_us;                     /* monotonic time of the first message */
    int64_t heard_us;                     /* monotonic time of the last message; 0: none yet */
    /* monotonic time of the warning of a possible second sender; 0: never */
    int64_t told_us;
};

/*
 * Senders of channels and nodes; all zero at the start. Beyond SENDERS_CHANNELS a new channel takes
 * the place of the channel heard longest ago, if that is a minute; else that of the last channel of
 * the sender with the most, if that has more than the new one's sender; else it is ignored. So
 * sensors that are heard keep their places, and a stranger takes no more than are left.
 */
struct duplicate_senders {
    unsigned num_channels, num_nodes;
    /* monotonic time from which `lines` counts the lines printed within a second */
    int64_t lines_us;
    unsigned lines;
    struct sender_channel channels[SENDERS_CHANNELS];
    struct transport_sender nodes[SENDERS_NODES]; /* ring of nodes that were reported */
};

/* Parses a sensor's number from its channel's name; false where the channel is not a sensor's. */
bool duplicate_senders_sensor_id(const char *channel, int16_t *sensor_id);

/*
 * Takes note of a message's sender. Prints a line once per pair where a second sender of a sensor
 * is certain, once a minute where it is possible, and once per other node that publishes; at most
 * SENDERS_LINES lines a second.
 *   now_us  monotonic time (monotonic_clock_us), above 0
 *   to      NULL: prints nothing
 */
void duplicate_senders_note_message(struct duplicate_senders *senders,
                                    const struct transport_message *message, int64_t now_us,
                                    FILE *to);

#endif
