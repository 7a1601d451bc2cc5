/* SPDX-License-Identifier: MIT */
/*
 * Scans of one sensor that come behind newer ones of it: in their place where they can be, else
 * late, else not at all.
 */
#include "late_scans.h"

static void two_that_are_swapped_go_out_in_order(void **state)
{
    (void)state;
    begin_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    expect_no_scan(7 * SECOND_US); /* 6 may come */
    assert_int_equal(rho_scan_assembler_due_us(&assembler), 7 * SECOND_US + HOLD_US);
    take_late_scan(6, 7 * SECOND_US + HOLD_US - 1);
    expect_next_scan(7 * SECOND_US + HOLD_US - 1, 1, 6 * SECOND_US);
    assert_true(item.scan.plots[0].x_m == 6.0f);
    expect_next_scan(7 * SECOND_US + HOLD_US - 1, 1, 7 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 8 * SECOND_US); /* nothing waits any more */
    COUNTERS_ARE(.scans_accepted = 8, .scans_late = 1, .scans_lost = 1);
}

static void a_number_that_is_lost_is_waited_for_once(void **state)
{
    (void)state;
    begin_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    expect_no_scan(7 * SECOND_US + HOLD_US - 1);
    expect_next_scan(7 * SECOND_US + HOLD_US, 1, 7 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 8 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_lost = 1);
}

static void nothing_is_waited_for_where_nothing_is_held(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.hold_us = 0;
    begin_with(&config, 5);
    take_late_scan(7, 7 * SECOND_US);
    expect_next_scan(7 * SECOND_US, 1, 7 * SECOND_US);
    take_late_scan(6, 7 * SECOND_US); /* late, but of use */
    expect_next_scan(7 * SECOND_US, 1, 6 * SECOND_US);
}

static void one_that_is_later_goes_out_late(void **state)
{
    (void)state;
    begin_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 7 * SECOND_US);
    take_late_scan(6, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1,
                     6 * SECOND_US); /* at once: what it would wait for has gone out */
    take_scan(1, 8, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 8 * SECOND_US);
    assert_int_equal(assembler.sources[0].interval_us, SECOND_US);
    assert_int_equal(assembler.sources[0].place.scan, 8);
    COUNTERS_ARE(.scans_accepted = 8, .scans_late = 1, .scans_lost = 1);
}

static void late_max_says_how_late(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    for (int32_t behind = 1; behind <= 6; behind++) {
        config.late_max_us = 3 * SECOND_US;
        begin_with(&config, 5);
        take_late_scan(6 + behind, (6 + behind) * SECOND_US); /* 6 and what follows is skipped */
        expect_next_scan(30 * SECOND_US, 1, (6 + behind) * SECOND_US);
        take_late_scan(6, 30 * SECOND_US);
        assert_int_equal(drain(30 * SECOND_US), behind <= 3);
        COUNTERS_ARE(.scans_accepted = 6 + (behind <= 3), .scans_late = 1,
                     .scans_lost = (uint32_t)behind);
    }
    config.late_max_us = 0;
    begin_with(&config, 5);
    take_late_scan(7, 7 * SECOND_US);
    take_late_scan(6, 7 * SECOND_US); /* held, so that it is in time all the same */
    assert_int_equal(drain(7 * SECOND_US), 2);
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 1, .scans_lost = 1);
}

static void a_time_that_is_not_its_numbers_is_not_taken(void **state)
{
    static const struct {
        int64_t time_us;
        int is_taken;
    } cases[] = {
        /* one number behind 7: a second, less a quarter, more by a half, jitter of 10 ms */
        {7 * SECOND_US - 740000, 1},  {7 * SECOND_US - 739999, 0}, {7 * SECOND_US - 1510000, 1},
        {7 * SECOND_US - 1510001, 0}, {7 * SECOND_US, 0},          {-20 * SECOND_US, 0},
    };

    (void)state;
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct look look = {.time_us = cases[i].time_us, .scan = 6, .sensor_id = 1, .count = 1};

        begin_with_scans(5);
        take_late_scan(7, 7 * SECOND_US);
        take_message(&look, 7 * SECOND_US);
        assert_int_equal(assembler.counters.scans_accepted, 6 + cases[i].is_taken);
        assert_int_equal(assembler.counters.scans_late, 1);
        /* the real one may still come */
        take_late_scan(6, 7 * SECOND_US);
        assert_int_equal(assembler.counters.scans_accepted, 7);
        assert_int_equal(assembler.counters.scans_duplicate, cases[i].is_taken);
    }
}

static void what_was_there_before_the_first_one_is_not_taken(void **state)
{
    (void)state;
    begin_with_scans(0);
    take_late_scan(5, 5 * SECOND_US);
    take_late_scan(4, 5 * SECOND_US);
    take_late_scan(6, 6 * SECOND_US);
    take_late_scan(3, 6 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 2, .scans_late = 2);
}

static void several_are_put_in_order(void **state)
{
    static const int32_t order[] = {9, 7, 8, 6};
    const unsigned room = RHO_MAX_OPEN_SCANS < 4 ? RHO_MAX_OPEN_SCANS : 4;

    (void)state;
    begin_with_scans(5);
    for (unsigned i = 0; i < room; i++) {
        take_late_scan(order[i], 9 * SECOND_US);
    }
    if (room == 4) {
        for (int32_t scan = 6; scan <= 9; scan++) {
            expect_next_scan(9 * SECOND_US, 1, scan * SECOND_US);
        }
    } else { /* 9 and 7: 8 is waited for, and nothing before a late one */
        expect_next_scan(9 * SECOND_US, 1, 7 * SECOND_US);
        expect_no_scan(9 * SECOND_US);
        expect_next_scan(9 * SECOND_US + HOLD_US, 1, 9 * SECOND_US);
    }
    expect_no_scan(9 * SECOND_US);
}

static void parts_of_both_may_come_mixed(void **state)
{
    static const struct {
        int32_t scan;
        int16_t part;
    } order[] = {{7, 1}, {6, 1}, {7, 0}, {6, 0}};

    (void)state;
    begin_with_scans(5);
    for (unsigned i = 0; i < 4; i++) {
        struct look look = part_of(order[i].scan, order[i].part);

        take_message(&look, 7 * SECOND_US);
    }
    for (int32_t scan = 6; scan <= 7; scan++) {
        expect_next_scan(7 * SECOND_US, 1, scan * SECOND_US);
        assert_int_equal(item.scan.num_plots, 2);
        assert_int_equal(item.parts_missing, 0);
        assert_true(item.scan.plots[0].x_m == (float)(10 * scan));
        assert_true(item.scan.plots[1].x_m == (float)(10 * scan + 1));
    }
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 1, .scans_lost = 1);
}

static void a_late_one_without_its_last_part_goes_out_after_a_while(void **state)
{
    struct rho_scan_assembler_config config = usual_config();
    struct look look = part_of(6, 0);

    (void)state;
    begin_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    take_message(&look, 7 * SECOND_US + 10000);
    expect_no_scan(7 * SECOND_US + HOLD_US - 1);
    expect_next_scan(7 * SECOND_US + HOLD_US, 1, 6 * SECOND_US); /* 7 has waited */
    assert_int_equal(item.parts_missing, 1);
    expect_next_scan(7 * SECOND_US + HOLD_US, 1, 7 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 1, .scans_lost = 1, .scans_incomplete = 1);
    /* where parts wait for a newer scan alone, that one ends it */
    config.hold_us = 0;
    begin_with(&config, 5);
    take_late_scan(7, 7 * SECOND_US);
    expect_next_scan(7 * SECOND_US, 1, 7 * SECOND_US);
    take_message(&look, 7 * SECOND_US);
    expect_no_scan(20 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 6 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 8 * SECOND_US);
    expect_no_scan(8 * SECOND_US);
}

/* Frames of bearings are over once a later one has begun. */
static void bearings_are_not_late(void **state)
{
    struct look look = {.sensor_id = 1, .kind = RHO_SCAN_ASSEMBLER_BEARINGS, .count = 1};
    static const int32_t order[] = {1, 2, 4, 3};

    (void)state;
    for (int is_held = 0; is_held < 2; is_held++) {
        start_assembler();
        for (unsigned i = 0; i < 4; i++) {
            look.scan = order[i];
            look.time_us = order[i] * SECOND_US;
            take_message(&look, 5 * SECOND_US);
            (void)drain(i == 2 && is_held ? 5 * SECOND_US : 6 * SECOND_US);
        }
        COUNTERS_ARE(.scans_accepted = 3 + (uint32_t)is_held, .scans_late = 1, .scans_lost = 1,
                     .bearings_in = 3 + (uint32_t)is_held);
    }
}

/*
 * ---- what is waited for -----------------------------------------------------------------------
 */

/*
 * Sensors 1 and 2, scans 1 .. 5, one a second; then 9 of sensor 1, or its first part, so that 8 is
 * waited for.
 */
static void begin_two(int16_t num_parts)
{
    struct look look = part_of(9, 0);

    start_assembler();
    for (int32_t i = 1; i <= 5; i++) {
        take_scan(1, i, i * SECOND_US);
        take_scan(2, i, i * SECOND_US);
        assert_int_equal(drain(INT64_MAX), 2);
    }
    look.num_parts = num_parts;
    take_message(&look, 9 * SECOND_US);
    expect_no_scan(9 * SECOND_US);
}

static void others_wait_for_what_may_be_older_and_no_more(void **state)
{
    static const struct {
        int64_t time_us;
        int waits;
    } cases[] = {{7 * SECOND_US, 0},
                 {8 * SECOND_US, 0}, /* as old as 8 will be */
                 {8 * SECOND_US + 1, 1},
                 {9 * SECOND_US - 1, 1}};

    (void)state;
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int16_t num_parts = 1; num_parts <= 2; num_parts++) {
            struct look other = {.time_us = cases[i].time_us, .scan = 6, .sensor_id = 2};

            begin_two(num_parts);
            take_message(&other, 9 * SECOND_US);
            assert_int_equal(rho_scan_assembler_next(&assembler, 9 * SECOND_US, &item),
                             !cases[i].waits);
            if (cases[i].waits && RHO_MAX_OPEN_SCANS > 2) {
                take_late_scan(8, 9 * SECOND_US);
                expect_next_scan(9 * SECOND_US, 1, 8 * SECOND_US);
                expect_next_scan(9 * SECOND_US, 2, cases[i].time_us);
            }
        }
    }
}

/* A late one does not make others wait for the number before it. */
static void nothing_waits_for_what_is_before_a_late_one(void **state)
{
    struct look other = {.time_us = 8 * SECOND_US - 1, .scan = 6, .sensor_id = 2};

    (void)state;
    begin_two(1);
    take_late_scan(8, 9 * SECOND_US); /* 7 may come */
    expect_no_scan(9 * SECOND_US);    /* sensor 2 may have one that is older */
    if (RHO_MAX_OPEN_SCANS > 2) {
        take_message(&other, 9 * SECOND_US);
        expect_next_scan(9 * SECOND_US, 2, other.time_us);
    }
}

static void numbers_far_behind_are_not_waited_for(void **state)
{
    const int64_t step_us = 100000;

    (void)state;
    for (int32_t ahead = 30; ahead <= 60; ahead++) {
        struct look look = {.sensor_id = 1, .count = 1};

        start_assembler();
        for (look.scan = 1; look.scan <= 5; look.scan++) {
            look.time_us = look.scan * step_us;
            take_message(&look, look.time_us);
            assert_int_equal(drain(look.time_us), 1);
        }
        look.scan = 7;
        look.time_us = 7 * step_us;
        take_message(&look, look.time_us);
        expect_no_scan(7 * step_us); /* 6 may come */
        look.scan = 7 + ahead;
        look.time_us = look.scan * step_us;
        take_message(&look, 7 * step_us);
        if (ahead > 30) { /* 6 is more than 31 behind */
            expect_next_scan(7 * step_us, 1, 7 * step_us);
        }
        expect_no_scan(7 * step_us);
    }
}

/*
 * The place of a sensor that gave way is another's, whose skipped numbers are not those of the
 * first.
 */
static void a_sensor_that_gives_way_is_not_waited_for(void **state)
{
    static const struct {
        int16_t sensor_id;
        int32_t scan;
        int64_t time_us;
    } rows[] = {{500, 1, 5000000}, {500, 2, 5100000}, {500, 4, 5300000},
                {600, 2, 5500000}, {600, 4, 5700000}, {0, 6, 5250000}};
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    if (RHO_MAX_OPEN_SCANS < 4) {
        skip();
    }
    config.hold_us = 10 * SECOND_US;
    config.follow_scans = 5;
    start_assembler_with(&config);
    for (int32_t scan = 1; scan <= 5; scan++) {
        for (int16_t id = 0; id < RHO_MAX_SENSORS - 1; id++) {
            take_scan(id, scan, (scan + (id > 0)) * SECOND_US);
            assert_int_equal(drain(INT64_MAX), 1);
        }
    }
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct look look = {
            .sensor_id = rows[i].sensor_id, .scan = rows[i].scan, .time_us = rows[i].time_us};

        take_message(&look, 6 * SECOND_US);
        if (i < 2) {
            assert_int_equal(drain(INT64_MAX), 1);
        }
    }
    expect_next_scan(6 * SECOND_US, 0, 5250000);
}

/*
 * Nor is a number of the old ones waited for, where a sensor began anew and skips one of the same
 * value.
 */
static void what_was_sent_before_a_restart_is_not_waited_for(void **state)
{
    static const int32_t scans[] = {3, 4, 5, 8};

    (void)state;
    if (RHO_MAX_OPEN_SCANS < 3) {
        skip();
    }
    begin_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    for (unsigned i = 0; i < 4; i++) {
        struct look look = {
            .time_us = (5 + scans[i]) * SECOND_US, .scan = scans[i], .epoch = 1, .sensor_id = 1};

        take_message(&look, 7 * SECOND_US);
    }
    expect_next_scan(7 * SECOND_US, 1, 7 * SECOND_US);
    expect_next_scan(7 * SECOND_US, 1, 10 * SECOND_US);
    expect_no_scan(7 * SECOND_US); /* 7 of the new ones may come */
    COUNTERS_ARE(.scans_accepted = 8, .scans_lost = 3, .scans_bad = 2, .sensor_restarts = 1);
}

/*
 * ---- each counts once -------------------------------------------------------------------------
 */

static void one_that_waits_until_it_is_too_late_is_dropped(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.hold_us = 0;
    config.late_max_us = 3 * SECOND_US;
    for (int64_t after_us = 0; after_us < 2; after_us++) {
        struct look look = part_of(6, 0);

        begin_with(&config, 5);
        take_late_scan(7, 7 * SECOND_US);
        expect_next_scan(7 * SECOND_US, 1, 7 * SECOND_US);
        expect_no_scan(7 * SECOND_US);
        take_message(&look, 7 * SECOND_US);
        take_scan(2, 1, 9 * SECOND_US + after_us);
        expect_next_scan(9 * SECOND_US, 2, 9 * SECOND_US + after_us);
        expect_no_scan(9 * SECOND_US);
        look.part = 1;
        take_message(&look, 9 * SECOND_US);
        assert_int_equal(drain(9 * SECOND_US), 1 - after_us);
        COUNTERS_ARE(.scans_accepted = 8, .scans_late = 1, .scans_lost = 1,
                     .scans_duplicate = (uint32_t)after_us);
    }
}

static void one_that_another_clock_drops_counts_once(void **state)
{
    struct look look = part_of(6, 0);

    (void)state;
    begin_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    take_message(&look, 7 * SECOND_US);
    for (int32_t scan = 8; scan <= 10; scan++) {
        struct look other = {.time_us = (3600 + scan) * SECOND_US, .scan = scan, .sensor_id = 1};

        take_message(&other, 7 * SECOND_US);
    }
    expect_next_scan(7 * SECOND_US, 1, 3610 * SECOND_US);
    assert_int_equal(item.is_restart, 1);
    expect_no_scan(INT64_MAX);
    assert_int_equal(assembler.counters.scans_late, 2); /* 6 and 7 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_that_are_swapped_go_out_in_order),
        cmocka_unit_test(a_number_that_is_lost_is_waited_for_once),
        cmocka_unit_test(nothing_is_waited_for_where_nothing_is_held),
        cmocka_unit_test(one_that_is_later_goes_out_late),
        cmocka_unit_test(late_max_says_how_late),
        cmocka_unit_test(a_time_that_is_not_its_numbers_is_not_taken),
        cmocka_unit_test(what_was_there_before_the_first_one_is_not_taken),
        cmocka_unit_test(several_are_put_in_order),
        cmocka_unit_test(parts_of_both_may_come_mixed),
        cmocka_unit_test(a_late_one_without_its_last_part_goes_out_after_a_while),
        cmocka_unit_test(bearings_are_not_late),
        cmocka_unit_test(others_wait_for_what_may_be_older_and_no_more),
        cmocka_unit_test(nothing_waits_for_what_is_before_a_late_one),
        cmocka_unit_test(numbers_far_behind_are_not_waited_for),
        cmocka_unit_test(a_sensor_that_gives_way_is_not_waited_for),
        cmocka_unit_test(what_was_sent_before_a_restart_is_not_waited_for),
        cmocka_unit_test(one_that_waits_until_it_is_too_late_is_dropped),
        cmocka_unit_test(one_that_another_clock_drops_counts_once),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
