/* SPDX-License-Identifier: MIT */
/*
 * out_of_sequence_counts: counts out-of-sequence scans by outcome: used, dropped, lost.
 *
 * The scan assembler's counters describe the wire: a scan that arrives after a newer one counts as
 * late, and its number was counted as lost before, even if it is then put in order or updates
 * tracks. Reports keep the three apart.
 */
#ifndef RHOTRACK_TOOL_OUT_OF_SEQUENCE_COUNTS_H
#define RHOTRACK_TOOL_OUT_OF_SEQUENCE_COUNTS_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/scan_assembler.h"

/* Count kept beside the scan assembler's counters. Initialised with zeros. */
struct out_of_sequence_counts {
    uint32_t out_of_order; /* out-of-sequence scans that were put in order or updated tracks */
};

/* Scans by outcome. `lost` decreases again when a scan whose number was skipped arrives. */
struct scan_losses {
    uint32_t out_of_order;
    uint32_t dropped; /* scans that came late and were not used */
    uint32_t lost;    /* scans whose numbers were skipped and that did not arrive later */
};

/* Passes a message to rho_scan_assembler_take, and counts whether a late scan was accepted. */
enum rho_status out_of_sequence_counts_take(struct out_of_sequence_counts *order,
                                            struct rho_scan_assembler *assembler,
                                            const char *channel, const uint8_t *data, size_t size,
                                            int64_t now_us);

/*
 * Counts whether a message that the assembler has taken was a late scan that was accepted; before:
 * the assembler's counters before the message.
 */
void out_of_sequence_counts_note(struct out_of_sequence_counts *order,
                                 const struct rho_scan_assembler_counters *before,
                                 const struct rho_scan_assembler *assembler);

struct scan_losses
out_of_sequence_counts_losses(const struct out_of_sequence_counts *order,
                              const struct rho_scan_assembler_counters *counters);

#endif
