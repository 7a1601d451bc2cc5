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

/* Work is bounded: what lies beyond so many parts nobody looks at. */
#define PARTS_MAX 4u

struct part {
    struct rho_scan scan;
    uint32_t first;
    uint32_t had_plot[(RHO_MAX_TRACKS + 31) / 32]; /* bit i: track i came with a plot */
};

static void begin_part(struct step *step, struct part *part, const struct rho_scan *whole,
                       uint32_t first)
{
    const struct rho_tracker *tracker = step->tracker;
    const uint32_t left = whole->num_plots - first;
    part->scan = *whole;
    part->scan.plots += first;
    part->scan.num_plots = left < RHO_MAX_PLOTS ? left : RHO_MAX_PLOTS;
    part->first = first;
    memset(part->had_plot, 0, sizeof part->had_plot);
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        part->had_plot[i / 32] |= (tracker->tracks[i].plot >= 0 ? 1u : 0u) << i % 32;
    }
    step->scan = &part->scan;
    step->num_gated = part->scan.num_plots;
    rho_tracker_judge_plots(step);
    rho_tracker_sort_plots(step);
}

/* Plots are told by their rows in the whole scan; those beyond 32767 by that. */
static void end_part(struct step *step, const struct part *part)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        if (track->plot >= 0 && !((part->had_plot[i / 32] >> (i % 32)) & 1u)) {
            const uint32_t row = part->first + (uint16_t)track->plot;
            track->plot = row < INT16_MAX ? (int16_t)row : INT16_MAX;
        }
    }
    for (uint32_t i = 0; i < step->num_gated && part->first > 0; i++) {
        step->num_beyond_claimed += step->report->fates[i] == RHO_FATE_CLAIMED ? 1u : 0u;
        step->num_beyond_invalid += step->report->fates[i] == RHO_FATE_INVALID ? 1u : 0u;
    }
}

void rho_tracker_claim_parts(struct step *step)
{
    const struct rho_scan *whole = step->scan;
    const uint32_t num_gated = step->num_gated;
    const uint32_t end =
        whole->num_plots < PARTS_MAX * RHO_MAX_PLOTS ? whole->num_plots : PARTS_MAX * RHO_MAX_PLOTS;
    uint8_t fates[RHO_MAX_PLOTS];
    struct part part;
    for (uint32_t first = 0; first < end; first += RHO_MAX_PLOTS) {
        begin_part(step, &part, whole, first);
        step->has_more_parts = end - first > RHO_MAX_PLOTS;
        rho_tracker_claim(step);
        rho_tracker_update(step);
        end_part(step, &part);
        if (first == 0) {
            memcpy(fates, step->report->fates, sizeof fates);
        }
    }
    memcpy(step->report->fates, fates, sizeof fates);
    step->scan = whole;
    step->num_gated = num_gated;
}

#else

typedef int rho_tracker_claims_nothing_beyond; /* a file must not be empty */

#endif
