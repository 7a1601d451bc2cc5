/* SPDX-License-Identifier: MIT */
/*
 * transport: sends and receives LCM messages.
 *
 * URLs udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES&sources_allowed=ADDRESS,ADDRESS use a multicast
 * socket of this program with the library's module udpm: liblcm reassembles fragments before its
 * users can check them, and a forged fragment makes it write out of bounds. Other URLs (file://,
 * memq://, tcpq://) are opened by liblcm, except log files that are written or read with speed=0,
 * for which liblcm reports neither write errors nor the times of events.
 */
#ifndef RHOTRACK_TOOL_TRANSPORT_H
#define RHOTRACK_TOOL_TRANSPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define TRANSPORT_DEFAULT_URL "udpm://239.255.76.67:7667?ttl=0"

struct transport;

enum transport_use { TRANSPORT_SEND, TRANSPORT_SEND_AND_RECEIVE };

/* Sender of a datagram, IPv4 in host byte order; all 0 where the transport does not tell it. */
struct transport_sender {
    uint32_t address;
    uint16_t port;
    bool is_own; /* this program sent the message itself */
};

/* A received message, valid until the next call of transport_receive. */
struct transport_message {
    const char *channel; /* name of 1 to 63 characters */
    const uint8_t *data;
    size_t size;
    int64_t received_us; /* reception time on the clock of transport_now_us */
    struct transport_sender sender;
};

enum transport_found {
    TRANSPORT_MESSAGE,
    TRANSPORT_NOTHING, /* no message at present */
    TRANSPORT_END      /* end of the file, or the connection is lost */
};

struct transport_counters {
    uint64_t received, sent;
    /* refused datagrams: fragments, not LCM, or longer than any message of rhotrack */
    uint64_t refused;
    uint64_t refused_source; /* datagrams from addresses outside sources_allowed */
    uint64_t dropped;        /* datagrams dropped by the kernel, as this program was too slow */
    /* messages refused by the network, or by a transport that only reads */
    uint64_t not_sent;
};

/*
 * Opens an LCM URL. Exit 2 with the reason where the URL is bad; exit 1 without a network.
 *   url  NULL: the environment's LCM_DEFAULT_URL, else TRANSPORT_DEFAULT_URL
 */
struct transport *transport_open(const char *url, enum transport_use use);

/*
 * True where the URL (NULL: the default one) is that file. To be asked first, as opening a URL may
 * truncate its file.
 */
bool transport_url_is_same_file(const char *url, const char *path);

/*
 * True where the URL (NULL: the default one) is a network; false for files, whose messages can wait
 * for slow outputs.
 */
bool transport_url_is_live(const char *url);

/* True where messages of the URL (NULL: the default one) come with their sender's address. */
bool transport_url_tells_senders(const char *url);

/* Prints an address and port as 10.9.0.1:5001. */
void transport_print_sender(const struct transport_sender *sender, FILE *to);

const char *transport_url(const struct transport *transport);

/*
 * Where messages come from at present, or go to where none are received: group, port, interface and
 * its address, or the reason why nothing can come; "" for transports of liblcm and files.
 */
const char *transport_place(const struct transport *transport);

/* Prints the place where it has changed since the last call; `to` NULL: prints nothing. */
void transport_tell_place(struct transport *transport, FILE *to);

/* True where messages can be sent; false where a file is read. */
bool transport_can_send(const struct transport *transport);

/*
 * Descriptor to poll for POLLIN, -1: none. Messages may be left to receive though it is not
 * readable.
 */
int transport_descriptor(const struct transport *transport);

/*
 * The reception clock: microseconds since 1970, monotonic even where the system's clock is set
 * back. A log read with speed=0 has its events' times instead.
 */
int64_t transport_now_us(struct transport *transport);

/* Receives the next message, without waiting. */
enum transport_found transport_receive(struct transport *transport,
                                       struct transport_message *message);

/* Sends a message, waiting for 0.1 s at most. Returns false with errno where it was not sent. */
bool transport_send(struct transport *transport, const char *channel, const uint8_t *data,
                    size_t size);

struct transport_counters transport_counters(const struct transport *transport);

void transport_close(struct transport *transport);

#endif
