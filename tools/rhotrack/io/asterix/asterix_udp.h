/* SPDX-License-Identifier: MIT */
/*
 * asterix_udp: datagrams in ASTERIX from the network. A datagram holds whole data blocks, one or
 * more.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_UDP_H
#define RHOTRACK_TOOL_ASTERIX_UDP_H

#include "io/asterix/asterix_scans.h"

/* Whether an input is a place to listen at: udp://ADDRESS:PORT. */
bool asterix_udp_is_url(const char *text);

/*
 * A socket that hears what is sent to a multicast group (on the loopback where no route leads to
 * it, with a note), or to an address of this machine; udp://:PORT: to any. Errors: exit 2 of the
 * URL, 1 of the network.
 */
int asterix_udp_open(const char *url);

/* Of datagrams. */
struct asterix_heard {
    uint64_t datagrams, bad; /* bad: with a place that cannot be read; what is before it counts */
    uint64_t others;         /* blocks of categories that are not read */
};

/* Takes the records of a datagram. Any bytes will do. */
void asterix_datagram_take_records(struct asterix_scans *scans, const uint8_t *data, size_t size,
                                   struct asterix_heard *heard);

#endif
