/* SPDX-License-Identifier: MIT */
/* The Kalman filter at its limits: refused calls, and rounding in extreme cases. */
#include <float.h>
#include <string.h>

#include "kalman_checks.h"

/* --- refusals --------------------------------------------------------------------------------- */

static void open_axis_refuses_bad_arguments(void **state)
{
    const float bad_variances[] = {0.0f,
                                   -1.0f,
                                   NAN,
                                   INFINITY,
                                   -INFINITY,
                                   nextafterf(RHO_VARIANCE_MIN, 0.0f),
                                   nextafterf(RHO_VARIANCE_MAX, INFINITY)};
    const float bad_positions[] = {NAN, INFINITY, -INFINITY};
    const int bad_axes[] = {-1, 3, INT32_MAX, INT32_MIN};
    struct rho_kalman kalman = opened_filter(2, 4.0f, 9.0f);
    const struct rho_kalman before = kalman;

    (void)state;
    for (size_t i = 0; i < NUM(bad_variances); ++i) {
        assert_int_equal(rho_kalman_open_axis(&kalman, 0, 0.0f, bad_variances[i], 1.0f),
                         RHO_ERROR_VALUE);
        assert_int_equal(rho_kalman_open_axis(&kalman, 0, 0.0f, 1.0f, bad_variances[i]),
                         RHO_ERROR_VALUE);
    }
    for (size_t i = 0; i < NUM(bad_positions); ++i) {
        assert_int_equal(rho_kalman_open_axis(&kalman, 0, bad_positions[i], 1.0f, 1.0f),
                         RHO_ERROR_VALUE);
    }
    for (size_t i = 0; i < NUM(bad_axes); ++i) {
        assert_int_equal(rho_kalman_open_axis(&kalman, bad_axes[i], 0.0f, 1.0f, 1.0f),
                         RHO_ERROR_VALUE);
    }
    assert_changed_nothing(&kalman, &before);
    assert_int_equal(rho_kalman_open_axis(&kalman, 0, 0.0f, RHO_VARIANCE_MIN, RHO_VARIANCE_MAX),
                     RHO_OK);
}

static void assert_prediction_refused(struct rho_kalman kalman, float dt_s, float noise_density)
{
    const struct rho_kalman before = kalman;

    assert_int_equal(rho_kalman_predict(&kalman, dt_s, noise_density), RHO_ERROR_VALUE);
    assert_changed_nothing(&kalman, &before);
}

static void the_longest_prediction_is_accepted(void **state)
{
    struct rho_kalman kalman = opened_filter(3, 1.0f, 1e-3f);

    (void)state;
    assert_int_equal(rho_kalman_predict(&kalman, 1e5f, 0.0f), RHO_OK);
    assert_float_equal(kalman.covariance[0], 1e7, 100.0);
    assert_int_equal(rho_kalman_predict(&kalman, -1e5f, 0.0f), RHO_OK);
    assert_true(is_positive_definite(&kalman));
}

static void a_prediction_refuses_bad_arguments(void **state)
{
    const struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);
    const float bad_times[] = {NAN, INFINITY, -INFINITY, 1.0001e5f, -1.0001e5f, FLT_MAX};
    const float bad_densities[] = {NAN, INFINITY, -INFINITY, -1e-9f, -FLT_MAX};

    (void)state;
    for (size_t i = 0; i < NUM(bad_times); ++i) {
        assert_prediction_refused(kalman, bad_times[i], 1.0f);
    }
    for (size_t i = 0; i < NUM(bad_densities); ++i) {
        assert_prediction_refused(kalman, 1.0f, bad_densities[i]);
        assert_prediction_refused(kalman, 0.0f, bad_densities[i]);
    }
}

static void a_prediction_beyond_the_largest_variance_is_refused(void **state)
{
    (void)state;
    /* a position variance of 1e14 */
    assert_prediction_refused(opened_filter(3, 1.0f, 1e4f), 1e5f, 0.0f);
    assert_prediction_refused(opened_filter(3, 1.0f, 1e4f), -1e5f, 0.0f);
    /* a velocity variance beyond the limit */
    assert_prediction_refused(opened_filter(1, 1.0f, 1e12f), 0.001f, 1e9f);
    assert_prediction_refused(opened_filter(3, 1.0f, 1.0f), 1.0f, FLT_MAX);
    assert_prediction_refused(opened_filter(3, 1.0f, 1.0f), 1e5f, 1.0f);
    for (int axis = 0; axis < 3; ++axis) {
        struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);

        kalman.state[axis] = FLT_MAX;
        kalman.state[axis + 3] = FLT_MAX;
        assert_prediction_refused(kalman, 1.0f, 1.0f);
    }
}

static void a_prediction_refuses_a_bad_estimate(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int i = 0; i < STATES; ++i) {
            struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);

            kalman.state[i] = bad[k];
            assert_prediction_refused(kalman, 1.0f, 1.0f);
            kalman = opened_filter(3, 1.0f, 1.0f);
            kalman.covariance[RHO_AT(i, i)] = i < 3 && bad[k] < 0.0f ? NAN : bad[k];
            assert_prediction_refused(kalman, 1.0f, 1.0f);
        }
        struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);
        kalman.covariance[RHO_AT(3, 0)] = bad[k] < 0.0f ? NAN : bad[k];
        assert_prediction_refused(kalman, 1.0f, 1.0f);
    }
}

static void assert_update_refused(struct rho_kalman kalman, int element, float value,
                                  float variance, enum rho_status expected)
{
    const struct rho_kalman before = kalman;
    float nis = GUARD;

    assert_int_equal(rho_kalman_update(&kalman, element, value, variance, &nis), expected);
    assert_changed_nothing(&kalman, &before);
    assert_true(nis == GUARD);
}

static void an_update_refuses_bad_arguments(void **state)
{
    const struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);
    const float bad_values[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX};
    const float bad_variances[] = {0.0f, -0.0f, -1.0f, NAN, INFINITY, -INFINITY};
    const int bad_elements[] = {-1, STATES, INT32_MAX, INT32_MIN};

    (void)state;
    for (size_t i = 0; i < NUM(bad_values); ++i) {
        assert_update_refused(kalman, 1, bad_values[i], 1.0f, RHO_ERROR_VALUE);
    }
    for (size_t i = 0; i < NUM(bad_variances); ++i) {
        assert_update_refused(kalman, 1, 1.0f, bad_variances[i], RHO_ERROR_VALUE);
    }
    for (size_t i = 0; i < NUM(bad_elements); ++i) {
        assert_update_refused(kalman, bad_elements[i], 1.0f, 1.0f, RHO_ERROR_VALUE);
    }
}

static void an_update_refuses_a_bad_estimate(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (size_t k = 0; k < NUM(bad); ++k) {
        for (int i = 0; i < STATES; ++i) {
            struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);

            kalman.covariance[RHO_AT(i, i)] = bad[k];
            assert_update_refused(kalman, i, 1.0f, 1.0f, RHO_ERROR_SINGULAR);
            kalman = opened_filter(3, 1.0f, 1.0f);
            kalman.state[i] = bad[k];
            assert_update_refused(kalman, 2, 1.0f, 1.0f, RHO_ERROR_VALUE);
        }
    }
    struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);
    kalman.covariance[RHO_AT(1, 1)] = -2.0f;
    assert_update_refused(kalman, 1, 1.0f, 3.0f, RHO_ERROR_SINGULAR);
}

/* The gain underflows in float, which must not make the estimate certain. */
static void a_measurement_of_huge_variance_changes_no_covariance(void **state)
{
    const float variances[] = {1e30f, 1e38f, 3e38f, FLT_MAX};

    (void)state;
    for (size_t i = 0; i < NUM(variances); ++i) {
        struct rho_kalman kalman = opened_filter(3, RHO_VARIANCE_MIN, RHO_VARIANCE_MIN);
        const struct rho_kalman before = kalman;

        assert_int_equal(rho_kalman_update(&kalman, 0, 5.0f, variances[i], NULL), RHO_OK);
        assert_int_equal(rho_kalman_update(&kalman, 3, 5.0f, variances[i], NULL), RHO_OK);
        assert_memory_equal(kalman.covariance, before.covariance, sizeof before.covariance);
        assert_float_equal(kalman.state[0], before.state[0], 0.0);
        assert_float_equal(kalman.state[3], before.state[3], 1e-30);
    }
}

static void variances_do_not_fall_below_their_minimum(void **state)
{
    (void)state;
    for (int element = 0; element < STATES; ++element) {
        struct rho_kalman kalman = opened_filter(3, 1.0f, 1.0f);

        assert_int_equal(rho_kalman_update(&kalman, element, 1.0f, 1e-30f, NULL), RHO_OK);
        assert_true(kalman.covariance[RHO_AT(element, element)] == RHO_VARIANCE_MIN);
        assert_finite_with_variances_in_limits(&kalman);
        assert_true(is_positive_definite(&kalman));
    }
}

/* --- extreme cases ---------------------------------------------------------------------------- */

/*
 * Plots are 5e8 times more certain than the prediction: the velocity variance cancels in every
 * digit.
 */
static void a_vague_start_with_a_sharp_sensor_stays_positive_definite(void **state)
{
    const float vague = 5e8f;
    struct rho_kalman kalman = opened_filter(3, vague, vague);

    (void)state;
    for (int k = 0; k < 60; ++k) {
        if (k > 0) {
            assert_int_equal(rho_kalman_predict(&kalman, 1.0f, 0.0f), RHO_OK);
            assert_true(is_positive_definite(&kalman));
        }
        for (int axis = 0; axis < 3; ++axis) {
            const float position = 1000.0f + 30.0f * (float)(axis + 1) * (float)k;

            assert_int_equal(rho_kalman_update(&kalman, axis, position, 1.0f, NULL), RHO_OK);
            assert_true(is_positive_definite(&kalman));
        }
        assert_finite_with_variances_in_limits(&kalman);
    }
    /* a line fitted through n = 60 points of variance 1 has variances of 4 / n and 12 / n^3 */
    for (int axis = 0; axis < 3; ++axis) {
        assert_float_equal(kalman.state[axis + 3], 30.0 * (axis + 1), 0.01);
        assert_float_equal(kalman.state[axis], 1000.0 + 30.0 * (axis + 1) * 59, 0.01);
        assert_in_range(kalman.covariance[RHO_AT(axis, axis)] * 60e3f, 3800, 4200);
        assert_in_range(kalman.covariance[RHO_AT(axis + 3, axis + 3)] * 216e6f, 11000, 13000);
    }
}

static uint32_t seed;

static float random_power(float lowest_exponent, float highest_exponent)
{
    seed = seed * 1664525u + 1013904223u;
    return powf(10.0f, lowest_exponent +
                           (highest_exponent - lowest_exponent) * (float)(seed >> 8) / 16777216.0f);
}

static int random_below(int n)
{
    seed = seed * 1664525u + 1013904223u;
    return (int)(((uint64_t)seed * (uint64_t)n) >> 32);
}

/* The given value, or in one call of ten NAN, infinity, 0 or an extreme value. */
static float usual_or_hostile(float usual)
{
    static const float nonsense[] = {NAN,      INFINITY,     -INFINITY, FLT_MAX,
                                     -FLT_MAX, FLT_TRUE_MIN, 0.0f,      -1.0f};

    return random_below(10) == 0 ? nonsense[random_below(NUM(nonsense))] : usual;
}

static enum rho_status make_random_call(struct rho_kalman *kalman)
{
    const float sign = random_below(4) == 0 ? -1.0f : 1.0f;
    float nis;

    switch (random_below(20)) {
    case 0:
        return rho_kalman_open_axis(kalman, random_below(4),
                                    usual_or_hostile(random_power(-3.0f, 7.0f)),
                                    usual_or_hostile(random_power(-9.0f, 12.0f)),
                                    usual_or_hostile(random_power(-9.0f, 12.0f)));
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
        return rho_kalman_predict(kalman, usual_or_hostile(sign * random_power(-4.0f, 5.0f)),
                                  usual_or_hostile(random_power(-6.0f, 6.0f)));
    default:
        return rho_kalman_update(kalman, random_below(7) - (random_below(50) == 0),
                                 usual_or_hostile(sign * random_power(-3.0f, 7.0f)),
                                 usual_or_hostile(random_power(-12.0f, 12.0f)), &nis);
    }
}

static void a_million_random_calls_leave_a_valid_covariance(void **state)
{
    struct rho_kalman kalman;
    int accepted = 0;

    (void)state;
    seed = 99;
    rho_kalman_init(&kalman);
    for (int i = 0; i < 1000000; ++i) {
        const struct rho_kalman before = kalman;
        const enum rho_status status = make_random_call(&kalman);

        accepted += status == RHO_OK;
        if (status != RHO_OK) {
            assert_changed_nothing(&kalman, &before);
        }
        assert_finite_with_variances_in_limits(&kalman);
        assert_true(is_positive_definite(&kalman));
    }
    assert_in_range(accepted, 500000, 900000); /* neither all calls are refused nor none */
}

static void the_same_calls_give_the_same_bits(void **state)
{
    struct rho_kalman one, other;

    (void)state;
    memset(&one, 0x11, sizeof one);
    memset(&other, 0xee, sizeof other);
    struct rho_kalman *const kalmans[] = {&one, &other};
    for (int k = 0; k < 2; ++k) {
        seed = 4711;
        rho_kalman_init(kalmans[k]);
        for (int i = 0; i < 5000; ++i) {
            (void)!make_random_call(kalmans[k]);
        }
    }
    assert_memory_equal(&one, &other, sizeof one);
}

/* Three standard deviations of the innovation must be within half the span: 3 * 15 < 50. */
static void an_ambiguous_range_rate_is_unfolded_if_the_estimate_is_sharp(void **state)
{
    struct rho_sensor sensor = {.range_rate_span_mps = 100.0f};
    struct rho_kalman_row seen;
    struct rho_kalman at;

    (void)state;
    for (int is_vague = 0; is_vague < 2; ++is_vague) {
        const float variance = is_vague ? 324.0f : 224.0f;

        rho_kalman_init(&at);
        for (int axis = 0; axis < 2; ++axis) {
            assert_int_equal(rho_kalman_open_axis(&at, axis, axis ? 0.0f : 1e4f, 1.0f, variance),
                             RHO_OK);
        }
        assert_true(rho_kalman_linearise_rate(&at, &sensor, 0.0f, 1.0f, &seen));
        assert_int_equal(rho_kalman_can_unfold(&at, &sensor, &seen) != 0, !is_vague);
        assert_true(rho_kalman_can_unfold(&at, NULL, &seen));
    }
    sensor.range_rate_span_mps = 0.0f; /* 0: range rates are not ambiguous */
    assert_true(rho_kalman_can_unfold(&at, &sensor, &seen));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(open_axis_refuses_bad_arguments),
        cmocka_unit_test(the_longest_prediction_is_accepted),
        cmocka_unit_test(a_prediction_refuses_bad_arguments),
        cmocka_unit_test(a_prediction_beyond_the_largest_variance_is_refused),
        cmocka_unit_test(a_prediction_refuses_a_bad_estimate),
        cmocka_unit_test(an_update_refuses_bad_arguments),
        cmocka_unit_test(an_update_refuses_a_bad_estimate),
        cmocka_unit_test(a_measurement_of_huge_variance_changes_no_covariance),
        cmocka_unit_test(variances_do_not_fall_below_their_minimum),
        cmocka_unit_test(a_vague_start_with_a_sharp_sensor_stays_positive_definite),
        cmocka_unit_test(a_million_random_calls_leave_a_valid_covariance),
        cmocka_unit_test(the_same_calls_give_the_same_bits),
        cmocka_unit_test(an_ambiguous_range_rate_is_unfolded_if_the_estimate_is_sharp),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
