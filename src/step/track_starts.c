/* SPDX-License-Identifier: MIT */
/*
 * track_starts: a candidate of any initiator becomes a track, where there is room for one: within a
 * step, or between two.
 */
#include <string.h>

#include "phases.h"
#include "rhotrack/measurement.h"

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

/* Each is valid, and has a time that a plot of the last step or of one before can have. */
static int are_usable(const struct rho_tracker *tracker, const struct rho_report *report,
                      const struct rho_track_plot *plots, unsigned num_plots)
{
    for (unsigned i = 0; i < num_plots; i++) {
        if (!rho_is_stored_time(plots[i].time_us) ||
            plots[i].time_us - tracker->time_us > RHO_LIMIT_OFFSET_US || plots[i].row < -1 ||
            plots[i].row >= (int32_t)report->num_plots ||
            !rho_measurement_is_valid(&plots[i].plot, plots[i].measures) ||
            (plots[i].sensor && !rho_measurement_is_sensor(plots[i].sensor))) {
            return 0;
        }
    }
    return 1;
}

enum rho_status rho_tracker_start_track(struct rho_tracker *tracker,
                                        const struct rho_track_plot *plots, unsigned num_plots,
                                        int32_t score_mnat, struct rho_report *report)
{
    if (!tracker || !plots || !report) {
        return RHO_ERROR_NULL;
    }
    if (!rho_tracker_is_ready(tracker) || !tracker->has_time ||
        report->time_us != tracker->time_us) {
        return RHO_ERROR_STATE;
    }
    if (num_plots < 1 || !rho_tracker_is_score(score_mnat) ||
        !are_usable(tracker, report, plots, num_plots)) {
        return RHO_ERROR_VALUE;
    }
    const struct rho_scan scan = {.time_us = tracker->time_us,
                                  .sensor_id = plots[num_plots - 1].sensor_id};
    struct step step = {
        .tracker = tracker, .report = report, .scan = &scan, .time_us = scan.time_us};
    struct rho_track track;
    rho_tracker_set_model(&step);
    rho_tracker_set_pd(&step);
    const struct rho_track_limits limits = rho_tracker_limits(&step);
    if (score_mnat < limits.tentative_mnat) {
        return RHO_ERROR_VALUE;
    }
    const enum rho_status status =
        rho_track_start(&track, tracker->next_track_id, plots, num_plots, &step.model, score_mnat);
    if (status != RHO_OK) {
        return status;
    }
    if (RHO_SECTORS) {
        const struct rho_tracker_look *look = rho_tracker_own_look(&step);
        step.look = look ? look->count : 0;
        rho_tracker_note_sight(&step, &track);
    }
    if (!rho_tracker_admit(&step, &track, &limits)) {
        return RHO_ERROR_CAPACITY;
    }
    rho_tracker_merge_estimates(&step);
    rho_tracker_report_tracks(&step);
    return RHO_OK;
}

void rho_tracker_refuse_unclaimed(struct step *step)
{
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            step->report->fates[i] = RHO_FATE_NO_ROOM;
        }
    }
}
