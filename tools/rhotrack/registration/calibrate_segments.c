/* SPDX-License-Identifier: MIT */
#include "registration/calibrate_segments.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "registration/cholesky.h"

#define SEGMENT_PLOTS 10
#define SEGMENT_S 300.0 /* no longer: a path is no parabola for ever */
#define LEAD_PLOTS 4    /* that lead on to the next one */
#define POWERS_MAX 3    /* coefficients of an axis */
#define MAX_UNKNOWN ((size_t)2 * POWERS_MAX)
#define CUT2 4.0
#define LEVERAGE_MAX 0.9
#define CORRELATION_MAX                                                                            \
    0.15 /* of a plot with the next one; of white noise beside a parabola -0.2 */

/* Polynomials of x and of y, fitted to plots. */
struct path {
    size_t powers; /* of the time from middle_s on */
    double middle_s;
    double factor[MAX_UNKNOWN * MAX_UNKNOWN];
    double solution[MAX_UNKNOWN];
};

/* A place along a direction, as the path has it. */
static void design_row(const struct path *path, double t_s, double x, double y, double *row)
{
    double power = 1.0;

    for (size_t i = 0; i < path->powers; i++) {
        row[i] = x * power;
        row[path->powers + i] = y * power;
        power *= t_s - path->middle_s;
    }
}

static double dot(const double *a, const double *b, size_t n)
{
    double sum = 0.0;

    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Of what the row says, by the plots' sigmas. */
static double path_variance(const struct path *path, const double *row)
{
    double half[MAX_UNKNOWN];

    memcpy(half, row, sizeof half);
    cholesky_solve_lower(path->factor, 2 * path->powers, half);
    return dot(half, half, 2 * path->powers);
}

/* The axes of a plot's noise. */
struct axes {
    double x[2], y[2], sigma_m[2];
};

static struct axes noise_axes(const struct radar_plot *plot, bool is_round)
{
    double c = is_round ? 1.0 : cos(plot->azimuth_rad), s = is_round ? 0.0 : sin(plot->azimuth_rad);

    return (struct axes){
        .x = {c, -s}, .y = {s, c}, .sigma_m = {plot->sigma_range_m, plot->sigma_cross_m}};
}

static double plot_seconds(const struct register_data *data, const struct radar_plot *plot)
{
    return (double)(plot->time_us - data->start_us) * 1e-6;
}

static double plot_place_along(const struct radar_plot *plot, const struct axes *axes, int axis)
{
    return axes->x[axis] * (double)plot->plot.x_m + axes->y[axis] * (double)plot->plot.y_m;
}

/* Through `count` plots of a track. False where they tell no such path. */
static bool fit_path(const struct register_data *data, const struct radar_track *track,
                     size_t first, size_t count, bool is_round, struct path *path)
{
    const struct radar_plot *plots = data->radars[track->radar].plots;
    const size_t n = 2 * path->powers;

    memset(path->factor, 0, sizeof path->factor);
    memset(path->solution, 0, sizeof path->solution);
    path->middle_s = 0.5 * (plot_seconds(data, &plots[track->plots[first]]) +
                            plot_seconds(data, &plots[track->plots[first + count - 1]]));
    for (size_t k = 0; k < 2 * count; k++) {
        const struct radar_plot *plot = &plots[track->plots[first + k / 2]];
        const struct axes axes = noise_axes(plot, is_round);
        const int axis = (int)(k % 2);
        const double weight = 1.0 / (axes.sigma_m[axis] * axes.sigma_m[axis]);
        double row[MAX_UNKNOWN];

        design_row(path, plot_seconds(data, plot), axes.x[axis], axes.y[axis], row);
        for (size_t i = 0; i < n; i++) {
            path->solution[i] += weight * row[i] * plot_place_along(plot, &axes, axis);
            for (size_t j = 0; j < n; j++) {
                path->factor[i * n + j] += weight * row[i] * row[j];
            }
        }
    }
    if (!cholesky_factor(path->factor, n)) {
        return false;
    }
    cholesky_solve(path->factor, n, path->solution);
    return true;
}

static void add_residuals(const struct register_data *data, const struct radar_track *track,
                          size_t first, size_t count, bool is_round, const struct path *path,
                          struct calibrate_segments *segments)
{
    const struct radar_plot *plots = data->radars[track->radar].plots;

    for (size_t k = 0; k < 2 * count; k++) {
        const struct radar_plot *plot = &plots[track->plots[first + k / 2]];
        const struct axes axes = noise_axes(plot, is_round);
        const int axis = (int)(k % 2);
        double row[MAX_UNKNOWN], leverage;

        design_row(path, plot_seconds(data, plot), axes.x[axis], axes.y[axis], row);
        leverage = path_variance(path, row) / (axes.sigma_m[axis] * axes.sigma_m[axis]);
        if (leverage > LEVERAGE_MAX) {
            continue; /* the path goes through it, whatever its noise */
        }
        segments->residuals = must_grow(segments->residuals, segments->num_residuals,
                                        &segments->residuals_room, sizeof *segments->residuals);
        segments->residuals[segments->num_residuals++] =
            (struct residual){.segment = segments->num_segments,
                              .track = (size_t)(track - data->tracks),
                              .axis = axis,
                              .off_m = (plot_place_along(plot, &axes, axis) -
                                        dot(row, path->solution, 2 * path->powers)) /
                                       sqrt(1.0 - leverage),
                              .range_m = plot->range_m};
    }
}

/* Noise changes sides from plot to plot; where a target turns harder than its path, plots lie on
 * one side for some. */
static bool look_like_noise(const struct residual *residuals, size_t count)
{
    double product[2] = {0.0, 0.0}, square[2] = {0.0, 0.0}, before[2] = {0.0, 0.0};

    for (size_t i = 0; i < count; i++) {
        const int axis = residuals[i].axis;

        product[axis] += before[axis] * residuals[i].off_m;
        square[axis] += residuals[i].off_m * residuals[i].off_m;
        before[axis] = residuals[i].off_m;
    }
    return product[0] <= CORRELATION_MAX * square[0] && product[1] <= CORRELATION_MAX * square[1];
}

static struct calibrate_segment segment_of(const struct path *path, size_t track)
{
    double vx = path->solution[1], vy = path->solution[path->powers + 1];
    double speed_mps = hypot(vx, vy), row[MAX_UNKNOWN] = {0.0};

    if (speed_mps > 0.0) {
        row[1] = vx / speed_mps;
        row[path->powers + 1] = vy / speed_mps;
    }
    return (struct calibrate_segment){track, speed_mps, sqrt(path_variance(path, row))};
}

/* A line where that will do, else a parabola: residuals are added, and it is true, where they look
 * like noise. */
static bool fit_segment(const struct register_data *data, const struct radar_track *track,
                        size_t first, bool is_round, struct path *path,
                        struct calibrate_segments *segments)
{
    const size_t before = segments->num_residuals;

    for (path->powers = 2; path->powers <= POWERS_MAX; path->powers++) {
        if (!fit_path(data, track, first, SEGMENT_PLOTS, is_round, path)) {
            return false;
        }
        add_residuals(data, track, first, SEGMENT_PLOTS, is_round, path, segments);
        if (look_like_noise(&segments->residuals[before], segments->num_residuals - before)) {
            return true;
        }
        segments->num_residuals = before;
    }
    return false;
}

static void cut_track_into_segments(const struct register_data *data, size_t number, bool is_round,
                                    struct calibrate_segments *segments)
{
    const struct radar_track *track = &data->tracks[number];
    const struct radar_plot *plots = data->radars[track->radar].plots;

    for (size_t first = 0; first + SEGMENT_PLOTS <= track->count; first += SEGMENT_PLOTS) {
        const double took_s = plot_seconds(data, &plots[track->plots[first + SEGMENT_PLOTS - 1]]) -
                              plot_seconds(data, &plots[track->plots[first]]);
        struct path path;

        if (took_s > SEGMENT_S) {
            continue;
        }
        if (!fit_segment(data, track, first, is_round, &path, segments)) {
            segments->num_left_out++;
            continue;
        }
        segments->segments = must_grow(segments->segments, segments->num_segments,
                                       &segments->segments_room, sizeof *segments->segments);
        segments->segments[segments->num_segments++] = segment_of(&path, number);
    }
}

struct calibrate_segments calibrate_cut_segments(const struct register_data *data, size_t radar,
                                                 bool is_round)
{
    struct calibrate_segments segments = {.num_segments = 0};

    for (size_t i = 0; i < data->num_tracks; i++) {
        if (data->tracks[i].radar == radar) {
            cut_track_into_segments(data, i, is_round, &segments);
        }
    }
    return segments;
}

void calibrate_segments_free(struct calibrate_segments *segments)
{
    free(segments->segments);
    free(segments->residuals);
}

double calibrate_sum_innovations(const struct register_data *data, size_t radar, bool is_round,
                                 size_t *count)
{
    double sum = 0.0;

    *count = 0;
    for (size_t i = 0; i < data->num_tracks; i++) {
        const struct radar_track *track = &data->tracks[i];

        for (size_t next = LEAD_PLOTS; track->radar == radar && next < track->count; next++) {
            const struct radar_plot *plot = &data->radars[radar].plots[track->plots[next]];
            const struct axes axes = noise_axes(plot, is_round);
            struct path path = {.powers = 2};

            for (int axis = 0;
                 axis < 2 && fit_path(data, track, next - LEAD_PLOTS, LEAD_PLOTS, is_round, &path);
                 axis++) {
                double row[MAX_UNKNOWN] = {0.0}, off_m, square;

                design_row(&path, plot_seconds(data, plot), axes.x[axis], axes.y[axis], row);
                off_m = plot_place_along(plot, &axes, axis) - dot(row, path.solution, 4);
                square = off_m * off_m /
                         (path_variance(&path, row) + axes.sigma_m[axis] * axes.sigma_m[axis]);
                sum += square < CUT2 ? square : CUT2;
                ++*count;
            }
        }
    }
    return sum;
}
