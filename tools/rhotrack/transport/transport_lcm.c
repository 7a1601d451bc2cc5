/* SPDX-License-Identifier: MIT */
/*
 * transport_lcm: the LCM transports that liblcm provides (file://, memq://, tcpq://); messages stay
 * undecoded. Logs that are written, or read without waiting, go to transport_log, as liblcm reports
 * neither times of events nor write errors.
 */
#include <errno.h>
#include <lcm/lcm.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "rhotrack/udpm.h"
#include "transport/transport_provider_interface.h"

/*
 * QUEUE_MESSAGES: capacity of liblcm's receive queue, which drops newer messages when full.
 * MESSAGE_BYTES: longest message received; messages of rhotrack are never longer.
 */
enum { QUEUE_MESSAGES = 10000, MESSAGE_BYTES = 65536 };

struct provider {
    lcm_t *lcm;
    struct transport *transport;
    bool has_ended, has_message;
    size_t size;
    int64_t time_us;
    char channel[RHO_UDPM_MAX_CHANNEL + 1];
    uint8_t data[MESSAGE_BYTES];
};

static void on_lcm_message(const lcm_recv_buf_t *buffer, const char *channel, void *user)
{
    struct provider *provider = user;
    size_t length = strlen(channel);

    if (length == 0 || length > RHO_UDPM_MAX_CHANNEL || buffer->data_size > MESSAGE_BYTES) {
        provider->transport->counters.refused += strncmp(channel, "RHO_", 4) == 0;
        return;
    }
    memcpy(provider->channel, channel, length + 1);
    memcpy(provider->data, buffer->data, buffer->data_size);
    provider->size = buffer->data_size;
    provider->time_us = buffer->recv_utime;
    provider->has_message = true;
}

static int lcm_descriptor(const void *object)
{
    return lcm_get_fileno(((const struct provider *)object)->lcm);
}

static enum transport_found receive_message(struct transport *transport, void *object,
                                            struct transport_message *message)
{
    struct provider *provider = object;
    struct pollfd here = {.fd = lcm_descriptor(object), .events = POLLIN};

    provider->has_message = false;
    while (!provider->has_ended && !provider->has_message) {
        if (poll(&here, 1, 0) <= 0) {
            return TRANSPORT_NOTHING;
        }
        provider->has_ended = lcm_handle(provider->lcm) != 0;
    }
    if (!provider->has_message) {
        return TRANSPORT_END;
    }
    *message = (struct transport_message){
        .channel = provider->channel,
        .data = provider->data,
        .size = provider->size,
        .received_us = transport_reception_time_us(transport, provider->time_us)};
    return TRANSPORT_MESSAGE;
}

static bool send_message(void *object, const char *channel, const uint8_t *data, size_t size)
{
    struct provider *provider = object;

    errno = EIO;
    return lcm_publish(provider->lcm, channel, data, (unsigned)size) == 0;
}

static void close_lcm(void *object)
{
    struct provider *provider = object;

    lcm_destroy(provider->lcm);
    free(provider);
}

/* The text behind "name=" in a URL's options, up to the end of the URL; "" where it is missing. */
static const char *url_option_text(const char *url, const char *name)
{
    size_t length = strlen(name);

    for (const char *rest = strpbrk(url, "?&"); rest; rest = strpbrk(rest, "?&")) {
        rest++;
        if (strncmp(rest, name, length) == 0 && rest[length] == '=') {
            return rest + length + 1;
        }
    }
    return "";
}

/* The mode of a file:// URL: 'r' (default) reads, 'w' overwrites, 'a' appends. */
static char url_file_mode(const char *url)
{
    const char *mode = url_option_text(url, "mode");

    return *mode ? *mode : 'r';
}

static bool has_url_speed_0(const char *url)
{
    const char *speed = url_option_text(url, "speed");

    return *speed && !(strtod(speed, NULL) > 0);
}

static void check_url_file_mode(const struct transport *transport, enum transport_use use)
{
    bool is_read = url_file_mode(transport->url) == 'r';

    if (!strchr("rwa", url_file_mode(transport->url))) {
        transport_refuse(transport, "unknown mode; there are r, w and a");
    }
    if (is_read && use == TRANSPORT_SEND) {
        transport_refuse(transport, "this URL reads the file; ?mode=w writes it");
    }
    if (!is_read && use == TRANSPORT_SEND_AND_RECEIVE) {
        transport_refuse(transport,
                         "nothing can be received from a file that is written; ?mode=r reads it");
    }
}

void transport_open_lcm_or_log(struct transport *transport, enum transport_use use)
{
    static const struct transport_provider methods = {lcm_descriptor, receive_message, send_message,
                                                      close_lcm};
    bool is_file = strncmp(transport->url, "file://", 7) == 0;
    struct provider *provider;
    lcm_subscription_t *all;

    if (is_file) {
        check_url_file_mode(transport, use);
        if (use == TRANSPORT_SEND) {
            transport_open_written_log(transport,
                                       url_file_mode(transport->url) == 'a' ? "ab" : "wb");
            return;
        }
        if (has_url_speed_0(transport->url)) {
            transport_open_read_log(transport);
            return;
        }
    }
    provider = must_calloc(1, sizeof *provider);
    provider->transport = transport;
    provider->lcm = lcm_create(transport->url);
    if (!provider->lcm) {
        transport_refuse(transport, "liblcm cannot open it");
    }
    if (use == TRANSPORT_SEND_AND_RECEIVE) {
        all = lcm_subscribe(provider->lcm, ".*", on_lcm_message, provider);
        if (!all || lcm_subscription_set_queue_capacity(all, QUEUE_MESSAGES)) {
            fail(EXIT_RUNTIME, "%s: liblcm cannot subscribe", transport->url);
        }
    }
    transport->provider = &methods;
    transport->object = provider;
    transport->can_send = !is_file;
}
