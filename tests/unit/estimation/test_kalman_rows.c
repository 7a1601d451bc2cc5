/* SPDX-License-Identifier: MIT */
/*
 * The Kalman filter's updates by rows and by range rates, compared with full matrices in double
 * precision.
 */
#include <float.h>

#include "dense_filter.h"
#include "kalman_checks.h"

/* Tolerances in sigmas of the estimate before; largest seen: 1.4e-6 and 9.4e-6. */
#define ROW_RELATIVE 4e-6
#define RATE_RELATIVE 4e-5

#define NUM_CASES 2000

static const float some_row[STATES] = {0.5f, -0.25f, 0.75f, 1.5f, -2.0f, 0.125f};

static const struct rho_sensor somewhere = {
    .sensor_id = 3, .x_m = 1200.0f, .y_m = -3400.0f, .z_m = 250.0f};

/* --- rows ------------------------------------------------------------------------------------- */

static struct rho_kalman random_estimate(double decades)
{
    struct rho_kalman kalman;

    random_covariance(kalman.covariance, decades);
    for (int i = 0; i < STATES; ++i) {
        kalman.state[i] = (float)(i < 3 ? uniform(-3e4, 3e4) : uniform(-400.0, 400.0));
    }
    return kalman;
}

static void rows_agree_with_the_joseph_form(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman kalman = random_estimate(3.0);
        const struct dense before = dense_of(kalman.state, kalman.covariance);
        struct dense expected = before;
        float row[STATES];

        for (int i = 0; i < STATES; ++i) {
            row[i] = (float)normal();
        }
        const struct dense_measurement measured = dense_row_measurement(row, 12.5, 4.0);
        (void)dense_update(&expected, &measured);
        assert_int_equal(rho_kalman_update_row(&kalman, row, 12.5f, 4.0f), RHO_OK);
        assert_near_dense(kalman.state, kalman.covariance, &expected, &before, ROW_RELATIVE);
        assert_true(is_positive_definite(&kalman));
    }
}

/*
 * (x + y) / 2, of variance 2, is measured 6 above its estimate with variance 2: it moves half way.
 */
static void a_row_update_agrees_with_a_result_by_hand(void **state)
{
    const float mean[STATES] = {0.5f, 0.5f};
    struct rho_kalman kalman = opened_filter(2, 4.0f, 9.0f);

    (void)state;
    assert_int_equal(rho_kalman_update_row(&kalman, mean, 6.0f, 2.0f), RHO_OK);
    assert_float_equal(kalman.state[0], 103.0, 1e-4);
    assert_float_equal(kalman.state[1], 203.0, 1e-4);
    assert_float_equal(kalman.covariance[RHO_AT(0, 0)], 3.0, 1e-5);
    assert_float_equal(kalman.covariance[RHO_AT(1, 1)], 3.0, 1e-5);
    assert_float_equal(kalman.covariance[RHO_AT(1, 0)], -1.0, 1e-5);
    assert_float_equal(kalman.covariance[RHO_AT(3, 3)], 9.0, 1e-4);
    assert_true(kalman.state[3] == 0.0f);
    assert_int_equal(rho_kalman_update_row(&kalman, mean, 6.0f, 2.0f), RHO_OK);
}

static void rows_leave_a_closed_axis_zero(void **state)
{
    struct rho_kalman kalman = opened_filter(2, 4.0f, 9.0f);

    (void)state;
    for (int k = 0; k < 20; ++k) {
        assert_int_equal(rho_kalman_predict(&kalman, 1.5f, 3.0f), RHO_OK);
        assert_int_equal(rho_kalman_update_row(&kalman, some_row, 5.0f, 2.0f), RHO_OK);
        assert_true(kalman.state[2] == 0.0f && kalman.state[5] == 0.0f);
        for (int i = 0; i < STATES; ++i) {
            assert_true(kalman.covariance[RHO_AT(2, i)] == 0.0f);
            assert_true(kalman.covariance[RHO_AT(5, i)] == 0.0f);
        }
    }
}

/* A measurement variance below the minimum has the same effect as the minimum. */
static void row_variances_below_the_minimum_act_as_the_minimum(void **state)
{
    const float variances[] = {1e-30f, FLT_TRUE_MIN, 0.5f * RHO_VARIANCE_MIN};

    (void)state;
    for (int element = 0; element < STATES; ++element) {
        struct rho_kalman floor = opened_filter(3, 2e-9f, 2e-9f);
        const struct rho_kalman before = floor;
        float row[STATES] = {0.0f};

        row[element] = 1.0f;
        assert_int_equal(rho_kalman_update_row(&floor, row, 3e-5f, RHO_VARIANCE_MIN), RHO_OK);
        assert_true(floor.covariance[RHO_AT(element, element)] == RHO_VARIANCE_MIN);
        assert_finite_with_variances_in_limits(&floor);
        for (size_t k = 0; k < NUM(variances); ++k) {
            struct rho_kalman kalman = before;

            assert_int_equal(rho_kalman_update_row(&kalman, row, 3e-5f, variances[k]), RHO_OK);
            assert_memory_equal(&kalman, &floor, sizeof floor);
        }
    }
}

/* At first each row is measured 10^8 times better than predicted; predictions in between. */
static void a_vague_start_with_sharp_rows_stays_positive_definite(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES / 10; ++n) {
        struct rho_kalman kalman = opened_filter(3, 1e8f, 1e8f);

        for (int k = 0; k < 60; ++k) {
            float row[STATES];

            for (int i = 0; i < STATES; ++i) {
                row[i] = (float)normal();
            }
            assert_int_equal(rho_kalman_update_row(&kalman, row, (float)normal(), 1.0f), RHO_OK);
            assert_finite_with_variances_in_limits(&kalman);
            assert_true(is_positive_definite(&kalman));
            assert_int_equal(rho_kalman_predict(&kalman, 1.0f, 0.0f), RHO_OK);
            assert_true(is_positive_definite(&kalman));
        }
    }
}

/* --- refusals --------------------------------------------------------------------------------- */

static void assert_row_refused(struct rho_kalman kalman, const float *row, float innovation,
                               float variance, enum rho_status expected)
{
    const struct rho_kalman before = kalman;

    assert_int_equal(rho_kalman_update_row(&kalman, row, innovation, variance), expected);
    assert_changed_nothing(&kalman, &before);
}

static void a_row_update_refuses_bad_arguments(void **state)
{
    const struct rho_kalman kalman = opened_filter(3, 4.0f, 9.0f);
    const float bad_innovations[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX};
    const float bad_variances[] = {0.0f, -0.0f, -1.0f, NAN, INFINITY, -INFINITY};
    const float bad_elements[] = {NAN, INFINITY, -INFINITY, FLT_MAX};

    (void)state;
    for (size_t k = 0; k < NUM(bad_innovations); ++k) {
        assert_row_refused(kalman, some_row, bad_innovations[k], 1.0f, RHO_ERROR_VALUE);
    }
    for (size_t k = 0; k < NUM(bad_variances); ++k) {
        assert_row_refused(kalman, some_row, 1.0f, bad_variances[k], RHO_ERROR_VALUE);
    }
    for (size_t k = 0; k < NUM(bad_elements); ++k) {
        for (int i = 0; i < STATES; ++i) {
            float row[STATES];

            memcpy(row, some_row, sizeof row);
            row[i] = bad_elements[k];
            assert_row_refused(kalman, row, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
        }
    }
}

static void a_row_update_refuses_a_bad_estimate(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};
    const float sum[STATES] = {1.0f, 1.0f};
    struct rho_kalman kalman;

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int i = 0; i < STATES; ++i) {
            kalman = opened_filter(3, 4.0f, 9.0f);
            kalman.state[i] = bad[k];
            assert_row_refused(kalman, some_row, 1.0f, 1.0f, RHO_ERROR_VALUE);
        }
        for (int place = 0; place < PACKED; ++place) {
            kalman = opened_filter(3, 4.0f, 9.0f);
            kalman.covariance[place] = bad[k];
            assert_row_refused(kalman, some_row, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
        }
    }
    kalman = opened_filter(3, 4.0f, 9.0f);
    kalman.covariance[RHO_AT(1, 0)] = -5.0f; /* the variance of x + y is -2 */
    assert_row_refused(kalman, sum, 1.0f, 3.0f, RHO_ERROR_SINGULAR);
}

/* --- range rates ------------------------------------------------------------------------------ */

/* Closes the z axis, as in a filter of two axes. */
static void close_heights(struct rho_kalman *kalman)
{
    for (int i = 0; i < STATES; ++i) {
        kalman->covariance[RHO_AT(2, i)] = kalman->covariance[RHO_AT(5, i)] = 0.0f;
    }
    kalman->state[2] = kalman->state[5] = 0.0f;
}

static void range_rates_agree_with_the_linearised_filter(void **state)
{
    const double here[3] = {0.0}, there[3] = {1200.0, -3400.0, 250.0};

    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        struct rho_kalman kalman = random_estimate(2.0);
        const int has_sensor = n % 2, axes = n % 3 == 0 ? 2 : 3;
        const float variance = (float)pow(10.0, uniform(-1.0, 2.0));

        if (axes == 2) {
            close_heights(&kalman);
        }
        const struct dense before = dense_of(kalman.state, kalman.covariance);
        struct dense expected = before;
        const struct dense_measurement measured =
            dense_range_rate(&before, has_sensor ? there : here, axes, -50.0, variance);
        dense_update(&expected, &measured);
        assert_int_equal(
            rho_kalman_update_range_rate(&kalman, has_sensor ? &somewhere : NULL, -50.0f, variance),
            RHO_OK);
        assert_near_dense(kalman.state, kalman.covariance, &expected, &before, RATE_RELATIVE);
        assert_true(is_positive_definite(&kalman));
    }
}

/* A target on the x axis: the range rate measures its velocity along x. */
static void a_range_rate_update_agrees_with_a_result_by_hand(void **state)
{
    struct rho_kalman kalman = opened_filter(1, 4.0f, 9.0f);

    (void)state;
    kalman.state[0] = -500.0f;
    assert_int_equal(rho_kalman_update_range_rate(&kalman, NULL, -30.0f, 9.0f), RHO_OK);
    /* -30 m/s is an approach, +30 m/s along x: half way from 0 */
    assert_float_equal(kalman.state[3], 15.0, 1e-4);
    assert_float_equal(kalman.covariance[RHO_AT(3, 3)], 4.5, 1e-5);
    assert_float_equal(kalman.covariance[0], 4.0, 1e-4);
    assert_true(kalman.state[0] == -500.0f);
}

static void a_range_rate_at_the_sensors_place_changes_nothing(void **state)
{
    struct rho_kalman kalman = opened_filter(3, 4.0f, 9.0f);

    (void)state;
    kalman.state[0] = 1200.5f;
    kalman.state[1] = -3400.5f;
    kalman.state[2] = 250.5f;
    const struct rho_kalman before = kalman;
    assert_int_equal(rho_kalman_update_range_rate(&kalman, &somewhere, 30.0f, 9.0f), RHO_OK);
    assert_changed_nothing(&kalman, &before);
    kalman.state[2] = 251.5f;
    assert_int_equal(rho_kalman_update_range_rate(&kalman, &somewhere, 30.0f, 9.0f), RHO_OK);
    assert_true(kalman.state[5] > before.state[5]);
}

/*
 * Near the sensor the line of sight is uncertain, and a range rate tells little about the velocity.
 */
static void a_range_rate_near_the_sensor_has_little_weight(void **state)
{
    struct rho_kalman near = opened_filter(2, 900.0f, 1e4f), far = near;

    (void)state;
    near.state[1] = far.state[1] = 0.0f;
    near.state[0] = 45.0f;
    far.state[0] = 45000.0f;
    near.state[3] = far.state[3] = 200.0f;
    assert_int_equal(rho_kalman_update_range_rate(&near, NULL, 190.0f, 1.0f), RHO_OK);
    assert_int_equal(rho_kalman_update_range_rate(&far, NULL, 190.0f, 1.0f), RHO_OK);
    assert_true(near.covariance[RHO_AT(3, 3)] > 5000.0f);
    assert_true(far.covariance[RHO_AT(3, 3)] < 1.1f);
}

static void assert_rate_refused(struct rho_kalman kalman, float rate_mps, float variance,
                                enum rho_status expected)
{
    const struct rho_kalman before = kalman;

    assert_int_equal(rho_kalman_update_range_rate(&kalman, &somewhere, rate_mps, variance),
                     expected);
    assert_changed_nothing(&kalman, &before);
}

static void range_rates_refuse_bad_arguments(void **state)
{
    const float bad_rates[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX};
    const float bad_variances[] = {0.0f, -0.0f, -1.0f, NAN, INFINITY, -INFINITY};
    struct rho_kalman kalman = opened_filter(3, 4.0f, 9.0f);

    (void)state;
    for (size_t k = 0; k < NUM(bad_rates); ++k) {
        assert_rate_refused(kalman, bad_rates[k], 1.0f, RHO_ERROR_VALUE);
    }
    for (size_t k = 0; k < NUM(bad_variances); ++k) {
        assert_rate_refused(kalman, 1.0f, bad_variances[k], RHO_ERROR_VALUE);
    }
    for (int i = 0; i < STATES; ++i) {
        kalman = opened_filter(3, 4.0f, 9.0f);
        kalman.covariance[RHO_AT(i, i)] = i < 3 ? INFINITY : NAN;
        assert_rate_refused(kalman, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
    }
    kalman = opened_filter(3, 4.0f, 9.0f);
    kalman.state[4] = NAN;
    assert_rate_refused(kalman, 1.0f, 1.0f, RHO_ERROR_VALUE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_agree_with_the_joseph_form),
        cmocka_unit_test(a_row_update_agrees_with_a_result_by_hand),
        cmocka_unit_test(rows_leave_a_closed_axis_zero),
        cmocka_unit_test(row_variances_below_the_minimum_act_as_the_minimum),
        cmocka_unit_test(a_vague_start_with_sharp_rows_stays_positive_definite),
        cmocka_unit_test(a_row_update_refuses_bad_arguments),
        cmocka_unit_test(a_row_update_refuses_a_bad_estimate),
        cmocka_unit_test(range_rates_agree_with_the_linearised_filter),
        cmocka_unit_test(a_range_rate_update_agrees_with_a_result_by_hand),
        cmocka_unit_test(a_range_rate_at_the_sensors_place_changes_nothing),
        cmocka_unit_test(a_range_rate_near_the_sensor_has_little_weight),
        cmocka_unit_test(range_rates_refuse_bad_arguments),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
