/* SPDX-License-Identifier: MIT */
/* Scans of one sensor, one a second, some of which are received late. */
#ifndef LATE_SCANS_H
#define LATE_SCANS_H

#include "scan_assembler_setup.h"

/* One sensor's scans 1 .. count, one a second. */
static inline void start_with_config_and_scans(const struct rho_scan_assembler_config *config,
                                               int32_t count)
{
    start_assembler_with(config);
    for (int32_t i = 1; i <= count; i++) {
        take_scan(1, i, i * SECOND_US);
        expect_next_scan(i * SECOND_US, 1, i * SECOND_US);
    }
    expect_no_scan(count * SECOND_US);
}

static inline void start_with_scans(int32_t count)
{
    struct rho_scan_assembler_config config = usual_config();

    start_with_config_and_scans(&config, count);
}

/* Takes scan number `scan` with its own time, received at now_us. */
static inline void take_late_scan(int32_t scan, int64_t now_us)
{
    struct look look = {
        .time_us = scan * SECOND_US, .scan = scan, .sensor_id = 1, .count = 1, .tag = scan};

    take_message(&look, now_us);
}

static inline struct look late_part(int32_t scan, int16_t part)
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
