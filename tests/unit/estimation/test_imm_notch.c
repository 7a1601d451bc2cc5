/* SPDX-License-Identifier: MIT */
/*
 * Misses and the Doppler notch in the filter with two models: both are updated, and the model that
 * explains the miss gains probability.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/detail/imm_notch.h"

static const struct rho_sensor radar = {.pd = 0.9f, .range_max_m = 1e5f, .notch_mps = 2.0f};

/*
 * A target 1 km east that recedes at rate_mps, in the manoeuvring model at manoeuvring_more_mps
 * more.
 */
static struct rho_imm filter_receding_at(float rate_mps, float manoeuvring_more_mps)
{
    struct rho_imm_model model;
    struct rho_kalman estimate = {.state = {1000.0f, 0.0f, 0.0f, rate_mps, 20.0f, 0.0f}};
    struct rho_imm imm;
    for (int axis = 0; axis < 2; axis++) {
        estimate.covariance[RHO_AT(axis, axis)] = 1.0f;
        estimate.covariance[RHO_AT(3 + axis, 3 + axis)] = 0.25f;
    }
    rho_imm_model_default(&model, 5.0f, 50.0f);
    rho_imm_start(&imm, &model, &estimate);
    imm.probability = 0.25f;
    imm.state[3] += manoeuvring_more_mps;
    return imm;
}

static void the_blind_probability_is_the_mean_over_both_models(void **state)
{
    const struct rho_imm inside = filter_receding_at(0.0f, 0.0f),
                         half = filter_receding_at(0.0f, 30.0f),
                         outside = filter_receding_at(9.0f, 0.0f);
    (void)state;
    assert_float_equal(rho_imm_blind_probability(&inside, &radar), 1.0f, 1e-3);
    assert_float_equal(rho_imm_blind_probability(&half, &radar), 0.75f, 1e-3);
    assert_float_equal(rho_imm_blind_probability(&outside, &radar), 0.0f, 1e-3);
}

static void a_miss_favours_the_model_inside_the_doppler_notch(void **state)
{
    const struct rho_notch_look look = {.pd = 0.9f};
    struct rho_imm imm = filter_receding_at(0.0f, 30.0f), alike = filter_receding_at(3.0f, 0.0f);
    (void)state;
    rho_imm_update_by_miss(&imm, &radar, &look);
    /* weights 0.75 x 1 against 0.25 x 0.1 */
    assert_float_equal(imm.probability, 0.025f / 0.775f, 1e-3);
    assert_true(imm.is_coupled);
    rho_imm_update_by_miss(&alike, &radar, &look);
    assert_float_equal(alike.probability, 0.25f, 1e-3);
    assert_true(alike.steady.state[3] < 2.9f && alike.state[3] < 2.9f);
}

static void a_miss_without_a_doppler_notch_changes_nothing(void **state)
{
    const struct rho_sensor whole = {.pd = 0.9f, .range_max_m = 1e5f};
    const struct rho_notch_look look = {.pd = 0.9f};
    const struct rho_imm before = filter_receding_at(0.0f, 30.0f);
    struct rho_imm imm = before;
    (void)state;
    rho_imm_update_by_miss(&imm, &whole, &look);
    rho_imm_update_by_miss(&imm, NULL, &look);
    assert_memory_equal(&imm, &before, sizeof imm);
    assert_float_equal(rho_imm_blind_probability(&imm, &whole), 0.0f, 0.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_blind_probability_is_the_mean_over_both_models),
        cmocka_unit_test(a_miss_favours_the_model_inside_the_doppler_notch),
        cmocka_unit_test(a_miss_without_a_doppler_notch_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
