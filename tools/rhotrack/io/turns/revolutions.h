/* SPDX-License-Identifier: MIT */
/*
 * revolutions: the last scans of files as one batch, in which the sectors of a turn are one scan.
 *
 * Which sectors are one turn says the library's window (rho_window_continues), for each sensor by
 * itself. The time of a turn is its first sector's, its plots' own times count from there. A scan
 * of the whole circle is a turn. What comes behind a later scan of its sensor (files in the order
 * of reception) is left out.
 */
#ifndef RHOTRACK_TOOL_REVOLUTIONS_H
#define RHOTRACK_TOOL_REVOLUTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/types.h"

struct revolution {
    struct rho_scan scan;
    struct rho_plot *plots; /* of the scan */
    bool has_sensor;        /* something was said of it */
    struct rho_sensor sensor;
};

struct revolutions {
    struct revolution *list; /* by time, the last `max` of all */
    size_t count, max;
    uint64_t total; /* of the files */
    uint64_t late;  /* scans left out */
};

/*
 * Reads all scans, and says on standard error if the files have more turns than max (1 and more),
 * and what came late. Memory: that of the turns kept, and a struct rho_window for each sensor that
 * looks by sectors.
 */
struct scan_reader;
struct revolutions revolutions_read_last(struct scan_reader *reader, size_t max);
void revolutions_free(struct revolutions *revolutions);

#endif
