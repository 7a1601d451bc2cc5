/* SPDX-License-Identifier: MIT */
#include "io/scans/hough_batch.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "base/common.h"

#define SPAN_MAX_US INT64_C(900000000000000)

static void make_room_for_plots(struct hough_batch *batch, uint32_t plots)
{
    if (batch->num_plots + plots <= batch->room) {
        return;
    }
    batch->room = 2 * (batch->num_plots + plots);
    batch->x_m = must_realloc(batch->x_m, batch->room * sizeof *batch->x_m);
    batch->y_m = must_realloc(batch->y_m, batch->room * sizeof *batch->y_m);
    batch->t_s = must_realloc(batch->t_s, batch->room * sizeof *batch->t_s);
}

static bool is_plot_in_range(const struct rho_plot *plot)
{
    return rho_is_coordinate(plot->x_m) && rho_is_coordinate(plot->y_m);
}

/* Adds a scan's plots, with times from the first scan until the last scan is known. */
static void add_scan_plots(struct hough_batch *batch, const struct rho_scan *scan, int64_t first_us)
{
    if (scan->time_us - first_us > SPAN_MAX_US) {
        fail(EXIT_USAGE, "the scans used span %.3g s; a batch spans at most %.0g s",
             1e-6 * (double)(scan->time_us - first_us), 1e-6 * (double)SPAN_MAX_US);
    }
    make_room_for_plots(batch, scan->num_plots);
    for (uint32_t i = 0; i < scan->num_plots; i++) {
        const struct rho_plot *plot = &scan->plots[i];

        if (!is_plot_in_range(plot)) {
            batch->num_invalid++;
            continue;
        }
        batch->x_m[batch->num_plots] = plot->x_m;
        batch->y_m[batch->num_plots] = plot->y_m;
        batch->t_s[batch->num_plots++] =
            (float)(1e-6 * (double)(scan->time_us - first_us + plot->offset_us));
        batch->range_m = fmax(batch->range_m, hypot((double)plot->x_m, (double)plot->y_m));
    }
    batch->scan_end[batch->num_scans++] = batch->num_plots;
    batch->time_us = scan->time_us;
}

struct hough_batch hough_batch_from_revolutions(const struct revolutions *revolutions)
{
    struct hough_batch batch = {.num_scans = 0};
    int64_t first_us = revolutions->count > 0 ? revolutions->list[0].scan.time_us : 0;

    for (size_t i = 0; i < revolutions->count; i++) {
        add_scan_plots(&batch, &revolutions->list[i].scan, first_us);
    }
    for (uint32_t i = 0; i < batch.num_plots; i++) {
        batch.t_s[i] -= (float)(1e-6 * (double)(batch.time_us - first_us));
    }
    return batch;
}

void hough_batch_report_beyond(const struct hough_batch *batch)
{
    if (batch->num_invalid) {
        fprintf(stderr, "rhotrack: %" PRIu32 " plots beyond %.0f km are left out\n",
                batch->num_invalid, (double)RHO_LIMIT_POSITION_M / 1e3);
    }
}

struct rho_hough_points hough_batch_points(const struct hough_batch *batch)
{
    return (struct rho_hough_points){
        .at = {batch->x_m, batch->y_m, batch->num_scans, batch->scan_end}, .t_s = batch->t_s};
}

void hough_batch_free(struct hough_batch *batch)
{
    free(batch->x_m);
    free(batch->y_m);
    free(batch->t_s);
}
