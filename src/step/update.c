/* SPDX-License-Identifier: MIT */
/*
 * update: updates sensor health and the learned noise by the assigned plots, and then the tracks by
 * their plots.
 */
#include "phases.h"

/* ---- tracks with a Kalman filter ------------------------------------------------------------- */

/* The plot's score for the track as it is now, in mnat; 0 where the plot is outside its gate. */
static int32_t score_plot_in_gate(const struct rho_look *look, const struct rho_track *track,
                                  uint32_t plot)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    rho_score_open_gate(look, track, look->scan->measures, &gate);
    if (!rho_gate_test(&gate, &look->scan->plots[plot], &result)) {
        return 0;
    }
    return rho_score_to_mnat(
        rho_score_plot(look, track, &result, rho_clutter_log_at_track(look, track), plot));
}

static void update_track_by_plot_or_count_refusal(struct rho_tracker *tracker,
                                                  const struct rho_look *look,
                                                  struct rho_track *track, int plot)
{
    struct rho_tracker_counters *counters = &tracker->counters;
    const int32_t gain = score_plot_in_gate(look, track, (uint32_t)plot);
    const struct rho_track_plot seen = rho_score_track_plot(look, plot);
    if (rho_track_update_by_plot(track, &seen, &look->model, gain) == RHO_OK) {
        look->fates[plot] = RHO_FATE_CLAIMED;
    } else {
        counters->updates_refused = rho_count(counters->updates_refused, 1);
    }
}

/* ---- tracks with hypotheses ------------------------------------------------------------------ */

/*
 * 1 where another track was assigned a plot that a hypothesis of this track has in its full list of
 * best plots. A plot that is not on the list may then be better than the remaining ones.
 */
static int was_any_plot_of_full_list_taken(const struct rho_tracker *tracker, unsigned row)
{
    const struct rho_hypotheses *pool = &tracker->hypotheses;
    const int16_t *claims = tracker->assignment.column_row;
    const uint16_t slot = tracker->tracks[row].slot;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, slot); i++) {
        const struct rho_hypothesis *at = rho_hypotheses_at(pool, slot, i);
        for (unsigned k = 0;
             at->num_candidates == RHO_HYPOTHESES_CHILDREN && k < RHO_HYPOTHESES_CHILDREN; k++) {
            int claim = claims[at->candidates[k].row];
            if (claim >= 0 && claim != (int)row) {
                return 1;
            }
        }
    }
    return 0;
}

/* Lists each hypothesis's best plots anew, among plots that no other track was assigned. */
static void rescore_unassigned_plots(struct rho_tracker *tracker, const struct rho_look *look,
                                     struct rho_work *work, unsigned row)
{
    struct plot_scores scores;
    uint32_t plot;
    float gain_nat;
    rho_score_begin(tracker, look, work, row, &scores);
    while (rho_score_next(tracker, look, work, &scores, &plot, &gain_nat)) {
    }
}

/*
 * Hypotheses branch by all plots that no other track was assigned; the plot of the best hypothesis
 * is claimed. As the assignment is optimal, that is the assigned plot or none.
 */
static void update_hypotheses_of_track(struct rho_tracker *tracker, const struct rho_look *look,
                                       struct rho_work *work, unsigned row)
{
    struct rho_track *track = &tracker->tracks[row];
    struct rho_assignment *assignment = &tracker->assignment;
    uint32_t refused = tracker->hypotheses.updates_refused;
    const float log_miss = rho_score_log_miss(look, track);
    const int assigned = rho_assignment_column(assignment, row);
    const struct rho_hypotheses_scan scan = {
        .time_us = look->time_us,
        .measures = look->scan->measures,
        .plots = look->scan->plots,
        .sensor = look->sensor,
        .log_miss = log_miss,
        .look = RHO_DOPPLER_NOTCH && track->blind_percent > 0 ? &look->notch_look : 0,
        .claims = assignment->column_row,
        .own = (int16_t)row,
    };
    if (!(log_miss < 0.0f) && !rho_hypotheses_has_candidates(&tracker->hypotheses, track->slot)) {
        return;
    }
    if (was_any_plot_of_full_list_taken(tracker, row)) {
        rescore_unassigned_plots(tracker, look, work, row);
    } else {
        rho_work_release_share(work);
    }
    /* cannot fail: the track has hypotheses */
    (void)!rho_track_commit_scan(track, &scan, look->scan->sensor_id, &look->model);
    refused = tracker->hypotheses.updates_refused - refused;
    tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, refused);
    if (assigned != RHO_ASSIGNMENT_NONE && assigned != track->plot) {
        assignment->column_row[assigned] =
            RHO_ASSIGNMENT_NONE; /* the track left its plot unclaimed */
    }
    if (track->plot >= 0) {
        assignment->column_row[track->plot] = (int16_t)row;
        look->fates[track->plot] = RHO_FATE_CLAIMED;
    }
}

/* ---- the phase ------------------------------------------------------------------------------- */

void rho_step_update(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work)
{
    if (look->bearings) {
        rho_step_update_by_bearings(tracker, look);
        return;
    }
    if (RHO_SECTORS) {
        rho_health_compare(tracker, look);
    }
    rho_learning_take_look(tracker, look);
    rho_work_begin_shares(look, work);
    if (RHO_SHARES_PLOTS) {
        rho_step_share_merged(tracker, look);
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        const int plot = rho_assignment_column(&tracker->assignment, row);
        const int may_wait =
            RHO_CLAIMS_BEYOND && look->has_more_parts && plot == RHO_ASSIGNMENT_NONE;
        if (track->status == RHO_TRACK_FREE || track->plot >= 0 || may_wait ||
            !rho_look_has_in_view(look, row)) {
            continue;
        }
        if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
            update_hypotheses_of_track(tracker, look, work, row);
        } else if (plot != RHO_ASSIGNMENT_NONE) {
            update_track_by_plot_or_count_refusal(tracker, look, track, plot);
        }
    }
}
