/* SPDX-License-Identifier: MIT */
/*
 * time_alignment: which rows of tracks count at which times of a truth. Times ascend in both.
 *
 * A clock's bias that was taken off is known to milliseconds, so that tracks have other times than
 * the truth: each of the truth's times has the rows of the nearest time of the tracks, within a
 * tolerance. The rows count as if at the truth's time.
 */
#ifndef RHOTRACK_TOOL_TIME_ALIGNMENT_H
#define RHOTRACK_TOOL_TIME_ALIGNMENT_H

#include <stddef.h>
#include <stdint.h>

#include "io/csv/table.h"
#include "settings/parameters.h"

#define ALIGNMENT_LEAST_US 1000 /* times that are no further apart are one in any case */

struct alignment_times {
    int64_t *list_us;
    size_t count;
};

struct aligned_row {
    size_t row; /* of the tracks' times */
    int64_t to_us;
};

struct alignment {
    struct aligned_row *list; /* by time; to be freed */
    size_t count;
};

/* time_tolerance_s, at least ALIGNMENT_LEAST_US. */
int64_t alignment_tolerance_us(const struct parameters *parameters);

/*
 * The first of the tracks' times that is further from each of the truth's than that; their count
 * where there is none.
 */
size_t alignment_find_unmatched(struct alignment_times tracks, struct alignment_times truth,
                                int64_t most_us);

/* Exit 2: the truth has no such time. */
_Noreturn void alignment_fail_unmatched(const struct table *tracks, size_t row, int64_t most_us);

/*
 * Which rows of the tracks are used at each of the truth's times. A row may be used at none of
 * them, or at several.
 */
struct alignment alignment_to_truth(struct alignment_times tracks, struct alignment_times truth,
                                    int64_t most_us);

#endif
