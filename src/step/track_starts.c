/* SPDX-License-Identifier: MIT */
/* track_starts: adds tracks to the tracker where there is room, in a step or between two steps. */
#include <float.h>
#include <string.h>

#include "phases.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/detail/measurement.h"

unsigned rho_step_candidate_plots(struct rho_window *window, const struct rho_candidate *candidate,
                                  struct rho_track_plot *plots)
{
    unsigned n = 0;
    for (unsigned m = 0; m < window->num_scans; m++) {
        if ((unsigned)candidate->mask >> m & 1u) {
            const struct rho_window_scan *scan = rho_window_scan_at(window, m);
            const int row = (int)(scan->marks[candidate->plot[m]] & RHO_WINDOW_ROW);
            struct rho_plot plot = rho_window_unpack_plot(scan, candidate->plot[m]);
            plots[n++] = (struct rho_track_plot){
                .time_us = scan->time_us + plot.offset_us,
                .measures = scan->measures & ~RHO_MEASURES_VELOCITY, /* not in the window */
                .sensor_id = scan->sensor.sensor_id,
                .sensor = &scan->sensor,
                .plot = plot,
                /* -1: the plot came with an earlier sector */
                .row = (int16_t)(row < (int)RHO_WINDOW_ROW ? row : -1),
            };
        }
    }
    return n;
}

/* Row of the tentative track that exists least, below this probability; RHO_MAX_TRACKS: none. */
static unsigned least_tentative(const struct rho_tracker *tracker, float least)
{
    unsigned found = RHO_MAX_TRACKS;
    for (unsigned i = 0; i < RHO_MAX_TRACKS; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (track->status == RHO_TRACK_TENTATIVE && rho_track_existence(track) < least) {
            least = rho_track_existence(track);
            found = i;
        }
    }
    return found;
}

void rho_step_end_track(struct step *step, unsigned row)
{
    struct rho_tracker *tracker = step->tracker;
    rho_life_end(step, &tracker->tracks[row]);
    tracker->num_tracks--;
    memmove(&tracker->tracks[row], &tracker->tracks[row + 1],
            (tracker->num_tracks - row) * sizeof tracker->tracks[0]);
    if (RHO_KEEPS_OFFERS) {
        rho_score_remove_row(tracker, row);
    }
}

/* A new track's life begins: confirmed, or tentative, by its score. */
static void begin_life(struct step *step, struct rho_track *track, int32_t confirm_mnat)
{
    if (RHO_SECTORS) {
        track->ahead_us = track->time_us;
    }
    track->seen_us = step->look.time_us;
    rho_life_begin(track, step->look.time_us, confirm_mnat);
    rho_life_apply(step, track, confirm_mnat);
}

void rho_step_restart(struct step *step, unsigned row, struct rho_track *track,
                      int32_t confirm_mnat)
{
    track->was_confirmed = step->tracker->tracks[row].was_confirmed;
    begin_life(step, track, confirm_mnat);
    step->tracker->tracks[row] = *track;
}

int rho_step_admit(struct step *step, struct rho_track *track, int32_t confirm_mnat)
{
    struct rho_tracker *tracker = step->tracker;
    if (tracker->num_tracks == RHO_MAX_TRACKS) {
        const unsigned lowest =
            least_tentative(tracker, rho_life_at_start(track->score_mnat, confirm_mnat));
        tracker->counters.tracks_no_room = rho_count(tracker->counters.tracks_no_room, 1);
        if (lowest == RHO_MAX_TRACKS) {
            rho_track_free_hypotheses(track, &step->look.model);
            return 0;
        }
        rho_step_end_track(step, lowest);
    }
    begin_life(step, track, confirm_mnat);
    tracker->tracks[tracker->num_tracks++] = *track;
    tracker->next_track_id = tracker->next_track_id == UINT32_MAX ? 1 : tracker->next_track_id + 1;
    tracker->counters.tracks_started = rho_count(tracker->counters.tracks_started, 1);
    return 1;
}

enum rho_status rho_step_reopen(struct rho_tracker *tracker, struct rho_report *report,
                                struct step *step)
{
    if (!rho_tracker_is_ready(tracker) || !tracker->has_time ||
        report->time_us != tracker->time_us) {
        return RHO_ERROR_STATE;
    }
    *step = (struct step){
        .tracker = tracker,
        .report = report,
        .look = {.tracker = tracker, .fates = report->fates, .time_us = tracker->time_us}};
    rho_step_set_model(tracker, &step->look);
    return RHO_OK;
}

/* Resumes the newest step for a start. VALUE: its score is too low for a tentative track. */
static enum rho_status resume_for_start(struct rho_tracker *tracker, struct rho_report *report,
                                        int32_t score_mnat, struct step *step)
{
    const enum rho_status status = rho_step_reopen(tracker, report, step);
    if (status != RHO_OK) {
        return status;
    }
    rho_pd_open(&step->look, 0);
    return rho_tracker_is_score_in_range(score_mnat) && score_mnat >= rho_life_least_mnat(tracker)
               ? RHO_OK
               : RHO_ERROR_VALUE;
}

/* CAPACITY: no track can give way, or be listed; told before a start takes hypotheses. */
static enum rho_status check_room(const struct step *step, int32_t score_mnat)
{
    struct rho_tracker *tracker = step->tracker;
    if (tracker->num_tracks < RHO_MAX_TRACKS ||
        (step->report->num_ended < RHO_MAX_TRACKS &&
         least_tentative(tracker, rho_life_at_start(score_mnat, tracker->confirm_mnat)) <
             RHO_MAX_TRACKS)) {
        return RHO_OK;
    }
    tracker->counters.tracks_no_room = rho_count(tracker->counters.tracks_no_room, 1);
    return RHO_ERROR_CAPACITY;
}

static enum rho_status admit_between_steps(struct step *step, struct rho_track *track)
{
    if (!rho_step_admit(step, track, step->tracker->confirm_mnat)) {
        return RHO_ERROR_CAPACITY;
    }
    rho_step_merge_estimates(step);
    rho_step_report_tracks(step);
    return RHO_OK;
}

enum rho_status rho_tracker_start_track(struct rho_tracker *tracker,
                                        const struct rho_track_plot *plots, unsigned num_plots,
                                        int32_t score_mnat, struct rho_report *report)
{
    struct rho_track track;
    struct step step = {0};
    if (!tracker || !plots || !report) {
        return RHO_ERROR_NULL;
    }
    enum rho_status status = resume_for_start(tracker, report, score_mnat, &step);
    if (status != RHO_OK) {
        return status;
    }
    if (num_plots < 1) {
        return RHO_ERROR_VALUE;
    }
    for (unsigned i = 0; i < num_plots; i++) {
        if (!rho_is_stored_time(plots[i].time_us) ||
            plots[i].time_us - tracker->time_us > RHO_LIMIT_OFFSET_US || plots[i].row < -1 ||
            plots[i].row >= (int32_t)report->num_plots ||
            !rho_measurement_is_valid_plot(&plots[i].plot, plots[i].measures) ||
            (plots[i].sensor && !rho_measurement_is_valid_site(plots[i].sensor))) {
            return RHO_ERROR_VALUE;
        }
    }
    const struct rho_scan scan = {.time_us = tracker->time_us,
                                  .sensor_id = plots[num_plots - 1].sensor_id};
    step.look.scan = &scan;
    status = check_room(&step, score_mnat);
    if (status == RHO_OK) {
        status = rho_track_start(&track, tracker->next_track_id, plots, num_plots, &step.look.model,
                                 score_mnat);
    }
    if (status != RHO_OK) {
        return status;
    }
    if (RHO_SECTORS) {
        const struct rho_tracker_look *health = rho_tracker_look_of(tracker, scan.sensor_id);
        step.look.count = health ? health->count : 0;
        step.look.teaches = 1;
        rho_turn_note_seen(&step.look, &track);
    }
    return admit_between_steps(&step, &track);
}

/*
 * 1 where an estimate is within its limits, and its covariance is one: variances of open axes
 * within their limits, elements of closed axes 0, positive definite but for rounding.
 */
static int is_usable_estimate(const struct rho_kalman *estimate)
{
    float covariance[RHO_TRIANGLE(RHO_KALMAN_STATES)], factor[RHO_TRIANGLE(RHO_KALMAN_STATES)];
    for (int i = 0; i < RHO_KALMAN_STATES; i++) {
        const float limit = i < 3 ? RHO_LIMIT_POSITION_M : RHO_LIMIT_SPEED_MPS;
        const int is_open = rho_kalman_has_axis(estimate, i % 3);
        const float variance = estimate->covariance[RHO_AT(i, i)];
        if (!rho_is_within(estimate->state[i], -limit, limit) ||
            !rho_is_within(variance, is_open ? RHO_VARIANCE_MIN : 0.0f,
                           is_open ? RHO_VARIANCE_MAX : 0.0f)) {
            return 0;
        }
        for (int j = 0; j < i; j++) {
            const float element = estimate->covariance[RHO_AT(i, j)];
            const float most = is_open && rho_kalman_has_axis(estimate, j % 3) ? FLT_MAX : 0.0f;
            if (!rho_is_within(element, -most, most)) {
                return 0;
            }
            covariance[RHO_AT(i, j)] = element;
        }
        /* raised by a hundred thousandth, for the caller's rounding */
        covariance[RHO_AT(i, i)] = is_open ? variance * (1.0f + 1e-5f) : 1.0f;
    }
    return rho_linalg_cholesky(RHO_KALMAN_STATES, covariance, factor) == RHO_OK;
}

enum rho_status rho_tracker_start_estimate(struct rho_tracker *tracker,
                                           const struct rho_kalman *estimate, int32_t sensor_id,
                                           uint16_t hits, int32_t score_mnat,
                                           struct rho_report *report)
{
    struct rho_track track;
    struct step step = {0};
    if (!tracker || !estimate || !report) {
        return RHO_ERROR_NULL;
    }
    enum rho_status status = resume_for_start(tracker, report, score_mnat, &step);
    if (status == RHO_OK && !is_usable_estimate(estimate)) {
        status = RHO_ERROR_VALUE;
    }
    if (status == RHO_OK) {
        status = check_room(&step, score_mnat);
    }
    if (status == RHO_OK) {
        status =
            rho_track_start_estimate(&track, tracker->next_track_id, estimate, step.look.time_us,
                                     sensor_id, hits, &step.look.model, score_mnat);
    }
    return status == RHO_OK ? admit_between_steps(&step, &track) : status;
}

void rho_step_replace_fates(const struct rho_look *look, enum rho_fate from, enum rho_fate to)
{
    for (uint32_t i = 0; i < look->num_gated; i++) {
        look->fates[i] = (uint8_t)(look->fates[i] == from ? to : look->fates[i]);
    }
}
