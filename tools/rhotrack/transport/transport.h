/* SPDX-License-Identifier: MIT */
/*
 * transport: LCM messages in and out.
 *
 * udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES&sources_allowed=ADDRESS,ADDRESS goes over a multicast
 * socket of this program with the library's module udpm: liblcm puts fragments together before any
 * of its users can look at them, and one that is forged makes it write beyond its memory. The other
 * providers (file://, memq://, tcpq://) are liblcm's, but for file://NAME?speed=0: it does not tell
 * the times of a log's events.
 */
#ifndef RHOTRACK_TOOL_TRANSPORT_H
#define RHOTRACK_TOOL_TRANSPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TRANSPORT_DEFAULT_URL "udpm://239.255.76.67:7667?ttl=0"

struct transport;

enum transport_use { TRANSPORT_SEND, TRANSPORT_SEND_AND_RECEIVE };

/* IPv4, in the order of this machine. All 0: the provider does not tell. */
struct transport_sender {
    uint32_t address;
    uint16_t port;
    bool is_own; /* this program */
};

/* Valid until the next call. */
struct transport_message {
    const char *channel; /* 1 to 63 characters */
    const uint8_t *data;
    size_t size;
    int64_t received_us; /* on the clock of transport_now_us */
    struct transport_sender sender;
};

enum transport_found {
    TRANSPORT_MESSAGE,
    TRANSPORT_NOTHING, /* for now */
    TRANSPORT_END      /* for ever: a file's end, or the connection is gone */
};

struct transport_counters {
    uint64_t received, sent;
    /* datagrams: fragments, no LCM at all, or longer than any message of rhotrack */
    uint64_t refused;
    uint64_t refused_source; /* datagrams of addresses that are not in sources_allowed */
    uint64_t dropped;        /* by the kernel, because this program was too slow */
    uint64_t not_sent;       /* refused by the network, or read only */
};

/*
 * The provider's own message about a URL that it does not take, exit 2; a network that is not
 * there, exit 1.
 *   url  NULL: that of the environment (LCM_DEFAULT_URL), else TRANSPORT_DEFAULT_URL
 */
struct transport *transport_open(const char *url, enum transport_use use);

/* Whether this URL is that file: opening it may empty it, so it is asked before. */
bool transport_url_is_file(const char *url, const char *path);

/* False: this URL is a file, whose messages wait for what goes out. NULL as above. */
bool transport_url_is_live(const char *url);

const char *transport_url(const struct transport *transport);

/* False: the provider reads a file, and takes nothing. */
bool transport_can_send(const struct transport *transport);

/* To poll for POLLIN; there may be messages left to receive without it. */
int transport_descriptor(const struct transport *transport);

/*
 * The reception clock: microseconds since 1970, and never back, even where the system's clock is
 * set back. A file that is read at speed 0 has its own times instead.
 */
int64_t transport_now_us(struct transport *transport);

/* The next message that is here; does not wait. */
enum transport_found transport_receive(struct transport *transport,
                                       struct transport_message *message);

/* False where it was not sent: errno says why. It waits 0.1 s at most. */
bool transport_send(struct transport *transport, const char *channel, const uint8_t *data,
                    size_t size);

struct transport_counters transport_counters(const struct transport *transport);

void transport_close(struct transport *transport);

#endif
