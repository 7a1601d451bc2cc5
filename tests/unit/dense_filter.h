/* SPDX-License-Identifier: MIT */
/*
 * A Kalman filter in double precision as reference: full 6 x 6 matrices, vector updates with an
 * inverse and in Joseph's form. The order of the packed triangle is all that it shares with the
 * library.
 */
#ifndef RHOTRACK_TESTS_DENSE_FILTER_H
#define RHOTRACK_TESTS_DENSE_FILTER_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define DENSE 6
#define DENSE_ROWS 3 /* largest number of rows of one update */

struct dense {
    double x[DENSE], p[DENSE][DENSE];
};

/* A measurement h x with noise covariance r; y is the innovation, measured minus predicted. */
struct dense_measurement {
    int num_rows;
    double h[DENSE_ROWS][DENSE], y[DENSE_ROWS], r[DENSE_ROWS][DENSE_ROWS];
};

/* --- random numbers ------------------------------------------------------------------------ */

static uint64_t dense_seed = 1;

static inline double uniform(double from, double to)
{
    dense_seed = dense_seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(dense_seed >> 11) / 9007199254740992.0;
}

static inline double normal(void)
{
    const double radius = sqrt(-2.0 * log(1.0 - uniform(0.0, 1.0)));

    return radius * cos(uniform(0.0, 6.283185307179586));
}

/* Draws a positive definite covariance: correlations up to 0.99, sigmas of 1 to 10^decades. */
static inline void random_covariance(float p[21], double decades)
{
    double w[DENSE][DENSE], scale[DENSE];

    for (int i = 0; i < DENSE; ++i) {
        scale[i] = pow(10.0, uniform(0.0, decades));
        for (int k = 0; k < DENSE; ++k) {
            w[i][k] = normal();
        }
    }
    for (int i = 0; i < DENSE; ++i) {
        for (int j = 0; j <= i; ++j) {
            double sum = i == j ? 0.05 : 0.0;

            for (int k = 0; k < DENSE; ++k) {
                sum += w[i][k] * w[j][k];
            }
            p[i * (i + 1) / 2 + j] = (float)(sum * scale[i] * scale[j]);
        }
    }
}

/* --- the filter ---------------------------------------------------------------------------- */

static inline struct dense dense_of(const float x[6], const float p[21])
{
    struct dense d;

    for (int i = 0; i < DENSE; ++i) {
        d.x[i] = x[i];
        for (int j = 0; j <= i; ++j) {
            d.p[i][j] = d.p[j][i] = p[i * (i + 1) / 2 + j];
        }
    }
    return d;
}

/* p := f p f^T */
static inline void dense_transform(double p[DENSE][DENSE], double f[DENSE][DENSE])
{
    double half[DENSE][DENSE] = {{0.0}}, full[DENSE][DENSE] = {{0.0}};

    for (int i = 0; i < DENSE; ++i) {
        for (int j = 0; j < DENSE; ++j) {
            for (int k = 0; k < DENSE; ++k) {
                half[i][j] += f[i][k] * p[k][j];
            }
        }
    }
    for (int i = 0; i < DENSE; ++i) {
        for (int j = 0; j < DENSE; ++j) {
            for (int k = 0; k < DENSE; ++k) {
                full[i][j] += half[i][k] * f[j][k];
            }
        }
    }
    memcpy(p, full, sizeof full);
}

static inline void dense_predict(struct dense *d, double dt, double density)
{
    double f[DENSE][DENSE] = {{0.0}};

    for (int i = 0; i < DENSE; ++i) {
        f[i][i] = 1.0;
    }
    for (int axis = 0; axis < 3; ++axis) {
        f[axis][axis + 3] = dt;
        d->x[axis] += dt * d->x[axis + 3];
    }
    dense_transform(d->p, f);
    for (int axis = 0; axis < 3; ++axis) {
        if (d->p[axis][axis] > 0.0) {
            d->p[axis][axis] += density * dt * dt * dt / 3.0;
            d->p[axis][axis + 3] += density * dt * dt / 2.0;
            d->p[axis + 3][axis] += density * dt * dt / 2.0;
            d->p[axis + 3][axis + 3] += density * dt;
        }
    }
}

/* Inverts by Gauss-Jordan without pivoting, as s is positive definite. */
static inline void dense_invert(int n, double s[DENSE_ROWS][DENSE_ROWS])
{
    for (int k = 0; k < n; ++k) {
        const double pivot = s[k][k];

        s[k][k] = 1.0;
        for (int j = 0; j < n; ++j) {
            s[k][j] /= pivot;
        }
        for (int i = 0; i < n; ++i) {
            const double factor = s[i][k];

            if (i == k) {
                continue;
            }
            s[i][k] = 0.0;
            for (int j = 0; j < n; ++j) {
                s[i][j] -= factor * s[k][j];
            }
        }
    }
}

/* Computes p h^T and the inverse of the innovation covariance h p h^T + r. */
static inline void dense_innovation_inverse(const struct dense *d,
                                            const struct dense_measurement *m,
                                            double ph[DENSE][DENSE_ROWS],
                                            double inverse[DENSE_ROWS][DENSE_ROWS])
{
    for (int a = 0; a < m->num_rows; ++a) {
        for (int i = 0; i < DENSE; ++i) {
            ph[i][a] = 0.0;
            for (int k = 0; k < DENSE; ++k) {
                ph[i][a] += d->p[i][k] * m->h[a][k];
            }
        }
    }
    for (int a = 0; a < m->num_rows; ++a) {
        for (int b = 0; b < m->num_rows; ++b) {
            inverse[a][b] = m->r[a][b];
            for (int k = 0; k < DENSE; ++k) {
                inverse[a][b] += m->h[a][k] * ph[k][b];
            }
        }
    }
    dense_invert(m->num_rows, inverse);
}

/* Covariance update in Joseph's form: p := (1 - k h) p (1 - k h)^T + k r k^T. */
static inline void dense_update_covariance(struct dense *d, const struct dense_measurement *m,
                                           double gain[DENSE][DENSE_ROWS])
{
    double rest[DENSE][DENSE];

    for (int i = 0; i < DENSE; ++i) {
        for (int j = 0; j < DENSE; ++j) {
            rest[i][j] = i == j ? 1.0 : 0.0;
            for (int a = 0; a < m->num_rows; ++a) {
                rest[i][j] -= gain[i][a] * m->h[a][j];
            }
        }
    }
    dense_transform(d->p, rest);
    for (int i = 0; i < DENSE; ++i) {
        for (int j = 0; j < DENSE; ++j) {
            for (int a = 0; a < m->num_rows * m->num_rows; ++a) {
                const int row = a / m->num_rows, column = a % m->num_rows;

                d->p[i][j] += gain[i][row] * m->r[row][column] * gain[j][column];
            }
        }
    }
}

/* Updates the estimate; returns the normalised innovation squared. */
static inline double dense_update(struct dense *d, const struct dense_measurement *m)
{
    double ph[DENSE][DENSE_ROWS], inverse[DENSE_ROWS][DENSE_ROWS], gain[DENSE][DENSE_ROWS];
    double nis = 0.0;

    dense_innovation_inverse(d, m, ph, inverse);
    for (int i = 0; i < DENSE; ++i) {
        for (int b = 0; b < m->num_rows; ++b) {
            gain[i][b] = 0.0;
            for (int a = 0; a < m->num_rows; ++a) {
                gain[i][b] += ph[i][a] * inverse[a][b];
            }
            d->x[i] += gain[i][b] * m->y[b];
        }
    }
    for (int a = 0; a < m->num_rows; ++a) {
        for (int b = 0; b < m->num_rows; ++b) {
            nis += m->y[a] * inverse[a][b] * m->y[b];
        }
    }
    dense_update_covariance(d, m, gain);
    return nis;
}

static inline struct dense_measurement dense_row_measurement(const float row[6], double y,
                                                             double variance)
{
    struct dense_measurement m = {.num_rows = 1, .y = {y}, .r = {{variance}}};

    for (int i = 0; i < DENSE; ++i) {
        m.h[0][i] = row[i];
    }
    return m;
}

/*
 * Range rate seen from `from`, linearised at the estimate; axes is 2 if heights are unknown. The
 * linearisation error counts as noise: (v s^2 / range^2)^2 / 2, where s^2 is the place's variance.
 */
static inline struct dense_measurement dense_range_rate(const struct dense *d, const double from[3],
                                                        int axes, double rate, double variance)
{
    struct dense_measurement m = {.num_rows = 1, .r = {{variance}}};
    double range2 = 0.0, product = 0.0, spread2 = 0.0, speed2 = 0.0;

    for (int i = 0; i < axes; ++i) {
        range2 += pow(d->x[i] - from[i], 2);
        product += (d->x[i] - from[i]) * d->x[i + 3];
        spread2 += d->p[i][i];
        speed2 += d->x[i + 3] * d->x[i + 3];
    }
    const double range = sqrt(range2);
    for (int i = 0; i < axes; ++i) {
        m.h[0][i + 3] = (d->x[i] - from[i]) / range;
        m.h[0][i] = d->x[i + 3] / range - product * (d->x[i] - from[i]) / (range * range2);
    }
    m.y[0] = rate - product / range;
    m.r[0][0] += 0.5 * speed2 * pow(spread2 / range2, 2);
    return m;
}

/* --- places -------------------------------------------------------------------------------- */

/* A plot's place and its noise covariance in x, y, z. */
struct dense_place {
    double at[3], r[3][3];
};

/*
 * Place with noise variances along the line of sight from `sensor` to `at`, across it horizontally,
 * and at right angles to both; axes is 2 if heights are unknown.
 */
static inline struct dense_place dense_place_of(const double sensor[3], const double at[3],
                                                int axes, const double variance[3])
{
    const double d[3] = {at[0] - sensor[0], at[1] - sensor[1], axes == 3 ? at[2] - sensor[2] : 0.0};
    const double ground = hypot(d[0], d[1]), range = hypot(ground, d[2]);
    const double axis[3][3] = {
        {d[0] / range, d[1] / range, d[2] / range},
        {-d[1] / ground, d[0] / ground, 0.0},
        {-d[2] * d[0] / range / ground, -d[2] * d[1] / range / ground, ground / range}};
    struct dense_place place = {.r = {{0.0}}};

    for (int i = 0; i < axes; ++i) {
        place.at[i] = at[i];
        for (int j = 0; j < axes; ++j) {
            for (int k = 0; k < axes; ++k) {
                place.r[i][j] += variance[k] * axis[k][i] * axis[k][j];
            }
        }
    }
    return place;
}

/* Updates with axes `from` to `to` - 1 of a place, all at once. */
static inline void dense_update_place(struct dense *d, const struct dense_place *place, int from,
                                      int to)
{
    struct dense_measurement m = {.num_rows = to - from};

    for (int a = from; a < to; ++a) {
        m.h[a - from][a] = 1.0;
        m.y[a - from] = place->at[a] - d->x[a];
        for (int b = from; b < to; ++b) {
            m.r[a - from][b - from] = place->r[a][b];
        }
    }
    dense_update(d, &m);
}

/* Opens the closed axes `from` to `to` - 1 with the place and its noise, and velocities of 0. */
static inline void dense_open_place(struct dense *d, const struct dense_place *place, int from,
                                    int to, double velocity_variance)
{
    for (int a = from; a < to; ++a) {
        d->x[a] = place->at[a];
        d->x[a + 3] = 0.0;
        d->p[a + 3][a + 3] = velocity_variance;
        for (int b = from; b < to; ++b) {
            d->p[a][b] = place->r[a][b];
        }
    }
}

/* --- comparison ------------------------------------------------------------------------------ */

#define DENSE_ROUNDING 5e-7 /* relative rounding of a state: eight units of float */

/*
 * Tolerances are in sigmas of `scale`, and in products of two sigmas for covariances; `scale` is
 * mostly the estimate before, as rounding errors are proportional to it.
 */
static inline void assert_near_dense(const float x[6], const float p[21],
                                     const struct dense *expected, const struct dense *scale,
                                     double relative)
{
    for (int i = 0; i < DENSE; ++i) {
        const double sigma = sqrt(scale->p[i][i]);

        assert_float_equal(x[i], expected->x[i],
                           relative * sigma + DENSE_ROUNDING * fabs(expected->x[i]));
        for (int j = 0; j <= i; ++j) {
            assert_float_equal(p[i * (i + 1) / 2 + j], expected->p[i][j],
                               relative * sigma * sqrt(scale->p[j][j]));
        }
    }
}

#endif
