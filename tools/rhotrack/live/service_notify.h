/* SPDX-License-Identifier: MIT */
/*
 * service_notify: tells the system's service manager (systemd: Type=notify, WatchdogSec) that the
 * program is ready, what it does, and that it goes on: datagrams to the socket NOTIFY_SOCKET, as
 * sd_notify(3) sends them. Without a manager nothing happens.
 */
#ifndef RHOTRACK_TOOL_SERVICE_NOTIFY_H
#define RHOTRACK_TOOL_SERVICE_NOTIFY_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/socket.h>
#include <sys/un.h>

struct service {
    int descriptor; /* -1: there is no manager */
    struct sockaddr_un manager;
    socklen_t manager_bytes;
    bool is_ready, is_watched; /* is_ready: the manager knows it; is_watched: by its watchdog */
    bool is_failure_told;
    int64_t interval_us; /* between words to the manager */
    int64_t due_us;      /* monotonic time of the next word; INT64_MAX: never */
};

/* Reads NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID. Exit 2 where NOTIFY_SOCKET is no socket. */
struct service service_open(void);

/*
 * Tells the manager what the program does, and its watchdog that it goes on. To be called at due_us
 * by the loop that does the program's work, and nowhere else. The first call also says that the
 * program is ready.
 *   status  one line for `systemctl status`
 */
void service_tell(struct service *service, int64_t now_us, const char *status);

/* Tells the manager that the program ends. */
void service_close(struct service *service);

#endif
