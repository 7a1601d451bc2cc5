/* SPDX-License-Identifier: MIT */
/*
 * late_scans: of the scans that a feed counts late, which were used all the same, and so what is
 * lost in fact.
 *
 * The feed's scans_late and scans_lost are what the wire says: a scan that comes behind a newer one
 * is late, and its number was lost before, also where it is then put in order or updates tracks.
 * What a person reads tells these three apart.
 */
#ifndef RHOTRACK_TOOL_LATE_SCANS_H
#define RHOTRACK_TOOL_LATE_SCANS_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/scan_assembler.h"

/* All zero at the start. */
struct feed_order {
    uint32_t out_of_order; /* scans that were late and used */
};

/* `lost` falls again where a number that was skipped comes after all. */
struct feed_losses {
    uint32_t out_of_order;
    uint32_t dropped; /* late, and not used */
    uint32_t lost;    /* numbers skipped that were not used later */
};

/* rho_scan_assembler_take, watched. */
enum rho_status feed_order_take(struct feed_order *order, struct rho_scan_assembler *feed,
                                const char *channel, const uint8_t *data, size_t size,
                                int64_t now_us);

/* The same of a scan assembler that has taken a message, with its counters from before. */
void feed_order_note(struct feed_order *order, const struct rho_scan_assembler_counters *before,
                     const struct rho_scan_assembler *feed);

struct feed_losses feed_order_losses(const struct feed_order *order,
                                     const struct rho_scan_assembler_counters *counters);

#endif
