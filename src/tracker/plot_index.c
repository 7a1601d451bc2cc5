/* SPDX-License-Identifier: MIT */
/*
 * plot_index: the scan's plots sorted by strips of x, so that the plots near a track are found
 * without a pass over the whole scan.
 *
 * A strip is as wide as the extent of the plots over RHO_PLOT_STRIPS. Within a strip plots keep
 * their order. With one strip nothing is sorted: the scan is cut into RHO_PLOT_BOXES runs of
 * successive plots, and runs whose bounding box is elsewhere are skipped. Radars send plots as the
 * antenna turns, so that these boxes are small.
 */
#include <string.h>

#include "plots.h"
#include "rhotrack/detail/approx.h"

/* The strip that holds x; the first or the last one where x is outside of all strips. */
static unsigned strip_of_x(const struct rho_tracker_strips *strips, float x_m)
{
    const float place = (x_m - strips->x_min_m) * strips->per_m;
    if (!(place > 0.0f)) {
        return 0;
    }
    return place < (float)(RHO_PLOT_STRIPS - 1) ? (unsigned)place : RHO_PLOT_STRIPS - 1u;
}

/*
 * Lays the strips over the held plots' extent in x. Counting sort: starts[s + 2] counts strip s;
 * after the sums starts[s + 1] is where its next plot goes, and ends as the start of s + 1.
 */
static void sort_plots_by_strip(struct rho_tracker *tracker, const struct rho_look *look)
{
    struct rho_tracker_strips *strips = &tracker->strips;
    uint16_t *starts = strips->starts;
    float x_min_m = RHO_LIMIT_POSITION_M, x_max_m = -RHO_LIMIT_POSITION_M;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD) {
            const float x_m = look->scan->plots[i].x_m;
            x_min_m = rho_smaller(x_m, x_min_m);
            x_max_m = rho_larger(x_m, x_max_m);
        }
    }
    strips->x_min_m = x_min_m;
    strips->per_m = x_max_m > x_min_m ? (float)RHO_PLOT_STRIPS / (x_max_m - x_min_m) : 0.0f;
    memset(starts, 0, sizeof strips->starts);
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD) {
            starts[strip_of_x(strips, look->scan->plots[i].x_m) + 2u]++;
        }
    }
    for (unsigned s = 2; s < RHO_PLOT_STRIPS; s++) {
        starts[s + 1u] = (uint16_t)(starts[s + 1u] + starts[s]);
    }
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD) {
            strips->plots[starts[strip_of_x(strips, look->scan->plots[i].x_m) + 1u]++] =
                (uint16_t)i;
        }
    }
}

static void bound_plot_boxes(struct rho_look *look)
{
    look->plots_of_box = (look->num_gated + RHO_PLOT_BOXES - 1u) / RHO_PLOT_BOXES;
    for (unsigned k = 0; k < RHO_PLOT_BOXES; k++) {
        const uint32_t first = k * look->plots_of_box, end = first + look->plots_of_box;
        struct rho_extent box = {RHO_LIMIT_POSITION_M, -RHO_LIMIT_POSITION_M, RHO_LIMIT_POSITION_M,
                                 -RHO_LIMIT_POSITION_M};
        for (uint32_t i = first; i < end && i < look->num_gated; i++) {
            const struct rho_plot *plot = &look->scan->plots[i];
            if (look->fates[i] == RHO_FATE_HELD) {
                rho_extent_add(&box, plot->x_m, plot->y_m);
            }
        }
        look->boxes[k] = box;
    }
}

void rho_plots_index(struct rho_tracker *tracker, struct rho_look *look)
{
    if (RHO_PLOT_STRIPS > 1) {
        sort_plots_by_strip(tracker, look);
    } else {
        bound_plot_boxes(look);
    }
}

struct plots_near rho_plots_near(const struct rho_tracker *tracker, float x_min_m, float x_max_m,
                                 float y_min_m, float y_max_m)
{
    struct plots_near near = {.within = {x_min_m, x_max_m, y_min_m, y_max_m}};
    if (RHO_PLOT_STRIPS > 1) {
        const struct rho_tracker_strips *strips = &tracker->strips;
        near.next = strips->starts[strip_of_x(strips, x_min_m)];
        near.end = strips->starts[strip_of_x(strips, x_max_m) + 1u];
    }
    return near;
}

int rho_plots_next_box(const struct rho_look *look, struct plots_near *near)
{
    const struct rho_extent within = near->within;
    for (unsigned k = near->box; k < RHO_PLOT_BOXES; k++) {
        const struct rho_extent *box = &look->boxes[k];
        if (!(box->x_min_m > within.x_max_m || box->x_max_m < within.x_min_m ||
              box->y_min_m > within.y_max_m || box->y_max_m < within.y_min_m)) {
            const uint32_t end = (k + 1u) * look->plots_of_box;
            near->box = k + 1u;
            near->next = k * look->plots_of_box;
            near->end = end < look->num_gated ? end : look->num_gated;
            return near->next < near->end;
        }
    }
    return 0;
}
