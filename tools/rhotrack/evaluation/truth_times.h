/* SPDX-License-Identifier: MIT */
/*
 * truth_times: a truth at the times of the tracks.
 *
 * Rows of a truth are one target's, at its own times. Between two of them the target is where a
 * cubic leads that has both places and velocities (without velocities a straight line). It exists
 * from its first row to its last one, gaps apart: rows farther apart than truth_gap_s, or than
 * TRUTH_GAP_INTERVALS times the median interval of its rows.
 */
#ifndef RHOTRACK_TOOL_TRUTH_TIMES_H
#define RHOTRACK_TOOL_TRUTH_TIMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "evaluation/evaluation.h"

/*
 * Three missing rows in turn are common in receivers of AIS and ADS-B; a target out of coverage is
 * away for more. At half of it two missing rows end a target, at twice of it a track that goes on
 * for nine scans where nobody is counts as right.
 */
#define TRUTH_GAP_INTERVALS 5

struct timed_point {
    int64_t time_us;
    size_t row; /* row in the table that it was read from */
    bool is_tentative;
    struct evaluation_point point;
};

/* Sorted by time, then by row of the file. */
struct timed_points {
    struct timed_point *list;
    size_t count;
};

/*
 * Whether the truth has the times of the tracks, which are compared at its times then: each track
 * row is within tolerance_us of a truth time, no target is without a row at more than a third of
 * the tracks' times of its life (gaps apart), and the tracks have some two truth times in turn (a
 * truth of more times than there were scans does not say when one was missed). gap_us 0: by
 * TRUTH_GAP_INTERVALS. Tentative rows do not count.
 */
bool truth_has_times_of_tracks(const struct timed_points *truth, const struct timed_points *tracks,
                               int64_t gap_us, int64_t tolerance_us);

/*
 * The truth at every time of the tracks, tentative rows included, and at times in their usual
 * interval where no track lives, as long as the truth goes on. The caller frees the list.
 */
struct timed_points truth_at_times_of_tracks(const struct timed_points *truth,
                                             const struct timed_points *tracks, int64_t gap_us,
                                             int64_t tolerance_us);

#endif
