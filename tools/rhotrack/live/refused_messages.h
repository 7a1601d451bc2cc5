/* SPDX-License-Identifier: MIT */
/*
 * refused_messages: messages that the scan assembler has refused, until their sensor sends one that
 * it accepts. Where that is a restart of the sensor they were its first scans, and can be taken
 * once more: so a restart, or a record that is played again, costs no scan.
 */
#ifndef RHOTRACK_TOOL_REFUSED_MESSAGES_H
#define RHOTRACK_TOOL_REFUSED_MESSAGES_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/scan_assembler.h"
#include "rhotrack/udpm.h"

/* Of all sensors together: the newest ones. */
#define REFUSED_MESSAGES_MAX 512

struct refused_message {
    char channel[RHO_UDPM_MAX_CHANNEL + 1]; /* "": it is over */
    uint8_t cause;                          /* private */
    uint16_t size;
    uint8_t data[RHO_UDPM_MAX_DATAGRAM];
};

/* All zero at the start. */
struct refused_messages {
    unsigned next, count; /* next: the place of the next one */
    struct refused_message of[REFUSED_MESSAGES_MAX];
};

/* The assembler, whose counters were such before, has taken the message: keeps it if it has to. */
void refused_messages_note(struct refused_messages *refused, const char *channel,
                           const uint8_t *data, size_t size,
                           const struct rho_scan_assembler_counters *before,
                           const struct rho_scan_assembler_counters *after);

/*
 * The sensor's restart was followed: gives its messages to the assembler once more, the oldest one
 * first, and forgets them. Adds what they had been refused for, and are not any more, to `taken`.
 */
void refused_messages_take_again(struct refused_messages *refused, const char *channel,
                                 struct rho_scan_assembler *assembler, int64_t now_us,
                                 struct rho_scan_assembler_counters *taken);

/* The counters less those of messages that were taken after all. */
struct rho_scan_assembler_counters
refused_messages_remaining_counters(const struct rho_scan_assembler_counters *counters,
                                    const struct rho_scan_assembler_counters *taken);

#endif
