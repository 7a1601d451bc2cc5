/* SPDX-License-Identifier: MIT */
/*
 * retrodiction: scans that are older than the newest one by late_max_s at most.
 * Tracks are moved back to the scan's time without process noise, claim its plots, and return to
 * the newest time at the end of the step.
 */
#include "clutter.h"
#include "plots.h"
#include "sensors.h"
#include "step.h"

#define LATE_LIMIT_S 60.0f

void rho_retrodiction_default(struct rho_tracker_config *config)
{
    config->late_max_s = 20.0f;
}

int rho_retrodiction_is_usable(const struct rho_tracker_config *config)
{
    return rho_is_within(config->late_max_s, 0.0f, LATE_LIMIT_S);
}

int rho_retrodiction_accepts(const struct rho_look *look)
{
    const struct rho_tracker *tracker = look->tracker;
    const struct rho_tracker_look *health =
        look->scan ? rho_tracker_look_of(tracker, look->scan->sensor_id) : 0;
    const int is_double = health && health->count > 0 && health->time_us == look->time_us;
    return look->scan && !is_double &&
           rho_seconds_between(look->time_us, tracker->time_us) <= tracker->config.late_max_s;
}

void rho_retrodiction_keep_time(struct rho_track *track)
{
    track->ahead_us = track->time_us;
}

int rho_retrodiction_is_sound(const struct rho_track *track)
{
    return rho_is_stored_time(track->ahead_us);
}

/*
 * Moves a track that an out-of-sequence scan moved back to its time before; other tracks stay.
 * Merges its estimates. Returns 0 where the filter refuses the move.
 */
static int return_track_to_newest_time(const struct rho_look *look, struct rho_track *track)
{
    const int was_ahead = track->ahead_us > track->time_us;
    if (!was_ahead && track->time_us != look->time_us) {
        return 1;
    }
    if (was_ahead && rho_track_return_to_time_it_was_moved_from(track, track->ahead_us,
                                                                &look->model) != RHO_OK) {
        return 0;
    }
    if (!rho_track_is_frozen(track)) {
        rho_track_merge_estimates(track, track->time_us, &look->model);
    }
    return 1;
}

int rho_retrodiction_return(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    if (!step->look.is_late) {
        return 0;
    }
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        if (!return_track_to_newest_time(&step->look, &tracker->tracks[i])) {
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
            rho_life_end(step, &tracker->tracks[i]);
        }
    }
    rho_life_remove_ended(tracker);
    step->look.time_us = tracker->time_us;
    step->report->time_us = step->look.time_us;
    return 1;
}
