/* SPDX-License-Identifier: MIT */
/*
 * refused_messages: keeps messages that the scan assembler has refused, until it
 * accepts one of their sensor. If the sensor had restarted, they were its first scans and are fed
 * again, so that a restart, or a replay that begins anew, loses no scan.
 */
#ifndef RHOTRACK_TOOL_REFUSED_MESSAGES_H
#define RHOTRACK_TOOL_REFUSED_MESSAGES_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/scan_assembler.h"
#include "rhotrack/udpm.h"

/* Capacity for refused messages of all sensors together; newer ones replace older ones. */
#define REFUSED_MESSAGES_MAX 512

struct refused_message {
    char channel[RHO_UDPM_MAX_CHANNEL + 1]; /* channel of the message; "": the place is free */
    uint8_t cause;                          /* index of the counter that rose; private */
    uint16_t size;
    uint8_t data[RHO_UDPM_MAX_DATAGRAM];
};

/* Ring buffer of refused messages; all zero at the start. */
struct refused_messages {
    unsigned next, count; /* next: index at which the next message is stored */
    struct refused_message of[REFUSED_MESSAGES_MAX];
};

/*
 * Call after the assembler has taken a message; `before` and `after` are its counters. Keeps the
 * message if it was refused; if it was accepted, drops the kept messages of its channel.
 */
void refused_messages_keep(struct refused_messages *refused, const char *channel,
                           const uint8_t *data, size_t size,
                           const struct rho_scan_assembler_counters *before,
                           const struct rho_scan_assembler_counters *after);

/*
 * Feeds the kept messages of a channel to the assembler again, oldest first, after its sensor's
 * restart was confirmed, and drops them. Adds the refusals that are thereby undone to `taken`.
 */
void refused_messages_retry(struct refused_messages *refused, const char *channel,
                            struct rho_scan_assembler *assembler, int64_t now_us,
                            struct rho_scan_assembler_counters *taken);

/* The assembler's counters less the refusals in `taken`, whose messages were accepted later. */
struct rho_scan_assembler_counters
refused_messages_correct(const struct rho_scan_assembler_counters *counters,
                         const struct rho_scan_assembler_counters *taken);

#endif
