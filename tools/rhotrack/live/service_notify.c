/* SPDX-License-Identifier: MIT */
#include "live/service_notify.h"

#include <errno.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/common.h"

#define RETRY_US 500000   /* time to the next attempt where the manager takes nothing */
#define STATUS_US 5000000 /* interval of words to a manager without a watchdog */

/* The value of a variable as a number above 0; 0 where it is missing or anything else. */
static int64_t environment_number(const char *name)
{
    const char *text = getenv(name);
    char *end;
    long long number;

    if (!text || *text < '0' || *text > '9') {
        return 0;
    }
    errno = 0;
    number = strtoll(text, &end, 10);
    return *end || errno ? 0 : number;
}

/* The time after which the manager's watchdog ends this process, us; 0: it does not watch it. */
static int64_t watchdog_time_us(void)
{
    const int64_t watched = environment_number("WATCHDOG_PID");

    return watched && watched != getpid() ? 0 : environment_number("WATCHDOG_USEC");
}

struct service service_open(void)
{
    struct service service = {.descriptor = -1, .interval_us = STATUS_US, .due_us = INT64_MAX};
    const char *name = getenv("NOTIFY_SOCKET");
    const int64_t watchdog_us = watchdog_time_us();
    size_t length;

    if (!name || !*name) {
        return service;
    }
    length = strlen(name);
    if ((*name != '/' && *name != '@') || length >= sizeof service.manager.sun_path) {
        fail(EXIT_USAGE, "NOTIFY_SOCKET %s: not a path, or @ and a name, of at most %zu characters",
             name, sizeof service.manager.sun_path - 1);
    }
    service.manager.sun_family = AF_UNIX;
    memcpy(service.manager.sun_path, name, length);
    if (*name == '@') { /* an abstract name, which begins with a zero byte */
        service.manager.sun_path[0] = '\0';
    }
    service.manager_bytes = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + length);
    service.descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (service.descriptor < 0) {
        fail(EXIT_RUNTIME, "NOTIFY_SOCKET %s: %s", name, strerror(errno));
    }
    service.is_watched = watchdog_us > 0;
    if (service.is_watched) {
        service.interval_us = watchdog_us / 2;
    }
    service.due_us = 0;
    return service;
}

static bool send_to_manager(const struct service *service, const char *text)
{
    return sendto(service->descriptor, text, strlen(text), MSG_NOSIGNAL,
                  (const struct sockaddr *)&service->manager, service->manager_bytes) >= 0;
}

void service_tell(struct service *service, int64_t now_us, const char *status)
{
    char text[512];

    snprintf(text, sizeof text, "%s%sSTATUS=%.400s", service->is_ready ? "" : "READY=1\n",
             service->is_watched ? "WATCHDOG=1\n" : "", status);
    if (send_to_manager(service, text)) {
        service->is_ready = true;
        service->due_us = now_us + service->interval_us;
        return;
    }
    if (errno != EAGAIN && !service->is_failure_told) {
        service->is_failure_told = true;
        fprintf(stderr, "rhotrack: NOTIFY_SOCKET: %s; the service manager hears nothing\n",
                strerror(errno));
    }
    service->due_us = now_us + RETRY_US;
}

void service_close(struct service *service)
{
    if (service->descriptor >= 0) {
        (void)send_to_manager(service, "STOPPING=1");
        close(service->descriptor);
        service->descriptor = -1;
    }
}
