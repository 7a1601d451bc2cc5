/* SPDX-License-Identifier: MIT */
/*
 * Sensors that are new beside one that was heard for long, honest ones and others; sensors that are
 * not allowed, and twins.
 */
#include "scan_assembler_setup.h"

#define RADAR 1
#define INTERVAL_US INT64_C(2500000)
#define TURNS 48 /* two minutes */

static int32_t turn;

static void begin(const struct rho_scan_assembler_config *config)
{
    start_assembler_with(config);
    turn = 0;
}

/* The radar's next scan goes out at once, and is the newest. */
static void radar(void)
{
    const int64_t time_us = turn * INTERVAL_US;

    take_scan(RADAR, turn++, time_us);
    assert_true(rho_scan_assembler_next(&assembler, time_us + HOLD_US, &item));
    while (item_sensor() != RADAR) {
        assert_true(rho_scan_assembler_next(&assembler, time_us + HOLD_US, &item));
    }
    assert_int_equal(item_time_us(), time_us);
    expect_no_scan(time_us + HOLD_US);
    assert_int_equal(assembler.out_us, time_us);
}

static int64_t begin_with_a_radar(void)
{
    struct rho_scan_assembler_config config = usual_config();

    begin(&config);
    while (turn <= TURNS) {
        radar();
    }
    return TURNS * INTERVAL_US;
}

static int is_taken(int16_t sensor_id, int32_t scan, int64_t time_us, int64_t now_us)
{
    const uint32_t before = assembler.counters.scans_accepted;
    struct look look = {.time_us = time_us, .scan = scan, .sensor_id = sensor_id, .count = 1};

    take_message(&look, now_us);
    return assembler.counters.scans_accepted > before;
}

static void what_is_ahead_waits_for_the_clock_of_who_was_heard(void **state)
{
    const int64_t now_us = begin_with_a_radar() + SECOND_US;

    (void)state;
    assert_true(is_taken(9, 0, now_us + SECOND_US, now_us));
    assert_int_equal(rho_scan_assembler_due_us(&assembler), now_us + SECOND_US + HOLD_US);
    expect_no_scan(now_us + SECOND_US + HOLD_US - 1);
    expect_next_scan(now_us + SECOND_US + HOLD_US, 9, now_us + SECOND_US);
    radar();
    assert_true(is_taken(9, 1, now_us + 5 * SECOND_US, now_us + 2 * SECOND_US));
    assert_int_equal(assembler.clock_us, (turn - 1) * INTERVAL_US);
    radar(); /* goes out before */
    expect_next_scan(now_us + 5 * SECOND_US + HOLD_US, 9, now_us + 5 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = TURNS + 5);
}

static void it_makes_no_other_wait_and_gives_way(void **state)
{
    const int64_t now_us = begin_with_a_radar() + SECOND_US;
    struct look look = {.sensor_id = RADAR,
                        .scan = turn,
                        .time_us = turn * INTERVAL_US,
                        .num_parts = 2,
                        .count = 1};

    (void)state;
    for (int16_t i = 0; i < RHO_MAX_OPEN_SCANS; i++) { /* as if a radar's scan were in between */
        assembler.newcomers = 0;
        assert_true(is_taken((int16_t)(20 + i), 0, now_us + 3 * SECOND_US, now_us));
    }
    assembler.newcomers = 0;
    assert_false(is_taken(80, 0, now_us + 3 * SECOND_US, now_us));
    expect_no_scan(now_us);
    take_message(&look, look.time_us);
    look.part = 1;
    take_message(&look, look.time_us + HOLD_US / 2);
    expect_next_scan(look.time_us + HOLD_US / 2 + HOLD_US, RADAR, look.time_us);
    assert_int_equal(item.parts_missing, 0);
    assert_int_equal(assembler.counters.sensors_no_room, 2);
}

/* It is as far behind the radar's first part as it likes, and later than its scan. */
static void it_cuts_no_scan_short(void **state)
{
    const int64_t time_us = begin_with_a_radar() + INTERVAL_US;
    struct look look = {.sensor_id = RADAR, .scan = turn, .time_us = time_us, .num_parts = 3};

    (void)state;
    if (RHO_MAX_OPEN_SCANS < 2) {
        return;
    }
    take_message(&look, time_us);
    assert_true(is_taken(9, 0, time_us + 1, time_us));
    for (look.part = 1; look.part < 3; look.part++) {
        int64_t now_us = time_us + look.part * (HOLD_US - 1);

        expect_no_scan(now_us);
        take_message(&look, now_us);
    }
    expect_next_scan(time_us + 4 * HOLD_US, RADAR, time_us);
    assert_int_equal(item.parts_missing, 0);
    expect_next_scan(time_us + 4 * HOLD_US, 9, time_us + 1);
}

static void many_of_them_do_not_move_the_clock(void **state)
{
    int64_t now_us = begin_with_a_radar();

    (void)state;
    for (int32_t i = 0; i < 10; i++) {
        for (int16_t id = 20; id < 20 + RHO_MAX_SENSORS - 1; id++) {
            assert_false(
                is_taken(id, i, now_us + i * 100000 + 3600 * SECOND_US, now_us + i * 100000));
        }
    }
    radar();
    radar();
    assert_int_equal(assembler.counters.sensor_restarts, 0);
    assert_int_equal(assembler.is_restart, 0);
}

/*
 * Two of them on another clock, with a scan each every_us: how many until that clock is followed.
 */
static int32_t scans_until_followed(int32_t turns, int64_t every_us)
{
    struct rho_scan_assembler_config config = usual_config();
    int64_t from_us = turns * INTERVAL_US, sent_us = from_us - every_us;
    int32_t scans = 0;

    begin(&config);
    for (int64_t now_us = 0; !assembler.is_restart && scans < 1000; now_us += INTERVAL_US) {
        radar();
        if (now_us >= sent_us + every_us) {
            sent_us = now_us;
            (void)is_taken(8, scans, now_us + 3600 * SECOND_US, now_us);
            (void)is_taken(9, scans, now_us + 3600 * SECOND_US, now_us);
            scans++;
        }
    }
    return scans;
}

/* Once they were heard for half as long as the radar, as it is then, or five minutes. */
static void who_is_heard_for_long_has_a_vote(void **state)
{
    (void)state;
    assert_in_range(scans_until_followed(48, INTERVAL_US), 48, 50);
    assert_in_range(scans_until_followed(240, INTERVAL_US), 120, 122);
    assert_in_range(scans_until_followed(2400, INTERVAL_US), 120, 122);
    assert_in_range(scans_until_followed(2400, 11 * INTERVAL_US), 12, 12);
}

/* A camera with the same clock, from its first scan on: as many as it has turns. */
static void an_honest_one_loses_nothing(void **state)
{
    const int64_t from_us = begin_with_a_radar();
    unsigned given = 0;

    (void)state;
    for (int32_t i = 0; i < 200; i++) {
        int64_t now_us = from_us + (i * 2 + 1) * INTERVAL_US / 2;

        assert_true(is_taken(3, i, now_us, now_us));
        expect_no_scan(now_us + HOLD_US - 1);
        expect_next_scan(now_us + HOLD_US, 3, now_us);
        given++;
        radar();
    }
    assert_int_equal(given, 200);
    assert_int_equal(assembler.counters.scans_lost + assembler.counters.scans_late, 0);
    assert_true(assembler.sources[1].known_us >= RHO_SCAN_ASSEMBLER_TRUST_US / 2 - 1);
}

/* Its scans fill the time until it is missed, and then count as any: nothing begins anew. */
static void who_falls_silent_holds_nobody(void **state)
{
    int64_t now_us = begin_with_a_radar();
    uint32_t refused = 0;

    (void)state;
    for (int32_t n = 0; n < 60; n++) { /* beside the radar for half a minute, then alone */
        if (n < 12) {
            radar();
        }
        now_us += INTERVAL_US;
        refused += !is_taken(9, n, now_us, now_us);
        while (rho_scan_assembler_next(&assembler, now_us + HOLD_US, &item)) {
            assert_false(item.is_restart);
        }
    }
    assert_in_range(refused, 0, 4);
    assert_int_equal(assembler.counters.clock_jumps, 0);
    assert_int_equal(assembler.out_us, now_us);
}

static void in_a_record_nobody_is_new(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.is_record = 1;
    begin(&config);
    while (turn <= TURNS) {
        radar();
    }
    assert_true(is_taken(9, 0, turn * INTERVAL_US - 2, turn * INTERVAL_US - SECOND_US));
    expect_next_scan(turn * INTERVAL_US - SECOND_US + HOLD_US, 9, turn * INTERVAL_US - 2);
}

/*
 * ---- shares -----------------------------------------------------------------------------------
 */

static void newcomers_share_plots_and_turns(void **state)
{
    const int64_t now_us = begin_with_a_radar() + SECOND_US;
    struct look look = {.count = 30, .num_parts = 12, .time_us = now_us, .sensor_id = 9};
    struct rho_scan_assembler_sensor known = assembler.config.other;
    const uint32_t parts = assembler.config.stranger_plots_per_s / look.count;

    (void)state;
    for (; look.part < look.num_parts; look.part++) {
        take_message(&look, now_us);
    }
    COUNTERS_ARE(.scans_accepted = TURNS + 2, .messages_flooded = (uint32_t)look.num_parts - parts);
    look = (struct look){.time_us = now_us, .sensor_id = 8};
    take_message(&look, now_us); /* the next one has its turn behind the radar's */
    assert_int_equal(assembler.counters.messages_flooded, 13 - parts);
    look.sensor_id = known.sensor.sensor_id = 7;
    look.count = 34;
    assert_int_equal(rho_scan_assembler_set_sensor(&assembler, &known), RHO_OK);
    drain(INT64_MAX);
    take_message(&look, now_us); /* one that is described has its own */
    assert_int_equal(assembler.counters.messages_flooded, 13 - parts);
    assert_int_equal(assembler.counters.scans_accepted, TURNS + 3);
    assembler.config.allowed[assembler.config.num_allowed++] = look.sensor_id = 6;
    drain(INT64_MAX);
    take_message(&look, now_us); /* and one that is allowed by name */
    assert_int_equal(assembler.counters.scans_accepted, TURNS + 4);
}

/*
 * A scan that is not its turn is refused with all of its parts, and a late one is not late beside.
 */
static void parts_of_a_scan_without_a_turn_are_flooded_too(void **state)
{
    const int64_t now_us = begin_with_a_radar() + SECOND_US;
    struct look look = {.count = 1, .num_parts = 3, .time_us = now_us, .sensor_id = 9};

    (void)state;
    for (; look.part < look.num_parts; look.part++) {
        take_message(&look, now_us);
    }
    COUNTERS_ARE(.scans_accepted = TURNS + 2);
    look.scan = 2;
    look.time_us += 2 * SECOND_US;
    for (look.part = 0; look.part < look.num_parts; look.part++) {
        take_message(&look, now_us + 2 * SECOND_US);
        COUNTERS_ARE(.scans_accepted = TURNS + 2, .scans_lost = 1,
                     .messages_flooded = look.part + 1u);
    }
    look.tag = 7;
    for (look.part = 0; look.part < look.num_parts; look.part++) { /* other contents, no twin */
        take_message(&look, now_us + 2 * SECOND_US);
    }
    COUNTERS_ARE(.scans_accepted = TURNS + 2, .scans_lost = 1, .messages_flooded = 6);
    look.scan = 1;
    look.time_us -= SECOND_US;
    for (look.part = 0; look.part < look.num_parts; look.part++) {
        take_message(&look, now_us + 2 * SECOND_US);
    }
    COUNTERS_ARE(.scans_accepted = TURNS + 2, .scans_lost = 1, .messages_flooded = 9);
}

/* The message says 1 mm; the assembler's own noise is 10 m. */
static void a_newcomer_is_no_surer_than_the_config(void **state)
{
    const int64_t now_us = begin_with_a_radar() + SECOND_US;
    struct rho_message_plot plot = {.x_m = 1.0f, .sigma_m = 0.001f};
    struct rho_message_plot_scan_head head = {
        .utime = now_us, .kind = RHO_MESSAGE_PLOT_SCAN_POSITION_2D, .num_parts = 1};
    struct rho_message_writer writer;
    uint8_t buffer[DATAGRAM];

    (void)state;
    for (int i = 0; i < 2; i++) {
        head.sensor_id = i == 0 ? 9 : RADAR;
        head.scan = i == 0 ? 0 : turn;
        head.utime = i == 0 ? now_us : turn * INTERVAL_US;
        assert_int_equal(rho_message_plot_scan_begin(&writer, buffer, DATAGRAM, &head), RHO_OK);
        assert_int_equal(rho_message_plot_scan_add(&writer, &plot), RHO_OK);
        assert_int_equal(take_bytes(channel_of(RHO_SCAN_ASSEMBLER_PLOTS, head.sensor_id), buffer,
                                    end_of_message(&writer), head.utime),
                         RHO_OK);
        expect_next_scan(head.utime + HOLD_US, head.sensor_id, head.utime);
        assert_float_equal(item.scan.plots[0].sigma_range_m, i == 0 ? 10.0f : 0.001f, 0.0f);
    }
}

/*
 * ---- who may send -----------------------------------------------------------------------------
 */

static void sensors_that_are_not_allowed_are_counted(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.num_allowed = 2;
    config.allowed[0] = -5;
    config.allowed[1] = 12;
    start_assembler_with(&config);
    take_scan(12, 0, 0);
    take_scan(-5, 0, 0);
    take_scan(5, 0, 0);
    take_scan(0, 0, 0);
    COUNTERS_ARE(.scans_accepted = 2, .messages_not_allowed = 2);
    config.num_allowed = RHO_MAX_SENSORS + 1;
    assert_int_equal(rho_scan_assembler_init(&assembler, sizeof assembler, &config),
                     RHO_ERROR_CONFIG);
    config.num_allowed = 0;
    config.stranger_plots_per_s = 0;
    assert_int_equal(rho_scan_assembler_init(&assembler, sizeof assembler, &config),
                     RHO_ERROR_CONFIG);
}

static void two_senders_of_one_number_are_told(void **state)
{
    struct look look = {.time_us = SECOND_US, .sensor_id = 4, .count = 3};

    (void)state;
    start_assembler();
    take_message(&look, 0);
    take_message(&look, 0);
    assert_int_equal(assembler.sources[0].has_two_senders, 0);
    expect_next_scan(0, 4, SECOND_US);
    take_message(&look, 0);
    look.tag = 7;
    take_message(&look, 0);
    COUNTERS_ARE(.scans_accepted = 1, .scans_duplicate = 2, .scans_other = 1);
    assert_int_equal(assembler.sources[0].has_two_senders, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_ahead_waits_for_the_clock_of_who_was_heard),
        cmocka_unit_test(it_makes_no_other_wait_and_gives_way),
        cmocka_unit_test(it_cuts_no_scan_short),
        cmocka_unit_test(many_of_them_do_not_move_the_clock),
        cmocka_unit_test(who_is_heard_for_long_has_a_vote),
        cmocka_unit_test(an_honest_one_loses_nothing),
        cmocka_unit_test(who_falls_silent_holds_nobody),
        cmocka_unit_test(in_a_record_nobody_is_new),
        cmocka_unit_test(newcomers_share_plots_and_turns),
        cmocka_unit_test(parts_of_a_scan_without_a_turn_are_flooded_too),
        cmocka_unit_test(a_newcomer_is_no_surer_than_the_config),
        cmocka_unit_test(sensors_that_are_not_allowed_are_counted),
        cmocka_unit_test(two_senders_of_one_number_are_told),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
