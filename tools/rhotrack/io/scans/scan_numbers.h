/* SPDX-License-Identifier: MIT */
/*
 * scan_numbers: which scan of a file has a number. Rows of successive scans may come mixed: a radar
 * that turns begins a scan before the last plots of the one before have their time.
 */
#ifndef RHOTRACK_TOOL_SCAN_NUMBERS_H
#define RHOTRACK_TOOL_SCAN_NUMBERS_H

#include <stddef.h>
#include <stdint.h>

#include "io/csv/row_check.h"

#define SCAN_NUMBERS_NONE SIZE_MAX

/* Starts as zeros. */
struct scan_numbers {
    struct scan_numbers_slot *slots;
    size_t count, capacity; /* capacity: a power of two */
    size_t dropped;         /* scans before this one are not wanted any more */
};

/*
 * The newest scan of a sensor with that number, or SCAN_NUMBERS_NONE, also for a number that is not
 * given. Constant cost.
 */
size_t scan_numbers_find_scan(const struct scan_numbers *numbers, int32_t sensor_id,
                              const struct row_number *number);

/* From now on that scan; a number that is not given leaves all as it is. */
void scan_numbers_set_scan(struct scan_numbers *numbers, int32_t sensor_id,
                           const struct row_number *number, size_t scan);

/* Scans before that one may be forgotten: memory is that for those from it on. */
void scan_numbers_drop_before(struct scan_numbers *numbers, size_t before);

/* Forgets all, as before another file. */
void scan_numbers_clear(struct scan_numbers *numbers);

#endif
