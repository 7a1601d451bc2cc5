/* SPDX-License-Identifier: MIT */
/*
 * captured_datagrams: the contents of the UDP datagrams of a network recording (pcap or pcapng, as
 * tcpdump and Wireshark write them), in the recorded order.
 *
 * Recordings are read by libpcap. Links: Ethernet with any number of VLAN tags, Linux cooked, raw
 * IP and loopback. Packets of other protocols are skipped. Fragments and packets that the recording
 * cut short are left out and counted.
 */
#ifndef RHOTRACK_TOOL_CAPTURED_DATAGRAMS_H
#define RHOTRACK_TOOL_CAPTURED_DATAGRAMS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whether a plain file begins like a network recording. */
bool captured_datagrams_is_capture(const char *path);

struct captured_datagrams;

/* Opens a network recording. Errors: exit 2. */
struct captured_datagrams *captured_datagrams_open(const char *path);

/*
 * Reads the next datagram's content, of at least one byte, valid until the next call. Returns false
 * after the last. A file that ends within a packet: exit 2, or with keep_going it ends there.
 */
bool captured_datagrams_next(struct captured_datagrams *captured, bool keep_going,
                             const uint8_t **data, size_t *size);

/* Number of the packet that was read last, from 1, as Wireshark counts. */
uint64_t captured_datagrams_packet(const struct captured_datagrams *captured);

/* Number of datagrams left out so far, since they are fragments or cut short. */
uint64_t captured_datagrams_incomplete(const struct captured_datagrams *captured);

/* Reason why the recording could not be read to its end; NULL where it could. */
const char *captured_datagrams_why_cut(const struct captured_datagrams *captured);

void captured_datagrams_close(struct captured_datagrams *captured);

#endif
