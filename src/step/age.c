/* SPDX-License-Identifier: MIT */
/* age: counts misses where the sensor looked, and asks of each track whether it is to end. */
#include "phases.h"
#include "rhotrack/detail/doppler_notch.h"

/*
 * Counts a miss of a track without a plot where the scan looked, and lowers the score; hypotheses
 * have taken the miss from their score already.
 */
static void count_miss_of_scan(const struct rho_look *look, struct rho_track *track, unsigned row)
{
    if (track->plot >= 0 || !rho_look_has_in_view(look, row) || !rho_look_may_miss(look, track)) {
        return;
    }
    if (rho_notch_is_mostly_blind(track) && track->was_confirmed) {
        rho_notch_coast(look, track);
        return;
    }
    rho_track_count_miss(track, RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)
                                    ? 0
                                    : rho_score_to_mnat(-rho_look_detection(look, track).log_miss));
}

void rho_step_age(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_look *look = &step->look;
    if (look->scan) {
        rho_removal_of_duplicates(step);
    }
    rho_evidence_update(step);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status == RHO_TRACK_FREE || rho_track_is_frozen(track)) {
            continue;
        }
        if (look->scan) {
            count_miss_of_scan(look, track, row);
        }
        if (RHO_SECTORS && look->scan) {
            rho_turn_note_seen(look, track);
        }
    }
    rho_life_weigh(tracker, look);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status != RHO_TRACK_FREE && !rho_track_is_frozen(track)) {
            rho_removal_of_track(step, track);
        }
    }
    rho_life_remove_ended(tracker);
    const int has_notch = look->scan && rho_notch_sensor_has_notch(look->sensor);
    for (unsigned row = 0; has_notch && row < tracker->num_tracks; row++) {
        tracker->tracks[row].blind_percent = 0;
    }
}
