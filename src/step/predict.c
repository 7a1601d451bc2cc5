/* SPDX-License-Identifier: MIT */
/*
 * predict: moves tracks to the scan's time.
 *
 * A track that the scan cannot see stays at its own time: scans of other sectors or sensors change
 * no bit of its estimate.
 */
#include "phases.h"

void rho_tracker_predict_or_end_track(struct step *step, struct rho_track *track)
{
    /* the prediction fails where the covariance has grown beyond its limits */
    if (rho_track_predict(track, step->look.time_us, &step->look.model) != RHO_OK) {
        rho_tracker_end_track(step, track);
    }
}

void rho_tracker_predict(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        track->plot = -1;
        if (RHO_SECTORS) {
            rho_tracker_store_track_time_before_late_scan(track);
        }
        if (!rho_tracker_is_track_frozen(track) &&
            rho_tracker_may_scan_see_track(&step->look, track) &&
            !(RHO_SECTORS && rho_tracker_was_seen_in_last_sector(&step->look, track)) &&
            !rho_tracker_is_only_seen_by_suspect_sensor(&step->look, track)) {
            step->look.in_view[i / 32] |= 1u << i % 32;
            rho_tracker_predict_or_end_track(step, track);
        }
    }
}
