/* SPDX-License-Identifier: MIT */
/*
 * claim_large_scan_in_parts: claims plots of a scan that has more than RHO_MAX_PLOTS. Existing
 * tracks come first: they may claim the plots beyond that limit, too.
 *
 * The scan is claimed in parts of RHO_MAX_PLOTS. In each part the tracks that have no plot yet
 * claim one; a track without a plot after the last part is missed. Only plots of the first part
 * have places in fates[] and are held: unclaimed plots of later parts are NO_ROOM.
 */
#include <string.h>

#include "phases.h"

/* Largest row of a plot that the int16_t field of a track holds. */
#define ROWS_MAX ((uint32_t)INT16_MAX)

static void select_scan_part(struct rho_look *look, struct rho_scan *part,
                             const struct rho_scan *whole, uint32_t first, uint32_t end)
{
    *part = *whole;
    part->plots += first;
    part->num_plots = end - first < RHO_MAX_PLOTS ? end - first : RHO_MAX_PLOTS;
    look->scan = part;
    look->first_row = first;
    look->num_gated = part->num_plots;
    look->has_more_parts = end - first > RHO_MAX_PLOTS;
}

/*
 * Excludes tracks that were assigned a plot, taken or refused, from later parts; their plots get
 * the rows of the whole scan. Counts claimed and invalid plots that have no place in fates[].
 */
static void exclude_assigned_tracks(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        const int had = rho_assignment_column(&tracker->assignment, i) != RHO_ASSIGNMENT_NONE;
        if (rho_tracker_is_track_in_view(&step->look, i) && (track->plot >= 0 || had)) {
            track->plot =
                (int16_t)(track->plot < 0 ? -1 : track->plot + (int32_t)step->look.first_row);
            step->look.in_view[i / 32] &= ~(1u << i % 32);
        }
    }
    for (uint32_t i = 0; i < step->look.num_gated && step->look.first_row > 0; i++) {
        step->num_beyond_claimed += step->report->fates[i] == RHO_FATE_CLAIMED ? 1u : 0u;
        step->num_beyond_invalid += step->report->fates[i] == RHO_FATE_INVALID ? 1u : 0u;
    }
}

static uint32_t num_plots_in_all_parts(const struct rho_scan *whole)
{
    const uint32_t most = RHO_TRACKER_PARTS_MAX * RHO_MAX_PLOTS < ROWS_MAX
                              ? RHO_TRACKER_PARTS_MAX * RHO_MAX_PLOTS
                              : ROWS_MAX;
    return whole->num_plots < most ? whole->num_plots : most;
}

void rho_tracker_claim_and_update_in_plot_parts(struct step *step)
{
    const struct rho_look before = step->look;
    const uint32_t end = num_plots_in_all_parts(before.scan);
    uint8_t fates[RHO_MAX_PLOTS];
    struct rho_scan part;
    for (uint32_t first = 0; first < end; first += RHO_MAX_PLOTS) {
        select_scan_part(&step->look, &part, before.scan, first, end);
        rho_tracker_claim(step->tracker, &step->look, &step->work);
        rho_tracker_update(step->tracker, &step->look, &step->work);
        exclude_assigned_tracks(step);
        if (first == 0) {
            memcpy(fates, step->report->fates, sizeof fates);
        }
    }
    memcpy(step->report->fates, fates, sizeof fates);
    memcpy(step->look.in_view, before.in_view, sizeof before.in_view);
    step->look.part_share = before.part_share;
    step->look.part_per_m2 = before.part_per_m2;
    step->look.scan = before.scan;
    step->look.first_row = before.first_row;
    step->look.num_gated = before.num_gated;
}
