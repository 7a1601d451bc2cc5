/* SPDX-License-Identifier: MIT */
/*
 * tracker_strips: the scan's plots by strips of x, so that a track looks at those near it alone.
 *
 * A track's box is as wide as its uncertainty, a strip as the scan over RHO_PLOT_STRIPS. Within a strip plots keep their
 * order. With one strip there is nothing to sort: all plots, in their order.
 */
#include <string.h>

#include "tracker_step.h"

#if RHO_PLOT_STRIPS > 1

/* Plots of any place, and limits of any size, have one. */
static unsigned strip_of(const struct rho_tracker_strips *strips, float x_m)
{
    const float place = (x_m - strips->x_min_m) * strips->per_m;
    if (!(place > 0.0f)) {
        return 0;
    }
    return place < (float)(RHO_PLOT_STRIPS - 1) ? (unsigned)place : RHO_PLOT_STRIPS - 1u;
}

/* As wide as the plots that count lie. */
static void lay_strips(struct rho_tracker_strips *strips, const struct step *step)
{
    float x_min_m = RHO_LIMIT_POSITION_M, x_max_m = -RHO_LIMIT_POSITION_M;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            const float x_m = step->scan->plots[i].x_m;
            x_min_m = x_m < x_min_m ? x_m : x_min_m;
            x_max_m = x_m > x_max_m ? x_m : x_max_m;
        }
    }
    strips->x_min_m = x_min_m;
    strips->per_m = x_max_m > x_min_m ? (float)RHO_PLOT_STRIPS / (x_max_m - x_min_m) : 0.0f;
}

/* Counting sort: the plots of strip s are counted two places on, then put one place on, which moves to their end. */
void rho_tracker_sort_plots(struct step *step)
{
    struct rho_tracker_strips *strips = &step->tracker->strips;
    uint16_t *starts = strips->starts;
    lay_strips(strips, step);
    memset(starts, 0, sizeof strips->starts);
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            starts[strip_of(strips, step->scan->plots[i].x_m) + 2u]++;
        }
    }
    for (unsigned s = 2; s < RHO_PLOT_STRIPS; s++) {
        starts[s + 1u] = (uint16_t)(starts[s + 1u] + starts[s]);
    }
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            strips->plots[starts[strip_of(strips, step->scan->plots[i].x_m) + 1u]++] = (uint16_t)i;
        }
    }
}

struct plot_range rho_tracker_plots_between(const struct step *step, float x_min_m, float x_max_m)
{
    const struct rho_tracker_strips *strips = &step->tracker->strips;
    return (struct plot_range){strips->starts[strip_of(strips, x_min_m)],
                               strips->starts[strip_of(strips, x_max_m) + 1u]};
}

#else

typedef int rho_tracker_has_no_strips; /* a file must not be empty */

#endif
