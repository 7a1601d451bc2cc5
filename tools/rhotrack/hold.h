/* SPDX-License-Identifier: MIT */
/*
 * hold: scans in the order in which they were received go out in the order of their times, as far as they come within a time to
 * wait. One that comes later than that goes out at once: the tracker knows what to do with it.
 */
#ifndef RHOTRACK_TOOL_HOLD_H
#define RHOTRACK_TOOL_HOLD_H

#include "plot_source.h"

struct held_scan {
    struct plot_scan scan;
    int64_t heard_us;
};

/* All 0 but for the time to wait: empty. */
struct hold {
    int64_t hold_us;
    int64_t clock_us; /* now */
    struct held_scan *scans;
    size_t count, capacity;
};

/* A scan and when it was received; it is the hold's until it is taken. clock_us: what was received since is in later scans alone. */
void hold_put(struct hold *hold, const struct plot_scan *scan, int64_t heard_us, int64_t clock_us);

/* Once one of them has waited long enough: takes out the scan of the earliest time of those that were there then, of equal times the
 * one that came first. With all, nothing more comes. */
bool hold_take(struct hold *hold, bool all, struct plot_scan *scan);

void hold_free(struct hold *hold);

#endif
