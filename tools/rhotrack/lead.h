/* SPDX-License-Identifier: MIT */
/*
 * lead: which rows of tracks count at which times of a truth. Times ascend in both.
 *
 * A clock's bias that was taken off is known to milliseconds, so that tracks have other times than the truth: each of the
 * truth's times has the rows of the nearest time of the tracks, within a tolerance. Who has the rows leads them there.
 */
#ifndef RHOTRACK_TOOL_LEAD_H
#define RHOTRACK_TOOL_LEAD_H

#include <stddef.h>
#include <stdint.h>

#include "parameters.h"
#include "table.h"

#define LEAD_LEAST_US 1000 /* times that are no further apart are one in any case */

struct lead_times {
    int64_t *list_us;
    size_t count;
};

struct lead {
    size_t row; /* of the tracks' times */
    int64_t to_us;
};

struct leads {
    struct lead *list; /* by time; to be freed */
    size_t count;
};

/* time_tolerance_s, at least LEAD_LEAST_US. */
int64_t lead_tolerance_us(const struct parameters *parameters);

/* The first of the tracks' times that is further from each of the truth's than that; their count where there is none. */
size_t lead_find_far(struct lead_times tracks, struct lead_times truth, int64_t most_us);

/* Exit 2: the truth has no such time. */
_Noreturn void lead_fail(const struct table *tracks, size_t row, int64_t most_us);

/* The rows that count at each of the truth's times, some at none, some at more than one. */
struct leads lead_to_truth(struct lead_times tracks, struct lead_times truth, int64_t most_us);

#endif
