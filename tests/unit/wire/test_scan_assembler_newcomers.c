/* SPDX-License-Identifier: MIT */
/*
 * New sensors beside one heard for long, honest ones and others; sensors that are not allowed, and
 * two senders of one number.
 */
#include "scan_assembler_setup.h"

#define RADAR 1
#define INTERVAL_US INT64_C(2500000)
#define TURNS 48 /* turns in two minutes */

static int32_t turn;

static void start_at_turn_0(const struct rho_scan_assembler_config *config)
{
    start_assembler_with(config);
    turn = 0;
}

/* Takes the radar's next scan, which is given at once, and is the newest. */
static void step_radar_scan(void)
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

static int64_t start_with_a_radar(void)
{
    struct rho_scan_assembler_config config = usual_config();

    start_at_turn_0(&config);
    while (turn <= TURNS) {
        step_radar_scan();
    }
    return TURNS * INTERVAL_US;
}

static int is_scan_accepted(int16_t sensor_id, int32_t scan, int64_t time_us, int64_t now_us)
{
    const uint32_t before = assembler.counters.scans_accepted;
    struct look look = {.time_us = time_us, .scan = scan, .sensor_id = sensor_id, .count = 1};

    take_message(&look, now_us);
    return assembler.counters.scans_accepted > before;
}

static void scans_of_a_newcomer_ahead_of_time_wait_for_the_clock(void **state)
{
    const int64_t now_us = start_with_a_radar() + SECOND_US;

    (void)state;
    assert_true(is_scan_accepted(9, 0, now_us + SECOND_US, now_us));
    assert_int_equal(rho_scan_assembler_due_us(&assembler), now_us + SECOND_US + HOLD_US);
    expect_no_scan(now_us + SECOND_US + HOLD_US - 1);
    expect_next_scan(now_us + SECOND_US + HOLD_US, 9, now_us + SECOND_US);
    step_radar_scan();
    assert_true(is_scan_accepted(9, 1, now_us + 5 * SECOND_US, now_us + 2 * SECOND_US));
    assert_int_equal(assembler.clock_us, (turn - 1) * INTERVAL_US);
    step_radar_scan(); /* the newcomer's scan is given before the radar's */
    expect_next_scan(now_us + 5 * SECOND_US + HOLD_US, 9, now_us + 5 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = TURNS + 5);
}

static void early_scans_of_newcomers_delay_no_other_and_give_way(void **state)
{
    const int64_t now_us = start_with_a_radar() + SECOND_US;
    struct look look = {.sensor_id = RADAR,
                        .scan = turn,
                        .time_us = turn * INTERVAL_US,
                        .num_parts = 2,
                        .count = 1};

    (void)state;
    /* 0: as if a scan of the radar were in between */
    for (int16_t i = 0; i < RHO_MAX_OPEN_SCANS; i++) {
        assembler.newcomers = 0;
        assert_true(is_scan_accepted((int16_t)(20 + i), 0, now_us + 3 * SECOND_US, now_us));
    }
    assembler.newcomers = 0;
    assert_false(is_scan_accepted(80, 0, now_us + 3 * SECOND_US, now_us));
    expect_no_scan(now_us);
    take_message(&look, look.time_us);
    look.part = 1;
    take_message(&look, look.time_us + HOLD_US / 2);
    expect_next_scan(look.time_us + HOLD_US / 2 + HOLD_US, RADAR, look.time_us);
    assert_int_equal(item.parts_missing, 0);
    assert_int_equal(assembler.counters.sensors_no_room, 2);
}

/*
 * An early scan of a newcomer comes after the radar's first part, with a later time than the
 * radar's scan.
 */
static void an_early_scan_of_a_newcomer_ends_no_incomplete_scan(void **state)
{
    const int64_t time_us = start_with_a_radar() + INTERVAL_US;
    struct look look = {.sensor_id = RADAR, .scan = turn, .time_us = time_us, .num_parts = 3};

    (void)state;
    if (RHO_MAX_OPEN_SCANS < 2) {
        return;
    }
    take_message(&look, time_us);
    assert_true(is_scan_accepted(9, 0, time_us + 1, time_us));
    for (look.part = 1; look.part < 3; look.part++) {
        int64_t now_us = time_us + look.part * (HOLD_US - 1);

        expect_no_scan(now_us);
        take_message(&look, now_us);
    }
    expect_next_scan(time_us + 4 * HOLD_US, RADAR, time_us);
    assert_int_equal(item.parts_missing, 0);
    expect_next_scan(time_us + 4 * HOLD_US, 9, time_us + 1);
}

/*
 * Strangers of more numbers than there are places do not take that of a radar that is off. It is
 * back when follow_scans of its scans agree, as after any long silence.
 */
static void a_radar_that_was_off_for_a_minute_comes_back(void **state)
{
    const int64_t off_us = start_with_a_radar();
    int64_t now_us = off_us;
    int32_t refused = 0;

    (void)state;
    for (int32_t i = 0; now_us < off_us + 60 * SECOND_US; now_us += 5 * SECOND_US, i++) {
        for (int16_t id = 100; id < 100 + 2 * RHO_MAX_SENSORS; id++) {
            (void)is_scan_accepted(id, i, now_us, now_us);
            (void)take_all_items(now_us + HOLD_US);
        }
    }
    while (!is_scan_accepted(RADAR, turn++, now_us, now_us) && refused < 9) {
        now_us += INTERVAL_US;
        refused++;
    }
    assert_int_equal(refused, (int)assembler.config.follow_scans - 1);
}

static void many_newcomers_do_not_move_the_clock(void **state)
{
    int64_t now_us = start_with_a_radar();

    (void)state;
    for (int32_t i = 0; i < 10; i++) {
        for (int16_t id = 20; id < 20 + RHO_MAX_SENSORS - 1; id++) {
            assert_false(is_scan_accepted(id, i, now_us + i * 100000 + 3600 * SECOND_US,
                                          now_us + i * 100000));
        }
    }
    step_radar_scan();
    step_radar_scan();
    assert_int_equal(assembler.counters.sensor_restarts, 0);
    assert_int_equal(assembler.is_restart, 0);
}

/*
 * Two newcomers on another clock send a scan every every_us. Returns scans until that clock is
 * accepted.
 */
static int32_t scans_until_newcomers_set_clock(int32_t turns, int64_t every_us)
{
    struct rho_scan_assembler_config config = usual_config();
    int64_t from_us = turns * INTERVAL_US, sent_us = from_us - every_us;
    int32_t scans = 0;

    start_at_turn_0(&config);
    for (int64_t now_us = 0; !assembler.is_restart && scans < 1000; now_us += INTERVAL_US) {
        step_radar_scan();
        if (now_us >= sent_us + every_us) {
            sent_us = now_us;
            (void)is_scan_accepted(8, scans, now_us + 3600 * SECOND_US, now_us);
            (void)is_scan_accepted(9, scans, now_us + 3600 * SECOND_US, now_us);
            scans++;
        }
    }
    return scans;
}

/* Newcomers vote once heard for half as long as the radar is then, or for five minutes. */
static void newcomers_heard_for_long_vote_on_the_clock(void **state)
{
    (void)state;
    assert_in_range(scans_until_newcomers_set_clock(48, INTERVAL_US), 48, 51);
    assert_in_range(scans_until_newcomers_set_clock(240, INTERVAL_US), 120, 123);
    assert_in_range(scans_until_newcomers_set_clock(2400, INTERVAL_US), 120, 123);
    assert_in_range(scans_until_newcomers_set_clock(2400, 11 * INTERVAL_US), 12, 13);
}

/*
 * A camera on the radar's clock from its first scan on, with one scan between two of the radar's.
 */
static void an_honest_newcomer_loses_no_scan(void **state)
{
    const int64_t from_us = start_with_a_radar();
    unsigned given = 0;

    (void)state;
    for (int32_t i = 0; i < 200; i++) {
        int64_t now_us = from_us + (i * 2 + 1) * INTERVAL_US / 2;

        assert_true(is_scan_accepted(3, i, now_us, now_us));
        expect_no_scan(now_us + HOLD_US - 1);
        expect_next_scan(now_us + HOLD_US, 3, now_us);
        given++;
        step_radar_scan();
    }
    assert_int_equal(given, 200);
    assert_int_equal(assembler.counters.scans_lost + assembler.counters.scans_late, 0);
    assert_true(assembler.sources[1].known_us >= RHO_SCAN_ASSEMBLER_TRUST_US / 2 - 1);
}

/*
 * Until the radar counts as silent, the newcomer's scans keep the clock; after that they count
 * fully, without a restart.
 */
static void after_the_radar_falls_silent_a_newcomer_is_accepted(void **state)
{
    int64_t now_us = start_with_a_radar();
    uint32_t refused = 0;

    (void)state;
    for (int32_t n = 0; n < 60; n++) { /* half a minute beside the radar, then alone */
        if (n < 12) {
            step_radar_scan();
        }
        now_us += INTERVAL_US;
        refused += !is_scan_accepted(9, n, now_us, now_us);
        while (rho_scan_assembler_next(&assembler, now_us + HOLD_US, &item)) {
            assert_false(item.is_restart);
        }
    }
    assert_in_range(refused, 0, 4);
    assert_int_equal(assembler.counters.clock_jumps, 0);
    assert_int_equal(assembler.out_us, now_us);
}

static void when_a_record_is_played_no_sensor_is_a_newcomer(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.is_record = 1;
    start_at_turn_0(&config);
    while (turn <= TURNS) {
        step_radar_scan();
    }
    assert_true(is_scan_accepted(9, 0, turn * INTERVAL_US - 2, turn * INTERVAL_US - SECOND_US));
    expect_next_scan(turn * INTERVAL_US - SECOND_US + HOLD_US, 9, turn * INTERVAL_US - 2);
}

/* Shared limits of newcomers */

static void newcomers_share_a_limit_of_plots_and_scans(void **state)
{
    const int64_t now_us = start_with_a_radar() + SECOND_US;
    struct look look = {.count = 30, .num_parts = 12, .time_us = now_us, .sensor_id = 9};
    struct rho_scan_assembler_sensor known = assembler.config.other;
    const uint32_t parts = assembler.config.stranger_plots_per_s / look.count;

    (void)state;
    for (; look.part < look.num_parts; look.part++) {
        take_message(&look, now_us);
    }
    COUNTERS_ARE(.scans_accepted = TURNS + 2, .messages_flooded = (uint32_t)look.num_parts - parts);
    look = (struct look){.time_us = now_us, .sensor_id = 8};
    take_message(&look, now_us); /* the next newcomer may send after the radar's next scan */
    assert_int_equal(assembler.counters.messages_flooded, 13 - parts);
    look.sensor_id = known.sensor.sensor_id = 7;
    look.count = 34;
    assert_int_equal(rho_scan_assembler_set_sensor(&assembler, &known), RHO_OK);
    take_all_items(INT64_MAX);
    take_message(&look, now_us); /* a described sensor has its own limit */
    assert_int_equal(assembler.counters.messages_flooded, 13 - parts);
    assert_int_equal(assembler.counters.scans_accepted, TURNS + 3);
    assembler.config.allowed[assembler.config.num_allowed++] = look.sensor_id = 6;
    take_all_items(INT64_MAX);
    take_message(&look, now_us); /* a sensor allowed by name has its own limit */
    assert_int_equal(assembler.counters.scans_accepted, TURNS + 4);
}

/*
 * A newcomer's scan beyond its turn is refused with all its parts, and not counted as late as well.
 */
static void all_parts_of_a_newcomers_refused_scan_are_refused(void **state)
{
    const int64_t now_us = start_with_a_radar() + SECOND_US;
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
    /* other contents of a refused scan do not count as a second sender */
    for (look.part = 0; look.part < look.num_parts; look.part++) {
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

/* The message claims 1 mm; the assembler's configured noise is 10 m. */
static void a_newcomers_noise_is_at_least_that_of_the_config(void **state)
{
    const int64_t now_us = start_with_a_radar() + SECOND_US;
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
                                    end_message(&writer), head.utime),
                         RHO_OK);
        expect_next_scan(head.utime + HOLD_US, head.sensor_id, head.utime);
        assert_float_equal(item.scan.plots[0].sigma_range_m, i == 0 ? 10.0f : 0.001f, 0.0f);
    }
}

/* Allowed sensors, two senders of one number */

static void messages_of_sensors_not_allowed_are_counted(void **state)
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

static void two_senders_of_one_sensor_number_are_counted(void **state)
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
        cmocka_unit_test(scans_of_a_newcomer_ahead_of_time_wait_for_the_clock),
        cmocka_unit_test(early_scans_of_newcomers_delay_no_other_and_give_way),
        cmocka_unit_test(an_early_scan_of_a_newcomer_ends_no_incomplete_scan),
        cmocka_unit_test(a_radar_that_was_off_for_a_minute_comes_back),
        cmocka_unit_test(many_newcomers_do_not_move_the_clock),
        cmocka_unit_test(newcomers_heard_for_long_vote_on_the_clock),
        cmocka_unit_test(an_honest_newcomer_loses_no_scan),
        cmocka_unit_test(after_the_radar_falls_silent_a_newcomer_is_accepted),
        cmocka_unit_test(when_a_record_is_played_no_sensor_is_a_newcomer),
        cmocka_unit_test(newcomers_share_a_limit_of_plots_and_scans),
        cmocka_unit_test(all_parts_of_a_newcomers_refused_scan_are_refused),
        cmocka_unit_test(a_newcomers_noise_is_at_least_that_of_the_config),
        cmocka_unit_test(messages_of_sensors_not_allowed_are_counted),
        cmocka_unit_test(two_senders_of_one_sensor_number_are_counted),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
