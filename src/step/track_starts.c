/* SPDX-License-Identifier: MIT */
/*
 * track_starts: a candidate of any initiator becomes a track, where there is room for one.
 */
#include <string.h>

#include "phases.h"

/* By which tentative tracks give way: the score; of a hidden track how far it has fallen. */
static int32_t precedence(const struct step *step, const struct rho_track *track)
{
    const int hides = track->misses_in_row >= step->tracker->config.coast_scans_max;
    return hides ? track->score_mnat - track->score_max_mnat : track->score_mnat;
}

/* Makes room at the end, or in place of the lowest tentative track below the score. */
static int make_room(struct step *step, int32_t score_mnat)
{
    struct rho_tracker *tracker = step->tracker;
    if (tracker->num_tracks < RHO_MAX_TRACKS) {
        return 1;
    }
    tracker->counters.tracks_no_room = rho_count(tracker->counters.tracks_no_room, 1);
    unsigned lowest = RHO_MAX_TRACKS;
    for (unsigned i = 0; i < RHO_MAX_TRACKS; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (track->status == RHO_TRACK_TENTATIVE && precedence(step, track) < score_mnat) {
            score_mnat = precedence(step, track);
            lowest = i;
        }
    }
    if (lowest == RHO_MAX_TRACKS) {
        return 0;
    }
    rho_tracker_end_track(step, &tracker->tracks[lowest]);
    tracker->num_tracks--;
    memmove(&tracker->tracks[lowest], &tracker->tracks[lowest + 1],
            (tracker->num_tracks - lowest) * sizeof tracker->tracks[0]);
    return 1;
}

int rho_tracker_admit(struct step *step, struct rho_track *track,
                      const struct rho_track_limits *limits)
{
    struct rho_tracker *tracker = step->tracker;
    if (!make_room(step, track->score_mnat)) {
        rho_track_end(track, &step->model);
        return 0;
    }
    if (RHO_MAX_ECHOES > 0) {
        rho_tracker_note_place(track);
    }
    if (RHO_SECTORS) {
        rho_tracker_note_ahead(track);
    }
    track->seen_us = step->time_us;
    rho_tracker_apply_thresholds(step, track, limits);
    tracker->tracks[tracker->num_tracks++] = *track;
    tracker->next_track_id = tracker->next_track_id == UINT32_MAX ? 1 : tracker->next_track_id + 1;
    tracker->counters.tracks_started = rho_count(tracker->counters.tracks_started, 1);
    return 1;
}

void rho_tracker_refuse_unclaimed(struct step *step)
{
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            step->report->fates[i] = RHO_FATE_NO_ROOM;
        }
    }
}
