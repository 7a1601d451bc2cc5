/* SPDX-License-Identifier: MIT */
/* operator: starts, ends, renumbers and freezes tracks by hand, between two steps. */
#include "rhotrack/operator.h"

#include "phases.h"

/* Finds a track by its identity, and fills *step to continue the newest step. */
static enum rho_status resume_at_track(struct rho_tracker *tracker, uint32_t track_id,
                                       struct rho_report *report, struct step *step,
                                       struct rho_track **track)
{
    if (!tracker || !report) {
        return RHO_ERROR_NULL;
    }
    const enum rho_status status = rho_step_reopen(tracker, report, step);
    if (status != RHO_OK) {
        return status;
    }
    const unsigned row = rho_tracker_find_row(tracker, track_id);
    *track = &tracker->tracks[row < RHO_MAX_TRACKS ? row : 0];
    return row < RHO_MAX_TRACKS ? RHO_OK : RHO_ERROR_VALUE;
}

enum rho_status rho_tracker_start_at(struct rho_tracker *tracker,
                                     const struct rho_operator_start *start,
                                     struct rho_report *report)
{
    const enum rho_status status = rho_tracker_check(tracker, start && report);
    if (status != RHO_OK) {
        return status;
    }
    /* a start is of the sensor with the newest scan; 0: none was heard */
    const struct rho_tracker_sensor *newest = 0;
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        const struct rho_tracker_sensor *row = &tracker->sensors[i];
        if (row->pace.is_heard && (!newest || row->pace.time_us > newest->pace.time_us)) {
            newest = row;
        }
    }
    const int has_velocity = !rho_is_within(start->sigma_mps, 0.0f, 0.0f);
    const struct rho_track_plot seen = {
        .time_us = tracker->time_us,
        .measures = has_velocity ? RHO_MEASURES_VELOCITY : 0,
        .sensor_id = newest ? newest->sensor.sensor_id : 0,
        .plot = {.x_m = start->x_m,
                 .y_m = start->y_m,
                 .vx_mps = start->vx_mps,
                 .vy_mps = start->vy_mps,
                 .sigma_range_m = start->sigma_m,
                 .sigma_cross_m = start->sigma_m,
                 .sigma_mps = start->sigma_mps},
        .row = -1,
    };
    const enum rho_status started = rho_tracker_start_track(
        tracker, &seen, 1, tracker->confirm_mnat > 0 ? tracker->confirm_mnat : 0, report);
    if (started == RHO_OK) {
        tracker->tracks[tracker->num_tracks - 1].is_operators = 1;
    }
    return started;
}

enum rho_status rho_tracker_drop_track(struct rho_tracker *tracker, uint32_t track_id,
                                       struct rho_report *report)
{
    struct step step;
    struct rho_track *track;
    const enum rho_status status = resume_at_track(tracker, track_id, report, &step, &track);
    if (status != RHO_OK) {
        return status;
    }
    if (report->num_ended >= RHO_MAX_TRACKS) {
        return RHO_ERROR_CAPACITY;
    }
    rho_life_end(&step, track);
    rho_life_remove_ended(tracker);
    if (rho_bodies_are_used(tracker)) {
        rho_bodies_align(tracker);
    }
    tracker->counters.tracks_dropped = rho_count(tracker->counters.tracks_dropped, 1);
    rho_step_report_tracks(&step);
    return RHO_OK;
}

static void swap_tracks(struct rho_tracker *tracker, unsigned row, unsigned other)
{
    const struct rho_track track = tracker->tracks[row];
    tracker->tracks[row] = tracker->tracks[other];
    tracker->tracks[other] = track;
    if (rho_bodies_are_used(tracker)) {
        const struct rho_body_filter body = tracker->bodies.of[row];
        tracker->bodies.of[row] = tracker->bodies.of[other];
        tracker->bodies.of[other] = body;
    }
}

enum rho_status rho_tracker_renumber_track(struct rho_tracker *tracker, uint32_t track_id,
                                           uint32_t new_id, struct rho_report *report)
{
    struct step step;
    struct rho_track *track;
    const enum rho_status status = resume_at_track(tracker, track_id, report, &step, &track);
    if (status != RHO_OK) {
        return status;
    }
    if (new_id < 1 || new_id > RHO_LIMIT_TRACK_ID ||
        rho_tracker_find_row(tracker, new_id) < RHO_MAX_TRACKS) {
        return RHO_ERROR_VALUE;
    }
    if (report->num_ended >= RHO_MAX_TRACKS) {
        return RHO_ERROR_CAPACITY;
    }
    /* the track continues one that may have ended in this step: that end is no longer reported */
    uint16_t kept = 0;
    for (unsigned i = 0; i < report->num_ended; i++) {
        if (report->ended[i] != new_id) {
            report->ended[kept++] = report->ended[i];
        }
    }
    report->num_ended = kept;
    if (track->was_confirmed) {
        report->ended[report->num_ended++] = track_id;
    }
    if (rho_bodies_are_used(tracker)) {
        rho_bodies_align(tracker);
        tracker->bodies.of[track - tracker->tracks].track_id = new_id;
    }
    track->track_id = new_id;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *other = &tracker->tracks[i];
        other->older_id = other->older_id == track_id ? new_id : other->older_id;
    }
    /* to its place in the order of identities; the assignment's rows from there on are dropped */
    const unsigned row = (unsigned)(track - tracker->tracks);
    unsigned to = row;
    for (; to > 0 && tracker->tracks[to - 1].track_id > new_id; to--) {
        swap_tracks(tracker, to, to - 1u);
    }
    for (; to + 1u < tracker->num_tracks && tracker->tracks[to + 1].track_id < new_id; to++) {
        swap_tracks(tracker, to, to + 1u);
    }
    if (RHO_KEEPS_OFFERS && to != row) {
        const unsigned first = to < row ? to : row;
        if (tracker->assignment.num_rows > first) {
            tracker->assignment.num_rows = (uint16_t)first;
        }
    }
    tracker->next_track_id = tracker->next_track_id > new_id ? tracker->next_track_id : new_id + 1u;
    rho_step_report_tracks(&step);
    return RHO_OK;
}

enum rho_status rho_tracker_freeze_track(struct rho_tracker *tracker, uint32_t track_id,
                                         int is_frozen, struct rho_report *report)
{
    struct step step;
    struct rho_track *track;
    const enum rho_status status = resume_at_track(tracker, track_id, report, &step, &track);
    if (status != RHO_OK) {
        return status;
    }
    if (RHO_MAX_EXCLUDED_AREAS == 0 || track->status == RHO_TRACK_TENTATIVE) {
        return RHO_MAX_EXCLUDED_AREAS == 0 ? RHO_ERROR_CONFIG : RHO_ERROR_STATE;
    }
    if (rho_track_is_frozen(track) == (is_frozen != 0)) {
        return RHO_OK;
    }
    track->is_frozen = is_frozen != 0;
    track->status = RHO_TRACK_COASTING;
    track->plot = -1;
    track->accel_mps2[0] = track->accel_mps2[1] = track->accel_mps2[2] = 0.0f;
    /* the frozen time does not count as silence of the target */
    track->seen_us = track->lived_us = tracker->time_us;
    track->misses_in_row = 0;
    rho_step_report_tracks(&step);
    return RHO_OK;
}
