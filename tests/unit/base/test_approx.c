/* SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/approx.h"

/* The bounds that approx.h states; the reference is the double precision libm. */
#define SINE_ABSOLUTE 1e-7
#define ATAN2_ABSOLUTE 3e-7
#define EXP_RELATIVE 1e-7
#define LOG_RELATIVE 1e-7
#define LOG_ONE_PLUS_ABSOLUTE 2e-7
#define LOG_ABSOLUTE 1e-7

#define BITS_INFINITY 0x7f800000u
#define BITS_SIGN 0x80000000u

/* Steps between tested bit patterns are primes: they sample every exponent densely. */
#define STRIDE_SINE 1009u
#define STRIDE_EXP 499u
#define STRIDE_LOG 997u
#define STRIDE_SQRT 211u

static float from_bits(uint32_t bits)
{
    float v;

    memcpy(&v, &bits, sizeof v);
    return v;
}

static uint32_t to_bits(float v)
{
    uint32_t bits;

    memcpy(&bits, &v, sizeof bits);
    return bits;
}

static void assert_sine_and_cosine_within_bound(float angle)
{
    assert_true(fabs((double)rho_sin(angle) - sin((double)angle)) <= SINE_ABSOLUTE);
    assert_true(fabs((double)rho_cos(angle) - cos((double)angle)) <= SINE_ABSOLUTE);
}

static void sine_and_cosine_are_within_bounds_for_all_exponents(void **state)
{
    (void)state;
    for (uint32_t bits = 0; bits <= to_bits(100.0f); bits += STRIDE_SINE) {
        assert_sine_and_cosine_within_bound(from_bits(bits));
        assert_sine_and_cosine_within_bound(from_bits(bits | BITS_SIGN));
    }
}

/*
 * Multiples of pi / 4: the argument reduction changes its count there, and results are near 0 and
 * 1.
 */
static void sine_and_cosine_are_within_bounds_near_multiples_of_45_degrees(void **state)
{
    (void)state;
    for (int k = -127; k <= 127; ++k) {
        float angle = (float)(k * 3.14159265358979323846 / 4.0);

        for (int i = 0; i < 40; ++i) {
            angle = nextafterf(angle, -200.0f);
        }
        for (int i = 0; i < 80; ++i, angle = nextafterf(angle, 200.0f)) {
            assert_sine_and_cosine_within_bound(angle);
        }
    }
}

static void sine_and_cosine_beyond_100_rad_are_nan(void **state)
{
    const float beyond = nextafterf(100.0f, 200.0f);
    const float refused[] = {beyond, -beyond, FLT_MAX, -FLT_MAX, INFINITY, -INFINITY, NAN};

    (void)state;
    assert_true(rho_sin(0.0f) == 0.0f);
    assert_true(rho_cos(0.0f) == 1.0f);
    assert_sine_and_cosine_within_bound(100.0f);
    assert_sine_and_cosine_within_bound(-100.0f);
    for (size_t i = 0; i < sizeof refused / sizeof refused[0]; ++i) {
        assert_true(isnan(rho_sin(refused[i])));
        assert_true(isnan(rho_cos(refused[i])));
    }
}

static void assert_atan2_within_bound(float y, float x)
{
    const double expected = atan2((double)y + 0.0, (double)x + 0.0); /* + 0.0 makes -0 into 0 */

    assert_true(fabs((double)rho_atan2(y, x) - expected) <= ATAN2_ABSOLUTE);
}

static void atan2_is_within_bounds_around_the_circle(void **state)
{
    const float sizes[] = {FLT_TRUE_MIN * 1000.0f, FLT_MIN, 1e-20f, 1.0f, 2e6f, 1e20f, FLT_MAX};

    (void)state;
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; ++k) {
        for (int i = -20000; i <= 20000; ++i) {
            const double angle = i * 3.14159265358979323846 / 20000.0;

            assert_atan2_within_bound((float)(sizes[k] * sin(angle)),
                                      (float)(sizes[k] * cos(angle)));
        }
    }
}

static void atan2_is_within_bounds_for_all_pairs_of_exponents(void **state)
{
    (void)state;
    for (uint32_t y = 0; y < BITS_INFINITY; y += 0x3f1234u) {
        for (uint32_t x = 0; x < BITS_INFINITY; x += 0x3e4321u) {
            for (uint32_t signs = 0; signs < 4; ++signs) {
                assert_atan2_within_bound(from_bits(y | (signs & 1u) << 31),
                                          from_bits(x | (signs & 2u) << 30));
            }
        }
    }
}

static void atan2_is_exact_on_the_axes_and_nan_if_not_finite(void **state)
{
    const float zeros[] = {0.0f, -0.0f};
    const float bad[] = {NAN, INFINITY, -INFINITY};

    (void)state;
    for (int i = 0; i < 2; ++i) {
        assert_true(rho_atan2(zeros[i], 0.0f) == 0.0f);
        assert_true(rho_atan2(zeros[i], -0.0f) == 0.0f);
        assert_true(rho_atan2(zeros[i], 3.0f) == 0.0f);
        assert_true(rho_atan2(zeros[i], -3.0f) == RHO_PI);
        assert_true(rho_atan2(3.0f, zeros[i]) == RHO_HALF_PI);
        assert_true(rho_atan2(-3.0f, zeros[i]) == -RHO_HALF_PI);
    }
    assert_true(rho_atan2(-FLT_TRUE_MIN, -1.0f) == -RHO_PI);
    for (int i = 0; i < 3; ++i) {
        assert_true(isnan(rho_atan2(bad[i], 1.0f)));
        assert_true(isnan(rho_atan2(1.0f, bad[i])));
        assert_true(isnan(rho_atan2(bad[i], 0.0f)));
        assert_true(isnan(rho_atan2(bad[i], bad[2 - i])));
    }
}

static void assert_exp_within_bound(float v)
{
    const double expected = exp((double)v);

    assert_true(fabs((double)rho_exp(v) - expected) <= EXP_RELATIVE * expected);
}

static void exp_is_within_its_error_over_its_range(void **state)
{
    (void)state;
    for (uint32_t bits = 0; bits <= to_bits(88.0f); bits += STRIDE_EXP) {
        const float v = from_bits(bits);

        assert_exp_within_bound(v);
        if (v <= 87.0f) {
            assert_exp_within_bound(-v);
        }
    }
    assert_exp_within_bound(88.0f);
    assert_exp_within_bound(-87.0f);
}

static void exp_beyond_its_range_is_0_or_infinite(void **state)
{
    (void)state;
    assert_true(rho_exp(0.0f) == 1.0f);
    assert_true(rho_exp(nextafterf(88.0f, 89.0f)) == INFINITY);
    assert_true(rho_exp(FLT_MAX) == INFINITY);
    assert_true(rho_exp(INFINITY) == INFINITY);
    assert_true(rho_exp(nextafterf(-87.0f, -88.0f)) == 0.0f);
    assert_true(rho_exp(-FLT_MAX) == 0.0f);
    assert_true(rho_exp(-INFINITY) == 0.0f);
    assert_true(isnan(rho_exp(NAN)));
}

static void assert_log_within_bound(float v)
{
    const double expected = log((double)v);

    assert_true(fabs((double)rho_log(v) - expected) <=
                LOG_RELATIVE * fabs(expected) + LOG_ABSOLUTE);
}

static void log_is_within_its_error_for_all_positive_numbers(void **state)
{
    (void)state;
    for (uint32_t bits = 1; bits < BITS_INFINITY; bits += STRIDE_LOG) {
        assert_log_within_bound(from_bits(bits));
    }
    for (uint32_t bits = 1; bits < 5000; ++bits) { /* the smallest subnormal numbers */
        assert_log_within_bound(from_bits(bits));
    }
    for (uint32_t i = 0; i < 5000; ++i) {
        assert_log_within_bound(from_bits(to_bits(1.0f) - 2500u + i));
        assert_log_within_bound(from_bits(to_bits(FLT_MIN) - 2500u + i));
    }
    assert_log_within_bound(FLT_MAX);
}

static void log_of_0_is_minus_infinity_and_of_negative_numbers_nan(void **state)
{
    (void)state;
    assert_true(rho_log(1.0f) == 0.0f);
    assert_true(rho_log(0.0f) == -INFINITY);
    assert_true(rho_log(-0.0f) == -INFINITY);
    assert_true(rho_log(INFINITY) == INFINITY);
    assert_true(isnan(rho_log(-FLT_TRUE_MIN)));
    assert_true(isnan(rho_log(-1.0f)));
    assert_true(isnan(rho_log(-INFINITY)));
    assert_true(isnan(rho_log(NAN)));
}

static void log_one_plus_is_within_its_error_from_0_to_1(void **state)
{
    double worst = 0.0;

    (void)state;
    for (uint32_t bits = 0; bits <= to_bits(1.0f); bits += 1009u) {
        const float v = from_bits(bits);
        const double off = fabs((double)rho_log_one_plus(v) - log1p((double)v));

        worst = off > worst ? off : worst;
    }
    assert_true(worst <= LOG_ONE_PLUS_ABSOLUTE);
    assert_true(rho_log_one_plus(0.0f) == 0.0f);
    assert_true(rho_log_one_plus(1.0f) <=
                /* the upper bound on which imm_likelihood.c relies */
                nextafterf(0.693147181f, 1.0f));
    assert_true(isnan(rho_log_one_plus(NAN)));
}

static void assert_sqrt_has_the_bits_of_sqrtf(uint32_t bits)
{
    assert_int_equal(to_bits(rho_sqrt(from_bits(bits))), to_bits(sqrtf(from_bits(bits))));
}

/*
 * IEEE 754 rounds square roots correctly: the bits must equal those of sqrtf, without a tolerance.
 */
static void sqrt_is_correctly_rounded(void **state)
{
    (void)state;
    for (uint32_t bits = 0; bits < BITS_INFINITY; bits += STRIDE_SQRT) {
        assert_sqrt_has_the_bits_of_sqrtf(bits);
    }
}

static void sqrt_of_subnormal_numbers_is_correctly_rounded(void **state)
{
    (void)state;
    for (uint32_t bits = 0; bits < 0x00010000u; ++bits) {
        assert_sqrt_has_the_bits_of_sqrtf(bits);
    }
    for (uint32_t bits = 0; bits < 0x00800100u; bits += 7) {
        assert_sqrt_has_the_bits_of_sqrtf(bits);
    }
}

/* First and last mantissas of each binade, and exact squares with their neighbours. */
static void sqrt_is_correctly_rounded_near_exact_squares_and_binade_ends(void **state)
{
    (void)state;
    for (uint32_t exponent = 0; exponent < 255; ++exponent) {
        for (uint32_t i = 0; i < 512; ++i) {
            assert_sqrt_has_the_bits_of_sqrtf((exponent << 23) | i);
            assert_sqrt_has_the_bits_of_sqrtf((exponent << 23) | (0x7fffffu - i));
        }
    }
    for (uint32_t root = 1; root < 4096; ++root) {
        const uint32_t square = to_bits((float)(root * root));

        assert_sqrt_has_the_bits_of_sqrtf(square - 1);
        assert_sqrt_has_the_bits_of_sqrtf(square);
        assert_sqrt_has_the_bits_of_sqrtf(square + 1);
        assert_true(rho_sqrt((float)(root * root)) == (float)root);
    }
}

static void sqrt_of_special_values_follows_ieee_754(void **state)
{
    (void)state;
    assert_sqrt_has_the_bits_of_sqrtf(BITS_INFINITY - 1u);
    assert_true(rho_sqrt(INFINITY) == INFINITY);
    assert_int_equal(to_bits(rho_sqrt(0.0f)), 0);
    assert_int_equal(to_bits(rho_sqrt(-0.0f)), BITS_SIGN);
    assert_true(isnan(rho_sqrt(-FLT_TRUE_MIN)));
    assert_true(isnan(rho_sqrt(-1.0f)));
    assert_true(isnan(rho_sqrt(-INFINITY)));
    assert_true(isnan(rho_sqrt(NAN)));
}

static void constants_are_the_nearest_floats(void **state)
{
    (void)state;
    assert_true(RHO_PI == (float)3.14159265358979323846);
    assert_true(RHO_TWO_PI == (float)6.28318530717958647692);
    assert_true(RHO_HALF_PI == (float)1.57079632679489661923);
}

/* FNV-1a over the bits of results: every target and compiler must get the same hash. */
static uint32_t hash_bits(uint32_t hash, float v)
{
    const uint32_t bits = to_bits(v);

    for (int shift = 0; shift < 32; shift += 8) {
        hash = (hash ^ (bits >> shift & 0xffu)) * 16777619u;
    }
    return hash;
}

static void results_have_the_same_bits_everywhere(void **state)
{
    uint32_t hash = 2166136261u;

    (void)state;
    for (int i = -5000; i <= 5000; ++i) {
        const float v = (float)i * 0.0171875f;

        hash = hash_bits(hash, rho_sin(v));
        hash = hash_bits(hash, rho_cos(v));
        hash = hash_bits(hash, rho_atan2(v, 31.7f - v));
        hash = hash_bits(hash, rho_exp(v));
        hash = hash_bits(hash, rho_log(v * v + 0.001f));
        hash = hash_bits(hash, rho_sqrt(v * v * 3.0f));
    }
    assert_int_equal(hash, 0x0b283448u);
}

/* Coarsely from FLT_MIN to FLT_MAX, densely from 1 to 4; all other octaves repeat these two. */
static void inverse_sqrt_is_within_its_error_over_all_magnitudes(void **state)
{
    double worst = 0.0;

    (void)state;
    for (double v = FLT_MIN; v <= FLT_MAX; v *= 1.37) {
        worst = fmax(worst, fabs(rho_inverse_sqrt((float)v) * sqrt((double)(float)v) - 1.0));
    }
    for (int i = 0; i < 30000; ++i) {
        const float v = 1.0f + 1e-4f * (float)i;

        worst = fmax(worst, fabs(rho_inverse_sqrt(v) * sqrt((double)v) - 1.0));
    }
    assert_true(worst <= 3e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_and_cosine_are_within_bounds_for_all_exponents),
        cmocka_unit_test(sine_and_cosine_are_within_bounds_near_multiples_of_45_degrees),
        cmocka_unit_test(sine_and_cosine_beyond_100_rad_are_nan),
        cmocka_unit_test(atan2_is_within_bounds_around_the_circle),
        cmocka_unit_test(atan2_is_within_bounds_for_all_pairs_of_exponents),
        cmocka_unit_test(atan2_is_exact_on_the_axes_and_nan_if_not_finite),
        cmocka_unit_test(exp_is_within_its_error_over_its_range),
        cmocka_unit_test(exp_beyond_its_range_is_0_or_infinite),
        cmocka_unit_test(log_is_within_its_error_for_all_positive_numbers),
        cmocka_unit_test(log_of_0_is_minus_infinity_and_of_negative_numbers_nan),
        cmocka_unit_test(log_one_plus_is_within_its_error_from_0_to_1),
        cmocka_unit_test(sqrt_is_correctly_rounded),
        cmocka_unit_test(sqrt_of_subnormal_numbers_is_correctly_rounded),
        cmocka_unit_test(sqrt_is_correctly_rounded_near_exact_squares_and_binade_ends),
        cmocka_unit_test(sqrt_of_special_values_follows_ieee_754),
        cmocka_unit_test(constants_are_the_nearest_floats),
        cmocka_unit_test(results_have_the_same_bits_everywhere),
        cmocka_unit_test(inverse_sqrt_is_within_its_error_over_all_magnitudes),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
