/* SPDX-License-Identifier: MIT */
#include "hold.h"

#include <stdlib.h>
#include <string.h>

#include "common.h"

void hold_put(struct hold *hold, const struct plot_scan *scan, int64_t heard_us, int64_t clock_us)
{
    hold->scans = must_grow(hold->scans, hold->count, &hold->capacity, sizeof *hold->scans);
    hold->scans[hold->count++] = (struct held_scan){.scan = *scan, .heard_us = heard_us};
    hold->clock_us = clock_us;
}

static size_t first_heard(const struct hold *hold)
{
    size_t first = 0;

    for (size_t i = 1; i < hold->count; i++) {
        first = hold->scans[i].heard_us < hold->scans[first].heard_us ? i : first;
    }
    return first;
}

/* When the one that was received first has waited long enough: what came after that is not waited for. */
bool hold_take(struct hold *hold, bool all, struct plot_scan *scan)
{
    size_t first;
    int64_t due_us;

    if (hold->count == 0) {
        return false;
    }
    first = first_heard(hold);
    due_us = hold->scans[first].heard_us + hold->hold_us;
    if (!all && hold->clock_us < due_us) {
        return false;
    }
    for (size_t i = 0; i < hold->count; i++) {
        int64_t time_us = hold->scans[i].scan.scan.time_us,
                first_us = hold->scans[first].scan.scan.time_us;

        if (hold->scans[i].heard_us <= due_us &&
            (time_us < first_us || (time_us == first_us && i < first))) {
            first = i;
        }
    }
    *scan = hold->scans[first].scan;
    hold->count--;
    memmove(hold->scans + first, hold->scans + first + 1,
            (hold->count - first) * sizeof *hold->scans);
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
