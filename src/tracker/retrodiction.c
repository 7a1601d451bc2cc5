/* SPDX-License-Identifier: MIT */
/*
 * retrodiction: scans that are older than the newest one by late_max_s at most.
 * Tracks are moved back to the scan's time without process noise, claim its plots, and return to
 * the newest time at the end of the step.
 */
#include "step.h"

int rho_retrodiction_accepts(const struct rho_look *look)
{
    const struct rho_tracker *tracker = look->tracker;
    const struct rho_tracker_look *health =
        look->scan ? rho_tracker_look_of(tracker, look->scan->sensor_id) : 0;
    const int is_double = health && health->count > 0 && health->time_us == look->time_us;
    return look->scan && !is_double &&
           rho_seconds_between(look->time_us, tracker->time_us) <= tracker->config.late_max_s;
}

int rho_retrodiction_return(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_look *look = &step->look;
    if (look->teaches) {
        return 0;
    }
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        const int was_ahead = track->ahead_us > track->time_us;
        if (!was_ahead && track->time_us != look->time_us) {
            continue; /* the scan has not moved it */
        }
        if (was_ahead && rho_track_return(track, track->ahead_us, &look->model) != RHO_OK) {
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
            rho_life_end(step, track);
        } else if (!rho_track_is_frozen(track)) {
            rho_track_merge_estimates(track, track->time_us, &look->model);
        }
    }
    rho_life_remove_ended(tracker);
    step->report->time_us = look->time_us = tracker->time_us;
    return 1;
}
