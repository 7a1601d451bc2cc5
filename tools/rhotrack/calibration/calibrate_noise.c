/* SPDX-License-Identifier: MIT */
#include "calibration/calibrate_noise.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "calibration/calibrate_segments.h"

#define ROUNDS_MAX 8
/* noise that changes by a smaller share between rounds has converged */
#define CONVERGED_SHARE 0.02
#define TRY_BETTER 1.5

/* number of parts of the data, each left out once to find the sigma of a figure (jackknife) */
#define PARTS 10
#define SEGMENTS_MIN 4
#define LOOKS_MIN 50
#define TURNS_MIN 6
#define MOVING_SIGMAS 4.0

/* The square of a standard normal variable, cut at CUT^2 = 4, has this mean. */
#define CUT 2.0
#define CUT_MEAN 0.9205

/* ---- jackknife ---- */

struct jackknife_figures {
    double without[PARTS]; /* the figure estimated without each of the PARTS */
};

/* Standard error of the figure by the jackknife. */
static double jackknife_sigma(const struct jackknife_figures *jackknife_figures)
{
    double mean = 0.0, sum = 0.0;

    for (int i = 0; i < PARTS; i++) {
        mean += jackknife_figures->without[i] / PARTS;
    }
    for (int i = 0; i < PARTS; i++) {
        sum += (jackknife_figures->without[i] - mean) * (jackknife_figures->without[i] - mean);
    }
    return sqrt(sum * (PARTS - 1) / PARTS);
}

/* Median of the values, which are sorted in place. */
static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

/* ---- noise ---- */

/* Magnitude of a residual: metres, or radians across the line of sight of a polar plot. */
static double absolute_residual_m_or_rad(const struct residual *residual, bool is_isotropic)
{
    return fabs(residual->axis == 1 && !is_isotropic ? residual->off_m / residual->range_m
                                                     : residual->off_m);
}

static bool is_residual_counted(const struct residual *residual, int axis, bool is_isotropic,
                                int left_out_part)
{
    return (is_isotropic || residual->axis == axis) &&
           (int)(residual->segment % PARTS) != left_out_part;
}

/*
 * Finds by bisection the sigma for which the residuals' normalised squares, cut at CUT^2, have the
 * mean CUT_MEAN. Residuals of one part are left out; part -1: none is.
 */
static double noise_without_part(const struct calibrate_segments *segments, int axis,
                                 bool is_isotropic, int part)
{
    double least = 1e-9, most = 1e7;

    for (int i = 0; i < 60; i++) {
        const double sigma = sqrt(least * most);
        double sum = 0.0, count = 0.0;

        for (size_t k = 0; k < segments->num_residuals; k++) {
            if (is_residual_counted(&segments->residuals[k], axis, is_isotropic, part)) {
                const double sigmas =
                    absolute_residual_m_or_rad(&segments->residuals[k], is_isotropic) / sigma;

                sum += sigmas < CUT ? sigmas * sigmas : CUT * CUT;
                count += 1.0;
            }
        }
        if (sum > CUT_MEAN * count) {
            least = sigma;
        } else {
            most = sigma;
        }
    }
    return sqrt(least * most);
}

static struct calibrate_figure noise_with_jackknife_sigma(const struct calibrate_segments *segments,
                                                          int axis, bool is_isotropic)
{
    struct calibrate_figure figure = {.is_known = segments->num_segments >= SEGMENTS_MIN};
    struct jackknife_figures jackknife_figures;

    if (figure.is_known) {
        for (int i = 0; i < PARTS; i++) {
            jackknife_figures.without[i] = noise_without_part(segments, axis, is_isotropic, i);
        }
        figure.value = noise_without_part(segments, axis, is_isotropic, -1);
        figure.sigma = jackknife_sigma(&jackknife_figures);
    }
    return figure;
}

static void set_plot_sigmas(struct radar_data *radar, bool is_isotropic, double along_m,
                            double across)
{
    for (size_t i = 0; i < radar->num_plots; i++) {
        struct radar_plot *plot = &radar->plots[i];
        const double across_m = is_isotropic ? along_m : across * plot->range_m;

        plot->sigma_range_m = fmax(along_m, (double)RHO_LIMIT_SIGMA_MIN);
        plot->sigma_cross_m = fmax(across_m, (double)RHO_LIMIT_SIGMA_MIN);
        plot->plot.sigma_range_m = (float)plot->sigma_range_m;
        plot->plot.sigma_cross_m = (float)plot->sigma_cross_m;
        plot->plot.sigma_up_m = is_isotropic ? plot->plot.sigma_range_m : plot->plot.sigma_up_m;
    }
}

static void scale_plot_sigmas(struct radar_data *radar, double factor)
{
    for (size_t i = 0; i < radar->num_plots; i++) {
        struct radar_plot *plot = &radar->plots[i];

        plot->sigma_range_m *= factor;
        plot->sigma_cross_m *= factor;
        plot->plot.sigma_range_m = (float)plot->sigma_range_m;
        plot->plot.sigma_cross_m = (float)plot->sigma_cross_m;
        plot->plot.sigma_up_m = (float)(factor * (double)plot->plot.sigma_up_m);
    }
}

/* ---- rounds ---- */

/* Frees the tracks of all radars. */
static void remove_all_tracks(struct register_data *data)
{
    for (size_t i = 0; i < data->num_tracks; i++) {
        free(data->tracks[i].plots);
    }
    data->num_tracks = 0;
}

static struct calibrate_segments track_and_cut_segments(struct register_data *data, size_t radar,
                                                        bool is_isotropic,
                                                        struct pipeline *pipeline)
{
    remove_all_tracks(data);
    register_track_one_radar(data, radar, pipeline);
    return calibrate_cut_segments(data, radar, is_isotropic);
}

/* Score of a noise factor: fitted segments minus segments that fit no parabola. */
static double fitted_minus_unfitted_segments(const struct calibrate_segments *segments)
{
    return (double)segments->num_segments - (double)segments->num_unfitted;
}

/*
 * Tracks a radar with its stated sigmas multiplied by 1 and by each of the factors, keeps in its
 * plots the factor that gives most segments, and returns these: with sigmas far from the true noise
 * the tracker finds no tracks.
 */
static struct calibrate_segments track_with_best_sigma(struct register_data *data,
                                                       size_t radar_number, bool is_isotropic,
                                                       struct pipeline *pipeline)
{
    static const double factors[] = {4.0, 16.0, 0.25};
    struct radar_data *radar = &data->radars[radar_number];
    struct calibrate_segments best =
        track_and_cut_segments(data, radar_number, is_isotropic, pipeline);
    double factor = 1.0;

    for (size_t i = 0; i < sizeof factors / sizeof *factors; i++) {
        const double tried = factors[i];
        struct calibrate_segments segments;

        scale_plot_sigmas(radar, tried / factor);
        segments = track_and_cut_segments(data, radar_number, is_isotropic, pipeline);
        if (fitted_minus_unfitted_segments(&segments) >
            TRY_BETTER * fmax(fitted_minus_unfitted_segments(&best), 1.0)) {
            calibrate_segments_free(&best);
            best = segments;
            factor = tried;
        } else {
            calibrate_segments_free(&segments);
            scale_plot_sigmas(radar, factor / tried);
        }
    }
    calibrate_segments_free(&best);
    return track_and_cut_segments(data, radar_number, is_isotropic, pipeline);
}

static bool has_noise_converged(const struct calibrate_figure *before,
                                const struct calibrate_figure *now)
{
    return before->is_known && fabs(now->value / before->value - 1.0) < CONVERGED_SHARE;
}

/* Whether enough segments fit a parabola: where most do not, the others fit by chance. */
static bool are_enough_segments(const struct calibrate_segments *segments)
{
    return segments->num_segments >= SEGMENTS_MIN &&
           segments->num_segments > segments->num_unfitted;
}

/*
 * Sets the values of the noise, still unknown, to the means of the stated ones. Plots nearer than
 * RHO_RANGE_LEAST_M do not count: at the sensor their noise across is no azimuth's.
 */
static void take_stated_noise(const struct radar_data *radar, struct calibrate_radar *out)
{
    double range_m = 0.0, azimuth_rad = 0.0, count = 0.0;

    for (size_t i = 0; i < radar->num_plots; i++) {
        const struct radar_plot *plot = &radar->plots[i];

        if (plot->range_m >= (double)RHO_RANGE_LEAST_M) {
            range_m += plot->sigma_range_m;
            azimuth_rad += plot->sigma_cross_m / plot->range_m;
            count += 1.0;
        }
    }
    if (count > 0.0) {
        out->figures[CALIBRATE_RANGE] =
            (struct calibrate_figure){.value = range_m / count, .is_stated = true};
        out->figures[CALIBRATE_AZIMUTH] =
            (struct calibrate_figure){.value = azimuth_rad / count, .is_stated = true};
    }
}

/*
 * Estimates the noise along and across the line of sight: tracks are found again with each estimate
 * until it converges. Returns the segments of the last tracks.
 */
static struct calibrate_segments estimate_noise(struct register_data *data, size_t radar_number,
                                                struct calibrate_radar *out,
                                                struct pipeline *pipeline)
{
    struct calibrate_figure *noise = out->figures;
    struct calibrate_segments segments;

    if (out->has_bodies) {
        take_stated_noise(&data->radars[radar_number], out);
        return track_and_cut_segments(data, radar_number, out->is_isotropic, pipeline);
    }
    segments = track_with_best_sigma(data, radar_number, out->is_isotropic, pipeline);
    for (int round = 0; round < ROUNDS_MAX && segments.num_segments >= SEGMENTS_MIN; round++) {
        const struct calibrate_figure before[2] = {noise[0], noise[1]};

        noise[0] = noise_with_jackknife_sigma(&segments, 0, out->is_isotropic);
        noise[1] = noise_with_jackknife_sigma(&segments, 1, false);
        noise[1].is_known = noise[1].is_known && !out->is_isotropic;
        if (has_noise_converged(&before[0], &noise[0]) &&
            (out->is_isotropic || has_noise_converged(&before[1], &noise[1]))) {
            break;
        }
        set_plot_sigmas(&data->radars[radar_number], out->is_isotropic, noise[0].value,
                        noise[1].value);
        calibrate_segments_free(&segments);
        segments = track_and_cut_segments(data, radar_number, out->is_isotropic, pipeline);
    }
    if (!are_enough_segments(&segments)) {
        noise[0] = noise[1] = (struct calibrate_figure){.is_known = false};
    }
    return segments;
}

/* ---- turns, clutter ---- */

struct turns {
    size_t count;
    double *end_s, *plots;
};

static struct turns group_scans_into_turns(const struct register_data *data,
                                           const struct radar_data *radar)
{
    struct turns turns = {.end_s = must_calloc(radar->num_scans + 1, sizeof(double)),
                          .plots = must_calloc(radar->num_scans + 1, sizeof(double))};

    for (size_t first = 0, end; first < radar->num_scans; first = end) {
        end = register_find_scan_after_turn(radar, first);
        for (size_t i = first; i < end; i++) {
            turns.plots[turns.count] += (double)radar->scans[i].count;
        }
        turns.end_s[turns.count++] =
            (double)(radar->scans[end - 1].time_us - data->start_us) * 1e-6;
    }
    return turns;
}

static struct calibrate_figure estimate_turn_time(const struct turns *turns)
{
    struct calibrate_figure figure = {.is_known = turns->count > TURNS_MIN};
    const size_t count = turns->count > 0 ? turns->count - 1 : 0;
    double *gaps_s = must_calloc(count + 1, sizeof *gaps_s);

    if (figure.is_known) {
        for (size_t i = 0; i < count; i++) {
            gaps_s[i] = turns->end_s[i + 1] - turns->end_s[i];
        }
        figure.value = median(gaps_s, count);
        figure.is_known = figure.value > 0.0;
        for (size_t i = 0; i < count; i++) {
            gaps_s[i] = fabs(gaps_s[i] - figure.value);
        }
        /*
         * standard error of a median: 1.25 sigma / sqrt(n), sigma from the median absolute
         * deviation
         */
        figure.sigma = 1.25 * 1.4826 * median(gaps_s, count) / sqrt((double)count);
    }
    free(gaps_s);
    return figure;
}

static bool has_bodies(const struct register_data *data)
{
    return data->parameters->value[PARAMETER_BODY_MAX_M] > 0.0;
}

/* Plots of confirmed tracks; of bodies all plots that tracks claim, as a track has one a scan. */
static double count_tracked_plots(const struct register_data *data, size_t radar_number)
{
    double tracked = 0.0;

    if (has_bodies(data)) {
        return (double)data->radars[radar_number].claimed;
    }
    for (size_t i = 0; i < data->num_tracks; i++) {
        if (data->tracks[i].radar == radar_number) {
            tracked += (double)(data->tracks[i].count + data->tracks[i].earlier);
        }
    }
    return tracked;
}

static struct calibrate_figure estimate_clutter(const struct register_data *data,
                                                size_t radar_number, const struct turns *turns)
{
    const double count = (double)turns->count;
    struct calibrate_figure figure = {.is_known = turns->count >= TURNS_MIN};
    const double tracked = count_tracked_plots(data, radar_number);
    double mean = 0.0, square = 0.0;

    for (size_t i = 0; i < turns->count; i++) {
        mean += turns->plots[i] / count;
        square += turns->plots[i] * turns->plots[i] / count;
    }
    figure.value = figure.is_known ? fmax(mean - tracked / count, 0.0) : 0.0;
    figure.sigma = figure.is_known ? sqrt(fmax(square - mean * mean, 0.0) / count) : 0.0;
    return figure;
}

/*
 * Area over which clutter is spread: the circle that holds 99.5 % of a polar radar's plots, or the
 * bounding box of plots without a range.
 */
static double covered_area_km2(const struct radar_data *radar, bool is_isotropic)
{
    double *range_m = must_calloc(radar->num_plots + 1, sizeof *range_m), area_m2 = 0.0;
    double x[2] = {1e9, -1e9}, y[2] = {1e9, -1e9};

    for (size_t i = 0; i < radar->num_plots; i++) {
        const struct rho_plot *plot = &radar->plots[i].plot;

        range_m[i] = radar->plots[i].range_m;
        x[0] = fmin(x[0], (double)plot->x_m);
        x[1] = fmax(x[1], (double)plot->x_m);
        y[0] = fmin(y[0], (double)plot->y_m);
        y[1] = fmax(y[1], (double)plot->y_m);
    }
    if (radar->num_plots > 0) {
        qsort(range_m, radar->num_plots, sizeof *range_m, compare_doubles);
        area_m2 = is_isotropic
                      ? (x[1] - x[0]) * (y[1] - y[0])
                      : M_PI * pow(range_m[radar->num_plots - 1 - radar->num_plots / 200], 2);
    }
    free(range_m);
    return area_m2 * 1e-6;
}

/* ---- pd ---- */

/*
 * The share of looks with a plot, as the tracker has counted it of its last tracks. One hit and one
 * miss are added, as a share of 1 would end tracks at their first miss.
 */
static struct calibrate_figure pd_by_counted_looks(const struct rho_tracker_sensor *row)
{
    const double looks = (double)row->looks, hits = (double)row->hits;
    struct calibrate_figure figure = {.is_known = false};

    if (looks >= LOOKS_MIN) {
        const double pd = (hits + 1.0) / (looks + 2.0);

        figure = (struct calibrate_figure){
            .is_known = true, .value = pd, .sigma = sqrt((pd * (1.0 - pd) + 0.01) / looks)};
    }
    return figure;
}

/* ---- speeds ---- */

/*
 * Median speed, with its error, of the track whose segments begin at *next, and moves *next to the
 * following track. False, not reliable, where the track has fewer than two segments.
 */
static bool next_track_median_speed(const struct calibrate_segments *segments, size_t *next,
                                    struct calibrate_figure *speed)
{
    const size_t first = *next;
    double *speeds, square = 0.0;
    size_t count = 0;

    while (*next < segments->num_segments &&
           segments->segments[*next].track == segments->segments[first].track) {
        ++*next;
    }
    count = *next - first;
    speeds = must_calloc(count, sizeof *speeds);
    for (size_t i = 0; i < count; i++) {
        const struct calibrate_segment *segment = &segments->segments[first + i];

        speeds[i] = segment->speed_mps;
        square += segment->speed_sigma_mps * segment->speed_sigma_mps / (double)count;
    }
    *speed = (struct calibrate_figure){.is_known = true,
                                       .value = median(speeds, count),
                                       .sigma = 1.25 * sqrt(square / (double)count)};
    free(speeds);
    return count >= 2;
}

/*
 * Finds the fastest and the slowest track among those whose speed is at least MOVING_SIGMAS sigma.
 */
static void find_speed_extremes(const struct calibrate_segments *segments,
                                struct calibrate_figure *fastest, struct calibrate_figure *slowest)
{
    struct calibrate_figure speed;

    for (size_t next = 0; next < segments->num_segments;) {
        if (!next_track_median_speed(segments, &next, &speed) ||
            speed.value < MOVING_SIGMAS * speed.sigma) {
            continue;
        }
        *fastest = !fastest->is_known || speed.value > fastest->value ? speed : *fastest;
        *slowest = !slowest->is_known || speed.value < slowest->value ? speed : *slowest;
    }
}

/* ---- a radar ---- */

/* Whether all plots have equal sigmas along and across: Cartesian plots, without a range. */
static bool has_isotropic_plots(const struct radar_data *radar)
{
    for (size_t i = 0; i < radar->num_plots; i++) {
        if (radar->plots[i].sigma_range_m != radar->plots[i].sigma_cross_m) {
            return false;
        }
    }
    return true;
}

/*
 * Puts the stated sigmas back into the plots, and computes the mean normalised innovation squared
 * with them.
 */
static void find_innovations(struct register_data *data, size_t radar_number,
                             struct calibrate_radar *out, const double *stated)
{
    struct radar_data *radar = &data->radars[radar_number];
    double sum;

    for (size_t i = 0; i < radar->num_plots; i++) {
        radar->plots[i].sigma_range_m = stated[2 * i];
        radar->plots[i].sigma_cross_m = stated[2 * i + 1];
    }
    sum = calibrate_sum_innovations(data, radar_number, out->is_isotropic, &out->num_innovations);
    out->innovations = out->num_innovations ? sum / CUT_MEAN / (double)out->num_innovations : NAN;
}

static void estimate_radar(struct register_data *data, size_t radar_number,
                           struct pipeline *pipeline, struct calibrate_radar *out)
{
    struct radar_data *radar = &data->radars[radar_number];
    double *stated = must_calloc(2 * radar->num_plots + 1, sizeof *stated);
    struct calibrate_segments segments;
    struct turns turns;

    for (size_t i = 0; i < radar->num_plots; i++) {
        stated[2 * i] = radar->plots[i].sigma_range_m;
        stated[2 * i + 1] = radar->plots[i].sigma_cross_m;
    }
    *out = (struct calibrate_radar){.sensor_id = radar->sensor.sensor_id,
                                    .has_bodies = has_bodies(data),
                                    .is_isotropic = has_isotropic_plots(radar),
                                    .innovations = NAN,
                                    .scans = radar->num_scans,
                                    .plots = radar->num_plots};
    segments = estimate_noise(data, radar_number, out, pipeline);
    turns = group_scans_into_turns(data, radar);
    out->turns = turns.count;
    out->tracks = data->num_tracks;
    out->segments = segments.num_segments;
    out->segments_left_out = segments.num_unfitted;
    out->area_km2 = covered_area_km2(radar, out->is_isotropic);
    out->figures[CALIBRATE_TURN] = estimate_turn_time(&turns);
    out->figures[CALIBRATE_CLUTTER] = estimate_clutter(data, radar_number, &turns);
    out->figures[CALIBRATE_PD] = pd_by_counted_looks(&pipeline->node->tracker.sensors[0]);
    find_speed_extremes(&segments, &out->figures[CALIBRATE_FASTEST],
                        &out->figures[CALIBRATE_SLOWEST]);
    if (!out->has_bodies) {
        find_innovations(data, radar_number, out, stated);
    }
    calibrate_segments_free(&segments);
    free(turns.end_s);
    free(turns.plots);
    free(stated);
}

struct calibrate_result calibrate(struct register_data *data, struct pipeline *pipeline)
{
    struct calibrate_result result = {.num_radars = data->num_radars};

    result.radars = must_calloc(data->num_radars + 1, sizeof *result.radars);
    for (size_t i = 0; i < data->num_radars; i++) {
        estimate_radar(data, i, pipeline, &result.radars[i]);
    }
    return result;
}

void calibrate_result_free(struct calibrate_result *result)
{
    free(result->radars);
}
