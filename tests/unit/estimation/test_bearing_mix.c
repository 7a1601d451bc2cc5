/* SPDX-License-Identifier: MIT */
/* Mixes of the bearings of a look, against sums in double precision, and in both models. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "rhotrack/detail/bearing_mix.h"
#include "rhotrack/detail/imm.h"

#include "one_bearing.h"

/* Adds a bearing of this weight, variance and noise. */
static void add_to_mix(struct rho_bearing_mix *mix, float weight, float off_rad,
                       float variance_rad2, float noise_rad2)
{
    const struct rho_bearing bearing = {.sigma_rad = sqrtf(0.25f * noise_rad2)};
    const struct rho_bearing_scan scan = {.num_bearings = 1, .bearings = &bearing};
    const struct rho_weighed_bearings look = {
        .scan = &scan, .weight = {weight}, .lasting_in_estimate_rad2 = 0.75f * noise_rad2};
    const double share = exp(-0.5 * (double)off_rad * (double)off_rad / (double)variance_rad2);
    const struct rho_expected_bearing expected = {
        .off_rad = off_rad,
        .variance_rad2 = variance_rad2,
        .density = (float)(share / sqrt(2.0 * 3.14159265358979 * (double)variance_rad2))};
    rho_bearing_mix_add(mix, &look, 0, &expected);
}

/* Mean and variance after a scalar state of variance P has taken the one bearing. */
static void update_scalar(double variance, double noise, double off, double *mean, double *after)
{
    *mean = variance / (variance + noise) * off;
    *after = variance * noise / (variance + noise);
}

/*
 * One bearing stands for three and a miss: the state after it has the mean and the variance of the
 * mixture of the four states that each of them alone would leave.
 */
static void one_bearing_leaves_the_moments_of_the_mixture(void **state)
{
    static const double off[3] = {0.002, -0.001, 0.004}, weight[3] = {1.0, 0.3, 0.02};
    const double variance = 9e-6, noise = 4e-6, miss = 20.0, pi = 3.14159265358979;
    struct rho_bearing_mix mix = {.hit = 0.0f};
    double sum = miss, mean = 0.0, square = miss * variance, hit = 0.0;
    float off_rad, sigma_rad;
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double s = variance + noise;
        const double share = weight[i] * exp(-0.5 * off[i] * off[i] / s) / sqrt(2.0 * pi * s);
        double at, after;
        update_scalar(variance, noise, off[i], &at, &after);
        sum += share;
        hit += share;
        mean += share * at;
        square += share * (after + at * at);
        add_to_mix(&mix, (float)weight[i], (float)off[i], (float)s, (float)noise);
    }
    mean /= sum;
    assert_true(fabs((double)mix.hit / hit - 1.0) < 1e-4);
    assert_int_equal(rho_bearing_mix_as_one(&mix, (float)miss, &off_rad, &sigma_rad), 1);
    double at, after;
    update_scalar(variance, (double)sigma_rad * sigma_rad, off_rad, &at, &after);
    assert_true(fabs(at / mean - 1.0) < 1e-3);
    assert_true(fabs(after / (square / sum - mean * mean) - 1.0) < 1e-3);
}

/* An estimate north of a sensor: its sigma of 30 m across is 3 mrad at 10 km, beside 4 of noise. */
static void a_bearing_is_expected_with_the_variance_of_both(void **state)
{
    const double pi = 3.14159265358979;
    struct rho_kalman at = {.state = {500.0f, 9000.0f, 2000.0f}};
    struct rho_bearing bearing = {.bearing_rad = (float)(0.5 * pi + 0.002),
                                  .sigma_rad = 0.0024f,
                                  .elevation_rad = (float)atan(0.2),
                                  .sigma_elevation_rad = 0.01f};
    const struct rho_bearing_scan scan = {
        .x_m = 500.0f, .y_m = -1000.0f, .num_bearings = 1, .bearings = &bearing};
    const struct rho_weighed_bearings look = {.scan = &scan, .lasting_rad2 = 0.0032f * 0.0032f};
    struct rho_expected_bearing level, expected;
    (void)state;
    at.covariance[RHO_AT(0, 0)] = at.covariance[RHO_AT(1, 1)] = 900.0f;
    at.covariance[RHO_AT(3, 3)] = at.covariance[RHO_AT(4, 4)] = 1.0f;
    assert_int_equal(rho_bearing_expect(&at, &look, 0, &level), 1);
    assert_float_equal(level.off_rad, 0.002, 1e-6);
    assert_float_equal(level.variance_rad2, 25e-6, 1e-8);
    assert_float_equal(level.nis, 4.0 / 25.0, 1e-3);
    assert_float_equal(level.density, exp(-0.08) / (0.005 * sqrt(2.0 * pi)), 0.05);
    at.covariance[RHO_AT(2, 2)] = 900.0f;
    at.covariance[RHO_AT(5, 5)] = 1.0f;
    at.state[2] = 2300.0f; /* 300 m above the slope, whose sigma is 108 m */
    const double variance = 900.0 * 1.04 + pow(0.01 * 1.04, 2.0) * (1e8 + 900.0);
    assert_int_equal(rho_bearing_expect(&at, &look, 0, &expected), 1);
    assert_float_equal(expected.nis, 9e4 / variance, 0.02);
    assert_float_equal(expected.density / level.density,
                       1e4 * exp(-4.5e4 / variance) / sqrt(2.0 * pi * variance), 0.01);
    assert_float_equal(expected.variance_rad2, level.variance_rad2, 1e-12);
    at.state[1] = -1000.5f;
    assert_int_equal(rho_bearing_expect(&at, &look, 0, &expected), 0);
    at.state[1] = 9000.0f;
    bearing.sigma_rad = INFINITY;
    assert_int_equal(rho_bearing_expect(&at, &look, 0, &expected), 0);
}

static void a_sure_bearing_is_itself(void **state)
{
    struct rho_bearing_mix mix = {.hit = 0.0f};
    float off_rad, sigma_rad;
    (void)state;
    add_to_mix(&mix, 0.7f, 0.003f, 5e-6f, 4e-6f);
    assert_int_equal(rho_bearing_mix_as_one(&mix, 0.0f, &off_rad, &sigma_rad), 1);
    assert_float_equal(off_rad, 0.003f, 1e-7f);
    assert_float_equal(sigma_rad, 0.002f, 1e-7f);
}

/* None at all, one that is far less probable than a miss, and two on both sides. */
static void looks_that_tell_next_to_nothing_are_left_out(void **state)
{
    struct rho_bearing_mix none = {.hit = 0.0f}, faint = none, sides = none;
    float off_rad, sigma_rad;
    (void)state;
    add_to_mix(&faint, 1e-4f, 0.0f, 4e-6f, 1e-6f);
    add_to_mix(&sides, 1.0f, 0.003f, 4e-6f, 1e-6f);
    add_to_mix(&sides, 1.0f, -0.003f, 4e-6f, 1e-6f);
    assert_int_equal(rho_bearing_mix_as_one(&none, 0.1f, &off_rad, &sigma_rad), 0);
    assert_int_equal(rho_bearing_mix_as_one(&faint, 1.0f, &off_rad, &sigma_rad), 0);
    assert_int_equal(rho_bearing_mix_as_one(&sides, 0.0f, &off_rad, &sigma_rad), 0);
}

/*
 * 80 m beside a straight flight that is known to 10 m, by a bearing of 17 m: to the steady model it
 * is 4 sigma off, in no gate of its own, to the manoeuvring one a bearing like any. It is in the
 * track's gate, moves that model alone, and makes it the likelier one; a look that misses moves
 * neither.
 */
static void a_bearing_off_a_straight_flight_is_the_manoeuvring_models(void **state)
{
    struct rho_imm_model model;
    struct rho_kalman estimate;
    struct rho_imm imm;
    struct one_bearing at;
    struct rho_bearing_mix mixes[2] = {{.hit = 0.0f}, {.hit = 0.0f}};
    float density, variance_rad2, gain_nat;
    (void)state;
    rho_imm_model_default(&model, 20.0f, 300.0f);
    rho_kalman_init(&estimate);
    assert_int_equal(rho_kalman_open_axis(&estimate, 0, 10000.0f, 100.0f, 4.0f), RHO_OK);
    assert_int_equal(rho_kalman_open_axis(&estimate, 1, 0.0f, 100.0f, 4.0f), RHO_OK);
    rho_imm_start(&imm, &model, &estimate);
    imm.covariance[RHO_AT(1, 1)] = 1600.0f;
    imm.probability = 0.01f;
    struct rho_weighed_bearings look =
        *one_bearing_in_row(&at, 0, 0, 0.0f, 0.0f, 0.008f, 0.0017f, 0.1f);
    look.weight[0] = 0.9f / 0.16f;
    assert_int_equal(rho_imm_score_bearing(&imm, &look, 0, &density, &variance_rad2), 1);
    assert_true(variance_rad2 > 1e-5f); /* 4e-6 to the steady model */
    const struct rho_imm before = imm;
    assert_int_equal(rho_imm_update_bearings(&imm, &look, mixes, &gain_nat), RHO_OK);
    assert_float_equal(gain_nat, (float)log(0.1), 1e-5f);
    assert_float_equal(imm.probability, 0.01f, 1e-6f);
    assert_memory_equal(imm.state, before.state, sizeof imm.state);
    rho_imm_mix_bearing(&imm, &look, 0, mixes);
    assert_int_equal(rho_imm_update_bearings(&imm, &look, mixes, &gain_nat), RHO_OK);
    assert_float_equal(gain_nat, (float)log(0.1 + (double)look.weight[0] * (double)density), 0.02f);
    assert_true(imm.probability > 0.5f);
    assert_float_equal(imm.state[1], 68.0f, 3.0f);
    assert_true(imm.steady.state[1] < 20.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_bearing_leaves_the_moments_of_the_mixture),
        cmocka_unit_test(a_bearing_is_expected_with_the_variance_of_both),
        cmocka_unit_test(a_sure_bearing_is_itself),
        cmocka_unit_test(looks_that_tell_next_to_nothing_are_left_out),
        cmocka_unit_test(a_bearing_off_a_straight_flight_is_the_manoeuvring_models),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
