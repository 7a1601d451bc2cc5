/* SPDX-License-Identifier: MIT */
/*
 * second_plots: raises the clutter density near claimed plots by the density of second plots of the
 * same target, learns how often those come, and ends the younger of two tracks of one target.
 */
#include "clutter.h"
#include "plots.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/recurring_clutter_map.h"
#include "sensors.h"
#include "step.h"

/* Bins of the distances of second plots on an axis: upper bounds in sigmas, and prior shares. */
static const float bin_end[RHO_SECOND_BINS] = {1.0f, 2.0f, 3.0f, 4.0f, 6.0f, 8.0f, 12.0f, 16.0f};
static const float bin_prior[RHO_SECOND_BINS] = {0.26f, 0.24f, 0.18f, 0.12f,
                                                 0.1f,  0.05f, 0.03f, 0.02f};

static float second_plot_rate(const struct rho_second_plots *table, const struct rho_track *track)
{
    const float rate =
        (table->plots + RATE_PRIOR_LOOKS * SECOND_RATE_PRIOR) / (table->looks + RATE_PRIOR_LOOKS);
    return track ? (track->second_plots + RATE_PRIOR_LOOKS * rate) /
                       (track->second_looks + RATE_PRIOR_LOOKS)
                 : rate;
}

static unsigned distance_bin(float sigmas)
{
    unsigned bin = 0;
    while (bin < RHO_SECOND_BINS && sigmas > bin_end[bin]) {
        bin++;
    }
    return bin;
}

/* Density of second plots on an axis at a distance in this bin, per sigma, on either side. */
static float bin_density(const struct rho_second_plots *table, const float *sums, unsigned bin)
{
    const float width = bin_end[bin] - (bin > 0 ? bin_end[bin - 1u] : 0.0f);
    return 0.5f * (sums[bin] + SECOND_BINS_PRIOR * bin_prior[bin]) /
           ((table->plots + SECOND_BINS_PRIOR) * width);
}

/* Distance of a plot from a claimed one, along the line of sight and across it, in bins. */
struct bin_offset {
    unsigned along, across; /* indices of bins; RHO_SECOND_BINS: beyond the last bin */
};

static int is_within_bins(struct bin_offset offset)
{
    return offset.along < RHO_SECOND_BINS && offset.across < RHO_SECOND_BINS;
}

static struct bin_offset plot_offset(const struct rho_sensor *sensor, const struct rho_plot *first,
                                     const struct rho_plot *second)
{
    const struct echo_view view = rho_clutter_map_view(sensor, first->x_m, first->y_m);
    const float dx_m = second->x_m - first->x_m, dy_m = second->y_m - first->y_m;
    const float along_m = dx_m * view.along_x + dy_m * view.along_y;
    const float across_m = dy_m * view.along_x - dx_m * view.along_y;
    return (struct bin_offset){
        distance_bin(rho_magnitude(along_m) / first->sigma_range_m),
        distance_bin(rho_magnitude(across_m) / first->sigma_cross_m),
    };
}

/* Half side of a square about a claimed plot that holds the bins in any direction. */
static float half_side(const struct rho_plot *first)
{
    return bin_end[RHO_SECOND_BINS - 1] * 1.4142136f * rho_plot_sigma_m(first);
}

/*
 * Density of a target's second plots at an offset from the first one, over that of the background
 * of clutter. track: whose target; NULL: the sensor's mean. Of both plots' range rates, where the
 * scan measures them, it is the ratio of one target to clutter.
 */
static float second_plot_ratio(const struct rho_look *look, uint32_t measures,
                               const struct rho_second_plots *table, const struct rho_track *track,
                               struct bin_offset offset, const struct rho_plot *first,
                               const struct rho_plot *second)
{
    const float density = bin_density(table, table->along, offset.along) *
                          bin_density(table, table->across, offset.across) /
                          (first->sigma_range_m * first->sigma_cross_m);
    const float rate_ratio =
        measures & RHO_MEASURES_RANGE_RATE
            ? rho_echoes_rate_ratio(look, second->range_rate_mps - first->range_rate_mps,
                                    first->sigma_range_rate_mps * first->sigma_range_rate_mps +
                                        second->sigma_range_rate_mps * second->sigma_range_rate_mps)
            : 1.0f;
    return second_plot_rate(table, track) * density * rate_ratio /
           rho_clutter_background_at(look, second);
}

/* Counts a claimed plot whose neighbours are not scored, as the share of work is used up. */
static void count_plot_not_tried(struct rho_work *work)
{
    work->is_partial = 1;
    work->plots_not_tried = rho_count(work->plots_not_tried, 1);
}

static float one_target_probability(const struct rho_track *track)
{
    return 1.0f / (1.0f + rho_exp(-track->one_target_nat));
}

/* ln evidence for one target where both have a plot: the younger's is second, or its own. */
static float two_plots_evidence(const struct rho_look *look, const struct rho_second_plots *table,
                                unsigned older_row, unsigned row)
{
    const struct rho_track *older = &look->tracker->tracks[older_row];
    const struct rho_track *track = &look->tracker->tracks[row];
    const struct rho_plot *first = &look->scan->plots[older->plot];
    const struct rho_plot *second = &look->scan->plots[track->plot];
    const struct bin_offset offset = plot_offset(look->sensor, first, second);
    float gain_nat = 0.0f, ratio = 0.0f, swap_nat = 0.0f, own_nat = 0.0f;
    (void)rho_score_pair_gain(look, row, track->plot, &gain_nat);
    /* or swapped: the younger has the only target's first plot, or each made the other's plot */
    float ways = 1.0f, older_ways = 1.0f;
    if (rho_score_pair_gain(look, older_row, older->plot, &own_nat) &&
        rho_score_pair_gain(look, older_row, track->plot, &swap_nat)) {
        float other_nat;
        older_ways += rho_exp(swap_nat - own_nat);
        if (rho_score_pair_gain(look, row, older->plot, &other_nat)) {
            ways += rho_exp(swap_nat - own_nat + other_nat - gain_nat);
        }
    }
    if (is_within_bins(offset)) {
        ratio = second_plot_ratio(look, look->scan->measures, table, older, offset, first, second) *
                rho_exp(-rho_echoes_log_ratio_at(look, (uint32_t)track->plot));
    }
    return rho_log(1.0f + ratio) + rho_log(older_ways / ways) - gain_nat;
}

/*
 * Evidence for one target, ln, by a scan in which one of both tracks has a plot, or both have the
 * same. A plot in both gates could be of either of two targets: two ways, which ln 2 counts.
 */
static float one_plot_evidence(const struct rho_look *look, const struct rho_second_plots *table,
                               unsigned older_row, unsigned row)
{
    const struct rho_track *older = &look->tracker->tracks[older_row];
    const struct rho_track *track = &look->tracker->tracks[row];
    const int plot = older->plot >= 0 ? older->plot : track->plot;
    float gain_nat = 0.0f, older_gain_nat = 0.0f, nat = -second_plot_rate(table, older);
    if (older->plot == track->plot) {
        return MERGED_NAT;
    }
    const int is_in_gate = rho_score_pair_gain(look, row, plot, &gain_nat);
    const int is_in_olders_gate = rho_score_pair_gain(look, older_row, plot, &older_gain_nat);
    if (older->plot < 0) {
        if (!is_in_olders_gate) {
            /* a second plot near the older track's place is no evidence; else it speaks for two */
            struct rho_plot place = look->scan->plots[plot];
            place.x_m = older->kalman.state[0];
            place.y_m = older->kalman.state[1];
            return is_within_bins(plot_offset(look->sensor, &place, &look->scan->plots[plot]))
                       ? 0.0f
                       : -gain_nat;
        }
        nat += older_gain_nat - gain_nat;
    }
    if (!is_in_gate) {
        return YOUNGER_MISS_NAT;
    }
    return nat - rho_look_detection(look, track).log_miss -
           (is_in_olders_gate ? 0.69314718f : 0.0f);
}

static void add_one_target_evidence(struct rho_track *track, float nat)
{
    nat = rho_smaller(nat, ONE_TARGET_END_NAT);
    track->one_target_nat += rho_larger(nat, -ONE_TARGET_END_NAT);
    track->one_target_nat = rho_larger(track->one_target_nat, ONE_TARGET_LEAST_NAT);
}

static void test_younger_track(struct step *step, const struct rho_second_plots *table,
                               unsigned row)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_track *track = &tracker->tracks[row];
    const unsigned older_row = rho_tracker_find_row(tracker, track->older_id);
    if (older_row >= row) { /* it has ended, or an operator has changed the order */
        track->older_id = 0;
        track->one_target_nat = 0.0f;
        return;
    }
    struct rho_track *older = &tracker->tracks[older_row];
    const float share = one_target_probability(track);
    older->second_share = share < older->second_share ? share : older->second_share;
    if (!rho_look_has_in_view(&step->look, row) || !rho_look_has_in_view(&step->look, older_row) ||
        !rho_look_may_miss(&step->look, track) || !rho_look_may_miss(&step->look, older) ||
        (track->plot < 0 && older->plot < 0)) {
        return;
    }
    const float nat = track->plot >= 0 && older->plot >= 0 && track->plot != older->plot
                          ? two_plots_evidence(&step->look, table, older_row, row)
                          : one_plot_evidence(&step->look, table, older_row, row);
    add_one_target_evidence(track, nat);
    if (track->one_target_nat > ONE_TARGET_END_NAT) {
        track->one_target_nat = ONE_TARGET_END_NAT;
        if (older->plot >= 0) {
            rho_life_end(step, track);
        }
    }
}

struct second_plot_sums {
    float plots;
    float along[RHO_SECOND_BINS], across[RHO_SECOND_BINS];
};

/*
 * Probability that a plot near the track's plot is its target's second one. Raises the density of
 * clutter at an unclaimed plot; a younger track that claimed the plot becomes one to be tested.
 */
static float second_plot_probability(struct rho_tracker *tracker, const struct rho_look *look,
                                     const struct rho_second_plots *table, unsigned row,
                                     uint32_t other, struct bin_offset offset)
{
    const struct rho_track *track = &tracker->tracks[row];
    const struct rho_plot *first = &look->scan->plots[track->plot];
    const struct rho_plot *second = &look->scan->plots[other];
    const int owner = tracker->assignment.column_row[other];
    float share = 1.0f;
    if (look->fates[other] != RHO_FATE_HELD) {
        if (owner <= (int)row || tracker->tracks[owner].plot != (int)other ||
            tracker->config.gate == RHO_TRACKER_HOUGH) {
            /* no second plot: an older track's, or invalid; the Hough gate has no likelihoods */
            return 0.0f;
        }
        struct rho_track *younger = &tracker->tracks[owner];
        if (younger->older_id == 0 && younger->hits <= TARGET_TRACK_HITS && track->was_confirmed) {
            younger->older_id = track->track_id;
            younger->one_target_nat = 0.0f;
            add_one_target_evidence(younger, two_plots_evidence(look, table, row, (unsigned)owner));
        }
        share = younger->older_id == track->track_id ? one_target_probability(younger) : 0.0f;
    }
    const float ratio =
        second_plot_ratio(look, look->scan->measures, table, track, offset, first, second);
    float *denser = &tracker->clutter_map.denser[other];
    const float known = rho_exp(*denser);
    if (look->fates[other] == RHO_FATE_HELD) {
        *denser = rho_log(known + ratio);
    }
    return share * ratio / (known + ratio);
}

/* Sums the probable second plots near a track's plot, and raises the clutter density at them. */
static void take_neighbours(struct rho_tracker *tracker, const struct rho_look *look,
                            struct rho_work *work, const struct rho_second_plots *table,
                            unsigned row, struct second_plot_sums *found)
{
    const struct rho_track *track = &tracker->tracks[row];
    const struct rho_plot *first = &look->scan->plots[track->plot];
    const float half_m = half_side(first);
    struct plots_near near = rho_plots_near(tracker, first->x_m - half_m, first->x_m + half_m,
                                            first->y_m - half_m, first->y_m + half_m);
    uint32_t passed = 0;
    for (uint32_t i; rho_plots_next(look, &near, &i); passed++) {
        const struct rho_plot *plot = &look->scan->plots[i];
        if (!rho_plots_is_within(&near, plot) || (int)i == track->plot ||
            look->fates[i] == RHO_FATE_INVALID) {
            continue;
        }
        const struct bin_offset offset = plot_offset(look->sensor, first, plot);
        rho_work_spend(work, SECOND_UNITS);
        if (is_within_bins(offset)) {
            const float share = second_plot_probability(tracker, look, table, row, i, offset);
            found->plots += share;
            found->along[offset.along] += share;
            found->across[offset.across] += share;
        }
    }
    rho_work_spend(work, passed / RHO_WORK_PASSED_A_UNIT);
}

void rho_second_plots_take_look(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_second_plots *table = step->look.row ? &step->look.row->second_plots : 0;
    struct second_plot_sums found = {.plots = 0.0f};
    float looks = 0.0f;
    if (!table || !step->look.teaches || step->look.num_inputs > RHO_MAX_PLOTS) {
        return;
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        tracker->tracks[row].second_share = 1.0f;
    }
    /* not with the Hough gate, whose gains are no likelihoods */
    for (unsigned row = 1; row < tracker->num_tracks && tracker->config.gate != RHO_TRACKER_HOUGH;
         row++) {
        if (tracker->tracks[row].older_id > 0 && tracker->tracks[row].status != RHO_TRACK_FREE) {
            test_younger_track(step, table, row);
        }
    }
    rho_work_begin_phase(tracker, &step->work, RHO_WORK_SECOND_SHARE);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status == RHO_TRACK_FREE || track->plot < 0) {
            continue;
        }
        if (rho_work_is_spent(&step->work)) {
            count_plot_not_tried(&step->work);
            continue;
        }
        struct second_plot_sums near = {.plots = 0.0f};
        take_neighbours(tracker, &step->look, &step->work, table, row, &near);
        if (track->was_confirmed && track->hits >= TEACHER_HITS) {
            const float share = track->second_share;
            if (track->second_looks >= TRACK_LOOKS_REMEMBERED) {
                track->second_looks *= 0.5f;
                track->second_plots *= 0.5f;
            }
            track->second_looks += share;
            track->second_plots += share * near.plots;
            looks += share;
            found.plots += share * near.plots;
            for (unsigned bin = 0; bin < RHO_SECOND_BINS; bin++) {
                found.along[bin] += share * near.along[bin];
                found.across[bin] += share * near.across[bin];
            }
        }
    }
    if (!(looks > 0.0f)) {
        return;
    }
    const float keep = table->looks >= (float)LEARNED_MAX ? 0.5f : 1.0f;
    table->looks = keep * table->looks + looks;
    table->plots = keep * table->plots + found.plots;
    for (unsigned bin = 0; bin < RHO_SECOND_BINS; bin++) {
        table->along[bin] = keep * table->along[bin] + found.along[bin];
        table->across[bin] = keep * table->across[bin] + found.across[bin];
    }
}

void rho_second_plots_raise_window(const struct rho_look *look, struct rho_work *work,
                                   const struct rho_candidate *candidate)
{
    struct rho_window *window = &look->initiator->window;
    for (unsigned m = 0; m < window->num_scans; m++) {
        struct rho_window_scan *scan = rho_window_scan_at(window, m);
        const unsigned row = rho_sensors_row(look->tracker, scan->sensor.sensor_id);
        if (!((unsigned)candidate->mask >> m & 1u) || row >= look->tracker->num_rows) {
            continue;
        }
        if (rho_work_is_spent(work)) {
            count_plot_not_tried(work);
            continue;
        }
        rho_work_spend(work, scan->num_plots / RHO_WORK_PASSED_A_UNIT);
        const struct rho_second_plots *table = &look->tracker->sensors[row].second_plots;
        const struct rho_plot first = rho_window_unpack_plot(scan, candidate->plot[m]);
        const struct rho_sensor *sensor = rho_window_sensor_if_described(scan);
        const float half_m = half_side(&first);
        for (unsigned i = 0; i < scan->num_plots; i++) {
            const float dx_m = scan->plots[i].x_m - first.x_m,
                        dy_m = scan->plots[i].y_m - first.y_m;
            if (dx_m > half_m || dx_m < -half_m || dy_m > half_m || dy_m < -half_m ||
                (scan->marks[i] & RHO_WINDOW_INITIATED)) {
                continue;
            }
            const struct rho_plot plot = rho_window_unpack_plot(scan, i);
            const struct bin_offset offset = plot_offset(sensor, &first, &plot);
            rho_work_spend(work, SECOND_UNITS);
            if (is_within_bins(offset)) {
                const float ratio =
                    second_plot_ratio(look, scan->measures, table, 0, offset, &first, &plot);
                /* `repeats` is ln of the density ratio in steps */
                const float was = rho_exp((float)scan->repeats[i] / RHO_WINDOW_REPEATS_PER_NAT);
                const float is = RHO_WINDOW_REPEATS_PER_NAT * rho_log(was + ratio) + 0.5f;
                scan->repeats[i] = (uint8_t)(is < 255.0f ? is : 255.0f);
            }
        }
    }
}

int rho_second_is_sound_track(const struct rho_track *track)
{
    return rho_is_within(track->second_looks, 0.0f, 1e6f) &&
           rho_is_within(track->second_plots, 0.0f, 1e6f) &&
           rho_is_within(track->one_target_nat, -1e3f, 1e3f) &&
           rho_are_finite(&track->second_share, 1);
}

int rho_second_plots_are_sound(const struct rho_second_plots *table)
{
    return rho_is_within(table->looks, 0.0f, 1e9f) && rho_is_within(table->plots, 0.0f, 1e9f) &&
           rho_are_within(table->along, RHO_SECOND_BINS, 0.0f, 1e9f) &&
           rho_are_within(table->across, RHO_SECOND_BINS, 0.0f, 1e9f);
}
