/* SPDX-License-Identifier: MIT */
/*
 * Blind range rates: the share of looks that are blind, and the estimate after a look without a
 * plot, beside sums over 40 000 range rates in double precision.
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

/* 10 km east of the origin, with a variance a direction of place and velocity. */
struct estimate {
    float state[9], covariance[RHO_TRIANGLE(9)];
};

static struct estimate estimate_of(float vx_mps, float vy_mps, float sigma_mps)
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

static struct rho_sensor radar_of(float notch_mps, float blind_speed_mps)
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

/* Share, and mean and variance after a miss, of a range rate. */
struct sums {
    double share, missed, mean, variance;
};

static struct sums sum_up(const struct rho_sensor *sensor, double mean, double sigma, double pd)
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

static void shares_and_moments_are_those_of_sums(void **state)
{
    /* notch, blind speed, range rate, its sigma */
    static const float cases[][4] = {
        {12.0f, 0.0f, 0.0f, 3.0f},   {12.0f, 0.0f, 14.0f, 3.0f},  {12.0f, 0.0f, -14.0f, 3.0f},
        {12.0f, 0.0f, 3.0f, 40.0f},  {0.3f, 0.0f, 0.2f, 0.15f},   {8.0f, 50.0f, 46.0f, 5.0f},
        {8.0f, 50.0f, -97.0f, 6.0f}, {8.0f, 50.0f, 20.0f, 25.0f}, {8.0f, 50.0f, 25.0f, 30.0f}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct rho_sensor sensor = radar_of(cases[i][0], cases[i][1]);
        const struct rho_notch_look look = {.pd = 0.9f};
        struct estimate at = estimate_of(cases[i][2], 0.0f, cases[i][3]);
        const struct sums sums = sum_up(&sensor, (double)cases[i][2], (double)cases[i][3], 0.9);
        assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance),
                           sums.share, 2e-3);
        assert_float_equal(
            rho_notch_update_return_miss_probability(&sensor, &look, 6, at.state, at.covariance),
            sums.missed, 2e-3);
        assert_float_equal(at.state[3], sums.mean, 0.01 * (double)cases[i][3]);
        assert_float_equal(at.covariance[RHO_AT(3, 3)] / (cases[i][3] * cases[i][3]),
                           sums.variance / (double)(cases[i][3] * cases[i][3]), 0.02);
    }
}

/* Where so many blind speeds are possible, a look says nothing of the range rate. */
static void many_blind_speeds_are_a_share(void **state)
{
    const struct rho_sensor sensor = radar_of(2.0f, 20.0f);
    const struct rho_notch_look look = {.pd = 0.9f};
    struct estimate at = estimate_of(130.0f, 0.0f, 200.0f);
    (void)state;
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 0.2f, 1e-6);
    assert_float_equal(
        rho_notch_update_return_miss_probability(&sensor, &look, 6, at.state, at.covariance), 0.28f,
        1e-6);
    assert_float_equal(at.state[3], 130.0f, 1e-4);
    assert_float_equal(at.covariance[RHO_AT(3, 3)], 40000.0f, 40.0f);
}

/* What is coupled with the range rate moves with it, as with a measurement; all else stays. */
static void the_rest_follows(void **state)
{
    const struct rho_sensor sensor = radar_of(5.0f, 0.0f);
    const struct rho_notch_look look = {.pd = 0.9f};
    const struct estimate before = estimate_of(6.0f, 80.0f, 4.0f);
    struct estimate at = before;
    (void)state;
    (void)rho_notch_update_return_miss_probability(&sensor, &look, 9, at.state, at.covariance);
    const float off = at.state[3] - before.state[3];
    assert_true(off < -1.0f);
    assert_float_equal(at.state[0] - before.state[0], off * 20.0f / 16.0f, 0.06);
    assert_float_equal(at.state[6] - before.state[6], off * 4.0f / 16.0f, 0.01);
    assert_float_equal(at.state[4], before.state[4], 0.05);
    assert_true(at.covariance[RHO_AT(0, 0)] < before.covariance[RHO_AT(0, 0)]);
    assert_true(at.covariance[RHO_AT(6, 6)] < before.covariance[RHO_AT(6, 6)]);
    /* across the line of sight, the place alone has a little to do with it: 8 mrad/s */
    assert_float_equal(at.covariance[RHO_AT(4, 4)], 16.0f, 0.01);
    /* six elements know of no accelerations */
    struct estimate six = before;
    (void)rho_notch_update_return_miss_probability(&sensor, &look, 6, six.state, six.covariance);
    assert_float_equal(six.state[6], 0.0f, 0.0f);
    assert_float_equal(six.state[3], at.state[3], 1e-6);
}

/* Range rates are those over ground, seen from where the sensor is. */
static void the_place_of_the_sensor_counts(void **state)
{
    struct rho_sensor sensor = radar_of(10.0f, 0.0f);
    const struct estimate at = estimate_of(0.0f, 100.0f, 1.0f);
    (void)state;
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 1.0f, 1e-6);
    sensor.y_m = -10000.0f; /* now 71 m/s along the line of sight */
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 0.0f, 1e-6);
    sensor.y_m = 0.0f;
    sensor.x_m = 10000.0f; /* at the target's place there is no line of sight */
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 0.0f, 0.0f);
}

static void without_a_notch_nothing_changes(void **state)
{
    const struct rho_sensor sensor = radar_of(0.0f, 0.0f);
    const struct rho_notch_look look = {.pd = 0.8f, .may_stand = 1};
    const struct estimate before = estimate_of(0.0f, 0.0f, 1.0f);
    struct estimate at = before;
    (void)state;
    assert_false(rho_notch_sensor_has_notch(&sensor));
    assert_false(rho_notch_sensor_has_notch(NULL));
    assert_float_equal(rho_notch_blind_probability(&sensor, at.state, at.covariance), 0.0f, 0.0f);
    assert_float_equal(rho_notch_blind_probability(NULL, at.state, at.covariance), 0.0f, 0.0f);
    assert_float_equal(
        rho_notch_update_return_miss_probability(&sensor, &look, 9, at.state, at.covariance), 0.2f,
        1e-6);
    assert_memory_equal(&at, &before, sizeof at);
}

/* A target that may stand, and is as slow, stands: across the line of sight, too. */
static void the_slow_stand(void **state)
{
    const struct rho_sensor sensor = radar_of(0.3f, 0.0f);
    const struct rho_notch_look may = {.pd = 0.9f, .may_stand = 1}, may_not = {.pd = 0.9f};
    struct estimate slow = estimate_of(0.1f, 0.6f, 0.4f), other = slow;
    struct estimate fast = estimate_of(0.1f, 6.0f, 0.4f);
    (void)state;
    for (int i = 0; i < 3; i++) {
        (void)rho_notch_update_return_miss_probability(&sensor, &may, 9, slow.state,
                                                       slow.covariance);
        (void)rho_notch_update_return_miss_probability(&sensor, &may_not, 9, other.state,
                                                       other.covariance);
        (void)rho_notch_update_return_miss_probability(&sensor, &may, 9, fast.state,
                                                       fast.covariance);
    }
    assert_true(fabsf(slow.state[4]) < 0.15f);
    assert_true(slow.covariance[RHO_AT(4, 4)] < 0.04f);
    assert_float_equal(other.state[4], 0.6f, 0.01);
    assert_float_equal(fast.state[4], 6.0f, 0.01);
}

/* Whether a target across the line of sight is taken to stand after a miss. */
static int stands(float along_mps, float across_mps)
{
    const struct rho_sensor sensor = radar_of(0.3f, 0.0f);
    const struct rho_notch_look look = {.pd = 0.9f, .may_stand = 1};
    struct estimate at = estimate_of(along_mps, across_mps, 0.4f);
    (void)rho_notch_update_return_miss_probability(&sensor, &look, 9, at.state, at.covariance);
    return at.state[4] < 0.5f * across_mps;
}

/* Up to the root of the squares of two sigmas and of two widths of the notch: 1.0 m/s here. */
static void the_slow_are_within_two_sigmas_and_two_widths(void **state)
{
    (void)state;
    assert_true(stands(0.1f, 0.95f));
    assert_false(stands(0.1f, 1.05f));
}

/* A miss is half due to the notch where the share of blind looks is 1 / 11. */
static void a_target_stands_where_the_notch_explains_the_miss(void **state)
{
    (void)state;
    assert_true(stands(0.78f, 0.6f));  /* 0.11 */
    assert_false(stands(0.85f, 0.6f)); /* 0.083 */
}

static float share_of(float notch_mps, float blind_speed_mps, float mean_mps, float sigma_mps)
{
    const struct rho_sensor sensor = radar_of(notch_mps, blind_speed_mps);
    const struct estimate at = estimate_of(mean_mps, 0.0f, sigma_mps);
    return rho_notch_blind_probability(&sensor, at.state, at.covariance);
}

static void zones_count_within_four_sigmas(void **state)
{
    (void)state;
    assert_float_equal(share_of(12.0f, 0.0f, 12.0f + 3.9f * 3.0f, 3.0f), 4.8e-5, 1e-6);
    assert_float_equal(share_of(12.0f, 0.0f, 12.0f + 4.1f * 3.0f, 3.0f), 0.0, 0.0);
    /* up to a millionth blind speed, and a standard deviation of 3e-5 m/s */
    assert_float_equal(share_of(0.4f, 1.0f, 7e5f, 0.2f), 0.95, 0.01);
    assert_float_equal(share_of(0.4f, 1.0f, 1.5e6f, 0.2f), 0.0, 0.0);
    assert_float_equal(share_of(12.0f, 0.0f, 0.0f, 3.7e-5f), 1.0, 1e-6);
    assert_float_equal(share_of(12.0f, 0.0f, 0.0f, 2.6e-5f), 0.0, 0.0);
}

/* The share of the range rate's variance that is left after a look that sees all there is. */
static float kept_after(float notch_mps, float blind_speed_mps, struct estimate *at)
{
    const struct rho_sensor sensor = radar_of(notch_mps, blind_speed_mps);
    const struct rho_notch_look look = {.pd = 1.0f};
    const float before = at->covariance[RHO_AT(3, 3)];
    (void)rho_notch_update_return_miss_probability(&sensor, &look, 6, at->state, at->covariance);
    return at->covariance[RHO_AT(3, 3)] / before;
}

/* Zones within four sigmas each way: more than nine of them are a share, which moves nothing. */
static void nine_zones_are_summed(void **state)
{
    struct estimate many = estimate_of(133.0f, 0.0f, 22.6f), few = estimate_of(133.0f, 0.0f, 21.4f);
    (void)state;
    (void)kept_after(2.0f, 20.0f, &many);
    (void)kept_after(2.0f, 20.0f, &few);
    assert_float_equal(many.state[3], 133.0, 0.0);
    assert_true(fabsf(few.state[3] - 133.0f) > 1e-4f);
}

static void a_miss_keeps_a_hundredth_to_four_times_the_variance(void **state)
{
    struct estimate narrow = estimate_of(0.0f, 0.0f, 10.0f),
                    between = estimate_of(50.0f, 0.0f, 14.0f);
    (void)state;
    assert_float_equal(kept_after(1.0f, 0.0f, &narrow), 0.01, 1e-4);     /* 0.0033 by the moments */
    assert_float_equal(kept_after(10.0f, 100.0f, &between), 4.0, 0.001); /* 9.4 */
}

static void limits_are_checked(void **state)
{
    /* notch, blind speed, and whether that will do */
    static const float cases[][3] = {
        {0.0f, 0.0f, 1.0f},  {12.0f, 0.0f, 1.0f},   {12.0f, 25.0f, 1.0f}, {12.0f, 24.0f, 0.0f},
        {-1.0f, 0.0f, 0.0f}, {12.0f, -50.0f, 0.0f}, {NAN, 0.0f, 0.0f},    {12.0f, INFINITY, 0.0f}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct rho_sensor sensor = radar_of(cases[i][0], cases[i][1]);
        assert_int_equal(rho_notch_is_valid(&sensor) != 0, cases[i][2] > 0.0f);
    }
}

/* However little is known, or however well, numbers stay numbers, and variances positive. */
static void nothing_breaks(void **state)
{
    static const float sigmas[] = {1e-4f, 1e-2f, 1.0f, 1e3f, 1e6f};
    static const float rates[] = {0.0f, 0.29f, 0.31f, 3.0f, -500.0f};
    (void)state;
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 5; k++) {
            const struct rho_sensor sensor = radar_of(0.3f, k % 2 ? 7.0f : 0.0f);
            const struct rho_notch_look look = {.pd = 0.999f, .may_stand = 1};
            struct estimate at = estimate_of(rates[k], 0.1f, sigmas[i]);
            for (int n = 0; n < 50; n++) {
                const float missed = rho_notch_update_return_miss_probability(
                    &sensor, &look, 9, at.state, at.covariance);
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
        cmocka_unit_test(shares_and_moments_are_those_of_sums),
        cmocka_unit_test(many_blind_speeds_are_a_share),
        cmocka_unit_test(the_rest_follows),
        cmocka_unit_test(the_place_of_the_sensor_counts),
        cmocka_unit_test(without_a_notch_nothing_changes),
        cmocka_unit_test(the_slow_stand),
        cmocka_unit_test(the_slow_are_within_two_sigmas_and_two_widths),
        cmocka_unit_test(a_target_stands_where_the_notch_explains_the_miss),
        cmocka_unit_test(zones_count_within_four_sigmas),
        cmocka_unit_test(nine_zones_are_summed),
        cmocka_unit_test(a_miss_keeps_a_hundredth_to_four_times_the_variance),
        cmocka_unit_test(limits_are_checked),
        cmocka_unit_test(nothing_breaks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
