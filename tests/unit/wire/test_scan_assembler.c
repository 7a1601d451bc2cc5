/* SPDX-License-Identifier: MIT */
/* Parts joined to scans in any order, and scans of several sensors given in order of time. */
#include "scan_assembler_setup.h"

/* A part of scan 7 of sensor 3, of `num_parts`; part p has p + 1 plots, with tags from 100 p on. */
static struct look part_of_scan(int part, int num_parts)
{
    return (struct look){.time_us = 5 * SECOND_US,
                         .scan = 7,
                         .sensor_id = 3,
                         .part = (int16_t)part,
                         .num_parts = (int16_t)num_parts,
                         .count = (uint16_t)(part + 1),
                         .tag = 100 * part};
}

static void take_part_of_scan(int part, int num_parts, int64_t now_us)
{
    struct look look = part_of_scan(part, num_parts);

    take_message(&look, now_us);
}

/* The given scan holds the plots of these parts, in their order. */
static void expect_item_of_parts(unsigned mask, unsigned num_parts)
{
    unsigned row = 0;

    for (unsigned part = 0; part < num_parts; part++) {
        for (unsigned i = 0; (mask >> part & 1u) && i <= part; i++) {
            assert_true(item.scan.plots[row++].x_m == (float)(100 * part + i));
        }
    }
    assert_int_equal(item.scan.num_plots, row);
}

/*
 * ---- parts ------------------------------------------------------------------------------------
 */

static void parts_in_any_order_make_one_scan(void **state)
{
    unsigned order[5] = {0, 1, 2, 3, 4}, permutations = 0;
    unsigned swaps[5] = {0}, i = 0;

    (void)state;
    for (;;) { /* permutations by Heap's algorithm */
        start_assembler();
        for (unsigned k = 0; k < 5; k++) {
            expect_no_scan(0);
            take_part_of_scan((int)order[k], 5, 0);
        }
        expect_next_scan(0, 3, 5 * SECOND_US);
        assert_int_equal(item.parts_missing, 0);
        expect_item_of_parts(31, 5);
        expect_no_scan(INT64_MAX);
        COUNTERS_ARE(.scans_accepted = 1);
        permutations++;
        while (i < 5 && swaps[i] >= i) {
            swaps[i++] = 0;
        }
        if (i == 5) {
            break;
        }
        unsigned with = i % 2 ? swaps[i] : 0, kept = order[with];
        order[with] = order[i];
        order[i] = kept;
        swaps[i]++;
        i = 0;
    }
    assert_int_equal(permutations, 120);
}

static void an_incomplete_scan_is_given_after_hold(void **state)
{
    (void)state;
    for (unsigned mask = 1; mask < 15; mask++) {
        int64_t last_us = 0;

        start_assembler();
        for (int part = 3; part >= 0; part--) {
            if (mask >> part & 1u) {
                last_us = 1000 * (3 - part);
                take_part_of_scan(part, 4, last_us);
            }
        }
        assert_int_equal(rho_scan_assembler_due_us(&assembler), last_us + HOLD_US);
        expect_no_scan(last_us + HOLD_US - 1);
        COUNTERS_ARE(.scans_accepted = 1);
        expect_next_scan(last_us + HOLD_US, 3, 5 * SECOND_US);
        expect_item_of_parts(mask, 4);
        assert_int_equal(item.parts_missing, 4 - (int)rho_count_bits(mask));
        COUNTERS_ARE(.scans_accepted = 1, .scans_incomplete = 1);
        /* a part that comes too late, or a second time */
        take_part_of_scan(mask & 1u ? 1 : 0, 4, last_us + HOLD_US);
        COUNTERS_ARE(.scans_accepted = 1, .scans_incomplete = 1, .scans_duplicate = 1);
        expect_no_scan(INT64_MAX);
    }
}

static void a_newer_scan_ends_an_incomplete_one(void **state)
{
    struct look newer = part_of_scan(0, 1);

    (void)state;
    start_assembler();
    take_part_of_scan(0, 2, 0);
    newer.scan++;
    newer.time_us += SECOND_US;
    take_message(&newer, 0);
    expect_next_scan(0, 3, 5 * SECOND_US);
    assert_int_equal(item.parts_missing, 1);
    expect_next_scan(0, 3, 6 * SECOND_US);
    expect_no_scan(0);
    COUNTERS_ARE(.scans_accepted = 2, .scans_incomplete = 1);
    take_part_of_scan(1, 2, 0);
    COUNTERS_ARE(.scans_accepted = 2, .scans_incomplete = 1, .scans_duplicate = 1);
    expect_no_scan(INT64_MAX);
}

static void a_part_received_twice_counts_once(void **state)
{
    struct look other = part_of_scan(0, 2);

    (void)state;
    start_assembler();
    take_part_of_scan(0, 2, 0);
    take_part_of_scan(0, 2, 0);
    other.tag = 999; /* same part, other plots: the first copy counts */
    take_message(&other, 0);
    COUNTERS_ARE(.scans_accepted = 1, .scans_duplicate = 1, .scans_other = 1);
    take_part_of_scan(1, 2, 0);
    expect_next_scan(0, 3, 5 * SECOND_US);
    expect_item_of_parts(3, 2);
    take_part_of_scan(1, 2, 0);
    COUNTERS_ARE(.scans_accepted = 1, .scans_duplicate = 2, .scans_other = 1);
}

static void repeated_parts_do_not_prolong_the_hold(void **state)
{
    (void)state;
    start_assembler();
    take_part_of_scan(0, 2, 0);
    take_part_of_scan(0, 2, HOLD_US - 1);
    expect_next_scan(HOLD_US, 3, 5 * SECOND_US);
}

/* Takes a scan head of plots with one field changed. */
static void take_plot_scan_head(int64_t utime, int8_t kind, int16_t part, int16_t num_parts,
                                float from_rad, float to_rad)
{
    struct rho_message_plot_scan_head head = {.utime = utime,
                                              .scan = 7,
                                              .sensor_id = 3,
                                              .kind = kind,
                                              .part = part,
                                              .num_parts = num_parts,
                                              .sector_from_rad = from_rad,
                                              .sector_to_rad = to_rad};
    struct rho_message_writer writer;
    uint8_t buffer[DATAGRAM];

    assert_int_equal(rho_message_plot_scan_begin(&writer, buffer, sizeof buffer, &head), RHO_OK);
    assert_int_equal(take_bytes("RHO_PLOTS_3", buffer, end_message(&writer), 0), RHO_OK);
}

static void contradicting_parts_are_refused(void **state)
{
    (void)state;
    start_assembler();
    take_plot_scan_head(10, 2, 0, 2, -1.0f, 1.0f);
    take_plot_scan_head(11, 2, 1, 2, -1.0f, 1.0f);
    take_plot_scan_head(9, 2, 1, 2, -1.0f, 1.0f);
    take_plot_scan_head(10, 3, 1, 2, -1.0f, 1.0f);
    take_plot_scan_head(10, 4, 1, 2, -1.0f, 1.0f);
    take_plot_scan_head(10, 2, 1, 3, -1.0f, 1.0f);
    take_plot_scan_head(10, 2, 2, 3, -1.0f, 1.0f);
    take_plot_scan_head(10, 2, 1, 2, -1.5f, 1.0f);
    take_plot_scan_head(10, 2, 1, 2, -1.0f, 1.5f);
    COUNTERS_ARE(.scans_accepted = 1, .scans_bad = 8);
    expect_no_scan(0);
    take_plot_scan_head(10, 2, 1, 2, -1.0f, 1.0f);
    expect_next_scan(0, 3, 10);
    assert_true(item.scan.sector_from_rad == -1.0f && item.scan.sector_to_rad == 1.0f);
    assert_int_equal(item.scan.measures, 0);
    COUNTERS_ARE(.scans_accepted = 1, .scans_bad = 8);
}

/* A writer refuses such sectors, so their bytes replace those of a valid one. */
static void impossible_sectors_are_refused(void **state)
{
    static const uint8_t good[4] = {0xbf, 0x40, 0, 0};          /* valid: -0.75 */
    static const uint8_t bad[][4] = {{0x7f, 0xc0, 0, 0},        /* NaN */
                                     {0x7f, 0x80, 0, 0},        /* infinite */
                                     {0xff, 0x80, 0, 0},        /* minus infinity */
                                     {0x40, 0xca, 0, 0},        /* 6.3125 */
                                     {0xc0, 0xca, 0, 0},        /* -6.3125 */
                                     {0x7f, 0x7f, 0xff, 0xff}}; /* FLT_MAX */
    const struct rho_message_plot_scan_head heads[] = {
        {.sensor_id = 3, .num_parts = 1, .sector_from_rad = -0.75f, .sector_to_rad = 1.0f},
        {.sensor_id = 3, .num_parts = 1, .sector_from_rad = -1.0f, .sector_to_rad = -0.75f}};
    struct rho_message_writer writer;
    uint8_t buffer[DATAGRAM];
    uint32_t refused = 0;

    (void)state;
    start_assembler();
    for (size_t i = 0; i < 2; i++) {
        for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
            size_t at = 0;

            assert_int_equal(rho_message_plot_scan_begin(&writer, buffer, sizeof buffer, &heads[i]),
                             RHO_OK);
            const size_t size = end_message(&writer);
            while (at + 4 < size && memcmp(&buffer[at], good, 4) != 0) {
                at++;
            }
            assert_true(at + 4 < size);
            memcpy(&buffer[at], bad[k], 4);
            assert_int_equal(take_bytes("RHO_PLOTS_3", buffer, size, 0), RHO_OK);
            COUNTERS_ARE(.messages_bad = ++refused);
        }
    }
    expect_no_scan(SECOND_US);
}

static void take_polar_part_from(int part, float x_m, float y_m, float z_m)
{
    struct rho_message_polar_scan_head head = {.scan = 1,
                                               .sensor_id = 3,
                                               .part = (int16_t)part,
                                               .num_parts = 3,
                                               .sensor_x_m = x_m,
                                               .sensor_y_m = y_m,
                                               .sensor_z_m = z_m};
    struct rho_message_writer writer;
    uint8_t buffer[DATAGRAM];

    assert_int_equal(rho_message_polar_scan_begin(&writer, buffer, sizeof buffer, &head), RHO_OK);
    assert_int_equal(take_bytes("RHO_POLAR_3", buffer, end_message(&writer), 0), RHO_OK);
}

static void polar_parts_from_different_places_are_refused(void **state)
{
    (void)state;
    start_assembler();
    take_polar_part_from(0, 1.0f, 2.0f, 3.0f);
    take_polar_part_from(1, 1.5f, 2.0f, 3.0f);
    take_polar_part_from(1, 1.0f, 2.5f, 3.0f);
    take_polar_part_from(1, 1.0f, 2.0f, 3.5f);
    COUNTERS_ARE(.scans_accepted = 1, .scans_bad = 3);
    take_polar_part_from(1, 0.0f, 0.0f, 0.0f); /* another part without a place */
    take_polar_part_from(2, 1.0f, 2.0f, 3.0f);
    expect_next_scan(0, 3, 0);
    assert_true(item.sensor.x_m == 1.0f && item.sensor.y_m == 2.0f && item.sensor.z_m == 3.0f);
    assert_int_equal(item.has_sensor, 1);
    COUNTERS_ARE(.scans_accepted = 1, .scans_bad = 3);
}

static void parts_without_plots_count_as_parts(void **state)
{
    struct look look = part_of_scan(1, 2);

    (void)state;
    start_assembler();
    look.count = 0;
    take_message(&look, 0);
    take_message(&look, 0);
    COUNTERS_ARE(.scans_accepted = 1, .scans_duplicate = 1);
    take_part_of_scan(0, 2, 0);
    expect_next_scan(0, 3, 5 * SECOND_US);
    expect_item_of_parts(1, 2);
    assert_int_equal(item.parts_missing, 0);
}

static void parts_beyond_the_capacity_are_refused(void **state)
{
    (void)state;
    start_assembler();
    take_part_of_scan(0, RHO_MAX_PARTS + 1, 0);
    COUNTERS_ARE(.scans_bad = 1);
    take_part_of_scan(RHO_MAX_PARTS - 1 < 33 ? RHO_MAX_PARTS - 1 : 33, RHO_MAX_PARTS, 0);
    COUNTERS_ARE(.scans_bad = 1, .scans_accepted = 1);
    expect_next_scan(INT64_MAX, 3, 5 * SECOND_US);
    assert_int_equal(item.parts_missing, RHO_MAX_PARTS - 1);
}

/* Order of scans from several sensors */

static void scans_of_a_single_sensor_are_given_at_once(void **state)
{
    (void)state;
    start_assembler();
    for (int32_t scan = 0; scan < 10; scan++) {
        take_scan(1, scan, scan * SECOND_US);
        expect_next_scan(scan * SECOND_US, 1, scan * SECOND_US);
        assert_int_equal(item.is_restart, 0);
        assert_int_equal(rho_scan_assembler_due_us(&assembler), INT64_MAX);
    }
    COUNTERS_ARE(.scans_accepted = 10);
}

static void a_scan_waits_for_older_ones_of_another_sensor(void **state)
{
    struct look look = {.time_us = 2 * SECOND_US, .scan = 2, .sensor_id = 1};
    int64_t now_us = 2 * SECOND_US;

    (void)state;
    start_assembler();
    take_scan(1, 1, SECOND_US);
    take_scan(2, 1, SECOND_US + 1);
    assert_int_equal(take_all_items(INT64_MAX), 2);
    take_message(&look, now_us); /* sensor 1 may still send a scan a microsecond before this one */
    expect_no_scan(now_us + HOLD_US - 1);
    assert_int_equal(rho_scan_assembler_due_us(&assembler), now_us + HOLD_US);
    look = (struct look){.time_us = 2 * SECOND_US - 1, .scan = 2, .sensor_id = 2};
    take_message(&look, now_us + 100);
    expect_next_scan(now_us + 100, 2, 2 * SECOND_US - 1);
    expect_no_scan(now_us + 100); /* the other sensor's newest scan is older */
    expect_next_scan(now_us + HOLD_US, 1, 2 * SECOND_US);
    COUNTERS_ARE(.scans_accepted = 4);
}

static void scans_of_equal_time_are_given_at_once(void **state)
{
    (void)state;
    start_assembler();
    take_scan(9, 1, SECOND_US);
    take_scan(-4, 1, SECOND_US);
    expect_next_scan(SECOND_US, -4, SECOND_US); /* of equal times the lower sensor number first */
    expect_next_scan(SECOND_US, 9, SECOND_US);
    expect_no_scan(INT64_MAX);
}

static void plots_are_given_before_bearings_of_the_same_time(void **state)
{
    (void)state;
    start_assembler();
    for (int kind = RHO_NUM_SCAN_ASSEMBLER_KINDS - 1; kind >= 0; kind--) {
        struct look look = {
            .time_us = 7, .scan = kind, .sensor_id = 5, .kind = (uint8_t)kind, .count = 1};
        if (kind > 0 || RHO_MAX_OPEN_SCANS > 2) {
            take_message(&look, 0);
        }
    }
    for (int kind = RHO_MAX_OPEN_SCANS > 2 ? 0 : 1; kind < RHO_NUM_SCAN_ASSEMBLER_KINDS; kind++) {
        expect_next_scan(0, 5, 7);
        assert_int_equal(item.kind, kind);
    }
    expect_no_scan(INT64_MAX);
}

static void a_newer_scan_waits_for_an_older_incomplete_one(void **state)
{
    struct look look = part_of_scan(0, 2),
                later = {.time_us = 5 * SECOND_US + 1, .scan = 1, .sensor_id = 4};

    (void)state;
    start_assembler();
    take_message(&look, 0);
    take_message(&later, 0);
    expect_no_scan(HOLD_US - 2);
    take_part_of_scan(1, 2, HOLD_US - 2);
    expect_next_scan(HOLD_US - 2, 3, 5 * SECOND_US);
    expect_no_scan(HOLD_US - 1); /* the other sensor's newest scan is older */
    expect_next_scan(HOLD_US, 4, 5 * SECOND_US + 1);
}

/*
 * If the complete scan were given first, the incomplete older ones would be late for the tracker.
 */
static void scans_are_given_by_time_when_the_newest_was_held(void **state)
{
    const unsigned num_older = RHO_MAX_OPEN_SCANS > 2 ? 2 : 1;
    struct look older[2] = {part_of_scan(0, 2), part_of_scan(1, 2)},
                later = {.time_us = 5 * SECOND_US + 2, .scan = 1, .sensor_id = 2};

    (void)state;
    start_assembler();
    older[1].sensor_id = 1;
    older[1].time_us++;
    take_message(&later, 0);
    for (unsigned i = num_older; i-- > 0;) {
        take_message(&older[i], 7);
    }
    expect_no_scan(HOLD_US - 1);
    assert_int_equal(rho_scan_assembler_due_us(&assembler), HOLD_US);
    for (unsigned i = 0; i < num_older; i++) {
        expect_next_scan(HOLD_US, older[i].sensor_id, older[i].time_us);
        assert_int_equal(item.parts_missing, 1);
    }
    expect_next_scan(HOLD_US, 2, later.time_us);
    expect_no_scan(INT64_MAX);
    COUNTERS_ARE(.scans_accepted = num_older + 1, .scans_incomplete = num_older);
}

/* The newer scan has waited for hold: nothing is held longer, and no due time is in the past. */
static void an_older_scan_received_later_does_not_prolong_the_hold(void **state)
{
    struct look older = {.time_us = 2 * SECOND_US, .scan = 2, .sensor_id = 1};
    int64_t now_us = 2 * SECOND_US + 1;

    (void)state;
    start_assembler();
    for (int16_t sensor_id = 1; sensor_id <= 3; sensor_id++) {
        take_scan(sensor_id, 1, SECOND_US + sensor_id);
        assert_int_equal(take_all_items(INT64_MAX), 1);
    }
    take_scan(2, 2, now_us);
    take_message(&older, now_us + HOLD_US / 2);
    expect_no_scan(now_us + HOLD_US - 1); /* the third sensor has sent no scan of this time */
    assert_int_equal(rho_scan_assembler_due_us(&assembler), now_us + HOLD_US);
    expect_next_scan(now_us + HOLD_US, 1, older.time_us);
    expect_next_scan(now_us + HOLD_US, 2, now_us);
    COUNTERS_ARE(.scans_accepted = 5);
}

/* A scan of equal time would not be late. */
static void a_given_scan_does_not_end_incomplete_newer_ones(void **state)
{
    struct look part = part_of_scan(0, 2),
                first = {.time_us = 5 * SECOND_US, .scan = 1, .sensor_id = 9};

    (void)state;
    start_assembler();
    take_message(&first, 0);
    take_message(&part, 5);
    expect_next_scan(HOLD_US, 9, first.time_us);
    expect_no_scan(HOLD_US);
    take_part_of_scan(1, 2, HOLD_US);
    expect_next_scan(HOLD_US, part.sensor_id, part.time_us);
    assert_int_equal(item.parts_missing, 0);
}

static void hold_0_gives_scans_at_once(void **state)
{
    struct rho_scan_assembler_config config = usual_config();
    struct look look = part_of_scan(0, 2);

    (void)state;
    config.hold_us = 0;
    start_assembler_with(&config);
    take_message(&look, 0);
    assert_int_equal(rho_scan_assembler_due_us(&assembler), INT64_MAX);
    expect_no_scan(INT64_MAX - 1); /* with hold INT64_MAX, parts wait only for a newer scan */
    take_scan(4, 1, 6 * SECOND_US);
    expect_next_scan(6 * SECOND_US, 4, 6 * SECOND_US);
    expect_no_scan(6 * SECOND_US);
    look.scan++;
    look.time_us += 2 * SECOND_US;
    take_message(&look, 7 * SECOND_US);
    expect_next_scan(7 * SECOND_US, 3, 5 * SECOND_US);
    expect_no_scan(7 * SECOND_US);
    expect_next_scan(INT64_MAX, 3, 7 * SECOND_US);
}

static void a_dead_sensor_delays_others_by_hold_at_most(void **state)
{
    unsigned waited = 0;

    (void)state;
    start_assembler();
    take_scan(1, 0, 0);
    take_scan(2, 0, 0);
    assert_int_equal(take_all_items(0), 2);
    for (int32_t scan = 1; scan <= 60; scan++) {
        int64_t now_us = scan * SECOND_US;

        take_scan(1, scan, now_us);
        if (!rho_scan_assembler_next(&assembler, now_us, &item)) {
            expect_next_scan(now_us + HOLD_US, 1, now_us);
            waited++;
        }
    }
    assert_int_equal(waited, 30); /* held as long as an older scan may still come */
    COUNTERS_ARE(.scans_accepted = 62);
}

/* Sensors of several intervals and delays, all within hold: scans are given in order of time. */
static void delays_within_hold_are_put_in_order(void **state)
{
    enum { SENSORS = RHO_MAX_OPEN_SCANS < 3 ? RHO_MAX_OPEN_SCANS : 3, STEPS = 4000 };
    static const int64_t interval_us[3] = {100000, 70000, 330000};
    static struct {
        int64_t at_us, time_us;
        int32_t scan;
    } due[SENSORS];
    int64_t last_us = INT64_MIN;
    unsigned in = 0, out = 0;

    (void)state;
    start_assembler();
    random_state = 5;
    for (int64_t now_us = 0; now_us < STEPS * 10000; now_us += 1000) {
        for (unsigned s = 0; s < SENSORS; s++) {
            if (now_us % interval_us[s] == 0) {
                due[s].at_us = now_us + random_below((uint32_t)HOLD_US / 1000) * 1000;
                due[s].time_us = now_us;
            }
            if (due[s].at_us == now_us && due[s].time_us >= 0) {
                struct look look = {.time_us = due[s].time_us,
                                    .scan = ++due[s].scan,
                                    .sensor_id = (int16_t)s,
                                    .count = 2};
                take_message(&look, now_us);
                due[s].time_us = -1;
                in++;
            }
        }
        while (rho_scan_assembler_next(&assembler, now_us, &item)) {
            assert_true(item.scan.time_us >= last_us);
            last_us = item.scan.time_us;
            out++;
        }
    }
    out += take_all_items(INT64_MAX);
    assert_int_equal(in, out);
    assert_int_equal(assembler.counters.scans_accepted, in);
}

static void a_reception_clock_set_back_holds_no_scan(void **state)
{
    (void)state;
    start_assembler();
    take_scan(1, 0, 0);
    take_scan(2, 0, 0);
    assert_int_equal(take_all_items(0), 2);
    take_scan(1, 1, 10 * SECOND_US);
    expect_no_scan(10 * SECOND_US - HOLD_US);
    expect_next_scan(10 * SECOND_US - HOLD_US - 1, 1, 10 * SECOND_US);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_in_any_order_make_one_scan),
        cmocka_unit_test(an_incomplete_scan_is_given_after_hold),
        cmocka_unit_test(a_newer_scan_ends_an_incomplete_one),
        cmocka_unit_test(a_part_received_twice_counts_once),
        cmocka_unit_test(repeated_parts_do_not_prolong_the_hold),
        cmocka_unit_test(contradicting_parts_are_refused),
        cmocka_unit_test(impossible_sectors_are_refused),
        cmocka_unit_test(polar_parts_from_different_places_are_refused),
        cmocka_unit_test(parts_without_plots_count_as_parts),
        cmocka_unit_test(parts_beyond_the_capacity_are_refused),
        cmocka_unit_test(scans_of_a_single_sensor_are_given_at_once),
        cmocka_unit_test(a_scan_waits_for_older_ones_of_another_sensor),
        cmocka_unit_test(scans_of_equal_time_are_given_at_once),
        cmocka_unit_test(plots_are_given_before_bearings_of_the_same_time),
        cmocka_unit_test(a_newer_scan_waits_for_an_older_incomplete_one),
        cmocka_unit_test(scans_are_given_by_time_when_the_newest_was_held),
        cmocka_unit_test(an_older_scan_received_later_does_not_prolong_the_hold),
        cmocka_unit_test(a_given_scan_does_not_end_incomplete_newer_ones),
        cmocka_unit_test(hold_0_gives_scans_at_once),
        cmocka_unit_test(a_dead_sensor_delays_others_by_hold_at_most),
        cmocka_unit_test(delays_within_hold_are_put_in_order),
        cmocka_unit_test(a_reception_clock_set_back_holds_no_scan),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
