/* SPDX-License-Identifier: MIT */
#include "io/scans/reorder_buffer.h"

#include <stdlib.h>
#include <string.h>

#include "base/common.h"

int64_t sensor_scan_time_us(const struct sensor_scan *scan)
{
    return scan->is_bearings ? scan->bearings.time_us : scan->scan.time_us;
}

void sensor_scan_free(struct sensor_scan *scan)
{
    free((void *)scan->scan.plots);
    free((void *)scan->bearings.bearings);
    *scan = (struct sensor_scan){.path = NULL};
}

void reorder_buffer_put(struct reorder_buffer *buffer, const struct sensor_scan *scan,
                        int64_t heard_us, int64_t clock_us)
{
    buffer->scans = must_make_room_for_one(buffer->scans, buffer->count, &buffer->capacity,
                                           sizeof *buffer->scans);
    buffer->scans[buffer->count++] = (struct waiting_scan){.scan = *scan, .heard_us = heard_us};
    buffer->clock_us = clock_us;
}

static size_t first_received_scan(const struct reorder_buffer *buffer)
{
    size_t first = 0;

    for (size_t i = 1; i < buffer->count; i++) {
        first = buffer->scans[i].heard_us < buffer->scans[first].heard_us ? i : first;
    }
    return first;
}

/* Scans received more than hold_us after the scan that was received first do not go before it. */
bool reorder_buffer_take(struct reorder_buffer *buffer, bool all, struct sensor_scan *scan)
{
    size_t first;
    int64_t due_us;

    if (buffer->count == 0) {
        return false;
    }
    first = first_received_scan(buffer);
    due_us = buffer->scans[first].heard_us + buffer->hold_us;
    if (!all && buffer->clock_us < due_us) {
        return false;
    }
    for (size_t i = 0; i < buffer->count; i++) {
        int64_t time_us = sensor_scan_time_us(&buffer->scans[i].scan),
                first_us = sensor_scan_time_us(&buffer->scans[first].scan);

        if (buffer->scans[i].heard_us <= due_us &&
            (time_us < first_us || (time_us == first_us && i < first))) {
            first = i;
        }
    }
    *scan = buffer->scans[first].scan;
    buffer->count--;
    memmove(buffer->scans + first, buffer->scans + first + 1,
            (buffer->count - first) * sizeof *buffer->scans);
    return true;
}

void reorder_buffer_free(struct reorder_buffer *buffer)
{
    for (size_t i = 0; i < buffer->count; i++) {
        sensor_scan_free(&buffer->scans[i].scan);
    }
    free(buffer->scans);
    *buffer = (struct reorder_buffer){.count = 0};
}
