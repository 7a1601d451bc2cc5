/* SPDX-License-Identifier: MIT */
/*
 * age: counts misses of tracks without a plot where the sensor looked; confirms tracks, and ends
 * tracks by their score, silence or speed.
 */
#include "phases.h"
#include "rhotrack/detail/doppler_notch.h"

/* Standard deviations of a speed that is surely below the slowest target's. */
#define SLOW_SIGMAS 3.0f

#define FAST_SHARE 1.1f  /* speed of a track that is too fast, over v_max_mps */
#define FAST_SIGMAS 2.0f /* standard deviations by which its speed is above v_max_mps, too */
#define FAST_UPDATES 3   /* successive updates at such speeds that end a track */

/* 1 where the track is surely slower than v_min_mps: it follows a standing object. */
static int is_too_slow(const struct rho_tracker *tracker, const struct rho_track *track)
{
    const float *velocity_mps = &track->kalman.state[3];
    const float least_mps = tracker->config.v_min_mps - SLOW_SIGMAS * rho_track_sigma_mps(track);
    return least_mps > 0.0f && velocity_mps[0] * velocity_mps[0] +
                                       velocity_mps[1] * velocity_mps[1] +
                                       velocity_mps[2] * velocity_mps[2] <
                                   least_mps * least_mps;
}

/* Counts successive updates that leave a track faster than any target. 1: enough to end it. */
static int count_too_fast_updates_are_enough_to_end(const struct rho_tracker *tracker,
                                                    struct rho_track *track)
{
    const float *velocity_mps = &track->kalman.state[3];
    const float v_max_mps = tracker->config.v_max_mps;
    const float speed2 = velocity_mps[0] * velocity_mps[0] + velocity_mps[1] * velocity_mps[1] +
                         velocity_mps[2] * velocity_mps[2];
    const float most_mps = FAST_SHARE * v_max_mps;
    const float sure_mps = v_max_mps + FAST_SIGMAS * rho_track_sigma_mps(track);
    const float limit_mps = most_mps > sure_mps ? most_mps : sure_mps;
    if (track->plot >= 0) {
        track->fast_in_row =
            (uint8_t)(speed2 > limit_mps * limit_mps
                          ? track->fast_in_row + (track->fast_in_row < FAST_UPDATES ? 1 : 0)
                          : 0);
    }
    return track->fast_in_row >= FAST_UPDATES;
}

void rho_step_confirm_or_end(struct step *step, struct rho_track *track, int is_missed,
                             const struct rho_track_limits *limits)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    const int is_unseen = rho_unseen_update(&step->look, track, is_missed, limits) ||
                          rho_unseen_is_lost(step->tracker, track);
    const int is_fast = count_too_fast_updates_are_enough_to_end(step->tracker, track);
    rho_life_apply(step, track, limits);
    if (track->status != RHO_TRACK_FREE &&
        (is_unseen || is_fast || is_too_slow(step->tracker, track))) {
        counters->tracks_unseen = rho_count(counters->tracks_unseen, is_unseen ? 1 : 0);
        counters->tracks_too_fast =
            rho_count(counters->tracks_too_fast, is_fast && !is_unseen ? 1 : 0);
        rho_life_end(step, track);
    }
}

/*
 * A frame without a bearing of a track is one miss, however many sensors looked. The score is left
 * alone: the update has lowered it for each sensor.
 */
static void count_misses_of_frame(struct step *step)
{
    for (unsigned row = 0; row < step->tracker->num_tracks; row++) {
        struct rho_track *track = &step->tracker->tracks[row];
        if (track->status != RHO_TRACK_FREE && !rho_track_is_frozen(track) && track->plot < 0 &&
            rho_step_does_frame_cover(step, track)) {
            rho_track_count_miss(track, 0);
        }
    }
}

/*
 * Counts a miss of a track without a plot where the scan looked, and lowers the score; hypotheses
 * have taken the miss from their score already. Returns 1 where the track is missed.
 */
static int count_miss_of_scan(const struct rho_look *look, struct rho_track *track, unsigned row)
{
    if (track->plot >= 0 || !rho_look_has_in_view(look, row) || !rho_look_may_miss(look, track)) {
        return 0;
    }
    if (rho_notch_is_mostly_blind(track) && track->was_confirmed) {
        rho_notch_coast(look, track);
        return 0;
    }
    rho_track_count_miss(track, RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)
                                    ? 0
                                    : rho_score_to_mnat(-rho_look_detection(look, track).log_miss));
    return 1;
}

void rho_step_age(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_look *look = &step->look;
    if (step->frame) {
        count_misses_of_frame(step);
    } else if (RHO_MAX_ECHOES > 0) {
        rho_second_plots_take_look(step);
    }
    const struct rho_track_limits limits = rho_life_limits(look);
    rho_evidence_update(step);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status == RHO_TRACK_FREE || rho_track_is_frozen(track)) {
            continue;
        }
        const int is_missed = step->frame ? track->plot < 0 && track->misses_in_row > 0
                                          : count_miss_of_scan(look, track, row);
        if (RHO_SECTORS && look->scan) {
            rho_turn_note_seen(look, track);
        }
        rho_step_confirm_or_end(step, track, is_missed, &limits);
    }
    rho_life_remove_ended(tracker);
    if (look->scan && rho_notch_sensor_has_notch(look->sensor)) {
        rho_notch_clear_tracks(tracker);
    }
}
