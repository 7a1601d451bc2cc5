/* SPDX-License-Identifier: MIT */
/*
 * scan_interval_hint: detects plots with a time each that have become scans
 * of one plot: then the user probably forgot scan_interval_s, which gathers the plots of a turn
 * into one scan.
 */
#ifndef RHOTRACK_TOOL_SCAN_INTERVAL_HINT_H
#define RHOTRACK_TOOL_SCAN_INTERVAL_HINT_H

#include <stddef.h>
#include <stdint.h>

#include "io/log/message_source.h"

/* Counts of scans and of lone ones, with a single plot. Initialised with zeros. */
struct scan_interval_hint {
    /* lone: one plot, without a sector, less than a second after the sensor's scan before */
    uint64_t scans, lone;
    struct lone_scan_counts *sensors;
    size_t count, capacity;
};

/* Counts a message; others than scans of plots are ignored. */
void scan_interval_hint_count(struct scan_interval_hint *plots, const struct message_event *event);

/* Reports on standard error, in one line, if most scans have a single plot. */
void scan_interval_hint_report(const struct scan_interval_hint *plots, const char *path);

/*
 * Reports once for each live sensor whose scans mostly have a single plot and come irregularly, as
 * the plots of a turning antenna do.
 */
void scan_interval_hint_report_lone(struct scan_interval_hint *plots);

void scan_interval_hint_free(struct scan_interval_hint *plots);

#endif
