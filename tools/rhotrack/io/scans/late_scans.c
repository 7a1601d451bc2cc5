/* SPDX-License-Identifier: MIT */
#include "io/scans/late_scans.h"

void feed_order_note(struct feed_order *order, const struct rho_scan_assembler_counters *before,
                     const struct rho_scan_assembler *feed)
{
    /*
     * a clock that is set anew makes all that waits late, in the same call as its own scan is
     * accepted
     */
    order->out_of_order += feed->counters.scans_accepted > before->scans_accepted &&
                           feed->counters.scans_late > before->scans_late && !feed->is_restart;
}

enum rho_status feed_order_take(struct feed_order *order, struct rho_scan_assembler *feed,
                                const char *channel, const uint8_t *data, size_t size,
                                int64_t now_us)
{
    const struct rho_scan_assembler_counters before = feed->counters;
    enum rho_status status = rho_scan_assembler_take(feed, channel, data, size, now_us);

    feed_order_note(order, &before, feed);
    return status;
}

static uint32_t less(uint32_t count, uint32_t part)
{
    return count > part ? count - part : 0;
}

struct feed_losses feed_order_losses(const struct feed_order *order,
                                     const struct rho_scan_assembler_counters *counters)
{
    return (struct feed_losses){.out_of_order = order->out_of_order,
                                .dropped = less(counters->scans_late, order->out_of_order),
                                .lost = less(counters->scans_lost, order->out_of_order)};
}
