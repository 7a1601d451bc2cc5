/* SPDX-License-Identifier: MIT */
/*
 * out_of_sequence_counts: how many out-of-sequence scans were used, dropped and lost.
 *
 * The assembler's counters are those of the wire: a scan behind a newer one counts as late, and its
 * number as lost before, also where it is then put in order or updates tracks. What a person reads
 * keeps the three apart.
 */
#ifndef RHOTRACK_TOOL_OUT_OF_SEQUENCE_COUNTS_H
#define RHOTRACK_TOOL_OUT_OF_SEQUENCE_COUNTS_H

#include <stddef.h>
#include <stdint.h>

#include "rhotrack/scan_assembler.h"

/* All zero at the start. */
struct out_of_sequence_counts {
    uint32_t out_of_order; /* scans that were late and used */
};

/* `lost` falls again where a number that was skipped comes after all. */
struct scan_losses {
    uint32_t out_of_order;
    uint32_t dropped; /* late, and not used */
    uint32_t lost;    /* numbers skipped that were not used later */
};

/* rho_scan_assembler_take, watched. */
enum rho_status out_of_sequence_counts_take_message(struct out_of_sequence_counts *order,
                                                    struct rho_scan_assembler *assembler,
                                                    const char *channel, const uint8_t *data,
                                                    size_t size, int64_t now_us);

/* The same of a scan assembler that has taken a message, with its counters from before. */
void out_of_sequence_counts_note_message(struct out_of_sequence_counts *order,
                                         const struct rho_scan_assembler_counters *before,
                                         const struct rho_scan_assembler *assembler);

struct scan_losses
out_of_sequence_counts_losses(const struct out_of_sequence_counts *order,
                              const struct rho_scan_assembler_counters *counters);

#endif
