/* SPDX-License-Identifier: MIT */
/*
 * How far a fit may move a state. Fits that diverge begin with crossings that no scene makes on
 * purpose, so the test includes a private header.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "../../src/bearings/passive_search.h"

static struct rho_passive passive = {.config = {.range_max_m = 1000.0f}};
static struct rho_passive_search search = {.passive = &passive, .half_s = 10.0f};

/* Without bearings the displacement goes to 0, a tenth of the range at a time. */
static void a_fit_stays_within_two_ranges_and_steps_a_tenth_of_one(void **state)
{
    static const uint8_t no_claims[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS];
    float state_m[4] = {5000.0f, -5000.0f, 500.0f, -60.0f};
    (void)state;
    rho_passive_fit_claimed(&search, state_m, no_claims);
    assert_true(fabsf(state_m[0] - 2000.0f) < 1e-3f && fabsf(state_m[1] + 2000.0f) < 1e-3f);
    assert_true(fabsf(state_m[2] - 400.0f) < 1e-3f && fabsf(state_m[3]) < 1e-3f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_fit_stays_within_two_ranges_and_steps_a_tenth_of_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
