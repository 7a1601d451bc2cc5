/* SPDX-License-Identifier: MIT */
/*
 * transport_log: the transport of LCM logs that are written, or read without waiting. The reception
 * clock of a reader is the time of the logged events: rate limits and hold times then work as they
 * did live. Writing does not use liblcm, which does not report a full disk.
 */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "io/log/lcm_log.h"
#include "transport/transport_provider_interface.h"

struct log {
    struct lcm_log_reader *reader;
    struct lcm_log_event event;
    bool has_event; /* the first event, read at the start to set the clock, is not delivered yet */
};

static int no_descriptor(const void *object)
{
    (void)object;
    return -1; /* a log is always ready */
}

static enum transport_found receive_event(struct transport *transport, void *object,
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

static void close_read_log(void *object)
{
    struct log *log = object;

    lcm_log_report_skipped(log->reader);
    lcm_log_close(log->reader);
    free(log);
}

/* Path of a file:// URL, in new memory. */
static char *log_path(const struct transport *transport)
{
    char *path = must_copy_text(transport->url + strlen("file://"));

    path[strcspn(path, "?")] = '\0';
    return path;
}

void transport_open_read_log(struct transport *transport)
{
    static const struct transport_provider provider = {no_descriptor, receive_event, NULL,
                                                       close_read_log};
    struct log *log = must_calloc(1, sizeof *log);
    char *path = log_path(transport);

    log->reader = lcm_log_open(path);
    log->has_event = lcm_log_next(log->reader, &log->event);
    if (!log->has_event) {
        transport_refuse(transport, "contains no event of an LCM log");
    }
    transport->provider = &provider;
    transport->object = log;
    transport->last_us = log->event.utime;
    transport->has_own_clock = true;
    free(path);
}

struct written_log {
    struct transport *transport;
    char *path;
    struct lcm_log_writer writer;
};

static enum transport_found receive_nothing(struct transport *transport, void *object,
                                            struct transport_message *message)
{
    (void)transport;
    (void)object;
    (void)message;
    return TRANSPORT_NOTHING;
}

static bool write_log_event(void *object, const char *channel, const uint8_t *data, size_t size)
{
    struct written_log *log = object;

    return lcm_log_write(&log->writer, transport_now_us(log->transport), channel, data, size);
}

static void close_written_log(void *object)
{
    struct written_log *log = object;

    if (fclose(log->writer.file)) {
        fail(EXIT_RUNTIME, "%s: cannot be written: %s", log->path, strerror(errno));
    }
    free(log->path);
    free(log);
}

void transport_open_written_log(struct transport *transport, const char *mode)
{
    static const struct transport_provider provider = {no_descriptor, receive_nothing,
                                                       write_log_event, close_written_log};
    struct written_log *log = must_calloc(1, sizeof *log);

    log->transport = transport;
    log->path = log_path(transport);
    log->writer.file = fopen(log->path, mode);
    if (!log->writer.file) {
        fail(EXIT_RUNTIME, "%s: %s", log->path, strerror(errno));
    }
    transport->provider = &provider;
    transport->object = log;
    transport->can_send = true;
}
