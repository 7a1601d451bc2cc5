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
#include "plots.h"
#include "policy.h"

void rho_work_begin_phase(const struct rho_tracker *tracker, struct rho_work *work,
                          uint32_t divisor)
{
    const uint32_t work_max = tracker->config.work_max;
    work->share.end = work_max > 0 ? rho_count(work->spent, work_max / divisor) : UINT32_MAX;
}

void rho_work_begin_shares(const struct rho_look *look, struct rho_work *work)
{
    const struct rho_tracker *tracker = look->tracker;
    /* a large scan is claimed in parts of RHO_MAX_PLOTS plots, one phase each */
    uint32_t parts = (look->num_inputs + RHO_MAX_PLOTS - 1u) / RHO_MAX_PLOTS;
    parts = !RHO_CLAIMS_BEYOND || parts < 1u ? 1u : parts;
    const uint32_t part =
        RHO_WORK_TRACKS_SHARE * (parts < RHO_TRACKER_PARTS_MAX ? parts : RHO_TRACKER_PARTS_MAX);
    unsigned waiting = 0;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        waiting += tracker->tracks[row].status != RHO_TRACK_FREE && rho_look_has_in_view(look, row);
    }
    rho_work_begin_phase(tracker, work, part);
    work->share.kept = waiting > 0 ? tracker->config.work_max / (part * KEPT_PARTS * waiting) : 0u;
    work->share.waiting = waiting;
}

struct plot_choice rho_work_begin_choice(const struct rho_look *look, struct rho_work *work,
                                         const struct rho_track *track)
{
    const struct rho_hypotheses *hypotheses = &look->tracker->hypotheses;
    const uint32_t measures = look->scan->measures;
    struct work_share *share = &work->share;
    struct plot_choice choice = {.units = GATE_UNITS};
    if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
        uint32_t units = SCORE_UNITS + (look->offset_max_s > 0.0f ? MOVE_UNITS : 0u);
        if (measures & RHO_MEASURES_VELOCITY) {
            units += measures & RHO_MEASURES_Z ? VELOCITY_3D_UNITS : VELOCITY_UNITS;
        }
        choice.units = units * rho_hypotheses_count(hypotheses, track->slot);
    }
    uint32_t most = UINT32_MAX;
    if (share->end != UINT32_MAX) { /* the track's reserved share, and a part of the rest */
        rho_work_release_share(work);
        const uint32_t used = work->spent + share->kept * (share->waiting + 1u);
        const unsigned others = share->waiting < FREE_PARTS - 1u ? share->waiting : FREE_PARTS - 1u;
        most = share->kept + (used < share->end ? (share->end - used) / (others + 1u) : 0u);
    }
    choice.most = most / choice.units;
    return choice;
}

/* Octave of the squared distance between plot and predicted place; 0: nearer than 1 m. */
static unsigned distance_octave(const struct rho_track *track, const struct rho_plot *plot)
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
    choice->in_octave[distance_octave(track, plot)]++;
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
        const unsigned octave = distance_octave(track, plot);
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
