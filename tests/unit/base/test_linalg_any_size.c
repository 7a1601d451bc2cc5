/* SPDX-License-Identifier: MIT */
/*
 * Scalar updates and normalised innovations for states of 1 to 12 elements, compared with full
 * matrices in double precision.
 */
#include <float.h>
#include <string.h>

#include "dense_filter.h"
#include "kalman_checks.h"

/* Tolerance of updates, in sigmas of the estimate before. */
#define UPDATE_RELATIVE 4e-6 /* largest error seen: 1.2e-6 */

/* Tolerances of distances: with correlations of 0.99 they lose two or three digits. */
#define DISTANCE_RELATIVE 6e-5 /* largest error seen: 1.4e-5 */
#define LOG_DET_ABSOLUTE 1e-4  /* largest error seen: 2.4e-5 */

#define MOST RHO_LINALG_MAX
#define MOST_PACKED RHO_TRIANGLE(MOST)
#define CASES_OF_SIZE 300

struct sized {
    int n;
    float x[MOST], p[MOST_PACKED];
};

struct wide {
    double x[MOST], p[MOST][MOST];
};

/* --- reference in double precision ----------------------------------------------------------- */

/* Correlations of up to 0.99, sigmas of 1 to 1000; elements beyond n are GUARD. */
static struct sized random_estimate(int n)
{
    struct sized e = {.n = n};
    double w[MOST][MOST], scale[MOST];

    for (int i = 0; i < MOST; ++i) {
        e.x[i] = i < n ? (float)(100.0 * normal()) : GUARD;
        scale[i] = pow(10.0, uniform(0.0, 3.0));
        for (int k = 0; k < MOST; ++k) {
            w[i][k] = normal();
        }
    }
    for (int i = 0; i < MOST; ++i) {
        for (int j = 0; j <= i; ++j) {
            double sum = i == j ? 0.05 : 0.0;

            for (int k = 0; k < n; ++k) {
                sum += w[i][k] * w[j][k];
            }
            e.p[RHO_AT(i, j)] = i < n ? (float)(sum * scale[i] * scale[j]) : GUARD;
        }
    }
    return e;
}

static struct wide double_precision_of(const struct sized *e)
{
    struct wide d = {.x = {0.0}};

    for (int i = 0; i < e->n; ++i) {
        d.x[i] = e->x[i];
        for (int j = 0; j < e->n; ++j) {
            d.p[i][j] = e->p[RHO_AT(i, j)];
        }
    }
    return d;
}

/* The update in Joseph's form, (1 - k h) P (1 - k h)^T + k r k^T, element by element. */
static struct wide updated_in_double_precision(int n, const struct wide *d, const double *h,
                                               double y, double r)
{
    struct wide out = {.x = {0.0}};
    double ph[MOST] = {0.0}, s = r;

    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
            ph[i] += d->p[i][k] * h[k];
        }
        s += ph[i] * h[i];
    }
    for (int i = 0; i < n; ++i) {
        out.x[i] = d->x[i] + ph[i] / s * y;
        for (int j = 0; j < n; ++j) {
            const double ki = ph[i] / s, kj = ph[j] / s;

            out.p[i][j] = d->p[i][j] - ki * ph[j] - kj * ph[i] + ki * kj * s;
        }
    }
    return out;
}

static double worst_update;

static void assert_near_reference(const struct sized *e, const struct wide *expected,
                                  const struct wide *before)
{
    for (int i = 0; i < e->n; ++i) {
        const double sigma = sqrt(before->p[i][i]);

        worst_update =
            fmax(worst_update,
                 (fabs(e->x[i] - expected->x[i]) - DENSE_ROUNDING * fabs(expected->x[i])) / sigma);
        for (int j = 0; j <= i; ++j) {
            worst_update = fmax(worst_update, fabs(e->p[RHO_AT(i, j)] - expected->p[i][j]) / sigma /
                                                  sqrt(before->p[j][j]));
        }
    }
    assert_true(worst_update <= UPDATE_RELATIVE);
    for (int i = e->n; i < MOST; ++i) {
        assert_true(e->x[i] == GUARD);
    }
    for (int i = RHO_TRIANGLE(e->n); i < MOST_PACKED; ++i) {
        assert_true(e->p[i] == GUARD);
    }
}

/* Tries a Cholesky factorisation in double precision. */
static int is_sized_positive_definite(const struct sized *e)
{
    double l[MOST][MOST] = {{0.0}};

    for (int i = 0; i < e->n; ++i) {
        for (int j = 0; j <= i; ++j) {
            double rest = e->p[RHO_AT(i, j)];

            for (int k = 0; k < j; ++k) {
                rest -= l[i][k] * l[j][k];
            }
            if (i == j && !(rest > 0.0)) {
                return 0;
            }
            l[i][j] = i == j ? sqrt(rest) : rest / l[j][j];
        }
    }
    return 1;
}

/* --- updates --------------------------------------------------------------------------------- */

static void an_element_update_agrees_with_full_matrices(void **state)
{
    (void)state;
    worst_update = 0.0;
    for (int c = 0; c < MOST * CASES_OF_SIZE; ++c) {
        struct sized e = random_estimate(1 + c % MOST);
        const int index = (int)uniform(0.0, e.n);
        const float own = e.p[RHO_AT(index, index)];
        const float variance = own * (float)pow(10.0, uniform(-6.0, 3.0));
        const float innovation = (float)(normal() * sqrt((double)own + variance));
        const struct wide before = double_precision_of(&e);
        double h[MOST] = {0.0};

        h[index] = 1.0;
        const struct wide expected =
            updated_in_double_precision(e.n, &before, h, innovation, variance);
        assert_int_equal(rho_linalg_update_element(e.n, e.x, e.p, index, innovation, variance),
                         RHO_OK);
        assert_near_reference(&e, &expected, &before);
    }
}

static void a_row_update_agrees_with_full_matrices(void **state)
{
    (void)state;
    worst_update = 0.0;
    for (int c = 0; c < MOST * CASES_OF_SIZE; ++c) {
        struct sized e = random_estimate(1 + c % MOST);
        const int num = 1 + (int)uniform(0.0, e.n);
        const float variance = (float)pow(10.0, uniform(-1.0, 2.0));
        const float innovation = (float)(normal() * 2.0);
        const struct wide before = double_precision_of(&e);
        float row[MOST];
        double h[MOST] = {0.0};

        for (int i = 0; i < MOST; ++i) { /* elements from num on must not be read */
            row[i] = i < num ? (float)(normal() / sqrt(before.p[i][i])) : NAN;
            h[i] = i < num ? row[i] : 0.0;
        }
        const struct wide expected =
            updated_in_double_precision(e.n, &before, h, innovation, variance);
        assert_int_equal(rho_linalg_update_row(e.n, e.x, e.p, num, row, innovation, variance),
                         RHO_OK);
        assert_near_reference(&e, &expected, &before);
    }
}

static void the_general_update_agrees_with_that_for_six_elements(void **state)
{
    (void)state;
    for (int c = 0; c < CASES_OF_SIZE; ++c) {
        struct sized e = random_estimate(6), other = e;
        const int index = c % 6;

        assert_int_equal(rho_linalg_update_element(6, e.x, e.p, index, 3.0f, 2.0f), RHO_OK);
        assert_int_equal(rho_linalg_update6_element(other.x, other.p, index, 3.0f, 2.0f, NULL),
                         RHO_OK);
        const struct wide before = double_precision_of(&e), expected = double_precision_of(&other);
        assert_near_reference(&e, &expected, &before);
    }
}

/*
 * Each measurement is 10^8 times better than the prediction: the variance along the row cancels in
 * every digit.
 */
static void sharp_measurements_leave_a_vague_estimate_positive_definite(void **state)
{
    (void)state;
    for (int c = 0; c < MOST * 60; ++c) {
        struct sized e = {.n = 1 + c % MOST};

        for (int i = 0; i < e.n; ++i) {
            e.p[RHO_AT(i, i)] = 1e8f;
        }
        for (int k = 0; k < 3 * e.n; ++k) {
            float row[MOST];

            for (int i = 0; i < e.n; ++i) {
                row[i] = c % 2 == 0 ? (float)normal() : (float)(int)uniform(-2.0, 2.0);
            }
            if (c % 3 == 0) {
                assert_int_equal(
                    rho_linalg_update_element(e.n, e.x, e.p, k % e.n, (float)normal(), 1.0f),
                    RHO_OK);
            }
            assert_int_equal(rho_linalg_update_row(e.n, e.x, e.p, e.n, row, (float)normal(), 1.0f),
                             RHO_OK);
            assert_true(is_sized_positive_definite(&e));
        }
    }
}

/*
 * Correlated elements are measured one after the other, each 10^8 times better than it was known.
 */
static void sharply_measured_correlated_elements_stay_positive_definite(void **state)
{
    (void)state;
    for (int c = 0; c < MOST * 60; ++c) {
        const struct sized before = random_estimate(1 + c % MOST);
        struct sized e = before;

        for (int k = 0; k < 3 * e.n; ++k) {
            const int index = (int)uniform(0.0, e.n);
            const float variance = e.p[RHO_AT(index, index)] * 1e-8f;

            assert_int_equal(
                rho_linalg_update_element(e.n, e.x, e.p, index, (float)normal(), variance), RHO_OK);
            assert_true(e.p[RHO_AT(index, index)] <= variance * 1.000001f);
            assert_true(is_sized_positive_definite(&e));
            /* process noise makes the next element uncertain again */
            for (int i = 0; i < e.n; ++i) {
                e.p[RHO_AT(i, i)] += 0.01f * before.p[RHO_AT(i, i)];
            }
        }
    }
}

static void updates_raise_variances_by_rounding_at_most(void **state)
{
    (void)state;
    for (int c = 0; c < MOST * CASES_OF_SIZE; ++c) {
        const struct sized before = random_estimate(1 + c % MOST);
        struct sized e = before;
        float row[MOST];

        for (int i = 0; i < e.n; ++i) {
            row[i] = (float)(normal() / sqrt(e.p[RHO_AT(i, i)]));
        }
        const enum rho_status status =
            c % 2 == 0 ? rho_linalg_update_element(e.n, e.x, e.p, c / 2 % e.n, 1.0f, 1e12f)
                       : rho_linalg_update_row(e.n, e.x, e.p, e.n, row, 1.0f, 1e12f);
        assert_int_equal(status, RHO_OK);
        for (int i = 0; i < e.n; ++i) {
            assert_true(e.p[RHO_AT(i, i)] <= before.p[RHO_AT(i, i)] * (1.0f + 1.0f / 1048576.0f));
        }
    }
}

/* A row of zeros changes nothing; an element without covariances changes itself alone. */
static void elements_that_are_not_coupled_keep_their_bytes(void **state)
{
    struct sized e = {.n = 3, .x = {1.0f, 2.0f, 3.0f}};
    const float nothing[3] = {0.0f, 0.0f, 0.0f};

    (void)state;
    e.p[RHO_AT(0, 0)] = 4.0f;
    e.p[RHO_AT(1, 1)] = 9.0f;
    e.p[RHO_AT(2, 2)] = 0.1f;
    const struct sized before = e;
    assert_int_equal(rho_linalg_update_row(3, e.x, e.p, 3, nothing, 7.0f, 1.0f), RHO_OK);
    assert_memory_equal(&e, &before, sizeof e);
    assert_int_equal(rho_linalg_update_element(3, e.x, e.p, 1, 1.0f, 9.0f), RHO_OK);
    assert_true(e.x[1] == 2.5f && e.p[RHO_AT(1, 1)] == 4.5f);
    e.x[1] = before.x[1];
    e.p[RHO_AT(1, 1)] = before.p[RHO_AT(1, 1)];
    assert_memory_equal(&e, &before, sizeof e);
}

/* --- refused updates ------------------------------------------------------------------------- */

static void assert_update_refused(const struct sized *before, int index, const float *row,
                                  float innovation, float variance, enum rho_status expected)
{
    struct sized e = *before;

    assert_int_equal(rho_linalg_update_element(e.n, e.x, e.p, index, innovation, variance),
                     expected);
    assert_memory_equal(&e, before, sizeof e);
    assert_int_equal(rho_linalg_update_row(e.n, e.x, e.p, e.n, row, innovation, variance),
                     expected);
    assert_memory_equal(&e, before, sizeof e);
}

static void an_update_with_bad_numbers_is_refused_and_changes_nothing(void **state)
{
    static const float no_variance[] = {0.0f, -0.0f, -1.0f, NAN, INFINITY, -INFINITY, FLT_MAX};
    static const float no_innovation[] = {NAN, INFINITY, -INFINITY, FLT_MAX, 1e30f};

    (void)state;
    for (int n = 1; n <= MOST; ++n) {
        struct sized e = random_estimate(n);
        float row[MOST] = {0.0f};

        e.p[0] = 1e33f;
        row[0] = 1.0f;
        for (size_t k = 0; k < NUM(no_variance); ++k) {
            if (!(no_variance[k] <= FLT_MAX) || !(no_variance[k] > 0.0f)) {
                assert_update_refused(&e, 0, row, 1.0f, no_variance[k], RHO_ERROR_SINGULAR);
            }
        }
        e.p[0] = FLT_MAX; /* the innovation's variance overflows */
        assert_update_refused(&e, 0, row, 1.0f, FLT_MAX, RHO_ERROR_SINGULAR);
        e.p[0] = 0.0f; /* the inverse of the innovation's variance overflows */
        assert_update_refused(&e, 0, row, 1.0f, FLT_TRUE_MIN, RHO_ERROR_SINGULAR);
        e.p[0] = -1.0f;
        assert_update_refused(&e, 0, row, 1.0f, 0.5f, RHO_ERROR_SINGULAR);
        assert_update_refused(&e, 0, row, 1.0f, 1e6f, RHO_ERROR_SINGULAR);
        e.p[0] = 4.0f;
        for (size_t k = 0; k < NUM(no_innovation); ++k) {
            assert_update_refused(&e, 0, row, no_innovation[k], 1.0f, RHO_ERROR_VALUE);
        }
    }
}

static void an_update_of_a_bad_estimate_is_refused_and_changes_nothing(void **state)
{
    static const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (int n = 1; n <= MOST; ++n) {
        for (size_t k = 0; k < NUM(bad); ++k) {
            struct sized e = random_estimate(n);
            float row[MOST] = {0.0f};

            row[n - 1] = 1.0f;
            e.x[0] = bad[k];
            assert_update_refused(&e, n - 1, row, 1.0f, 1.0f, RHO_ERROR_VALUE);
            e = random_estimate(n);
            e.p[RHO_AT(n - 1, n - 1)] = bad[k];
            assert_update_refused(&e, n - 1, row, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
            if (n > 1) { /* a covariance that would spread into the state */
                e = random_estimate(n);
                e.p[RHO_AT(n - 1, 0)] = bad[k];
                struct sized after = e;
                assert_int_equal(rho_linalg_update_element(n, after.x, after.p, n - 1, 1.0f, 1.0f),
                                 RHO_ERROR_VALUE);
                assert_int_not_equal(rho_linalg_update_row(n, after.x, after.p, n, row, 1.0f, 1.0f),
                                     RHO_OK);
                assert_memory_equal(&after, &e, sizeof e);
            }
        }
    }
}

/* --- normalised innovation squared (NIS) ----------------------------------------------------- */

/* Gauss-Jordan with partial pivoting on [A | 1]; returns ln |det A|. */
static double invert_in_double_precision(int n, double a[MOST][2 * MOST])
{
    double log_det = 0.0;

    for (int k = 0; k < n; ++k) {
        int best = k;

        for (int i = k; i < n; ++i) {
            best = fabs(a[i][k]) > fabs(a[best][k]) ? i : best;
        }
        for (int j = 0; j < 2 * n; ++j) {
            const double swapped = a[k][j];

            a[k][j] = a[best][j];
            a[best][j] = swapped;
        }
        const double pivot = a[k][k];
        log_det += log(fabs(pivot));
        for (int j = 0; j < 2 * n; ++j) {
            a[k][j] /= pivot;
        }
        for (int i = 0; i < n; ++i) {
            const double factor = a[i][k];

            for (int j = 0; j < 2 * n && i != k; ++j) {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    return log_det;
}

static double nis_by_full_inverse(const struct sized *e, double *log_det)
{
    double a[MOST][2 * MOST] = {{0.0}}, distance2 = 0.0;

    for (int i = 0; i < e->n; ++i) {
        a[i][e->n + i] = 1.0;
        for (int j = 0; j < e->n; ++j) {
            a[i][j] = e->p[RHO_AT(i, j)];
        }
    }
    *log_det = invert_in_double_precision(e->n, a);
    for (int i = 0; i < e->n; ++i) {
        for (int j = 0; j < e->n; ++j) {
            distance2 += (double)e->x[i] * a[i][e->n + j] * e->x[j];
        }
    }
    return distance2;
}

static void nis_and_log_determinant_agree_with_a_full_inverse(void **state)
{
    (void)state;
    for (int c = 0; c < MOST * CASES_OF_SIZE; ++c) {
        struct sized e = random_estimate(1 + c % MOST);
        float distance2 = GUARD, log_det = GUARD;
        double expected_log_det;

        for (int i = 0; i < e.n; ++i) {
            e.x[i] = (float)(normal() * sqrt(e.p[RHO_AT(i, i)]));
        }
        const double expected = nis_by_full_inverse(&e, &expected_log_det);
        assert_true(rho_linalg_gated_nis(e.n, e.p, e.x, FLT_MAX, &distance2, &log_det));
        assert_float_equal(distance2, expected, DISTANCE_RELATIVE * expected);
        assert_float_equal(log_det, expected_log_det, LOG_DET_ABSOLUTE);
    }
}

/* Values that are exact in float: NIS equal to the gate, and a gate 0.25 below it. */
static void nis_at_the_gate_is_accepted_and_beyond_refused(void **state)
{
    (void)state;
    for (int n = 1; n <= MOST; ++n) {
        for (int k = 0; k < 2; ++k) {
            struct sized e = {.n = n};
            float distance2 = GUARD, log_det = GUARD;

            for (int i = 0; i < n; ++i) {
                e.p[RHO_AT(i, i)] = 4.0f;
                e.x[i] = 2.0f;
            }
            const int is_matched = rho_linalg_gated_nis(n, e.p, e.x, (float)n - 0.25f * (float)k,
                                                        &distance2, &log_det);
            assert_int_equal(is_matched, k == 0);
            assert_true(distance2 == (k == 0 ? (float)n : GUARD));
            assert_true(k == 0 ? fabs(log_det - n * log(4.0)) < 1e-5 : log_det == GUARD);
        }
    }
}

/* Twelve variances of 1e12 or 1e-9, whose product is out of the range of float. */
static void the_log_determinant_does_not_overflow_for_extreme_variances(void **state)
{
    static const float variances[] = {1e12f, 1e-9f};

    (void)state;
    for (size_t k = 0; k < NUM(variances); ++k) {
        for (int n = 1; n <= MOST; ++n) {
            struct sized e = {.n = n};
            float distance2 = GUARD, log_det = GUARD;

            for (int i = 0; i < n; ++i) {
                e.p[RHO_AT(i, i)] = variances[k];
            }
            assert_true(rho_linalg_gated_nis(n, e.p, e.x, 30.0f, &distance2, &log_det));
            assert_true(distance2 == 0.0f);
            assert_float_equal(log_det, n * log((double)variances[k]), 1e-4);
        }
    }
}

static void nis_refuses_matrices_that_are_not_positive_definite(void **state)
{
    static const float bad[] = {0.0f, -1.0f, NAN, INFINITY, -INFINITY};

    (void)state;
    for (int n = 1; n <= MOST; ++n) {
        for (int c = 0; c < n * (int)NUM(bad); ++c) {
            struct sized e = random_estimate(n);
            float distance2 = GUARD, log_det = GUARD;

            e.p[RHO_AT(c % n, c % n)] = bad[c / n];
            assert_false(rho_linalg_gated_nis(n, e.p, e.x, FLT_MAX, &distance2, &log_det));
            assert_true(distance2 == GUARD && log_det == GUARD);
        }
        for (int i = 0; i < n; ++i) {
            struct sized e = random_estimate(n);
            float distance2 = GUARD, log_det = GUARD;

            e.x[i] = NAN;
            assert_false(rho_linalg_gated_nis(n, e.p, e.x, FLT_MAX, &distance2, &log_det));
            assert_true(distance2 == GUARD && log_det == GUARD);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_element_update_agrees_with_full_matrices),
        cmocka_unit_test(a_row_update_agrees_with_full_matrices),
        cmocka_unit_test(the_general_update_agrees_with_that_for_six_elements),
        cmocka_unit_test(sharp_measurements_leave_a_vague_estimate_positive_definite),
        cmocka_unit_test(sharply_measured_correlated_elements_stay_positive_definite),
        cmocka_unit_test(updates_raise_variances_by_rounding_at_most),
        cmocka_unit_test(elements_that_are_not_coupled_keep_their_bytes),
        cmocka_unit_test(an_update_with_bad_numbers_is_refused_and_changes_nothing),
        cmocka_unit_test(an_update_of_a_bad_estimate_is_refused_and_changes_nothing),
        cmocka_unit_test(nis_and_log_determinant_agree_with_a_full_inverse),
        cmocka_unit_test(nis_at_the_gate_is_accepted_and_beyond_refused),
        cmocka_unit_test(the_log_determinant_does_not_overflow_for_extreme_variances),
        cmocka_unit_test(nis_refuses_matrices_that_are_not_positive_definite),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
