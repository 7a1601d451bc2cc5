/* SPDX-License-Identifier: MIT */
#include "transport/transport_provider_interface.h"

#include <stdarg.h>
#include <stdio.h>
#include <time.h>

#include "base/common.h"

void transport_refuse(const struct transport *transport, const char *format, ...)
{
    char reason[512];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    fail(EXIT_USAGE, "%s %s: %s", transport->source, transport->url, reason);
}

static int64_t system_time_us(void)
{
    struct timespec now;

    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

int64_t transport_now_us(struct transport *transport)
{
    int64_t now_us =
        transport->has_own_clock ? transport->last_us : system_time_us() + transport->ahead_us;

    if (now_us < transport->last_us) { /* the system's clock was set back */
        transport->ahead_us += transport->last_us - now_us;
        now_us = transport->last_us;
    }
    transport->last_us = now_us;
    return now_us;
}

int64_t transport_reception_time_us(struct transport *transport, int64_t time_us)
{
    int64_t before_us = transport->last_us, now_us = transport_now_us(transport);

    time_us += transport->ahead_us;
    transport->last_us = time_us < before_us ? before_us : time_us > now_us ? now_us : time_us;
    return transport->last_us;
}
