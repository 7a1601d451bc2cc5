/* SPDX-License-Identifier: MIT */
/* Late scans take no room from other scans, whatever a faulty sensor sends. */
#include "late_scans.h"

/* A late scan neither ends other sensors' incomplete scans nor takes their room. */
static void late_scans_take_no_room_of_other_scans(void **state)
{
    (void)state;
    start_with_scans(5);
    take_late_scan(7, 7 * SECOND_US);
    expect_next_scan(8 * SECOND_US, 1, 7 * SECOND_US);
    expect_no_scan(8 * SECOND_US);
    for (int16_t i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        struct look look = {.time_us = 7 * SECOND_US + 1,
                            .scan = 1,
                            .sensor_id = (int16_t)(10 + i),
                            .kind = RHO_SCAN_ASSEMBLER_POLAR,
                            .num_parts = 2};
        if (i < RHO_MAX_SENSORS - 1) {
            take_message(&look, 8 * SECOND_US);
        }
    }
    take_late_scan(6, 8 * SECOND_US);
    if (RHO_MAX_OPEN_SCANS < RHO_MAX_SENSORS) {
        COUNTERS_ARE(.scans_accepted = 6 + RHO_MAX_OPEN_SCANS, .scans_late = 1, .scans_lost = 1);
    }
}

/*
 * Sensor 1 sends scans 1 .. 9, one a second, and sensor 9, with wrong numbers, a hundred a second.
 * Returns the last number of sensor 9.
 */
static int32_t start_with_slow_and_fast_sensor(const struct rho_scan_assembler_config *config)
{
    int32_t scan = 0;

    start_assembler_with(config);
    for (int32_t i = 1; i <= 9; i++) {
        take_scan(1, i, i * SECOND_US);
        for (int32_t k = 1; k < 100; k++) {
            take_scan(9, ++scan, i * SECOND_US + k * 10000);
            (void)take_all_items(INT64_MAX);
        }
    }
    return scan;
}

/*
 * Sends first parts of a scan of sensor 9 far ahead and of the numbers that it skipped, all with
 * times after 10 s.
 */
static struct look send_scan_far_ahead_and_those_skipped(int32_t last, int64_t now_us)
{
    struct look look = {.scan = last + 32,
                        .time_us = 9990000 + 32 * 10000,
                        .sensor_id = 9,
                        .num_parts = 2,
                        .count = 1};

    for (int32_t k = 0; k <= 30; k++) {
        struct look more = look;

        more.scan -= k;
        more.time_us -= k * 10000;
        take_message(&more, now_us);
        expect_no_scan(now_us);
    }
    return look;
}

static void wrong_scan_numbers_end_no_incomplete_scan(void **state)
{
    const struct rho_scan_assembler_config config = usual_config();
    const int64_t now_us = 10 * SECOND_US;
    const int32_t last = start_with_slow_and_fast_sensor(&config);
    struct look look = late_part(10, 0), more;

    (void)state;
    take_message(&look, now_us);
    more = send_scan_far_ahead_and_those_skipped(last, now_us);
    /* at most one waits for its parts, and none without room */
    assert_int_equal(assembler.counters.scans_accepted, 9 + 9 * 99 + 2 + (RHO_MAX_OPEN_SCANS > 2));
    assert_int_equal(assembler.counters.scans_late, 30);
    if (RHO_MAX_OPEN_SCANS > 2) {
        more.scan++;
        more.time_us += 10000;
        take_message(&more, now_us);
        expect_no_scan(now_us);
    }
    look.part = 1;
    take_message(&look, now_us + 1);
    expect_next_scan(now_us + 1, 1, now_us);
    assert_int_equal(item.parts_missing, 0);
}

static void one_late_scan_per_sensor_waits_for_its_parts(void **state)
{
    struct look first = late_part(8, 0), second = late_part(7, 0);

    (void)state;
    start_with_scans(5);
    take_late_scan(9, 9 * SECOND_US);
    expect_next_scan(10 * SECOND_US, 1, 9 * SECOND_US);
    expect_no_scan(10 * SECOND_US);
    take_message(&first, 10 * SECOND_US);
    take_message(&second, 10 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 7, .scans_late = 2, .scans_lost = 3);
    take_late_scan(6, 10 * SECOND_US);
    expect_next_scan(10 * SECOND_US, 1, 6 * SECOND_US);
    first.part = second.part = 1;
    take_message(&first, 10 * SECOND_US);
    expect_next_scan(10 * SECOND_US, 1, 8 * SECOND_US);
    second.num_parts = 1; /* the refused scan was not remembered */
    second.part = 0;
    take_message(&second, 10 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 9, .scans_late = 4, .scans_lost = 3);
}

static void wrong_scan_numbers_block_no_other_sensor(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    for (int is_held = 0; is_held < 2; is_held++) {
        config.hold_us = is_held * HOLD_US;
        (void)send_scan_far_ahead_and_those_skipped(start_with_slow_and_fast_sensor(&config),
                                                    10 * SECOND_US);
        for (int32_t i = 1; i <= 5; i++) {
            int64_t now_us = (10 + 4 * i) * SECOND_US;

            take_scan(3, i, now_us);
            assert_in_range(take_all_items(now_us + HOLD_US), 1, 3);
            assert_int_equal(item_sensor(), 3);
        }
        assert_int_equal(assembler.counters.scans_accepted, 9 + 9 * 99 + 2 + 5);
    }
}

/*
 * Late scans wait to be given; another sensor that needs their room gets it, and no scan is late by
 * that.
 */
static void late_scans_give_way_to_other_scans(void **state)
{
    struct rho_scan_assembler_config config = usual_config();
    const unsigned late_ones = RHO_MAX_OPEN_SCANS < 4 ? RHO_MAX_OPEN_SCANS - 1 : 3;
    unsigned others = 0;

    (void)state;
    config.late_max_us = 20 * SECOND_US;
    start_with_config_and_scans(&config, 5);
    take_scan(2, 1, 5 * SECOND_US + 1);
    assert_int_equal(take_all_items(INT64_MAX), 1);
    take_late_scan(9, 9 * SECOND_US);
    for (int32_t scan = 8; scan > 8 - (int32_t)late_ones; scan--) {
        take_late_scan(scan, 9 * SECOND_US);
    }
    expect_no_scan(9 * SECOND_US); /* sensor 2 may still send an older scan */
    for (int16_t id = 10; id < 10 + RHO_MAX_OPEN_SCANS - 1; id++, others++) {
        struct look look = {.time_us = 6 * SECOND_US - 1 + id, .sensor_id = id, .num_parts = 2};

        if (others < RHO_MAX_SENSORS - 2) {
            take_message(&look, 9 * SECOND_US);
        }
    }
    assert_int_equal(assembler.counters.scans_late, late_ones);
    assert_int_equal(assembler.counters.sensors_no_room, 0);
    assert_int_equal(assembler.counters.scans_incomplete, 0);
    expect_no_scan(9 * SECOND_US);
    expect_next_scan(9 * SECOND_US + HOLD_US, 10, 6 * SECOND_US + 9);
}

/* A late scan does not cause a newer scan to be given before an older incomplete one. */
static void a_late_scan_makes_no_incomplete_scan_late(void **state)
{
    const int64_t now_us = 10 * SECOND_US;
    struct look open = late_part(9, 0), whole = {.time_us = 9 * SECOND_US + 1, .scan = 6};

    (void)state;
    start_assembler();
    for (int32_t i = 1; i <= 5; i++) {
        for (int16_t id = 1; id <= 3; id++) {
            take_scan(id, i, i * SECOND_US);
            assert_int_equal(take_all_items(INT64_MAX), 1);
        }
    }
    take_scan(3, 7, 7 * SECOND_US);
    (void)take_all_items(INT64_MAX);
    take_message(&open, now_us);
    whole.sensor_id = 2;
    take_message(&whole, now_us);
    for (int16_t id = 10; id < 10 + RHO_MAX_OPEN_SCANS - 2; id++) {
        struct look look = {.time_us = now_us, .sensor_id = id, .num_parts = 2};

        take_message(&look, now_us);
    }
    take_scan(3, 6, 6 * SECOND_US); /* refused for lack of room */
    assert_int_equal(assembler.counters.scans_late, 1);
    expect_no_scan(now_us);
    open.part = 1;
    take_message(&open, now_us);
    expect_next_scan(now_us + HOLD_US, 1, 9 * SECOND_US);
    assert_int_equal(item.parts_missing, 0);
    expect_next_scan(now_us + HOLD_US, 2, 9 * SECOND_US + 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(late_scans_take_no_room_of_other_scans),
        cmocka_unit_test(wrong_scan_numbers_end_no_incomplete_scan),
        cmocka_unit_test(one_late_scan_per_sensor_waits_for_its_parts),
        cmocka_unit_test(wrong_scan_numbers_block_no_other_sensor),
        cmocka_unit_test(late_scans_give_way_to_other_scans),
        cmocka_unit_test(a_late_scan_makes_no_incomplete_scan_late),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
