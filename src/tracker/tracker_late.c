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
    return step->scan && rho_seconds_between(step->time_us, step->tracker->time_us) <=
                             step->tracker->config.late_max_s;
}

void rho_tracker_begin_late(struct step *step)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    counters->scans_retrodicted = rho_count(counters->scans_retrodicted, 1);
}

/* Tracks that were moved back go on to where they were; those that were not that far are where they should be. */
static void settle(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        const int was_ahead = track->ahead_us > track->time_us;
        if (!was_ahead && track->time_us != step->time_us) {
            continue;
        }
        if (was_ahead && rho_track_return(track, track->ahead_us, &step->model) != RHO_OK) {
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
            continue;
        }
        rho_track_settle(track, track->time_us, &step->model);
    }
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
