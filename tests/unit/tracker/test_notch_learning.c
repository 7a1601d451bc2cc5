/* SPDX-License-Identifier: MIT */
/*
 * Which counts of looks by range rate say that a sensor has a notch, each limit from both sides: a
 * tracker with one aircraft, whose looks are the last of the counts.
 */
#include "tracker_setup.h"

#if RHO_DOPPLER_NOTCH

#define SENSOR 3
#define TOP (RHO_LEARN_RATES - 1) /* the interval of all range rates from 32 m/s on */
#define FEW 88                    /* looks there, of which nine in ten have a plot */

static int next;

/* One look at an aircraft that flies away with this speed. */
static void look(double speed_mps)
{
    const double x_m = 3000.0 + speed_mps * 4.0 * next;
    add_noisy_plot(x_m, 0.0, 1.0);
    step_scan((struct rho_scan){.time_us = INT64_C(4000000) * next, .sensor_id = SENSOR});
    next++;
}

static struct rho_tracker_learned *prepare(double speed_mps)
{
    const struct rho_sensor radar = {.sensor_id = SENSOR, .pd = 0.9f, .range_max_m = 60e3f};
    use_usual_configs(5);
    config.v_max_mps = initiation.v_max_mps = 200.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    for (next = 0; next < 30;) {
        look(speed_mps);
    }
    assert_int_equal(report.num_tracks, 1);
    struct rho_tracker_learned *learned = &tracker.learned[0];
    memset(learned->rate_looks, 0, sizeof learned->rate_looks);
    memset(learned->rate_hits, 0, sizeof learned->rate_hits);
    return learned;
}

/* The first intervals have as many looks each, and plots in so many of them. */
static struct rho_tracker_learned *prepare_slow(unsigned intervals, unsigned looks, unsigned hits)
{
    struct rho_tracker_learned *learned = prepare(75.0);
    memset(learned->rate_looks, (int)looks, intervals);
    memset(learned->rate_hits, (int)hits, intervals);
    return learned;
}

/* Intervals of the notch after the look that makes so many at the fast one, and so many plots. */
static unsigned found_with(unsigned looks, unsigned hits)
{
    struct rho_tracker_learned *learned = &tracker.learned[0];
    learned->rate_looks[TOP] = (uint8_t)(looks - 1u);
    learned->rate_hits[TOP] = (uint8_t)(hits - 1u);
    look(75.0);
    assert_true(rho_tracker_is_sound(&tracker));
    return learned->blind_rates;
}

static unsigned found(void)
{
    return found_with(FEW, FEW * 9 / 10);
}

/* From 0.25 m/s on, root 2 times as wide each: 2.8 to 4 m/s is the ninth, 32 m/s the last. */
static void intervals_are_octaves_of_the_square(void **state)
{
    struct rho_tracker_learned *learned = prepare(3.36);
    (void)state;
    look(3.36);
    assert_int_equal(learned->rate_looks[8], 1);
    assert_int_equal(learned->rate_hits[8], 1);
    learned = prepare(75.0);
    look(75.0);
    assert_int_equal(learned->rate_looks[TOP], 1);
}

/* 65 of 100 of what faster ones are seen, all together. */
static void a_notch_is_seen_less(void **state)
{
    (void)state;
    (void)prepare_slow(8, 10, 5);
    assert_int_equal(found(), 8);
    (void)prepare_slow(8, 10, 7);
    assert_int_equal(found(), 0);
}

/* 85 of 100 in the fastest of them. */
static void its_fastest_interval_is_seen_less(void **state)
{
    (void)state;
    prepare_slow(8, 10, 2)->rate_hits[7] = 7;
    assert_int_equal(found(), 8);
    prepare_slow(8, 10, 2)->rate_hits[7] = 8;
    assert_int_equal(found(), 7);
}

/* Four standard deviations: 9.8 of 24 looks where every other one is expected to have a plot. */
static void it_is_no_chance(void **state)
{
    (void)state;
    prepare_slow(8, 3, 0)->rate_hits[0] = 1;
    assert_int_equal(found_with(FEW, FEW / 2), 8);
    prepare_slow(8, 3, 0)->rate_hits[0] = 3;
    tracker.learned[0].rate_hits[1] = 1;
    assert_int_equal(found_with(FEW, FEW / 2), 0);
}

static void it_takes_20_looks_there_and_60_above(void **state)
{
    (void)state;
    (void)prepare_slow(8, 3, 0);
    assert_int_equal(found(), 8);
    (void)prepare_slow(8, 2, 0);
    assert_int_equal(found(), 0);
    (void)prepare_slow(4, 10, 0);
    assert_int_equal(found_with(48, 43), 0);
    assert_int_equal(found_with(64, 58), 4);
}

static void four_intervals_are_the_narrowest(void **state)
{
    (void)state;
    (void)prepare_slow(4, 10, 0);
    assert_int_equal(found(), 4);
    (void)prepare_slow(3, 10, 0);
    assert_int_equal(found(), 0);
}

/* A notch that is used, and its last interval with these counts. */
static unsigned used_after(unsigned looks, unsigned hits)
{
    struct rho_tracker_learned *learned = prepare_slow(8, 10, 0);
    learned->blind_rates = 8;
    learned->rate_looks[7] = (uint8_t)looks;
    learned->rate_hits[7] = (uint8_t)hits;
    return found();
}

/* It is narrower where that is seen 60 of 100 times as often, of 40 looks. */
static void a_notch_in_use_becomes_narrower(void **state)
{
    (void)state;
    assert_int_equal(used_after(50, 30), 7);
    assert_int_equal(used_after(50, 24), 8);
    assert_int_equal(used_after(30, 20), 8);
}

static void three_that_were_none_are_the_last(void **state)
{
    (void)state;
    prepare_slow(8, 10, 0)->notches_forgotten = 2;
    assert_int_equal(found(), 8);
    prepare_slow(8, 10, 0)->notches_forgotten = 3;
    assert_int_equal(found(), 0);
    struct rho_tracker_learned *learned = prepare_slow(8, 10, 9);
    learned->blind_rates = 8;
    assert_int_equal(found(), 0);
    assert_int_equal(learned->notches_forgotten, 1);
}

/* They are searched at each eighth look, and halved at 250. */
static void counts_of_looks(void **state)
{
    (void)state;
    (void)prepare_slow(8, 10, 0);
    assert_int_equal(found_with(FEW - 4, 75), 0);
    assert_int_equal(found_with(FEW, 79), 8);
    const struct rho_tracker_learned *learned = prepare(75.0);
    (void)found_with(248, 240);
    assert_int_equal(learned->rate_looks[TOP], 248);
    (void)found_with(250, 240);
    assert_int_equal(learned->rate_looks[TOP], 125);
    assert_int_equal(learned->rate_hits[TOP], 120);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(intervals_are_octaves_of_the_square),
        cmocka_unit_test(a_notch_is_seen_less),
        cmocka_unit_test(its_fastest_interval_is_seen_less),
        cmocka_unit_test(it_is_no_chance),
        cmocka_unit_test(it_takes_20_looks_there_and_60_above),
        cmocka_unit_test(four_intervals_are_the_narrowest),
        cmocka_unit_test(a_notch_in_use_becomes_narrower),
        cmocka_unit_test(three_that_were_none_are_the_last),
        cmocka_unit_test(counts_of_looks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
