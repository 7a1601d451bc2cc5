/* SPDX-License-Identifier: MIT */
/*
 * captured_datagrams: what UDP datagrams carried, from a network recording (pcap or pcapng, as
 * tcpdump and Wireshark write them), in the order in which they were recorded.
 *
 * Read by libpcap. Links: Ethernet with any number of VLAN tags, Linux cooked, raw IP and loopback.
 * Packets of other protocols are passed over. Fragments and packets of which the recording has only
 * the beginning are left out and counted.
 */
#ifndef RHOTRACK_TOOL_CAPTURED_DATAGRAMS_H
#define RHOTRACK_TOOL_CAPTURED_DATAGRAMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whether a plain file begins as a network recording does. */
bool captured_datagrams_is_capture(const char *path);

struct captured_datagrams;

/* Errors: exit 2. */
struct captured_datagrams *captured_datagrams_open(const char *path);

/*
 * The next datagram's content, of at least one byte, valid until the next call. Returns false after
 * the last; a file that ends within a packet is an error, exit 2, but with keep_going it ends
 * there.
 */
bool captured_datagrams_next(struct captured_datagrams *captured, bool keep_going,
                             const uint8_t **data, size_t *size);

/* The number of the packet that was read last, from 1 on, as Wireshark counts. */
uint64_t captured_datagrams_packet_number(const struct captured_datagrams *captured);

/* How many were left out so far, as a part of them is not there. */
uint64_t captured_datagrams_num_incomplete(const struct captured_datagrams *captured);

/* Why it could not be read to its end; NULL: it was. */
const char *captured_datagrams_why_cut(const struct captured_datagrams *captured);

void captured_datagrams_close(struct captured_datagrams *captured);

#endif
