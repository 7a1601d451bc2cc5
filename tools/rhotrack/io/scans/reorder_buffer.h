/* SPDX-License-Identifier: MIT */
/*
 * reorder_buffer: scans go in in the order in which they were received, and out in the order of
 * their times, as far as they come within a time to wait. A scan that comes later than that goes
 * out at once: the tracker takes it as out of sequence.
 */
#ifndef RHOTRACK_TOOL_REORDER_BUFFER_H
#define RHOTRACK_TOOL_REORDER_BUFFER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/types.h"

/* A scan of plots, and the sensor; or one of bearings. What was measured is its own memory. */
struct sensor_scan {
    bool is_bearings;
    struct rho_scan scan;
    struct rho_bearing_scan bearings;
    bool has_sensor; /* of plots: something was said of the sensor */
    struct rho_sensor sensor;
    const char *path; /* of bearings: where the first row is */
    uint32_t line;
};
int64_t sensor_scan_time_us(const struct sensor_scan *scan);
void sensor_scan_free(struct sensor_scan *scan);

struct waiting_scan {
    struct sensor_scan scan;
    int64_t heard_us;
};

/* All 0 but for the time to wait: empty. */
struct reorder_buffer {
    int64_t hold_us;  /* the time to wait */
    int64_t clock_us; /* now */
    struct waiting_scan *scans;
    size_t count, capacity;
};

/*
 * A scan and when it was received; it is the buffer's until it is taken. Nothing received before
 * clock_us is still to come.
 */
void reorder_buffer_put(struct reorder_buffer *buffer, const struct sensor_scan *scan,
                        int64_t heard_us, int64_t clock_us);

/*
 * Once one scan has waited long enough: takes out the scan of the earliest time of those that had
 * come by then, of equal times the one that came first. With all, nothing more comes.
 */
bool reorder_buffer_take(struct reorder_buffer *buffer, bool all, struct sensor_scan *scan);

void reorder_buffer_free(struct reorder_buffer *buffer);

#endif
