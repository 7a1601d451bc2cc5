/* SPDX-License-Identifier: MIT */
/*
 * lone_plots: whether a file's plots, each with a time of its own, have become scans of one plot each: then a turn was
 * meant as the scan, and scan_interval_s makes it.
 */
#ifndef RHOTRACK_TOOL_LONE_PLOTS_H
#define RHOTRACK_TOOL_LONE_PLOTS_H

#include <stddef.h>
#include <stdint.h>

#include "message_source.h"

/* All zero at the start. */
struct lone_plots {
    uint64_t scans,
        lone; /* lone: of one plot, without a sector, soon after its sensor's last scan */
    struct lone_sensor *sensors;
    size_t count, capacity;
};

/* A message of the file; others than scans of plots are left out. */
void lone_plots_add(struct lone_plots *plots, const struct message_event *event);

/* One line on standard error where most scans are such. */
void lone_plots_report(const struct lone_plots *plots, const char *path);

void lone_plots_free(struct lone_plots *plots);

#endif
