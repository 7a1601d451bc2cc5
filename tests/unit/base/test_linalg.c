/* SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/linalg.h"
#include "vectors/linalg_vectors.h"

/* Tolerances, relative to the largest entry of the row or vector, or to the value itself. */
#define CHOLESKY_RELATIVE 4e-6
#define FORWARD_RELATIVE 2e-5
#define BACKWARD_RELATIVE 3e-7 /* of the residual; largest seen: 7.5e-8 */
#define LOG_DETERMINANT_ABSOLUTE 2e-5
#define DISTANCE2_RELATIVE 2e-4 /* wide, as S is nearly singular in a third of the vectors */
#define LOG_DET_ABSOLUTE 2e-5
#define UPDATE_RELATIVE 1e-5

#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define GUARD (-777.25f)
#define STATES 6
#define PACKED 21

static double largest_magnitude(const double *values, int n)
{
    double most = 0.0;

    for (int i = 0; i < n; ++i) {
        most = fmax(most, fabs(values[i]));
    }
    return most;
}

static void assert_near_reference(const float *got, const double *expected, int n, double relative)
{
    const double tolerance = relative * largest_magnitude(expected, n);

    for (int i = 0; i < n; ++i) {
        assert_true(fabs(got[i] - expected[i]) <= tolerance);
    }
}

static void fill(float *values, size_t n, float v)
{
    for (size_t i = 0; i < n; ++i) {
        values[i] = v;
    }
}

static void assert_all_equal_to(const float *values, size_t n, float v)
{
    for (size_t i = 0; i < n; ++i) {
        assert_true(values[i] == v);
    }
}

/* --- Cholesky ------------------------------------------------------------------------------ */

static void cholesky_agrees_with_the_reference(void **state)
{
    (void)state;
    for (size_t k = 0; k < NUM(cholesky_vectors); ++k) {
        const struct cholesky_vector *v = &cholesky_vectors[k];
        const size_t size = (size_t)RHO_TRIANGLE(v->n);
        float l[80];

        fill(l, NUM(l), GUARD);
        assert_int_equal(rho_linalg_cholesky(v->n, v->a, l), RHO_OK);
        for (int i = 0; i < v->n; ++i) {
            assert_near_reference(&l[RHO_TRIANGLE(i)], &v->factor[RHO_TRIANGLE(i)], i + 1,
                                  CHOLESKY_RELATIVE);
        }
        assert_all_equal_to(&l[size], NUM(l) - size, GUARD);
    }
}

static void cholesky_factors_in_place(void **state)
{
    (void)state;
    for (size_t k = 0; k < NUM(cholesky_vectors); ++k) {
        const struct cholesky_vector *v = &cholesky_vectors[k];
        float apart[78], same[78];

        memcpy(same, v->a, sizeof same);
        assert_int_equal(rho_linalg_cholesky(v->n, v->a, apart), RHO_OK);
        assert_int_equal(rho_linalg_cholesky(v->n, same, same), RHO_OK);
        assert_memory_equal(same, apart, (size_t)RHO_TRIANGLE(v->n) * sizeof(float));
    }
}

static void forward_solution_and_determinant_agree_with_the_reference(void **state)
{
    (void)state;
    for (size_t k = 0; k < NUM(cholesky_vectors); ++k) {
        const struct cholesky_vector *v = &cholesky_vectors[k];
        float l[78], b[13];

        assert_int_equal(rho_linalg_cholesky(v->n, v->a, l), RHO_OK);
        fill(b, NUM(b), GUARD);
        memcpy(b, v->b, (size_t)v->n * sizeof(float));
        rho_linalg_forward(v->n, l, b);
        assert_near_reference(b, v->forward, v->n, FORWARD_RELATIVE);
        assert_all_equal_to(&b[v->n], NUM(b) - (size_t)v->n, GUARD);
        assert_true(fabs(rho_linalg_log_determinant(v->n, l) - v->log_determinant) <=
                    LOG_DETERMINANT_ABSOLUTE);
    }
}

/*
 * Checks each row of L^T x = b, with a tolerance of the sum of the terms' magnitudes: this holds
 * for ill-conditioned L, too.
 */
static void backward_substitution_solves_the_transposed_factor(void **state)
{
    (void)state;
    for (size_t k = 0; k < NUM(cholesky_vectors); ++k) {
        const struct cholesky_vector *v = &cholesky_vectors[k];
        float l[78], x[13];

        assert_int_equal(rho_linalg_cholesky(v->n, v->a, l), RHO_OK);
        fill(x, NUM(x), GUARD);
        memcpy(x, v->b, (size_t)v->n * sizeof(float));
        rho_linalg_backward(v->n, l, x);
        for (int i = 0; i < v->n; ++i) {
            double sum = 0.0, size = fabs(v->b[i]);

            for (int j = i; j < v->n; ++j) {
                sum += (double)l[RHO_AT(j, i)] * x[j];
                size += fabs((double)l[RHO_AT(j, i)] * x[j]);
            }
            assert_float_equal(sum, v->b[i], BACKWARD_RELATIVE * size);
        }
        assert_all_equal_to(&x[v->n], NUM(x) - (size_t)v->n, GUARD);
    }
}

static void forward_then_backward_substitution_solves_the_equations(void **state)
{
    (void)state;
    for (size_t k = 0; k < NUM(cholesky_vectors); ++k) {
        const struct cholesky_vector *v = &cholesky_vectors[k];
        float l[78], x[12];

        assert_int_equal(rho_linalg_cholesky(v->n, v->a, l), RHO_OK);
        memcpy(x, v->b, (size_t)v->n * sizeof(float));
        rho_linalg_forward(v->n, l, x);
        rho_linalg_backward(v->n, l, x);
        for (int i = 0; i < v->n; ++i) {
            double sum = 0.0, size = 0.0;

            for (int j = 0; j < v->n; ++j) {
                sum += (double)v->a[RHO_AT(i, j)] * x[j];
                size += sqrt((double)v->a[RHO_AT(i, i)] * v->a[RHO_AT(j, j)]) * fabs(x[j]);
            }
            assert_float_equal(sum, v->b[i], BACKWARD_RELATIVE * size);
        }
    }
}

static void assert_cholesky_refuses(int n, const float *a, enum rho_status expected)
{
    float l[78];

    fill(l, NUM(l), GUARD);
    assert_int_equal(rho_linalg_cholesky(n, a, l), expected);
    /* a singular matrix is found halfway, when some of l is written */
    if (expected != RHO_ERROR_SINGULAR) {
        assert_all_equal_to(l, NUM(l), GUARD);
    }
}

static void cholesky_refuses_matrices_that_are_not_positive_definite(void **state)
{
    const float indefinite[3] = {1.0f, 2.0f, 1.0f};
    const float singular[3] = {1.0f, 1.0f, 1.0f};
    const float late[6] = {4.0f, 0.0f, 4.0f, 3.0f, 3.0f, 1.0f};
    const float bad[] = {0.0f, -0.0f, -1.0f, NAN, INFINITY, -INFINITY};

    (void)state;
    assert_cholesky_refuses(2, indefinite, RHO_ERROR_SINGULAR);
    assert_cholesky_refuses(2, singular, RHO_ERROR_SINGULAR);
    assert_cholesky_refuses(3, late, RHO_ERROR_SINGULAR);
    for (size_t i = 0; i < NUM(bad); ++i) {
        const float first[3] = {bad[i], 0.0f, 1.0f};
        const float last[3] = {1.0f, 0.0f, bad[i]};

        assert_cholesky_refuses(1, first, RHO_ERROR_SINGULAR);
        assert_cholesky_refuses(2, first, RHO_ERROR_SINGULAR);
        assert_cholesky_refuses(2, last, RHO_ERROR_SINGULAR);
    }
}

static void cholesky_refuses_nan_infinity_and_overflow_in_any_element(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY, FLT_MAX};

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int place = 0; place < PACKED; ++place) {
            float a[PACKED] = {0.0f};

            for (int i = 0; i < STATES; ++i) {
                a[RHO_AT(i, i)] = 2.0f;
            }
            a[place] = bad[k];
            if (bad[k] < INFINITY && place == RHO_AT(STATES - 1, STATES - 1)) {
                continue; /* FLT_MAX as the last variance is valid */
            }
            if (!(bad[k] == FLT_MAX &&
                  (place == 0 || place == 2 || place == 5 || place == 9 || place == 14))) {
                assert_cholesky_refuses(STATES, a, RHO_ERROR_SINGULAR);
            }
        }
    }
}

/* --- normalised innovation squared (NIS) ----------------------------------------------------- */

static void nis_of_two_dimensions_agrees_with_the_reference(void **state)
{
    (void)state;
    for (size_t i = 0; i < NUM(gate2_vectors); ++i) {
        const struct gate2_vector *v = &gate2_vectors[i];
        float distance2[2] = {0.0f, GUARD}, log_det[2] = {0.0f, GUARD};

        assert_int_equal(rho_linalg_nis(2, v->s, v->d, distance2, log_det), RHO_OK);
        assert_near_reference(distance2, &v->distance2, 1, DISTANCE2_RELATIVE);
        assert_true(fabs(log_det[0] - v->log_det) <= LOG_DET_ABSOLUTE);
        assert_true(distance2[1] == GUARD && log_det[1] == GUARD);
    }
}

static void nis_of_three_dimensions_agrees_with_the_reference(void **state)
{
    (void)state;
    for (size_t i = 0; i < NUM(gate3_vectors); ++i) {
        const struct gate3_vector *v = &gate3_vectors[i];
        float distance2[2] = {0.0f, GUARD}, log_det[2] = {0.0f, GUARD};

        assert_int_equal(rho_linalg_nis(3, v->s, v->d, distance2, log_det), RHO_OK);
        assert_near_reference(distance2, &v->distance2, 1, DISTANCE2_RELATIVE);
        assert_true(fabs(log_det[0] - v->log_det) <= LOG_DET_ABSOLUTE);
        assert_true(distance2[1] == GUARD && log_det[1] == GUARD);
    }
}

/* Results by hand for diagonal covariances. */
static void nis_of_diagonal_matrices_is_exact(void **state)
{
    const float s2[3] = {1.0f, 0.0f, 4.0f}, d2[2] = {3.0f, 4.0f};
    const float s3[6] = {1.0f, 0.0f, 4.0f, 0.0f, 0.0f, 16.0f}, d3[3] = {1.0f, 2.0f, 8.0f};
    float distance2, log_det;

    (void)state;
    assert_int_equal(rho_linalg_nis(2, s2, d2, &distance2, &log_det), RHO_OK);
    assert_true(distance2 == 13.0f);
    assert_float_equal(log_det, log(4.0), 1e-6);
    assert_int_equal(rho_linalg_nis(3, s3, d3, &distance2, &log_det), RHO_OK);
    assert_true(distance2 == 6.0f);
    assert_float_equal(log_det, log(64.0), 1e-6);
}

static void assert_nis_refused(const float s[6], const float d[3], int try2)
{
    float distance2 = GUARD, log_det = GUARD;

    if (try2) {
        assert_int_equal(rho_linalg_nis(2, s, d, &distance2, &log_det), RHO_ERROR_SINGULAR);
    }
    assert_int_equal(rho_linalg_nis(3, s, d, &distance2, &log_det), RHO_ERROR_SINGULAR);
    assert_true(distance2 == GUARD && log_det == GUARD);
}

static void nis_refuses_bad_matrices_and_innovations(void **state)
{
    const float good[6] = {2.0f, 0.5f, 2.0f, 0.5f, 0.5f, 2.0f}, zero[3] = {0.0f};
    const float bad[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX};
    const float bad_variances[] = {0.0f, -0.0f, -1.0f, FLT_TRUE_MIN};

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int place = 0; place < 6; ++place) {
            float s[6];

            memcpy(s, good, sizeof s);
            s[place] = bad[k];
            if (bad[k] == FLT_MAX && (place == 0 || place == 2 || place == 5)) {
                continue;
            }
            assert_nis_refused(s, zero, place < 3);
        }
        for (int place = 0; place < 3; ++place) {
            float d[3] = {0.0f};

            d[place] = bad[k];
            assert_nis_refused(good, d, place < 2);
        }
    }
    for (size_t k = 0; k < NUM(bad_variances); ++k) {
        for (int i = 0; i < 3; ++i) {
            float s[6];

            memcpy(s, good, sizeof s);
            s[RHO_AT(i, i)] = bad_variances[k];
            assert_nis_refused(s, zero, i < 2);
        }
    }
}

/* Two-by-two minors positive, determinant negative; products that overflow or underflow float. */
static void nis_refuses_indefinite_matrices_and_overflow(void **state)
{
    const float s[6] = {1.0f, 0.9f, 1.0f, 0.9f, -0.9f, 1.0f}, zero[3] = {0.0f};
    const float huge[6] = {1e20f, 0.0f, 1e20f, 0.0f, 0.0f, 1e20f};
    const float tiny[6] = {1e-20f, 0.0f, 1e-20f, 0.0f, 0.0f, 1e-20f};

    (void)state;
    assert_nis_refused(s, zero, 0);
    assert_nis_refused(huge, zero, 1);
    assert_nis_refused(tiny, zero, 0);
}

/* --- update of one element ------------------------------------------------------------------- */

struct estimate {
    float before, x[STATES], between, p[PACKED], after;
};

static struct estimate test_estimate(void)
{
    const struct cholesky_vector *v = &cholesky_vectors[2 * (STATES - 1)];
    struct estimate e = {.before = GUARD, .between = GUARD, .after = GUARD};

    assert_int_equal(v->n, STATES);
    memcpy(e.x, v->b, sizeof e.x);
    memcpy(e.p, v->a, sizeof e.p);
    return e;
}

/* Expected: x + p_i innovation / s and P - p_i p_i^T / s, in double precision. */
static void an_element_update_agrees_with_the_formula(void **state)
{
    (void)state;
    for (int index = 0; index < STATES; ++index) {
        const struct estimate old = test_estimate();
        struct estimate e = old;
        const double variance = 3.5, innovation = -7.25;
        const double sum = old.p[RHO_AT(index, index)] + variance;
        float nis = GUARD;

        assert_int_equal(
            rho_linalg_update6_element(e.x, e.p, index, (float)innovation, (float)variance, &nis),
            RHO_OK);
        assert_float_equal(nis, innovation * innovation / sum, 1e-6 * nis);
        for (int i = 0; i < STATES; ++i) {
            const double p_i = old.p[RHO_AT(i, index)];

            assert_float_equal(e.x[i], old.x[i] + p_i * innovation / sum,
                               UPDATE_RELATIVE * (fabs(old.x[i]) + fabs(p_i * innovation / sum)));
            for (int j = 0; j <= i; ++j) {
                const double lowered = old.p[RHO_AT(i, j)] - p_i * old.p[RHO_AT(j, index)] / sum;
                const double scale = sqrt((double)old.p[RHO_AT(i, i)] * old.p[RHO_AT(j, j)]);

                assert_float_equal(e.p[RHO_AT(i, j)], lowered, UPDATE_RELATIVE * scale);
            }
        }
        assert_true(e.before == GUARD && e.between == GUARD && e.after == GUARD);
    }
}

#define GROWTH_MAX (1.0f + 1.0f / 1048576.0f) /* 2^-20 */

static void an_element_update_raises_variances_by_rounding_at_most(void **state)
{
    (void)state;
    for (int index = 0; index < STATES; ++index) {
        const struct estimate old = test_estimate();
        struct estimate e = old;

        assert_int_equal(rho_linalg_update6_element(e.x, e.p, index, 1.0f, 1e20f, NULL), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            assert_true(e.p[RHO_AT(i, i)] <= old.p[RHO_AT(i, i)] * GROWTH_MAX);
        }
    }
}

static void assert_update_refused(struct estimate e, int index, float innovation, float variance,
                                  enum rho_status expected)
{
    const struct estimate old = e;
    float nis = GUARD;

    assert_int_equal(rho_linalg_update6_element(e.x, e.p, index, innovation, variance, &nis),
                     expected);
    assert_memory_equal(&e, &old, sizeof e);
    assert_true(nis == GUARD);
}

static void an_element_update_refuses_bad_numbers(void **state)
{
    const struct estimate e = test_estimate();
    const float no_variance[] = {0.0f, -0.0f, -1.0f, NAN, INFINITY, -INFINITY};
    const float no_innovation[] = {NAN, INFINITY, -INFINITY, FLT_MAX, 1e25f};

    (void)state;
    for (size_t i = 0; i < NUM(no_variance); ++i) {
        assert_update_refused(e, 2, 1.0f, no_variance[i], RHO_ERROR_SINGULAR);
    }
    for (size_t i = 0; i < NUM(no_innovation); ++i) {
        assert_update_refused(e, 2, no_innovation[i], 1.0f, RHO_ERROR_VALUE);
    }
}

static void an_element_update_refuses_a_bad_estimate(void **state)
{
    const float no_variance[] = {-1.0f, NAN, INFINITY, -INFINITY};
    const float no_state[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (size_t i = 0; i < NUM(no_variance); ++i) {
        struct estimate e = test_estimate();

        e.p[RHO_AT(2, 2)] = no_variance[i];
        assert_update_refused(e, 2, 1.0f, 4.0f, RHO_ERROR_SINGULAR);
    }
    for (size_t i = 0; i < NUM(no_state); ++i) {
        struct estimate e = test_estimate();

        e.x[4] = no_state[i];
        assert_update_refused(e, 2, 1.0f, 4.0f, RHO_ERROR_VALUE);
        e = test_estimate();
        e.p[RHO_AT(4, 2)] = no_state[i];
        assert_update_refused(e, 2, 1.0f, 4.0f, RHO_ERROR_VALUE);
    }
    struct estimate e = test_estimate();
    e.p[RHO_AT(2, 2)] = 0.0f;
    assert_update_refused(e, 2, 1.0f, FLT_TRUE_MIN, RHO_ERROR_SINGULAR); /* 1 / s overflows */
    e.p[RHO_AT(2, 2)] = FLT_MAX;
    assert_update_refused(e, 2, 1.0f, FLT_MAX, RHO_ERROR_SINGULAR); /* the sum overflows */
}

static void an_element_update_needs_no_nis(void **state)
{
    struct estimate e = test_estimate();

    (void)state;
    assert_int_equal(rho_linalg_update6_element(e.x, e.p, 0, 1.0f, 1.0f, NULL), RHO_OK);
}

/* Compared with the product of the full matrix, in double precision. */
static void a_projected_covariance_agrees_with_the_full_product(void **state)
{
    double full[STATES][STATES], expected[STATES], variance = 0.0;
    float p[PACKED], row[STATES], projected[STATES];

    (void)state;
    for (int i = 0, k = 0; i < STATES; ++i) {
        row[i] = 0.5f - 0.3f * (float)i;
        for (int j = 0; j <= i; ++j) {
            p[k] = (float)((i == j) * 9 + (7 * i + 3 * j) % 5) - 1.25f;
            full[i][j] = full[j][i] = p[k++];
        }
    }
    for (int i = 0; i < STATES; ++i) {
        expected[i] = 0.0;
        for (int j = 0; j < STATES; ++j) {
            expected[i] += full[i][j] * row[j];
        }
        variance += row[i] * expected[i];
    }
    assert_true(fabs(rho_linalg_project6(p, row, projected) - variance) <= 1e-6 * fabs(variance));
    assert_near_reference(projected, expected, STATES, 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cholesky_agrees_with_the_reference),
        cmocka_unit_test(cholesky_factors_in_place),
        cmocka_unit_test(forward_solution_and_determinant_agree_with_the_reference),
        cmocka_unit_test(backward_substitution_solves_the_transposed_factor),
        cmocka_unit_test(forward_then_backward_substitution_solves_the_equations),
        cmocka_unit_test(cholesky_refuses_matrices_that_are_not_positive_definite),
        cmocka_unit_test(cholesky_refuses_nan_infinity_and_overflow_in_any_element),
        cmocka_unit_test(nis_of_two_dimensions_agrees_with_the_reference),
        cmocka_unit_test(nis_of_three_dimensions_agrees_with_the_reference),
        cmocka_unit_test(nis_of_diagonal_matrices_is_exact),
        cmocka_unit_test(nis_refuses_bad_matrices_and_innovations),
        cmocka_unit_test(nis_refuses_indefinite_matrices_and_overflow),
        cmocka_unit_test(an_element_update_agrees_with_the_formula),
        cmocka_unit_test(an_element_update_raises_variances_by_rounding_at_most),
        cmocka_unit_test(an_element_update_refuses_bad_numbers),
        cmocka_unit_test(an_element_update_refuses_a_bad_estimate),
        cmocka_unit_test(an_element_update_needs_no_nis),
        cmocka_unit_test(a_projected_covariance_agrees_with_the_full_product),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
