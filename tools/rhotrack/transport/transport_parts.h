/* SPDX-License-Identifier: MIT */
/* transport_parts: what the providers share. For transport*.c alone. */
#ifndef RHOTRACK_TOOL_TRANSPORT_PARTS_H
#define RHOTRACK_TOOL_TRANSPORT_PARTS_H

#include "transport/transport.h"

struct transport_provider {
    int (*descriptor)(const void *object);
    enum transport_found (*receive)(struct transport *transport, void *object,
                                    struct transport_message *message);
    /* NULL: it can not */
    bool (*send)(void *object, const char *channel, const uint8_t *data, size_t size);
    void (*close)(void *object);
};

struct transport {
    const struct transport_provider *provider;
    void *object; /* the provider's */
    char *url;
    const char *source; /* of the URL, for messages: "--lcm" or the variable's name */
    bool can_send;
    int64_t last_us,
        ahead_us;       /* the reception clock: its last time, and how far the system's is behind */
    bool has_own_clock; /* it is the messages' own times: last_us */
    struct transport_counters counters;
};

/* Exit 2: rhotrack: --lcm URL: reason. */
_Noreturn void transport_refuse(const struct transport *transport, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* A time of the system's clock, a little ago, on the reception clock. */
int64_t transport_reception_time_us(struct transport *transport, int64_t time_us);

/* Open the URL of the transport, and set provider, object and can_send. */
void transport_open_udpm(struct transport *transport, enum transport_use use);
void transport_open_lcm(struct transport *transport, enum transport_use use);
void transport_open_log(struct transport *transport);
void transport_open_written_log(struct transport *transport, const char *mode); /* of fopen */

#endif
