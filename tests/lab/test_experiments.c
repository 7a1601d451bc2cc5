/* SPDX-License-Identifier: MIT */
/*
 * `rhotrack experiment false-alarms` through its functions, with few runs and a fixed seed. Bounds
 * are four standard deviations of so few runs away from the figures of many (the comment at each).
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "experiment_alarms.h"

#define SEED 4711

/* ---- false alarms ---------------------------------------------------------------------------- */

struct delays {
    int targets, on_third_plot, too_late;
    double confirmed_at, possible_at;
};

static struct delays run_delays(double per_km2, uint64_t num_runs)
{
    struct pipeline chain = pipeline_start();
    struct delays delays = {0};
    for (uint64_t run = 0; run < num_runs; run++) {
        struct delay_result result = delay_run(per_km2, SEED, run, &chain);
        for (int i = 0; i < DELAY_TARGETS; i++) {
            delays.targets++;
            delays.on_third_plot += result.plots[i] == 3;
            delays.too_late += result.confirmed_at[i] > result.possible_at[i] + 1;
            delays.confirmed_at += result.confirmed_at[i];
            delays.possible_at += result.possible_at[i];
        }
    }
    pipeline_free(&chain);
    print_message("%g a km^2: %d of %d on the 3rd plot, %d late; scan %.2f, possible at %.2f\n",
                  per_km2, delays.on_third_plot, delays.targets, delays.too_late,
                  delays.confirmed_at / delays.targets, delays.possible_at / delays.targets);
    return delays;
}

static void in_a_clear_sky_the_third_plot_confirms(void **state)
{
    (void)state;
    struct delays delays = run_delays(0.0, 10);
    assert_int_equal(delays.targets, 30);
    assert_int_equal(delays.on_third_plot, 30); /* 1.000 */
    assert_int_equal(delays.too_late, 0);
    /* of 30 targets, each of the first plots may be missed once in a hundred: 3.03 +- 0.03 */
    assert_true(delays.confirmed_at >= 3.0 * 30.0 && delays.confirmed_at <= 3.16 * 30.0);
    assert_true(delays.possible_at >= 3.0 * 30.0 && delays.possible_at <= delays.confirmed_at);
}

static void in_clutter_targets_are_confirmed_soon_after_they_can_be(void **state)
{
    (void)state;
    struct delays delays = run_delays(1.0, 10);
    assert_int_equal(delays.on_third_plot, 0); /* three plots are not enough there */
    assert_true(delays.too_late <= 2);         /* 0.00 */
    assert_true(fabs(delays.confirmed_at - delays.possible_at) <= 0.5 * delays.targets); /* 0.0 */
    assert_true(delays.confirmed_at >= 4.0 * delays.targets);                            /* 4.5 */
    assert_true(delays.confirmed_at <= 5.5 * delays.targets);
}

/* Over 111 h at 0.1 a km^2: 1.25 an hour where 1 is wanted, 7.5 where 10 are. A run has 5.6 h. */
static void clutter_alone_confirms_as_many_tracks_as_are_wanted(void **state)
{
    struct pipeline chain = pipeline_start();
    (void)state;
    struct alarm_result one = alarm_run(0.1, 1.0, SEED, 0, &chain);
    struct alarm_result ten = alarm_run(0.1, 10.0, SEED, 0, &chain);
    print_message("%.2f hours: %.0f tracks at 1 an hour, %.0f at 10\n", one.hours, one.confirmed,
                  ten.confirmed);
    assert_true(fabs(one.scans - ALARM_SCANS) < 0.5);
    assert_true(fabs(one.hours - ALARM_SCANS * 2.0 / 3600.0) < 1e-9);
    assert_true(one.confirmed >= 1.0 && one.confirmed <= 17.0);  /* 6.9 */
    assert_true(ten.confirmed >= 16.0 && ten.confirmed <= 68.0); /* 41.7 */
    assert_true(one.started >= one.confirmed && ten.started >= ten.confirmed);
    assert_true(one.confirm_nat > ten.confirm_nat); /* the threshold is what tells them apart */
    pipeline_free(&chain);
}

/* But for the time it took. */
static void the_same_run_gives_the_same_figures(void **state)
{
    struct pipeline chain = pipeline_start();
    (void)state;
    struct delay_result once = delay_run(1.0, SEED, 3, &chain);
    (void)delay_run(0.1, SEED, 4, &chain);
    struct delay_result again = delay_run(1.0, SEED, 3, &chain);
    struct delay_result other = delay_run(1.0, SEED, 4, &chain);
    assert_memory_equal(&once, &again, sizeof once);
    assert_memory_not_equal(&once, &other, sizeof once);
    struct alarm_result clutter = alarm_run(0.1, 10.0, SEED, 1, &chain);
    struct alarm_result clutter_again = alarm_run(0.1, 10.0, SEED, 1, &chain);
    clutter.time_us = clutter_again.time_us;
    assert_memory_equal(&clutter, &clutter_again, sizeof clutter);
    pipeline_free(&chain);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(in_a_clear_sky_the_third_plot_confirms),
        cmocka_unit_test(in_clutter_targets_are_confirmed_soon_after_they_can_be),
        cmocka_unit_test(clutter_alone_confirms_as_many_tracks_as_are_wanted),
        cmocka_unit_test(the_same_run_gives_the_same_figures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
