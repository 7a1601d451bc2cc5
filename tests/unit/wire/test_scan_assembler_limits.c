/* SPDX-License-Identifier: MIT */
/* Messages for which an assembler has no room, which it refuses, and which are invalid. */
#include "scan_assembler_setup.h"

static struct rho_scan_assembler before;

/* Flood limit */

static void messages_beyond_flood_per_s_are_not_read(void **state)
{
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.flood_per_s = 5;
    start_assembler_with(&config);
    take_scan(1, 0, 0); /* counted for unknown sensors, as the first message is */
    for (int i = 0; i < 9; i++) {
        take_scan(1, 0, 1);
    }
    COUNTERS_ARE(.scans_accepted = 1, .scans_other = 5, .messages_flooded = 4);
    take_scan(2, 0, 2); /* another sensor is not affected */
    COUNTERS_ARE(.scans_accepted = 2, .scans_other = 5, .messages_flooded = 4);
    take_scan(1, 1, SECOND_US - 1);
    COUNTERS_ARE(.scans_accepted = 2, .scans_other = 5, .messages_flooded = 5);
    expect_next_scan(SECOND_US, 1, 0);
    expect_next_scan(SECOND_US, 2, 2);
    expect_no_scan(SECOND_US);
    take_scan(1, 1, SECOND_US);
    COUNTERS_ARE(.scans_accepted = 3, .scans_other = 5, .messages_flooded = 5);
}

static void unknown_sensors_share_one_flood_limit(void **state)
{
    struct rho_scan_assembler_config config = usual_config();
    uint8_t junk[3] = {0};

    (void)state;
    config.flood_per_s = 5;
    start_assembler_with(&config);
    for (int16_t id = 0; id < 9; id++) {
        assert_int_equal(take_bytes(channel_of(0, id), junk, sizeof junk, 0), RHO_OK);
    }
    COUNTERS_ARE(.messages_bad = 5, .messages_flooded = 4);
}

static void a_reception_clock_set_back_refills_the_flood_limit(void **state)
{
    struct rho_scan_assembler_config config = usual_config();
    struct look look = {.sensor_id = 1};

    (void)state;
    config.flood_per_s = 1;
    start_assembler_with(&config);
    take_message(&look, 100 * SECOND_US);
    take_message(&look, 100 * SECOND_US);
    take_message(&look, 100 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 1, .scans_duplicate = 1, .messages_flooded = 1);
    take_message(&look, 99 * SECOND_US);
    take_message(&look, 99 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 1, .scans_duplicate = 2, .messages_flooded = 2);
}

static void a_message_offered_again_counts_once_in_the_flood_limit(void **state)
{
    struct rho_scan_assembler_config config = usual_config();
    struct look look = {.num_parts = 2};

    (void)state;
    config.flood_per_s = RHO_MAX_OPEN_SCANS + 1;
    start_assembler_with(&config);
    for (int16_t id = 0; id < RHO_MAX_OPEN_SCANS; id++) {
        look.sensor_id = id;
        take_message(&look, 0);
    }
    look.sensor_id = RHO_MAX_OPEN_SCANS;
    for (int i = 0; i < 10; i++) {
        assert_int_equal(take_message_status(&look, 0), RHO_ERROR_CAPACITY);
    }
    assert_int_equal(assembler.counters.messages_flooded, 0);
}

/*
 * ---- the table of sensors ---------------------------------------------------------------------
 */

static void fill_table(int32_t scans)
{
    for (int32_t scan = 0; scan < scans; scan++) {
        for (int16_t id = 0; id < RHO_MAX_SENSORS; id++) {
            take_scan(id, scan, scan * SECOND_US + id);
            assert_int_equal(take_all_items(scan * SECOND_US + HOLD_US + id), 1);
        }
    }
}

static void a_new_sensor_replaces_the_one_heard_longest_ago(void **state)
{
    (void)state;
    start_assembler();
    fill_table(1);
    take_scan(1000, 0, SECOND_US);
    assert_int_equal(take_all_items(INT64_MAX), 1);
    for (unsigned i = 0; i < RHO_MAX_SENSORS; i++) {
        assert_int_equal(assembler.sources[i].sensor_id, i == 0 ? 1000 : (int)i);
    }
    assert_int_equal(assembler.counters.sensors_no_room, 0);
}

static void proven_sensors_are_not_replaced_while_heard(void **state)
{
    const uint32_t known = 3 * RHO_MAX_SENSORS;

    (void)state;
    start_assembler();
    fill_table(3);
    take_scan(1000, 0, 3 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = known, .sensors_no_room = 1);
    take_scan(1000, 0, 2 * SECOND_US + JUMP_US); /* the first sensor was heard jump_max ago */
    COUNTERS_ARE(.scans_accepted = known, .sensors_no_room = 2);
    take_scan(1000, 0, 2 * SECOND_US + JUMP_US + 1);
    COUNTERS_ARE(.scans_accepted = known + 1, .sensors_no_room = 2);
    assert_int_equal(assembler.sources[0].sensor_id, 1000);
}

static void forged_sensors_never_replace_proven_ones(void **state)
{
    uint32_t forged = 0;

    (void)state;
    start_assembler();
    random_state = 11;
    fill_table(3);
    for (int32_t scan = 3; scan < 40; scan++) {
        for (int16_t id = 0; id < RHO_MAX_SENSORS; id++) {
            uint32_t accepted = assembler.counters.scans_accepted;
            int64_t now_us = scan * SECOND_US + id;

            for (int i = 0; i < 20; i++) {
                struct look look = {.time_us = now_us + (int32_t)random_below(100000) - 50000,
                                    .scan = (int32_t)random_below(UINT32_MAX),
                                    .sensor_id = (int16_t)(1000 + random_below(30000)),
                                    .kind = (uint8_t)random_below(3),
                                    .count = 1};
                take_message(&look, now_us);
                forged++;
            }
            take_scan(id, scan, now_us);
            assert_int_equal(assembler.counters.scans_accepted, accepted + 1);
            assert_int_equal(take_all_items(now_us + HOLD_US), 1);
        }
    }
    assert_int_equal(assembler.counters.sensors_no_room, forged);
}

static void a_proven_sensor_off_the_clock_is_replaced(void **state)
{
    int32_t scan = 3;

    (void)state;
    start_assembler();
    fill_table(3);
    for (int i = 0; i < 3; i++, scan++) { /* the clock of sensor 1 is an hour ahead */
        struct look look = {.sensor_id = 1, .scan = scan, .time_us = (3600 + scan) * SECOND_US};
        take_message(&look, 3 * SECOND_US);
    }
    take_scan(1000, 0, 4 * SECOND_US);
    assert_int_equal(assembler.counters.sensors_no_room, 0);
    assert_int_equal(assembler.sources[1].sensor_id, 1000);
}

static void one_sensor_number_on_three_channels_is_three_sensors(void **state)
{
    (void)state;
    start_assembler();
    for (uint8_t kind = 0; kind < RHO_NUM_SCAN_ASSEMBLER_KINDS; kind++) {
        struct look look = {.sensor_id = 5, .kind = kind, .time_us = kind};
        take_message(&look, 0);
        assert_int_equal(take_all_items(INT64_MAX), 1);
    }
    COUNTERS_ARE(.scans_accepted = 3);
}

static void a_replaced_sensors_scan_is_still_given(void **state)
{
    struct look look = {.sensor_id = 500, .time_us = 5, .num_parts = 2, .count = 1};
    struct rho_scan_assembler_config config = usual_config();

    (void)state;
    config.hold_us = 10000000;
    start_assembler_with(&config);
    take_message(&look, 0);
    /* the last new sensor takes the place of this one */
    for (int16_t id = 0; id < RHO_MAX_SENSORS; id++) {
        look = (struct look){.sensor_id = id, .time_us = 4};
        take_message(&look, 1);
        expect_next_scan(1, id, 4);
        expect_no_scan(1);
        assert_int_equal(assembler.counters.scans_incomplete, id == RHO_MAX_SENSORS - 1);
    }
    expect_next_scan(20000000, 500, 5);
    assert_int_equal(item.parts_missing, 1);
    assert_int_equal(item.scan.num_plots, 1);
}

/* Slots of open scans */

static void without_room_the_oldest_scan_is_given_for_a_new_message(void **state)
{
    struct look look = {.count = 1, .num_parts = 2};
    struct rho_scan_assembler_bucket was;

    (void)state;
    start_assembler();
    for (int16_t id = 0; id < RHO_MAX_OPEN_SCANS; id++) {
        look.sensor_id = id;
        look.time_us = 100 - id;
        take_message(&look, 0);
        expect_no_scan(0);
    }
    look.sensor_id = 500;
    was = assembler.strangers;
    assert_int_equal(take_message_status(&look, 0), RHO_ERROR_CAPACITY);
    assert_memory_equal(&was, &assembler.strangers, sizeof was);
    COUNTERS_ARE(.scans_accepted = RHO_MAX_OPEN_SCANS);
    expect_next_scan(0, 0, 100); /* the first unproven sensor's scan */
    assert_int_equal(item.parts_missing, 1);
    /* the given scan is still read by the caller */
    assert_int_equal(take_message_status(&look, 0), RHO_ERROR_CAPACITY);
    assert_true(item.scan.plots[0].x_m == 0.0f);
    expect_no_scan(0); /* after this call its slot is free */
    take_message(&look, 0);
    COUNTERS_ARE(.scans_accepted = RHO_MAX_OPEN_SCANS + 1, .scans_incomplete = 1);
    expect_no_scan(0);
}

static void complete_scans_make_room_before_incomplete_ones(void **state)
{
    struct look open = {.sensor_id = 1, .time_us = 50, .num_parts = 2},
                whole = {.sensor_id = 2, .time_us = 90};

    (void)state;
    start_assembler();
    take_message(&open, 0);
    take_message(&whole, 0);
    for (int16_t id = 3; id < 3 + 2 * RHO_MAX_OPEN_SCANS; id++) {
        struct look more = {.sensor_id = id, .time_us = 90 + id};
        while (take_message_status(&more, 0) == RHO_ERROR_CAPACITY) {
            if (rho_scan_assembler_next(&assembler, 0, &item)) {
                assert_int_not_equal(item_sensor(), 1);
            }
        }
    }
    open.part = 1;
    take_message(&open, 0);
    COUNTERS_ARE(.scans_accepted = 2 + 2 * RHO_MAX_OPEN_SCANS);
}

static void unproven_sensors_end_no_incomplete_scan_of_proven_ones(void **state)
{
    const uint32_t known = 4 * RHO_MAX_OPEN_SCANS;

    (void)state;
    start_assembler();
    for (int32_t scan = 0; scan < 4; scan++) {
        for (int16_t id = 0; id < RHO_MAX_OPEN_SCANS; id++) {
            struct look look = {.sensor_id = id,
                                .scan = scan,
                                .time_us = scan * SECOND_US,
                                .num_parts = (int16_t)(scan == 3 ? 2 : 1)};
            take_message(&look, scan * SECOND_US);
        }
        assert_int_equal(take_all_items(scan * SECOND_US), scan == 3 ? 0 : RHO_MAX_OPEN_SCANS);
    }
    for (int16_t id = 100; id < 200; id++) {
        struct look look = {.sensor_id = id, .time_us = 3 * SECOND_US};
        take_message(&look, 3 * SECOND_US);
    }
    COUNTERS_ARE(.scans_accepted = known, .sensors_no_room = 100);
    expect_no_scan(3 * SECOND_US);
}

/*
 * Unproven sensors must not make proven ones' scans late by whole, newer scans that would be given
 * first for lack of room.
 */
static void unproven_sensors_make_no_scan_of_proven_ones_late(void **state)
{
    struct look open = {.sensor_id = 1, .scan = 4, .time_us = 4 * SECOND_US, .num_parts = 2};

    (void)state;
    start_assembler();
    for (int32_t scan = 1; scan < 4; scan++) {
        take_scan(1, scan, scan * SECOND_US);
        assert_int_equal(take_all_items(scan * SECOND_US), 1);
    }
    take_message(&open, 4 * SECOND_US);
    for (int16_t id = 100; id < 120; id++) {
        struct look look = {.sensor_id = id, .time_us = 4 * SECOND_US + id};

        take_message(&look, 4 * SECOND_US);
        expect_no_scan(4 * SECOND_US);
    }
    open.part = 1;
    take_message(&open, 4 * SECOND_US);
    expect_next_scan(4 * SECOND_US, 1, 4 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 3 + RHO_MAX_OPEN_SCANS,
                 .sensors_no_room = 20 - (RHO_MAX_OPEN_SCANS - 1));
}

/* For any messages, two calls of next make room. */
static void two_calls_of_next_always_make_room(void **state)
{
    unsigned pressed = 0;

    (void)state;
    start_assembler();
    random_state = 9;
    for (int32_t i = 0; i < 50000; i++) {
        struct look look = {.time_us = i * 100 + (int32_t)random_below(3000),
                            .scan = i / 20 + (int32_t)random_below(2),
                            .sensor_id = (int16_t)random_below(20),
                            .part = (int16_t)random_below(3),
                            .num_parts = 3,
                            .count = (uint16_t)random_below(3)};
        unsigned tries = 0;

        while (take_message_status(&look, i * 100) == RHO_ERROR_CAPACITY) {
            (void)rho_scan_assembler_next(&assembler, i * 100, &item);
            assert_true(++tries <= 2);
            pressed++;
        }
        if (random_below(50) == 0) {
            (void)take_all_items(i * 100);
        }
    }
    assert_in_range(pressed, 20, 100000);
}

/*
 * ---- plots beyond the capacities --------------------------------------------------------------
 */

static void of_too_many_plots_the_first_are_kept(void **state)
{
    enum { PARTS = 12, TOTAL = 34 * PARTS };
    unsigned order[PARTS];

    (void)state;
    random_state = 2;
    for (unsigned round = 0; round < 200 && TOTAL > RHO_MAX_PLOTS; round++) {
        start_assembler();
        for (unsigned i = 0; i < PARTS; i++) {
            unsigned at = random_below(i + 1);
            order[i] = order[at];
            order[at] = i;
        }
        for (unsigned i = 0; i < PARTS; i++) {
            struct look look = {.sensor_id = 1,
                                .part = (int16_t)order[i],
                                .num_parts = PARTS,
                                .count = 34,
                                .tag = (int32_t)order[i] * 34};
            take_message(&look, 0);
        }
        expect_next_scan(0, 1, 0);
        assert_int_equal(item.scan.num_plots, RHO_MAX_PLOTS);
        for (unsigned i = 0; i < RHO_MAX_PLOTS && i < TOTAL; i++) {
            assert_true(item.scan.plots[i].x_m == (float)i);
        }
        COUNTERS_ARE(.scans_accepted = 1,
                     .plots_no_room = TOTAL > RHO_MAX_PLOTS ? TOTAL - RHO_MAX_PLOTS : 0);
    }
}

static void of_too_many_bearings_the_first_are_kept(void **state)
{
    (void)state;
    for (uint16_t count = 0; count <= 256; count = (uint16_t)(count + 16)) {
        struct look look = {.sensor_id = 1, .kind = RHO_SCAN_ASSEMBLER_BEARINGS, .count = count};
        uint32_t kept = count < RHO_MAX_BEARINGS ? count : RHO_MAX_BEARINGS;

        start_assembler();
        take_message(&look, 0);
        expect_next_scan(0, 1, 0);
        assert_int_equal(item.bearings.num_bearings, kept);
        COUNTERS_ARE(.scans_accepted = 1, .bearings_in = count, .plots_no_room = count - kept);
    }
}

/* Refused messages and configurations */

static void only_channels_of_sensors_are_accepted(void **state)
{
    static const char *const others[] = {"",
                                         "RHO_PLOTS_",
                                         "RHO_PLOTS_01",
                                         "RHO_PLOTS_-0",
                                         "RHO_PLOTS_+1",
                                         "RHO_PLOTS",
                                         "RHO_PLOTS_1 ",
                                         "RHO_PLOTS_32768",
                                         "RHO_PLOTS_a",
                                         "RHO_PLOTS_-32769",
                                         "rho_plots_1",
                                         "RHO_PLOTS_1_",
                                         "RHO_POLARS_1",
                                         "RHO_TRACKS",
                                         "RHO_BEARING_1",
                                         "RHO_PLOTS_-",
                                         "RHO_PLOTS_--1",
                                         "RHO_PLOTS_99999999999999999999",
                                         "RHO_PLOTS_0x1"};
    static const struct {
        const char *channel;
        int16_t sensor_id;
    } good[] = {{"RHO_PLOTS_32767", 32767}, {"RHO_PLOTS_-32768", -32768}, {"RHO_PLOTS_0", 0}};
    uint8_t bytes[4] = {0};

    (void)state;
    start_assembler();
    before = assembler;
    for (unsigned i = 0; i < sizeof others / sizeof others[0]; i++) {
        assert_int_equal(take_bytes(others[i], bytes, sizeof bytes, 0), RHO_ERROR_TYPE);
        assert_memory_equal(&assembler, &before, sizeof assembler);
    }
    for (unsigned i = 0; i < 3; i++) {
        struct look look = {.sensor_id = good[i].sensor_id};
        uint8_t buffer[DATAGRAM];
        size_t size = pack_message(&look, buffer);

        assert_int_equal(take_bytes(good[i].channel, buffer, size, 0), RHO_OK);
        expect_next_scan(INT64_MAX, good[i].sensor_id, 0);
        expect_no_scan(0);
    }
}

static void bad_messages_are_counted_by_their_fault(void **state)
{
    struct look look = {.sensor_id = 1, .count = 3};
    uint8_t buffer[DATAGRAM + 1] = {0};
    size_t size;

    (void)state;
    for (look.kind = 0; look.kind < RHO_NUM_SCAN_ASSEMBLER_KINDS; look.kind++) {
        start_assembler();
        size = pack_message(&look, buffer);
        for (size_t length = 0; length <= size + 1; length++) {
            if (length != size) {
                assert_int_equal(take_bytes(channel_of(look.kind, 1), buffer, length, 0), RHO_OK);
            }
        }
        COUNTERS_ARE(.messages_bad = (uint32_t)size + 1);
        buffer[3] ^= 1;
        assert_int_equal(take_bytes(channel_of(look.kind, 1), buffer, size, 0), RHO_OK);
        buffer[3] ^= 1;
        assert_int_equal(take_bytes(channel_of((uint8_t)((look.kind + 1) % 3), 1), buffer, size, 0),
                         RHO_OK);
        COUNTERS_ARE(.messages_bad = (uint32_t)size + 1, .messages_wrong_type = 2);
        assert_int_equal(take_bytes(channel_of(look.kind, 2), buffer, size, 0), RHO_OK);
        COUNTERS_ARE(.messages_bad = (uint32_t)size + 2, .messages_wrong_type = 2);
        memset(buffer + size - 4, 0x7f, 4); /* the last value becomes no number, or out of range */
        memset(buffer + size - 2, 0xff, 2);
        assert_int_equal(take_bytes(channel_of(look.kind, 1), buffer, size, 0), RHO_OK);
        COUNTERS_ARE(.messages_bad = (uint32_t)size + 3, .messages_wrong_type = 2);
        expect_no_scan(INT64_MAX);
    }
}

static void expect_config_refused(struct rho_scan_assembler_config config)
{
    before = assembler;
    assert_int_equal(rho_scan_assembler_init(&assembler, sizeof assembler, &config),
                     RHO_ERROR_CONFIG);
    assert_memory_equal(&assembler, &before, sizeof assembler);
}

#define REFUSE(field, value)                                                                       \
    do {                                                                                           \
        struct rho_scan_assembler_config config = usual_config();                                  \
        config.field = (value);                                                                    \
        expect_config_refused(config);                                                             \
    } while (0)
#define ALLOW(field, value)                                                                        \
    do {                                                                                           \
        struct rho_scan_assembler_config config = usual_config();                                  \
        config.field = (value);                                                                    \
        start_assembler_with(&config);                                                             \
    } while (0)

static void configurations_beyond_their_ranges_are_refused(void **state)
{
    (void)state;
    ALLOW(hold_us, 0);
    ALLOW(hold_us, 10000000);
    REFUSE(hold_us, -1);
    REFUSE(hold_us, 10000001);
    ALLOW(late_max_us, 0);
    ALLOW(late_max_us, 60 * SECOND_US);
    REFUSE(late_max_us, -1);
    REFUSE(late_max_us, 60 * SECOND_US + 1);
    ALLOW(jump_max_us, 1000000);
    ALLOW(jump_max_us, 3600 * SECOND_US);
    REFUSE(jump_max_us, 999999);
    REFUSE(jump_max_us, 3600 * SECOND_US + 1);
    ALLOW(flood_per_s, 1);
    ALLOW(flood_per_s, 1000000);
    REFUSE(flood_per_s, 0);
    REFUSE(flood_per_s, 1000001);
    ALLOW(follow_scans, 2);
    ALLOW(follow_scans, 255);
    REFUSE(follow_scans, 1);
    REFUSE(follow_scans, 256);
    REFUSE(other.noise.sigma_m, 0.0f);
    REFUSE(other.noise.sigma_mps, -1.0f);
    REFUSE(other.noise.sigma_range_m, 2e5f);
    REFUSE(other.noise.sigma_range_rate_mps, 1e-4f);
    REFUSE(other.noise.sigma_azimuth_rad, 0.6f);
    REFUSE(other.noise.sigma_elevation_rad, 0.0f);
    REFUSE(other.noise.sigma_rad, 1e-7f);
    REFUSE(other.noise.sigma_m, 0.0f / 0.0f);
    REFUSE(other.sensor.x_m, 3e6f);
    REFUSE(other.sensor.azimuth_bias_rad, 1.0f);
}

static void bad_init_and_sensors_are_refused(void **state)
{
    struct rho_scan_assembler_config config = usual_config();
    struct rho_scan_assembler_sensor sensor = config.other;

    (void)state;
    memset(&assembler, 0x5a, sizeof assembler);
    assert_int_equal(rho_scan_assembler_set_sensor(&assembler, &sensor), RHO_ERROR_STATE);
    assert_int_equal(rho_scan_assembler_take(&assembler, "RHO_PLOTS_1", (const uint8_t *)"", 0, 0),
                     RHO_ERROR_STATE);
    assert_int_equal(rho_scan_assembler_next(&assembler, 0, &item), 0);
    assert_int_equal(rho_scan_assembler_due_us(&assembler), INT64_MAX);
    assert_int_equal(rho_scan_assembler_init(NULL, sizeof assembler, &config), RHO_ERROR_NULL);
    assert_int_equal(rho_scan_assembler_init(&assembler, sizeof assembler, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_scan_assembler_init(&assembler, sizeof assembler - 1, &config),
                     RHO_ERROR_SIZE);
    start_assembler();
    before = assembler;
    assert_int_equal(rho_scan_assembler_set_sensor(NULL, &sensor), RHO_ERROR_NULL);
    assert_int_equal(rho_scan_assembler_set_sensor(&assembler, NULL), RHO_ERROR_NULL);
    sensor.noise.sigma_m = 0.0f;
    assert_int_equal(rho_scan_assembler_set_sensor(&assembler, &sensor), RHO_ERROR_CONFIG);
    assert_int_equal(rho_scan_assembler_take(NULL, "RHO_PLOTS_1", (const uint8_t *)"", 0, 0),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_scan_assembler_take(&assembler, NULL, (const uint8_t *)"", 0, 0),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_scan_assembler_take(&assembler, "RHO_PLOTS_1", NULL, 0, 0),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_scan_assembler_next(NULL, 0, &item), 0);
    assert_int_equal(rho_scan_assembler_next(&assembler, 0, NULL), 0);
    assert_int_equal(rho_scan_assembler_due_us(NULL), INT64_MAX);
    assert_memory_equal(&assembler, &before, sizeof assembler);
    sensor = config.other;
    for (int32_t id = 0; id < RHO_MAX_SENSORS; id++) {
        sensor.sensor.sensor_id = id;
        assert_int_equal(rho_scan_assembler_set_sensor(&assembler, &sensor), RHO_OK);
    }
    sensor.sensor.sensor_id = 5;
    /* setting a sensor again replaces it */
    assert_int_equal(rho_scan_assembler_set_sensor(&assembler, &sensor), RHO_OK);
    sensor.sensor.sensor_id = RHO_MAX_SENSORS;
    before = assembler;
    assert_int_equal(rho_scan_assembler_set_sensor(&assembler, &sensor), RHO_ERROR_CAPACITY);
    assert_memory_equal(&assembler, &before, sizeof assembler);
}

static void a_copied_assembler_continues_like_the_original(void **state)
{
    static struct rho_scan_assembler copy;
    struct rho_scan_assembler_counters counters;

    (void)state;
    start_assembler();
    take_scan(1, 0, 0);
    take_scan(2, 0, 5);
    copy = assembler;
    for (int round = 0; round < 2; round++) {
        expect_next_scan(0, 1, 0);
        expect_next_scan(5 + HOLD_US, 2, 5);
        take_scan(1, 1, SECOND_US);
        expect_next_scan(INT64_MAX, 1, SECOND_US);
        expect_no_scan(INT64_MAX);
        if (round > 0) {
            assert_memory_equal(&counters, &assembler.counters, sizeof counters);
        }
        counters = assembler.counters;
        assembler = copy;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(messages_beyond_flood_per_s_are_not_read),
        cmocka_unit_test(unknown_sensors_share_one_flood_limit),
        cmocka_unit_test(a_reception_clock_set_back_refills_the_flood_limit),
        cmocka_unit_test(a_message_offered_again_counts_once_in_the_flood_limit),
        cmocka_unit_test(a_new_sensor_replaces_the_one_heard_longest_ago),
        cmocka_unit_test(proven_sensors_are_not_replaced_while_heard),
        cmocka_unit_test(forged_sensors_never_replace_proven_ones),
        cmocka_unit_test(a_proven_sensor_off_the_clock_is_replaced),
        cmocka_unit_test(one_sensor_number_on_three_channels_is_three_sensors),
        cmocka_unit_test(a_replaced_sensors_scan_is_still_given),
        cmocka_unit_test(without_room_the_oldest_scan_is_given_for_a_new_message),
        cmocka_unit_test(complete_scans_make_room_before_incomplete_ones),
        cmocka_unit_test(unproven_sensors_end_no_incomplete_scan_of_proven_ones),
        cmocka_unit_test(unproven_sensors_make_no_scan_of_proven_ones_late),
        cmocka_unit_test(two_calls_of_next_always_make_room),
        cmocka_unit_test(of_too_many_plots_the_first_are_kept),
        cmocka_unit_test(of_too_many_bearings_the_first_are_kept),
        cmocka_unit_test(only_channels_of_sensors_are_accepted),
        cmocka_unit_test(bad_messages_are_counted_by_their_fault),
        cmocka_unit_test(configurations_beyond_their_ranges_are_refused),
        cmocka_unit_test(bad_init_and_sensors_are_refused),
        cmocka_unit_test(a_copied_assembler_continues_like_the_original),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
