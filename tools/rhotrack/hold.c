/* SPDX-License-Identifier: MIT */
#include "hold.h"

#include <stdlib.h>
#include <string.h>

#include "common.h"

void hold_put(struct hold *hold, const struct plot_scan *scan, int64_t heard_us)
{
    hold->scans = must_grow(hold->scans, hold->count, &hold->capacity, sizeof *hold->scans);
    hold->scans[hold->count++] = (struct held_scan){.scan = *scan, .heard_us = heard_us};
    hold->clock_us = heard_us;
}

/* When the one that was received first has waited long enough: what came after that is not waited for. */
static int64_t due_of(const struct hold *hold)
{
    int64_t heard_us = hold->scans[0].heard_us;

    for (size_t i = 1; i < hold->count; i++) {
        heard_us = hold->scans[i].heard_us < heard_us ? hold->scans[i].heard_us : heard_us;
    }
    return heard_us + hold->hold_us;
}

bool hold_take(struct hold *hold, bool all, struct plot_scan *scan)
{
    struct held_scan *first = NULL;
    int64_t due_us = hold->count > 0 ? due_of(hold) : 0;

    if (hold->count == 0 || !(all || hold->clock_us >= due_us)) {
        return false;
    }
    for (size_t i = 0; i < hold->count; i++) {
        struct held_scan *held = &hold->scans[i];

        if (held->heard_us <= due_us &&
            (!first || held->scan.scan.time_us < first->scan.scan.time_us)) {
            first = held;
        }
    }
    *scan = first->scan;
    hold->count--;
    memmove(first, first + 1, (size_t)(hold->scans + hold->count - first) * sizeof *first);
    return true;
}

void hold_free(struct hold *hold)
{
    for (size_t i = 0; i < hold->count; i++) {
        plot_scan_free(&hold->scans[i].scan);
    }
    free(hold->scans);
    *hold = (struct hold){.count = 0};
}
