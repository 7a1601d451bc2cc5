/* SPDX-License-Identifier: MIT */
/*
 * Two constants of the filter with two models, tested through private headers, as plots hardly ever
 * meet their limits.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "../../src/estimation/imm_axis_access.h"
#include "../../src/estimation/imm_plane_update.h"

static void a_range_rate_is_predicted_from_a_metre_of_range_on(void **state)
{
    static const float covariance[RHO_TRIANGLE(RHO_IMM_STATES)] = {1.0f, 0.0f, 1.0f};
    struct plane_rate rate;
    (void)state;
    for (int i = 0; i < 4; i++) {
        const float at[RHO_IMM_STATES] = {i % 2 ? 1.01f : 0.0f, i % 2 ? 0.0f : 0.99f};
        const struct rho_sensor beside = {.x_m = -0.01f, .y_m = -0.02f};
        const double range_m =
            hypot((double)at[0] + 0.01 * (i / 2), (double)at[1] + 0.02 * (i / 2));
        assert_int_equal(rho_imm_plane_rate(at, covariance, i < 2 ? NULL : &beside, &rate),
                         range_m >= 1.0);
    }
}

/* A likelihood ratio of 10^9 raises the probability of the model that had none to a half. */
static void a_model_of_probability_zero_keeps_a_billionth(void **state)
{
    static const float variance[2] = {4.0f, 4.0f};
    const float far = (float)sqrt(4.0 * 2.0 * log(1e9)), far_and_near[2] = {far, 0.0f},
                near_and_far[2] = {0.0f, far};
    struct rho_imm imm = {.probability = 0.0f};
    float gain_nat;
    (void)state;
    rho_imm_update_probability(&imm, far_and_near, variance, &gain_nat);
    assert_true(fabs((double)imm.probability - 0.5) < 1e-3);
    assert_true(fabs((double)gain_nat - log(2e-9 / sqrt(4.0 * 6.283185307))) < 1e-3);
    imm.probability = 1.0f;
    rho_imm_update_probability(&imm, near_and_far, variance, &gain_nat);
    assert_true(fabs((double)imm.probability - 0.5) < 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_range_rate_is_predicted_from_a_metre_of_range_on),
        cmocka_unit_test(a_model_of_probability_zero_keeps_a_billionth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
