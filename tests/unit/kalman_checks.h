/* SPDX-License-Identifier: MIT */
/* Shared by tests of the Kalman filter: a filter with open axes, and checks of its covariance. */
#ifndef RHOTRACK_TESTS_KALMAN_CHECKS_H
#define RHOTRACK_TESTS_KALMAN_CHECKS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rhotrack/detail/kalman.h"

#define STATES RHO_KALMAN_STATES
#define PACKED RHO_TRIANGLE(RHO_KALMAN_STATES)
#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define GUARD (-777.25f)

static inline void assert_changed_nothing(const struct rho_kalman *kalman,
                                          const struct rho_kalman *before)
{
    assert_memory_equal(kalman, before, sizeof *before);
}

/* Tries a Cholesky factorisation of the open elements in double precision. */
static inline int is_positive_definite(const struct rho_kalman *kalman)
{
    double l[STATES][STATES] = {{0.0}};

    for (int i = 0; i < STATES; ++i) {
        for (int j = 0; j <= i; ++j) {
            double rest = kalman->covariance[RHO_AT(i, j)];

            for (int k = 0; k < j; ++k) {
                rest -= l[i][k] * l[j][k];
            }
            if (i == j && kalman->covariance[RHO_AT(i, i)] == 0.0f) {
                continue;
            }
            if (i == j && !(rest > 0.0)) {
                return 0;
            }
            l[i][j] = i == j ? sqrt(rest) : (l[j][j] > 0.0 ? rest / l[j][j] : 0.0);
        }
    }
    return 1;
}

static inline void assert_finite_with_variances_in_limits(const struct rho_kalman *kalman)
{
    for (int i = 0; i < STATES; ++i) {
        const float variance = kalman->covariance[RHO_AT(i, i)];

        assert_true(isfinite(kalman->state[i]));
        assert_true(variance == 0.0f ||
                    (variance >= RHO_VARIANCE_MIN && variance <= RHO_VARIANCE_MAX));
    }
    for (int i = 0; i < PACKED; ++i) {
        assert_true(isfinite(kalman->covariance[i]));
    }
}

static inline struct rho_kalman opened_filter(int num_axes, float position_variance,
                                              float velocity_variance)
{
    struct rho_kalman kalman;

    rho_kalman_init(&kalman);
    for (int axis = 0; axis < num_axes; ++axis) {
        assert_int_equal(rho_kalman_open_axis(&kalman, axis, 100.0f * (float)(axis + 1),
                                              position_variance, velocity_variance),
                         RHO_OK);
    }
    return kalman;
}

/* Makes an axis one that was never opened. */
static inline void close_axis(struct rho_kalman *kalman, int axis)
{
    for (int i = 0; i < STATES; ++i) {
        kalman->covariance[RHO_AT(axis, i)] = kalman->covariance[RHO_AT(axis + 3, i)] = 0.0f;
    }
    kalman->state[axis] = kalman->state[axis + 3] = 0.0f;
}

#endif
