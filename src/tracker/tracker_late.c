/* SPDX-License-Identifier: MIT */
/*
 * tracker_late: scans that are older than what was stepped, but not by much: tracks go back to their time, without noise, take
 * what is theirs, and go on from there with the next scan.
 */
#include "tracker_step.h"

#if RHO_SECTORS

#define LATE_LIMIT_S 60.0f

int rho_tracker_is_late_usable(const struct rho_tracker_config *config)
{
    return rho_is_within(config->late_max_s, 0.0f, LATE_LIMIT_S);
}

int rho_tracker_takes_late(const struct step *step)
{
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_tracker_look *look =
        step->scan ? rho_tracker_look_of(tracker, step->scan->sensor_id) : 0;
    const int is_double = look && look->count > 0 && look->time_us == step->time_us;
    return step->scan && !is_double &&
           rho_seconds_between(step->time_us, tracker->time_us) <= tracker->config.late_max_s;
}

void rho_tracker_begin_late(struct step *step)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    counters->scans_retrodicted = rho_count(counters->scans_retrodicted, 1);
}

/* 0: where it was before cannot be reached any more. */
static int settle_track(struct step *step, struct rho_track *track)
{
    const int was_ahead = track->ahead_us > track->time_us;
    if (!was_ahead && track->time_us != step->time_us) {
        return 1;
    }
    if (was_ahead && rho_track_return(track, track->ahead_us, &step->model) != RHO_OK) {
        return 0;
    }
    rho_track_settle(track, track->time_us, &step->model);
    return 1;
}

/* Tracks that were moved back go on to where they were; those that were not that far are where they should be. */
static void settle(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    unsigned live = 0;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        if (settle_track(step, &tracker->tracks[i])) {
            tracker->tracks[live++] = tracker->tracks[i];
        } else {
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
            rho_tracker_end_track(step, &tracker->tracks[i]);
        }
    }
    tracker->num_tracks = (uint16_t)live;
}

/* What nobody claimed starts no track: the initiation has gone on. Reports are of the newest time. */
void rho_tracker_end_late(struct step *step)
{
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            step->report->fates[i] = RHO_FATE_STALE;
        }
    }
    settle(step);
    step->time_us = step->tracker->time_us;
    step->report->time_us = step->time_us;
}

#else

typedef int rho_tracker_has_no_late; /* a file must not be empty */

#endif
