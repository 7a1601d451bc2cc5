/* SPDX-License-Identifier: MIT */
/*
 * track_starts: adds started tracks to the tracker, where there is room for one: within a
 * step, or between two steps.
 */
#include <float.h>
#include <string.h>

#include "phases.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/detail/measurement.h"

/* Variances of an estimate are raised by it before they are tested, for the caller's rounding. */
#define ROUNDING_ALLOWANCE (1.0f + 1e-5f)

/* Row of a held plot in the scan that it came with; -1: it came with an earlier sector. */
static int16_t row_in_scan_of_window_plot(const struct rho_window_scan *scan, unsigned plot)
{
    const int row = (int)(scan->marks[plot] & RHO_WINDOW_ROW);
    return (int16_t)(row < (int)RHO_WINDOW_ROW ? row : -1);
}

unsigned rho_step_candidate_plots(struct rho_window *window, const struct rho_candidate *candidate,
                                  struct rho_track_plot *plots)
{
    unsigned n = 0;
    for (unsigned m = 0; m < window->num_scans; m++) {
        if ((unsigned)candidate->mask >> m & 1u) {
            const struct rho_window_scan *scan = rho_window_scan_at(window, m);
            struct rho_plot plot = rho_window_unpack_plot(scan, candidate->plot[m]);
            plots[n++] = (struct rho_track_plot){
                .time_us = scan->time_us + plot.offset_us,
                .measures = scan->measures & ~RHO_MEASURES_VELOCITY, /* not in the window */
                .sensor_id = scan->sensor.sensor_id,
                .sensor = &scan->sensor,
                .plot = plot,
                .row = row_in_scan_of_window_plot(scan, candidate->plot[m]),
            };
        }
    }
    return n;
}

/*
 * Tentative tracks of low rank give way to new tracks. Rank is the score, or, after coast_scans_max
 * misses in a row, the score's fall from its maximum.
 */
static int32_t rank_of_tentative_track(const struct rho_tracker *tracker,
                                       const struct rho_track *track)
{
    const int hides = track->misses_in_row >= tracker->config.coast_scans_max;
    return hides ? track->score_mnat - track->score_max_mnat : track->score_mnat;
}

/* Row of the lowest-ranked tentative track below the score; RHO_MAX_TRACKS: there is none. */
static unsigned tentative_row_that_gives_way(const struct rho_tracker *tracker, int32_t score_mnat)
{
    unsigned lowest = RHO_MAX_TRACKS;
    for (unsigned i = 0; i < RHO_MAX_TRACKS; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (track->status == RHO_TRACK_TENTATIVE &&
            rank_of_tentative_track(tracker, track) < score_mnat) {
            score_mnat = rank_of_tentative_track(tracker, track);
            lowest = i;
        }
    }
    return lowest;
}

/* A full tracker ends its lowest-ranked tentative track below the score. 0: there is none. */
static int make_room_for_track(struct step *step, int32_t score_mnat)
{
    struct rho_tracker *tracker = step->tracker;
    if (tracker->num_tracks < RHO_MAX_TRACKS) {
        return 1;
    }
    tracker->counters.tracks_no_room = rho_count(tracker->counters.tracks_no_room, 1);
    const unsigned lowest = tentative_row_that_gives_way(tracker, score_mnat);
    if (lowest == RHO_MAX_TRACKS) {
        return 0;
    }
    rho_life_end(step, &tracker->tracks[lowest]);
    tracker->num_tracks--;
    memmove(&tracker->tracks[lowest], &tracker->tracks[lowest + 1],
            (tracker->num_tracks - lowest) * sizeof tracker->tracks[0]);
    if (RHO_KEEPS_OFFERS) {
        rho_score_remove_row(tracker, lowest);
    }
    return 1;
}

int rho_step_admit(struct step *step, struct rho_track *track,
                   const struct rho_track_limits *limits)
{
    struct rho_tracker *tracker = step->tracker;
    if (!make_room_for_track(step, track->score_mnat)) {
        rho_track_free_hypotheses(track, &step->look.model);
        return 0;
    }
    if (RHO_MAX_ECHOES > 0) {
        rho_echoes_store_start(track);
    }
    if (RHO_SECTORS) {
        track->ahead_us = track->time_us;
    }
    track->seen_us = step->look.time_us;
    rho_life_apply(step, track, limits);
    tracker->tracks[tracker->num_tracks++] = *track;
    tracker->next_track_id = tracker->next_track_id == UINT32_MAX ? 1 : tracker->next_track_id + 1;
    tracker->counters.tracks_started = rho_count(tracker->counters.tracks_started, 1);
    return 1;
}

/* 1 where plots of a start are valid, and no newer than a plot of the last step can be. */
static int are_usable_plots(const struct rho_tracker *tracker, const struct rho_report *report,
                            const struct rho_track_plot *plots, unsigned num_plots)
{
    for (unsigned i = 0; i < num_plots; i++) {
        if (!rho_is_stored_time(plots[i].time_us) ||
            plots[i].time_us - tracker->time_us > RHO_LIMIT_OFFSET_US || plots[i].row < -1 ||
            plots[i].row >= (int32_t)report->num_plots ||
            !rho_measurement_is_valid_plot(&plots[i].plot, plots[i].measures) ||
            (plots[i].sensor && !rho_measurement_is_valid_site(plots[i].sensor))) {
            return 0;
        }
    }
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
static enum rho_status resume_step_for_start(struct rho_tracker *tracker, struct rho_report *report,
                                             int32_t score_mnat, struct step *step)
{
    const enum rho_status status = rho_step_reopen(tracker, report, step);
    if (status != RHO_OK) {
        return status;
    }
    rho_look_set_pd(&step->look);
    return rho_tracker_is_score_in_range(score_mnat) &&
                   score_mnat >= rho_life_limits(&step->look).tentative_mnat
               ? RHO_OK
               : RHO_ERROR_VALUE;
}

/*
 * CAPACITY where the tracker is full, and no track can give way, or the report cannot list it as
 * ended. Told before the start, which takes hypotheses from the pool.
 */
static enum rho_status check_room_for_start(const struct step *step, int32_t score_mnat)
{
    struct rho_tracker *tracker = step->tracker;
    if (tracker->num_tracks < RHO_MAX_TRACKS ||
        (step->report->num_ended < RHO_MAX_TRACKS &&
         tentative_row_that_gives_way(tracker, score_mnat) < RHO_MAX_TRACKS)) {
        return RHO_OK;
    }
    tracker->counters.tracks_no_room = rho_count(tracker->counters.tracks_no_room, 1);
    return RHO_ERROR_CAPACITY;
}

static enum rho_status admit_track_between_steps(struct step *step, struct rho_track *track)
{
    const struct rho_track_limits limits = rho_life_limits(&step->look);
    if (!rho_step_admit(step, track, &limits)) {
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
    enum rho_status status = resume_step_for_start(tracker, report, score_mnat, &step);
    if (status != RHO_OK) {
        return status;
    }
    if (num_plots < 1 || !are_usable_plots(tracker, report, plots, num_plots)) {
        return RHO_ERROR_VALUE;
    }
    const struct rho_scan scan = {.time_us = tracker->time_us,
                                  .sensor_id = plots[num_plots - 1].sensor_id};
    step.look.scan = &scan;
    status = check_room_for_start(&step, score_mnat);
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
    return admit_track_between_steps(&step, &track);
}

/*
 * 1 where the place and velocity of an estimate are within their limits, and its covariance is one:
 * variances of open axes within their limits, elements of closed axes 0, positive definite but for
 * rounding.
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
        covariance[RHO_AT(i, i)] = is_open ? variance * ROUNDING_ALLOWANCE : 1.0f;
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
    enum rho_status status = resume_step_for_start(tracker, report, score_mnat, &step);
    if (status == RHO_OK && !is_usable_estimate(estimate)) {
        status = RHO_ERROR_VALUE;
    }
    if (status == RHO_OK) {
        status = check_room_for_start(&step, score_mnat);
    }
    if (status == RHO_OK) {
        status =
            rho_track_start_estimate(&track, tracker->next_track_id, estimate, step.look.time_us,
                                     sensor_id, hits, &step.look.model, score_mnat);
    }
    return status == RHO_OK ? admit_track_between_steps(&step, &track) : status;
}

void rho_step_replace_fates(const struct rho_look *look, enum rho_fate from, enum rho_fate to)
{
    for (uint32_t i = 0; i < look->num_gated; i++) {
        look->fates[i] = (uint8_t)(look->fates[i] == from ? to : look->fates[i]);
    }
}
