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
    static const float far_and_near[2] = {2e-9f, 2.0f}, near_and_far[2] = {2.0f, 2e-9f},
                       neither[2] = {0.0f, 0.0f};
    float probability = 0.0f;
    (void)state;
    assert_true(fabs((double)rho_imm_weigh_models(&probability, far_and_near) / 4e-9 - 1.0) < 1e-3);
    assert_true(fabs((double)probability - 0.5) < 1e-3);
    probability = 1.0f;
    assert_true(fabs((double)rho_imm_weigh_models(&probability, near_and_far) / 4e-9 - 1.0) < 1e-3);
    assert_true(fabs((double)probability - 0.5) < 1e-3);
    probability = 0.25f;
    assert_true(rho_imm_weigh_models(&probability, neither) == 0.0f && probability == 0.25f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_range_rate_is_predicted_from_a_metre_of_range_on),
        cmocka_unit_test(a_model_of_probability_zero_keeps_a_billionth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
