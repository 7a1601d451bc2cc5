/* SPDX-License-Identifier: MIT */
/*
 * Fit of a straight track through plots, and its score, as reference in double precision: full
 * covariances of plots, normal equations. The score is the log-likelihood ratio of a target to
 * clutter.
 */
#ifndef RHOTRACK_TESTS_STRAIGHT_FIT_H
#define RHOTRACK_TESTS_STRAIGHT_FIT_H

#include <math.h>
#include <string.h>

#define STRAIGHT                                                                                   \
    6 /* number of unknowns: place and velocity in x, y, z; z stays 0 if heights do not count */

/* One plot, t_s after the time of the fit. */
struct straight_plot {
    double t_s, at_m[3], sensor_m[3], sigma_m[3]; /* sigmas along, across, up */
    double rate_mps, sigma_rate_mps;
    int has_z, has_rate;
};

struct straight_fit {
    int axes; /* 3 if at least two plots have heights */
    double state[STRAIGHT];
    double normal[STRAIGHT][STRAIGHT];
    double chi2, log_det_noise;
    int rows, heights, rates;
};

/*
 * Inverts the leading n x n by Gauss-Jordan without pivoting, as s is positive definite; returns
 * the determinant.
 */
static inline double straight_invert(int n, double s[STRAIGHT][STRAIGHT])
{
    double determinant = 1.0;
    for (int k = 0; k < n; k++) {
        double pivot = s[k][k];
        determinant *= pivot;
        s[k][k] = 1.0;
        for (int j = 0; j < n; j++) {
            s[k][j] /= pivot;
        }
        for (int i = 0; i < n; i++) {
            double factor = s[i][k];
            if (i == k) {
                continue;
            }
            s[i][k] = 0.0;
            for (int j = 0; j < n; j++) {
                s[i][j] -= factor * s[k][j];
            }
        }
    }
    return determinant;
}

/* A plot's noise covariance in x, y and, if has_z, z. */
static inline void straight_noise(const struct straight_plot *plot, int has_z,
                                  double r[STRAIGHT][STRAIGHT])
{
    double dx = plot->at_m[0] - plot->sensor_m[0], dy = plot->at_m[1] - plot->sensor_m[1];
    double dz = has_z ? plot->at_m[2] - plot->sensor_m[2] : 0.0;
    double a = atan2(dy, dx), e = atan2(dz, hypot(dx, dy));
    const double axis[3][3] = {{cos(e) * cos(a), cos(e) * sin(a), sin(e)},
                               {-sin(a), cos(a), 0.0},
                               {-sin(e) * cos(a), -sin(e) * sin(a), cos(e)}};
    memset(r, 0, sizeof(double[STRAIGHT][STRAIGHT]));
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < (has_z ? 3 : 2); k++) {
                r[i][j] += pow(plot->sigma_m[k], 2) * axis[k][i] * axis[k][j];
            }
        }
    }
}

/* Rows of the normal equations from a place or a range rate: design h, residuals y, weights w. */
struct straight_rows {
    int count;
    double h[3][STRAIGHT], y[3], w[STRAIGHT][STRAIGHT], log_det;
};

static inline struct straight_rows straight_place_rows(const struct straight_fit *fit,
                                                       const struct straight_plot *plot)
{
    int has_z = plot->has_z && fit->axes == 3;
    struct straight_rows rows = {.count = has_z ? 3 : 2};
    straight_noise(plot, has_z, rows.w);
    rows.log_det = log(straight_invert(rows.count, rows.w));
    for (int i = 0; i < rows.count; i++) {
        rows.h[i][i] = 1.0;
        rows.h[i][i + 3] = plot->t_s;
        rows.y[i] = plot->at_m[i] - fit->state[i] - plot->t_s * fit->state[i + 3];
    }
    return rows;
}

static inline double straight_rate(const struct straight_fit *fit, const struct straight_plot *plot,
                                   const double state[STRAIGHT])
{
    double range2 = 0.0, product = 0.0;
    for (int i = 0; i < fit->axes; i++) {
        double d = state[i] + plot->t_s * state[i + 3] - plot->sensor_m[i];
        range2 += d * d;
        product += d * state[i + 3];
    }
    return product / sqrt(range2);
}

/*
 * Row of a range rate, linearised at `point` by differences, so that no derivative can be wrong as
 * in the library.
 */
static inline struct straight_rows straight_rate_rows(const struct straight_fit *fit,
                                                      const struct straight_plot *plot,
                                                      const double point[STRAIGHT])
{
    struct straight_rows rows = {.count = 1, .log_det = 2.0 * log(plot->sigma_rate_mps)};
    rows.w[0][0] = pow(plot->sigma_rate_mps, -2);
    rows.y[0] = plot->rate_mps - straight_rate(fit, plot, point);
    for (int i = 0; i < STRAIGHT; i++) {
        double low[STRAIGHT], high[STRAIGHT];
        memcpy(low, point, sizeof low);
        memcpy(high, point, sizeof high);
        low[i] -= 0.01;
        high[i] += 0.01;
        rows.h[0][i] = (straight_rate(fit, plot, high) - straight_rate(fit, plot, low)) / 0.02;
        rows.y[0] -= rows.h[0][i] * (fit->state[i] - point[i]);
    }
    return rows;
}

/* Adds rows to the normal equations, to chi-square and to the log determinant of the noise. */
static inline void straight_add_rows(struct straight_fit *fit, const struct straight_rows *rows,
                                     double right[STRAIGHT])
{
    fit->rows += rows->count;
    fit->log_det_noise += rows->log_det;
    for (int a = 0; a < rows->count; a++) {
        for (int b = 0; b < rows->count; b++) {
            fit->chi2 += rows->y[a] * rows->w[a][b] * rows->y[b];
            for (int i = 0; i < STRAIGHT; i++) {
                right[i] += rows->h[a][i] * rows->w[a][b] * rows->y[b];
                for (int j = 0; j < STRAIGHT; j++) {
                    fit->normal[i][j] += rows->h[a][i] * rows->w[a][b] * rows->h[b][j];
                }
            }
        }
    }
}

/* Sums all rows about the fit's state; range rates are linearised at `point`, NULL: left out. */
static inline void straight_sum_rows(struct straight_fit *fit, const struct straight_plot *of,
                                     int n, const double *point, double right[STRAIGHT])
{
    memset(fit->normal, 0, sizeof fit->normal);
    memset(right, 0, sizeof(double[STRAIGHT]));
    fit->chi2 = fit->log_det_noise = 0.0;
    fit->rows = fit->heights = fit->rates = 0;
    for (int k = 0; k < n; k++) {
        struct straight_rows rows = straight_place_rows(fit, &of[k]);
        straight_add_rows(fit, &rows, right);
        fit->heights += rows.count == 3;
        if (point && of[k].has_rate) {
            rows = straight_rate_rows(fit, &of[k], point);
            straight_add_rows(fit, &rows, right);
            fit->rates++;
        }
    }
}

/* Solves for x, y, vx, vy or for all six; returns the log determinant of the normal equations. */
static inline double straight_solve(struct straight_fit *fit, const double right[STRAIGHT])
{
    static const int level[4] = {0, 1, 3, 4}, all[6] = {0, 1, 2, 3, 4, 5};
    const int *used = fit->axes == 3 ? all : level;
    int n = 2 * fit->axes;
    double s[STRAIGHT][STRAIGHT];
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            s[i][j] = fit->normal[used[i]][used[j]];
        }
    }
    double determinant = straight_invert(n, s);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            fit->state[used[i]] += s[i][j] * right[used[j]];
        }
    }
    return log(determinant);
}

/*
 * Fits the places, then places and range rates, linearised at the first fit. log_fisher gets ln det
 * of the normal equations.
 */
static inline struct straight_fit straight_fit_through(const struct straight_plot *of, int n,
                                                       double *log_fisher)
{
    struct straight_fit fit = {0};
    double right[STRAIGHT], point[STRAIGHT];
    int heights = 0;
    for (int k = 0; k < n; k++) {
        heights += of[k].has_z;
    }
    fit.axes = heights >= 2 ? 3 : 2;
    memcpy(fit.state, of[n / 2].at_m, sizeof of[0].at_m);
    fit.state[2] *= fit.axes == 3;
    straight_sum_rows(&fit, of, n, NULL, right);
    straight_solve(&fit, right);
    memcpy(point, fit.state, sizeof point);
    straight_sum_rows(&fit, of, n, point, right);
    *log_fisher = straight_solve(&fit, right);
    straight_sum_rows(&fit, of, n, point, right); /* the residual of what was found */
    return fit;
}

/* residuals about the final state */
struct straight_world {
    double area_m2, v_min_mps, v_max_mps, pd, clutter_per_m2;
    int misses;
};

#define STRAIGHT_HEIGHT_M 20000.0

static inline double straight_score(const struct straight_world *world,
                                    const struct straight_fit *fit, int hits, double log_fisher)
{
    double tau = 2.0 * 3.14159265358979323846;
    double births =
        0.5 / (world->area_m2 * 0.5 * tau * (pow(world->v_max_mps, 2) - pow(world->v_min_mps, 2)));
    /* height uniform in 20 km, climb or descent up to v_max / 2 */
    births /= fit->axes == 3 ? STRAIGHT_HEIGHT_M * world->v_max_mps : 1.0;
    double clutter = hits * log(world->clutter_per_m2) - fit->heights * log(STRAIGHT_HEIGHT_M) -
                     fit->rates * log(2.0 * world->v_max_mps);
    double target = hits * log(world->pd) + world->misses * log(1.0 - world->pd) + log(births) -
                    0.5 * (fit->rows * log(tau) + fit->log_det_noise + fit->chi2) +
                    0.5 * (2.0 * fit->axes * log(tau) - log_fisher);
    return target - clutter;
}

#endif
