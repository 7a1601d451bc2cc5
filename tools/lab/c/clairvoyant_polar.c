/* SPDX-License-Identifier: MIT */
#include "clairvoyant_polar.h"

#include <math.h>

#define PI 3.141592653589793
#define LN_TWO_PI 1.8378770664093453
#define TARGETS_EXPECTED 0.5 /* in the area, before any plot: as the initiator takes it */
#define UNKNOWNS 4           /* x, y at the middle, vx, vy */
#define ROWS_MAX (3 * CLAIRVOYANT_PLOTS_MAX)

struct rows {
    size_t count;
    double row[ROWS_MAX][UNKNOWNS], value[ROWS_MAX], variance[ROWS_MAX];
};

struct solution {
    double unknown[UNKNOWNS];
    double log_det; /* of the normal equations */
};

static void add_row(struct rows *rows, double ux, double uy, double t_s, double value,
                    double variance)
{
    double *row = rows->row[rows->count];
    row[0] = ux;
    row[1] = uy;
    row[2] = t_s * ux;
    row[3] = t_s * uy;
    rows->value[rows->count] = value;
    rows->variance[rows->count++] = variance;
}

static void add_place(struct rows *rows, const struct scenario_radar *radar, double t_s,
                      const struct simulated_plot *plot)
{
    double ca = cos(plot->azimuth_rad), sa = sin(plot->azimuth_rad);
    double across_m = plot->range_m * radar->sigma_azimuth_rad;
    add_row(rows, ca, sa, t_s, plot->range_m, radar->sigma_range_m * radar->sigma_range_m);
    add_row(rows, -sa, ca, t_s, 0.0, across_m * across_m);
}

static void add_range_rate(struct rows *rows, const struct scenario_radar *radar, double t_s,
                           const struct simulated_plot *plot, const double at[UNKNOWNS])
{
    double x_m = at[0] + t_s * at[2], y_m = at[1] + t_s * at[3], range_m = hypot(x_m, y_m);
    double ux = x_m / range_m, uy = y_m / range_m, rate_mps = ux * at[2] + uy * at[3];
    double by_x = (at[2] - rate_mps * ux) / range_m, by_y = (at[3] - rate_mps * uy) / range_m;
    double *row = rows->row[rows->count];
    double value = plot->range_rate_mps - rate_mps;
    row[0] = by_x;
    row[1] = by_y;
    row[2] = ux + t_s * by_x;
    row[3] = uy + t_s * by_y;
    for (int i = 0; i < UNKNOWNS; i++) {
        value += row[i] * at[i];
    }
    rows->value[rows->count] = value;
    rows->variance[rows->count++] = radar->sigma_range_rate_mps * radar->sigma_range_rate_mps;
}

/* Gauss's elimination with pivots on the diagonal: the matrix is positive definite. */
static struct solution solve(const struct rows *rows)
{
    double normal[UNKNOWNS][UNKNOWNS + 1] = {{0.0}};
    struct solution solution = {.log_det = 0.0};
    for (size_t k = 0; k < rows->count; k++) {
        for (int i = 0; i < UNKNOWNS; i++) {
            for (int j = 0; j < UNKNOWNS; j++) {
                normal[i][j] += rows->row[k][i] * rows->row[k][j] / rows->variance[k];
            }
            normal[i][UNKNOWNS] += rows->row[k][i] * rows->value[k] / rows->variance[k];
        }
    }
    for (int pivot = 0; pivot < UNKNOWNS; pivot++) {
        solution.log_det += log(normal[pivot][pivot]);
        for (int i = 0; i < UNKNOWNS; i++) {
            double factor = i == pivot ? 0.0 : normal[i][pivot] / normal[pivot][pivot];
            for (int j = pivot; j <= UNKNOWNS; j++) {
                normal[i][j] -= factor * normal[pivot][j];
            }
        }
    }
    for (int i = 0; i < UNKNOWNS; i++) {
        solution.unknown[i] = normal[i][UNKNOWNS] / normal[i][i];
    }
    return solution;
}

static double residual_chi2(const struct rows *rows, const struct solution *solution)
{
    double chi2 = 0.0;
    for (size_t k = 0; k < rows->count; k++) {
        double residual = rows->value[k];
        for (int i = 0; i < UNKNOWNS; i++) {
            residual -= rows->row[k][i] * solution->unknown[i];
        }
        chi2 += residual * residual / rows->variance[k];
    }
    return chi2;
}

/* ln P_D over the clutter's density, at each plot; misses; births. */
static double log_prior(const struct clairvoyant_polar *of, const struct simulated_plot *plots,
                        size_t n)
{
    const struct clairvoyant_model *model = of->model;
    double depth_m = of->radar->range_max_m - of->radar->range_min_m;
    double speeds_m2ps2 =
        PI * (model->v_max_mps * model->v_max_mps - model->v_min_mps * model->v_min_mps);
    double sum = (double)(model->num_scans - n) * log(1.0 - model->pd) -
                 log(model->area_m2 * speeds_m2ps2) + log(TARGETS_EXPECTED);
    for (size_t i = 0; i < n; i++) {
        double density = of->clutter_mean / (2.0 * PI * plots[i].range_m * depth_m);
        sum += log(model->pd / density);
        sum += of->has_range_rate ? log(2.0 * model->v_max_mps) : 0.0;
    }
    return sum;
}

struct clairvoyant_fit clairvoyant_polar_fit(const struct clairvoyant_polar *of,
                                             const double *times_s,
                                             const struct simulated_plot *plots, size_t num_plots)
{
    struct rows rows = {.count = 0};
    double middle_s = 0.5 * (times_s[0] + times_s[num_plots - 1]), log_noise = 0.0;
    for (size_t i = 0; i < num_plots; i++) {
        add_place(&rows, of->radar, times_s[i] - middle_s, &plots[i]);
    }
    struct solution solution = solve(&rows);
    for (size_t i = 0; i < num_plots && of->has_range_rate; i++) {
        add_range_rate(&rows, of->radar, times_s[i] - middle_s, &plots[i], solution.unknown);
    }
    solution = solve(&rows);
    struct clairvoyant_fit fit = {.vx_mps = solution.unknown[2],
                                  .vy_mps = solution.unknown[3],
                                  .chi2 = residual_chi2(&rows, &solution)};
    for (size_t k = 0; k < rows.count; k++) {
        log_noise += log(rows.variance[k]);
    }
    fit.score_nat =
        log_prior(of, plots, num_plots) - 0.5 * ((double)(rows.count - UNKNOWNS) * LN_TWO_PI +
                                                 log_noise + solution.log_det + fit.chi2);
    return fit;
}
