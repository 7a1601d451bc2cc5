/* SPDX-License-Identifier: MIT */
/*
 * initiate: tracks start from the plots that no track claimed.
 */
#include "phases.h"

/*
 * 1 where a better candidate of this search has started a track with the same newest plot. If there
 * is another target, the next scan will show it.
 */
static int is_newest_plot_used(struct rho_initiator *initiator,
                               const struct rho_candidate *candidate)
{
    const unsigned newest = initiator->window.num_scans - 1u;
    const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, newest);
    return (scan->marks[candidate->plot[newest]] & RHO_WINDOW_INITIATED) != 0;
}

static void start_track_from_candidate(struct step *step, const struct rho_candidate *candidate,
                                       const struct rho_track_limits *limits)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_track_plot plots[RHO_MAX_SCANS];
    struct rho_track track;
    unsigned n = rho_step_candidate_plots(&step->look.initiator->window, candidate, plots);
    if (rho_track_start(&track, tracker->next_track_id, plots, n, &step->look.model,
                        candidate->score_mnat) != RHO_OK) {
        tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
        return;
    }
    if (RHO_MAX_ECHOES > 0) {
        rho_echoes_sum_returns(&step->look, candidate, &track);
    }
    if (RHO_SECTORS) {
        rho_turn_note_seen(&step->look, &track);
    }
    if (rho_step_admit(step, &track, limits)) {
        tracker->counters.plots_initiated =
            rho_count(tracker->counters.plots_initiated,
                      rho_initiator_consume(step->look.initiator, candidate));
        if (RHO_MAX_ECHOES > 0) {
            rho_second_plots_raise_window(&step->look, &step->work, candidate);
        }
    }
}

/* Searches for candidates with plots of the newest scan, within the work that the step has left. */
static void search_newest_scan(const struct rho_look *look, struct rho_work *work)
{
    struct rho_initiator *initiator = look->initiator;
    const struct rho_initiator_budget before = initiator->budget;
    (void)!rho_initiator_search_within(initiator, RHO_SEARCH_NEWEST,
                                       rho_work_left_for_search(look, work));
    work->spent = rho_count(work->spent, initiator->budget.work);
    work->plots_not_tried = rho_count(work->plots_not_tried,
                                      initiator->budget.plots_not_tried - before.plots_not_tried);
    work->is_partial |= initiator->budget.partial_steps != before.partial_steps;
}

/*
 * Pushes the plots with a fate in the report, and the sensor with its learned pd. The push cannot
 * fail: the step has checked the pointers and the time.
 */
static void push_scan_into_window(struct step *step)
{
    struct rho_scan held = *step->look.scan;
    struct rho_sensor sensor;
    held.num_plots = step->look.num_gated;
    if (step->look.sensor) {
        sensor = *step->look.sensor;
        sensor.pd = rho_learning_mean_pd(&step->look);
    }
    (void)!rho_initiator_push(step->look.initiator, &held, step->look.sensor ? &sensor : 0,
                              step->report->fates, &step->tracker->counters.plots_clutter);
}

static void search_and_start_tracks(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_initiator *initiator = step->look.initiator;
    push_scan_into_window(step);
    if (RHO_MAX_ECHOES > 0) {
        rho_echoes_store_ratios(&step->look);
    }
    search_newest_scan(&step->look, &step->work);
    tracker->counters.candidates_dropped =
        rho_count(tracker->counters.candidates_dropped, initiator->work.candidates_dropped);
    tracker->start_mnat = initiator->start_mnat;
    tracker->confirm_mnat = initiator->confirm_mnat;
    if (RHO_SECTORS) {
        rho_turn_merge_thresholds(tracker, &step->look);
    }
    const struct rho_track_limits limits = rho_life_limits(&step->look);
    rho_work_begin_phase(tracker, &step->work, RHO_WORK_STARTS_SHARE);
    /* a suspect sensor starts no tracks: plots of it alone are no evidence of a target */
    for (unsigned i = 0; i < initiator->num_candidates && !step->look.is_suspect; i++) {
        if (!is_newest_plot_used(initiator, &initiator->candidates[i])) {
            start_track_from_candidate(step, &initiator->candidates[i], &limits);
        }
    }
}

/* Must this plot go? A plot at the image of a track, or in an excluded area, starts no track. */
static void withhold_plots(struct step *step)
{
    if (RHO_MAX_REFLECTORS > 0 && step->tracker->num_reflectors > 0) {
        rho_images_mark_plots(&step->look, &step->work);
    }
    if (RHO_MAX_EXCLUDED_AREAS > 0 && step->tracker->num_excluded > 0) {
        rho_areas_mark_plots(step->tracker, &step->look, &step->work);
    }
}

void rho_step_initiate(struct step *step)
{
    if (step->frame) {
        rho_step_initiate_bearings(step);
        return;
    }
    withhold_plots(step);
    if (!step->look.starts) {
        rho_step_replace_fates(&step->look, RHO_FATE_HELD, RHO_FATE_STALE);
        return;
    }
    if (RHO_SEARCHES && step->look.initiator) {
        search_and_start_tracks(step);
    } else {
        rho_step_replace_fates(&step->look, RHO_FATE_HELD, RHO_FATE_NO_ROOM);
    }
    if (RHO_MAX_ECHOES > 0) {
        rho_echoes_update(step->tracker, &step->look);
    }
    rho_clutter_count_unclaimed(step->tracker, &step->look);
}
