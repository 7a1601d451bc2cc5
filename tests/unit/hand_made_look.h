/* SPDX-License-Identifier: MIT */
/* A look at the plots of tracker_setup.h, for tests of one phase of a step by private headers. */
#ifndef HAND_MADE_LOOK_H
#define HAND_MADE_LOOK_H

#include "tracker_setup.h"

static struct step at;
static struct rho_scan scan;

/* A look with range rates, within whose view the first tracks are. Its plots are of no track. */
static inline void begin_look(int64_t time_us, float sigma_m)
{
    scan = (struct rho_scan){.time_us = time_us,
                             .measures = RHO_MEASURES_RANGE_RATE,
                             .num_plots = num_plots,
                             .plots = plots};
    at = (struct step){.tracker = &tracker,
                       .report = &report,
                       .look = {.tracker = &tracker,
                                .scan = &scan,
                                .fates = report.fates,
                                .time_us = time_us,
                                .teaches = 1,
                                .num_inputs = num_plots,
                                .num_gated = num_plots,
                                .sigma_max_m = sigma_m,
                                .in_view = {3}}};
    for (uint32_t i = 0; i < num_plots; i++) {
        report.fates[i] = RHO_FATE_HELD;
    }
    for (unsigned row = 0; row < tracker.num_tracks; row++) {
        tracker.tracks[row].time_us = time_us; /* as they are predicted to it */
    }
    memset(&tracker.bodies.groups, 0xff, sizeof tracker.bodies.groups);
    rho_plots_index(&tracker, &at.look);
    rho_work_begin_phase(&tracker, &at.work, 1);
}

#endif
