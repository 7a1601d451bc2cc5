/* SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/types.h"

#define SECONDS_RELATIVE 1.2e-7

static void every_fate_has_its_name(void **state)
{
    static const char *const names[RHO_NUM_FATES] = {"claimed", "held",    "ghost",
                                                     "stale",   "invalid", "no_room"};

    (void)state;
    for (int i = 0; i < RHO_NUM_FATES; ++i) {
        assert_string_equal(rho_fate_name((enum rho_fate)i), names[i]);
    }
}

static void fates_out_of_range_are_named_unknown(void **state)
{
    const int others[] = {RHO_NUM_FATES, 255, 256, INT32_MAX, -1, INT32_MIN};

    (void)state;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        enum rho_fate fate;

        _Static_assert(sizeof fate == sizeof others[0], "an enum of another size");
        memcpy(&fate, &others[i], sizeof fate);
        assert_string_equal(rho_fate_name(fate), "unknown");
    }
}

static void counters_saturate(void **state)
{
    (void)state;
    assert_int_equal(rho_count(0, 0), 0);
    assert_int_equal(rho_count(0, 1), 1);
    assert_int_equal(rho_count(40, 2), 42);
    assert_int_equal(rho_count(UINT32_MAX - 1, 1), UINT32_MAX);
    assert_int_equal(rho_count(UINT32_MAX - 2, 1), UINT32_MAX - 1);
    assert_int_equal(rho_count(UINT32_MAX, 0), UINT32_MAX);
    assert_int_equal(rho_count(UINT32_MAX, 1), UINT32_MAX);
    assert_int_equal(rho_count(1, UINT32_MAX), UINT32_MAX);
    assert_int_equal(rho_count(0, UINT32_MAX), UINT32_MAX);
    assert_int_equal(rho_count(UINT32_MAX, UINT32_MAX), UINT32_MAX);
    assert_int_equal(rho_count(0x80000000u, 0x80000000u), UINT32_MAX);
    assert_int_equal(rho_count(0x80000000u, 0x7fffffffu), UINT32_MAX);
    assert_int_equal(rho_count(0x80000000u, 0x7ffffffeu), UINT32_MAX - 1);
}

static void set_bits_are_counted(void **state)
{
    (void)state;
    uint32_t mask = 0;
    assert_int_equal(rho_count_bits(0), 0);
    assert_int_equal(rho_count_bits(UINT32_MAX), 32);
    for (unsigned i = 0; i < 32; i++) {
        assert_int_equal(rho_count_bits(UINT32_C(1) << i), 1);
        mask |= UINT32_C(1) << (i * 11 % 32);
        assert_int_equal(rho_count_bits(mask), i + 1);
        assert_int_equal(rho_count_bits(~mask), 31 - i);
    }
}

static void short_time_spans_are_rounded_once(void **state)
{
    (void)state;
    for (int64_t span = 0; span <= 1 << 24; span += 37) {
        const float expected = (float)((double)span / 1e6);

        assert_true(rho_seconds_between(1000, 1000 + span) == expected);
        assert_true(rho_seconds_between(1000 + span, 1000) == -expected);
    }
}

/* Spans have the bits of the compiler's conversion, also half way between two floats. */
static void long_time_spans_are_rounded_once(void **state)
{
    uint64_t random = 1;
    (void)state;
    for (int i = 0; i < 200000; i++) {
        random = random * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        const int width = 24 + i % 40;
        const uint64_t half = UINT64_C(1) << (width > 24 ? width - 25 : 0);
        uint64_t span = random >> (64 - width) | UINT64_C(1) << (width - 1);
        if (i % 3 == 0) { /* half way between two floats, and 1 us beside it */
            span = (span & ~(2 * half - 1)) + half + (uint64_t)(i % 9) / 3 - 1;
        }
        span &= INT64_MAX;
        assert_true(rho_seconds_between(0, (int64_t)span) == (float)span / 1.0e6f);
    }
    assert_true(rho_seconds_between(INT64_MIN, INT64_MAX) == (float)UINT64_MAX / 1.0e6f);
    assert_true(rho_elapsed_us(INT64_MAX, INT64_MIN) == UINT64_MAX);
    assert_true(rho_elapsed_us(INT64_MIN, INT64_MAX) == 0 && rho_elapsed_us(7, 7) == 0);
    assert_true(rho_elapsed_us(8, -7) == 15);
}

static void assert_seconds_between(int64_t from_us, int64_t to_us)
{
    const double expected = ((double)to_us - (double)from_us) / 1e6;
    const double got = rho_seconds_between(from_us, to_us);

    assert_true(fabs(got - expected) <= SECONDS_RELATIVE * fabs(expected));
    assert_true(rho_seconds_between(to_us, from_us) == -rho_seconds_between(from_us, to_us));
}

/* Signed overflow would be reported by the sanitizer; wrapping would show in the values. */
static void the_span_between_any_two_times_does_not_overflow(void **state)
{
    const int64_t times[] = {
        INT64_MIN, INT64_MIN + 1,    -(INT64_C(1) << 40), -1000001,      -1,       0, 1,
        16777217,  1700000000000000, INT64_C(1) << 62,    INT64_MAX - 1, INT64_MAX};
    const size_t n = sizeof times / sizeof times[0];

    (void)state;
    for (size_t i = 0; i < n; ++i) {
        assert_true(rho_seconds_between(times[i], times[i]) == 0.0f);
        for (size_t j = 0; j < n; ++j) {
            /* A double cannot tell apart times this large that differ by little. */
            if (llabs((times[i] >> 1) - (times[j] >> 1)) > 4096) {
                assert_seconds_between(times[i], times[j]);
            }
        }
    }
    assert_true(rho_seconds_between(INT64_MIN, INT64_MIN + 1) == 1e-6f);
    assert_true(rho_seconds_between(INT64_MAX, INT64_MAX - 1) == -1e-6f);
    assert_true(rho_seconds_between(-1, 1) == 2e-6f);
}

static void a_range_includes_its_ends(void **state)
{
    (void)state;
    assert_int_equal(rho_is_within(1.0f, 1.0f, 2.0f), 1);
    assert_int_equal(rho_is_within(2.0f, 1.0f, 2.0f), 1);
    assert_int_equal(rho_is_within(1.5f, 1.0f, 2.0f), 1);
    assert_int_equal(rho_is_within(-0.0f, 0.0f, 2.0f), 1);
    assert_int_equal(rho_is_within(nextafterf(1.0f, 0.0f), 1.0f, 2.0f), 0);
    assert_int_equal(rho_is_within(nextafterf(2.0f, 3.0f), 1.0f, 2.0f), 0);
    assert_int_equal(rho_is_within(1.5f, 2.0f, 1.0f), 0);
    assert_int_equal(rho_is_within(FLT_TRUE_MIN, 0.0f, FLT_MIN), 1);
}

static void values_that_are_not_finite_are_in_no_range(void **state)
{
    (void)state;
    assert_int_equal(rho_is_within(NAN, -INFINITY, INFINITY), 0);
    assert_int_equal(rho_is_within(INFINITY, -INFINITY, INFINITY), 0);
    assert_int_equal(rho_is_within(-INFINITY, -INFINITY, INFINITY), 0);
    assert_int_equal(rho_is_within(FLT_MAX, -INFINITY, INFINITY), 1);
    assert_int_equal(rho_is_within(-FLT_MAX, -FLT_MAX, FLT_MAX), 1);
    assert_int_equal(rho_is_within(0.0f, NAN, 1.0f), 0);
    assert_int_equal(rho_is_within(0.0f, -1.0f, NAN), 0);
}

static void the_noise_of_a_plot_is_its_larger_horizontal_sigma(void **state)
{
    struct rho_plot plot = {.sigma_range_m = 15.0f, .sigma_cross_m = 180.0f, .sigma_up_m = 900.0f};

    (void)state;
    assert_true(rho_plot_sigma_m(&plot) == 180.0f);
    plot.sigma_cross_m = 7.0f;
    assert_true(rho_plot_sigma_m(&plot) == 15.0f);
}

static void nan_and_infinity_are_not_finite(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (size_t place = 0; place < 3; ++place) {
        for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
            float values[3] = {-FLT_MAX, 0.0f, FLT_MAX};

            assert_true(rho_is_finite(values[place]));
            assert_true(rho_are_finite(values, 3));
            values[place] = bad[i];
            assert_false(rho_is_finite(values[place]));
            assert_false(rho_are_finite(values, 3));
            assert_true(rho_are_finite(values, place)); /* the elements before the bad one */
        }
    }
}

static void each_of_several_values_is_within_both_limits(void **state)
{
    (void)state;
    for (size_t place = 0; place < 3; place++) {
        float values[3] = {-1.0f, 0.5f, 2.0f};
        assert_true(rho_are_within(values, 3, -1.0f, 2.0f));
        values[place] = place % 2 ? nextafterf(2.0f, 3.0f) : nextafterf(-1.0f, -2.0f);
        assert_false(rho_are_within(values, 3, -1.0f, 2.0f));
        assert_true(rho_are_within(values, place, -1.0f, 2.0f));
        values[place] = NAN;
        assert_false(rho_are_within(values, 3, -1.0f, 2.0f));
    }
}

static void coordinates_beyond_their_limit_are_refused(void **state)
{
    (void)state;
    assert_true(rho_is_coordinate(RHO_LIMIT_POSITION_M));
    assert_true(rho_is_coordinate(-RHO_LIMIT_POSITION_M));
    assert_false(rho_is_coordinate(nextafterf(RHO_LIMIT_POSITION_M, INFINITY)));
    assert_false(rho_is_coordinate(-nextafterf(RHO_LIMIT_POSITION_M, INFINITY)));
    assert_false(rho_is_coordinate(NAN));
}

/*
 * A scan at the limit of times with a plot after it is stored, ten such offsets beyond the limit
 * are not.
 */
static void stored_times_may_exceed_the_time_limit_by_an_offset(void **state)
{
    (void)state;
    assert_true(rho_is_stored_time(RHO_LIMIT_TIME_US + RHO_LIMIT_OFFSET_US));
    assert_true(rho_is_stored_time(-RHO_LIMIT_TIME_US - RHO_LIMIT_OFFSET_US));
    assert_false(rho_is_stored_time(RHO_LIMIT_TIME_US + 10 * (int64_t)RHO_LIMIT_OFFSET_US));
    assert_false(rho_is_stored_time(-RHO_LIMIT_TIME_US - 10 * (int64_t)RHO_LIMIT_OFFSET_US));
    assert_false(rho_is_stored_time(INT64_MAX));
    assert_false(rho_is_stored_time(INT64_MIN));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_fate_has_its_name),
        cmocka_unit_test(fates_out_of_range_are_named_unknown),
        cmocka_unit_test(counters_saturate),
        cmocka_unit_test(set_bits_are_counted),
        cmocka_unit_test(short_time_spans_are_rounded_once),
        cmocka_unit_test(long_time_spans_are_rounded_once),
        cmocka_unit_test(the_span_between_any_two_times_does_not_overflow),
        cmocka_unit_test(a_range_includes_its_ends),
        cmocka_unit_test(values_that_are_not_finite_are_in_no_range),
        cmocka_unit_test(the_noise_of_a_plot_is_its_larger_horizontal_sigma),
        cmocka_unit_test(nan_and_infinity_are_not_finite),
        cmocka_unit_test(each_of_several_values_is_within_both_limits),
        cmocka_unit_test(coordinates_beyond_their_limit_are_refused),
        cmocka_unit_test(stored_times_may_exceed_the_time_limit_by_an_offset),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
