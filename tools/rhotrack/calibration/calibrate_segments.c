/* SPDX-License-Identifier: MIT */
#include "calibration/calibrate_segments.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "registration/cholesky.h"

#define SEGMENT_PLOTS 10
#define SEGMENT_S 300.0   /* longest segment: over a longer time a target's path is no parabola */
#define PREDICTOR_PLOTS 4 /* plots through which a line is fitted to predict the next one */
#define POWERS_MAX 3      /* most coefficients of the polynomial of one axis */
#define MAX_UNKNOWN ((size_t)2 * POWERS_MAX)
#define CUT2 4.0
#define LEVERAGE_MAX 0.9
/*
 * largest lag-one correlation of residuals that pass as noise; white noise about a parabola has
 * -0.2
 */
#define CORRELATION_MAX 0.15

/* Polynomials of x and of y over time, fitted to plots by least squares. */
struct path {
    size_t powers; /* number of coefficients of each axis, powers of the seconds since middle_s */
    double middle_s;
    double factor[MAX_UNKNOWN * MAX_UNKNOWN];
    double solution[MAX_UNKNOWN];
};

/*
 * Row of the design matrix: the coordinate along the direction (x, y) at time t_s as a linear
 * function of the path's coefficients.
 */
static void fill_design_row(const struct path *path, double t_s, double x, double y, double *row)
{
    double power = 1.0;

    for (size_t i = 0; i < path->powers; i++) {
        row[i] = x * power;
        row[path->powers + i] = y * power;
        power *= t_s - path->middle_s;
    }
}

static double dot_product(const double *a, const double *b, size_t n)
{
    double sum = 0.0;

    for (size_t i = 0; i < n; i++) {
        sum += a[i] * b[i];
    }
    return sum;
}

/* Variance of row * coefficients, by the sigmas of the fitted plots. */
static double path_variance(const struct path *path, const double *row)
{
    double half[MAX_UNKNOWN];

    memcpy(half, row, sizeof half);
    cholesky_solve_lower(path->factor, 2 * path->powers, half);
    return dot_product(half, half, 2 * path->powers);
}

/* The two axes of a plot's noise as unit vectors, and the sigma along each. */
struct axes {
    double x[2], y[2], sigma_m[2];
};

static struct axes noise_axes(const struct radar_plot *plot, bool is_isotropic)
{
    double c = is_isotropic ? 1.0 : cos(plot->azimuth_rad),
           s = is_isotropic ? 0.0 : sin(plot->azimuth_rad);

    return (struct axes){
        .x = {c, -s}, .y = {s, c}, .sigma_m = {plot->sigma_range_m, plot->sigma_cross_m}};
}

static double plot_time_since_start_s(const struct register_data *data,
                                      const struct radar_plot *plot)
{
    return (double)(plot->time_us - data->start_us) * 1e-6;
}

static double plot_coordinate_along(const struct radar_plot *plot, const struct axes *axes,
                                    int axis)
{
    return axes->x[axis] * (double)plot->plot.x_m + axes->y[axis] * (double)plot->plot.y_m;
}

/*
 * Fits the path to `count` plots of a track from `first` on. False where the plots do not determine
 * it.
 */
static bool fit_path(const struct register_data *data, const struct radar_track *track,
                     size_t first, size_t count, bool is_isotropic, struct path *path)
{
    const struct radar_plot *plots = data->radars[track->radar].plots;
    const size_t n = 2 * path->powers;

    memset(path->factor, 0, sizeof path->factor);
    memset(path->solution, 0, sizeof path->solution);
    path->middle_s = 0.5 * (plot_time_since_start_s(data, &plots[track->plots[first]]) +
                            plot_time_since_start_s(data, &plots[track->plots[first + count - 1]]));
    for (size_t k = 0; k < 2 * count; k++) {
        const struct radar_plot *plot = &plots[track->plots[first + k / 2]];
        const struct axes axes = noise_axes(plot, is_isotropic);
        const int axis = (int)(k % 2);
        const double weight = 1.0 / (axes.sigma_m[axis] * axes.sigma_m[axis]);
        double row[MAX_UNKNOWN];

        fill_design_row(path, plot_time_since_start_s(data, plot), axes.x[axis], axes.y[axis], row);
        for (size_t i = 0; i < n; i++) {
            path->solution[i] += weight * row[i] * plot_coordinate_along(plot, &axes, axis);
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

/*
 * Adds the residual of each plot along both axes, divided by sqrt(1 - leverage) so that its
 * variance is the plot's noise.
 */
static void add_segment_residuals(const struct register_data *data, const struct radar_track *track,
                                  size_t first, size_t count, bool is_isotropic,
                                  const struct path *path, struct calibrate_segments *segments)
{
    const struct radar_plot *plots = data->radars[track->radar].plots;

    for (size_t k = 0; k < 2 * count; k++) {
        const struct radar_plot *plot = &plots[track->plots[first + k / 2]];
        const struct axes axes = noise_axes(plot, is_isotropic);
        const int axis = (int)(k % 2);
        double row[MAX_UNKNOWN], leverage;

        fill_design_row(path, plot_time_since_start_s(data, plot), axes.x[axis], axes.y[axis], row);
        leverage = path_variance(path, row) / (axes.sigma_m[axis] * axes.sigma_m[axis]);
        if (leverage > LEVERAGE_MAX) {
            /*
             * this plot alone determines the path here: its residual is near 0 whatever its noise
             */
            continue;
        }
        segments->residuals =
            must_make_room_for_one(segments->residuals, segments->num_residuals,
                                   &segments->residuals_room, sizeof *segments->residuals);
        segments->residuals[segments->num_residuals++] =
            (struct residual){.segment = segments->num_segments,
                              .track = (size_t)(track - data->tracks),
                              .axis = axis,
                              .off_m = (plot_coordinate_along(plot, &axes, axis) -
                                        dot_product(row, path->solution, 2 * path->powers)) /
                                       sqrt(1.0 - leverage),
                              .range_m = plot->range_m};
    }
}

/*
 * Whether successive residuals are uncorrelated, as noise is: where a target manoeuvres harder than
 * the path can follow, several plots in a row lie on one side.
 */
static bool residuals_look_like_noise(const struct residual *residuals, size_t count)
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

/* The segment's speed in its middle, and the standard error of the speed. */
static struct calibrate_segment segment_of_path_middle(const struct path *path, size_t track)
{
    double vx = path->solution[1], vy = path->solution[path->powers + 1];
    double speed_mps = hypot(vx, vy), row[MAX_UNKNOWN] = {0.0};

    if (speed_mps > 0.0) {
        row[1] = vx / speed_mps;
        row[path->powers + 1] = vy / speed_mps;
    }
    return (struct calibrate_segment){track, speed_mps, sqrt(path_variance(path, row))};
}

/*
 * Fits a line, or where its residuals do not look like noise a parabola, and adds the residuals of
 * the fit to segments. False, without residuals, where neither fits.
 */
static bool fit_segment_and_add_residuals(const struct register_data *data,
                                          const struct radar_track *track, size_t first,
                                          bool is_isotropic, struct path *path,
                                          struct calibrate_segments *segments)
{
    const size_t before = segments->num_residuals;

    for (path->powers = 2; path->powers <= POWERS_MAX; path->powers++) {
        if (!fit_path(data, track, first, SEGMENT_PLOTS, is_isotropic, path)) {
            return false;
        }
        add_segment_residuals(data, track, first, SEGMENT_PLOTS, is_isotropic, path, segments);
        if (residuals_look_like_noise(&segments->residuals[before],
                                      segments->num_residuals - before)) {
            return true;
        }
        segments->num_residuals = before;
    }
    return false;
}

static void cut_track_into_segments(const struct register_data *data, size_t track_number,
                                    bool is_isotropic, struct calibrate_segments *segments)
{
    const struct radar_track *track = &data->tracks[track_number];
    const struct radar_plot *plots = data->radars[track->radar].plots;

    for (size_t first = 0; first + SEGMENT_PLOTS <= track->count; first += SEGMENT_PLOTS) {
        const double duration_s =
            plot_time_since_start_s(data, &plots[track->plots[first + SEGMENT_PLOTS - 1]]) -
            plot_time_since_start_s(data, &plots[track->plots[first]]);
        struct path path;

        if (duration_s > SEGMENT_S) {
            continue;
        }
        if (!fit_segment_and_add_residuals(data, track, first, is_isotropic, &path, segments)) {
            segments->num_unfitted++;
            continue;
        }
        segments->segments =
            must_make_room_for_one(segments->segments, segments->num_segments,
                                   &segments->segments_room, sizeof *segments->segments);
        segments->segments[segments->num_segments++] = segment_of_path_middle(&path, track_number);
    }
}

struct calibrate_segments calibrate_cut_segments(const struct register_data *data, size_t radar,
                                                 bool is_isotropic)
{
    struct calibrate_segments segments = {.num_segments = 0};

    for (size_t i = 0; i < data->num_tracks; i++) {
        if (data->tracks[i].radar == radar) {
            cut_track_into_segments(data, i, is_isotropic, &segments);
        }
    }
    return segments;
}

void calibrate_segments_free(struct calibrate_segments *segments)
{
    free(segments->segments);
    free(segments->residuals);
}

double calibrate_sum_innovations(const struct register_data *data, size_t radar, bool is_isotropic,
                                 size_t *count)
{
    double sum = 0.0;

    *count = 0;
    for (size_t i = 0; i < data->num_tracks; i++) {
        const struct radar_track *track = &data->tracks[i];

        for (size_t next = PREDICTOR_PLOTS; track->radar == radar && next < track->count; next++) {
            const struct radar_plot *plot = &data->radars[radar].plots[track->plots[next]];
            const struct axes axes = noise_axes(plot, is_isotropic);
            struct path path = {.powers = 2};

            for (int axis = 0; axis < 2 && fit_path(data, track, next - PREDICTOR_PLOTS,
                                                    PREDICTOR_PLOTS, is_isotropic, &path);
                 axis++) {
                double row[MAX_UNKNOWN] = {0.0}, off_m, square;

                fill_design_row(&path, plot_time_since_start_s(data, plot), axes.x[axis],
                                axes.y[axis], row);
                off_m =
                    plot_coordinate_along(plot, &axes, axis) - dot_product(row, path.solution, 4);
                square = off_m * off_m /
                         (path_variance(&path, row) + axes.sigma_m[axis] * axes.sigma_m[axis]);
                sum += square < CUT2 ? square : CUT2;
                ++*count;
            }
        }
    }
    return sum;
}
