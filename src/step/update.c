/* SPDX-License-Identifier: MIT */
/* update: updates sensor health and learned noise by the assigned plots, and then the tracks. */
#include "../tracker/sight.h"
#include "phases.h"
#include "policy.h"

/*
 * Where targets may stand, one that is missed or manoeuvres may have braked harder than accel_max:
 * adds the hypothesis that it stands on its way of the last back_s.
 */
static void add_stop(struct rho_tracker *tracker, const struct rho_look *look,
                     const struct rho_track *track, float back_s)
{
    const struct rho_tracker_config *config = &tracker->config;
    struct rho_kalman stop = track->kalman;
    const float limit_mps = STOP_S * config->accel_max_mps2;
    float way_m[2], way_m2 = 0.0f, speed2 = 0.0f;
    for (int i = 0; i < 2; i++) {
        way_m[i] = back_s * stop.state[3 + i];
        way_m2 += way_m[i] * way_m[i];
        speed2 += stop.state[3 + i] * stop.state[3 + i];
        stop.state[i] -= way_m[i];
        stop.state[3 + i] = 0.0f;
    }
    if (!track->was_confirmed || track->misses_in_row >= RHO_HYPOTHESES_MEMORY ||
        config->v_min_mps > 0.0f || !(back_s > 0.0f) || speed2 > limit_mps * limit_mps ||
        way_m2 < rho_track_sigma_m(track) * rho_track_sigma_m(track)) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            stop.covariance[RHO_AT(3 + i, k)] = 0.0f;
        }
        for (int k = 0; k <= i && i < 2; k++) {
            stop.covariance[RHO_AT(i, k)] += way_m[i] * way_m[k];
        }
    }
    rho_hypotheses_add(&tracker->hypotheses, track->slot, &stop, look->time_us, STOP_NAT);
}

/*
 * Hypotheses branch by all plots that no other track was assigned; the plot of the best hypothesis
 * is claimed. As the assignment is optimal, that is the assigned plot or none.
 */
static void update_hypotheses(struct rho_tracker *tracker, const struct rho_look *look,
                              struct rho_work *work, unsigned row)
{
    struct rho_track *track = &tracker->tracks[row];
    struct rho_assignment *assignment = &tracker->assignment;
    const struct rho_hypotheses *pool = &tracker->hypotheses;
    uint32_t refused = pool->updates_refused;
    const float log_miss = rho_score_log_miss(look, track);
    const int assigned = rho_assignment_column(assignment, row);
    struct rho_notch_look at_rest;
    const struct rho_hypotheses_scan scan = {
        .time_us = look->time_us,
        .measures = look->scan->measures,
        .plots = look->scan->plots,
        .sensor = look->sensor,
        .log_miss = log_miss,
        .look = !RHO_DOPPLER_NOTCH                           ? 0
                : track->blind_percent > 0                   ? &look->notch_look
                : rho_pd_miss_at_rest(look, track, &at_rest) ? &at_rest
                                                             : 0,
        .claims = assignment->column_row,
        .own = (int16_t)row,
    };
    if (!(log_miss < 0.0f) && !rho_hypotheses_has_candidates(pool, track->slot)) {
        return;
    }
    /*
     * Another track may have been assigned a plot that a hypothesis has in its full list of best
     * plots: then a plot that is not on the list may be better than the remaining ones.
     */
    int is_taken = 0;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, track->slot); i++) {
        const struct rho_hypothesis *at = rho_hypotheses_at(pool, track->slot, i);
        for (unsigned k = 0; at->num_candidates == RHO_HYPOTHESES_CHILDREN &&
                             k < RHO_HYPOTHESES_CHILDREN && !is_taken;
             k++) {
            const int claim = assignment->column_row[at->candidates[k].row];
            is_taken = claim >= 0 && claim != (int)row;
        }
    }
    if (is_taken) {
        /* list each hypothesis's best plots anew, among plots that no other track was assigned */
        struct plot_scores scores;
        uint32_t plot;
        float gain_nat;
        rho_score_begin(tracker, look, work, row, &scores);
        while (rho_score_next(tracker, look, work, &scores, &plot, &gain_nat)) {
        }
    } else {
        rho_work_release_share(work);
    }
    const float back_s = rho_seconds_between(track->updated_us, look->time_us);
    /* cannot fail: the track has hypotheses */
    (void)!rho_track_commit_scan(track, &scan, look->scan->sensor_id, &look->model);
    if (log_miss < 0.0f && (track->plot < 0 || track->maneuver_probability > STOPS_ABOVE)) {
        add_stop(tracker, look, track, back_s);
    }
    refused = pool->updates_refused - refused;
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

void rho_step_update(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work)
{
    struct rho_tracker_counters *counters = &tracker->counters;
    if (RHO_SECTORS) {
        rho_health_compare(tracker, look);
    }
    rho_learning_take_look(tracker, look);
    rho_work_begin_shares(look, work);
    rho_targets_share_plots(tracker, look);
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
            update_hypotheses(tracker, look, work, row);
        } else if (plot != RHO_ASSIGNMENT_NONE) {
            /* scored as the track is now; 0 where the plot has left its gate */
            const struct rho_track_plot seen = rho_score_track_plot(look, plot);
            const struct rho_plot *at = &look->scan->plots[plot];
            struct rho_gate gate;
            struct rho_gate_result result;
            float gain_nat = 0.0f;
            rho_score_open_gate(look, track, look->scan->measures, &gate);
            if (rho_gate_test(&gate, at, &result)) {
                gain_nat = rho_score_plot(look, track, &result,
                                          rho_clutter_log_at_track(look, track), (uint32_t)plot);
            }
            if (rho_track_update_by_plot(track, &seen, &look->model, rho_score_to_mnat(gain_nat)) ==
                RHO_OK) {
                look->fates[plot] = RHO_FATE_CLAIMED;
            } else {
                counters->updates_refused = rho_count(counters->updates_refused, 1);
            }
        }
        if (track->plot >= 0) {
            rho_track_keep_plot(track, &look->scan->plots[track->plot]);
        }
    }
}
