/* SPDX-License-Identifier: MIT */
/*
 * tracker_sound: whether a tracker of unknown origin (a snapshot) can be worked with.
 */
#include "rhotrack/angle.h"
#include "tracker_step.h"

/* Scores may be added and subtracted. */
#define SCORE_MAX_MNAT 1000000000

/* Slots that are looked for in one pass over the tracks. */
#define PASS_SLOTS 256u

static int is_score(int32_t mnat)
{
    return mnat >= -SCORE_MAX_MNAT && mnat <= SCORE_MAX_MNAT;
}

/* ---- tracks ----------------------------------------------------------------------------------- */

/* That of tracks of plots, or that of tracks of bearings. */
static int is_sound_filter(const struct rho_tracker *tracker, const struct rho_track *track)
{
    const unsigned own = (unsigned)rho_tracker_filter_of(&tracker->config);
    return (track->filter == own || track->filter == RHO_TRACK_KALMAN) &&
           RHO_HAS_FILTER(track->filter) &&
           (track->filter != RHO_TRACK_HYPOTHESES || track->slot < RHO_HYPOTHESES_SLOTS);
}

static int is_sound_input(const struct rho_track *track)
{
    const struct rho_input *input = &track->input;
    if (track->filter != RHO_TRACK_INPUT) {
        return 1;
    }
    for (int axis = 0; axis < RHO_INPUT_AXES; axis++) {
        if (!rho_are_finite(input->sensitivity[axis], RHO_KALMAN_STATES)) {
            return 0;
        }
    }
    return rho_are_finite(input->bare.state, RHO_KALMAN_STATES) &&
           rho_are_finite(input->bare.covariance, RHO_TRIANGLE(RHO_KALMAN_STATES)) &&
           rho_are_finite(input->input_mps2, RHO_INPUT_AXES) &&
           rho_are_finite(input->variance, RHO_TRIANGLE(RHO_INPUT_AXES)) &&
           input->present < 1u << RHO_INPUT_AXES;
}

static int is_sound_track(const struct rho_tracker *tracker, const struct rho_track *track)
{
#if RHO_SECTORS
    if (!rho_is_stored_time(track->ahead_us)) {
        return 0;
    }
#endif
#if RHO_MAX_ECHOES > 0
    if (!rho_are_finite(track->returns, RHO_ECHO_HIT_CLASSES) ||
        !rho_are_finite(track->start_m, 2) || !rho_are_finite(&track->start_sigma_m, 1) ||
        !rho_is_within(track->second_looks, 0.0f, 1e6f) ||
        !rho_is_within(track->second_plots, 0.0f, 1e6f) ||
        !rho_is_within(track->twin_nat, -1e3f, 1e3f) || !rho_are_finite(&track->second_share, 1)) {
        return 0;
    }
#endif
    return track->status > RHO_TRACK_FREE && track->status < RHO_NUM_TRACK_STATUS &&
           is_score(track->score_mnat) && is_score(track->score_max_mnat) &&
           rho_is_stored_time(track->time_us) && rho_is_stored_time(track->updated_us) &&
           rho_is_stored_time(track->seen_us) && rho_is_within(track->seen_every_s, 0.0f, 1e13f) &&
           is_sound_filter(tracker, track) && is_sound_input(track) &&
           rho_are_finite(track->kalman.state, RHO_KALMAN_STATES) &&
           rho_are_finite(track->kalman.covariance, RHO_TRIANGLE(RHO_KALMAN_STATES)) &&
           rho_are_finite(track->accel_mps2, 3) && rho_are_finite(track->newest_mps, 3) &&
           rho_are_finite(track->before_mps, 3) &&
           rho_is_within(track->maneuver_probability, 0.0f, 1.0f);
}

/* No two tracks have the same hypotheses. */
static int has_own_slots(const struct rho_tracker *tracker)
{
    for (unsigned first = 0; first < RHO_HYPOTHESES_SLOTS; first += PASS_SLOTS) {
        uint8_t is_met[PASS_SLOTS] = {0};
        for (unsigned i = 0; i < tracker->num_tracks; i++) {
            const struct rho_track *track = &tracker->tracks[i];
            if (track->filter != RHO_TRACK_HYPOTHESES || track->slot < first ||
                track->slot - first >= PASS_SLOTS) {
                continue;
            }
            if (is_met[track->slot - first]++) {
                return 0;
            }
        }
    }
    return 1;
}

static int has_sound_tracks(const struct rho_tracker *tracker)
{
    if (tracker->num_tracks > RHO_MAX_TRACKS) {
        return 0;
    }
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        if (!is_sound_track(tracker, &tracker->tracks[i])) {
            return 0;
        }
    }
    return !RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) ||
           (rho_hypotheses_is_sound(&tracker->hypotheses) && has_own_slots(tracker));
}

/* ---- sensors ---------------------------------------------------------------------------------- */

static int has_sound_sensors(const struct rho_tracker *tracker)
{
    if (tracker->num_sensors > RHO_MAX_SENSORS) {
        return 0;
    }
    for (unsigned i = 0; i < tracker->num_sensors; i++) {
        if (!rho_tracker_is_usable_sensor(&tracker->sensors[i]) ||
            !rho_tracker_is_sound_learned(&tracker->learned[i])) {
            return 0;
        }
    }
    return 1;
}

static int has_sound_paces(const struct rho_tracker *tracker)
{
    if (tracker->num_paces > RHO_MAX_SENSORS) {
        return 0;
    }
    for (unsigned i = 0; i < tracker->num_paces; i++) {
        const struct rho_tracker_pace *pace = &tracker->paces[i];
        if (!rho_is_within(pace->azimuth_rad, -10.0f, 10.0f) ||
            !rho_is_within(pace->interval_s, 0.0f, 1e13f) || !rho_is_coordinate(pace->x_m) ||
            !rho_is_coordinate(pace->y_m) || !rho_is_stored_time(pace->time_us)) {
            return 0;
        }
    }
    return 1;
}

static int has_sound_looks(const struct rho_tracker *tracker)
{
#if RHO_SECTORS
    if (tracker->num_looks > RHO_MAX_SENSORS) {
        return 0;
    }
    for (unsigned i = 0; i < tracker->num_looks; i++) {
        const struct rho_tracker_look *look = &tracker->looks[i];
        if (!rho_angle_is_sector(look->sector_from_rad, look->sector_to_rad) ||
            !rho_is_stored_time(look->time_us) || !is_score(look->start_mnat) ||
            !is_score(look->confirm_mnat) || !rho_is_within(look->seen_share, 0.0f, 1e9f) ||
            !rho_is_within(look->distance2, 0.0f, 1e30f) ||
            !rho_is_within(look->sigma_m, 0.0f, 1e9f)) {
            return 0;
        }
    }
#else
    (void)tracker;
#endif
    return 1;
}

static int has_sound_second_plots(const struct rho_tracker *tracker)
{
#if RHO_MAX_ECHOES > 0
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        const struct rho_second_plots *table = &tracker->second_plots[i];
        if (!rho_is_within(table->looks, 0.0f, 1e9f) || !rho_is_within(table->plots, 0.0f, 1e9f)) {
            return 0;
        }
        for (unsigned bin = 0; bin < RHO_SECOND_BINS; bin++) {
            if (!rho_is_within(table->along[bin], 0.0f, 1e9f) ||
                !rho_is_within(table->across[bin], 0.0f, 1e9f)) {
                return 0;
            }
        }
    }
#else
    (void)tracker;
#endif
    return 1;
}

/* ---- all -------------------------------------------------------------------------------------- */

static int is_sound_extent(const struct rho_extent *extent)
{
    return rho_is_coordinate(extent->x_min_m) && rho_is_coordinate(extent->x_max_m) &&
           rho_is_coordinate(extent->y_min_m) && rho_is_coordinate(extent->y_max_m);
}

static int has_sound_map(const struct rho_tracker *tracker)
{
#if RHO_MAX_ECHOES > 0
    return rho_clutter_map_is_sound(&tracker->clutter_map);
#else
    (void)tracker;
    return 1;
#endif
}

int rho_tracker_is_sound(const struct rho_tracker *tracker)
{
    return rho_tracker_is_ready(tracker) && rho_tracker_is_usable(&tracker->config) &&
           rho_assignment_is_ready(&tracker->assignment) && tracker->next_track_id > 0 &&
           rho_is_stored_time(tracker->time_us) && is_score(tracker->start_mnat) &&
           is_score(tracker->confirm_mnat) && tracker->looks_max > 0 &&
           rho_is_within(tracker->unclaimed_plots, 0.0f, 1e9f) &&
           rho_is_within(tracker->unclaimed_bearings, 0.0f, 1e9f) &&
           rho_is_within(tracker->died_young, 0.0f, 1e9f) &&
           rho_is_within(tracker->straight_s, 0.0f, 1e9f) &&
           rho_is_within(tracker->turning_s, 0.0f, 1e9f) &&
           rho_is_within(tracker->wanted_per_hour, 0.0f, 1e9f) &&
           rho_is_within(tracker->grown, 0.0f, 1e9f) && rho_is_stored_time(tracker->youth_us) &&
           is_sound_extent(&tracker->extent) && has_sound_sensors(tracker) &&
           has_sound_paces(tracker) && has_sound_looks(tracker) && has_sound_map(tracker) &&
           has_sound_second_plots(tracker) && has_sound_tracks(tracker);
}
