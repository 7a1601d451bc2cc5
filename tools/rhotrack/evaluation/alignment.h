/* SPDX-License-Identifier: MIT */
/*
 * alignment: matches the times of tracks to the times of a truth. Times ascend in
 * both.
 *
 * Where a radar's clock bias was corrected by an estimate, the tracks' times differ from the
 * truth's by milliseconds: each truth time is given the rows of the nearest track time within a
 * tolerance, which are then moved to the truth's time.
 */
#ifndef RHOTRACK_TOOL_ALIGNMENT_H
#define RHOTRACK_TOOL_ALIGNMENT_H

#include <stddef.h>
#include <stdint.h>

#include "io/csv/csv_table.h"
#include "settings/parameters.h"

#define ALIGNMENT_LEAST_US 1000 /* times at most this far apart always count as equal */

/* The times of an array of structs. */
struct alignment_times {
    const int64_t *first_us;
    size_t stride, count; /* stride: bytes from one time to the next */
};

struct aligned_row {
    size_t row; /* index of the track row */
    int64_t to_us;
};

struct alignment {
    struct aligned_row *list; /* in the order of the truth's times; the caller frees it */
    size_t count;
};

/* The parameter time_tolerance_s in microseconds, at least ALIGNMENT_LEAST_US. */
int64_t alignment_tolerance_us(const struct parameters *parameters);

/*
 * Index of the first track time that is further than most_us from every truth time; tracks.count
 * where there is none.
 */
size_t alignment_find_unmatched(struct alignment_times tracks, struct alignment_times truth,
                                int64_t most_us);

/* Ends the program with exit 2: the truth has no time within most_us of this row's time. */
_Noreturn void alignment_fail_unmatched(const struct table *tracks, size_t row, int64_t most_us);

/*
 * Lists the track rows that are used at each truth time. A row may be used at no truth time or at
 * several.
 */
struct alignment alignment_list_rows(struct alignment_times tracks, struct alignment_times truth,
                                     int64_t most_us);

#endif
