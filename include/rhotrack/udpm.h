/* SPDX-License-Identifier: MIT */
/*
 * udpm: datagrams of LCM's UDP multicast, one message each.
 *
 * A datagram is "LC02", a sequence number (4 bytes, big endian), the channel's name with a NUL, and the message. Longer
 * messages go out in fragments ("LC03"), which this module refuses: all of rhotrack's messages fit one datagram. Group
 * and port are the caller's socket's; LCM's defaults are below.
 *
 * The message is written behind the head in place:
 *
 *     rho_udpm_begin(buffer, sizeof buffer, sequence++, "RHO_TRACKS", &head);
 *     rho_message_..._encode(&message, buffer + head, sizeof buffer - head, &size);
 *     send(buffer, head + size);
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_UDPM_H
#define RHOTRACK_UDPM_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/status.h"

#define RHO_UDPM_GROUP "239.255.76.67"
#define RHO_UDPM_PORT 7667
#define RHO_UDPM_MAX_CHANNEL 63 /* characters of a channel's name, 1 at least */
#define RHO_UDPM_MAX_DATAGRAM                                                                      \
    1472u /* bytes that an Ethernet frame takes: the longest that is built */
#define RHO_UDPM_MAX_HEAD (8u + RHO_UDPM_MAX_CHANNEL + 1u)

/* A datagram to read: it points into the bytes that were parsed, and lives as long. */
struct rho_udpm_datagram {
    uint32_t sequence;
    const char *channel; /* ends with NUL */
    const uint8_t *payload;
    size_t payload_size;
};

/*
 * Writes the head of a datagram to the buffer; *head: its length, behind which the message goes.
 * Errors: NULL, VALUE (a channel of no or more than 63 characters), CAPACITY (the buffer is shorter than the head);
 * nothing is written. Cost: the head's bytes. Stack: 88 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_udpm_begin(uint8_t *buffer, size_t capacity, uint32_t sequence,
                                              const char *channel, size_t *head);

/*
 * Opens a datagram; any bytes of any length may be given. The message itself is not looked into, and may be empty.
 * Errors: NULL, SHORT (no whole head), TYPE (not "LC02": a fragment, or no LCM), VALUE (a channel that is empty, longer
 * than 63 characters, or without its end); *datagram is unchanged. Cost: the channel's length. Stack: 88 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_udpm_parse(const uint8_t *data, size_t size,
                                              struct rho_udpm_datagram *datagram);

/* True for what liblcm sends to itself to try the network: channel LCM_SELF_TEST. Constant cost. */
int rho_udpm_is_self_test(const struct rho_udpm_datagram *datagram);

#endif
