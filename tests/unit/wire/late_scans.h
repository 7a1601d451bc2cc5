/* SPDX-License-Identifier: MIT */
/* One sensor's scans, one a second, some of them late. */
#ifndef LATE_SCANS_H
#define LATE_SCANS_H

#include "scan_assembler_setup.h"

/* One sensor's scans 1 .. count, one a second. */
static inline void begin_with(const struct rho_scan_assembler_config *config, int32_t count)
{
    start_with(config);
    for (int32_t i = 1; i <= count; i++) {
        take_scan(1, i, i * SECOND_US);
        next_is(i * SECOND_US, 1, i * SECOND_US);
    }
    next_is_none(count * SECOND_US);
}

static inline void begin(int32_t count)
{
    struct rho_scan_assembler_config config = usual();

    begin_with(&config, count);
}

/* Scan `scan` at its time, received at now_us. */
static inline void late(int32_t scan, int64_t now_us)
{
    struct look look = {
        .time_us = scan * SECOND_US, .scan = scan, .sensor_id = 1, .count = 1, .tag = scan};

    take(&look, now_us);
}

static inline struct look part_of(int32_t scan, int16_t part)
{
    return (struct look){.time_us = scan * SECOND_US,
                         .scan = scan,
                         .sensor_id = 1,
                         .part = part,
                         .num_parts = 2,
                         .count = 1,
                         .tag = 10 * scan + part};
}

#endif
