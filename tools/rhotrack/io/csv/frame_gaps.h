/* SPDX-License-Identifier: MIT */
/*
 * frame_gaps: finds frames without rows in a file whose times are numbers of frames. A radar that
 * saw nothing in a frame has no row to write, but it looked: such a frame is a scan without plots,
 * in which tracks miss.
 */
#ifndef RHOTRACK_TOOL_FRAME_GAPS_H
#define RHOTRACK_TOOL_FRAME_GAPS_H

#include <stdbool.h>
#include <stdint.h>

#include "io/csv/columns.h"

/*
 * Most frames of one gap that count as looks, from its start: enough to end tracks. What a longer
 * gap is beyond them, an empty room or a recording that stood still, is the same to the tracks, and
 * a few rows of a bad file cannot stand for any number of scans.
 */
#define FRAME_GAP_MAX 30

/* The last row of a file, and counts of frames without rows. Initialised with zeros. */
struct frame_gaps {
    bool has_last;
    int32_t sensor_id;
    int64_t frame;
    uint64_t looks, beyond; /* frames that count as looks, and those past FRAME_GAP_MAX */
};

/* Frames that count as looks before a row: count of them, from number first on. */
struct frame_gap {
    double rate_hz;
    int64_t first;
    int count;
};

/*
 * The frames between the last row and this one, which then is the last one, unless its number goes
 * back. None where the file has times, numbers of scans or times of reception, or where the last
 * row is another sensor's, whose frames may be others.
 */
struct frame_gap frame_gaps_before_row(struct frame_gaps *gaps, const struct columns *columns,
                                       int32_t sensor_id, int64_t time_us);

/* Time of a gap's frame, index 0 .. count - 1. */
int64_t frame_gap_time_us(const struct frame_gap *gap, int index);

/* Says on standard error how many frames had no rows, if any. */
void frame_gaps_report(const struct frame_gaps *gaps, const char *path);

#endif
