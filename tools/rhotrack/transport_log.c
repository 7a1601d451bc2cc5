/* SPDX-License-Identifier: MIT */
/*
 * transport_log: an LCM log read without waiting. The reception clock is that of its events, which may have been
 * recorded over days: nothing of it comes too fast, and what waits does so in their time.
 */
#include <stdlib.h>
#include <string.h>

#include "common.h"
#include "lcm_log.h"
#include "transport_parts.h"

struct log {
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    bool has_event; /* the first one, which sets the clock, was not given yet */
};

static int descriptor_of(const void *object)
{
    (void)object;
    return -1; /* nothing is ever waited for */
}

static enum transport_found receive(struct transport *transport, void *object,
                                    struct transport_message *message)
{
    struct log *log = object;

    if (!log->has_event && !lcm_log_next(log->reader, &log->event)) {
        return TRANSPORT_END;
    }
    log->has_event = false;
    if (log->event.utime > transport->last_us) {
        transport->last_us = log->event.utime;
    }
    *message = (struct transport_message){.channel = log->event.channel,
                                          .data = log->event.data,
                                          .size = log->event.size,
                                          .received_us = transport->last_us};
    return TRANSPORT_MESSAGE;
}

static void close_log(void *object)
{
    struct log *log = object;

    lcm_log_report(log->reader);
    lcm_log_close(log->reader);
    free(log);
}

void transport_open_log(struct transport *transport)
{
    static const struct transport_provider provider = {descriptor_of, receive, NULL, close_log};
    struct log *log = must_calloc(1, sizeof *log);
    char *path = must_copy(transport->url + strlen("file://"));

    path[strcspn(path, "?")] = '\0';
    log->reader = lcm_log_open(path);
    log->has_event = lcm_log_next(log->reader, &log->event);
    if (!log->has_event) {
        transport_refuse(transport, "not one event of an LCM log in it");
    }
    transport->provider = &provider;
    transport->object = log;
    transport->last_us = log->event.utime;
    transport->has_own_clock = true;
    free(path);
}
