/* SPDX-License-Identifier: MIT */
/*
 * udpm: datagrams of LCM's UDP multicast, one message each.
 *
 * A datagram is "LC02", a sequence number (4 bytes, big endian), the channel's name with a NUL, and
 * the message. Longer messages go out in fragments ("LC03"), which this module refuses: all of
 * rhotrack's messages fit one datagram. Group and port are the caller's socket's; LCM's defaults
 * are below.
 *
 * The message is written behind the head in place:
 *
 *     rho_udpm_begin(buffer, sizeof buffer, sequence++, "RHO_TRACKS", &head);
 *     rho_message_..._encode(&message, buffer + head, sizeof buffer - head, &size);
 *     send(buffer, head + size);
 *
 * Anybody on the network can send. Where that matters, datagrams are looked at before
 * rho_udpm_parse: whether they come from an allowed address (rho_udpm_admits), and whether the code
 * behind the message, if the senders put one there, is the right one. That code is the caller's,
 * with the caller's key: this library has no cryptography. It counts in the same guard what fails:
 *
 *     if (!rho_udpm_admits(&guard, source)) {
 *         return;
 *     }
 *     if (!is_authentic(data, &size)) {                       an HMAC, say; size without it
 *         guard.refused_mac = rho_count(guard.refused_mac, 1);
 *         return;
 *     }
 *     rho_udpm_parse(data, size, &datagram)
 *
 * An address alone stops what comes by mistake and over routers. Within a network it can be forged.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_UDPM_H
#define RHOTRACK_UDPM_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

#ifdef __cplusplus
extern "C" {
#endif

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

/* As many addresses as there may be sensors. */
#define RHO_UDPM_MAX_SOURCES RHO_MAX_SENSORS

/* The permitted senders, and counters of refusals; zeros: everybody may send. Counters saturate. */
struct rho_udpm_guard {
    uint32_t refused_source;                /* datagrams: from another address */
    uint32_t refused_mac;                   /* the caller's: without the right code */
    uint32_t num_sources;                   /* 0: any address */
    uint32_t sources[RHO_UDPM_MAX_SOURCES]; /* IPv4, 10.9.0.1 as 0x0a090001 */
};

/*
 * Whether a datagram may come from this address; where not, refused_source moves. 0 where guard is
 * NULL or its num_sources is beyond RHO_UDPM_MAX_SOURCES, which nothing counts. Cost: num_sources.
 */
int rho_udpm_admits(struct rho_udpm_guard *guard, uint32_t source_ipv4);

/*
 * Writes the head of a datagram to the buffer; *head: its length, behind which the message goes.
 * Errors: NULL, VALUE (a channel of no or more than 63 characters), CAPACITY (the buffer is shorter
 * than the head); nothing is written. Cost: the head's bytes. Stack: 88 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_udpm_begin(uint8_t *buffer, size_t capacity, uint32_t sequence,
                                              const char *channel, size_t *head);

/*
 * Opens a datagram; any bytes of any length may be given. The message itself is not looked into,
 * and may be empty.
 * Errors: NULL, SHORT (no whole head), TYPE (not "LC02": a fragment, or no LCM), VALUE (a channel
 * that is empty, longer than 63 characters, or without its end); *datagram is unchanged. Cost: the
 * channel's length. Stack: 88 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_udpm_parse(const uint8_t *data, size_t size,
                                              struct rho_udpm_datagram *datagram);

/* True for what liblcm sends to itself to try the network: channel LCM_SELF_TEST. Constant cost. */
int rho_udpm_is_self_test(const struct rho_udpm_datagram *datagram);

#ifdef __cplusplus
}
#endif

#endif
