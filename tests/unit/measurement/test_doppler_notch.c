/* SPDX-License-Identifier: MIT */
/*
 * The Doppler notch: the probability that a look is blind, and the estimate after a miss, compared
 * with sums over 40 000 range rates in double precision.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/doppler_notch.h"
#include "rhotrack/detail/linalg.h"

/* An estimate 10 km east of the origin, with variances of place, velocity and acceleration. */
struct estimate {
    float state[9], covariance[RHO_TRIANGLE(9)];
};

static struct estimate make_estimate(float vx_mps, float vy_mps, float sigma_mps)
{
    struct estimate made = {.state = {10000.0f, 0.0f, 0.0f, vx_mps, vy_mps}};
    for (int axis = 0; axis < 2; axis++) {
        made.covariance[RHO_AT(axis, axis)] = 400.0f;
        made.covariance[RHO_AT(3 + axis, 3 + axis)] = sigma_mps * sigma_mps;
        made.covariance[RHO_AT(3 + axis, axis)] = 5.0f * sigma_mps;
        made.covariance[RHO_AT(6 + axis, 6 + axis)] = 4.0f;
        made.covariance[RHO_AT(6 + axis, 3 + axis)] = sigma_mps;
    }
    return made;
}

static struct rho_sensor radar_with_notch(float notch_mps, float blind_speed_mps)
{
    return (struct rho_sensor){.pd = 0.9f,
                               .range_max_m = 1e5f,
                               .notch_mps = notch_mps,
                               .blind_speed_mps = blind_speed_mps};
}

static int is_blind(const struct rho_sensor *sensor, double rate_mps)
{
    const double blind = (double)sensor->blind_speed_mps;
    return fabs(blind > 0.0 ? remainder(rate_mps, blind) : rate_mps) < (double)sensor->notch_mps;
}

/*
 * Probability that a look is blind, that it misses, and mean and variance of the range rate after a
 * miss.
 */
struct sums {
    double share, missed, mean, variance;
};

static struct sums sum_over_range_rates(const struct rho_sensor *sensor, double mean, double sigma,
                                        double pd)
{
    struct sums sums = {0.0, 0.0, 0.0, 0.0};
    double all = 0.0, square = 0.0;
    for (int i = -20000; i <= 20000; i++) {
        const double x = i * 0.0004, rate = mean + x * sigma, weight = exp(-0.5 * x * x);
        const double missed = weight * (is_blind(sensor, rate) ? 1.0 : 1.0 - pd);
        all += weight;
        sums.share += is_blind(sensor, rate) ? weight : 0.0;
        sums.missed += missed;
        sums.mean += missed * rate;
        square += missed * rate * rate;
    }
    sums.mean /= sums.missed;
    sums.variance = square / sums.missed - sums.mean * sums.mean;
    sums.share /= all;
    sums.missed /= all;
    return sums;
}

static void blind_probabilities_and_moments_agree_with_sums(void **state)
{
    /* notch width, blind speed, range rate, sigma of the range rate */
    static const float cases[][4] = {
        {12.0f, 0.0f, 0.0f, 3.0f},   {12.0f, 0.0f, 14.0f, 3.0f},  {12.0f, 0.0f, -14.0f, 3.0f},
        {12.0f, 0.0f, 3.0f, 40.0f},  {0.3f, 0.0f, 0.2f, 0.15f},   {8.0f, 50.0f, 46.0f, 5.0f},
        {8.0f, 50.0f, -97.0f, 6.0f}, {8.0f, 50.0f, 20.0f, 25.0f}, {8.0f, 50.0f, 25.0f, 30.0f}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct rho_sensor sensor = radar_with_notch(cases[i][0], cases[i][1]);
        const struct rho_notch_look look = {.pd = 0.9f};
        struct estimate at = make_estimate(cases[i][2], 0.0f, cases[i][3]);
        const struct sums sums =
            sum_over_range_rates(&sensor, (double)cases[i][2], (double)cases[i][3], 0.9);
        assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance),
                           sums.share, 2e-3);
        assert_float_equal(rho_notch_update_by_miss(&sensor, &look, 6, at.state, at.covariance),
                           sums.missed, 2e-3);
        assert_float_equal(at.state[3], sums.mean, 0.01 * (double)cases[i][3]);
        assert_float_equal(at.covariance[RHO_AT(3, 3)] / (cases[i][3] * cases[i][3]),
                           sums.variance / (double)(cases[i][3] * cases[i][3]), 0.02);
    }
}

/* If many blind speeds are possible, a miss tells nothing about the range rate. */
static void with_many_blind_speeds_the_blind_probability_is_their_share(void **state)
{
    const struct rho_sensor sensor = radar_with_notch(2.0f, 20.0f);
    const struct rho_notch_look look = {.pd = 0.9f};
    struct estimate at = make_estimate(130.0f, 0.0f, 200.0f);
    (void)state;
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 0.2f, 1e-6);
    assert_float_equal(rho_notch_update_by_miss(&sensor, &look, 6, at.state, at.covariance), 0.28f,
                       1e-6);
    assert_float_equal(at.state[3], 130.0f, 1e-4);
    assert_float_equal(at.covariance[RHO_AT(3, 3)], 40000.0f, 40.0f);
}

/* Correlated elements move with the range rate as in an update with a measurement; others stay. */
static void correlated_states_move_with_the_range_rate(void **state)
{
    const struct rho_sensor sensor = radar_with_notch(5.0f, 0.0f);
    const struct rho_notch_look look = {.pd = 0.9f};
    const struct estimate before = make_estimate(6.0f, 80.0f, 4.0f);
    struct estimate at = before;
    (void)state;
    (void)rho_notch_update_by_miss(&sensor, &look, 9, at.state, at.covariance);
    const float off = at.state[3] - before.state[3];
    assert_true(off < -1.0f);
    assert_float_equal(at.state[0] - before.state[0], off * 20.0f / 16.0f, 0.06);
    assert_float_equal(at.state[6] - before.state[6], off * 4.0f / 16.0f, 0.01);
    assert_float_equal(at.state[4], before.state[4], 0.05);
    assert_true(at.covariance[RHO_AT(0, 0)] < before.covariance[RHO_AT(0, 0)]);
    assert_true(at.covariance[RHO_AT(6, 6)] < before.covariance[RHO_AT(6, 6)]);
    /* the velocity across changes little: it depends on the line of sight's turn, 8 mrad/s */
    assert_float_equal(at.covariance[RHO_AT(4, 4)], 16.0f, 0.01);
    /* an update of six elements leaves accelerations alone */
    struct estimate six = before;
    (void)rho_notch_update_by_miss(&sensor, &look, 6, six.state, six.covariance);
    assert_float_equal(six.state[6], 0.0f, 0.0f);
    assert_float_equal(six.state[3], at.state[3], 1e-6);
}

/* Range rates are relative to the ground and to the sensor's place. */
static void the_range_rate_is_seen_from_the_sensors_place(void **state)
{
    struct rho_sensor sensor = radar_with_notch(10.0f, 0.0f);
    const struct estimate at = make_estimate(0.0f, 100.0f, 1.0f);
    (void)state;
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 1.0f, 1e-6);
    sensor.y_m = -10000.0f; /* the range rate is 71 m/s */
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 0.0f, 1e-6);
    sensor.y_m = 0.0f;
    sensor.x_m = 10000.0f; /* no line of sight: the target is at the sensor's place */
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 0.0f, 0.0f);
}

static void a_miss_without_a_doppler_notch_changes_nothing(void **state)
{
    const struct rho_sensor sensor = radar_with_notch(0.0f, 0.0f);
    const struct rho_notch_look look = {.pd = 0.8f, .may_stand = 1};
    const struct estimate before = make_estimate(0.0f, 0.0f, 1.0f);
    struct estimate at = before;
    (void)state;
    assert_false(rho_notch_sensor_has_notch(&sensor));
    assert_false(rho_notch_sensor_has_notch(NULL));
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 0.0f, 0.0f);
    assert_float_equal(rho_notch_blind_probability(NULL, at.state, at.covariance), 0.0f, 0.0f);
    assert_float_equal(rho_notch_update_by_miss(&sensor, &look, 9, at.state, at.covariance), 0.2f,
                       1e-6);
    assert_memory_equal(&at, &before, sizeof at);
}

/* A target at rest is seen less by any radar: its notch is its own, and the radar's has no say. */
static void a_miss_at_rest_is_as_one_in_a_notch_so_wide(void **state)
{
    static const float rates_mps[] = {0.0f, 0.1f, -0.3f, 2.0f};
    const struct rho_sensor rest = radar_with_notch(0.15f, 0.0f),
                            none = radar_with_notch(0.0f, 0.0f),
                            other = radar_with_notch(8.0f, 50.0f);
    (void)state;
    for (size_t k = 0; k < 2 * sizeof rates_mps / sizeof rates_mps[0]; k++) {
        const size_t i = k / 2;
        const uint8_t may_stand = k % 2;
        const struct rho_notch_look look = {.pd = 0.8f, .may_stand = may_stand},
                                    own = {.pd = 0.8f, .rest_mps = 0.15f, .may_stand = may_stand};
        const struct estimate before = make_estimate(rates_mps[i], 0.0f, 0.2f);
        struct estimate at = before, one = before, two = before, three = before;
        const float missed = rho_notch_update_by_miss(&rest, &look, 9, at.state, at.covariance);
        assert_true(rho_notch_update_by_miss(&none, &own, 9, one.state, one.covariance) == missed);
        assert_true(rho_notch_update_by_miss(&other, &own, 9, two.state, two.covariance) == missed);
        assert_true(rho_notch_update_by_miss(NULL, &own, 9, three.state, three.covariance) ==
                    missed);
        assert_memory_equal(&one, &at, sizeof at);
        assert_memory_equal(&two, &at, sizeof at);
        assert_memory_equal(&three, &at, sizeof at);
        assert_true(i == 3 || at.covariance[RHO_AT(3, 3)] < before.covariance[RHO_AT(3, 3)]);
    }
}

/* With may_stand a slow target is taken to stand: its velocity across goes to 0, too. */
static void a_missed_slow_target_is_taken_to_stand(void **state)
{
    const struct rho_sensor sensor = radar_with_notch(0.3f, 0.0f);
    const struct rho_notch_look may = {.pd = 0.9f, .may_stand = 1}, may_not = {.pd = 0.9f};
    struct estimate slow = make_estimate(0.1f, 0.6f, 0.4f), other = slow;
    struct estimate fast = make_estimate(0.1f, 6.0f, 0.4f);
    (void)state;
    for (int i = 0; i < 3; i++) {
        (void)rho_notch_update_by_miss(&sensor, &may, 9, slow.state, slow.covariance);
        (void)rho_notch_update_by_miss(&sensor, &may_not, 9, other.state, other.covariance);
        (void)rho_notch_update_by_miss(&sensor, &may, 9, fast.state, fast.covariance);
    }
    assert_true(fabsf(slow.state[4]) < 0.15f);
    assert_true(slow.covariance[RHO_AT(4, 4)] < 0.04f);
    assert_float_equal(other.state[4], 0.6f, 0.01);
    assert_float_equal(fast.state[4], 6.0f, 0.01);
}

/* True if a miss at least halves the velocity across the line of sight. */
static int is_taken_to_stand(float along_mps, float across_mps)
{
    const struct rho_sensor sensor = radar_with_notch(0.3f, 0.0f);
    const struct rho_notch_look look = {.pd = 0.9f, .may_stand = 1};
    struct estimate at = make_estimate(along_mps, across_mps, 0.4f);
    (void)rho_notch_update_by_miss(&sensor, &look, 9, at.state, at.covariance);
    return at.state[4] < 0.5f * across_mps;
}

/* The speed limit is the root of the squares of two sigmas and two notch widths, here 1.0 m/s. */
static void targets_stand_within_two_sigmas_and_two_notch_widths(void **state)
{
    (void)state;
    assert_true(is_taken_to_stand(0.1f, 0.95f));
    assert_false(is_taken_to_stand(0.1f, 1.05f));
}

/* The notch explains half of the misses if the blind probability is 1 / 11. */
static void a_target_stands_if_the_notch_explains_the_miss(void **state)
{
    (void)state;
    assert_true(is_taken_to_stand(0.78f, 0.6f));  /* blind probability 0.11 */
    assert_false(is_taken_to_stand(0.85f, 0.6f)); /* blind probability 0.083 */
}

static float blind_probability_of(float notch_mps, float blind_speed_mps, float mean_mps,
                                  float sigma_mps)
{
    const struct rho_sensor sensor = radar_with_notch(notch_mps, blind_speed_mps);
    const struct estimate at = make_estimate(mean_mps, 0.0f, sigma_mps);
    return rho_notch_blind_probability(&sensor, at.state, at.covariance);
}

static void blind_zones_count_within_four_sigmas(void **state)
{
    (void)state;
    assert_float_equal(blind_probability_of(12.0f, 0.0f, 12.0f + 3.9f * 3.0f, 3.0f), 4.8e-5, 1e-6);
    assert_float_equal(blind_probability_of(12.0f, 0.0f, 12.0f + 4.1f * 3.0f, 3.0f), 0.0, 0.0);
    /* limits: 10^6 blind speeds, and a sigma of 3e-5 m/s */
    assert_float_equal(blind_probability_of(0.4f, 1.0f, 7e5f, 0.2f), 0.95, 0.01);
    assert_float_equal(blind_probability_of(0.4f, 1.0f, 1.5e6f, 0.2f), 0.0, 0.0);
    assert_float_equal(blind_probability_of(12.0f, 0.0f, 0.0f, 3.7e-5f), 1.0, 1e-6);
    assert_float_equal(blind_probability_of(12.0f, 0.0f, 0.0f, 2.6e-5f), 0.0, 0.0);
}

/* Variance of the range rate after a miss over that before, with P_D 1. */
static float variance_ratio_after_miss(float notch_mps, float blind_speed_mps, struct estimate *at)
{
    const struct rho_sensor sensor = radar_with_notch(notch_mps, blind_speed_mps);
    const struct rho_notch_look look = {.pd = 1.0f};
    const float before = at->covariance[RHO_AT(3, 3)];
    (void)rho_notch_update_by_miss(&sensor, &look, 6, at->state, at->covariance);
    return at->covariance[RHO_AT(3, 3)] / before;
}

/* With more than nine blind zones within four sigmas the mean range rate stays. */
static void with_more_than_nine_blind_zones_a_miss_keeps_the_range_rate(void **state)
{
    struct estimate many = make_estimate(133.0f, 0.0f, 22.6f),
                    few = make_estimate(133.0f, 0.0f, 21.4f);
    (void)state;
    (void)variance_ratio_after_miss(2.0f, 20.0f, &many);
    (void)variance_ratio_after_miss(2.0f, 20.0f, &few);
    assert_float_equal(many.state[3], 133.0, 0.0);
    assert_true(fabsf(few.state[3] - 133.0f) > 1e-4f);
}

static void a_miss_changes_the_variance_by_0_01_to_4(void **state)
{
    struct estimate narrow = make_estimate(0.0f, 0.0f, 10.0f),
                    between = make_estimate(50.0f, 0.0f, 14.0f);
    (void)state;
    /* 0.0033 without the bound */
    assert_float_equal(variance_ratio_after_miss(1.0f, 0.0f, &narrow), 0.01, 1e-4);
    /* 9.4 without the bound */
    assert_float_equal(variance_ratio_after_miss(10.0f, 100.0f, &between), 4.0, 0.001);
}

static void notch_widths_and_blind_speeds_are_checked(void **state)
{
    /* notch width, blind speed, 1 if they are valid */
    static const float cases[][3] = {
        {0.0f, 0.0f, 1.0f},  {12.0f, 0.0f, 1.0f},   {12.0f, 25.0f, 1.0f}, {12.0f, 24.0f, 0.0f},
        {-1.0f, 0.0f, 0.0f}, {12.0f, -50.0f, 0.0f}, {NAN, 0.0f, 0.0f},    {12.0f, INFINITY, 0.0f}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct rho_sensor sensor = radar_with_notch(cases[i][0], cases[i][1]);
        assert_int_equal(rho_notch_is_valid(&sensor) != 0, cases[i][2] > 0.0f);
    }
}

/* For sigmas from 1e-4 to 1e6 m/s, 50 misses leave finite estimates and positive variances. */
static void repeated_misses_keep_estimates_finite(void **state)
{
    static const float sigmas[] = {1e-4f, 1e-2f, 1.0f, 1e3f, 1e6f};
    static const float rates[] = {0.0f, 0.29f, 0.31f, 3.0f, -500.0f};
    (void)state;
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 5; k++) {
            const struct rho_sensor sensor = radar_with_notch(0.3f, k % 2 ? 7.0f : 0.0f);
            const struct rho_notch_look look = {.pd = 0.999f, .may_stand = 1};
            struct estimate at = make_estimate(rates[k], 0.1f, sigmas[i]);
            for (int n = 0; n < 50; n++) {
                const float missed =
                    rho_notch_update_by_miss(&sensor, &look, 9, at.state, at.covariance);
                assert_true(missed > 0.0f && missed <= 1.0f);
            }
            assert_true(rho_are_finite(at.state, 9) && rho_are_finite(at.covariance, 45));
            for (int n = 0; n < 9; n++) {
                assert_true(at.covariance[RHO_AT(n, n)] > 0.0f || n == 2 || n == 5 || n == 8);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(blind_probabilities_and_moments_agree_with_sums),
        cmocka_unit_test(with_many_blind_speeds_the_blind_probability_is_their_share),
        cmocka_unit_test(correlated_states_move_with_the_range_rate),
        cmocka_unit_test(the_range_rate_is_seen_from_the_sensors_place),
        cmocka_unit_test(a_miss_without_a_doppler_notch_changes_nothing),
        cmocka_unit_test(a_miss_at_rest_is_as_one_in_a_notch_so_wide),
        cmocka_unit_test(a_missed_slow_target_is_taken_to_stand),
        cmocka_unit_test(targets_stand_within_two_sigmas_and_two_notch_widths),
        cmocka_unit_test(a_target_stands_if_the_notch_explains_the_miss),
        cmocka_unit_test(blind_zones_count_within_four_sigmas),
        cmocka_unit_test(with_more_than_nine_blind_zones_a_miss_keeps_the_range_rate),
        cmocka_unit_test(a_miss_changes_the_variance_by_0_01_to_4),
        cmocka_unit_test(notch_widths_and_blind_speeds_are_checked),
        cmocka_unit_test(repeated_misses_keep_estimates_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
