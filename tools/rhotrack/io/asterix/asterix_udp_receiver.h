/* SPDX-License-Identifier: MIT */
/*
 * asterix_udp_receiver: receives ASTERIX datagrams from the network. A datagram holds one or more
 * whole data blocks.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_UDP_RECEIVER_H
#define RHOTRACK_TOOL_ASTERIX_UDP_RECEIVER_H

#include "io/asterix/asterix_scans.h"

/* Whether an input is an address to receive from: udp://ADDRESS:PORT. */
bool asterix_udp_receiver_is_url(const char *text);

/*
 * Opens a socket that receives datagrams sent to a multicast group (on the loopback where no route
 * leads to it, with a note), or to an address of this machine; udp://:PORT: to any. Errors: exit 2
 * for a bad URL, 1 for a failure of the network.
 */
int asterix_udp_receiver_open(const char *url);

/* Counts of the datagrams received. */
struct asterix_datagram_counts {
    uint64_t datagrams, bad; /* bad: with an unreadable place, before which records count */
    uint64_t others;         /* blocks of categories that are not read */
};

/* Passes the records of a datagram to the assembly of scans. Accepts any bytes. */
void asterix_datagram_take_records(struct asterix_scans *scans, const uint8_t *data, size_t size,
                                   struct asterix_datagram_counts *heard);

#endif
