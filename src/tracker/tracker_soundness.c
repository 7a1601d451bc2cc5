/* SPDX-License-Identifier: MIT */
/*
 * tracker_soundness: tests whether a tracker of unknown origin, as a loaded snapshot, is safe to
 * use: its counts are in range and its numbers are finite and within their limits.
 */
#include <string.h>

#include "clutter.h"
#include "sensors.h"
#include "step.h"

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
    /* the filter of tracks of plots, or the Kalman filter (bearings) */
    const int has_sound_filter =
        (track->filter == (unsigned)rho_tracker_filter(&tracker->config) ||
         track->filter == RHO_TRACK_KALMAN) &&
        RHO_HAS_FILTER(track->filter) &&
        (track->filter != RHO_TRACK_HYPOTHESES || track->slot < RHO_HYPOTHESES_SLOTS);
    return has_sound_filter && is_sound_input(track) &&
           (!RHO_SECTORS || rho_is_stored_time(track->ahead_us)) &&
           (RHO_MAX_ECHOES == 0 ||
            (rho_echoes_is_sound_track(track) && rho_second_is_sound_track(track))) &&
           (!RHO_DOPPLER_NOTCH || track->blind_percent == 0) &&
           (RHO_MAX_EXCLUDED_AREAS == 0 || track->is_frozen <= 1) &&
           track->status > RHO_TRACK_FREE && track->status < RHO_NUM_TRACK_STATUS &&
           rho_tracker_is_score_in_range(track->score_mnat) &&
           rho_tracker_is_score_in_range(track->score_max_mnat) &&
           rho_is_stored_time(track->time_us) && rho_is_stored_time(track->updated_us) &&
           rho_life_is_sound(track) && rho_is_stored_time(track->seen_us) &&
           rho_is_within(track->seen_every_s, 0.0f, 1e13f) &&
           rho_are_finite(track->kalman.state, RHO_KALMAN_STATES) &&
           rho_are_finite(track->kalman.covariance, RHO_TRIANGLE(RHO_KALMAN_STATES)) &&
           rho_are_finite(track->accel_mps2, 3) && rho_are_finite(track->newest_mps, 3) &&
           rho_are_finite(track->before_mps, 3) && rho_are_finite(track->plot_m, 2) &&
           rho_is_within(track->plot_sigma_m, 0.0f, 1e30f) &&
           rho_is_within(track->maneuver_probability, 0.0f, 1.0f);
}

/* True where no two tracks have the same slot in the pool of hypotheses. */
static int has_own_slots(const struct rho_tracker *tracker)
{
    uint8_t is_met[256]; /* slots that are checked in one pass over the tracks */
    for (size_t first = 0; first < RHO_HYPOTHESES_SLOTS; first += sizeof is_met) {
        memset(is_met, 0, sizeof is_met);
        for (unsigned i = 0; i < tracker->num_tracks; i++) {
            const struct rho_track *track = &tracker->tracks[i];
            if (track->filter == RHO_TRACK_HYPOTHESES && track->slot >= first &&
                track->slot - first < sizeof is_met && is_met[track->slot - first]++) {
                return 0;
            }
        }
    }
    return 1;
}

static int is_sound_row(const struct rho_tracker_sensor *row, int is_described)
{
    const struct rho_tracker_pace *pace = &row->pace;
    return (!is_described || rho_sensors_is_usable(&row->sensor)) && rho_pd_is_sound(row) &&
           rho_learning_is_sound(&row->learned) && rho_is_within(row->blind, 0.0f, 1.0f) &&
           rho_is_within(row->unclaimed_bearings, 0.0f, 1e9f) &&
           rho_bearing_errors_are_sound(&row->bearing_errors) &&
           rho_is_within(pace->azimuth_rad, -10.0f, 10.0f) &&
           rho_is_within(pace->interval_s, 0.0f, 1e13f) && rho_is_coordinate(pace->x_m) &&
           rho_is_coordinate(pace->y_m) && rho_is_stored_time(pace->time_us) &&
           (!RHO_SECTORS || rho_turn_is_sound(&row->look)) &&
           (RHO_MAX_ECHOES == 0 || rho_second_plots_are_sound(&row->second_plots));
}

int rho_tracker_is_sound(const struct rho_tracker *tracker)
{
    const struct rho_extent *extent = &tracker->extent;
    if (!rho_tracker_is_ready(tracker) || !rho_tracker_is_usable(&tracker->config) ||
        tracker->num_sensors > tracker->num_rows || tracker->num_rows > RHO_MAX_SENSORS ||
        tracker->num_tracks > RHO_MAX_TRACKS) {
        return 0;
    }
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        if (!is_sound_row(&tracker->sensors[i], i < tracker->num_sensors)) {
            return 0;
        }
    }
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        if (!is_sound_track(tracker, &tracker->tracks[i])) {
            return 0;
        }
    }
    const float counts[] = {
        tracker->unclaimed_plots, tracker->lived,           tracker->gone,
        tracker->returned,        tracker->seldom,          tracker->straight_s,
        tracker->turning_s,       tracker->wanted_per_hour, tracker->established};
    return rho_are_within(counts, sizeof counts / sizeof counts[0], 0.0f, 1e9f) &&
           rho_assignment_is_ready(&tracker->assignment) && tracker->next_track_id > 0 &&
           rho_is_stored_time(tracker->time_us) && rho_is_stored_time(tracker->counted_us) &&
           rho_tracker_is_score_in_range(tracker->start_mnat) &&
           rho_tracker_is_score_in_range(tracker->confirm_mnat) &&
           rho_is_within(tracker->clutter_per_m2, 0.0f, 1e30f) &&
           rho_is_coordinate(extent->x_min_m) && rho_is_coordinate(extent->x_max_m) &&
           rho_is_coordinate(extent->y_min_m) && rho_is_coordinate(extent->y_max_m) &&
           (RHO_MAX_REFLECTORS == 0 || rho_images_are_sound(tracker)) &&
           (RHO_MAX_EXCLUDED_AREAS == 0 || rho_areas_are_sound(tracker)) &&
           (!RHO_BODIES || rho_bodies_are_sound(tracker)) &&
           (RHO_MAX_ECHOES == 0 || rho_clutter_map_is_sound(&tracker->clutter_map)) &&
           (!RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) ||
            (rho_hypotheses_is_sound(&tracker->hypotheses) && has_own_slots(tracker)));
}
