/* SPDX-License-Identifier: MIT */
/*
 * scan_numbers: finds a file's scan by its sensor and number (scan and epoch), in
 * a hash table. Rows of successive scans may be mixed: an antenna may begin a turn before the last
 * plots of the turn before are reported.
 */
#ifndef RHOTRACK_TOOL_SCAN_NUMBERS_H
#define RHOTRACK_TOOL_SCAN_NUMBERS_H

#include <stddef.h>
#include <stdint.h>

#include "io/csv/row_cells.h"

#define SCAN_NUMBERS_NONE SIZE_MAX

/* Hash table from sensors and scan numbers to scans. Initialised with zeros. */
struct scan_numbers {
    struct scan_numbers_slot *slots;
    size_t count, capacity; /* capacity: a power of two */
    size_t dropped;         /* scans with smaller indices are no longer wanted */
};

/*
 * Index of the newest scan of a sensor with a number, or SCAN_NUMBERS_NONE, also where the number
 * is not given. Constant cost.
 */
size_t scan_numbers_find_scan_index(const struct scan_numbers *numbers, int32_t sensor_id,
                                    const struct scan_number *number);

/*
 * Assigns the index of a scan to a sensor and number; does nothing where the number is not given.
 */
void scan_numbers_set_scan(struct scan_numbers *numbers, int32_t sensor_id,
                           const struct scan_number *number, size_t scan);

/*
 * Allows scans with smaller indices to be forgotten, so that memory is needed only for the others.
 */
void scan_numbers_drop_before(struct scan_numbers *numbers, size_t before);

/* Forgets all scans, for another file. */
void scan_numbers_clear(struct scan_numbers *numbers);

#endif
