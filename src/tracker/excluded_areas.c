/* SPDX-License-Identifier: MIT */
/* excluded_areas: places in which no plot starts a track. */
#include "rhotrack/operator.h"

#include <string.h>

#include "plots.h"
#include "step.h"

static int is_usable_area(const struct rho_extent *area)
{
    return rho_is_coordinate(area->x_min_m) && rho_is_coordinate(area->x_max_m) &&
           rho_is_coordinate(area->y_min_m) && rho_is_coordinate(area->y_max_m) &&
           area->x_min_m < area->x_max_m && area->y_min_m < area->y_max_m;
}

static int area_contains(const struct rho_extent *area, float x_m, float y_m)
{
    return x_m >= area->x_min_m && x_m <= area->x_max_m && y_m >= area->y_min_m &&
           y_m <= area->y_max_m;
}

enum rho_status rho_tracker_exclude_area(struct rho_tracker *tracker, const struct rho_extent *area)
{
    const enum rho_status status = rho_tracker_check(tracker, area != 0);
    if (status != RHO_OK) {
        return status;
    }
    if (!is_usable_area(area)) {
        return RHO_ERROR_VALUE;
    }
    if (tracker->num_excluded + 1 > RHO_MAX_EXCLUDED_AREAS) {
        return RHO_ERROR_CAPACITY;
    }
    tracker->excluded[tracker->num_excluded++] = *area;
    return RHO_OK;
}

enum rho_status rho_tracker_include_place(struct rho_tracker *tracker, float x_m, float y_m)
{
    const enum rho_status status = rho_tracker_check(tracker, 1);
    if (status != RHO_OK) {
        return status;
    }
    unsigned kept = 0;
    for (unsigned i = 0; i < tracker->num_excluded; i++) {
        if (!area_contains(&tracker->excluded[i], x_m, y_m)) {
            tracker->excluded[kept++] = tracker->excluded[i];
        }
    }
    if (kept == tracker->num_excluded) {
        return RHO_ERROR_VALUE;
    }
    memset(&tracker->excluded[kept], 0,
           (tracker->num_excluded - kept) * sizeof tracker->excluded[0]);
    tracker->num_excluded = (uint16_t)kept;
    return RHO_OK;
}

int rho_areas_are_sound(const struct rho_tracker *tracker)
{
    const int num = tracker->num_excluded;
    int i = 0;
    while (i < num && num <= RHO_MAX_EXCLUDED_AREAS && is_usable_area(&tracker->excluded[i])) {
        i++;
    }
    return i == num;
}

int rho_areas_hold_plot(const struct rho_look *look, uint32_t plot)
{
    const struct rho_tracker *tracker = look->tracker;
    const struct rho_plot *at = &look->scan->plots[plot];
    unsigned k = 0;
    while (k < tracker->num_excluded && !area_contains(&tracker->excluded[k], at->x_m, at->y_m)) {
        k++;
    }
    return k < tracker->num_excluded;
}

void rho_areas_mark_plots(struct rho_tracker *tracker, const struct rho_look *look,
                          struct rho_work *work)
{
    /* half as many units as for plots that an iteration passes over */
    rho_work_spend(work, look->num_gated * tracker->num_excluded / (RHO_WORK_PASSED_A_UNIT * 2u));
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD && rho_areas_hold_plot(look, i)) {
            look->fates[i] = RHO_FATE_GHOST;
            tracker->counters.plots_excluded = rho_count(tracker->counters.plots_excluded, 1);
        }
    }
}
