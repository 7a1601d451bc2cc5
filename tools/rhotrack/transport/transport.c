/* SPDX-License-Identifier: MIT */
#include "transport/transport.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "transport/transport_provider_interface.h"

static const char *url_or_default(const char *url)
{
    const char *variable = getenv("LCM_DEFAULT_URL");

    return url ? url : variable && *variable ? variable : TRANSPORT_DEFAULT_URL;
}

bool transport_url_is_same_file(const char *url, const char *path)
{
    char *name;
    bool is_same;

    url = url_or_default(url);
    if (transport_url_is_live(url)) {
        return false;
    }
    name = must_copy_text(url + 7);
    name[strcspn(name, "?")] = '\0';
    is_same = is_same_file(name, path);
    free(name);
    return is_same;
}

bool transport_url_is_live(const char *url)
{
    return strncmp(url_or_default(url), "file://", 7) != 0;
}

bool transport_url_tells_senders(const char *url)
{
    return strncmp(url_or_default(url), "udpm://", 7) == 0;
}

void transport_print_sender(const struct transport_sender *sender, FILE *to)
{
    fprintf(to, "%u.%u.%u.%u:%u", sender->address >> 24, sender->address >> 16 & 255u,
            sender->address >> 8 & 255u, sender->address & 255u, (unsigned)sender->port);
}

struct transport *transport_open(const char *url, enum transport_use use)
{
    struct transport *transport = must_calloc(1, sizeof *transport);

    transport->source = url ? "--lcm" : "LCM_DEFAULT_URL";
    url = url_or_default(url);
    transport->url = must_copy_text(url);
    transport->last_us = INT64_MIN;
    if (!strstr(url, "://")) {
        transport_refuse(transport, "not an LCM URL, which looks like %s", TRANSPORT_DEFAULT_URL);
    }
    if (transport_url_tells_senders(url)) {
        transport_open_udpm(transport, use);
    } else {
        transport_open_lcm_or_log(transport, use);
    }
    return transport;
}

const char *transport_url(const struct transport *transport)
{
    return transport->url;
}

const char *transport_place(const struct transport *transport)
{
    return transport->place;
}

void transport_tell_place(struct transport *transport, FILE *to)
{
    if (transport->is_place_new && to) {
        fprintf(to, "rhotrack: %s\n", transport->place);
    }
    transport->is_place_new = false;
}

bool transport_can_send(const struct transport *transport)
{
    return transport->can_send;
}

int transport_descriptor(const struct transport *transport)
{
    return transport->provider->descriptor(transport->object);
}

enum transport_found transport_receive(struct transport *transport,
                                       struct transport_message *message)
{
    enum transport_found found;

    message->sender = (struct transport_sender){.port = 0};
    found = transport->provider->receive(transport, transport->object, message);
    transport->counters.received += found == TRANSPORT_MESSAGE;
    return found;
}

bool transport_send(struct transport *transport, const char *channel, const uint8_t *data,
                    size_t size)
{
    bool is_sent = false;

    errno = EROFS;
    if (transport->can_send) {
        is_sent = transport->provider->send(transport->object, channel, data, size);
    }
    transport->counters.sent += is_sent;
    transport->counters.not_sent += !is_sent;
    return is_sent;
}

struct transport_counters transport_counters(const struct transport *transport)
{
    return transport->counters;
}

void transport_close(struct transport *transport)
{
    transport->provider->close(transport->object);
    free(transport->url);
    free(transport);
}
