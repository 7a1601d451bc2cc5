/* SPDX-License-Identifier: MIT */
/*
 * work_budget: shares of work_max for the phases of a step and for each track, and the plots that a
 * track scores where its share is too small for all.
 *
 * A quarter of work_max is for claims, another for tracks that score plots again because other
 * tracks were assigned their plots. Half of each quarter is reserved, in even shares for the tracks
 * that wait; of the rest a track takes a quarter at most. A track with more plots near it than its
 * share allows scores the plots nearest to its expected place. Before the claims an eighth of
 * work_max is for echoes of clutter; after them a sixteenth is for second plots, and another is
 * reserved for second plots of new tracks. With reflectors, a sixteenth is for plots of images
 * before the search, and another is reserved for tracks of images after it. The search has the
 * rest.
 */
#include "clutter.h"
#include "plots.h"
#include "sensors.h"
#include "step.h"

/* 1 / share of a phase that is reserved for the tracks, and 1 / share of the rest for one track. */
#define KEPT_SHARE 2u
#define FREE_PARTS 4u

/*
 * Units of work: to score a plot with one hypothesis; in addition to predict the hypothesis to the
 * plot's own time, and for a measured velocity in two or three axes; for a Kalman filter's gate.
 */
#define SCORE_UNITS 20u
#define MOVE_UNITS 60u
#define VELOCITY_UNITS 70u
#define VELOCITY_3D_UNITS 140u
#define GATE_UNITS 12u

/* Number of parts of RHO_MAX_PLOTS plots in which a large scan is claimed, one phase each. */
static uint32_t num_parts_to_claim_large_scan(const struct rho_look *look)
{
    const uint32_t parts = (look->num_inputs + RHO_MAX_PLOTS - 1u) / RHO_MAX_PLOTS;
    return !RHO_CLAIMS_BEYOND || parts < 1u ? 1u
           : parts < RHO_TRACKER_PARTS_MAX  ? parts
                                            : RHO_TRACKER_PARTS_MAX;
}

void rho_work_begin_phase(const struct rho_tracker *tracker, struct rho_work *work,
                          uint32_t divisor)
{
    const uint32_t work_max = tracker->config.work_max;
    work->share.end = work_max > 0 ? rho_count(work->spent, work_max / divisor) : UINT32_MAX;
}

void rho_work_begin_shares(const struct rho_look *look, struct rho_work *work)
{
    const struct rho_tracker *tracker = look->tracker;
    const uint32_t part = RHO_WORK_TRACKS_SHARE * num_parts_to_claim_large_scan(look);
    unsigned waiting = 0;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        waiting += tracker->tracks[row].status != RHO_TRACK_FREE && rho_look_has_in_view(look, row);
    }
    rho_work_begin_phase(tracker, work, part);
    work->share.kept = waiting > 0 ? tracker->config.work_max / (part * KEPT_SHARE * waiting) : 0u;
    work->share.waiting = waiting;
}

static uint32_t units_to_score_plot(const struct rho_look *look, const struct rho_track *track)
{
    if (!RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        return GATE_UNITS;
    }
    uint32_t units = SCORE_UNITS + (look->offset_max_s > 0.0f ? MOVE_UNITS : 0u);
    if (look->scan->measures & RHO_MEASURES_VELOCITY) {
        units += look->scan->measures & RHO_MEASURES_Z ? VELOCITY_3D_UNITS : VELOCITY_UNITS;
    }
    return units * rho_hypotheses_count(&look->tracker->hypotheses, track->slot);
}

/*
 * Units of work that the next waiting track may spend: its reserved share, and a part of the rest.
 */
static uint32_t take_share_of_next_track(struct rho_work *work)
{
    struct work_share *share = &work->share;
    if (share->end == UINT32_MAX) {
        return UINT32_MAX;
    }
    rho_work_release_share(work);
    const uint32_t used = work->spent + share->kept * (share->waiting + 1u);
    const unsigned others = share->waiting < FREE_PARTS - 1u ? share->waiting : FREE_PARTS - 1u;
    return share->kept + (used < share->end ? (share->end - used) / (others + 1u) : 0u);
}

struct plot_choice rho_work_begin_choice(const struct rho_look *look, struct rho_work *work,
                                         const struct rho_track *track)
{
    struct plot_choice choice = {.units = units_to_score_plot(look, track)};
    choice.most = take_share_of_next_track(work) / choice.units;
    return choice;
}

/* Octave of the squared distance between plot and predicted place; 0: nearer than 1 m. */
static unsigned distance_octave_of_plot(const struct rho_track *track, const struct rho_plot *plot)
{
    const float dx_m = plot->x_m - track->kalman.state[0];
    const float dy_m = plot->y_m - track->kalman.state[1];
    float end_m2 = 1.0f;
    unsigned octave = 0;
    while (octave + 1u < RHO_WORK_OCTAVES && dx_m * dx_m + dy_m * dy_m >= end_m2) {
        end_m2 *= 2.0f;
        octave++;
    }
    return octave;
}

void rho_work_count_plot(struct plot_choice *choice, const struct rho_track *track,
                         const struct rho_plot *plot)
{
    choice->in_octave[distance_octave_of_plot(track, plot)]++;
    choice->num_near++;
}

void rho_work_limit_choice(struct rho_work *work, struct plot_choice *choice)
{
    uint32_t left = choice->most;
    if (choice->num_near <= choice->most) {
        return;
    }
    choice->is_partial = 1;
    while (choice->in_octave[choice->last] <= left) {
        left -= choice->in_octave[choice->last++];
    }
    choice->of_last = left;
    work->is_partial = 1;
    work->plots_not_tried = rho_count(work->plots_not_tried, choice->num_near - choice->most);
}

int rho_work_take_plot(struct rho_work *work, struct plot_choice *choice,
                       const struct rho_track *track, const struct rho_plot *plot)
{
    if (choice->is_partial) {
        const unsigned octave = distance_octave_of_plot(track, plot);
        if (octave > choice->last || (octave == choice->last && choice->of_last == 0)) {
            return 0;
        }
        choice->of_last -= octave == choice->last ? 1u : 0u;
    }
    rho_work_spend(work, choice->units);
    return 1;
}

uint32_t rho_work_left_for_search(const struct rho_look *look, struct rho_work *work)
{
    const uint32_t most = look->initiator->config.work_max, all = look->tracker->config.work_max;
    if (all == 0) {
        return most;
    }
    const int has_images = RHO_MAX_REFLECTORS > 0 && look->tracker->num_reflectors > 0;
    const uint32_t kept =
        all / RHO_WORK_STARTS_SHARE + (has_images ? all / RHO_WORK_IMAGES_SHARE : 0u);
    const uint32_t used = rho_count(work->spent, kept);
    const uint32_t left = all > used ? all - used : 1u; /* 1, as 0 would be no limit */
    return most > 0 && most < left ? most : left;
}

void rho_work_record(struct rho_tracker *tracker, const struct rho_work *work,
                     struct rho_report *report)
{
    struct rho_tracker_work *sum = &tracker->work;
    sum->work = work->spent;
    sum->work_worst = sum->work > sum->work_worst ? sum->work : sum->work_worst;
    sum->partial_steps = rho_count(sum->partial_steps, work->is_partial ? 1u : 0u);
    sum->plots_not_tried = rho_count(sum->plots_not_tried, work->plots_not_tried);
    report->is_partial = work->is_partial ? 1u : 0u;
}
