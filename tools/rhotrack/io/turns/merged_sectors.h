/* SPDX-License-Identifier: MIT */
/*
 * merged_sectors: the last scans of files as one batch, in which the sectors of one turn
 * are merged into one scan.
 *
 * The library's window (rho_window_continues_newest) tells, for each sensor by itself,
 * which sectors form one turn. A turn has the time of its first sector, and its plots' offsets
 * count from there. A scan of the whole circle is a turn. A scan older than one before it of the
 * same sensor (files in the order of reception) is left out.
 */
#ifndef RHOTRACK_TOOL_MERGED_SECTORS_H
#define RHOTRACK_TOOL_MERGED_SECTORS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rhotrack/types.h"

struct revolution {
    struct rho_scan scan;
    struct rho_plot *plots; /* plots that scan points to */
    bool has_sensor;        /* a description of the sensor was given */
    struct rho_sensor sensor;
};

struct revolutions {
    struct revolution *list; /* turns by time: the last `max` of all */
    size_t count, max;
    uint64_t total; /* turns in the files */
    uint64_t late;  /* out-of-sequence scans left out */
};

/*
 * Reads all scans. Reports on standard error if the files have more turns than max (at least 1),
 * and out-of-sequence scans left out. Memory: the turns kept, and a struct rho_window for each
 * sensor that scans in sectors.
 */
struct plot_reader;
struct revolutions revolutions_read_last(struct plot_reader *reader, size_t max);
void revolutions_free(struct revolutions *revolutions);

#endif
