/* SPDX-License-Identifier: MIT */
/* Which scans of one sensor are accepted: numbers, epochs and times. */
#include "scan_assembler_setup.h"

static int32_t epoch;

/* Takes one scan of sensor 1, which is given after hold. Returns whether it was accepted. */
static int push_scan(int32_t scan, int64_t time_us, int64_t now_us)
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

/* Takes `count` scans, one a second, numbered from `scan` on. */
static void start_with_scans(int32_t scan, int32_t count)
{
    start_assembler();
    epoch = 0;
    for (int32_t i = 0; i < count; i++) {
        assert_true(push_scan(scan + i, i * SECOND_US, i * SECOND_US));
    }
}

static void consecutive_scan_numbers_are_accepted(void **state)
{
    (void)state;
    start_with_scans(1, 100);
    COUNTERS_ARE(.scans_accepted = 100);
    assert_int_equal(assembler.sources[0].interval_us, SECOND_US);
}

static void scans_may_be_an_hour_apart(void **state)
{
    const int64_t hour_us = 3600 * SECOND_US;
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.jump_max_us = hour_us;
    start_assembler_with(&config);
    epoch = 0;
    for (int32_t i = 0; i < 3; i++) {
        assert_true(push_scan(1 + i, i * hour_us, i * hour_us));
    }
    assert_int_equal(assembler.sources[0].interval_us, hour_us);
}

static void scan_numbers_wrap_at_32_bits(void **state)
{
    (void)state;
    start_with_scans(INT32_MAX - 2, 3);
    assert_true(push_scan(INT32_MIN, 3 * SECOND_US, 3 * SECOND_US));
    assert_true(push_scan(INT32_MIN + 2, 5 * SECOND_US, 5 * SECOND_US));
    assert_false(push_scan(INT32_MAX, 2 * SECOND_US, 5 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 5, .scans_lost = 1, .scans_duplicate = 1);
}

static void skipped_scan_numbers_are_counted_as_lost(void **state)
{
    (void)state;
    start_with_scans(1, 3);
    for (int32_t skip = 1; skip <= RHO_SCAN_ASSEMBLER_SKIP_MAX && skip <= 30; skip++) {
        start_with_scans(1, 3);
        assert_true(push_scan(3 + skip, (2 + skip) * SECOND_US, (2 + skip) * SECOND_US));
        COUNTERS_ARE(.scans_accepted = 4, .scans_lost = (uint32_t)skip - 1);
    }
}

static void at_most_skip_max_numbers_may_be_skipped(void **state)
{
    for (int32_t more = 0; more < 2; more++) {
        (void)state;
        start_assembler();
        for (int32_t i = 1; i <= 3; i++) {
            assert_true(push_scan(i, i * 100000, i * 100000));
        }
        int32_t scan = 3 + RHO_SCAN_ASSEMBLER_SKIP_MAX + more;
        assert_int_equal(push_scan(scan, scan * 100000, scan * 100000), more == 0);
        COUNTERS_ARE(.scans_accepted = 4 - (uint32_t)more, .scans_bad = (uint32_t)more,
                     .scans_lost = more ? 0 : RHO_SCAN_ASSEMBLER_SKIP_MAX - 1);
    }
}

static void old_scan_numbers_are_double_or_late(void **state)
{
    (void)state;
    start_with_scans(1, 3);
    assert_true(push_scan(6, 5 * SECOND_US, 5 * SECOND_US)); /* numbers 4 and 5 are lost */
    assert_false(push_scan(6, 5 * SECOND_US, 5 * SECOND_US));
    assert_false(push_scan(3, 2 * SECOND_US, 5 * SECOND_US));
    assert_false(push_scan(1, 0, 5 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 4, .scans_lost = 2, .scans_duplicate = 3);
    assert_true(push_scan(4, 3 * SECOND_US, 5 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 5, .scans_lost = 2, .scans_duplicate = 3, .scans_late = 1);
    assert_false(push_scan(4, 3 * SECOND_US, 5 * SECOND_US)); /* number 4 was received already */
    assert_false(push_scan(0, -SECOND_US, 5 * SECOND_US));    /* number 0 was never skipped */
    COUNTERS_ARE(.scans_accepted = 5, .scans_lost = 2, .scans_duplicate = 4, .scans_late = 2);
}

static void received_numbers_are_remembered_31_back(void **state)
{
    (void)state;
    start_assembler();
    for (int32_t i = 0; i < 40; i++) {
        assert_true(push_scan(i, i * 100000, i * 100000));
    }
    assert_false(push_scan(8, 800000, 3900000)); /* 31 numbers back */
    COUNTERS_ARE(.scans_accepted = 40, .scans_duplicate = 1);
    assert_false(push_scan(7, 700000, 3900000));
    COUNTERS_ARE(.scans_accepted = 40, .scans_duplicate = 1, .scans_bad = 1);
    assert_true(push_scan(39 + 31, 7000000, 7000000)); /* number 39 is the oldest one remembered */
    assert_false(push_scan(39, 3900000, 7000000));
    assert_true(push_scan(40, 4000000, 7000000));
    COUNTERS_ARE(.scans_accepted = 42, .scans_duplicate = 2, .scans_bad = 1, .scans_lost = 30,
                 .scans_late = 1);
    assert_true(push_scan(70 + 32, 10200000, 10200000));
    assert_true(push_scan(71, 7100000, 10200000));
    COUNTERS_ARE(.scans_accepted = 44, .scans_duplicate = 2, .scans_bad = 1, .scans_lost = 61,
                 .scans_late = 2);
}

static void a_new_epoch_is_accepted_at_its_third_scan(void **state)
{
    (void)state;
    start_with_scans(500, 5);
    epoch = 9;
    assert_false(push_scan(1, 5 * SECOND_US, 5 * SECOND_US));
    assert_false(push_scan(2, 6 * SECOND_US, 6 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 5, .scans_bad = 2);
    assert_true(push_scan(3, 7 * SECOND_US, 7 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 6, .scans_bad = 2, .sensor_restarts = 1);
    assert_true(push_scan(4, 8 * SECOND_US, 8 * SECOND_US));
    assert_int_equal(item.is_restart, 0);
    assert_int_equal(assembler.sources[0].interval_us, SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_bad = 2, .sensor_restarts = 1);
}

static void three_scans_of_other_numbers_prove_a_restart(void **state)
{
    static const int32_t to[] = {-1000, 480, 1, 2000, INT32_MIN};

    (void)state;
    for (unsigned i = 0; i < 5; i++) {
        start_with_scans(500, 5);
        assert_false(push_scan(to[i], 5 * SECOND_US, 5 * SECOND_US));
        assert_false(push_scan(to[i] + 1, 6 * SECOND_US, 6 * SECOND_US));
        assert_true(push_scan(to[i] + 2, 7 * SECOND_US, 7 * SECOND_US));
        COUNTERS_ARE(.scans_accepted = 6, .scans_bad = 2, .sensor_restarts = 1);
    }
}

/* A record of a few scans is played again: the same numbers, times and epoch. */
static void a_record_played_again_is_accepted_as_a_restart(void **state)
{
    (void)state;
    for (int32_t count = 5; count <= 30; count += 5) {
        start_with_scans(1, count);
        assert_false(push_scan(1, 0, count * SECOND_US));
        assert_false(push_scan(2, SECOND_US, (count + 1) * SECOND_US));
        COUNTERS_ARE(.scans_accepted = (uint32_t)count, .scans_duplicate = 2);
        for (int32_t i = 3; i <= count; i++) {
            assert_true(push_scan(i, (i - 1) * SECOND_US, (count + i - 1) * SECOND_US));
            assert_int_equal(item.is_restart, i == 3);
        }
        COUNTERS_ARE(.scans_accepted = 2 * (uint32_t)count - 2, .scans_duplicate = 2,
                     .sensor_restarts = 1);
        assert_false(push_scan(1, 0, 100 * SECOND_US)); /* played a third time */
        assert_false(push_scan(2, SECOND_US, 101 * SECOND_US));
        assert_true(push_scan(3, 2 * SECOND_US, 102 * SECOND_US));
        assert_int_equal(item.is_restart, 1);
    }
}

/*
 * The first scans of a restart, refused so far, may be sent again before the first one was given.
 */
static void scans_refused_at_a_restart_may_be_sent_again(void **state)
{
    struct look look = {.sensor_id = 1};

    (void)state;
    if (RHO_MAX_OPEN_SCANS < 3) {
        skip();
    }
    start_with_scans(1, 9);
    for (int32_t i = 1; i <= 5; i++) {
        look.scan = i <= 3 ? i : i - 3; /* numbers 1, 2, 3, 1, 2 */
        look.time_us = (look.scan - 1) * SECOND_US;
        take_message(&look, 20 * SECOND_US);
    }
    for (int32_t i = 1; i <= 3; i++) {
        expect_next_scan(21 * SECOND_US, 1, (i - 1) * SECOND_US);
        assert_int_equal(item.is_restart, i == 1);
    }
    COUNTERS_ARE(.scans_accepted = 12, .scans_duplicate = 2, .scans_late = 2, .sensor_restarts = 1);
}

/* Copies of all scans arrive by another path, some scans later. */
static void delayed_copies_of_scans_are_no_restart(void **state)
{
    (void)state;
    for (int32_t behind = 1; behind <= 30; behind++) {
        start_with_scans(1, behind);
        for (int32_t i = behind; i < 100; i++) {
            assert_true(push_scan(i + 1, i * SECOND_US, i * SECOND_US));
            assert_false(push_scan(i + 1 - behind, (i - behind) * SECOND_US, i * SECOND_US));
        }
        COUNTERS_ARE(.scans_accepted = 100, .scans_duplicate = 100 - (uint32_t)behind);
    }
    /* copies in bursts: four scans again, not from the oldest one on */
    start_with_scans(1, 10);
    for (int32_t i = 6; i < 10; i++) {
        assert_false(push_scan(i + 1, i * SECOND_US, 10 * SECOND_US));
    }
    COUNTERS_ARE(.scans_accepted = 10, .scans_duplicate = 4);
}

static void follow_scans_sets_how_many_scans_prove_a_restart(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    for (uint16_t follow = 2; follow <= 255; follow = (uint16_t)(follow + 23)) {
        config.follow_scans = follow;
        start_assembler_with(&config);
        epoch = 0;
        assert_true(push_scan(1, 0, 0));
        epoch = 1;
        for (int32_t i = 1; i <= follow; i++) {
            assert_int_equal(push_scan(i, i * SECOND_US, i * SECOND_US), i == follow);
        }
        COUNTERS_ARE(.scans_accepted = 2, .scans_bad = follow - 1u, .sensor_restarts = 1);
    }
}

static void repeated_scans_do_not_prove_a_restart(void **state)
{
    (void)state;
    start_with_scans(500, 5);
    epoch = 9;
    for (int i = 0; i < 10; i++) {
        assert_false(push_scan(1, 5 * SECOND_US, 5 * SECOND_US));
        assert_false(push_scan(1, 5 * SECOND_US + 1, 5 * SECOND_US));
    }
    COUNTERS_ARE(.scans_accepted = 5, .scans_bad = 20);
    assert_false(push_scan(3, 6 * SECOND_US, 6 * SECOND_US));
    assert_true(push_scan(3, 6 * SECOND_US, 6 * SECOND_US) == 0);
    assert_true(push_scan(4, 7 * SECOND_US, 7 * SECOND_US));
}

/* A second sender's scans between those of a restarted sensor do not keep it out. */
static void stray_scans_do_not_prevent_a_restart(void **state)
{
    (void)state;
    start_with_scans(500, 5);
    for (int32_t i = 1; i <= 3; i++) {
        epoch = 9;
        assert_int_equal(push_scan(i, (4 + i) * SECOND_US, (4 + i) * SECOND_US), i == 3);
        for (int32_t k = 0; i < 3 && k < RHO_SCAN_ASSEMBLER_STRAYS - 1; k++) {
            epoch = 100 * i + k;
            assert_false(push_scan(-50 * k, (4 + i) * SECOND_US, (4 + i) * SECOND_US));
        }
    }
    assert_int_equal(assembler.counters.sensor_restarts, 1);
}

static void an_accepted_scan_forgets_the_strays(void **state)
{
    (void)state;
    start_with_scans(500, 5);
    for (int32_t i = 0; i < 20; i++) {
        epoch = 9;
        assert_false(push_scan(i, (5 + i) * SECOND_US, (5 + i) * SECOND_US));
        epoch = 0;
        assert_true(push_scan(505 + i, (5 + i) * SECOND_US, (5 + i) * SECOND_US));
    }
    COUNTERS_ARE(.scans_accepted = 25, .scans_bad = 20);
}

/*
 * ---- times ------------------------------------------------------------------------------------
 */

/* Largest difference of a scan's time from its number or its reception. */
#define OWN_US (HOLD_US + JUMP_US / 64)

static void a_next_scan_not_later_in_time_is_refused(void **state)
{
    (void)state;
    start_with_scans(1, 3);
    assert_false(push_scan(4, 2 * SECOND_US, 3 * SECOND_US));
    assert_false(push_scan(4, 2 * SECOND_US - 1, 3 * SECOND_US));
    assert_false(push_scan(4, INT64_C(-4000000000000000000), 3 * SECOND_US));
    assert_false(push_scan(4, INT64_C(4000000000000000000), 3 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 3, .clock_jumps = 4);
    assert_false(push_scan(4, 3 * SECOND_US - OWN_US - 1, 3 * SECOND_US));
    assert_true(push_scan(4, 3 * SECOND_US - OWN_US, 3 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 4, .clock_jumps = 5);
}

static void a_long_time_step_after_a_silence_is_accepted(void **state)
{
    (void)state;
    start_with_scans(1, 3);
    assert_true(push_scan(4, 2 * SECOND_US + JUMP_US, 2 * SECOND_US + JUMP_US));
    COUNTERS_ARE(.scans_accepted = 4);
    assert_false(push_scan(5, 2 * SECOND_US + 2 * JUMP_US + 1, 2 * SECOND_US + 2 * JUMP_US + 1));
    COUNTERS_ARE(.scans_accepted = 4, .clock_jumps = 1);
}

static void a_time_too_late_for_its_number_is_refused(void **state)
{
    const int64_t at_us = 4 * SECOND_US, most_us = SECOND_US + OWN_US;

    (void)state;
    for (int64_t more_us = 0; more_us < 3; more_us++) {
        start_with_scans(1, 5);
        assert_int_equal(push_scan(6, at_us + most_us + more_us, at_us + SECOND_US), more_us < 1);
        COUNTERS_ARE(.scans_accepted = more_us < 1 ? 6 : 5, .clock_jumps = more_us < 1 ? 0 : 1);
    }
    start_with_scans(1, 5);
    assert_false(push_scan(6, at_us + 20 * SECOND_US, at_us + SECOND_US));
    assert_true(push_scan(6, at_us + SECOND_US, at_us + SECOND_US)); /* the true scan */
    COUNTERS_ARE(.scans_accepted = 6, .clock_jumps = 1);
}

static void a_number_too_high_for_its_time_is_refused(void **state)
{
    const int64_t at_us = 4 * SECOND_US;

    (void)state;
    for (int bit = 1; bit < 31; bit++) { /* flipped bits of the next number */
        int32_t scan = 6 ^ (INT32_C(1) << bit);
        start_with_scans(1, 5);
        if (scan > 6 || scan < -30) {
            assert_false(push_scan(scan, at_us + SECOND_US, at_us + SECOND_US));
            assert_int_equal(assembler.counters.scans_bad, 1);
        }
        assert_true(push_scan(6, at_us + SECOND_US, at_us + SECOND_US));
        assert_int_equal(assembler.counters.scans_lost, 0);
    }
    start_with_scans(1,
                     5); /* two numbers in the time of one and a half, less the jitter of clocks */
    assert_false(push_scan(7, at_us + 1490000 - 1, at_us + 1490000));
    assert_true(push_scan(7, at_us + 1490000, at_us + 1490000));
    COUNTERS_ARE(.scans_accepted = 6, .scans_bad = 1, .scans_lost = 1);
}

static void another_scan_rate_is_accepted_after_two_scans(void **state)
{
    (void)state;
    start_with_scans(1, 5); /* now 20 scans a second, every second one lost */
    for (int32_t i = 1; i <= 20; i++) {
        int64_t time_us = 4 * SECOND_US + i * 100000;
        (void)push_scan(5 + 2 * i, time_us, time_us);
    }
    COUNTERS_ARE(.scans_accepted = 20 - 2 + 5, .scans_bad = 2, .sensor_restarts = 1,
                 .scans_lost = 17);
    assert_in_range(assembler.sources[0].interval_us, 49000, 51000);
}

static void scan_intervals_may_change_if_no_number_is_skipped(void **state)
{
    int64_t time_us = 0;

    (void)state;
    start_assembler();
    epoch = 0;
    for (int32_t i = 0; i < 1000; i++) {
        random_state += (uint64_t)i;
        time_us += 1 + random_below(i % 50 == 0 ? 29000000 : 1000000);
        assert_true(push_scan(i, time_us, time_us + random_below(5000)));
    }
    COUNTERS_ARE(.scans_accepted = 1000);
}

static void lost_scans_at_a_steady_rate_refuse_no_other(void **state)
{
    uint32_t sent = 0;

    (void)state;
    start_assembler();
    random_state = 3;
    for (int32_t i = 0; i < 3000; i++) {
        int64_t time_us = i * 500000 + random_below(100000);
        if (i == 0 || i == 2999 || random_below(10) < 3) {
            assert_true(push_scan(i, time_us, time_us + random_below(5000)));
            sent++;
        }
    }
    COUNTERS_ARE(.scans_accepted = sent, .scans_lost = 3000 - sent);
}

static void a_restart_with_its_clock_set_back_is_accepted(void **state)
{
    (void)state;
    start_with_scans(1, 20);
    assert_false(push_scan(1, -1000 * SECOND_US, 20 * SECOND_US));
    assert_false(push_scan(2, -999 * SECOND_US, 21 * SECOND_US));
    COUNTERS_ARE(.scans_accepted = 20, .clock_jumps = 2);
    assert_true(push_scan(3, -998 * SECOND_US, 22 * SECOND_US));
    assert_int_equal(assembler.counters.sensor_restarts, 1);
}

static void times_at_the_limits_of_their_range_are_handled(void **state)
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

            (void)take_message_status(&look, now_us[i % 4]);
            (void)rho_scan_assembler_due_us(&assembler);
            (void)rho_scan_assembler_next(&assembler, now_us[(i + i / 4) % 4], &item);
        }
        (void)take_all_items(INT64_MAX);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(consecutive_scan_numbers_are_accepted),
        cmocka_unit_test(scans_may_be_an_hour_apart),
        cmocka_unit_test(scan_numbers_wrap_at_32_bits),
        cmocka_unit_test(skipped_scan_numbers_are_counted_as_lost),
        cmocka_unit_test(at_most_skip_max_numbers_may_be_skipped),
        cmocka_unit_test(old_scan_numbers_are_double_or_late),
        cmocka_unit_test(received_numbers_are_remembered_31_back),
        cmocka_unit_test(a_new_epoch_is_accepted_at_its_third_scan),
        cmocka_unit_test(three_scans_of_other_numbers_prove_a_restart),
        cmocka_unit_test(a_record_played_again_is_accepted_as_a_restart),
        cmocka_unit_test(scans_refused_at_a_restart_may_be_sent_again),
        cmocka_unit_test(delayed_copies_of_scans_are_no_restart),
        cmocka_unit_test(follow_scans_sets_how_many_scans_prove_a_restart),
        cmocka_unit_test(repeated_scans_do_not_prove_a_restart),
        cmocka_unit_test(stray_scans_do_not_prevent_a_restart),
        cmocka_unit_test(an_accepted_scan_forgets_the_strays),
        cmocka_unit_test(a_next_scan_not_later_in_time_is_refused),
        cmocka_unit_test(a_long_time_step_after_a_silence_is_accepted),
        cmocka_unit_test(a_time_too_late_for_its_number_is_refused),
        cmocka_unit_test(a_number_too_high_for_its_time_is_refused),
        cmocka_unit_test(another_scan_rate_is_accepted_after_two_scans),
        cmocka_unit_test(scan_intervals_may_change_if_no_number_is_skipped),
        cmocka_unit_test(lost_scans_at_a_steady_rate_refuse_no_other),
        cmocka_unit_test(a_restart_with_its_clock_set_back_is_accepted),
        cmocka_unit_test(times_at_the_limits_of_their_range_are_handled),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
