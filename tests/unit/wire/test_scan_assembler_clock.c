/* SPDX-License-Identifier: MIT */
/* The common clock of several sensors: which sensors are off it, and when it is set anew. */
#include "scan_assembler_setup.h"

#define HOUR_US (3600 * SECOND_US)

static int32_t numbers[8];
static unsigned restarts;
static int64_t given_us;

static void start_assembler_and_scan_numbers(void)
{
    start_assembler();
    memset(numbers, 0, sizeof numbers);
    restarts = 0;
}

/* Takes the sensor's next scan and gives all scans held. Returns whether it was accepted. */
static int push_next_scan(int16_t sensor_id, int64_t time_us, int64_t now_us)
{
    uint32_t before = assembler.counters.scans_accepted;
    struct look look = {.time_us = time_us, .scan = ++numbers[sensor_id], .sensor_id = sensor_id};

    take_message(&look, now_us);
    while (rho_scan_assembler_next(&assembler, now_us + HOLD_US, &item)) {
        restarts += (unsigned)item.is_restart;
        given_us = item_time_us();
    }
    return assembler.counters.scans_accepted > before;
}

/*
 * One scan a second of each sensor in from .. to - 1, with right times, while the reception clock
 * is off by `off_us`.
 */
static void push_scans_of_sensors(unsigned sensors, int64_t from, int64_t to, int64_t off_us)
{
    for (int64_t t = from; t < to; t++) {
        for (unsigned s = 0; s < sensors; s++) {
            assert_true(push_next_scan((int16_t)s, t * SECOND_US, t * SECOND_US + off_us));
        }
    }
}

static void a_lone_sensor_may_jump_in_time_with_a_restart(void **state)
{
    static const int64_t jumps_us[] = {HOUR_US, -HOUR_US, INT64_C(3000000000000000000),
                                       INT64_C(-3000000000000000000)};

    (void)state;
    for (unsigned i = 0; i < 4; i++) {
        start_assembler_and_scan_numbers();
        push_scans_of_sensors(1, 0, 5, 0);
        for (int64_t t = 5; t < 10; t++) {
            assert_int_equal(push_next_scan(0, t * SECOND_US + jumps_us[i], t * SECOND_US), t >= 7);
            assert_int_equal(restarts, t >= 7);
        }
        COUNTERS_ARE(.scans_accepted = 8, .clock_jumps = 2, .sensor_restarts = 1);
    }
}

static void a_first_message_of_the_far_future_blocks_no_sensor(void **state)
{
    (void)state;
    for (unsigned sensors = 1; sensors <= 2; sensors++) {
        start_assembler_and_scan_numbers();
        /* without any other sensor, any time is accepted */
        assert_true(push_next_scan(7, INT64_C(4000000000000000000), 0));
        for (int64_t t = 0; t < 8; t++) {
            for (unsigned s = 0; s < sensors; s++) {
                int is_in = push_next_scan((int16_t)s, t * SECOND_US, t * SECOND_US);
                assert_int_equal(is_in, t > 2 || (t == 2 && s == 0) || (t == 2 && s == 1));
            }
        }
        assert_int_equal(restarts, 1);
        COUNTERS_ARE(.scans_accepted = 1 + 6 * sensors, .clock_jumps = 2 * sensors);
    }
}

static void a_wrong_clock_from_the_start_is_outvoted(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    for (int64_t t = 0; t < 20; t++) {
        int is_wrong_in = push_next_scan(7, t * SECOND_US + HOUR_US, t * SECOND_US + 5 * HOUR_US);
        int is_0_in = push_next_scan(0, t * SECOND_US, t * SECOND_US + 5 * HOUR_US);
        int is_1_in = push_next_scan(1, t * SECOND_US, t * SECOND_US + 5 * HOUR_US);

        assert_int_equal(is_wrong_in, t < 3);
        assert_int_equal(is_0_in, t > 2);
        assert_int_equal(is_1_in, t >= 2);
    }
    assert_int_equal(restarts, 1);
}

static void a_sensor_jumping_ahead_or_back_changes_nothing(void **state)
{
    static const int64_t jumps_us[] = {18 * SECOND_US, -18 * SECOND_US,
                                       6 * SECOND_US,  HOUR_US,
                                       -HOUR_US,       INT64_C(3999999000000000000)};

    (void)state;
    for (unsigned i = 0; i < 6; i++) {
        for (unsigned good = 1; good <= 2; good++) {
            start_assembler_and_scan_numbers();
            push_scans_of_sensors(good + 1, 0, 5, 0);
            for (int64_t t = 5; t < 200; t++) {
                for (unsigned s = 0; s < good; s++) {
                    assert_true(push_next_scan((int16_t)s, t * SECOND_US, t * SECOND_US));
                    assert_int_equal(given_us, t * SECOND_US);
                }
                assert_false(
                    push_next_scan((int16_t)good, t * SECOND_US + jumps_us[i], t * SECOND_US));
            }
            assert_int_equal(restarts, 0);
            assert_int_equal(assembler.counters.clock_jumps + assembler.counters.scans_late +
                                 assembler.counters.scans_bad,
                             195);
            assert_int_equal(assembler.counters.scans_accepted, 5 * (good + 1) + 195 * good);
        }
    }
}

static void a_new_sensor_five_seconds_ahead_changes_nothing(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    push_scans_of_sensors(1, 0, 5, 0);
    for (int64_t t = 5; t < 100; t++) {
        assert_false(push_next_scan(3, t * SECOND_US + 5 * SECOND_US, t * SECOND_US));
        assert_true(push_next_scan(0, t * SECOND_US, t * SECOND_US));
    }
    COUNTERS_ARE(.scans_accepted = 100, .clock_jumps = 95);
}

/* A new sensor may be ahead by the clock tolerance, but not by that much more at each scan. */
static void a_slowly_drifting_sensor_does_not_move_the_clock(void **state)
{
    int64_t lead_us = 0;
    unsigned refused = 0;

    (void)state;
    start_assembler_and_scan_numbers();
    push_scans_of_sensors(2, 0, 5, 0);
    for (int64_t t = 5; t < 100; t++) {
        assert_true(push_next_scan(0, t * SECOND_US, t * SECOND_US));
        assert_true(push_next_scan(1, t * SECOND_US, t * SECOND_US));
        lead_us += 400000;
        refused += !push_next_scan(3, t * SECOND_US + lead_us, t * SECOND_US);
    }
    assert_in_range(refused, 80, 90);
    assert_int_equal(restarts, 0);
}

static void the_majority_moves_the_clock(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    push_scans_of_sensors(3, 0, 5, 0);
    for (int64_t t = 5; t < 20; t++) { /* two of three sensors jump */
        int is_0 = push_next_scan(0, t * SECOND_US, t * SECOND_US + 100 * HOUR_US);
        int is_1 = push_next_scan(1, t * SECOND_US + HOUR_US, t * SECOND_US + 100 * HOUR_US);
        int is_2 = push_next_scan(2, t * SECOND_US + HOUR_US, t * SECOND_US + 100 * HOUR_US);

        assert_int_equal(is_0, t <= 7);
        assert_int_equal(is_1, t > 7);
        assert_int_equal(is_2, t >= 7);
    }
    assert_int_equal(restarts, 1);
    assert_int_equal(assembler.counters.sensor_restarts, 2);
    for (int64_t t = 20; t < 25; t++) { /* and the third one follows */
        int is_0 = push_next_scan(0, t * SECOND_US + HOUR_US, t * SECOND_US + 100 * HOUR_US);

        assert_int_equal(is_0, t >= 22);
        assert_true(push_next_scan(1, t * SECOND_US + HOUR_US, t * SECOND_US + 100 * HOUR_US));
    }
    assert_int_equal(restarts, 1);
}

static void sensors_set_together_move_the_clock_once(void **state)
{
    static const int64_t jumps_us[] = {HOUR_US, -HOUR_US, -20 * SECOND_US, 20 * SECOND_US};

    (void)state;
    for (unsigned i = 0; i < 4; i++) {
        for (unsigned sensors = 1; sensors <= 4; sensors++) {
            start_assembler_and_scan_numbers();
            push_scans_of_sensors(sensors, 0, 5, 7 * HOUR_US);
            for (int64_t t = 5; t < 30; t++) {
                for (unsigned s = 0; s < sensors; s++) {
                    (void)push_next_scan((int16_t)s, t * SECOND_US + jumps_us[i],
                                         t * SECOND_US + 7 * HOUR_US);
                }
            }
            assert_int_equal(restarts <= 1, 1);
            assert_int_equal(given_us, 29 * SECOND_US + jumps_us[i]);
            assert_in_range(assembler.counters.scans_accepted, sensors * 5 + sensors * 20 - 3,
                            sensors * 30);
        }
    }
}

/* Two sensors with different clocks, one vote each. */
static void of_two_sensors_the_one_near_the_reception_clock_is_followed(void **state)
{
    (void)state;
    for (int wrong = 0; wrong < 2; wrong++) { /* the wrong clock is the first one or the second */
        start_assembler_and_scan_numbers();
        for (int64_t t = 0; t < 20; t++) {
            int64_t off_us = 18 * SECOND_US;
            int is_0 = push_next_scan(0, t * SECOND_US + (wrong == 0 ? off_us : 0), t * SECOND_US);
            int is_1 = push_next_scan(1, t * SECOND_US + (wrong == 1 ? off_us : 0), t * SECOND_US);

            if (t >= 5) {
                assert_int_equal(is_0, wrong == 1);
                assert_int_equal(is_1, wrong == 0);
            }
        }
        assert_int_equal(restarts, wrong == 0);
    }
}

/* Two clocks equally far from the reception clock. */
static void the_first_sensor_decides_if_both_are_as_near_the_reception_clock(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    for (int64_t t = 0; t < 20; t++) {
        assert_true(push_next_scan(0, t * SECOND_US + 3200000, t * SECOND_US));
        assert_int_equal(push_next_scan(1, t * SECOND_US - 3200000, t * SECOND_US), t == 0);
    }
    COUNTERS_ARE(.scans_accepted = 21, .clock_jumps = 19);
}

static void the_first_sensor_decides_if_the_reception_clock_is_far_from_both(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    for (int64_t t = 0; t < 20; t++) {
        assert_true(push_next_scan(0, t * SECOND_US + HOUR_US, t * SECOND_US + 9 * HOUR_US));
        assert_false(push_next_scan(1, t * SECOND_US, t * SECOND_US + 9 * HOUR_US));
    }
    COUNTERS_ARE(.scans_accepted = 20, .clock_jumps = 20);
}

static void a_gone_sensor_has_no_vote_on_the_clock(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    push_scans_of_sensors(2, 0, 5, 0);
    for (int64_t t = 5; t < 60; t++) { /* sensor 0 is silent, sensor 1 is ahead */
        (void)push_next_scan(1, t * SECOND_US + HOUR_US, t * SECOND_US);
    }
    assert_int_equal(restarts, 1);
    assert_in_range(assembler.counters.clock_jumps, 29, 32);
}

static void a_silent_sensor_keeps_its_vote_for_jump_max(void **state)
{
    (void)state;
    for (int more_us = 0; more_us < 2; more_us++) {
        start_assembler_and_scan_numbers();
        push_scans_of_sensors(1, 0, 5, 0);
        assert_int_equal(push_next_scan(1, -6 * SECOND_US, 4 * SECOND_US + JUMP_US + more_us),
                         more_us);
    }
}

static void the_first_scan_on_a_new_clock_is_marked_restart(void **state)
{
    struct look first = {.time_us = HOUR_US + 7 * SECOND_US, .sensor_id = 1},
                older = {.time_us = HOUR_US + 7 * SECOND_US - 5, .sensor_id = 2};

    (void)state;
    start_assembler_and_scan_numbers();
    push_scans_of_sensors(3, 0, 5, 0);
    for (int64_t t = 5; t < 7; t++) {
        for (int16_t s = 0; s < 3; s++) {
            assert_false(push_next_scan(s, t * SECOND_US + HOUR_US, t * SECOND_US));
        }
    }
    /* one sensor alone against two */
    assert_false(push_next_scan(0, 7 * SECOND_US + HOUR_US - 9, 7 * SECOND_US));
    first.scan = ++numbers[1];
    take_message(&first, 7 * SECOND_US); /* two sensors against one */
    older.scan = ++numbers[2];
    take_message(&older, 7 * SECOND_US); /* given before the clock is set */
    expect_next_scan(7 * SECOND_US + HOLD_US, 2, older.time_us);
    assert_int_equal(item.is_restart, 1);
    expect_next_scan(7 * SECOND_US + HOLD_US, 1, first.time_us);
    assert_int_equal(item.is_restart, 0);
}

static void scans_waiting_when_the_clock_is_set_are_late(void **state)
{
    struct look look = {.time_us = 7 * SECOND_US, .scan = 6, .sensor_id = 2};

    (void)state;
    start_assembler_and_scan_numbers();
    push_scans_of_sensors(3, 0, 5, 0);
    for (int64_t t = 5; t < 8; t++) {
        if (t == 7) {
            take_message(&look, 7 * SECOND_US); /* waits for the other sensors */
        }
        for (int16_t s = 0; s < 2; s++) {
            struct look jump = {
                .time_us = t * SECOND_US + HOUR_US, .scan = ++numbers[s], .sensor_id = s};
            take_message(&jump, t * SECOND_US);
        }
    }
    assert_int_equal(assembler.counters.scans_late, 1);
    expect_next_scan(8 * SECOND_US, 1, 7 * SECOND_US + HOUR_US);
    assert_int_equal(item.is_restart, 1);
    expect_no_scan(INT64_MAX);
}

static void parts_of_a_scan_off_the_clock_are_not_counted_as_doubles(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    push_scans_of_sensors(1, 0, 5, 0);
    for (int part = 0; part < 3; part++) {
        struct look look = {
            .time_us = HOUR_US, .scan = 1, .sensor_id = 4, .part = (int16_t)part, .num_parts = 3};
        take_message(&look, 4 * SECOND_US);
    }
    COUNTERS_ARE(.scans_accepted = 5, .clock_jumps = 3);
}

/*
 * Radars of long intervals beside fast sensors, with dead times and network delays: no sensor is
 * off the clock.
 */
static void sensors_with_usual_delays_are_never_off_the_clock(void **state)
{
    static const int64_t interval_us[] = {100000, 1000000, 2500000, 12000000, 500000};
    static const int64_t delay_us[] = {5000, 200000, 1500000, 300000, 50000};
    static const int64_t clocks_us[] = {0, 5 * HOUR_US, -5 * HOUR_US};

    (void)state;
    for (unsigned c = 0; c < 3; c++) {
        start_assembler_and_scan_numbers();
        for (int64_t t = 0; t < 400 * SECOND_US; t += 50000) {
            for (int16_t s = 0; s < 5; s++) {
                int64_t age_us = t - delay_us[s] - s * 30000;
                int64_t time_us = age_us / 50000 * 50000;
                /* silent for longer than jump_max */
                int is_silent = s == 4 && t / (40 * SECOND_US) % 2;

                if (age_us >= 0 && time_us % interval_us[s] == 0 && !is_silent) {
                    (void)push_next_scan(s, time_us, t + clocks_us[c]);
                }
            }
        }
        assert_int_equal(restarts, 0);
        assert_int_equal(assembler.counters.scans_late, 0);
        /* at each return of the fifth sensor */
        assert_int_equal(assembler.counters.clock_jumps, 4 * 2);
        assert_int_equal(assembler.counters.scans_bad + assembler.counters.scans_duplicate, 0);
    }
}

/* A record played ten times as fast, with today's reception clock. */
static void a_record_played_ten_times_as_fast_is_accepted(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    for (int64_t t = 0; t < 1000; t++) {
        for (int16_t s = 0; s < 3; s++) {
            assert_true(push_next_scan(s, t * SECOND_US + s * 100000, t * SECOND_US / 10));
        }
    }
    assert_int_equal(restarts, 0);
    start_assembler_and_scan_numbers();
    for (int64_t t = 0; t < 1000; t++) { /* or without a reception clock */
        for (int16_t s = 0; s < 3; s++) {
            assert_true(push_next_scan(s, t * SECOND_US + s * 100000, 0));
        }
    }
}

/*
 * A short record played again: times of given scans come again, with another epoch. Beside another
 * sensor its clock has stepped, and it is left aside.
 */
static void a_lone_sensor_restarting_in_the_past_sets_the_clock(void **state)
{
    (void)state;
    for (int with_others = 0; with_others < 2; with_others++) {
        start_assembler_and_scan_numbers();
        push_scans_of_sensors(1u + (unsigned)with_others, 0, 20, 0);
        numbers[0] = 500;
        for (int64_t t = 20; t < 24; t++) {
            if (with_others) {
                assert_true(push_next_scan(1, t * SECOND_US, t * SECOND_US));
            }
            assert_int_equal(push_next_scan(0, (t - 3) * SECOND_US, t * SECOND_US),
                             t >= 22 && !with_others);
        }
        assert_int_equal(restarts, with_others ? 0 : 1);
    }
}

/* Two sensors of a record are played again, at times within jump_max. */
static void sensors_of_a_record_played_again_set_the_clock(void **state)
{
    (void)state;
    start_assembler_and_scan_numbers();
    push_scans_of_sensors(2, 0, 20, 0);
    numbers[0] = numbers[1] = 100;
    for (int64_t t = 0; t < 10; t++) {
        (void)push_next_scan(0, t * SECOND_US, (t + 20) * SECOND_US);
        assert_int_equal(push_next_scan(1, t * SECOND_US, (t + 20) * SECOND_US), t >= 2);
    }
    assert_int_equal(restarts, 1);
    assert_int_equal(assembler.counters.scans_accepted, 40 + 7 + 8);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lone_sensor_may_jump_in_time_with_a_restart),
        cmocka_unit_test(a_first_message_of_the_far_future_blocks_no_sensor),
        cmocka_unit_test(a_wrong_clock_from_the_start_is_outvoted),
        cmocka_unit_test(a_sensor_jumping_ahead_or_back_changes_nothing),
        cmocka_unit_test(a_new_sensor_five_seconds_ahead_changes_nothing),
        cmocka_unit_test(a_slowly_drifting_sensor_does_not_move_the_clock),
        cmocka_unit_test(the_majority_moves_the_clock),
        cmocka_unit_test(sensors_set_together_move_the_clock_once),
        cmocka_unit_test(of_two_sensors_the_one_near_the_reception_clock_is_followed),
        cmocka_unit_test(the_first_sensor_decides_if_both_are_as_near_the_reception_clock),
        cmocka_unit_test(the_first_sensor_decides_if_the_reception_clock_is_far_from_both),
        cmocka_unit_test(a_silent_sensor_keeps_its_vote_for_jump_max),
        cmocka_unit_test(a_gone_sensor_has_no_vote_on_the_clock),
        cmocka_unit_test(the_first_scan_on_a_new_clock_is_marked_restart),
        cmocka_unit_test(scans_waiting_when_the_clock_is_set_are_late),
        cmocka_unit_test(parts_of_a_scan_off_the_clock_are_not_counted_as_doubles),
        cmocka_unit_test(sensors_with_usual_delays_are_never_off_the_clock),
        cmocka_unit_test(a_record_played_ten_times_as_fast_is_accepted),
        cmocka_unit_test(a_lone_sensor_restarting_in_the_past_sets_the_clock),
        cmocka_unit_test(sensors_of_a_record_played_again_set_the_clock),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
