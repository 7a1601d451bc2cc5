/* SPDX-License-Identifier: MIT */
/* `experiment doppler` and `rotating` with few runs and a fixed seed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "experiment_doppler.h"
#include "experiment_rotating.h"

#define SEED 4711

static void assert_near(double value, double wanted, double tolerance)
{
    if (!(fabs(value - wanted) <= tolerance)) {
        fail_msg("%g is not within %g of %g", value, tolerance, wanted);
    }
}

/* ---- doppler --------------------------------------------------------------------------------- */

/*
 * 0.97 of the targets have a track after five turns without range rates and with ten times the
 * clutter and them, 0.95 with a span; 18 targets: four standard deviations are .19.
 */
static void range_rates_bear_ten_times_the_clutter(void **state)
{
    (void)state;
    static const double clutter[] = {100.0, 1000.0, 1000.0};
    for (size_t i = 0; i < sizeof clutter / sizeof clutter[0]; i++) {
        struct doppler_figures figures =
            doppler_measure(&doppler_cases[i], clutter[i], 0.0, SEED, 6);
        print_message("%s, %g a turn: Pd %.3f, after five %.3f, at %.2f, rmse %.0f m\n",
                      figures.of->name, clutter[i], figures.found, figures.prompt,
                      figures.confirm_at, figures.rmse_m);
        assert_true(figures.found >= 0.8 && figures.prompt >= 0.77);
        assert_true(figures.false_a_run <= 0.5 && figures.false_tracks <= 0.5);
        assert_near(figures.rmse_m, 170.0, 60.0);
    }
    struct doppler_figures without = doppler_measure(&doppler_cases[0], 1000.0, 0.0, SEED, 2);
    assert_true(without.prompt <= 0.5); /* 0 of 2000 a turn */
}

/* ---- rotating -------------------------------------------------------------------------------- */

/* 1.000 found and tracked by whole turns and at once; rmse 113 and 93 m. */
static void whole_turns_are_followed(void **state)
{
    (void)state;
    struct rotating_figures *figures = rotating_measure(SEED, 4);
    for (size_t i = ROTATING_TURNS; i < ROTATING_CASES; i++) {
        assert_true(figures[i].found >= 0.8 && figures[i].tracked >= 0.9);
        assert_true(figures[i].false_a_run <= 0.5);
    }
    assert_near(figures[ROTATING_TURNS].rmse_m, 113.0, 40.0);
    assert_near(figures[ROTATING_AT_ONCE].rmse_m, 93.0, 35.0);
    /* a plot waits for its sector, or its turn, to end, and for the step */
    assert_true(figures[ROTATING_SECTORS].latency_max_ms > 120.0);
    assert_true(figures[ROTATING_SECTORS].latency_max_ms < 200.0);
    assert_true(figures[ROTATING_TURNS].latency_max_ms > 3900.0);
    assert_true(figures[ROTATING_SECTORS].step_max_us > 0.0);
    rotating_figures_free(figures);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(range_rates_bear_ten_times_the_clutter),
        cmocka_unit_test(whole_turns_are_followed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
