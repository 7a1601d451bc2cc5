/* SPDX-License-Identifier: MIT */
/*
 * udpm: writes and parses datagrams of LCM's UDP multicast, one message each.
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
 * Anybody on the network can send. Where that matters, the caller tests each datagram before
 * rho_udpm_parse: for an allowed address (rho_udpm_admits), and for the right authentication code
 * behind the message, if the senders append one. The caller computes that code with its own key, as
 * this library has no cryptography, and counts failures in the guard:
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
 * A list of addresses stops datagrams that come by mistake or over routers; within a network an
 * address can be forged.
 *
 * Stack: 32 bytes at most where nothing else is said.
 */
#ifndef RHOTRACK_UDPM_H
#define RHOTRACK_UDPM_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/config.h"
#include "rhotrack/types.h"

RHO_BEGIN_C

#define RHO_UDPM_GROUP "239.255.76.67"
#define RHO_UDPM_PORT 7667
#define RHO_UDPM_MAX_CHANNEL 63 /* longest name of a channel, characters; the shortest has 1 */
#define RHO_UDPM_MAX_DATAGRAM                                                                      \
    1472u /* longest datagram, bytes: the UDP payload of an Ethernet frame */
#define RHO_UDPM_MAX_HEAD (8u + RHO_UDPM_MAX_CHANNEL + 1u)

/* A parsed datagram: its pointers point into the bytes that were parsed. */
struct rho_udpm_datagram {
    uint32_t sequence;
    const char *channel; /* name of the channel; ends with NUL */
    const uint8_t *payload;
    size_t payload_size;
};

/* Largest number of permitted senders: as many as there may be sensors. */
#define RHO_UDPM_MAX_SOURCES RHO_MAX_SENSORS

/* Permitted senders of datagrams, and counters of refusals, which saturate. All 0: any sender. */
struct rho_udpm_guard {
    uint32_t refused_source; /* datagrams refused for the sender's address */
    /* datagrams without the right authentication code; counted by the caller */
    uint32_t refused_mac;
    uint32_t num_sources;                   /* number of permitted addresses; 0: any address */
    uint32_t sources[RHO_UDPM_MAX_SOURCES]; /* permitted IPv4 addresses, 10.9.0.1 as 0x0a090001 */
};

/*
 * 1 where datagrams may come from this address; others are counted in refused_source. 0, without
 * counting, where guard is NULL or num_sources > RHO_UDPM_MAX_SOURCES. Cost: num_sources.
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
 * Parses the head of a datagram; any bytes of any length may be given. The message behind it is not
 * decoded, and may be empty. Errors: NULL, SHORT (no whole head), TYPE (not "LC02": a fragment, or
 * no LCM), VALUE (a channel that is empty, longer than 63 characters, or without its end);
 * *datagram is unchanged. Cost: the channel's length. Stack: 88 bytes.
 */
RHO_MUST_CHECK enum rho_status rho_udpm_parse(const uint8_t *data, size_t size,
                                              struct rho_udpm_datagram *datagram);

/* 1 for the datagram by which liblcm tests the network: channel LCM_SELF_TEST. Constant cost. */
int rho_udpm_is_self_test(const struct rho_udpm_datagram *datagram);

RHO_END_C

#endif
