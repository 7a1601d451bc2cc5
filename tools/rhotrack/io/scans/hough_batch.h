/* SPDX-License-Identifier: MIT */
/*
 * hough_batch: the plots of several scans as the arrays that the library's Hough
 * transforms take.
 */
#ifndef RHOTRACK_TOOL_HOUGH_BATCH_H
#define RHOTRACK_TOOL_HOUGH_BATCH_H

#include "io/turns/merged_sectors.h"
#include "rhotrack/hough.h"

struct hough_batch {
    int64_t time_us; /* time of the last scan, which t_s counts from */
    unsigned num_scans;
    uint32_t scan_end[RHO_MAX_SCANS];
    uint32_t num_plots, num_invalid, room;
    float *x_m, *y_m, *t_s;
    double range_m; /* range of the farthest plot from the origin */
};

/* Makes a batch of at most RHO_MAX_SCANS scans. Exit 2 where they span too long a time. */
struct hough_batch hough_batch_from_revolutions(const struct revolutions *revolutions);

/*
 * Reports on standard error how many plots are left out, since their coordinates are out of range.
 */
void hough_batch_report_beyond(const struct hough_batch *batch);

/* The batch in the library's form; the arrays still belong to the batch. */
struct rho_hough_points hough_batch_points(const struct hough_batch *batch);
void hough_batch_free(struct hough_batch *batch);

#endif
