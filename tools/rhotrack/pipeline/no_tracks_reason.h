/* SPDX-License-Identifier: MIT */
/* no_tracks_reason: why a run confirmed no track, as far as its scans and settings show it. */
#ifndef RHOTRACK_TOOL_NO_TRACKS_REASON_H
#define RHOTRACK_TOOL_NO_TRACKS_REASON_H

#include <stdint.h>
#include <stdio.h>

#include "rhotrack/tracker.h"
#include "settings/parameters.h"

/* What was seen of the scans of plots; all zero at the start. */
struct no_tracks {
    uint64_t scans, plots, lone; /* lone: of one plot and no sector, soon after the last one */
    uint64_t intervals;          /* between scans of the sensor that came first */
    int64_t first_us, last_us;   /* of that sensor */
    int32_t sensor_id;
};

void no_tracks_reason_add_scan(struct no_tracks *seen, const struct rho_scan *scan);

/* One line: the reason, with its figure and the setting that goes with it. */
void no_tracks_reason_say(const struct no_tracks *seen, const struct rho_tracker *tracker,
                          const struct parameters *parameters, FILE *file);

#endif
