/* SPDX-License-Identifier: MIT */
/* Which of one sensor's scans are believed: numbers, epochs and times. */
#include "scan_assembler_setup.h"

static int32_t epoch;

/*
 * One scan of sensor 1; what goes out once it was held is drained. Returns whether it was accepted.
 */
static int push(int32_t scan, int64_t time_us, int64_t now_us)
{
    struct look look = {.time_us = time_us, .scan = scan, .epoch = epoch, .sensor_id = 1};
    uint32_t before = assembler.counters.scans_accepted;

    take_message(&look, now_us);
    if (assembler.counters.scans_accepted > before) {
        expect_next_scan(now_us + HOLD_US, 1, time_us);
        expect_no_scan(now_us + HOLD_US);
        return 1;
    }
    expect_no_scan(now_us + HOLD_US);
    return 0;
}

/* Scans 1 .. count, one a second, from `scan` on. */
static void begin(int32_t scan, int32_t count)
{
    start_assembler();
    epoch = 0;
    for (int32_t i = 0; i < count; i++) {
        assert_true(push(scan + i, i * SECOND_US, i * SECOND_US));
    }
}

static void scans_count_up(void **state)
{
    (void)state;
    begin(1, 100);
    COUNTERS_ARE(.scans_accepted = 100);
    assert_int_equal(assembler.sources[0].interval_us, SECOND_US);
}

static void numbers_wrap(void **state)
{
    (void)state;
    begin(INT32_MAX - 2, 3);
    assert_true(push(INT32_MIN, 3 * SECOND_US, 3 * SECOND_US));
    assert_true(push(INT32_MIN + 2, 5 * SECOND_US, 5 * SECOND_US));
    assert_false(push(INT32_MAX, 2 * SECOND_US, 5 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 5, .scans_lost = 1, .scans_duplicate = 1);
}

static void what_is_skipped_is_lost(void **state)
{
    (void)state;
    begin(1, 3);
    for (int32_t skip = 1; skip <= RHO_SCAN_ASSEMBLER_SKIP_MAX && skip <= 30; skip++) {
        begin(1, 3);
        assert_true(push(3 + skip, (2 + skip) * SECOND_US, (2 + skip) * SECOND_US));
        COUNTERS_ARE(.scans_accepted = 4, .scans_lost = (uint32_t)skip - 1);
    }
}

static void as_many_as_skip_max_and_no_more(void **state)
{
    for (int32_t more = 0; more < 2; more++) {
        (void)state;
        start_assembler();
        for (int32_t i = 1; i <= 3; i++) {
            assert_true(push(i, i * 100000, i * 100000));
        }
        int32_t scan = 3 + RHO_SCAN_ASSEMBLER_SKIP_MAX + more;
        assert_int_equal(push(scan, scan * 100000, scan * 100000), more == 0);
        COUNTERS_ARE(.scans_accepted = 4 - (uint32_t)more, .scans_bad = (uint32_t)more,
                     .scans_lost = more ? 0 : RHO_SCAN_ASSEMBLER_SKIP_MAX - 1);
    }
}

static void old_numbers_are_double_or_late(void **state)
{
    (void)state;
    begin(1, 3);
    assert_true(push(6, 5 * SECOND_US, 5 * SECOND_US)); /* 4 and 5 are lost */
    assert_false(push(6, 5 * SECOND_US, 5 * SECOND_US));
    assert_false(push(3, 2 * SECOND_US, 5 * SECOND_US));
    assert_false(push(1, 0, 5 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 4, .scans_lost = 2, .scans_duplicate = 3);
    assert_true(push(4, 3 * SECOND_US, 5 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 5, .scans_lost = 2, .scans_duplicate = 3, .scans_late = 1);
    assert_false(push(4, 3 * SECOND_US, 5 * SECOND_US)); /* now it was there */
    assert_false(push(0, -SECOND_US, 5 * SECOND_US));    /* nobody has skipped it */
    COUNTERS_ARE(.scans_accepted = 5, .scans_lost = 2, .scans_duplicate = 4, .scans_late = 2);
}

static void memory_reaches_31_numbers_back(void **state)
{
    (void)state;
    start_assembler();
    for (int32_t i = 0; i < 40; i++) {
        assert_true(push(i, i * 100000, i * 100000));
    }
    assert_false(push(8, 800000, 3900000)); /* 31 back */
    COUNTERS_ARE(.scans_accepted = 40, .scans_duplicate = 1);
    assert_false(push(7, 700000, 3900000));
    COUNTERS_ARE(.scans_accepted = 40, .scans_duplicate = 1, .scans_bad = 1);
    assert_true(push(39 + 31, 7000000, 7000000)); /* 39 is the last one that is remembered */
    assert_false(push(39, 3900000, 7000000));
    assert_true(push(40, 4000000, 7000000));
    COUNTERS_ARE(.scans_accepted = 42, .scans_duplicate = 2, .scans_bad = 1, .scans_lost = 30,
                 .scans_late = 1);
    assert_true(push(70 + 32, 10200000, 10200000));
    assert_true(push(71, 7100000, 10200000));
    COUNTERS_ARE(.scans_accepted = 44, .scans_duplicate = 2, .scans_bad = 1, .scans_lost = 61,
                 .scans_late = 2);
}

static void a_new_epoch_is_followed_at_the_third_scan(void **state)
{
    (void)state;
    begin(500, 5);
    epoch = 9;
    assert_false(push(1, 5 * SECOND_US, 5 * SECOND_US));
    assert_false(push(2, 6 * SECOND_US, 6 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 5, .scans_bad = 2);
    assert_true(push(3, 7 * SECOND_US, 7 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 6, .scans_bad = 2, .sensor_restarts = 1);
    assert_true(push(4, 8 * SECOND_US, 8 * SECOND_US));
    assert_int_equal(item.is_restart, 0);
    assert_int_equal(assembler.sources[0].interval_us, SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_bad = 2, .sensor_restarts = 1);
}

static void numbers_that_fall_back_are_followed_without_an_epoch(void **state)
{
    static const int32_t to[] = {-1000, 480, 1, 2000, INT32_MIN};

    (void)state;
    for (unsigned i = 0; i < 5; i++) {
        begin(500, 5);
        assert_false(push(to[i], 5 * SECOND_US, 5 * SECOND_US));
        assert_false(push(to[i] + 1, 6 * SECOND_US, 6 * SECOND_US));
        assert_true(push(to[i] + 2, 7 * SECOND_US, 7 * SECOND_US));
        COUNTERS_ARE(.scans_accepted = 6, .scans_bad = 2, .sensor_restarts = 1);
    }
}

/* A record of a few scans is played once more: numbers, times and epoch are those that came. */
static void a_record_played_again_is_a_restart(void **state)
{
    (void)state;
    for (int32_t count = 5; count <= 30; count += 5) {
        begin(1, count);
        assert_false(push(1, 0, count * SECOND_US));
        assert_false(push(2, SECOND_US, (count + 1) * SECOND_US));
        COUNTERS_ARE(.scans_accepted = (uint32_t)count, .scans_duplicate = 2);
        for (int32_t i = 3; i <= count; i++) {
            assert_true(push(i, (i - 1) * SECOND_US, (count + i - 1) * SECOND_US));
            assert_int_equal(item.is_restart, i == 3);
        }
        COUNTERS_ARE(.scans_accepted = 2 * (uint32_t)count - 2, .scans_duplicate = 2,
                     .sensor_restarts = 1);
        assert_false(push(1, 0, 100 * SECOND_US)); /* and a third time */
        assert_false(push(2, SECOND_US, 101 * SECOND_US));
        assert_true(push(3, 2 * SECOND_US, 102 * SECOND_US));
        assert_int_equal(item.is_restart, 1);
    }
}

/* Its first scans, refused so far, may be given once more before the first one has gone out. */
static void refused_scans_of_a_restart_may_come_again(void **state)
{
    struct look look = {.sensor_id = 1};

    (void)state;
    if (RHO_MAX_OPEN_SCANS < 3) {
        skip();
    }
    begin(1, 9);
    for (int32_t i = 1; i <= 5; i++) {
        look.scan = i <= 3 ? i : i - 3; /* 1, 2, 3, 1, 2 */
        look.time_us = (look.scan - 1) * SECOND_US;
        take_message(&look, 20 * SECOND_US);
    }
    for (int32_t i = 1; i <= 3; i++) {
        expect_next_scan(21 * SECOND_US, 1, (i - 1) * SECOND_US);
        assert_int_equal(item.is_restart, i == 1);
    }
    COUNTERS_ARE(.scans_accepted = 12, .scans_duplicate = 2, .scans_late = 2, .sensor_restarts = 1);
}

/* A copy of every scan by another way, some scans behind. */
static void copies_behind_are_no_restart(void **state)
{
    (void)state;
    for (int32_t behind = 1; behind <= 30; behind++) {
        begin(1, behind);
        for (int32_t i = behind; i < 100; i++) {
            assert_true(push(i + 1, i * SECOND_US, i * SECOND_US));
            assert_false(push(i + 1 - behind, (i - behind) * SECOND_US, i * SECOND_US));
        }
        COUNTERS_ARE(.scans_accepted = 100, .scans_duplicate = 100 - (uint32_t)behind);
    }
    /* and in bursts: the same four once more, not from the oldest one on */
    begin(1, 10);
    for (int32_t i = 6; i < 10; i++) {
        assert_false(push(i + 1, i * SECOND_US, 10 * SECOND_US));
    }
    COUNTERS_ARE(.scans_accepted = 10, .scans_duplicate = 4);
}

static void follow_scans_say_how_many(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    for (uint16_t follow = 2; follow <= 255; follow = (uint16_t)(follow + 23)) {
        config.follow_scans = follow;
        start_assembler_with(&config);
        epoch = 0;
        assert_true(push(1, 0, 0));
        epoch = 1;
        for (int32_t i = 1; i <= follow; i++) {
            assert_int_equal(push(i, i * SECOND_US, i * SECOND_US), i == follow);
        }
        COUNTERS_ARE(.scans_accepted = 2, .scans_bad = follow - 1u, .sensor_restarts = 1);
    }
}

static void doubles_are_no_agreement(void **state)
{
    (void)state;
    begin(500, 5);
    epoch = 9;
    for (int i = 0; i < 10; i++) {
        assert_false(push(1, 5 * SECOND_US, 5 * SECOND_US));
        assert_false(push(1, 5 * SECOND_US + 1, 5 * SECOND_US));
    }
    COUNTERS_ARE(.scans_accepted = 5, .scans_bad = 20);
    assert_false(push(3, 6 * SECOND_US, 6 * SECOND_US));
    assert_true(push(3, 6 * SECOND_US, 6 * SECOND_US) == 0);
    assert_true(push(4, 7 * SECOND_US, 7 * SECOND_US));
}

/* Whoever sends something else between a restarted sensor's scans does not keep it out. */
static void strays_in_between_do_no_harm(void **state)
{
    (void)state;
    begin(500, 5);
    for (int32_t i = 1; i <= 3; i++) {
        epoch = 9;
        assert_int_equal(push(i, (4 + i) * SECOND_US, (4 + i) * SECOND_US), i == 3);
        for (int32_t k = 0; i < 3 && k < RHO_SCAN_ASSEMBLER_STRAYS - 1; k++) {
            epoch = 100 * i + k;
            assert_false(push(-50 * k, (4 + i) * SECOND_US, (4 + i) * SECOND_US));
        }
    }
    assert_int_equal(assembler.counters.sensor_restarts, 1);
}

static void a_believed_scan_ends_the_strays(void **state)
{
    (void)state;
    begin(500, 5);
    for (int32_t i = 0; i < 20; i++) {
        epoch = 9;
        assert_false(push(i, (5 + i) * SECOND_US, (5 + i) * SECOND_US));
        epoch = 0;
        assert_true(push(505 + i, (5 + i) * SECOND_US, (5 + i) * SECOND_US));
    }
    COUNTERS_ARE(.scans_accepted = 25, .scans_bad = 20);
}

/*
 * ---- times ------------------------------------------------------------------------------------
 */

static void a_next_scan_is_later(void **state)
{
    (void)state;
    begin(1, 3);
    assert_false(push(4, 2 * SECOND_US, 3 * SECOND_US));
    assert_false(push(4, 2 * SECOND_US - 1, 3 * SECOND_US));
    assert_false(push(4, INT64_C(-4000000000000000000), 3 * SECOND_US));
    assert_false(push(4, INT64_C(4000000000000000000), 3 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 3, .clock_jumps = 4);
    assert_true(push(4, 2 * SECOND_US + 1, 3 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 4, .clock_jumps = 4);
}

static void a_pause_is_no_jump_where_nothing_was_heard(void **state)
{
    (void)state;
    begin(1, 3);
    assert_true(push(4, 2 * SECOND_US + JUMP_US, 2 * SECOND_US + JUMP_US));
    COUNTERS_ARE(.scans_accepted = 4);
    assert_false(push(5, 2 * SECOND_US + 2 * JUMP_US + 1, 2 * SECOND_US + 2 * JUMP_US + 1));
    COUNTERS_ARE(.scans_accepted = 4, .clock_jumps = 1);
}

static void a_time_ahead_of_its_number_is_not_believed(void **state)
{
    const int64_t at_us = 4 * SECOND_US, most_us = 1500000 + 10000;

    (void)state;
    for (int64_t more_us = 0; more_us < 3; more_us++) {
        begin(1, 5);
        assert_int_equal(push(6, at_us + most_us + more_us, at_us + SECOND_US), more_us < 1);
        COUNTERS_ARE(.scans_accepted = more_us < 1 ? 6 : 5, .clock_jumps = more_us < 1 ? 0 : 1);
    }
    begin(1, 5);
    assert_false(push(6, at_us + 20 * SECOND_US, at_us + SECOND_US));
    assert_true(push(6, at_us + SECOND_US, at_us + SECOND_US)); /* the real one */
    COUNTERS_ARE(.scans_accepted = 6, .clock_jumps = 1);
}

static void a_number_ahead_of_its_time_is_not_believed(void **state)
{
    const int64_t at_us = 4 * SECOND_US;

    (void)state;
    for (int bit = 1; bit < 31; bit++) { /* flips of the next number */
        int32_t scan = 6 ^ (INT32_C(1) << bit);
        begin(1, 5);
        if (scan > 6 || scan < -30) {
            assert_false(push(scan, at_us + SECOND_US, at_us + SECOND_US));
            assert_int_equal(assembler.counters.scans_bad, 1);
        }
        assert_true(push(6, at_us + SECOND_US, at_us + SECOND_US));
        assert_int_equal(assembler.counters.scans_lost, 0);
    }
    begin(1, 5); /* two numbers in the time of one and a half, less what clocks jitter */
    assert_false(push(7, at_us + 1490000 - 1, at_us + SECOND_US));
    assert_true(push(7, at_us + 1490000, at_us + SECOND_US));
    COUNTERS_ARE(.scans_accepted = 6, .scans_bad = 1, .scans_lost = 1);
}

static void another_pace_is_followed(void **state)
{
    (void)state;
    begin(1, 5); /* now 20 a second, with every second one lost */
    for (int32_t i = 1; i <= 20; i++) {
        int64_t time_us = 4 * SECOND_US + i * 100000;
        (void)push(5 + 2 * i, time_us, time_us);
    }
    COUNTERS_ARE(.scans_accepted = 20 - 2 + 5, .scans_bad = 2, .sensor_restarts = 1,
                 .scans_lost = 17);
    assert_in_range(assembler.sources[0].interval_us, 49000, 51000);
}

static void intervals_may_change_while_nothing_is_lost(void **state)
{
    int64_t time_us = 0;

    (void)state;
    start_assembler();
    epoch = 0;
    for (int32_t i = 0; i < 1000; i++) {
        random_state += (uint64_t)i;
        time_us += 1 + random_below(i % 50 == 0 ? 29000000 : 1000000);
        assert_true(push(i, time_us, time_us + random_below(5000)));
    }
    COUNTERS_ARE(.scans_accepted = 1000);
}

static void losses_at_a_steady_pace_cost_nothing_more(void **state)
{
    uint32_t sent = 0;

    (void)state;
    start_assembler();
    random_state = 3;
    for (int32_t i = 0; i < 3000; i++) {
        int64_t time_us = i * 500000 + random_below(100000);
        if (i == 0 || i == 2999 || random_below(10) < 3) {
            assert_true(push(i, time_us, time_us + random_below(5000)));
            sent++;
        }
    }
    COUNTERS_ARE(.scans_accepted = sent, .scans_lost = 3000 - sent);
}

static void a_clock_set_back_is_followed_though_numbers_fell_back_as_well(void **state)
{
    (void)state;
    begin(1, 20);
    assert_false(push(1, -1000 * SECOND_US, 20 * SECOND_US));
    assert_false(push(2, -999 * SECOND_US, 21 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 20, .clock_jumps = 2);
    assert_true(push(3, -998 * SECOND_US, 22 * SECOND_US));
    assert_int_equal(assembler.counters.sensor_restarts, 1);
}

static void times_at_the_ends_of_their_range(void **state)
{
    const int64_t end_us = INT64_C(4000000000000000000);

    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        start_assembler();
        epoch = 0;
        for (int i = 0; i < 8; i++) {
            struct look look = {.time_us = (i / 2 % 2 ? end_us - i : -end_us + i) * sign,
                                .scan = i % 3 ? i : INT32_MIN + i,
                                .sensor_id = (int16_t)(i % 2)};
            static const int64_t now_us[] = {INT64_MIN, INT64_MAX, 0, INT64_MAX - 1};

            (void)take_status(&look, now_us[i % 4]);
            (void)rho_scan_assembler_due_us(&assembler);
            (void)rho_scan_assembler_next(&assembler, now_us[(i + i / 4) % 4], &item);
        }
        (void)drain(INT64_MAX);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scans_count_up),
        cmocka_unit_test(numbers_wrap),
        cmocka_unit_test(what_is_skipped_is_lost),
        cmocka_unit_test(as_many_as_skip_max_and_no_more),
        cmocka_unit_test(old_numbers_are_double_or_late),
        cmocka_unit_test(memory_reaches_31_numbers_back),
        cmocka_unit_test(a_new_epoch_is_followed_at_the_third_scan),
        cmocka_unit_test(numbers_that_fall_back_are_followed_without_an_epoch),
        cmocka_unit_test(a_record_played_again_is_a_restart),
        cmocka_unit_test(refused_scans_of_a_restart_may_come_again),
        cmocka_unit_test(copies_behind_are_no_restart),
        cmocka_unit_test(follow_scans_say_how_many),
        cmocka_unit_test(doubles_are_no_agreement),
        cmocka_unit_test(strays_in_between_do_no_harm),
        cmocka_unit_test(a_believed_scan_ends_the_strays),
        cmocka_unit_test(a_next_scan_is_later),
        cmocka_unit_test(a_pause_is_no_jump_where_nothing_was_heard),
        cmocka_unit_test(a_time_ahead_of_its_number_is_not_believed),
        cmocka_unit_test(a_number_ahead_of_its_time_is_not_believed),
        cmocka_unit_test(another_pace_is_followed),
        cmocka_unit_test(intervals_may_change_while_nothing_is_lost),
        cmocka_unit_test(losses_at_a_steady_pace_cost_nothing_more),
        cmocka_unit_test(a_clock_set_back_is_followed_though_numbers_fell_back_as_well),
        cmocka_unit_test(times_at_the_ends_of_their_range),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
