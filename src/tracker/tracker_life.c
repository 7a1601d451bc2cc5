/* SPDX-License-Identifier: MIT */
/*
 * tracker_life: evidence ends tracks, confirms them, and starts new ones from the plots that nobody claimed.
 */
#include <string.h>

#include "rhotrack/approx.h"
#include "rhotrack/measurement.h"
#include "tracker_step.h"

/* Wald's lower threshold: one true track in a hundred is given up while tentative. */
#define TENTATIVE_FALL_MNAT 4605

/* A target that was seen until now is there with odds of its lifetime in scans, 200, to one: ln. In frames
 * as if all sensors missed what one does. */
#define LIFETIME_MNAT 5298

/*
 * A grown track that has moved, and is not seen any more, may hide: in doubt, unreported, for so
 * many times coast_scans_max misses, as long as no more clutter plots than that are expected in its
 * gate. The target may have flown behind something, and keeps its identity.
 */
#define HIDE_SHARE 2.4f
#define HIDE_CLUTTER_MAX 3.0f

/* Standard deviations of a speed that is surely below the slowest target's. */
#define SLOW_SIGMAS 3.0f

/* Speeds beyond the fastest target's: by so much, and by so many standard deviations, in so many updates in a row. */
#define FAST_SHARE 1.1f
#define FAST_SIGMAS 2.0f
#define FAST_UPDATES 3

/* ---- age -------------------------------------------------------------------------------------- */

void rho_tracker_end_track(struct step *step, struct rho_track *track)
{
    struct rho_report *report = step->report;
    if (track->is_believed) {
        report->ended[report->num_ended++] = track->track_id;
    }
    rho_track_end(track, &step->model);
    track->status = RHO_TRACK_FREE;
    step->tracker->counters.tracks_ended = rho_count(step->tracker->counters.tracks_ended, 1);
}

int rho_tracker_looked_at(const struct step *step, float sector_from_rad, float sector_to_rad,
                          const struct rho_track *track)
{
    return rho_measurement_looks_at(step->sensor, sector_from_rad, sector_to_rad,
                                    track->kalman.state[0], track->kalman.state[1]);
}

int rho_tracker_scan_looked_at(const struct step *step, const struct rho_track *track)
{
#if RHO_SECTORS
    return !step->is_doubted && rho_tracker_has_passed(step, track);
#else
    return rho_tracker_looked_at(step, step->scan->sector_from_rad, step->scan->sector_to_rad,
                                 track);
#endif
}

/* What a miss of the best sensor costs: a weak sensor's scan must not make earlier misses of a better one weigh more. */
static float largest_loss(const struct step *step)
{
    float loss = -step->log_miss;
    for (unsigned i = 0; i < step->tracker->num_sensors; i++) {
        float other = -rho_log(1.0f - step->tracker->sensors[i].pd);
        loss = other > loss ? other : loss;
    }
    return loss;
}

struct rho_track_limits rho_tracker_limits(const struct step *step)
{
    const struct rho_tracker *tracker = step->tracker;
    struct rho_track_limits limits = {
        .confirm_mnat = tracker->confirm_mnat,
        .doubt_mnat = LIFETIME_MNAT * (int32_t)tracker->looks_max,
        .tentative_mnat = tracker->start_mnat - TENTATIVE_FALL_MNAT,
        .fall_mnat = rho_tracker_mnat(largest_loss(step) * (float)tracker->config.coast_scans_max *
                                      (float)tracker->looks_max),
        .misses_in_row_max = (uint8_t)tracker->config.coast_scans_max,
    };
    return limits;
}

static int may_hide(const struct step *step, const struct rho_track *track)
{
    return rho_tracker_is_grown(track) && rho_tracker_has_moved(track) &&
           rho_tracker_clutter_in_gate(step, track) <= HIDE_CLUTTER_MAX;
}

/*
 * What hides ends later, and its evidence falls no further than twice the doubt: a hidden target is
 * missed for sure, and two plots that fit are to be enough when it is back.
 */
static void let_hide(struct rho_track *track, struct rho_track_limits *limits)
{
    const float misses = HIDE_SHARE * (float)limits->misses_in_row_max;
    const int32_t most_mnat = 2 * limits->doubt_mnat;
    const int32_t least_mnat = track->score_max_mnat - most_mnat;
    limits->misses_in_row_max = misses < (float)UINT8_MAX ? (uint8_t)misses : UINT8_MAX;
    limits->fall_mnat = limits->fall_mnat > most_mnat ? limits->fall_mnat : most_mnat + 1;
    track->score_mnat = track->score_mnat > least_mnat ? track->score_mnat : least_mnat;
}

static void judge(struct step *step, struct rho_track *track, const struct rho_track_limits *limits)
{
    const uint8_t was_believed = track->is_believed;
    const int is_low = track->score_max_mnat - track->score_mnat > 2 * limits->doubt_mnat;
    const int is_late = track->misses_in_row >= limits->misses_in_row_max;
    struct rho_track_limits own = *limits;
    if ((is_low || is_late) && may_hide(step, track)) {
        let_hide(track, &own);
    }
    if (is_late || rho_tracker_is_too_young(step, track)) {
        own.doubt_mnat = 0;
    }
    rho_tracker_note_growth(step, track);
    if (rho_track_judge(track, &own) == RHO_TRACK_FREE) {
        rho_tracker_note_death(step, track);
        rho_tracker_end_track(step, track);
    } else if (track->is_believed != was_believed) {
        step->tracker->counters.tracks_confirmed =
            rho_count(step->tracker->counters.tracks_confirmed, 1);
    }
}

/* It has come upon something that stands: no target, however often it is seen. */
static int is_too_slow(const struct step *step, const struct rho_track *track)
{
    const float *velocity_mps = &track->kalman.state[3];
    const float least_mps =
        step->tracker->config.v_min_mps - SLOW_SIGMAS * rho_track_sigma_mps(track);
    return least_mps > 0.0f && velocity_mps[0] * velocity_mps[0] +
                                       velocity_mps[1] * velocity_mps[1] +
                                       velocity_mps[2] * velocity_mps[2] <
                                   least_mps * least_mps;
}

/* Updates in a row after which its speed is surely beyond the fastest target's, and by more than a tenth. */
static int is_too_fast_for_long(const struct step *step, struct rho_track *track)
{
    const float *velocity_mps = &track->kalman.state[3];
    const float v_max_mps = step->tracker->config.v_max_mps;
    const float speed2 = velocity_mps[0] * velocity_mps[0] + velocity_mps[1] * velocity_mps[1] +
                         velocity_mps[2] * velocity_mps[2];
    const float most_mps = FAST_SHARE * v_max_mps;
    const float sure_mps = v_max_mps + FAST_SIGMAS * rho_track_sigma_mps(track);
    const float limit_mps = most_mps > sure_mps ? most_mps : sure_mps;
    if (track->plot >= 0) {
        track->fast_in_row =
            (uint8_t)(speed2 > limit_mps * limit_mps
                          ? track->fast_in_row + (track->fast_in_row < FAST_UPDATES ? 1 : 0)
                          : 0);
    }
    return track->fast_in_row >= FAST_UPDATES;
}

void rho_tracker_age(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_tracker_counters *counters = &tracker->counters;
    struct rho_track_limits limits = rho_tracker_limits(step);
    unsigned live = 0;
    rho_tracker_weigh_youth(step);
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        if (track->status == RHO_TRACK_FREE) {
            continue;
        }
        /* a frame has counted its own */
        const int is_missed =
            track->plot < 0 &&
            (step->scan ? rho_tracker_is_reached(step, i) && rho_tracker_scan_looked_at(step, track)
                        : track->misses_in_row > 0);
        if (step->scan && is_missed) {
            /* what a miss says of a track of hypotheses is in its score already */
            rho_track_miss(track, RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)
                                      ? 0
                                      : rho_tracker_mnat(-rho_tracker_odds(step, track).log_miss));
        }
        rho_tracker_note_sight(step, track);
        const int is_unseen = rho_tracker_is_long_unseen(step, track, is_missed, &limits) ||
                              rho_tracker_is_nowhere(step, track);
        const int is_too_fast = is_too_fast_for_long(step, track);
        judge(step, track, &limits);
        if (track->status != RHO_TRACK_FREE &&
            (is_unseen || is_too_fast || is_too_slow(step, track))) {
            counters->tracks_unseen = rho_count(counters->tracks_unseen, is_unseen ? 1 : 0);
            counters->tracks_too_fast =
                rho_count(counters->tracks_too_fast, is_too_fast && !is_unseen ? 1 : 0);
            rho_tracker_end_track(step, track);
        }
        if (track->status != RHO_TRACK_FREE) {
            tracker->tracks[live++] = *track;
        }
    }
    tracker->num_tracks = (uint16_t)live;
}

/* ---- initiate --------------------------------------------------------------------------------- */

/* What a tentative track gives way by: its score; of one that hides how far that has fallen. */
static int32_t weight_of(const struct step *step, const struct rho_track *track)
{
    const int hides = track->misses_in_row >= step->tracker->config.coast_scans_max;
    return hides ? track->score_mnat - track->score_max_mnat : track->score_mnat;
}

/* Room for one more track: at the end, or that of the lowest tentative track below the score. */
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
        if (track->status == RHO_TRACK_TENTATIVE && weight_of(step, track) < score_mnat) {
            score_mnat = weight_of(step, track);
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

/* The row of a held plot in its scan; -1: of an earlier sector's. */
static int16_t row_of(struct rho_initiator *initiator, unsigned m, unsigned plot)
{
    const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, m);
#if RHO_SECTORS
    if (m + 1u == initiator->window.num_scans &&
        scan->plots[plot].offset_s < scan->newest.offset_min_s) {
        return -1;
    }
#endif
    return (int16_t)(scan->marks[plot] & RHO_WINDOW_ROW);
}

/* The candidate's plots in the order of their scans. */
static unsigned gather_plots(struct rho_initiator *initiator, const struct rho_candidate *candidate,
                             struct rho_track_plot *plots)
{
    unsigned n = 0;
    for (unsigned m = 0; m < initiator->window.num_scans; m++) {
        if ((unsigned)candidate->mask >> m & 1u) {
            const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, m);
            struct rho_plot plot = rho_window_plot_of(scan, candidate->plot[m]);
            plots[n++] = (struct rho_track_plot){
                .time_us = scan->time_us + plot.offset_us,
                .measures = scan->measures & ~RHO_MEASURES_VELOCITY, /* the window has none */
                .sensor_id = scan->sensor.sensor_id,
                .sensor = &scan->sensor,
                .plot = plot,
                .row = row_of(initiator, m, candidate->plot[m]),
            };
        }
    }
    return n;
}

int rho_tracker_admit(struct step *step, struct rho_track *track,
                      const struct rho_track_limits *limits)
{
    struct rho_tracker *tracker = step->tracker;
    if (!make_room(step, track->score_mnat)) {
        rho_track_end(track, &step->model);
        return 0;
    }
    rho_tracker_note_place(track);
    rho_tracker_note_sight(step, track);
    rho_tracker_note_ahead(track);
    track->seen_us = step->time_us;
    judge(step, track, limits);
    tracker->tracks[tracker->num_tracks++] = *track;
    tracker->next_track_id = tracker->next_track_id == UINT32_MAX ? 1 : tracker->next_track_id + 1;
    tracker->counters.tracks_started = rho_count(tracker->counters.tracks_started, 1);
    return 1;
}

/* A better one of this search started with its newest plot. If there is another target, the next scan will show it. */
static int is_doubled(struct rho_initiator *initiator, const struct rho_candidate *candidate)
{
    const unsigned newest = initiator->window.num_scans - 1u;
    const struct rho_window_scan *scan = rho_window_scan_at(&initiator->window, newest);
    return (scan->marks[candidate->plot[newest]] & RHO_WINDOW_INITIATED) != 0;
}

static void start_track(struct step *step, const struct rho_candidate *candidate,
                        const struct rho_track_limits *limits)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_track_plot plots[RHO_MAX_SCANS];
    struct rho_track track;
    unsigned n = gather_plots(step->initiator, candidate, plots);
    if (rho_track_start(&track, tracker->next_track_id, plots, n, &step->model,
                        candidate->score_mnat) != RHO_OK) {
        tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
        return;
    }
    rho_tracker_note_start(step, candidate, &track);
    if (rho_tracker_admit(step, &track, limits)) {
        tracker->counters.plots_initiated = rho_count(
            tracker->counters.plots_initiated, rho_initiator_consume(step->initiator, candidate));
        rho_tracker_expect_earlier_second_plots(step, candidate);
    }
}

void rho_tracker_refuse_unclaimed(struct step *step)
{
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            step->report->fates[i] = RHO_FATE_NO_ROOM;
        }
    }
}

/* What a doubted sensor alone sees is no target. */
static int is_without_say(const struct step *step)
{
#if RHO_SECTORS
    return step->is_doubted;
#else
    (void)step;
    return 0;
#endif
}

/* What the search did is work of the step. */
static void search_newest(struct step *step)
{
    struct rho_initiator *initiator = step->initiator;
    const struct rho_initiator_budget before = initiator->budget;
    (void)!rho_initiator_search_within(initiator, RHO_SEARCH_NEWEST, rho_tracker_work_left(step));
    step->work = rho_count(step->work, initiator->budget.work);
    step->plots_not_tried = rho_count(step->plots_not_tried,
                                      initiator->budget.plots_not_tried - before.plots_not_tried);
    step->is_partial |= initiator->budget.partial_steps != before.partial_steps;
}

/*
 * Pointers were checked before the step began. Targets are looked for by what is known of their
 * sensor now.
 */
static void push(struct step *step, const struct rho_scan *held)
{
    struct rho_sensor sensor;
    if (step->sensor) {
        sensor = *step->sensor;
        sensor.pd = rho_tracker_mean_pd(step);
    }
    (void)!rho_initiator_push(step->initiator, held, step->sensor ? &sensor : 0,
                              step->report->fates, &step->tracker->counters.plots_clutter);
}

void rho_tracker_initiate(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_initiator *initiator = step->initiator;
    if (!initiator) {
        rho_tracker_refuse_unclaimed(step);
        return;
    }
    /* only the plots with a fate of their own are offered */
    struct rho_scan held = *step->scan;
    held.num_plots = step->num_gated;
    push(step, &held);
    rho_tracker_keep_repeats(step);
    search_newest(step);
    tracker->counters.candidates_dropped =
        rho_count(tracker->counters.candidates_dropped, initiator->work.candidates_dropped);
    tracker->start_mnat = initiator->start_mnat;
    tracker->confirm_mnat = initiator->confirm_mnat;
    rho_tracker_note_thresholds(step);
    struct rho_track_limits limits = rho_tracker_limits(step);
    rho_tracker_begin_share(step, RHO_WORK_STARTS_SHARE);
    for (unsigned i = 0; i < initiator->num_candidates && !is_without_say(step); i++) {
        if (!is_doubled(initiator, &initiator->candidates[i])) {
            start_track(step, &initiator->candidates[i], &limits);
        }
    }
}
