/* SPDX-License-Identifier: MIT */
/* initiate: tracks start from plots that no track claimed, or that a weak one claimed. */
#include "phases.h"
#include "policy.h"

/* Sets the fate of the plots of tracks whose targets exist with this probability at least. */
static void set_fate_of_tracks_plots(const struct rho_tracker *tracker, const struct rho_look *look,
                                     float least, enum rho_fate fate)
{
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        const struct rho_track *track = &tracker->tracks[row];
        if (track->plot >= 0 && (uint32_t)track->plot < look->num_gated &&
            rho_track_existence(track) >= least) {
            look->fates[track->plot] = (uint8_t)fate;
        }
    }
}

/* Pushes the held plots, with the learned pd. Apart: its copies are not on the search's stack. */
static void push_scan(struct rho_tracker *tracker, const struct rho_look *look)
{
    struct rho_scan held = *look->scan;
    struct rho_sensor sensor;
    held.num_plots = look->num_gated;
    if (look->sensor) {
        sensor = *look->sensor;
        sensor.pd = look->pd;
    }
    /* the push cannot fail: the step has checked the pointers and the time */
    (void)!rho_initiator_push(look->initiator, &held, look->sensor ? &sensor : 0, look->fates,
                              &tracker->counters.plots_clutter);
    if (RHO_MAX_ECHOES > 0) {
        rho_echoes_store_ratios(look);
    }
}

/* Searches for candidates with plots of the newest scan. */
static void search_newest_scan(struct rho_tracker *tracker, const struct rho_look *look,
                               struct rho_work *work)
{
    struct rho_initiator *initiator = look->initiator;
    /* within the work that the step has left */
    const struct rho_initiator_budget before = initiator->budget;
    (void)!rho_initiator_search_within(initiator, RHO_SEARCH_NEWEST,
                                       rho_work_left_for_search(look, work));
    rho_work_spend(work, initiator->budget.work);
    work->plots_not_tried = rho_count(work->plots_not_tried,
                                      initiator->budget.plots_not_tried - before.plots_not_tried);
    work->is_partial |= initiator->budget.partial_steps != before.partial_steps;
    tracker->counters.candidates_dropped =
        rho_count(tracker->counters.candidates_dropped, initiator->work.candidates_dropped);
    tracker->start_mnat = initiator->start_mnat;
    tracker->confirm_mnat = initiator->confirm_mnat;
    if (RHO_SECTORS) {
        rho_turn_merge_thresholds(tracker, look);
    }
}

static void start_from_candidates(struct step *step)
{
    const struct rho_look *look = &step->look;
    struct rho_tracker_counters *counters = &step->tracker->counters;
    struct rho_initiator *initiator = look->initiator;
    const unsigned newest = initiator->window.num_scans - 1u;
    const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, newest);
    struct rho_track_plot plots[RHO_MAX_SCANS];
    struct rho_track track;
    rho_work_begin_phase(step->tracker, &step->work, RHO_WORK_STARTS_SHARE);
    /* a suspect sensor starts no tracks: plots of it alone are no evidence of a target */
    for (unsigned i = 0; i < initiator->num_candidates && !look->is_suspect; i++) {
        const struct rho_candidate *candidate = &initiator->candidates[i];
        /* a better candidate has used its newest plot: the next scan will show another target */
        if (scan->marks[candidate->plot[newest]] & RHO_WINDOW_INITIATED) {
            continue;
        }
        const int32_t plot = scan->marks[candidate->plot[newest]] & RHO_WINDOW_ROW;
        const float exists = rho_life_at_start(candidate->score_mnat, step->tracker->confirm_mnat);
        unsigned holder = 0;
        while (holder < step->tracker->num_tracks && step->tracker->tracks[holder].plot != plot) {
            holder++;
        }
        if (holder < step->tracker->num_tracks) {
            if (exists <= rho_track_existence(&step->tracker->tracks[holder])) {
                continue;
            }
            rho_step_end_track(step, holder);
            look->fates[plot] = RHO_FATE_HELD;
        }
        const unsigned n = rho_step_candidate_plots(&initiator->window, candidate, plots);
        if (rho_track_start(&track, step->tracker->next_track_id, plots, n, &look->model,
                            candidate->score_mnat) != RHO_OK) {
            counters->updates_refused = rho_count(counters->updates_refused, 1);
            continue;
        }
        if (RHO_MAX_ECHOES > 0) {
            rho_echoes_sum_returns(look, candidate, &track);
        }
        if (RHO_SECTORS) {
            rho_turn_note_seen(look, &track);
        }
        if (rho_step_admit(step, &track, step->tracker->confirm_mnat)) {
            counters->plots_initiated =
                rho_count(counters->plots_initiated, rho_initiator_consume(initiator, candidate));
            if (RHO_MAX_ECHOES > 0) {
                rho_second_plots_raise_window(look, &step->work, candidate);
            }
        }
    }
}

void rho_step_initiate(struct step *step)
{
    const struct rho_look *look = &step->look;
    const int searches = RHO_SEARCHES && look->initiator && look->starts;
    /* a track that clutter started, or whose target left, must not keep what a new one shows */
    set_fate_of_tracks_plots(step->tracker, look, 0.0f, RHO_FATE_HELD);
    set_fate_of_tracks_plots(step->tracker, look, OWNS_PLOT, RHO_FATE_CLAIMED);
    rho_removal_of_plots(step->tracker, look, &step->work);
    if (searches) {
        push_scan(step->tracker, look);
    }
    set_fate_of_tracks_plots(step->tracker, look, 0.0f, RHO_FATE_CLAIMED);
    if (!look->starts) {
        rho_step_replace_fates(look, RHO_FATE_HELD, RHO_FATE_STALE);
        return;
    }
    if (searches) {
        search_newest_scan(step->tracker, look, &step->work);
        start_from_candidates(step);
    } else {
        rho_step_replace_fates(look, RHO_FATE_HELD, RHO_FATE_NO_ROOM);
    }
    if (RHO_MAX_ECHOES > 0) {
        rho_echoes_update(step->tracker, look);
    }
    rho_clutter_count_unclaimed(step->tracker, look);
}
