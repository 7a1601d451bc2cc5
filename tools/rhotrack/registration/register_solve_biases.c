/* SPDX-License-Identifier: MIT */
/* register_solve_biases: the biases by least squares over all segments that several radars saw. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "registration/cholesky.h"
#include "registration/register_data.h"
#include "registration/register_equations.h"

/*
 * Prior sigmas of the biases, the largest biases that a sensor may have (types.h): they keep biases
 * bounded that the plots do not determine.
 */
static const double prior_sigma[NUM_REGISTER_KINDS] = {
    (double)RHO_LIMIT_BIAS_M, (double)RHO_LIMIT_BIAS_RAD, (double)RHO_LIMIT_BIAS_S};
/* Units of the biases, chosen so that the entries of the equations are of similar size. */
static const double unit[NUM_REGISTER_KINDS] = {10.0, 1e-3, 0.1};

#define STEPS_MAX 30
/* largest step of any bias, in `unit`, at which the iteration has converged */
#define STEP_LEAST 1e-6
#define PASSES_MAX 4 /* most rounds of leaving out segments */
/* a segment whose chi-square is too large by more sigmas is no parabola */
#define MISFIT_SIGMAS 4.0

static struct normal_equations alloc_normal_equations(const struct register_data *data)
{
    struct normal_equations normal = {.num = data->num_radars * NUM_REGISTER_KINDS};

    normal.matrix = must_calloc(normal.num * normal.num, sizeof *normal.matrix);
    normal.right = must_calloc(normal.num, sizeof *normal.right);
    return normal;
}

/* Fixes a bias at its present value: its row and column become those of the identity. */
static void hold_bias_constant(struct normal_equations *normal, size_t index)
{
    for (size_t i = 0; i < normal->num; i++) {
        normal->matrix[index * normal->num + i] = normal->matrix[i * normal->num + index] = 0.0;
    }
    normal->matrix[index * normal->num + index] = 1.0;
    normal->right[index] = 0.0;
}

/*
 * Completes the normal equations: adds the priors, scales to `unit`, fixes the reference's time,
 * and replaces the matrix by its Cholesky factor.
 */
static void finish_and_factor_normal(const struct register_data *data, size_t reference,
                                     struct normal_equations *normal)
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
    hold_bias_constant(normal, reference * NUM_REGISTER_KINDS + REGISTER_TIME);
    if (!cholesky_factor(normal->matrix, num)) {
        fail(EXIT_RUNTIME, "register: the normal equations of the biases cannot be solved");
    }
}

/* Fits all segments in use, sums their normal equations, and leaves out those that do not fit. */
static void fit_segments_and_sum_equations(const struct register_data *data,
                                           struct segments *segments,
                                           struct normal_equations *normal)
{
    memset(normal->matrix, 0, normal->num * normal->num * sizeof *normal->matrix);
    memset(normal->right, 0, normal->num * sizeof *normal->right);
    for (size_t i = 0; i < segments->num_segments; i++) {
        struct segment *segment = &segments->segments[i];

        if (!segment->is_left_out &&
            !segment_fit_and_add_equations(data, segments, segment, normal)) {
            segment->is_left_out = true;
        }
    }
}

/*
 * Gauss-Newton iteration for the biases; the plots' weights are updated in each step. normal keeps
 * the factored equations of the last step.
 */
static void iterate_biases(struct register_data *data, struct segments *segments, size_t reference,
                           struct normal_equations *normal)
{
    for (int i = 0; i < STEPS_MAX; i++) {
        double largest = 0.0;

        fit_segments_and_sum_equations(data, segments, normal);
        finish_and_factor_normal(data, reference, normal);
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

/*
 * Median over the segments of chi-square divided by its degrees of freedom, which the few segments
 * that are no parabolas hardly change.
 */
static double median_chi2_ratio(const struct segments *segments)
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
        qsort(ratios, count, sizeof *ratios, compare_doubles);
        median = ratios[count / 2];
    }
    free(ratios);
    return median;
}

/* Leaves out segments whose chi-square is too large; true where there was any new one. */
static bool leave_out_misfit_segments(struct segments *segments)
{
    double usual = median_chi2_ratio(segments);
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

static void summarise_segments(const struct segments *segments, struct solution *solution)
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
    struct normal_equations normal = alloc_normal_equations(data);
    struct solution solution = {0};
    double *work = must_calloc(normal.num, sizeof *work);

    for (int pass = 0; pass < PASSES_MAX; pass++) {
        iterate_biases(data, &segments, reference, &normal);
        if (!leave_out_misfit_segments(&segments)) {
            break;
        }
    }
    solution.radar_plots = must_calloc(data->num_radars + 1, sizeof *solution.radar_plots);
    solution.sigma = must_calloc(normal.num + 1, sizeof *solution.sigma);
    summarise_segments(&segments, &solution);
    for (size_t i = 0; i < normal.num; i++) {
        solution.sigma[i] = solution.misfit * unit[i % NUM_REGISTER_KINDS] *
                            sqrt(cholesky_inverse_diagonal(normal.matrix, normal.num, i, work));
    }
    solution.sigma[reference * NUM_REGISTER_KINDS + REGISTER_TIME] = 0.0;
    free(work);
    free(normal.matrix);
    free(normal.right);
    segments_free(&segments);
    return solution;
}

void bias_solution_free(struct solution *solution)
{
    free(solution->radar_plots);
    free(solution->sigma);
}
