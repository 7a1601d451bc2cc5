/* SPDX-License-Identifier: MIT */
/*
 * Scans of one sensor received after newer ones: put in order if possible, else given late, else
 * refused.
 */
#include "late_scans.h"

static void two_swapped_scans_are_given_in_order(void **state)
{
    (void)state;
    start_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    expect_no_scan(7 * SECOND_US); /* scan 6 may still come */
    assert_int_equal(rho_scan_assembler_due_us(&assembler), 7 * SECOND_US + HOLD_US);
    take_late_scan(6, 7 * SECOND_US + HOLD_US - 1);
    expect_next_scan(7 * SECOND_US + HOLD_US - 1, 1, 6 * SECOND_US);
    assert_true(item.scan.plots[0].x_m == 6.0f);
    expect_next_scan(7 * SECOND_US + HOLD_US - 1, 1, 7 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 8 * SECOND_US); /* after it no scan is waited for */
    COUNTERS_ARE(.scans_accepted = 8, .scans_late = 1, .scans_lost = 1);
}

static void a_lost_scan_number_is_waited_for_once(void **state)
{
    (void)state;
    start_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    expect_no_scan(7 * SECOND_US + HOLD_US - 1);
    expect_next_scan(7 * SECOND_US + HOLD_US, 1, 7 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 8 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_lost = 1);
}

static void hold_0_waits_for_no_skipped_scan(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.hold_us = 0;
    start_with_config_and_scans(&config, 5);
    take_late_scan(7, 7 * SECOND_US);
    expect_next_scan(7 * SECOND_US, 1, 7 * SECOND_US);
    take_late_scan(6, 7 * SECOND_US); /* late, but still useful */
    expect_next_scan(7 * SECOND_US, 1, 6 * SECOND_US);
}

static void a_scan_later_than_hold_is_given_after_newer_ones(void **state)
{
    (void)state;
    start_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 7 * SECOND_US);
    take_late_scan(6, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1,
                     6 * SECOND_US); /* given at once, as newer scans were given already */
    take_scan(1, 8, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 8 * SECOND_US);
    assert_int_equal(assembler.sources[0].interval_us, SECOND_US);
    assert_int_equal(assembler.sources[0].place.scan, 8);
    COUNTERS_ARE(.scans_accepted = 8, .scans_late = 1, .scans_lost = 1);
}

static void scans_later_than_late_max_are_refused(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    for (int32_t behind = 1; behind <= 6; behind++) {
        config.late_max_us = 3 * SECOND_US;
        start_with_config_and_scans(&config, 5);
        /* 6 and the numbers after it were skipped */
        take_late_scan(6 + behind, (6 + behind) * SECOND_US);
        expect_next_scan(30 * SECOND_US, 1, (6 + behind) * SECOND_US);
        take_late_scan(6, 30 * SECOND_US);
        assert_int_equal(take_all_items(30 * SECOND_US), behind <= 3);
        COUNTERS_ARE(.scans_accepted = 6 + (behind <= 3), .scans_late = 1,
                     .scans_lost = (uint32_t)behind);
    }
    config.late_max_us = 0;
    start_with_config_and_scans(&config, 5);
    take_late_scan(7, 7 * SECOND_US);
    take_late_scan(6, 7 * SECOND_US); /* held, so that it is given in time */
    assert_int_equal(take_all_items(7 * SECOND_US), 2);
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 1, .scans_lost = 1);
}

static void late_scans_whose_time_does_not_fit_their_number_are_refused(void **state)
{
    static const struct {
        int64_t time_us;
        int is_taken;
    } cases[] = {
        /* one number before 7: a second less a quarter, or plus a half, with jitter of 10 ms */
        {7 * SECOND_US - 740000, 1},  {7 * SECOND_US - 739999, 0}, {7 * SECOND_US - 1510000, 1},
        {7 * SECOND_US - 1510001, 0}, {7 * SECOND_US, 0},          {-20 * SECOND_US, 0},
    };

    (void)state;
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct look look = {.time_us = cases[i].time_us, .scan = 6, .sensor_id = 1, .count = 1};

        start_with_scans(5);
        take_late_scan(7, 7 * SECOND_US);
        take_message(&look, 7 * SECOND_US);
        assert_int_equal(assembler.counters.scans_accepted, 6 + cases[i].is_taken);
        assert_int_equal(assembler.counters.scans_late, 1);
        /* the true scan 6 may still come */
        take_late_scan(6, 7 * SECOND_US);
        assert_int_equal(assembler.counters.scans_accepted, 7);
        assert_int_equal(assembler.counters.scans_duplicate, cases[i].is_taken);
    }
}

static void scans_before_the_first_received_one_are_refused(void **state)
{
    (void)state;
    start_with_scans(0);
    take_late_scan(5, 5 * SECOND_US);
    take_late_scan(4, 5 * SECOND_US);
    take_late_scan(6, 6 * SECOND_US);
    take_late_scan(3, 6 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 2, .scans_late = 2);
}

static void several_late_scans_are_put_in_order(void **state)
{
    static const int32_t order[] = {9, 7, 8, 6};
    const unsigned room = RHO_MAX_OPEN_SCANS < 4 ? RHO_MAX_OPEN_SCANS : 4;

    (void)state;
    start_with_scans(5);
    for (unsigned i = 0; i < room; i++) {
        take_late_scan(order[i], 9 * SECOND_US);
    }
    if (room == 4) {
        for (int32_t scan = 6; scan <= 9; scan++) {
            expect_next_scan(9 * SECOND_US, 1, scan * SECOND_US);
        }
    } else { /* order 9, 7: 8 is waited for, but nothing before the late 7 */
        expect_next_scan(9 * SECOND_US, 1, 7 * SECOND_US);
        expect_no_scan(9 * SECOND_US);
        expect_next_scan(9 * SECOND_US + HOLD_US, 1, 9 * SECOND_US);
    }
    expect_no_scan(9 * SECOND_US);
}

static void parts_of_late_and_newer_scans_may_be_interleaved(void **state)
{
    static const struct {
        int32_t scan;
        int16_t part;
    } order[] = {{7, 1}, {6, 1}, {7, 0}, {6, 0}};

    (void)state;
    start_with_scans(5);
    for (unsigned i = 0; i < 4; i++) {
        struct look look = late_part(order[i].scan, order[i].part);

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

static void an_incomplete_late_scan_is_given_after_hold(void **state)
{
    struct rho_scan_assembler_config config = usual_config();
    struct look look = late_part(6, 0);

    (void)state;
    start_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    take_message(&look, 7 * SECOND_US + 10000);
    expect_no_scan(7 * SECOND_US + HOLD_US - 1);
    expect_next_scan(7 * SECOND_US + HOLD_US, 1, 6 * SECOND_US); /* scan 7 has been held */
    assert_int_equal(item.parts_missing, 1);
    expect_next_scan(7 * SECOND_US + HOLD_US, 1, 7 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 1, .scans_lost = 1, .scans_incomplete = 1);
    /* with hold INT64_MAX, parts wait only for a newer scan, which ends them */
    config.hold_us = 0;
    start_with_config_and_scans(&config, 5);
    take_late_scan(7, 7 * SECOND_US);
    expect_next_scan(7 * SECOND_US, 1, 7 * SECOND_US);
    take_message(&look, 7 * SECOND_US);
    expect_no_scan(20 * SECOND_US);
    take_scan(1, 8, 8 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 6 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 8 * SECOND_US);
    expect_no_scan(8 * SECOND_US);
}

/* A frame of bearings is over once a later one has begun. */
static void late_bearings_are_refused(void **state)
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
            (void)take_all_items(i == 2 && is_held ? 5 * SECOND_US : 6 * SECOND_US);
        }
        COUNTERS_ARE(.scans_accepted = 3 + (uint32_t)is_held, .scans_late = 1, .scans_lost = 1,
                     .bearings_in = 3 + (uint32_t)is_held);
    }
}

/* Skipped scans that are waited for */

/*
 * Scans 1 .. 5 of sensors 1 and 2, one a second; then 9 of sensor 1, or its first part, so that 8
 * is waited for.
 */
static void start_two_sensors_and_skip_to_scan_9(int16_t num_parts)
{
    struct look look = late_part(9, 0);

    start_assembler();
    for (int32_t i = 1; i <= 5; i++) {
        take_scan(1, i, i * SECOND_US);
        take_scan(2, i, i * SECOND_US);
        assert_int_equal(take_all_items(INT64_MAX), 2);
    }
    look.num_parts = num_parts;
    take_message(&look, 9 * SECOND_US);
    expect_no_scan(9 * SECOND_US);
}

static void others_wait_only_for_a_skipped_scan_that_may_be_older(void **state)
{
    static const struct {
        int64_t time_us;
        int waits;
    } cases[] = {{7600000, 0},
                 {8 * SECOND_US, 0}, /* exactly as old as scan 8 will be */
                 {8 * SECOND_US + 1, 1},
                 {9 * SECOND_US - 1, 1}};

    (void)state;
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int16_t num_parts = 1; num_parts <= 2; num_parts++) {
            struct look other = {.time_us = cases[i].time_us, .scan = 6, .sensor_id = 2};

            start_two_sensors_and_skip_to_scan_9(num_parts);
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

/* A late scan does not make others wait for the number before it. */
static void numbers_before_a_late_scan_are_not_waited_for(void **state)
{
    struct look other = {.time_us = 8 * SECOND_US - 1, .scan = 6, .sensor_id = 2};

    (void)state;
    start_two_sensors_and_skip_to_scan_9(1);
    take_late_scan(8, 9 * SECOND_US); /* scan 7 may still come */
    expect_no_scan(9 * SECOND_US);    /* sensor 2 may still send an older scan */
    if (RHO_MAX_OPEN_SCANS > 2) {
        take_message(&other, 9 * SECOND_US);
        expect_next_scan(9 * SECOND_US, 2, other.time_us);
    }
}

static void skipped_numbers_over_31_behind_are_not_waited_for(void **state)
{
    const int64_t step_us = 100000;

    (void)state;
    for (int32_t ahead = 30; ahead <= 60; ahead++) {
        struct look look = {.sensor_id = 1, .count = 1};

        start_assembler();
        for (look.scan = 1; look.scan <= 5; look.scan++) {
            look.time_us = look.scan * step_us;
            take_message(&look, look.time_us);
            assert_int_equal(take_all_items(look.time_us), 1);
        }
        look.scan = 7;
        look.time_us = 7 * step_us;
        take_message(&look, look.time_us);
        expect_no_scan(7 * step_us); /* scan 6 may still come */
        look.scan = 7 + ahead;
        look.time_us = look.scan * step_us;
        take_message(&look, 7 * step_us);
        if (ahead > 30) { /* scan 6 is more than 31 numbers behind */
            expect_next_scan(7 * step_us, 1, 7 * step_us);
        }
        expect_no_scan(7 * step_us);
    }
}

/* A replaced sensor's place belongs to another one, whose skipped numbers are its own. */
static void skipped_numbers_of_a_replaced_sensor_are_not_waited_for(void **state)
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
            assert_int_equal(take_all_items(INT64_MAX), 1);
        }
    }
    for (unsigned i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct look look = {
            .sensor_id = rows[i].sensor_id, .scan = rows[i].scan, .time_us = rows[i].time_us};

        take_message(&look, 6 * SECOND_US);
        if (i < 2) {
            assert_int_equal(take_all_items(INT64_MAX), 1);
        }
    }
    expect_next_scan(6 * SECOND_US, 0, 5250000);
}

/*
 * A skipped number from before a restart is not waited for, even if the new scans skip the same
 * number.
 */
static void scans_before_a_restart_are_not_waited_for(void **state)
{
    static const int32_t scans[] = {3, 4, 5, 8};

    (void)state;
    if (RHO_MAX_OPEN_SCANS < 3) {
        skip();
    }
    start_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    for (unsigned i = 0; i < 4; i++) {
        struct look look = {
            .time_us = (5 + scans[i]) * SECOND_US, .scan = scans[i], .epoch = 1, .sensor_id = 1};

        take_message(&look, 7 * SECOND_US);
    }
    expect_next_scan(7 * SECOND_US, 1, 7 * SECOND_US);
    expect_next_scan(7 * SECOND_US, 1, 10 * SECOND_US);
    expect_no_scan(7 * SECOND_US); /* scan 7 after the restart may still come */
    COUNTERS_ARE(.scans_accepted = 8, .scans_lost = 3, .scans_bad = 2, .sensor_restarts = 1);
}

/* Each late scan is counted once */

static void a_late_scan_held_too_long_is_dropped(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.hold_us = 0;
    config.late_max_us = 3 * SECOND_US;
    for (int64_t after_us = 0; after_us < 2; after_us++) {
        struct look look = late_part(6, 0);

        start_with_config_and_scans(&config, 5);
        take_late_scan(7, 7 * SECOND_US);
        expect_next_scan(7 * SECOND_US, 1, 7 * SECOND_US);
        expect_no_scan(7 * SECOND_US);
        take_message(&look, 7 * SECOND_US);
        take_scan(2, 1, 9 * SECOND_US + after_us);
        expect_next_scan(9 * SECOND_US, 2, 9 * SECOND_US + after_us);
        expect_no_scan(9 * SECOND_US);
        look.part = 1;
        take_message(&look, 9 * SECOND_US);
        assert_int_equal(take_all_items(9 * SECOND_US), 1 - after_us);
        COUNTERS_ARE(.scans_accepted = 8, .scans_late = 1, .scans_lost = 1,
                     .scans_duplicate = (uint32_t)after_us);
    }
}

static void a_late_scan_dropped_by_a_new_clock_counts_once(void **state)
{
    struct look look = late_part(6, 0);

    (void)state;
    start_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    take_message(&look, 7 * SECOND_US);
    for (int32_t scan = 8; scan <= 10; scan++) {
        struct look other = {.time_us = (3600 + scan) * SECOND_US, .scan = scan, .sensor_id = 1};

        take_message(&other, 7 * SECOND_US);
    }
    expect_next_scan(7 * SECOND_US, 1, 3610 * SECOND_US);
    assert_int_equal(item.is_restart, 1);
    expect_no_scan(INT64_MAX);
    assert_int_equal(assembler.counters.scans_late, 2); /* scans 6 and 7 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_swapped_scans_are_given_in_order),
        cmocka_unit_test(a_lost_scan_number_is_waited_for_once),
        cmocka_unit_test(hold_0_waits_for_no_skipped_scan),
        cmocka_unit_test(a_scan_later_than_hold_is_given_after_newer_ones),
        cmocka_unit_test(scans_later_than_late_max_are_refused),
        cmocka_unit_test(late_scans_whose_time_does_not_fit_their_number_are_refused),
        cmocka_unit_test(scans_before_the_first_received_one_are_refused),
        cmocka_unit_test(several_late_scans_are_put_in_order),
        cmocka_unit_test(parts_of_late_and_newer_scans_may_be_interleaved),
        cmocka_unit_test(an_incomplete_late_scan_is_given_after_hold),
        cmocka_unit_test(late_bearings_are_refused),
        cmocka_unit_test(others_wait_only_for_a_skipped_scan_that_may_be_older),
        cmocka_unit_test(numbers_before_a_late_scan_are_not_waited_for),
        cmocka_unit_test(skipped_numbers_over_31_behind_are_not_waited_for),
        cmocka_unit_test(skipped_numbers_of_a_replaced_sensor_are_not_waited_for),
        cmocka_unit_test(scans_before_a_restart_are_not_waited_for),
        cmocka_unit_test(a_late_scan_held_too_long_is_dropped),
        cmocka_unit_test(a_late_scan_dropped_by_a_new_clock_counts_once),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
