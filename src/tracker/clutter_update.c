/* SPDX-License-Identifier: MIT */
/*
 * clutter_update: a step asks the clutter map how dense clutter is at each plot, and updates the
 * map with the plots.
 *
 *   look   before claims: echoes move to the scan's time, and each adds the density of its next
 *          plot at the plots near it
 *   keep   when plots are held for initiation, the density found stays with them
 *   learn  after starts: echoes take the plots that they explain best, other plots become new
 *          echoes
 *
 * Plots of targets teach the map, too, until it is known that they are targets'. So a track counts
 * how far echoes explained its plots. Once it has been seen often enough and moves as a target
 * does, that count is subtracted from the map.
 */
#include <string.h>

#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/clutter_map_cells.h"
#include "rhotrack/detail/measurement.h"
#include "step.h"

/* Hits of a track from which it is a target's, if it is not too slow. */
#define TARGET_HITS 12
/*
 * A track has moved that is so many standard deviations of both places away from where it started;
 * where one of its first plots was clutter, five may be probability.
 */
#define MOVED_SIGMAS 8.0f
/* Gate of an echo: squared distance, in variances; e^-(this / 2) of the density is left out. */
#define GATE_CHI2 18.0f
#define GATE_SIGMAS 4.2426407f
/* A sensor that was silent for longer is not there. */
#define SILENT_S 60.0f
/*
 * Variance of an echo's place, as a share of the squared range of its sensor, from which the place
 * is not known.
 */
#define UNKNOWN_SHARE 0.01f
/* Share of a plot's density from which an echo takes it. */
#define WEIGHT_MIN 0.3f
/*
 * Range rates of an echo: a share of them is that of its own speed (learned; the prior and its
 * weight in plots). Of the rest half are so to within some m/s, and half are any (blades, trees,
 * water). Sums are halved at so many plots.
 */
#define EXACT_PRIOR 0.3f
#define EXACT_PRIOR_PLOTS 10.0f
#define RATE_SIGMA_MPS 1.0f
#define RATE_SHARE 0.5f
#define RATE_PLOTS_REMEMBERED 1000.0f
/*
 * A strobe: three directions have more plots than this, and than so many times as many as others;
 * in so many eighths of the range.
 */
#define STROBE_PLOTS_MIN 8.0f
#define STROBE_TIMES_USUAL 6.0f
#define STROBE_RANGES 8.0f
#define STROBE_RANGES_LAST 7u
#define STROBE_RANGES_MIN 6u
/* Units of work: an echo and a plot near it, more of them with range rates. */
#define ECHO_UNITS 4u
#define RATE_UNITS 6u

/* ---- look ------------------------------------------------------------------------------------ */

static float range_max_of(const struct step *step)
{
    if (step->sensor) {
        return step->sensor->range_max_m;
    }
    const struct rho_extent *extent = &step->tracker->extent;
    const float width_m = rho_extent_width_m(extent, RHO_CLUTTER_SIDE_MIN_M);
    const float height_m = rho_extent_height_m(extent, RHO_CLUTTER_SIDE_MIN_M);
    return 0.5f * rho_sqrt(width_m * width_m + height_m * height_m);
}

/*
 * Likelihood of a plot's range rate for the echo, over that for clutter, which is spread over all
 * rates: where it is that of the echo's own speed, as of a reflector; and where it is not.
 */
struct rate_ratios {
    float exact, other;
};

/* Density of a normal range rate, over that of clutter, which is spread over all rates. */
static float over_all_rates(const struct step *step, float off_mps, float variance)
{
    const float share = rho_exp(-0.5f * off_mps * off_mps / variance);
    return share > 0.0f ? step->range_rates_mps * (share * rho_inverse_sqrt(RHO_TWO_PI * variance))
                        : 0.0f; /* most of them */
}

float rho_tracker_rate_ratio(const struct step *step, float off_mps, float variance)
{
    return 1.0f - RATE_SHARE +
           RATE_SHARE * over_all_rates(step, off_mps, variance + RATE_SIGMA_MPS * RATE_SIGMA_MPS);
}

static struct rate_ratios rate_ratios(const struct step *step, const struct rho_echo *echo,
                                      const struct echo_view *view, const struct rho_plot *plot)
{
    const float variance = plot->sigma_range_rate_mps * plot->sigma_range_rate_mps + echo->along[2];
    const float off_mps =
        plot->range_rate_mps - (echo->vx_mps * view->along_x + echo->vy_mps * view->along_y);
    return (struct rate_ratios){over_all_rates(step, off_mps, variance),
                                rho_tracker_rate_ratio(step, off_mps, variance)};
}

/* Learned share of the echoes' plots with the range rate of the echo's own speed. */
static float exact_share(const struct rho_clutter_map *map)
{
    return (map->exact_plots + EXACT_PRIOR * EXACT_PRIOR_PLOTS) /
           (map->rate_plots + EXACT_PRIOR_PLOTS);
}

static float rate_ratio(const struct step *step, const struct rho_echo *echo,
                        const struct echo_view *view, const struct rho_plot *plot)
{
    if (!(step->scan->measures & RHO_MEASURES_RANGE_RATE)) {
        return 1.0f;
    }
    const struct rate_ratios ratios = rate_ratios(step, echo, view, plot);
    const float share = exact_share(&step->tracker->clutter_map);
    return share * ratios.exact + (1.0f - share) * ratios.other;
}

/* An echo takes a plot: learns how often its range rate is just the echo's speed. */
static void learn_range_rate(struct step *step, const struct rho_echo *echo,
                             const struct rho_plot *plot)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    if (!(step->scan->measures & RHO_MEASURES_RANGE_RATE)) {
        return;
    }
    const struct echo_view view = rho_clutter_map_view(step->sensor, echo->x_m, echo->y_m);
    const struct rate_ratios ratios = rate_ratios(step, echo, &view, plot);
    const float share = exact_share(map);
    const float exact = share * ratios.exact;
    if (map->rate_plots >= RATE_PLOTS_REMEMBERED) {
        map->rate_plots *= 0.5f;
        map->exact_plots *= 0.5f;
    }
    map->rate_plots += 1.0f;
    map->exact_plots += exact / (exact + (1.0f - share) * ratios.other);
}

/* Density at a plot of the echo's next plot, if it comes back; 0 beyond its gate. */
static float echo_density_at(const struct step *step, const struct rho_echo *echo,
                             const struct echo_view *view, const struct rho_plot *plot)
{
    const float dx_m = plot->x_m - echo->x_m, dy_m = plot->y_m - echo->y_m;
    const float along_m = dx_m * view->along_x + dy_m * view->along_y;
    const float across_m = dy_m * view->along_x - dx_m * view->along_y;
    const float along_m2 = echo->along[0] + plot->sigma_range_m * plot->sigma_range_m;
    const float across_m2 = echo->across[0] + plot->sigma_cross_m * plot->sigma_cross_m;
    const float chi2 = along_m * along_m / along_m2 + across_m * across_m / across_m2;
    if (!(chi2 < GATE_CHI2)) {
        return 0.0f;
    }
    return rho_exp(-0.5f * chi2) * rho_inverse_sqrt(along_m2 * across_m2) / RHO_TWO_PI *
           rate_ratio(step, echo, view, plot);
}

static void add_echo_density(struct step *step, unsigned place)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    struct rho_echo *echo = &map->echoes[place];
    struct echo_view view = {0.0f, 0.0f, 0.0f};
    float probability = -1.0f; /* with the view, once there is a plot: most echoes have none near */
    const float sigma_m = step->sigma_max_m;
    const float half_m =
        GATE_SIGMAS * rho_sqrt(echo->along[0] + echo->across[0] + sigma_m * sigma_m);
    struct plots_near near = rho_tracker_plots_near(step, echo->x_m - half_m, echo->x_m + half_m,
                                                    echo->y_m - half_m, echo->y_m + half_m);
    const uint32_t units =
        ECHO_UNITS + (step->scan->measures & RHO_MEASURES_RANGE_RATE ? RATE_UNITS : 0u);
    uint32_t passed = 0;
    for (uint32_t i; rho_tracker_next_plot_near(step, &near, &i); passed++) {
        const struct rho_plot *plot = &step->scan->plots[i];
        const float dx_m = plot->x_m - echo->x_m, dy_m = plot->y_m - echo->y_m;
        if (dx_m > half_m || dx_m < -half_m || dy_m > half_m || dy_m < -half_m ||
            step->report->fates[i] != RHO_FATE_HELD) {
            continue;
        }
        if (probability < 0.0f) {
            view = rho_clutter_map_view(step->sensor, echo->x_m, echo->y_m);
            probability =
                rho_clutter_map_return_probability(map, echo->region, echo->hits, echo->unseen);
        }
        rho_tracker_spend(step, units);
        const float density = probability * echo_density_at(step, echo, &view, plot);
        if (!(density > 0.0f)) {
            continue;
        }
        map->denser[i] += density;
        if (density > map->best_per_m2[i]) {
            map->best_per_m2[i] = density;
            map->best_echo[i] = (uint16_t)place;
        }
    }
    rho_tracker_spend(step, passed / RHO_WORK_PASSED_A_UNIT);
}

/* 1 where the scan may see the echo. Its scratch of the scan is cleared. */
static int is_echo_in_scan(const struct step *step, struct rho_echo *echo)
{
    const struct rho_scan *scan = step->scan;
    echo->was_looked_at = 0;
    echo->plot = -1;
    echo->weight = 0.0f;
    return echo->hits > 0 && echo->sensor_id == scan->sensor_id &&
           rho_measurement_covers(step->sensor, scan->sector_from_rad, scan->sector_to_rad,
                                  echo->x_m, echo->y_m);
}

/* Predicts the echo to the scan's time; 0 where it is lost. */
static int predict_echo(struct step *step, struct rho_echo *echo, float range_max_m)
{
    echo->was_looked_at = 1;
    echo->unseen = (uint8_t)(echo->unseen < UINT8_MAX ? echo->unseen + 1 : UINT8_MAX);
    if (rho_clutter_map_is_echo_lost(echo)) {
        echo->hits = 0;
        return 0;
    }
    if (echo->region == UINT8_MAX || echo->unseen == 1) {
        echo->region = rho_clutter_map_region(step->sensor, range_max_m, echo->x_m, echo->y_m);
    }
    rho_clutter_map_predict_echo(echo, step->time_us);
    if (!(echo->along[0] + echo->across[0] < UNKNOWN_SHARE * range_max_m * range_max_m)) {
        echo->hits = 0; /* after a long silence it may be anywhere */
        return 0;
    }
    return 1;
}

/*
 * Where work ends before all echoes are predicted, the next scan begins with the others: this scan
 * cannot have seen them.
 */
static void add_echo_densities(struct step *step, float range_max_m)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    unsigned place = map->first_echo, left_out = 0;
    rho_tracker_begin_share(step, RHO_WORK_ECHOES_SHARE);
    for (unsigned i = 0; i < RHO_ECHO_PLACES; i++, place = (place + 1u) % RHO_ECHO_PLACES) {
        if (!is_echo_in_scan(step, &map->echoes[place])) {
            continue;
        }
        if (rho_tracker_is_spent(step)) {
            map->first_echo = (uint16_t)(left_out == 0 ? place : map->first_echo);
            left_out++;
        } else if (predict_echo(step, &map->echoes[place], range_max_m)) {
            add_echo_density(step, place);
        }
    }
    step->is_partial |= left_out > 0;
    step->plots_not_tried = rho_count(step->plots_not_tried, left_out);
}

/* ---- strobes --------------------------------------------------------------------------------- */

/* Where the sensor sees a plot, which must be a valid one. */
struct direction {
    unsigned bin;
    float range_m;
};

static struct direction direction_of(const struct step *step, uint32_t row)
{
    const struct rho_plot *plot = &step->scan->plots[row];
    const struct echo_view view = rho_clutter_map_view(step->sensor, plot->x_m, plot->y_m);
    const unsigned bin = (unsigned)(rho_clutter_map_direction(&view) * (float)RHO_ECHO_STROBES);
    return (struct direction){bin < RHO_ECHO_STROBES ? bin : 0, view.range_m};
}

/* In which eighth of the sensor's range a plot is. */
static unsigned range_part(float range_m, float range_max_m)
{
    const float eighth = STROBE_RANGES * range_m / range_max_m;
    return eighth < STROBE_RANGES ? (unsigned)eighth : STROBE_RANGES_LAST;
}

/* Counts the plots by direction. Returns how many there are. */
static float count_directions(struct step *step, float range_max_m)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    float plots = 0.0f;
    memset(map->strobe_count, 0, sizeof map->strobe_count);
    memset(map->strobe_ranges, 0, sizeof map->strobe_ranges);
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] != RHO_FATE_HELD) {
            continue;
        }
        const struct direction at = direction_of(step, i);
        map->strobe_count[at.bin]++;
        map->strobe_ranges[at.bin] |= (uint8_t)(1u << range_part(at.range_m, range_max_m));
        plots += 1.0f;
    }
    return plots;
}

/* Width of the scan's sector, or of the sensor's own where that is narrower. */
static float sector_width(const struct step *step)
{
    const float scan_rad =
        rho_angle_sector_width(step->scan->sector_from_rad, step->scan->sector_to_rad);
    const float sensor_rad = step->sensor ? rho_angle_sector_width(step->sensor->sector_from_rad,
                                                                   step->sensor->sector_to_rad)
                                          : scan_rad;
    return sensor_rad < scan_rad ? sensor_rad : scan_rad;
}

/*
 * Plots a radian and metre of range that a strobe in this direction and the two beside it has; 0
 * where there is none.
 */
static float strobe_density(const struct step *step, unsigned bin, float plots, float range_max_m)
{
    const struct rho_clutter_map *map = &step->tracker->clutter_map;
    const unsigned bins[3] = {bin == 0 ? RHO_ECHO_STROBES - 1u : bin - 1u, bin,
                              bin + 1u == RHO_ECHO_STROBES ? 0 : bin + 1u};
    unsigned count = 0, ranges = 0;
    for (int k = 0; k < 3; k++) {
        count += map->strobe_count[bins[k]];
        ranges |= map->strobe_ranges[bins[k]];
    }
    if (!((float)count > STROBE_PLOTS_MIN)) {
        return 0.0f; /* most directions */
    }
    const float width_rad = 3.0f * RHO_TWO_PI / (float)RHO_ECHO_STROBES;
    const float others_rad = sector_width(step) - width_rad;
    const float usual = others_rad > 0.0f ? (plots - (float)count) * width_rad / others_rad : plots;
    return (float)count > STROBE_PLOTS_MIN + STROBE_TIMES_USUAL * usual &&
                   rho_count_bits(ranges) >= STROBE_RANGES_MIN
               ? ((float)count - usual) / (width_rad * range_max_m)
               : 0.0f;
}

/* Counts plots, and the parts of the range that have any. */
static int may_have_strobes(const struct step *step, float range_max_m)
{
    float plots = 0.0f;
    unsigned ranges = 0;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            const struct rho_plot *plot = &step->scan->plots[i];
            const struct echo_view view = rho_clutter_map_view(step->sensor, plot->x_m, plot->y_m);
            ranges |= 1u << range_part(view.range_m, range_max_m);
            plots += 1.0f;
        }
    }
    return plots > STROBE_PLOTS_MIN && rho_count_bits(ranges) >= STROBE_RANGES_MIN;
}

/* A jammer's strobe lies in one direction, at all ranges: too narrow for the density map. */
static void add_strobe_densities(struct step *step, float range_max_m)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    if (!may_have_strobes(step, range_max_m)) {
        return;
    }
    const float plots = count_directions(step, range_max_m);
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] != RHO_FATE_HELD) {
            continue;
        }
        const struct direction at = direction_of(step, i);
        float density = 0.0f;
        for (unsigned k = 0; k < 3; k++) { /* at the strobe's edge */
            const float beside = strobe_density(
                step, (at.bin + RHO_ECHO_STROBES + k - 1u) % RHO_ECHO_STROBES, plots, range_max_m);
            density = beside > density ? beside : density;
        }
        if (density > 0.0f && at.range_m > 0.0f) {
            map->denser[i] += density / at.range_m;
        }
    }
}

/* ---- clutter at each plot -------------------------------------------------------------------- */

/* For each plot: how much denser clutter is there, and the echo that explains it best. */
static void compare_with_echoes(struct step *step)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (!(map->denser[i] > 0.0f)) {
            continue;
        }
        const struct rho_plot *plot = &step->scan->plots[i];
        const float density = rho_tracker_density_at_plot(step, plot);
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

void rho_tracker_look_at_clutter(struct step *step)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    map->is_looked = !step->is_late;
    if (step->is_late) {
        return;
    }
    map->time_us = step->time_us;
    memset(map->denser, 0, step->num_gated * sizeof map->denser[0]);
    memset(map->best_per_m2, 0, step->num_gated * sizeof map->best_per_m2[0]);
    const float range_max_m = range_max_of(step);
    add_echo_densities(step, range_max_m);
    add_strobe_densities(step, range_max_m);
    compare_with_echoes(step);
}

float rho_tracker_repeats_nat(const struct step *step, uint32_t row)
{
    const struct rho_clutter_map *map = &step->tracker->clutter_map;
    return map->is_looked && step->first_row == 0 ? map->denser[row] : 0.0f;
}

/* ---- keep ------------------------------------------------------------------------------------ */

void rho_tracker_keep_repeats(struct step *step)
{
    struct rho_window *window = &step->initiator->window;
    const struct rho_clutter_map *map = &step->tracker->clutter_map;
    struct rho_window_scan *scan = rho_window_scan_at(window, window->num_scans - 1u);
    for (unsigned i = 0; i < scan->num_plots && map->is_looked; i++) {
        const unsigned row = scan->marks[i] & RHO_WINDOW_ROW;
        if (row >= step->num_gated ||
            (RHO_SECTORS && rho_tracker_is_of_earlier_sector(window, scan, i))) {
            continue; /* an earlier sector has given it its own */
        }
        const float repeats = RHO_WINDOW_REPEATS_PER_NAT * map->denser[row] + 0.5f;
        scan->repeats[i] = (uint8_t)(repeats < 255.0f ? repeats : 255.0f);
    }
}

/* ---- plots of targets ------------------------------------------------------------------------ */

void rho_tracker_note_start_echoes(struct step *step, const struct rho_candidate *candidate,
                                   struct rho_track *track)
{
    struct rho_window *window = &step->initiator->window;
    unsigned hits = 0;
    for (unsigned m = 0; m + 1u < window->num_scans; m++) { /* the newest plot: as the map learns */
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

void rho_tracker_note_start_place(struct rho_track *track)
{
    track->start_m[0] = track->kalman.state[0];
    track->start_m[1] = track->kalman.state[1];
    track->start_sigma_m = rho_track_sigma_m(track);
}

static int has_left_its_start(const struct rho_track *track)
{
    const float dx_m = track->kalman.state[0] - track->start_m[0];
    const float dy_m = track->kalman.state[1] - track->start_m[1];
    const float far_m = MOVED_SIGMAS * (rho_track_sigma_m(track) + track->start_sigma_m);
    return dx_m * dx_m + dy_m * dy_m > far_m * far_m;
}

/*
 * Its plots are a target's: it moves as one; or, where targets may stand still, it has moved once.
 */
static int is_target(const struct step *step, struct rho_track *track)
{
    const float *velocity_mps = &track->kalman.state[3];
    const float v_min_mps = step->tracker->config.v_min_mps;
    if (!track->was_confirmed || track->hits < TARGET_HITS) {
        return 0;
    }
    track->has_moved = track->has_moved || has_left_its_start(track);
    return v_min_mps > 0.0f
               ? velocity_mps[0] * velocity_mps[0] + velocity_mps[1] * velocity_mps[1] >=
                     v_min_mps * v_min_mps
               : track->has_moved != 0;
}

static void take_back_returns(struct step *step, struct rho_track *track)
{
    if (track->has_taken_back) {
        return;
    }
    rho_clutter_map_remove_returns(&step->tracker->clutter_map,
                                   rho_clutter_map_region(step->sensor, range_max_of(step),
                                                          track->kalman.state[0],
                                                          track->kalman.state[1]),
                                   track->returns);
    track->has_taken_back = 1;
}

/* ---- learn ----------------------------------------------------------------------------------- */

static int is_plot_of_target(const uint32_t *targets, uint32_t row)
{
    return (targets[row / 32] >> row % 32 & 1u) != 0;
}

/* Notes in the track the return that the echo counts for its plot. */
static void note_echo_return(const struct rho_clutter_map *map, struct rho_track *track)
{
    if (map->best_per_m2[track->plot] > 0.0f) {
        const struct rho_echo *echo = &map->echoes[map->best_echo[track->plot]];
        if (echo->plot == track->plot && echo->unseen == 1) {
            track->returns[rho_clutter_map_hit_class(echo->hits)] += echo->weight;
        }
    }
}

/* Rows of the plots that targets have. */
static void find_target_plots(struct step *step, uint32_t *targets, float share)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        for (unsigned c = 0; c < RHO_ECHO_HIT_CLASSES; c++) {
            track->returns[c] *= rho_clutter_map_remaining(share); /* as the map forgets */
        }
        if (track->plot < 0 || (uint32_t)track->plot >= step->num_gated) {
            continue;
        }
        if (is_target(step, track)) {
            take_back_returns(step, track);
            targets[track->plot / 32] |= 1u << track->plot % 32;
        } else {
            note_echo_return(&tracker->clutter_map, track);
        }
    }
}

/*
 * Echoes take the plots that they explain best. Where targets may stand still, an echo takes no
 * plot of a target.
 */
static void update_echoes(struct step *step, const uint32_t *targets, uint32_t *taken)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    const float v_min2 = map->v_min_mps * map->v_min_mps;
    for (unsigned place = 0; place < RHO_ECHO_PLACES; place++) {
        struct rho_echo *echo = &map->echoes[place];
        const int is_seen = echo->hits > 0 && echo->was_looked_at && echo->plot >= 0;
        const int by_target = is_seen && is_plot_of_target(targets, (uint32_t)echo->plot);
        if (echo->hits > 0 && echo->was_looked_at && !echo->is_target) {
            rho_clutter_map_count_look(map, echo);
            if (is_seen && !by_target) {
                rho_clutter_map_count_return(map, echo);
            }
        }
        if (is_seen && echo->weight > WEIGHT_MIN && !(by_target && !(v_min2 > 0.0f))) {
            if (!by_target && !echo->is_target) {
                learn_range_rate(step, echo, &step->scan->plots[echo->plot]);
            }
            rho_clutter_map_update_echo(echo, step->sensor, &step->scan->plots[echo->plot]);
            echo->is_target |= (uint8_t)by_target;
            taken[echo->plot / 32] |= 1u << echo->plot % 32;
            if (v_min2 > 0.0f && echo->hits >= 3 &&
                echo->vx_mps * echo->vx_mps + echo->vy_mps * echo->vy_mps > v_min2) {
                echo->hits = 0;
            }
        }
    }
}

/* A plot that no echo explains and, where targets may stand still, no target has. */
static int becomes_echo(const struct step *step, const uint32_t *targets, const uint32_t *taken,
                        uint32_t row)
{
    const int may_stand = !(step->tracker->clutter_map.v_min_mps > 0.0f);
    return step->report->fates[row] != RHO_FATE_INVALID && !is_plot_of_target(taken, row) &&
           !(may_stand && is_plot_of_target(targets, row));
}

static void add_echoes(struct step *step, const uint32_t *targets, const uint32_t *taken)
{
    struct rho_clutter_map *map = &step->tracker->clutter_map;
    const float range_max_m = range_max_of(step);
    uint32_t num = 0;
    unsigned place = 0;
    for (uint32_t i = 0; i < step->num_gated; i++) {
        num += becomes_echo(step, targets, taken, i) ? 1u : 0u;
    }
    rho_clutter_map_make_room(map, num, step->time_us);
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (!becomes_echo(step, targets, taken, i)) {
            continue;
        }
        while (place < RHO_ECHO_PLACES && map->echoes[place].hits > 0) {
            place++;
        }
        if (place == RHO_ECHO_PLACES) {
            map->echoes_dropped = rho_count(map->echoes_dropped, 1);
            continue;
        }
        const struct rho_plot *plot = &step->scan->plots[i];
        struct rho_echo *echo = &map->echoes[place];
        rho_clutter_map_start_echo(map, echo, step->scan->sensor_id, step->time_us, plot);
        echo->is_target = (uint8_t)is_plot_of_target(targets, i);
        echo->region = rho_clutter_map_region(step->sensor, range_max_m, plot->x_m, plot->y_m);
    }
}

/* Share of one turn of all sensors that this scan is. */
static float share_of_turn(const struct step *step)
{
    const struct rho_tracker *tracker = step->tracker;
    float sensors = 0.0f;
    for (unsigned i = 0; i < tracker->num_paces; i++) {
        const float silent_s = rho_seconds_between(tracker->paces[i].time_us, step->time_us);
        sensors += silent_s < SILENT_S ? 1.0f : 0.0f;
    }
    return 1.0f / ((RHO_SECTORS ? rho_tracker_scans_a_turn(step) : 1.0f) *
                   (sensors > 1.0f ? sensors : 1.0f));
}

void rho_tracker_learn_clutter(struct step *step)
{
    uint32_t targets[(RHO_MAX_PLOTS + 31) / 32] = {0}, taken[(RHO_MAX_PLOTS + 31) / 32] = {0};
    if (!step->tracker->clutter_map.is_looked) {
        return;
    }
    const float share = share_of_turn(step);
    find_target_plots(step, targets, share);
    update_echoes(step, targets, taken);
    add_echoes(step, targets, taken);
    rho_clutter_map_age(&step->tracker->clutter_map, share);
}

/* ---- the object ------------------------------------------------------------------------------ */

void rho_tracker_open_clutter_map(struct rho_tracker *tracker)
{
    rho_clutter_map_init(&tracker->clutter_map, tracker->config.v_min_mps);
}

int rho_tracker_has_moved(const struct rho_track *track)
{
    return track->has_taken_back;
}

int rho_tracker_has_sound_clutter_map(const struct rho_tracker *tracker)
{
    return rho_clutter_map_is_sound(&tracker->clutter_map);
}

int rho_tracker_has_sound_returns(const struct rho_track *track)
{
    return rho_are_finite(track->returns, RHO_ECHO_HIT_CLASSES) &&
           rho_are_finite(track->start_m, 2) && rho_are_finite(&track->start_sigma_m, 1);
}
