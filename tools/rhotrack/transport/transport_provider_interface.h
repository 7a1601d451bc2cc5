/* SPDX-License-Identifier: MIT */
/*
 * transport_provider_interface: the transport's interface to its providers udpm, liblcm and log
 * files.
 */
#ifndef RHOTRACK_TOOL_TRANSPORT_PROVIDER_INTERFACE_H
#define RHOTRACK_TOOL_TRANSPORT_PROVIDER_INTERFACE_H

#include "transport/transport.h"

enum { TRANSPORT_PLACE_BYTES = 256 };

struct transport_provider {
    int (*descriptor)(const void *object);
    enum transport_found (*receive)(struct transport *transport, void *object,
                                    struct transport_message *message);
    /* NULL: the provider cannot send */
    bool (*send)(void *object, const char *channel, const uint8_t *data, size_t size);
    void (*close)(void *object);
};

struct transport {
    const struct transport_provider *provider;
    void *object; /* the provider's own data */
    char *url;
    /* origin of the URL for error messages: "--lcm" or the environment variable's name */
    const char *source;
    bool can_send;
    /* last_us: last time of the reception clock; ahead_us: its lead over the system's clock */
    int64_t last_us, ahead_us;
    bool has_own_clock; /* the reception clock is last_us, the time of the last message */
    struct transport_counters counters;
    /* where messages come from, as transport_tell_place prints it; "": the URL says all */
    char place[TRANSPORT_PLACE_BYTES];
    bool is_place_new; /* not printed yet */
};

/* Exit 2 with `rhotrack: --lcm URL: reason`. */
_Noreturn void transport_refuse(const struct transport *transport, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Converts a recent time of the system's clock to the monotonic reception clock. */
int64_t transport_reception_time_us(struct transport *transport, int64_t time_us);

/* Providers: each opens the transport's URL, and sets provider, object and can_send. */
void transport_open_udpm(struct transport *transport, enum transport_use use);
void transport_open_lcm_or_log(struct transport *transport, enum transport_use use);
void transport_open_read_log(struct transport *transport);
/* Opens a log for writing; mode as of fopen. */
void transport_open_written_log(struct transport *transport, const char *mode);

#endif
