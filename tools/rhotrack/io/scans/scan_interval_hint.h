/* SPDX-License-Identifier: MIT */
/*
 * scan_interval_hint: whether a file's plots, each with a time of its own, have become scans of one
 * plot each: then a turn was meant as the scan, and scan_interval_s makes it.
 */
#ifndef RHOTRACK_TOOL_SCAN_INTERVAL_HINT_H
#define RHOTRACK_TOOL_SCAN_INTERVAL_HINT_H

#include <stddef.h>
#include <stdint.h>

#include "io/log/message_source.h"

/* All zero at the start. */
struct scan_interval_hint {
    uint64_t scans,
        lone; /* lone: of one plot, without a sector, soon after its sensor's last scan */
    struct lone_sensor *sensors;
    size_t count, capacity;
};

/* A message of the file; others than scans of plots are left out. */
void scan_interval_hint_add_message(struct scan_interval_hint *plots,
                                    const struct message_event *event);

/* One line on standard error where most scans are such. */
void scan_interval_hint_report(const struct scan_interval_hint *plots, const char *path);

/*
 * The same of sensors that are heard live: a line each, once, where their scans come irregularly
 * as well, as plots of a turn do.
 */
void scan_interval_hint_report_live(struct scan_interval_hint *plots);

void scan_interval_hint_free(struct scan_interval_hint *plots);

#endif
