/* SPDX-License-Identifier: MIT */
#include "live/publish_stop.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <time.h>

#include "base/common.h"

#define TRIES 100 /* attempts at intervals of 1 ms to send while the network is busy */

static volatile sig_atomic_t is_stopped;

static void on_stop_signal(int number)
{
    (void)number;
    is_stopped = 1;
}

void publish_watch_signals(void)
{
    struct sigaction action = {.sa_handler =
                                   on_stop_signal}; /* no SA_RESTART: signals end sleeps */

    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    if (!is_signal_ignored(SIGHUP)) {
        sigaction(SIGHUP, &action, NULL);
    }
}

bool publish_is_stopped(void)
{
    return is_stopped;
}

int32_t publish_run_epoch(void)
{
    struct timespec now;

    clock_gettime(CLOCK_REALTIME, &now);
    return (int32_t)(((int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000) & INT32_MAX) | 1;
}

bool publish_send_message(struct transport *transport, const char *channel, const uint8_t *data,
                          size_t size)
{
    const struct timespec moment = {.tv_nsec = 1000000};
    int tries = 1;

    while (!transport_send(transport, channel, data, size)) {
        if (errno == EMSGSIZE) {
            return false;
        }
        if (errno == EINTR) {
            continue;
        }
        if ((errno != ENOBUFS && errno != EAGAIN) || tries++ == TRIES) {
            fail(EXIT_RUNTIME, "%s: %s: %s", transport_url(transport), channel, strerror(errno));
        }
        nanosleep(&moment, NULL);
    }
    transport_tell_place(transport, stderr);
    return true;
}
