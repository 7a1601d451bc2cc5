/* SPDX-License-Identifier: MIT */
/*
 * ASTERIX put together to scans: turns and sectors, plots out of order, late or lost, midnight,
 * jumps, several radars.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "io/asterix/asterix_scans.h"

#define HZ ASTERIX_TIME_HZ
#define TURN_S 4 /* of the radar in these tests */

/* ---- A radar ---- */

static struct asterix_scans *open_scans(bool is_by_turn, double interval_s, double wait_s)
{
    const struct asterix_rules rules = {
        .hold_s = 1, .is_by_turn = is_by_turn, .interval_s = interval_s, .wait_s = wait_s};

    return asterix_scans_open(&rules);
}

static void take(struct asterix_scans *scans, uint8_t category, const uint8_t *bytes, size_t size)
{
    struct asterix_record record;
    struct asterix_error error;

    assert_true(asterix_record_read(category, bytes, size, &record, &error));
    assert_int_equal(record.size, size);
    asterix_scans_take_record(scans, &record);
}

/* Items 010, 140, 020, 040 of radar 0/sic; time of day in 1/128 s. */
static void plot_at(struct asterix_scans *scans, uint8_t sic, uint32_t time_128, uint16_t azimuth)
{
    const uint8_t bytes[] = {
        0xf0, 0,    sic,  (uint8_t)(time_128 >> 16), (uint8_t)(time_128 >> 8), (uint8_t)time_128,
        0x20, 0x10, 0x00, (uint8_t)(azimuth >> 8),   (uint8_t)azimuth};

    take(scans, ASTERIX_PLOTS, bytes, sizeof bytes);
}

/* Where the antenna is at that time: at north at whole turns since midnight. */
static uint16_t azimuth_at(uint32_t time_128)
{
    return (uint16_t)(time_128 % (TURN_S * HZ) * ASTERIX_TURN / (TURN_S * HZ));
}

static void plot(struct asterix_scans *scans, uint32_t time_128)
{
    plot_at(scans, 1, time_128, azimuth_at(time_128));
}

static void north(struct asterix_scans *scans, uint8_t sic, uint32_t time_128)
{
    const uint8_t bytes[] = {
        0xe0, 0, sic, 1, (uint8_t)(time_128 >> 16), (uint8_t)(time_128 >> 8), (uint8_t)time_128};

    take(scans, ASTERIX_SERVICE, bytes, sizeof bytes);
}

/* The antenna's crossing at that time, as a sector's. */
static void sector(struct asterix_scans *scans, uint32_t time_128)
{
    const uint8_t bytes[] = {0xf0,
                             0,
                             1,
                             2,
                             (uint8_t)(time_128 >> 16),
                             (uint8_t)(time_128 >> 8),
                             (uint8_t)time_128,
                             (uint8_t)(azimuth_at(time_128) >> 8)};

    take(scans, ASTERIX_SERVICE, bytes, sizeof bytes);
}

static void expect_scan(struct asterix_scans *scans, int64_t start_128, int64_t end_128,
                        size_t count)
{
    struct asterix_scan scan;

    assert_true(asterix_scans_next(scans, &scan));
    assert_int_equal(scan.look.start_128, start_128);
    assert_int_equal(scan.look.end_128, end_128);
    assert_int_equal(scan.count, count);
}

static void expect_none(struct asterix_scans *scans)
{
    struct asterix_scan scan;

    assert_false(asterix_scans_next(scans, &scan));
}

/* ---- Sectors ---- */

/*
 * Eight sectors a turn; plots come behind the next crossing's message, and before their own
 * sector's.
 */
static void test_sectors(void **state)
{
    struct asterix_scans *scans = open_scans(false, 0, 30);
    struct asterix_scan scan;

    (void)state;
    for (uint32_t i = 0; i < 24; i++) {
        uint32_t time_128 = 64 * i;

        sector(scans, time_128);
        if (i > 0 && i % 3 == 0) {
            plot(scans, time_128 - 1); /* of the sector before */
            plot(scans, time_128);     /* of the one that begins */
        }
    }
    asterix_scans_finish(scans);
    for (uint32_t i = 0; i < 23; i++) {
        size_t count = (i > 0 && i % 3 == 0) + ((i + 1) % 3 == 0);

        assert_true(asterix_scans_next(scans, &scan));
        assert_int_equal(scan.number, i + 1);
        assert_int_equal(scan.look.start_128, 64 * i);
        assert_int_equal(scan.look.from, 8192 * i % ASTERIX_TURN);
        assert_int_equal(scan.look.advance, 8192);
        assert_int_equal(scan.count, count);
        assert_false(scan.is_turn);
    }
    expect_none(scans);
    assert_int_equal(asterix_scans_counts(scans)->placed, 14);
    asterix_scans_close(scans);
}

/* The same as turns: empty ones too; a partial one at the end. */
static void test_turns_of_sectors(void **state)
{
    struct asterix_scans *scans = open_scans(true, 0, 30);

    (void)state;
    for (uint32_t i = 0; i < 21; i++) {
        sector(scans, 64 * i);
        if (i % 8 == 3 && i != 11) {
            plot(scans, 64 * i + 5);
        }
    }
    asterix_scans_finish(scans);
    expect_scan(scans, 0, 512, 1);
    expect_scan(scans, 512, 1024, 0);
    expect_scan(scans, 1024, 64 * 20, 1);
    expect_none(scans);
    asterix_scans_close(scans);
}

/* North markers alone: what came before the first one, and after the last, is part of a turn. */
static void test_north_markers(void **state)
{
    struct asterix_scans *scans = open_scans(true, 0, 30);
    struct asterix_scan scan;

    (void)state;
    plot(scans, 300);
    plot(scans, 400);
    for (uint32_t turn = 1; turn < 4; turn++) {
        north(scans, 1, 512 * turn);
        plot(scans, 512 * turn + 500);
        plot(scans, 512 * turn + 2); /* later than the one that was seen after it */
    }
    asterix_scans_finish(scans);
    assert_true(asterix_scans_next(scans, &scan));
    assert_int_equal(scan.look.start_128, 300);
    assert_int_equal(scan.look.end_128, 512);
    assert_int_equal(scan.count, 2);
    assert_false(scan.is_turn);
    for (uint32_t turn = 1; turn < 3; turn++) {
        assert_true(asterix_scans_next(scans, &scan));
        assert_true(scan.is_turn);
        assert_int_equal(scan.time_128, 512 * turn);
        assert_int_equal(scan.count, 2);
        assert_int_equal(scan.marks[0].time_128, 512 * turn + 2);
    }
    expect_scan(scans, 512 * 3, 512 * 3 + 500, 1); /* the antenna came as far as 500 */
    expect_none(scans);
    assert_int_equal(asterix_scans_counts(scans)->unplaced, 1);
    asterix_scans_close(scans);
}

/* A north marker and the sector crossing at north are one crossing. */
static void test_crossing_twice(void **state)
{
    struct asterix_scans *scans = open_scans(false, 0, 30);

    (void)state;
    for (uint32_t i = 0; i < 17; i++) {
        if (i % 8 == 0) {
            north(scans, 1, 64 * i);
        }
        sector(scans, 64 * i);
    }
    asterix_scans_finish(scans);
    for (uint32_t i = 0; i < 16; i++) {
        expect_scan(scans, 64 * i, 64 * i + 64, 0);
    }
    expect_none(scans);
    assert_int_equal(asterix_scans_counts(scans)->gaps, 0);
    asterix_scans_close(scans);
}

/*
 * A crossing that is lost joins two sectors; a turn without any is a gap, of which nothing is said.
 */
static void test_lost_crossings(void **state)
{
    struct asterix_scans *scans = open_scans(false, 0, 30);

    (void)state;
    for (uint32_t i = 0; i < 32; i++) {
        if (i != 5 && (i < 10 || i > 20)) {
            sector(scans, 64 * i);
        }
        if (i == 15) {
            plot(scans, 64 * i);
        }
    }
    asterix_scans_finish(scans);
    for (uint32_t i = 0; i < 4; i++) {
        expect_scan(scans, 64 * i, 64 * i + 64, 0);
    }
    expect_scan(scans, 64 * 4, 64 * 6, 0);
    for (uint32_t i = 6; i < 9; i++) {
        expect_scan(scans, 64 * i, 64 * i + 64, 0);
    }
    for (uint32_t i = 21; i < 31; i++) {
        expect_scan(scans, 64 * i, 64 * i + 64, 0);
    }
    expect_none(scans);
    assert_int_equal(asterix_scans_counts(scans)->gaps, 1);
    assert_int_equal(asterix_scans_counts(scans)->unplaced, 1);
    asterix_scans_close(scans);
}

/*
 * A sector is complete a second after its end; a plot of it that comes then is late, and counted.
 */
static void test_late(void **state)
{
    struct asterix_scans *scans = open_scans(false, 0, 30);

    (void)state;
    for (uint32_t i = 0; i <= 3; i++) {
        sector(scans, 64 * i);
    }
    expect_scan(scans, 0, 64, 0);
    expect_none(scans);
    assert_int_equal(asterix_scans_settled_time_128(scans), 64 - HZ);
    plot(scans, 70);
    sector(scans, 64 * 4);
    expect_scan(scans, 64, 128, 1);
    plot(scans, 64);
    plot(scans, 10);
    for (uint32_t i = 5; i <= 8; i++) {
        sector(scans, 64 * i);
    }
    plot(scans, 70);
    asterix_scans_finish(scans);
    assert_int_equal(asterix_scans_counts(scans)->unplaced, 2); /* just before what was complete */
    assert_int_equal(asterix_scans_counts(scans)->late, 1);
    assert_int_equal(asterix_scans_counts(scans)->placed, 1);
    asterix_scans_close(scans);
}

/* ---- Time ---- */

static void test_midnight(void **state)
{
    struct asterix_scans *scans = open_scans(true, 0, 30);
    const uint32_t day = ASTERIX_DAY;

    (void)state;
    north(scans, 1, day - 512);
    plot(scans, day - 3);
    north(scans, 1, 0);
    plot(scans, 100);
    plot(scans, day - 2); /* out of order over midnight */
    north(scans, 1, 512);
    asterix_scans_finish(scans);
    expect_scan(scans, (int64_t)day - 512, day, 2);
    expect_scan(scans, day, (int64_t)day + 512, 1);
    expect_none(scans);
    asterix_scans_close(scans);
}

/*
 * One wild time changes nothing; a pause of an hour is believed at the second time; going back is
 * not.
 */
static void test_jumps(void **state)
{
    struct asterix_scans *scans = open_scans(false, 0, 0);
    struct asterix_scan scan;
    const uint32_t hour = 3600 * HZ;
    size_t count = 0;

    (void)state;
    plot(scans, 1000);
    plot(scans, 5 * hour);
    plot(scans, 1100);
    plot(scans, hour);
    plot(scans, hour + 10);
    plot(scans, 1200);
    plot(scans, 1201);
    plot(scans, hour + 20);
    plot_at(scans, 1, ASTERIX_DAY, 0);
    asterix_scans_finish(scans);
    for (int64_t times[] = {1000, 1100, hour + 10, hour + 20}; asterix_scans_next(scans, &scan);
         count++) {
        assert_int_equal(scan.time_128, times[count]);
    }
    assert_int_equal(count, 4);
    assert_int_equal(asterix_scans_counts(scans)->bad_times, 5);
    asterix_scans_close(scans);
}

/* Near a time of another day. */
static void test_start(void **state)
{
    struct asterix_scans *scans = open_scans(false, 0, 0);
    struct asterix_scan scan;

    (void)state;
    asterix_scans_set_reference_time(scans, INT64_C(3) * ASTERIX_DAY - 50);
    plot(scans, 100);
    asterix_scans_finish(scans);
    assert_true(asterix_scans_next(scans, &scan));
    assert_int_equal(scan.time_128, INT64_C(3) * ASTERIX_DAY + 100);
    asterix_scans_close(scans);
    assert_int_equal(asterix_time_us(1), 7813);
    assert_int_equal(asterix_time_us(-128), -1000000);
}

/* ---- Radars ---- */

/* Without crossings: known after wait_s, then plots within interval_s are a scan. */
static void test_intervals(void **state)
{
    struct asterix_scans *scans = open_scans(true, 2, 3);

    (void)state;
    for (uint32_t i = 0; i < 30; i++) {
        plot(scans, 64 * i);
    }
    asterix_scans_finish(scans);
    for (uint32_t i = 0; i < 7; i++) {
        expect_scan(scans, 256 * i, 256 * i + 256, 4);
    }
    expect_scan(scans, 256 * 7, 256 * 8, 2);
    expect_none(scans);
    asterix_scans_close(scans);
}

/* Two radars, of which one falls silent: its scans come, and are not waited for. */
static void test_silent_radar(void **state)
{
    struct asterix_scans *scans = open_scans(true, 0, 30);
    struct asterix_scan scan;
    size_t of_second = 0;

    (void)state;
    for (uint32_t turn = 0; turn < 40; turn++) {
        north(scans, 1, 512 * turn);
        if (turn < 4) {
            north(scans, 2, 512 * turn + 256);
        }
    }
    while (asterix_scans_next(scans, &scan)) {
        of_second += scan.sensor_id == 2;
    }
    assert_int_equal(of_second, 3);
    assert_true(asterix_scans_settled_time_128(scans) > 512 * 36);
    asterix_scans_close(scans);
}

/* ---- What plots say ---- */

/* Items 010, 140, 020, 040, 090 and 120 (calculated). */
static void full_plot(struct asterix_scans *scans, uint32_t time_128, uint16_t level,
                      uint8_t doppler_flag, int doppler_mps)
{
    uint16_t azimuth = azimuth_at(time_128);
    const uint8_t bytes[] = {0xf5,
                             0x01,
                             0x04,
                             0,
                             1,
                             0,
                             (uint8_t)(time_128 >> 8),
                             (uint8_t)time_128,
                             0x20,
                             0x10,
                             0x00,
                             (uint8_t)(azimuth >> 8),
                             (uint8_t)azimuth,
                             (uint8_t)(level >> 8),
                             (uint8_t)level,
                             0x80,
                             (uint8_t)(doppler_flag | (doppler_mps >> 8 & 3)),
                             (uint8_t)doppler_mps};

    take(scans, ASTERIX_PLOTS, bytes, sizeof bytes);
}

/* All plots of a scan have a height and a speed, or none has; heights then correct the range. */
static void test_measures(void **state)
{
    struct asterix_scans *scans = open_scans(true, 0, 30);
    struct asterix_scan scan;

    (void)state;
    north(scans, 1, 0);
    full_plot(scans, 10, 400, 0, -100);
    full_plot(scans, 20, 0x3fff, 0, 511);
    north(scans, 1, 512);
    full_plot(scans, 530, 800, 0, 5);
    full_plot(scans, 540, 0x8000 | 800, 0x80, 5); /* not validated; doubtful */
    north(scans, 1, 1024);
    asterix_scans_finish(scans);
    assert_true(asterix_scans_next(scans, &scan));
    assert_true(scan.marks[0].has_alt && scan.marks[0].alt == 400);
    assert_true(scan.marks[1].has_alt && scan.marks[1].alt == -1);
    assert_true(scan.marks[0].has_doppler && scan.marks[0].doppler_mps == -100);
    assert_int_equal(scan.marks[1].doppler_mps, 511);
    assert_true(asterix_scans_next(scans, &scan));
    assert_false(scan.marks[0].has_alt || scan.marks[1].has_alt);
    assert_false(scan.marks[0].has_doppler || scan.marks[1].has_doppler);
    assert_false(scan.marks[1].is_ground);
    assert_true(scan.marks[0].is_ground);
    /*
     * 16 NM at 20,000 ft: a flat earth would give 29001.5 m; 67 m of curvature below it add some 14
     * m
     */
    assert_true(fabs(scan.marks[0].ground_m - 28997.4) < 20);
    assert_int_equal(asterix_scans_counts(scans)->levels_bad, 1);
    assert_int_equal(asterix_scans_counts(scans)->levels_left, 1);
    assert_int_equal(asterix_scans_counts(scans)->dopplers_bad, 1);
    assert_int_equal(asterix_scans_counts(scans)->dopplers_left, 1);
    asterix_scans_close(scans);
}

/* What is no plot of a target is left out and counted. */
static void test_left_out(void **state)
{
    struct asterix_scans *scans = open_scans(true, 0, 0);
    const uint8_t simulated[] = {0x20, 0x30}, fixed[] = {0x20, 0x22}, test[] = {0x20, 0x21, 0x80};
    const uint8_t beyond[] = {0x20, 0x21, 0x40}, none[] = {0x20, 0x00},
                  bare[] = {0xc0, 0, 1, 0, 0, 9};
    const uint8_t zero[] = {0xf0, 0, 1, 0, 0, 9, 0x20, 0, 0, 1, 1};

    (void)state;
    take(scans, ASTERIX_PLOTS, simulated, sizeof simulated);
    take(scans, ASTERIX_PLOTS, fixed, sizeof fixed);
    take(scans, ASTERIX_PLOTS, test, sizeof test);
    take(scans, ASTERIX_PLOTS, beyond, sizeof beyond);
    take(scans, ASTERIX_PLOTS, none, sizeof none);
    take(scans, ASTERIX_PLOTS, bare, sizeof bare);
    take(scans, ASTERIX_PLOTS, zero, sizeof zero);
    asterix_scans_finish(scans);
    expect_none(scans);
    assert_int_equal(asterix_scans_counts(scans)->plots, 7);
    assert_int_equal(asterix_scans_counts(scans)->not_real, 3);
    assert_int_equal(asterix_scans_counts(scans)->no_detection, 1);
    assert_int_equal(asterix_scans_counts(scans)->incomplete, 3);
    asterix_scans_close(scans);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sectors),        cmocka_unit_test(test_turns_of_sectors),
        cmocka_unit_test(test_north_markers),  cmocka_unit_test(test_crossing_twice),
        cmocka_unit_test(test_lost_crossings), cmocka_unit_test(test_late),
        cmocka_unit_test(test_midnight),       cmocka_unit_test(test_jumps),
        cmocka_unit_test(test_start),          cmocka_unit_test(test_intervals),
        cmocka_unit_test(test_silent_radar),   cmocka_unit_test(test_measures),
        cmocka_unit_test(test_left_out),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
