/* SPDX-License-Identifier: MIT */
/*
 * A slope seen from a place as a measurement of the reference filter (dense_filter.h), in metres of
 * height.
 */
#ifndef RHOTRACK_TESTS_DENSE_FILTER_SLOPE_MEASUREMENT_H
#define RHOTRACK_TESTS_DENSE_FILTER_SLOPE_MEASUREMENT_H

#include "dense_filter.h"
#include "rhotrack/detail/measurement.h"

/* Height of a state above the line of sight that has the slope. */
static inline double dense_height_over_line(const double x[DENSE], const struct rho_slope *slope)
{
    const double range = hypot(x[0] - (double)slope->x_m, x[1] - (double)slope->y_m);

    return x[2] - (double)slope->z_m - (double)slope->value * range;
}

/* Its derivative from central differences a metre away, and two metres, by Richardson. */
static inline double dense_height_derivative(const double x[DENSE], const struct rho_slope *slope,
                                             int element)
{
    double by[2];

    for (int k = 0; k < 2; ++k) {
        double up[DENSE], down[DENSE];

        memcpy(up, x, sizeof up);
        memcpy(down, x, sizeof down);
        up[element] += k + 1.0;
        down[element] -= k + 1.0;
        by[k] = (dense_height_over_line(up, slope) - dense_height_over_line(down, slope)) /
                (2.0 * (k + 1.0));
    }
    return (4.0 * by[0] - by[1]) / 3.0;
}

/*
 * The noise is the slope's times the ground range, whose mean square is that of the estimate and
 * the variance along the line of sight.
 */
static inline struct dense_measurement dense_slope(const struct dense *d,
                                                   const struct rho_slope *slope)
{
    struct dense_measurement m = {.num_rows = 1, .y = {-dense_height_over_line(d->x, slope)}};
    const double to[2] = {d->x[0] - (double)slope->x_m, d->x[1] - (double)slope->y_m};
    const double range = hypot(to[0], to[1]);
    double range2 = range * range;

    for (int i = 0; i < DENSE; ++i) {
        m.h[0][i] = dense_height_derivative(d->x, slope, i);
    }
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            range2 += to[i] / range * to[j] / range * d->p[i][j];
        }
    }
    m.r[0][0] = (double)slope->sigma * (double)slope->sigma * range2;
    return m;
}

/* Variance of the innovation. */
static inline double dense_innovation_variance(const struct dense *d,
                                               const struct dense_measurement *m)
{
    double sum = m->r[0][0];

    for (int i = 0; i < DENSE; ++i) {
        for (int j = 0; j < DENSE; ++j) {
            sum += m->h[0][i] * m->h[0][j] * d->p[i][j];
        }
    }
    return sum;
}

#endif
