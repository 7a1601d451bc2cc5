/* SPDX-License-Identifier: MIT */
#include "io/scans/out_of_sequence_counts.h"

void out_of_sequence_counts_note(struct out_of_sequence_counts *order,
                                 const struct rho_scan_assembler_counters *before,
                                 const struct rho_scan_assembler *assembler)
{
    /*
     * a restarted clock makes all waiting scans late in the call that accepts its own scan: these
     * are not out of sequence
     */
    order->out_of_order += assembler->counters.scans_accepted > before->scans_accepted &&
                           assembler->counters.scans_late > before->scans_late &&
                           !assembler->is_restart;
}

enum rho_status out_of_sequence_counts_take(struct out_of_sequence_counts *order,
                                            struct rho_scan_assembler *assembler,
                                            const char *channel, const uint8_t *data, size_t size,
                                            int64_t now_us)
{
    const struct rho_scan_assembler_counters before = assembler->counters;
    enum rho_status status = rho_scan_assembler_take(assembler, channel, data, size, now_us);

    out_of_sequence_counts_note(order, &before, assembler);
    return status;
}

static uint32_t subtract_or_zero(uint32_t count, uint32_t part)
{
    return count > part ? count - part : 0;
}

struct scan_losses out_of_sequence_counts_losses(const struct out_of_sequence_counts *order,
                                                 const struct rho_scan_assembler_counters *counters)
{
    return (struct scan_losses){
        .out_of_order = order->out_of_order,
        .dropped = subtract_or_zero(counters->scans_late, order->out_of_order),
        .lost = subtract_or_zero(counters->scans_lost, order->out_of_order)};
}
