/* SPDX-License-Identifier: MIT */
/*
 * Which counts of looks by range rate show that a sensor has a Doppler notch, each limit from both
 * sides: one aircraft, whose looks complete prepared counts.
 */
#include "tracker_setup.h"

#if RHO_DOPPLER_NOTCH

#define SENSOR 3
#define TOP (RHO_LEARN_RATES - 1) /* the interval of all range rates from 32 m/s up */
#define FEW 88                    /* looks in it, nine in ten of which have a plot */

static int next;

/* Steps one look at an aircraft that flies away at this speed. */
static void step_look_at_speed(double speed_mps)
{
    const double x_m = 3000.0 + speed_mps * 4.0 * next;
    add_noisy_plot(x_m, 0.0, 1.0);
    step_scan((struct rho_scan){.time_us = INT64_C(4000000) * next, .sensor_id = SENSOR});
    next++;
}

static struct rho_tracker_learned *start_with_looks_at(double speed_mps)
{
    const struct rho_sensor radar = {.sensor_id = SENSOR, .pd = 0.9f, .range_max_m = 60e3f};
    use_usual_configs(5);
    config.v_max_mps = initiation.v_max_mps = 200.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    for (next = 0; next < 30;) {
        step_look_at_speed(speed_mps);
    }
    assert_int_equal(report.num_tracks, 1);
    struct rho_tracker_learned *learned = &tracker.sensors[0].learned;
    memset(learned->rate_looks, 0, sizeof learned->rate_looks);
    memset(learned->rate_hits, 0, sizeof learned->rate_hits);
    return learned;
}

/* Sets the counts of the first intervals: so many looks each, and hits. */
static struct rho_tracker_learned *start_with_slow_counts(unsigned intervals, unsigned looks,
                                                          unsigned hits)
{
    struct rho_tracker_learned *learned = start_with_looks_at(75.0);
    memset(learned->rate_looks, (int)looks, intervals);
    memset(learned->rate_hits, (int)hits, intervals);
    return learned;
}

/* Intervals in the notch after the look that makes the TOP interval have so many looks and hits. */
static unsigned notch_intervals_after_top_counts(unsigned top_looks, unsigned top_hits)
{
    struct rho_tracker_learned *learned = &tracker.sensors[0].learned;
    learned->rate_looks[TOP] = (uint8_t)(top_looks - 1u);
    learned->rate_hits[TOP] = (uint8_t)(top_hits - 1u);
    step_look_at_speed(75.0);
    assert_true(rho_tracker_is_sound(&tracker));
    return learned->blind_rates;
}

static unsigned notch_intervals_found(void)
{
    return notch_intervals_after_top_counts(FEW, FEW * 9 / 10);
}

/*
 * Intervals begin at 0.25 m/s, each root 2 times as wide as the one before: 2.8 to 4 m/s is the
 * ninth, 32 m/s the last.
 */
static void range_rate_intervals_widen_by_root_2(void **state)
{
    struct rho_tracker_learned *learned = start_with_looks_at(3.36);
    (void)state;
    step_look_at_speed(3.36);
    assert_int_equal(learned->rate_looks[8], 1);
    assert_int_equal(learned->rate_hits[8], 1);
    learned = start_with_looks_at(75.0);
    step_look_at_speed(75.0);
    assert_int_equal(learned->rate_looks[TOP], 1);
}

/* Intervals of a notch together are seen below 65 % as often as faster ones. */
static void a_notch_is_seen_less_than_65_percent_as_often(void **state)
{
    (void)state;
    (void)start_with_slow_counts(8, 10, 5);
    assert_int_equal(notch_intervals_found(), 8);
    (void)start_with_slow_counts(8, 10, 7);
    assert_int_equal(notch_intervals_found(), 0);
}

/* The fastest interval of a notch is seen below 85 % as often. */
static void the_fastest_interval_of_a_notch_is_below_85_percent(void **state)
{
    (void)state;
    start_with_slow_counts(8, 10, 2)->rate_hits[7] = 7;
    assert_int_equal(notch_intervals_found(), 8);
    start_with_slow_counts(8, 10, 2)->rate_hits[7] = 8;
    assert_int_equal(notch_intervals_found(), 7);
}

/*
 * By four standard deviations: 9.8 for 24 looks, every other of which is expected to have a plot.
 */
static void a_notch_is_rarer_than_chance_by_four_standard_deviations(void **state)
{
    (void)state;
    start_with_slow_counts(8, 3, 0)->rate_hits[0] = 1;
    assert_int_equal(notch_intervals_after_top_counts(FEW, FEW / 2), 8);
    start_with_slow_counts(8, 3, 0)->rate_hits[0] = 3;
    tracker.sensors[0].learned.rate_hits[1] = 1;
    assert_int_equal(notch_intervals_after_top_counts(FEW, FEW / 2), 0);
}

static void a_notch_needs_20_looks_within_and_60_above(void **state)
{
    (void)state;
    (void)start_with_slow_counts(8, 3, 0);
    assert_int_equal(notch_intervals_found(), 8);
    (void)start_with_slow_counts(8, 2, 0);
    assert_int_equal(notch_intervals_found(), 0);
    (void)start_with_slow_counts(4, 10, 0);
    assert_int_equal(notch_intervals_after_top_counts(48, 43), 0);
    assert_int_equal(notch_intervals_after_top_counts(64, 58), 4);
}

static void a_notch_is_at_least_four_intervals_wide(void **state)
{
    (void)state;
    (void)start_with_slow_counts(4, 10, 0);
    assert_int_equal(notch_intervals_found(), 4);
    (void)start_with_slow_counts(3, 10, 0);
    assert_int_equal(notch_intervals_found(), 0);
}

/* Sets a learned notch of eight intervals, the last with these counts. */
static unsigned notch_intervals_after_counts(unsigned looks, unsigned hits)
{
    struct rho_tracker_learned *learned = start_with_slow_counts(8, 10, 0);
    learned->blind_rates = 8;
    learned->rate_looks[7] = (uint8_t)looks;
    learned->rate_hits[7] = (uint8_t)hits;
    return notch_intervals_found();
}

/* A notch narrows if its last interval is seen 60 % as often, from 40 looks on. */
static void a_notch_narrows_when_its_last_interval_is_seen(void **state)
{
    (void)state;
    assert_int_equal(notch_intervals_after_counts(50, 30), 7);
    assert_int_equal(notch_intervals_after_counts(50, 24), 8);
    assert_int_equal(notch_intervals_after_counts(30, 20), 8);
}

static void after_three_false_notches_none_is_learned(void **state)
{
    (void)state;
    start_with_slow_counts(8, 10, 0)->notches_forgotten = 2;
    assert_int_equal(notch_intervals_found(), 8);
    start_with_slow_counts(8, 10, 0)->notches_forgotten = 3;
    assert_int_equal(notch_intervals_found(), 0);
    struct rho_tracker_learned *learned = start_with_slow_counts(8, 10, 9);
    learned->blind_rates = 8;
    assert_int_equal(notch_intervals_found(), 0);
    assert_int_equal(learned->notches_forgotten, 1);
}

/* Counts are searched at each eighth look, and halved at 250. */
static void looks_are_counted_and_halved_at_250(void **state)
{
    (void)state;
    (void)start_with_slow_counts(8, 10, 0);
    assert_int_equal(notch_intervals_after_top_counts(FEW - 4, 75), 0);
    assert_int_equal(notch_intervals_after_top_counts(FEW, 79), 8);
    const struct rho_tracker_learned *learned = start_with_looks_at(75.0);
    (void)notch_intervals_after_top_counts(248, 240);
    assert_int_equal(learned->rate_looks[TOP], 248);
    (void)notch_intervals_after_top_counts(250, 240);
    assert_int_equal(learned->rate_looks[TOP], 125);
    assert_int_equal(learned->rate_hits[TOP], 120);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(range_rate_intervals_widen_by_root_2),
        cmocka_unit_test(a_notch_is_seen_less_than_65_percent_as_often),
        cmocka_unit_test(the_fastest_interval_of_a_notch_is_below_85_percent),
        cmocka_unit_test(a_notch_is_rarer_than_chance_by_four_standard_deviations),
        cmocka_unit_test(a_notch_needs_20_looks_within_and_60_above),
        cmocka_unit_test(a_notch_is_at_least_four_intervals_wide),
        cmocka_unit_test(a_notch_narrows_when_its_last_interval_is_seen),
        cmocka_unit_test(after_three_false_notches_none_is_learned),
        cmocka_unit_test(looks_are_counted_and_halved_at_250),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
