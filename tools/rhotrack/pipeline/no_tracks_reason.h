/* SPDX-License-Identifier: MIT */
/*
 * no_tracks_reason: explains why a run confirmed no track, from its scans, counters and settings.
 */
#ifndef RHOTRACK_TOOL_NO_TRACKS_REASON_H
#define RHOTRACK_TOOL_NO_TRACKS_REASON_H

#include <stdint.h>
#include <stdio.h>

#include "rhotrack/tracker.h"
#include "settings/parameters.h"

/* Statistics of the plot scans of a run; all zero at the start. */
struct no_tracks {
    /* lone: scans of one plot without a sector, within 1 s of the one before */
    uint64_t scans, plots, lone;
    uint64_t intervals;        /* scan intervals of the first sensor */
    int64_t first_us, last_us; /* times of the first sensor's first and last scan */
    int32_t sensor_id;
};

void no_tracks_reason_add_scan(struct no_tracks *seen, const struct rho_scan *scan);

/* Prints one line with the most likely reason, its figure, and the setting that would help. */
void no_tracks_reason_print(const struct no_tracks *seen, const struct rho_tracker *tracker,
                            const struct parameters *parameters, FILE *file);

#endif
