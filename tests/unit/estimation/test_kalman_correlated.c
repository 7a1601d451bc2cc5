/* SPDX-License-Identifier: MIT */
/*
 * Updates with correlated measurement noise, and process noise, compared with full matrices in
 * double precision.
 */
#include <float.h>
#include <string.h>

#include "dense_filter.h"
#include "kalman_checks.h"

/*
 * Tolerance in sigmas of the estimate before; largest seen: 5.8e-3, where estimate and noise are
 * both correlated by 0.99. Scalar updates of such an estimate are off by 5e-4.
 */
#define RELATIVE 2e-2

#define NUM_CASES 2000

struct look {
    int num, elements[STATES];
    float values[STATES], covariance[PACKED];
};

/*
 * Measurements of different elements in random order, near the estimate, with noise correlated by
 * up to 0.99.
 */
static struct look random_look(const struct rho_kalman *kalman, int num)
{
    struct look look = {.num = num};

    for (int i = 0; i < STATES; ++i) {
        look.elements[i] = i;
    }
    for (int i = STATES - 1; i > 0; --i) {
        const int k = (int)uniform(0.0, i + 1.0), swapped = look.elements[k];

        look.elements[k] = look.elements[i];
        look.elements[i] = swapped;
    }
    random_covariance(look.covariance, 1.5);
    for (int i = 0; i < num; ++i) {
        look.values[i] = kalman->state[look.elements[i]] + (float)(30.0 * normal());
    }
    return look;
}

static struct rho_kalman random_estimate(double decades)
{
    struct rho_kalman kalman;

    random_covariance(kalman.covariance, decades);
    for (int i = 0; i < STATES; ++i) {
        kalman.state[i] = (float)(i < 3 ? uniform(-5e4, 5e4) : uniform(-600.0, 600.0));
    }
    return kalman;
}

/* For the update in information form: P := (P^-1 + H^T R^-1 H)^-1, x := x + P H^T R^-1 y. */
static void invert_matrix(int n, double a[DENSE][DENSE])
{
    for (int k = 0; k < n; ++k) {
        const double pivot = a[k][k];

        a[k][k] = 1.0;
        for (int j = 0; j < n; ++j) {
            a[k][j] /= pivot;
        }
        for (int i = 0; i < n; ++i) {
            const double factor = a[i][k];

            if (i != k) {
                a[i][k] = 0.0;
                for (int j = 0; j < n; ++j) {
                    a[i][j] -= factor * a[k][j];
                }
            }
        }
    }
}

static void update_in_information_form(struct dense *d, const struct look *look)
{
    double r[DENSE][DENSE] = {{0.0}};
    const struct dense before = *d;

    for (int a = 0; a < look->num; ++a) {
        for (int b = 0; b < look->num; ++b) {
            r[a][b] = look->covariance[RHO_AT(a, b)];
        }
    }
    invert_matrix(look->num, r);
    invert_matrix(DENSE, d->p);
    for (int a = 0; a < look->num; ++a) {
        for (int b = 0; b < look->num; ++b) {
            d->p[look->elements[a]][look->elements[b]] += r[a][b];
        }
    }
    invert_matrix(DENSE, d->p);
    for (int i = 0; i < DENSE; ++i) {
        for (int a = 0; a < look->num; ++a) {
            for (int b = 0; b < look->num; ++b) {
                d->x[i] += d->p[i][look->elements[a]] * r[a][b] *
                           (look->values[b] - before.x[look->elements[b]]);
            }
        }
    }
}

static enum rho_status update_with_look(struct rho_kalman *kalman, const struct look *look)
{
    return rho_kalman_update_correlated(kalman, look->num, look->elements, look->values,
                                        look->covariance);
}

/* ---- comparison with the vector update ------------------------------------------------------ */

static void correlated_elements_agree_with_the_vector_update(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman kalman = random_estimate(2.0);
        const struct look look = random_look(&kalman, 1 + n % STATES);
        const struct dense before = dense_of(kalman.state, kalman.covariance);
        struct dense expected = before;

        update_in_information_form(&expected, &look);
        assert_int_equal(update_with_look(&kalman, &look), RHO_OK);
        assert_near_dense(kalman.state, kalman.covariance, &expected, &before, RELATIVE);
        assert_true(is_positive_definite(&kalman));
    }
}

/* Without correlation the result is that of scalar updates, within rounding. */
static void uncorrelated_elements_equal_scalar_updates(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman kalman = random_estimate(2.0), other = kalman;
        struct look look = random_look(&kalman, STATES);
        const struct dense before = dense_of(kalman.state, kalman.covariance);

        for (int i = 0; i < STATES; ++i) {
            for (int j = 0; j < i; ++j) {
                look.covariance[RHO_AT(i, j)] = 0.0f;
            }
        }
        assert_int_equal(update_with_look(&kalman, &look), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            assert_int_equal(rho_kalman_update(&other, look.elements[i], look.values[i],
                                               look.covariance[RHO_AT(i, i)], NULL),
                             RHO_OK);
        }
        const struct dense expected = dense_of(other.state, other.covariance);
        assert_near_dense(kalman.state, kalman.covariance, &expected, &before, RELATIVE);
    }
}

/* z is closed: its measurements and their correlations have no effect. */
static void elements_of_a_closed_axis_are_left_out(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman kalman = opened_filter(2, 400.0f, 900.0f), other = kalman;
        const struct look look = random_look(&kalman, STATES);
        struct look level = {.num = 0};
        int kept[STATES] = {0};

        for (int i = 0; i < STATES; ++i) {
            if (look.elements[i] % 3 != 2) {
                kept[level.num] = i;
                level.elements[level.num] = look.elements[i];
                level.values[level.num] = look.values[i];
                for (int k = 0; k <= level.num; ++k) {
                    level.covariance[RHO_AT(level.num, k)] = look.covariance[RHO_AT(i, kept[k])];
                }
                level.num++;
            }
        }
        assert_int_equal(level.num, 4);
        assert_int_equal(update_with_look(&kalman, &look), RHO_OK);
        assert_int_equal(update_with_look(&other, &level), RHO_OK);
        assert_memory_equal(&kalman, &other, sizeof kalman);
        assert_true(kalman.state[2] == 0.0f && kalman.covariance[RHO_AT(2, 2)] == 0.0f);
    }
}

/* ---- extreme cases -------------------------------------------------------------------------- */

/* The prediction's variance is 5e8 times that of plots, whose ellipses of 1 x 300 m turn. */
static void a_vague_start_with_thin_ellipses_stays_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < 100; ++n) {
        struct rho_kalman kalman = opened_filter(3, 5e8f, 5e8f);

        for (int k = 0; k < 60; ++k) {
            const double angle = uniform(0.0, 6.3), c = cos(angle), s = sin(angle), wide = 9e4;
            const int elements[3] = {0, 1, 2};
            const float values[3] = {100.0f + 20.0f * (float)k, 200.0f, 300.0f};
            const float covariance[6] = {(float)(c * c + wide * s * s),
                                         (float)(c * s * (1.0 - wide)),
                                         (float)(s * s + wide * c * c),
                                         0.0f,
                                         0.0f,
                                         1.0f};

            assert_int_equal(rho_kalman_update_correlated(&kalman, 3, elements, values, covariance),
                             RHO_OK);
            assert_finite_with_variances_in_limits(&kalman);
            assert_true(is_positive_definite(&kalman));
            assert_int_equal(rho_kalman_predict(&kalman, 1.0f, 0.0f), RHO_OK);
            assert_true(is_positive_definite(&kalman));
        }
        assert_float_equal(kalman.state[3], 20.0, 0.1);
        assert_float_equal(kalman.state[5], 0.0, 0.1);
    }
}

static void random_correlated_updates_stay_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman kalman = opened_filter(3, 5e8f, 5e8f);

        for (int k = 0; k < 10; ++k) {
            const struct look look = random_look(&kalman, 1 + k % STATES);

            assert_int_equal(update_with_look(&kalman, &look), RHO_OK);
            assert_finite_with_variances_in_limits(&kalman);
            assert_true(is_positive_definite(&kalman));
        }
    }
}

/* ---- refusals ------------------------------------------------------------------------------- */

static void assert_look_refused(struct rho_kalman kalman, const struct look *look,
                                enum rho_status expected)
{
    const struct rho_kalman before = kalman;

    assert_int_equal(update_with_look(&kalman, look), expected);
    assert_changed_nothing(&kalman, &before);
}

static void bad_measurements_are_refused(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};
    const struct rho_kalman kalman = opened_filter(3, 4.0f, 9.0f);
    const struct look good = {
        .num = 2, .elements = {1, 3}, .values = {1.0f, 2.0f}, .covariance = {4.0f, 1.0f, 4.0f}};
    struct look look;

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int i = 0; i < 5; ++i) {
            look = good;
            *(i < 2 ? &look.values[i] : &look.covariance[i - 2]) = bad[k];
            assert_look_refused(kalman, &look, RHO_ERROR_VALUE);
        }
    }
    for (int i = 0; i < 2; ++i) {
        look = good;
        look.elements[i] = i ? 6 : -1;
        assert_look_refused(kalman, &look, RHO_ERROR_VALUE);
        look.num = i ? 7 : 0;
        assert_look_refused(kalman, &look, RHO_ERROR_VALUE);
        look = good;
        look.covariance[i ? 2 : 0] = 0.0f;
        assert_look_refused(kalman, &look, RHO_ERROR_SINGULAR);
        look.covariance[i ? 2 : 0] = -1.0f;
        assert_look_refused(kalman, &look, RHO_ERROR_SINGULAR);
        look = good;
        look.values[i] = FLT_MAX;
        assert_look_refused(kalman, &look, RHO_ERROR_VALUE);
    }
    look = good;
    look.covariance[1] = 4.0f;
    assert_look_refused(kalman, &look, RHO_ERROR_SINGULAR);
    look.covariance[1] = -5.0f;
    assert_look_refused(kalman, &look, RHO_ERROR_SINGULAR);
}

/* The last element overflows after the first one was used. */
static void an_update_that_fails_at_its_last_element_changes_nothing(void **state)
{
    const struct look look = {
        .num = 2, .elements = {1, 3}, .values = {1.0f, 3e38f}, .covariance = {4.0f, 1.0f, 4.0f}};

    (void)state;
    assert_look_refused(opened_filter(3, 4.0f, 9.0f), &look, RHO_ERROR_VALUE);
}

static void null_is_refused(void **state)
{
    const int elements[1] = {0};
    const float one[1] = {1.0f};
    struct rho_kalman kalman = opened_filter(3, 4.0f, 9.0f);

    (void)state;
    assert_int_equal(rho_kalman_update_correlated(NULL, 1, elements, one, one), RHO_ERROR_NULL);
    assert_int_equal(rho_kalman_update_correlated(&kalman, 1, NULL, one, one), RHO_ERROR_NULL);
    assert_int_equal(rho_kalman_update_correlated(&kalman, 1, elements, NULL, one), RHO_ERROR_NULL);
    assert_int_equal(rho_kalman_update_correlated(&kalman, 1, elements, one, NULL), RHO_ERROR_NULL);
}

/* ---- process noise -------------------------------------------------------------------------- */

static void noise_is_added_to_open_axes(void **state)
{
    struct rho_kalman kalman = opened_filter(2, 4.0f, 9.0f);
    const struct rho_kalman before = kalman;

    (void)state;
    assert_int_equal(rho_kalman_add_noise(&kalman, 0.5f, 0.25f), RHO_OK);
    for (int i = 0; i < STATES; ++i) {
        const double added = i % 3 == 2 ? 0.0 : (i < 3 ? 0.5 : 0.25);

        assert_true(kalman.state[i] == before.state[i]);
        for (int j = 0; j <= i; ++j) {
            assert_float_equal(kalman.covariance[RHO_AT(i, j)],
                               before.covariance[RHO_AT(i, j)] + (i == j ? added : 0.0), 1e-6);
        }
    }
}

static void bad_noise_is_refused(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY, -1e-9f, 1.1f * RHO_KALMAN_VARIANCE_MAX};
    struct rho_kalman kalman = opened_filter(3, 4.0f, 9.0f);
    const struct rho_kalman before = kalman;

    (void)state;
    assert_int_equal(rho_kalman_add_noise(NULL, 1.0f, 1.0f), RHO_ERROR_NULL);
    for (size_t k = 0; k < NUM(bad); ++k) {
        assert_int_equal(rho_kalman_add_noise(&kalman, bad[k], 1.0f), RHO_ERROR_VALUE);
        assert_int_equal(rho_kalman_add_noise(&kalman, 1.0f, bad[k]), RHO_ERROR_VALUE);
    }
    assert_changed_nothing(&kalman, &before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(correlated_elements_agree_with_the_vector_update),
        cmocka_unit_test(uncorrelated_elements_equal_scalar_updates),
        cmocka_unit_test(elements_of_a_closed_axis_are_left_out),
        cmocka_unit_test(a_vague_start_with_thin_ellipses_stays_positive_definite),
        cmocka_unit_test(random_correlated_updates_stay_positive_definite),
        cmocka_unit_test(bad_measurements_are_refused),
        cmocka_unit_test(an_update_that_fails_at_its_last_element_changes_nothing),
        cmocka_unit_test(null_is_refused),
        cmocka_unit_test(noise_is_added_to_open_axes),
        cmocka_unit_test(bad_noise_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
