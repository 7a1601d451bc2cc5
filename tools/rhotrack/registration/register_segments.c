/* SPDX-License-Identifier: MIT */
#include "registration/register_segments.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "registration/cholesky.h"

#define SEGMENT_S 30.0
#define PLOTS_MIN 2    /* of a radar in a segment, for two radars of it at least */
#define SPARE_MIN 4    /* measurements of a segment more than it has coefficients */
#define FAR_SIGMAS 3.0 /* plots farther off count with the weight of one there: Huber */

/* ---- cutting ---- */

static int by_time(const void *a, const void *b)
{
    const struct segment_plot *one = a, *other = b;

    if (one->t_s < other->t_s || one->t_s > other->t_s) {
        return one->t_s > other->t_s ? 1 : -1;
    }
    if (one->radar != other->radar) {
        return one->radar > other->radar ? 1 : -1;
    }
    return (one->plot > other->plot) - (one->plot < other->plot);
}

static void add_track_plots(const struct register_data *data, const struct radar_track *track,
                            struct segments *segments)
{
    const struct radar_data *radar = &data->radars[track->radar];

    for (size_t i = 0; i < track->count; i++) {
        struct corrected at = register_correct_plot(data, radar, &radar->plots[track->plots[i]]);

        segments->plots = must_grow(segments->plots, segments->num_plots, &segments->plots_room,
                                    sizeof *segments->plots);
        segments->plots[segments->num_plots++] = (struct segment_plot){
            .radar = track->radar, .plot = track->plots[i], .t_s = at.t_s, .weight = 1.0};
    }
}

/* Do enough radars have enough plots here to say anything of biases? */
static bool has_enough_radars(const struct register_data *data, const struct segments *segments,
                              const struct segment *segment)
{
    size_t enough = 0;

    for (size_t radar = 0; radar < data->num_radars; radar++) {
        size_t count = 0;

        for (size_t i = 0; i < segment->count; i++) {
            count += segments->plots[segment->first + i].radar == radar;
        }
        enough += count >= PLOTS_MIN;
    }
    return enough >= 2 && 2 * segment->count >= SEGMENT_COEFFICIENTS + SPARE_MIN;
}

/* The plots of one target, from `first` on. */
static void cut_target_path(const struct register_data *data, struct segments *segments,
                            size_t first)
{
    const struct segment_plot *plots = segments->plots;

    qsort(segments->plots + first, segments->num_plots - first, sizeof *segments->plots, by_time);
    while (first < segments->num_plots) {
        struct segment segment = {.first = first, .middle_s = plots[first].t_s + SEGMENT_S / 2.0};

        while (first < segments->num_plots &&
               plots[first].t_s < segment.middle_s + SEGMENT_S / 2.0) {
            first++;
        }
        segment.count = first - segment.first;
        if (has_enough_radars(data, segments, &segment)) {
            segments->segments = must_grow(segments->segments, segments->num_segments,
                                           &segments->segments_room, sizeof *segments->segments);
            segments->segments[segments->num_segments++] = segment;
        }
    }
}

struct segments segments_cut_paths(const struct register_data *data)
{
    struct segments segments = {0};

    for (size_t target = 0; target < data->num_tracks; target++) {
        size_t first = segments.num_plots;

        for (size_t i = target; i < data->num_tracks; i++) {
            if (data->tracks[i].target == target) {
                add_track_plots(data, &data->tracks[i], &segments);
            }
        }
        if (segments.num_plots > first) {
            cut_target_path(data, &segments, first);
        }
    }
    return segments;
}

void segments_free(struct segments *segments)
{
    free(segments->segments);
    free(segments->plots);
}

double segment_degrees_of_freedom(const struct segment *segment)
{
    return 2.0 * (double)segment->count - SEGMENT_COEFFICIENTS;
}

/* ---- fitting ---- */

/* One plot against the parabola: two measurements, along and across, in sigmas. */
struct opened {
    struct corrected at;
    double unit[2][2]; /* along and across, over sigma */
    double basis[SEGMENT_TERMS], slope[SEGMENT_TERMS];
    double reach; /* metres across for a radian, over sigma */
};

static struct opened prepare_plot(const struct register_data *data, const struct segment *segment,
                                  const struct segment_plot *plot)
{
    const struct radar_data *radar = &data->radars[plot->radar];
    const struct radar_plot *measured = &radar->plots[plot->plot];
    struct opened opened = {.at = register_correct_plot(data, radar, measured)};
    double u = (opened.at.t_s - segment->middle_s) / (SEGMENT_S / 2.0);

    opened.unit[0][0] = opened.at.cos_azimuth / measured->sigma_range_m;
    opened.unit[0][1] = opened.at.sin_azimuth / measured->sigma_range_m;
    opened.unit[1][0] = -opened.at.sin_azimuth / measured->sigma_cross_m;
    opened.unit[1][1] = opened.at.cos_azimuth / measured->sigma_cross_m;
    opened.reach = opened.at.range_m / measured->sigma_cross_m;
    opened.basis[0] = 1.0;
    for (int k = 1; k < SEGMENT_TERMS; k++) {
        opened.basis[k] = opened.basis[k - 1] * u;
        opened.slope[k] = (double)k * opened.basis[k - 1] / (SEGMENT_S / 2.0);
    }
    return opened;
}

/* By how much the parabola's value changes with each coefficient, in the row's sigmas. */
static void coefficient_row(const struct opened *opened, int row,
                            double values[SEGMENT_COEFFICIENTS])
{
    for (int k = 0; k < SEGMENT_TERMS; k++) {
        values[k] = opened->unit[row][0] * opened->basis[k];
        values[SEGMENT_TERMS + k] = opened->unit[row][1] * opened->basis[k];
    }
}

static double measured_value(const struct opened *opened, int row)
{
    return opened->unit[row][0] * opened->at.x_m + opened->unit[row][1] * opened->at.y_m;
}

/*
 * The place is large beside what is looked for: taken from the segment's first plot, not to lose
 * digits.
 */
static void shift_origin_to(struct opened *opened, const struct corrected *from)
{
    opened->at.x_m -= from->x_m;
    opened->at.y_m -= from->y_m;
}

/* The coefficients by the plots' weights; the factor of their normal matrix stays for later. */
static bool fit_coefficients(const struct opened *opened, const struct segment_plot *plots,
                             struct segment *segment,
                             double factor[SEGMENT_COEFFICIENTS * SEGMENT_COEFFICIENTS])
{
    memset(factor, 0, sizeof(double) * SEGMENT_COEFFICIENTS * SEGMENT_COEFFICIENTS);
    memset(segment->coefficients, 0, sizeof segment->coefficients);
    for (size_t i = 0; i < segment->count; i++) {
        for (int row = 0; row < 2; row++) {
            double values[SEGMENT_COEFFICIENTS], value = measured_value(&opened[i], row);

            coefficient_row(&opened[i], row, values);
            for (int j = 0; j < SEGMENT_COEFFICIENTS; j++) {
                segment->coefficients[j] += plots[i].weight * values[j] * value;
                for (int k = 0; k < SEGMENT_COEFFICIENTS; k++) {
                    factor[j * SEGMENT_COEFFICIENTS + k] += plots[i].weight * values[j] * values[k];
                }
            }
        }
    }
    if (!cholesky_factor(factor, SEGMENT_COEFFICIENTS)) {
        return false;
    }
    cholesky_solve(factor, SEGMENT_COEFFICIENTS, segment->coefficients);
    return true;
}

static void path_velocity(const struct segment *segment, const struct opened *opened,
                          double v_mps[2])
{
    for (int axis = 0; axis < 2; axis++) {
        v_mps[axis] = 0.0;
        for (int k = 1; k < SEGMENT_TERMS; k++) {
            v_mps[axis] += segment->coefficients[axis * SEGMENT_TERMS + k] * opened->slope[k];
        }
    }
}

/* How a plot's row changes with its radar's biases. */
static void bias_row(const struct segment *segment, const struct opened *opened, int row,
                     double values[NUM_REGISTER_KINDS])
{
    double v_mps[2];

    path_velocity(segment, opened, v_mps);
    values[REGISTER_RANGE] =
        row == 0 ? -hypot(opened->unit[0][0], opened->unit[0][1]) : 0.0; /* -1 / sigma */
    values[REGISTER_AZIMUTH] = row == 1 ? -opened->reach : 0.0;
    values[REGISTER_TIME] = opened->unit[row][0] * v_mps[0] + opened->unit[row][1] * v_mps[1];
}

static double row_residual(const struct segment *segment, const struct opened *opened, int row)
{
    double values[SEGMENT_COEFFICIENTS], off = measured_value(opened, row);

    coefficient_row(opened, row, values);
    for (int k = 0; k < SEGMENT_COEFFICIENTS; k++) {
        off -= values[k] * segment->coefficients[k];
    }
    return off;
}

/*
 * Adds a segment's normal equations: B'B - B'A (A'A)^-1 A'B of all biases, and -B'e. `mixed` is
 * A'B, a column for each bias.
 */
static void add_bias_equations(const struct segment_plot *plots, const struct opened *opened,
                               const struct segment *segment, const double *factor, double *mixed,
                               struct normal *normal)
{
    size_t num = normal->num;

    memset(mixed, 0, sizeof *mixed * num * SEGMENT_COEFFICIENTS);
    for (size_t i = 0; i < segment->count; i++) {
        size_t base = plots[i].radar * NUM_REGISTER_KINDS;

        for (int row = 0; row < 2; row++) {
            double values[SEGMENT_COEFFICIENTS], biases[NUM_REGISTER_KINDS];
            double off = row_residual(segment, &opened[i], row);

            coefficient_row(&opened[i], row, values);
            bias_row(segment, &opened[i], row, biases);
            for (size_t j = 0; j < NUM_REGISTER_KINDS; j++) {
                double weighted = plots[i].weight * biases[j];

                normal->right[base + j] -= weighted * off;
                for (size_t k = 0; k < NUM_REGISTER_KINDS; k++) {
                    normal->matrix[(base + j) * num + base + k] += weighted * biases[k];
                }
                for (size_t k = 0; k < SEGMENT_COEFFICIENTS; k++) {
                    mixed[(base + j) * SEGMENT_COEFFICIENTS + k] += weighted * values[k];
                }
            }
        }
    }
    /* with the factor L: |L^-1 A'B| squared */
    for (size_t j = 0; j < num; j++) {
        cholesky_solve_lower(factor, SEGMENT_COEFFICIENTS, &mixed[j * SEGMENT_COEFFICIENTS]);
    }
    for (size_t j = 0; j < num; j++) {
        for (size_t k = 0; k < num; k++) {
            for (size_t m = 0; m < SEGMENT_COEFFICIENTS; m++) {
                normal->matrix[j * num + k] -=
                    mixed[j * SEGMENT_COEFFICIENTS + m] * mixed[k * SEGMENT_COEFFICIENTS + m];
            }
        }
    }
}

static void weigh_plots(struct segment_plot *plots, const struct opened *opened,
                        struct segment *segment)
{
    segment->chi2 = 0.0;
    for (size_t i = 0; i < segment->count; i++) {
        double d =
            hypot(row_residual(segment, &opened[i], 0), row_residual(segment, &opened[i], 1));

        plots[i].weight = d > FAR_SIGMAS ? FAR_SIGMAS / d : 1.0;
        segment->chi2 += plots[i].weight * d * d;
    }
}

bool segment_fit(const struct register_data *data, struct segments *segments,
                 struct segment *segment, struct normal *normal)
{
    struct segment_plot *plots = &segments->plots[segment->first];
    struct opened *opened = must_calloc(segment->count, sizeof *opened);
    struct corrected from;
    double factor[SEGMENT_COEFFICIENTS * SEGMENT_COEFFICIENTS];
    bool is_fitted;

    for (size_t i = 0; i < segment->count; i++) {
        opened[i] = prepare_plot(data, segment, &plots[i]);
    }
    from = opened[0].at;
    for (size_t i = 0; i < segment->count; i++) {
        shift_origin_to(&opened[i], &from);
    }
    is_fitted = fit_coefficients(opened, plots, segment, factor);
    if (is_fitted) {
        if (normal) {
            double *mixed = must_calloc(normal->num * SEGMENT_COEFFICIENTS, sizeof *mixed);

            add_bias_equations(plots, opened, segment, factor, mixed, normal);
            free(mixed);
        }
        double v_mps[2];

        path_velocity(segment, &opened[segment->count / 2], v_mps);
        segment->speed_mps = hypot(v_mps[0], v_mps[1]);
        weigh_plots(plots, opened, segment);
    }
    free(opened);
    return is_fitted;
}
