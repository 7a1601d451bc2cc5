/* SPDX-License-Identifier: MIT */
/*
 * tracker_beyond: scans of more plots than there is room for. Existing tracks are kept first: they look at the others, too.
 *
 * The scan is gone through in parts of RHO_MAX_PLOTS. In each, tracks that have no plot yet claim theirs; who has none after
 * the last part has missed. Fates have places, and plots are held, of the first part alone: what nobody claims of the
 * others is NO_ROOM.
 */
#include <string.h>

#include "tracker_step.h"

#if RHO_CLAIMS_BEYOND

/* Rows that a track can tell. */
#define ROWS_MAX ((uint32_t)INT16_MAX)

struct part {
    struct rho_scan scan;
    uint32_t first;
};

/*
 * What the initiator knows of clutter is of the first parts of the scans before. The others are as dense as their own plots
 * lie, or as the first one where all are mixed.
 */
static void measure_part(struct step *step, const struct rho_scan *whole)
{
    struct rho_extent extent = {0.0f, 0.0f, 0.0f, 0.0f};
    float num = 0.0f;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            const struct rho_plot *plot = &step->scan->plots[i];
            if (num < 1.0f) {
                extent = (struct rho_extent){plot->x_m, plot->x_m, plot->y_m, plot->y_m};
            }
            rho_extent_add(&extent, plot->x_m, plot->y_m);
            num += 1.0f;
        }
    }
    step->part_per_m2 = num / rho_extent_area_m2(&extent, RHO_CLUTTER_SIDE_MIN_M);
    step->part_share = (float)whole->num_plots / (float)RHO_MAX_PLOTS;
}

static void begin_part(struct step *step, struct part *part, const struct rho_scan *whole,
                       uint32_t first, uint32_t end)
{
    part->scan = *whole;
    part->scan.plots += first;
    part->scan.num_plots = end - first < RHO_MAX_PLOTS ? end - first : RHO_MAX_PLOTS;
    part->first = first;
    step->scan = &part->scan;
    step->num_gated = part->scan.num_plots;
    step->has_more_parts = end - first > RHO_MAX_PLOTS;
    rho_tracker_judge_plots(step);
    rho_tracker_sort_plots(step);
    rho_tracker_use_repeats(step, first == 0);
    if (first == 0) {
        rho_tracker_look_at_clutter(step);
    } else {
        measure_part(step, whole);
    }
}

/* Who got a plot, taken or refused, is out of the others' reach. Plots are told by their rows in the whole scan. */
static void end_part(struct step *step, const struct part *part)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        const int had = rho_assignment_column(&tracker->assignment, i) != RHO_ASSIGNMENT_NONE;
        if (rho_tracker_is_reached(step, i) && (track->plot >= 0 || had)) {
            track->plot = (int16_t)(track->plot < 0 ? -1 : track->plot + (int32_t)part->first);
            step->reached[i / 32] &= ~(1u << i % 32);
        }
    }
    for (uint32_t i = 0; i < step->num_gated && part->first > 0; i++) {
        step->num_beyond_claimed += step->report->fates[i] == RHO_FATE_CLAIMED ? 1u : 0u;
        step->num_beyond_invalid += step->report->fates[i] == RHO_FATE_INVALID ? 1u : 0u;
    }
}

static uint32_t end_of_parts(const struct rho_scan *whole)
{
    const uint32_t most = RHO_TRACKER_PARTS_MAX * RHO_MAX_PLOTS < ROWS_MAX
                              ? RHO_TRACKER_PARTS_MAX * RHO_MAX_PLOTS
                              : ROWS_MAX;
    return whole->num_plots < most ? whole->num_plots : most;
}

void rho_tracker_claim_parts(struct step *step)
{
    const struct step before = *step;
    const uint32_t end = end_of_parts(before.scan);
    uint8_t fates[RHO_MAX_PLOTS];
    struct part part;
    for (uint32_t first = 0; first < end; first += RHO_MAX_PLOTS) {
        begin_part(step, &part, before.scan, first, end);
        rho_tracker_claim(step);
        rho_tracker_watch(step);
        rho_tracker_learn(step);
        rho_tracker_update(step);
        end_part(step, &part);
        if (first == 0) {
            memcpy(fates, step->report->fates, sizeof fates);
        }
    }
    memcpy(step->report->fates, fates, sizeof fates);
    rho_tracker_use_repeats(step, 1);
    memcpy(step->reached, before.reached, sizeof step->reached);
    step->part_share = before.part_share;
    step->part_per_m2 = before.part_per_m2;
    step->scan = before.scan;
    step->num_gated = before.num_gated;
}

#else

typedef int rho_tracker_claims_nothing_beyond; /* a file must not be empty */

#endif
