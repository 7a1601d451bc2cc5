/* SPDX-License-Identifier: MIT */
/*
 * A bearing from a place as a measurement of the reference filter (dense_filter.h), in metres
 * across the line of sight.
 */
#ifndef RHOTRACK_TESTS_DENSE_FILTER_BEARING_MEASUREMENT_H
#define RHOTRACK_TESTS_DENSE_FILTER_BEARING_MEASUREMENT_H

#include "dense_filter.h"

#define DENSE_PI 3.14159265358979323846

/*
 * The bearing of a state; below its derivative by x or y from central differences two metres apart.
 */
static inline double dense_bearing_of(const double x[DENSE], const double place[2])
{
    return atan2(x[1] - place[1], x[0] - place[0]);
}

static inline double dense_bearing_derivative(const struct dense *d, const double place[2],
                                              int axis)
{
    struct dense up = *d, down = *d;

    up.x[axis] += 1.0;
    down.x[axis] -= 1.0;
    return remainder(dense_bearing_of(up.x, place) - dense_bearing_of(down.x, place),
                     2.0 * DENSE_PI) /
           2.0;
}

/*
 * Variance of the error of linearising range times the bearing: for errors a along and c across the
 * line of sight this error is -a c / range, of variance (var a var c + cov^2) / range^2.
 */
static inline double dense_bearing_nonlinearity_variance_m2(const struct dense *d, double bearing,
                                                            double range)
{
    const double along[2] = {cos(bearing), sin(bearing)}, across[2] = {-along[1], along[0]};
    double aa = 0.0, cc = 0.0, ac = 0.0;

    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            aa += along[i] * along[j] * d->p[i][j];
            cc += across[i] * across[j] * d->p[i][j];
            ac += along[i] * across[j] * d->p[i][j];
        }
    }
    return (aa * cc + ac * ac) / (range * range);
}

static inline struct dense_measurement dense_bearing(const struct dense *d, const double place[2],
                                                     double bearing, double sigma)
{
    const double range = hypot(d->x[0] - place[0], d->x[1] - place[1]);
    const double predicted = dense_bearing_of(d->x, place);
    struct dense_measurement m = {.num_rows = 1};

    for (int axis = 0; axis < 2; ++axis) {
        m.h[0][axis] = range * dense_bearing_derivative(d, place, axis);
    }
    m.y[0] = range * remainder(bearing - predicted, 2.0 * DENSE_PI);
    m.r[0][0] =
        range * range * sigma * sigma + dense_bearing_nonlinearity_variance_m2(d, predicted, range);
    return m;
}

#endif
