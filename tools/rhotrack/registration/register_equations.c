/* SPDX-License-Identifier: MIT */
#include "registration/register_equations.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "registration/cholesky.h"

#define SEGMENT_S 30.0
#define PLOTS_MIN 2    /* fewest plots of a radar in a segment, for at least two radars */
#define SPARE_MIN 4    /* measurements that a segment needs beyond its number of coefficients */
#define FAR_SIGMAS 3.0 /* residual in sigmas beyond which a plot's weight falls (Huber) */

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

/* Appends a track's plots, each with the biases estimated so far subtracted. */
static void append_corrected_plots(const struct register_data *data,
                                   const struct radar_track *track, struct segments *segments)
{
    const struct radar_data *radar = &data->radars[track->radar];

    for (size_t i = 0; i < track->count; i++) {
        struct corrected at = register_correct_plot(data, radar, &radar->plots[track->plots[i]]);

        segments->plots = must_make_room_for_one(segments->plots, segments->num_plots,
                                                 &segments->plots_room, sizeof *segments->plots);
        segments->plots[segments->num_plots++] = (struct segment_plot){
            .radar = track->radar, .plot = track->plots[i], .t_s = at.t_s, .weight = 1.0};
    }
}

/*
 * Whether at least two radars have PLOTS_MIN plots in the segment, so that it says something about
 * their biases.
 */
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

/* Cuts the plots of one target, from index `first` on, into segments of SEGMENT_S. */
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
            segments->segments =
                must_make_room_for_one(segments->segments, segments->num_segments,
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
                append_corrected_plots(data, &data->tracks[i], &segments);
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

/*
 * The terms of a plot in the least squares: two rows, along and across the line of sight, in units
 * of sigma.
 */
struct plot_terms {
    struct corrected at;
    double unit[2][2]; /* unit vectors along and across the line of sight, divided by sigma */
    double basis[SEGMENT_TERMS], slope[SEGMENT_TERMS];
    /* metres across the line of sight for a radian of azimuth, divided by sigma */
    double cross_per_rad;
};

static struct plot_terms make_plot_terms(const struct register_data *data,
                                         const struct segment *segment,
                                         const struct segment_plot *plot)
{
    const struct radar_data *radar = &data->radars[plot->radar];
    const struct radar_plot *measured = &radar->plots[plot->plot];
    struct plot_terms plot_terms = {.at = register_correct_plot(data, radar, measured)};
    double u = (plot_terms.at.t_s - segment->middle_s) / (SEGMENT_S / 2.0);

    plot_terms.unit[0][0] = plot_terms.at.cos_azimuth / measured->sigma_range_m;
    plot_terms.unit[0][1] = plot_terms.at.sin_azimuth / measured->sigma_range_m;
    plot_terms.unit[1][0] = -plot_terms.at.sin_azimuth / measured->sigma_cross_m;
    plot_terms.unit[1][1] = plot_terms.at.cos_azimuth / measured->sigma_cross_m;
    plot_terms.cross_per_rad = plot_terms.at.range_m / measured->sigma_cross_m;
    plot_terms.basis[0] = 1.0;
    for (int k = 1; k < SEGMENT_TERMS; k++) {
        plot_terms.basis[k] = plot_terms.basis[k - 1] * u;
        plot_terms.slope[k] = (double)k * plot_terms.basis[k - 1] / (SEGMENT_S / 2.0);
    }
    return plot_terms;
}

/* Derivatives of the parabola's coordinate along the row's axis by each coefficient, in sigmas. */
static void fill_coefficient_row(const struct plot_terms *plot_terms, int row,
                                 double values[SEGMENT_COEFFICIENTS])
{
    for (int k = 0; k < SEGMENT_TERMS; k++) {
        values[k] = plot_terms->unit[row][0] * plot_terms->basis[k];
        values[SEGMENT_TERMS + k] = plot_terms->unit[row][1] * plot_terms->basis[k];
    }
}

static double place_along_row(const struct plot_terms *plot_terms, int row)
{
    return plot_terms->unit[row][0] * plot_terms->at.x_m +
           plot_terms->unit[row][1] * plot_terms->at.y_m;
}

/* Subtracts `from`, the place of the segment's first plot: large coordinates would lose digits. */
static void subtract_origin(struct plot_terms *plot_terms, const struct corrected *origin)
{
    plot_terms->at.x_m -= origin->x_m;
    plot_terms->at.y_m -= origin->y_m;
}

/*
 * Fits the segment's coefficients with the plots' weights; factor is the Cholesky factor of their
 * normal matrix. False where it is singular.
 */
static bool fit_path_coefficients(const struct plot_terms *plot_terms,
                                  const struct segment_plot *plots, struct segment *segment,
                                  double factor[SEGMENT_COEFFICIENTS * SEGMENT_COEFFICIENTS])
{
    memset(factor, 0, sizeof(double) * SEGMENT_COEFFICIENTS * SEGMENT_COEFFICIENTS);
    memset(segment->coefficients, 0, sizeof segment->coefficients);
    for (size_t i = 0; i < segment->count; i++) {
        for (int row = 0; row < 2; row++) {
            double values[SEGMENT_COEFFICIENTS], value = place_along_row(&plot_terms[i], row);

            fill_coefficient_row(&plot_terms[i], row, values);
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

static void path_velocity(const struct segment *segment, const struct plot_terms *plot_terms,
                          double v_mps[2])
{
    for (int axis = 0; axis < 2; axis++) {
        v_mps[axis] = 0.0;
        for (int k = 1; k < SEGMENT_TERMS; k++) {
            v_mps[axis] += segment->coefficients[axis * SEGMENT_TERMS + k] * plot_terms->slope[k];
        }
    }
}

/* Derivatives of a plot's row by the biases of its radar. */
static void fill_bias_row(const struct segment *segment, const struct plot_terms *plot_terms,
                          int row, double values[NUM_REGISTER_KINDS])
{
    double v_mps[2];

    path_velocity(segment, plot_terms, v_mps);
    values[REGISTER_RANGE] =
        /* the unit vector has length 1 / sigma */
        row == 0 ? -hypot(plot_terms->unit[0][0], plot_terms->unit[0][1]) : 0.0;
    values[REGISTER_AZIMUTH] = row == 1 ? -plot_terms->cross_per_rad : 0.0;
    values[REGISTER_TIME] =
        plot_terms->unit[row][0] * v_mps[0] + plot_terms->unit[row][1] * v_mps[1];
}

static double row_residual(const struct segment *segment, const struct plot_terms *plot_terms,
                           int row)
{
    double values[SEGMENT_COEFFICIENTS], off = place_along_row(plot_terms, row);

    fill_coefficient_row(plot_terms, row, values);
    for (int k = 0; k < SEGMENT_COEFFICIENTS; k++) {
        off -= values[k] * segment->coefficients[k];
    }
    return off;
}

/*
 * Adds the normal equations of all biases from one segment, with its coefficients eliminated:
 * matrix B'B - B'A (A'A)^-1 A'B, right side -B'e. `mixed` is storage for A'B, a column for each
 * bias.
 */
static void add_bias_equations(const struct segment_plot *plots,
                               const struct plot_terms *plot_terms, const struct segment *segment,
                               const double *factor, double *mixed, struct normal_equations *normal)
{
    size_t num = normal->num;

    memset(mixed, 0, sizeof *mixed * num * SEGMENT_COEFFICIENTS);
    for (size_t i = 0; i < segment->count; i++) {
        size_t base = plots[i].radar * NUM_REGISTER_KINDS;

        for (int row = 0; row < 2; row++) {
            double values[SEGMENT_COEFFICIENTS], biases[NUM_REGISTER_KINDS];
            double off = row_residual(segment, &plot_terms[i], row);

            fill_coefficient_row(&plot_terms[i], row, values);
            fill_bias_row(segment, &plot_terms[i], row, biases);
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
    /* B'A (A'A)^-1 A'B is (L^-1 A'B)' (L^-1 A'B) with A'A = L L' */
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

/* Sets the plots' Huber weights by their residuals, and the segment's weighted chi-square. */
static void update_weights_and_chi2(struct segment_plot *plots, const struct plot_terms *plot_terms,
                                    struct segment *segment)
{
    segment->chi2 = 0.0;
    for (size_t i = 0; i < segment->count; i++) {
        double d = hypot(row_residual(segment, &plot_terms[i], 0),
                         row_residual(segment, &plot_terms[i], 1));

        plots[i].weight = d > FAR_SIGMAS ? FAR_SIGMAS / d : 1.0;
        segment->chi2 += plots[i].weight * d * d;
    }
}

bool segment_fit_and_add_equations(const struct register_data *data, struct segments *segments,
                                   struct segment *segment, struct normal_equations *normal)
{
    struct segment_plot *plots = &segments->plots[segment->first];
    struct plot_terms *plot_terms = must_calloc(segment->count, sizeof *plot_terms);
    struct corrected from;
    double factor[SEGMENT_COEFFICIENTS * SEGMENT_COEFFICIENTS];
    bool is_fitted;

    for (size_t i = 0; i < segment->count; i++) {
        plot_terms[i] = make_plot_terms(data, segment, &plots[i]);
    }
    from = plot_terms[0].at;
    for (size_t i = 0; i < segment->count; i++) {
        subtract_origin(&plot_terms[i], &from);
    }
    is_fitted = fit_path_coefficients(plot_terms, plots, segment, factor);
    if (is_fitted) {
        if (normal) {
            double *mixed = must_calloc(normal->num * SEGMENT_COEFFICIENTS, sizeof *mixed);

            add_bias_equations(plots, plot_terms, segment, factor, mixed, normal);
            free(mixed);
        }
        double v_mps[2];

        path_velocity(segment, &plot_terms[segment->count / 2], v_mps);
        segment->speed_mps = hypot(v_mps[0], v_mps[1]);
        update_weights_and_chi2(plots, plot_terms, segment);
    }
    free(plot_terms);
    return is_fitted;
}
