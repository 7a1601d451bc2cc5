/* SPDX-License-Identifier: MIT */
/* register_solve: the biases by least squares over all segments that several radars saw. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "registration/cholesky.h"
#include "registration/register_data.h"
#include "registration/register_segments.h"

/* Beyond these nobody believes a bias (types.h): what the plots say nothing of stays within. */
static const double prior_sigma[NUM_REGISTER_KINDS] = {
    (double)RHO_LIMIT_BIAS_M, (double)RHO_LIMIT_BIAS_RAD, (double)RHO_LIMIT_BIAS_S};
/* Units of the biases, which give the equations entries of like size. */
static const double unit[NUM_REGISTER_KINDS] = {10.0, 1e-3, 0.1};

#define STEPS_MAX 30
#define STEP_LEAST 1e-6   /* in those units */
#define PASSES_MAX 4      /* in which segments are left out */
#define MISFIT_SIGMAS 4.0 /* a segment whose chi-square is off by more is no parabola */

static struct normal start_normal(const struct register_data *data)
{
    struct normal normal = {.num = data->num_radars * NUM_REGISTER_KINDS};

    normal.matrix = must_calloc(normal.num * normal.num, sizeof *normal.matrix);
    normal.right = must_calloc(normal.num, sizeof *normal.right);
    return normal;
}

static void free_normal(struct normal *normal)
{
    free(normal->matrix);
    free(normal->right);
}

/* Holds a bias at its value by an equation of its own. */
static void hold_bias(struct normal *normal, size_t index)
{
    for (size_t i = 0; i < normal->num; i++) {
        normal->matrix[index * normal->num + i] = normal->matrix[i * normal->num + index] = 0.0;
    }
    normal->matrix[index * normal->num + index] = 1.0;
    normal->right[index] = 0.0;
}

/* In the units above, with the priors, the reference's time held, as a factor. */
static void finish_normal(const struct register_data *data, size_t reference, struct normal *normal)
{
    size_t num = normal->num;

    for (size_t i = 0; i < num; i++) {
        size_t kind = i % NUM_REGISTER_KINDS;
        double weight = 1.0 / (prior_sigma[kind] * prior_sigma[kind]);

        normal->matrix[i * num + i] += weight;
        normal->right[i] -= weight * data->radars[i / NUM_REGISTER_KINDS].bias[kind];
    }
    for (size_t i = 0; i < num; i++) {
        normal->right[i] *= unit[i % NUM_REGISTER_KINDS];
        for (size_t j = 0; j < num; j++) {
            normal->matrix[i * num + j] *=
                unit[i % NUM_REGISTER_KINDS] * unit[j % NUM_REGISTER_KINDS];
        }
    }
    hold_bias(normal, reference * NUM_REGISTER_KINDS + REGISTER_TIME);
    if (!cholesky_factor(normal->matrix, num)) {
        fail(EXIT_RUNTIME, "register: the normal equations of the biases cannot be solved");
    }
}

static void add_segments(const struct register_data *data, struct segments *segments,
                         struct normal *normal)
{
    memset(normal->matrix, 0, normal->num * normal->num * sizeof *normal->matrix);
    memset(normal->right, 0, normal->num * sizeof *normal->right);
    for (size_t i = 0; i < segments->num_segments; i++) {
        struct segment *segment = &segments->segments[i];

        if (!segment->is_left_out && !segment_fit(data, segments, segment, normal)) {
            segment->is_left_out = true;
        }
    }
}

/* Gauss-Newton, with the weights going along. The normal equations of the last step stay. */
static void iterate_biases(struct register_data *data, struct segments *segments, size_t reference,
                           struct normal *normal)
{
    for (int i = 0; i < STEPS_MAX; i++) {
        double largest = 0.0;

        add_segments(data, segments, normal);
        finish_normal(data, reference, normal);
        cholesky_solve(normal->matrix, normal->num, normal->right);
        for (size_t j = 0; j < normal->num; j++) {
            size_t kind = j % NUM_REGISTER_KINDS;

            data->radars[j / NUM_REGISTER_KINDS].bias[kind] += normal->right[j] * unit[kind];
            largest = fmax(largest, fabs(normal->right[j]));
        }
        if (largest < STEP_LEAST) {
            return;
        }
    }
}

/* ---- segments that are no parabolas ---- */

static int by_size(const void *a, const void *b)
{
    double one = *(const double *)a, other = *(const double *)b;

    return (one > other) - (one < other);
}

/*
 * The median of chi-square over its degrees of freedom, which segments that are no parabolas hardly
 * move.
 */
static double median_misfit(const struct segments *segments)
{
    double *ratios = must_calloc(segments->num_segments + 1, sizeof *ratios), median = 1.0;
    size_t count = 0;

    for (size_t i = 0; i < segments->num_segments; i++) {
        if (!segments->segments[i].is_left_out) {
            ratios[count++] =
                segments->segments[i].chi2 / segment_degrees_of_freedom(&segments->segments[i]);
        }
    }
    if (count > 0) {
        qsort(ratios, count, sizeof *ratios, by_size);
        median = ratios[count / 2];
    }
    free(ratios);
    return median;
}

/* True where any segment was left out that was not before. */
static bool leave_out_misfits(struct segments *segments)
{
    double usual = median_misfit(segments);
    bool is_changed = false;

    for (size_t i = 0; i < segments->num_segments; i++) {
        struct segment *segment = &segments->segments[i];
        double freedom = segment_degrees_of_freedom(segment);

        if (!segment->is_left_out &&
            segment->chi2 > usual * (freedom + MISFIT_SIGMAS * sqrt(2.0 * freedom))) {
            segment->is_left_out = is_changed = true;
        }
    }
    return is_changed;
}

/* ---- what was found ---- */

static void count_segments(const struct segments *segments, struct solution *solution)
{
    double chi2 = 0.0, freedom = 0.0;

    for (size_t i = 0; i < segments->num_segments; i++) {
        const struct segment *segment = &segments->segments[i];

        if (segment->is_left_out) {
            solution->segments_left_out++;
            continue;
        }
        solution->segments++;
        solution->plots += segment->count;
        solution->speed_mps += segment->speed_mps;
        chi2 += segment->chi2;
        freedom += segment_degrees_of_freedom(segment);
        for (size_t j = 0; j < segment->count; j++) {
            solution->radar_plots[segments->plots[segment->first + j].radar]++;
        }
    }
    solution->speed_mps /= solution->segments > 0 ? (double)solution->segments : 1.0;
    solution->misfit = freedom > 0.0 ? sqrt(chi2 / freedom) : 1.0;
}

struct solution register_solve_biases(struct register_data *data, size_t reference)
{
    struct segments segments = segments_cut_paths(data);
    struct normal normal = start_normal(data);
    struct solution solution = {0};
    double *work = must_calloc(normal.num, sizeof *work);

    for (int pass = 0; pass < PASSES_MAX; pass++) {
        iterate_biases(data, &segments, reference, &normal);
        if (!leave_out_misfits(&segments)) {
            break;
        }
    }
    solution.radar_plots = must_calloc(data->num_radars + 1, sizeof *solution.radar_plots);
    solution.sigma = must_calloc(normal.num + 1, sizeof *solution.sigma);
    count_segments(&segments, &solution);
    for (size_t i = 0; i < normal.num; i++) {
        solution.sigma[i] = solution.misfit * unit[i % NUM_REGISTER_KINDS] *
                            sqrt(cholesky_inverse_diagonal(normal.matrix, normal.num, i, work));
    }
    solution.sigma[reference * NUM_REGISTER_KINDS + REGISTER_TIME] = 0.0;
    free(work);
    free_normal(&normal);
    segments_free(&segments);
    return solution;
}

void solution_free(struct solution *solution)
{
    free(solution->radar_plots);
    free(solution->sigma);
}
