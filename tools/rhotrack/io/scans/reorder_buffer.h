/* SPDX-License-Identifier: MIT */
/*
 * reorder_buffer: puts scans, which are added in the order of reception, in the order of their
 * times, as far as they arrive within hold_us. A scan that arrives later is given out at once: the
 * tracker takes it as out of sequence.
 */
#ifndef RHOTRACK_TOOL_REORDER_BUFFER_H
#define RHOTRACK_TOOL_REORDER_BUFFER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/types.h"

/* A scan of plots with its sensor, or a scan of bearings; it owns the memory of its list. */
struct sensor_scan {
    bool is_bearings;
    struct rho_scan scan;
    struct rho_bearing_scan bearings;
    bool has_sensor; /* of plots: a description of the sensor was given */
    struct rho_sensor sensor;
    const char *path; /* of bearings: file and line of its first row */
    uint32_t line;
};
int64_t sensor_scan_time_us(const struct sensor_scan *scan);
void sensor_scan_free(struct sensor_scan *scan);

struct waiting_scan {
    struct sensor_scan scan;
    int64_t heard_us;
};

/* The buffer. Initialised with zeros but for hold_us. */
struct reorder_buffer {
    int64_t hold_us;  /* longest wait for earlier scans */
    int64_t clock_us; /* reception clock */
    struct waiting_scan *scans;
    size_t count, capacity;
};

/*
 * Adds a scan with its reception time; the buffer owns it until it is taken. No scan received
 * before clock_us is still to come.
 */
void reorder_buffer_put(struct reorder_buffer *buffer, const struct sensor_scan *scan,
                        int64_t heard_us, int64_t clock_us);

/*
 * Takes out the next scan: once the scan received first has waited hold_us, the one of the earliest
 * time among those received by then; at equal times the one received first. With all, without
 * waiting, since no more scans come. Returns false where none is due.
 */
bool reorder_buffer_take(struct reorder_buffer *buffer, bool all, struct sensor_scan *scan);

void reorder_buffer_free(struct reorder_buffer *buffer);

#endif
