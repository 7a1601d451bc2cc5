/* SPDX-License-Identifier: MIT */
/*
 * echo_clutter: a step computes the clutter density at each plot from the clutter map, and
 * updates the map with the plots.
 *
 *   look   before claims: echoes are predicted to the scan's time, and each adds the density of its
 *          next plot at the plots near it
 *   keep   when plots are held for initiation, the density ratios are stored with them
 *   learn  after starts: each echo is updated with the plot that it explains best; plots that no
 *          echo explains become new echoes
 *
 * The map also counts returns of echoes that were plots of targets, until a track is known to be of
 * a target. So each track sums the probabilities that its plots were returns of echoes. Once the
 * track has enough hits and moves as a target does, that sum is subtracted from the map.
 */
#include <string.h>

#include "clutter.h"
#include "plots.h"
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "rhotrack/detail/recurring_clutter_map.h"

static float sensor_range_max(const struct rho_look *look)
{
    const struct rho_extent *extent = &look->tracker->extent;
    const float width_m = rho_extent_width_m(extent, RHO_CLUTTER_SIDE_MIN_M);
    const float height_m = rho_extent_height_m(extent, RHO_CLUTTER_SIDE_MIN_M);
    return look->sensor ? look->sensor->range_max_m
                        : 0.5f * rho_sqrt(width_m * width_m + height_m * height_m);
}

/* Normal density of a range rate's deviation, over the density of clutter uniform in all rates. */
static float normal_over_uniform(const struct rho_look *look, float off_mps, float variance)
{
    const float share = rho_exp(-0.5f * off_mps * off_mps / variance);
    return share > 0.0f ? look->range_rates_mps * (share * rho_inverse_sqrt(RHO_TWO_PI * variance))
                        : 0.0f; /* most plots: exp() has underflowed */
}

float rho_echoes_rate_ratio(const struct rho_look *look, float off_mps, float variance)
{
    return 0.5f + 0.5f * normal_over_uniform(look, off_mps,
                                             variance + ECHO_RATE_SIGMA_MPS * ECHO_RATE_SIGMA_MPS);
}

/*
 * Likelihood ratios of a plot's range rate, from the echo against clutter that is spread over all
 * rates. exact: the rate is that of the echo's own speed, as of a mast; other: it is not (blades,
 * trees, water). share: learned share of echoes' plots with the exact rate.
 */
struct rate_ratios {
    float exact, other, share;
};

static struct rate_ratios echo_rate_ratios(const struct rho_look *look, const struct rho_echo *echo,
                                           const struct echo_view *view,
                                           const struct rho_plot *plot)
{
    const struct rho_clutter_map *map = &look->tracker->clutter_map;
    const float variance = plot->sigma_range_rate_mps * plot->sigma_range_rate_mps + echo->along[2];
    const float off_mps =
        plot->range_rate_mps - (echo->vx_mps * view->along_x + echo->vy_mps * view->along_y);
    return (struct rate_ratios){normal_over_uniform(look, off_mps, variance),
                                rho_echoes_rate_ratio(look, off_mps, variance),
                                (map->exact_plots + ECHO_EXACT_PRIOR * RATE_PRIOR_LOOKS) /
                                    (map->rate_plots + RATE_PRIOR_LOOKS)};
}

/* Adds, at the plots near an echo, the density of its next plot by its probability to return. */
static void add_echo_density(struct rho_tracker *tracker, const struct rho_look *look,
                             struct rho_work *work, unsigned place)
{
    struct rho_clutter_map *map = &tracker->clutter_map;
    const struct rho_echo *echo = &map->echoes[place];
    const int has_rates = (look->scan->measures & RHO_MEASURES_RANGE_RATE) != 0;
    struct echo_view view = {0.0f, 0.0f, 0.0f};
    float probability = -1.0f; /* of the echo's return; < 0: no plot near the echo yet */
    const float sigma_m = look->sigma_max_m;
    const float half_m = 4.2426407f * /* the root of ECHO_CHI2 */
                         rho_sqrt(echo->along[0] + echo->across[0] + sigma_m * sigma_m);
    struct plots_near near = rho_plots_near(tracker, echo->x_m - half_m, echo->x_m + half_m,
                                            echo->y_m - half_m, echo->y_m + half_m);
    uint32_t passed = 0;
    for (uint32_t i; rho_plots_next(look, &near, &i); passed++) {
        const struct rho_plot *plot = &look->scan->plots[i];
        const float dx_m = plot->x_m - echo->x_m, dy_m = plot->y_m - echo->y_m;
        if (!rho_plots_is_within(&near, plot) || look->fates[i] != RHO_FATE_HELD) {
            continue;
        }
        if (probability < 0.0f) {
            view = rho_clutter_map_view(look->sensor, echo->x_m, echo->y_m);
            probability =
                rho_clutter_map_return_probability(map, echo->region, echo->hits, echo->unseen);
        }
        rho_work_spend(work, ECHO_UNITS + (has_rates ? ECHO_RATE_UNITS : 0u));
        const float along_m = dx_m * view.along_x + dy_m * view.along_y;
        const float across_m = dy_m * view.along_x - dx_m * view.along_y;
        const float along_m2 = echo->along[0] + plot->sigma_range_m * plot->sigma_range_m;
        const float across_m2 = echo->across[0] + plot->sigma_cross_m * plot->sigma_cross_m;
        const float chi2 = along_m * along_m / along_m2 + across_m * across_m / across_m2;
        if (!(chi2 < ECHO_CHI2)) {
            continue;
        }
        float rate_ratio = 1.0f; /* echo against clutter of any range rate */
        if (has_rates) {
            const struct rate_ratios ratios = echo_rate_ratios(look, echo, &view, plot);
            rate_ratio = ratios.share * ratios.exact + (1.0f - ratios.share) * ratios.other;
        }
        const float density =
            probability * (rho_exp(-0.5f * chi2) * rho_inverse_sqrt(along_m2 * across_m2) /
                           RHO_TWO_PI * rate_ratio);
        if (!(density > 0.0f)) {
            continue;
        }
        map->denser[i] += density;
        if (density > map->best_per_m2[i]) {
            map->best_per_m2[i] = density;
            map->best_echo[i] = (uint16_t)place;
        }
    }
    rho_work_spend(work, passed / RHO_WORK_PASSED_A_UNIT);
}

/* Bin of azimuth, of RHO_ECHO_STROBES, and range of a valid plot, as the sensor sees it. */
struct direction {
    unsigned bin;
    float range_m;
};

static struct direction plot_direction(const struct rho_look *look, uint32_t row)
{
    const struct rho_plot *plot = &look->scan->plots[row];
    const struct echo_view view = rho_clutter_map_view(look->sensor, plot->x_m, plot->y_m);
    const unsigned bin = (unsigned)(rho_clutter_map_azimuth_turns(&view) * (float)RHO_ECHO_STROBES);
    return (struct direction){bin < RHO_ECHO_STROBES ? bin : 0, view.range_m};
}

/* Index of the part, of STROBE_RANGES, of the sensor's maximum range that a range lies in. */
static unsigned range_part(float range_m, float range_max_m)
{
    const float part = (float)STROBE_RANGES * range_m / range_max_m;
    return part < (float)STROBE_RANGES ? (unsigned)part : STROBE_RANGES - 1u;
}

/* Plots a radian and metre of range that a strobe adds in three neighbouring bins; 0: no strobe. */
static float strobe_density(const struct rho_look *look, unsigned bin, float plots,
                            float range_max_m)
{
    const struct rho_clutter_map *map = &look->tracker->clutter_map;
    unsigned count = 0, ranges = 0;
    for (unsigned k = bin + RHO_ECHO_STROBES - 1u; k <= bin + RHO_ECHO_STROBES + 1u; k++) {
        count += map->strobe_count[k % RHO_ECHO_STROBES];
        ranges |= map->strobe_ranges[k % RHO_ECHO_STROBES];
    }
    if (!((float)count > STROBE_PLOTS_MIN)) {
        return 0.0f; /* most directions have too few plots for a strobe */
    }
    /* of the scan's sector, or of the sensor's stated sector where that is narrower */
    const float scan_rad =
        rho_angle_sector_width(look->scan->sector_from_rad, look->scan->sector_to_rad);
    const float sensor_rad = look->sensor ? rho_angle_sector_width(look->sensor->sector_from_rad,
                                                                   look->sensor->sector_to_rad)
                                          : scan_rad;
    const float width_rad = 3.0f * RHO_TWO_PI / (float)RHO_ECHO_STROBES;
    const float others_rad = (sensor_rad < scan_rad ? sensor_rad : scan_rad) - width_rad;
    const float usual = others_rad > 0.0f ? (plots - (float)count) * width_rad / others_rad : plots;
    return (float)count > STROBE_PLOTS_MIN + STROBE_TIMES_USUAL * usual &&
                   rho_count_bits(ranges) >= STROBE_RANGES_MIN
               ? ((float)count - usual) / (width_rad * range_max_m)
               : 0.0f;
}

/* Adds a jammer's strobes, one direction at all ranges: too narrow for the initiator's map. */
static void add_strobe_densities(struct rho_tracker *tracker, const struct rho_look *look,
                                 float range_max_m)
{
    struct rho_clutter_map *map = &tracker->clutter_map;
    float plots = 0.0f;
    unsigned ranges = 0;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD) {
            const struct rho_plot *plot = &look->scan->plots[i];
            const struct echo_view view = rho_clutter_map_view(look->sensor, plot->x_m, plot->y_m);
            ranges |= 1u << range_part(view.range_m, range_max_m);
            plots += 1.0f;
        }
    }
    if (!(plots > STROBE_PLOTS_MIN) || rho_count_bits(ranges) < STROBE_RANGES_MIN) {
        return; /* most scans: no direction needs to be computed */
    }
    memset(map->strobe_count, 0, sizeof map->strobe_count);
    memset(map->strobe_ranges, 0, sizeof map->strobe_ranges);
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD) {
            const struct direction at = plot_direction(look, i);
            map->strobe_count[at.bin]++;
            map->strobe_ranges[at.bin] |= (uint8_t)(1u << range_part(at.range_m, range_max_m));
        }
    }
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] != RHO_FATE_HELD) {
            continue;
        }
        const struct direction at = plot_direction(look, i);
        float density = 0.0f;
        for (unsigned k = 0; k < 3; k++) { /* a plot at a strobe's edge may be one bin beside it */
            const float beside = strobe_density(
                look, (at.bin + RHO_ECHO_STROBES + k - 1u) % RHO_ECHO_STROBES, plots, range_max_m);
            density = beside > density ? beside : density;
        }
        if (density > 0.0f && at.range_m > 0.0f) {
            map->denser[i] += density / at.range_m;
        }
    }
}

/* True of an echo where an operator's track is. */
static int is_operators_echo(const struct rho_tracker *tracker, const struct rho_echo *echo)
{
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        const struct rho_track *track = &tracker->tracks[i];
        if (!track->is_operators) {
            continue;
        }
        const float dx_m = echo->x_m - track->kalman.state[0];
        const float dy_m = echo->y_m - track->kalman.state[1];
        const float sigma_m = rho_track_sigma_m(track);
        if (dx_m * dx_m + dy_m * dy_m <
            ECHO_CHI2 * (sigma_m * sigma_m + echo->along[0] + echo->across[0])) {
            return 1;
        }
    }
    return 0;
}

void rho_echoes_predict(struct rho_tracker *tracker, const struct rho_look *look,
                        struct rho_work *work)
{
    struct rho_clutter_map *map = &tracker->clutter_map;
    const struct rho_scan *scan = look->scan;
    map->is_looked = look->teaches ? 1 : 0;
    if (!look->teaches) {
        return;
    }
    map->time_us = look->time_us;
    memset(map->denser, 0, look->num_gated * sizeof map->denser[0]);
    memset(map->best_per_m2, 0, look->num_gated * sizeof map->best_per_m2[0]);
    const float range_max_m = sensor_range_max(look);
    unsigned place = map->first_echo, left_out = 0, operators = 0;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        operators += tracker->tracks[i].is_operators;
    }
    rho_work_begin_phase(tracker, work, RHO_WORK_ECHOES_SHARE);
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++, place = (place + 1u) % RHO_ECHO_PLACES) {
        struct rho_echo *echo = &map->echoes[place];
        if (echo->hits == 0) {
            continue;
        }
        echo->was_looked_at = 0;
        echo->plot = -1;
        echo->weight = 0.0f;
        if (echo->sensor_id != scan->sensor_id ||
            !rho_measurement_covers(look->sensor, scan->sector_from_rad, scan->sector_to_rad,
                                    echo->x_m, echo->y_m) ||
            (operators > 0 && is_operators_echo(tracker, echo))) {
            continue;
        }
        if (rho_work_is_spent(work)) { /* the next scan begins with the first one left out */
            map->first_echo = (uint16_t)(left_out == 0 ? place : map->first_echo);
            left_out++;
            continue;
        }
        echo->was_looked_at = 1;
        echo->unseen = (uint8_t)(echo->unseen < UINT8_MAX ? echo->unseen + 1 : UINT8_MAX);
        if (rho_clutter_map_is_echo_lost(echo)) {
            echo->hits = 0;
            continue;
        }
        if (echo->region == UINT8_MAX || echo->unseen == 1) {
            echo->region =
                rho_clutter_map_region_at(look->sensor, range_max_m, echo->x_m, echo->y_m);
        }
        rho_clutter_map_predict_echo(echo, look->time_us);
        if (!(echo->along[0] + echo->across[0] < ECHO_UNKNOWN_SHARE * range_max_m * range_max_m)) {
            echo->hits = 0; /* the echo's place is unknown after a long silence of the sensor */
            continue;
        }
        add_echo_density(tracker, look, work, place);
    }
    work->is_partial |= left_out > 0;
    work->plots_not_tried = rho_count(work->plots_not_tried, left_out);
    add_strobe_densities(tracker, look, range_max_m);
    /* each echo gets the plot of which it explains the largest share; densities become ln ratios */
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (!(map->denser[i] > 0.0f)) {
            continue;
        }
        const float density = rho_clutter_background_at(look, &scan->plots[i]);
        if (map->best_per_m2[i] > 0.0f) {
            struct rho_echo *echo = &map->echoes[map->best_echo[i]];
            const float weight = map->best_per_m2[i] / (density + map->denser[i]);
            if (weight > echo->weight) {
                echo->weight = weight;
                echo->plot = (int16_t)i;
            }
        }
        map->denser[i] = rho_log(1.0f + map->denser[i] / density);
    }
}

float rho_echoes_log_ratio_at(const struct rho_look *look, uint32_t row)
{
    const struct rho_clutter_map *map = &look->tracker->clutter_map;
    return map->is_looked && look->first_row == 0 ? map->denser[row] : 0.0f;
}

void rho_echoes_store_ratios(const struct rho_look *look)
{
    struct rho_window *window = &look->initiator->window;
    const struct rho_clutter_map *map = &look->tracker->clutter_map;
    struct rho_window_scan *scan = rho_window_scan_at(window, window->num_scans - 1u);
    for (unsigned i = 0; i < scan->num_plots && map->is_looked; i++) {
        const unsigned row = scan->marks[i] & RHO_WINDOW_ROW;
        if (row >= look->num_gated) {
            continue; /* a plot of an earlier sector has its density ratio already */
        }
        const float repeats = RHO_WINDOW_REPEATS_PER_NAT * map->denser[row] + 0.5f;
        scan->repeats[i] = (uint8_t)(repeats < 255.0f ? repeats : 255.0f);
    }
}

void rho_echoes_sum_returns(const struct rho_look *look, const struct rho_candidate *candidate,
                            struct rho_track *track)
{
    struct rho_window *window = &look->initiator->window;
    unsigned hits = 0;
    /* the newest scan's plot is counted when the map is updated */
    for (unsigned m = 0; m + 1u < window->num_scans; m++) {
        if (!((unsigned)candidate->mask >> m & 1u)) {
            continue;
        }
        const uint8_t repeats = rho_window_scan_at(window, m)->repeats[candidate->plot[m]];
        if (hits > 0 && repeats > 0) {
            track->returns[rho_clutter_map_hit_class(hits)] +=
                1.0f - rho_exp((float)repeats / -RHO_WINDOW_REPEATS_PER_NAT);
        }
        hits++;
    }
}

static int is_in_set(const uint32_t *set, uint32_t row)
{
    return (set[row / 32] >> row % 32 & 1u) != 0;
}

/*
 * True where a track is as fast as v_min, or, where targets may stand, has ever left its start; and
 * where an operator started it.
 */
static int moves_as_target(const struct rho_tracker *tracker, const struct rho_track *track)
{
    const float *state = track->kalman.state;
    const float v_min2 = rho_square(tracker->config.v_min_mps);
    return track->is_operators ||
           (v_min2 > 0.0f ? track->was_confirmed && track->hits >= TARGET_TRACK_HITS &&
                                rho_square(state[RHO_VX]) + rho_square(state[RHO_VY]) >= v_min2
                          : track->has_moved);
}

/*
 * Updates each echo with the plot that it explains best, which is `taken`; with none of a target
 * where targets may stand still. An echo faster than v_min is dropped.
 */
static void update_echoes(struct rho_tracker *tracker, const struct rho_look *look,
                          const uint32_t *targets, uint32_t *taken)
{
    struct rho_clutter_map *map = &tracker->clutter_map;
    const float v_min2 = map->v_min_mps * map->v_min_mps;
    for (unsigned place = 0; place < RHO_ECHO_PLACES; place++) {
        struct rho_echo *echo = &map->echoes[place];
        const int is_seen = echo->hits > 0 && echo->was_looked_at && echo->plot >= 0;
        const int by_target = is_seen && is_in_set(targets, (uint32_t)echo->plot);
        if (echo->hits > 0 && echo->was_looked_at && !echo->is_target) {
            rho_clutter_map_count_look(map, echo);
            if (is_seen && !by_target) {
                rho_clutter_map_count_return(map, echo);
            }
        }
        if (!is_seen || !(echo->weight > ECHO_WEIGHT_MIN) || (by_target && !(v_min2 > 0.0f))) {
            continue;
        }
        const struct rho_plot *plot = &look->scan->plots[echo->plot];
        if (!by_target && !echo->is_target && (look->scan->measures & RHO_MEASURES_RANGE_RATE)) {
            /* learns how often range rates are exactly those of the echo's own speed */
            const struct echo_view view = rho_clutter_map_view(look->sensor, echo->x_m, echo->y_m);
            const struct rate_ratios ratios = echo_rate_ratios(look, echo, &view, plot);
            const float exact = ratios.share * ratios.exact;
            if (map->rate_plots >= (float)LEARNED_MAX) {
                map->rate_plots *= 0.5f;
                map->exact_plots *= 0.5f;
            }
            map->rate_plots += 1.0f;
            map->exact_plots += exact / (exact + (1.0f - ratios.share) * ratios.other);
        }
        rho_clutter_map_update_echo(echo, look->sensor, plot);
        echo->is_target |= (uint8_t)by_target;
        taken[echo->plot / 32] |= 1u << echo->plot % 32;
        if (v_min2 > 0.0f && echo->hits >= 3 &&
            echo->vx_mps * echo->vx_mps + echo->vy_mps * echo->vy_mps > v_min2) {
            echo->hits = 0;
        }
    }
}

/*
 * True of a valid plot of no echo. Where targets may stand still, plots of targets' tracks become
 * none; and no plot does where what never moved may be a target.
 */
static int becomes_echo(const struct rho_look *look, const uint32_t *targets, const uint32_t *taken,
                        uint32_t row)
{
    const int may_stand = !(look->tracker->clutter_map.v_min_mps > 0.0f);
    return look->fates[row] != RHO_FATE_INVALID && !is_in_set(taken, row) &&
           !(may_stand &&
             (look->tracker->config.standing == RHO_STANDING_TARGETS || is_in_set(targets, row)));
}

void rho_echoes_update(struct rho_tracker *tracker, const struct rho_look *look)
{
    struct rho_clutter_map *map = &tracker->clutter_map;
    uint32_t targets[(RHO_MAX_PLOTS + 31) / 32] = {0}, taken[(RHO_MAX_PLOTS + 31) / 32] = {0};
    if (!map->is_looked) {
        return;
    }
    const float range_max_m = sensor_range_max(look);
    float sensors = 0.0f; /* those that are not silent share a turn */
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        const struct rho_tracker_pace *pace = &tracker->sensors[i].pace;
        const float silent_s = rho_seconds_between(pace->time_us, look->time_us);
        sensors += pace->is_heard && silent_s < (float)RHO_TRACKER_SILENT_US / 1e6f ? 1.0f : 0.0f;
    }
    const float turn_share = 1.0f / ((RHO_SECTORS ? rho_turn_num_scans(look) : 1.0f) *
                                     (sensors > 1.0f ? sensors : 1.0f));
    const float kept = rho_clutter_map_decay_factor(turn_share);
    /* the returns of a target's track leave the map once; other tracks fade and add theirs */
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        for (unsigned c = 0; c < RHO_ECHO_HIT_CLASSES; c++) {
            track->returns[c] *= kept;
        }
        if (track->plot < 0 || (uint32_t)track->plot >= look->num_gated) {
            continue;
        }
        if (moves_as_target(tracker, track)) {
            targets[track->plot / 32] |= 1u << track->plot % 32;
            if (!track->has_taken_back) {
                const float *at = track->kalman.state;
                rho_clutter_map_remove_returns(
                    map, rho_clutter_map_region_at(look->sensor, range_max_m, at[0], at[1]),
                    track->returns);
                track->has_taken_back = 1;
            }
        } else if (map->best_per_m2[track->plot] > 0.0f) {
            const struct rho_echo *echo = &map->echoes[map->best_echo[track->plot]];
            if (echo->plot == track->plot && echo->unseen == 1) {
                track->returns[rho_clutter_map_hit_class(echo->hits)] += echo->weight;
            }
        }
    }
    update_echoes(tracker, look, targets, taken);
    uint32_t num = 0;
    unsigned place = 0;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        num += becomes_echo(look, targets, taken, i) ? 1u : 0u;
    }
    rho_clutter_map_free_places(map, num, look->time_us);
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (!becomes_echo(look, targets, taken, i)) {
            continue;
        }
        while (place < RHO_ECHO_PLACES && map->echoes[place].hits > 0) {
            place++;
        }
        if (place == RHO_ECHO_PLACES) {
            map->echoes_dropped = rho_count(map->echoes_dropped, 1);
            continue;
        }
        const struct rho_plot *plot = &look->scan->plots[i];
        struct rho_echo *echo = &map->echoes[place];
        rho_clutter_map_start_echo(map, echo, look->scan->sensor_id, look->time_us, plot);
        echo->is_target = (uint8_t)is_in_set(targets, i);
        echo->region = rho_clutter_map_region_at(look->sensor, range_max_m, plot->x_m, plot->y_m);
    }
    rho_clutter_map_age_counts(map, turn_share);
}

int rho_echoes_is_sound_track(const struct rho_track *track)
{
    return rho_are_finite(track->returns, RHO_ECHO_HIT_CLASSES);
}
