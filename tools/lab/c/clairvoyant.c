/* SPDX-License-Identifier: MIT */
#include "clairvoyant.h"

#include <math.h>

#define MAX CLAIRVOYANT_PLOTS_MAX
#define LN_TWO_PI 1.8378770664093453
#define TARGETS_EXPECTED 0.5 /* in the area, before any plot: as the initiator takes it */
#define PI 3.141592653589793

/*
 * Position at time t of the unit velocity changes at the start of every interval before: half at
 * once, then linear.
 */
static double reach_s(double t_s, double change_t_s, double interval_s)
{
    double since_s = t_s - change_t_s;
    return since_s < interval_s - 1e-9 ? 0.0 : since_s - interval_s / 2.0;
}

static double covariance(const struct clairvoyant_model *model, double ta_s, double tb_s)
{
    double change_mps = model->process_noise_mps2 * model->interval_s;
    double sum = 0.0;
    for (size_t i = 0; i + 1 < model->num_scans; i++) {
        double change_t_s = (double)i * model->interval_s;
        sum += reach_s(ta_s, change_t_s, model->interval_s) *
               reach_s(tb_s, change_t_s, model->interval_s);
    }
    return change_mps * change_mps * sum + (ta_s == tb_s ? model->sigma_m * model->sigma_m : 0.0);
}

/* Cholesky factor of the plots' covariance along one axis; returns ln det. */
static double factor(const struct clairvoyant_model *model, const struct clairvoyant_plot *plots,
                     size_t n, double l[MAX][MAX])
{
    double log_det = 0.0;
    for (size_t i = 0; i < n; i++) {
        for (size_t j = 0; j <= i; j++) {
            double sum = covariance(model, plots[i].t_s, plots[j].t_s);
            for (size_t k = 0; k < j; k++) {
                sum -= l[i][k] * l[j][k];
            }
            l[i][j] = i == j ? sqrt(sum) : sum / l[j][j];
        }
        log_det += 2.0 * log(l[i][i]);
    }
    return log_det;
}

static void whiten(double l[MAX][MAX], size_t n, double v[MAX])
{
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < i; k++) {
            v[i] -= l[i][k] * v[k];
        }
        v[i] /= l[i][i];
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

struct line_columns {
    double one[MAX], time[MAX]; /* whitened */
    double det;                 /* of the normal equations */
};

/* Velocity and chi-square of one axis. */
static double fit_axis(const struct line_columns *columns, size_t n, const double *z,
                       double *velocity)
{
    double s11 = dot(columns->one, columns->one, n), s12 = dot(columns->one, columns->time, n);
    double s22 = dot(columns->time, columns->time, n);
    double z1 = dot(columns->one, z, n), z2 = dot(columns->time, z, n);
    double place = (s22 * z1 - s12 * z2) / columns->det;
    double chi2 = 0.0;
    *velocity = (s11 * z2 - s12 * z1) / columns->det;
    for (size_t i = 0; i < n; i++) {
        double residual = z[i] - place * columns->one[i] - *velocity * columns->time[i];
        chi2 += residual * residual;
    }
    return chi2;
}

static double score(const struct clairvoyant_model *model, const struct clairvoyant_plot *plots,
                    size_t n, double log_det, double log_det_normal, double chi2)
{
    double speeds_m2ps2 =
        PI * (model->v_max_mps * model->v_max_mps - model->v_min_mps * model->v_min_mps);
    double sum = ((double)(model->num_scans - n)) * log(1.0 - model->pd) -
                 log(model->area_m2 * speeds_m2ps2) + log(TARGETS_EXPECTED);
    for (size_t i = 0; i < n; i++) {
        sum += log(model->pd / plots[i].density_per_m2);
    }
    return sum - ((double)n - 2.0) * LN_TWO_PI - log_det - log_det_normal - chi2 / 2.0;
}

struct clairvoyant_fit clairvoyant_fit(const struct clairvoyant_model *model,
                                       const struct clairvoyant_plot *plots, size_t num_plots)
{
    double l[MAX][MAX], x[MAX], y[MAX];
    struct line_columns columns;
    struct clairvoyant_fit fit;
    for (size_t i = 0; i < num_plots; i++) {
        columns.one[i] = 1.0;
        columns.time[i] = plots[i].t_s;
        x[i] = plots[i].x_m - plots[0].x_m;
        y[i] = plots[i].y_m - plots[0].y_m;
    }
    double log_det = factor(model, plots, num_plots, l);
    whiten(l, num_plots, columns.one);
    whiten(l, num_plots, columns.time);
    whiten(l, num_plots, x);
    whiten(l, num_plots, y);
    columns.det =
        dot(columns.one, columns.one, num_plots) * dot(columns.time, columns.time, num_plots) -
        pow(dot(columns.one, columns.time, num_plots), 2.0);
    fit.chi2 = fit_axis(&columns, num_plots, x, &fit.vx_mps) +
               fit_axis(&columns, num_plots, y, &fit.vy_mps);
    fit.score_nat = score(model, plots, num_plots, log_det, log(columns.det), fit.chi2);
    return fit;
}
