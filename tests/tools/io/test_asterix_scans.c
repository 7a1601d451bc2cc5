/* SPDX-License-Identifier: MIT */
/*
 * ASTERIX messages put together to scans: turns and sectors, plots out of order, late or lost,
 * midnight, time jumps, several radars.
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
#define TURN_S 4 /* turn of the simulated radar, in seconds */

static struct asterix_scans *open_asterix_scans(bool is_by_turn, double interval_s, double wait_s)
{
    const struct asterix_rules rules = {
        .hold_s = 1, .is_by_turn = is_by_turn, .interval_s = interval_s, .wait_s = wait_s};

    return asterix_scans_open(&rules);
}

static void take_record(struct asterix_scans *scans, uint8_t category, const uint8_t *bytes,
                        size_t size)
{
    struct asterix_record record;
    struct asterix_error error;

    assert_true(asterix_record_read(category, bytes, size, &record, &error));
    assert_int_equal(record.size, size);
    asterix_scans_take_record(scans, &record);
}

/* Takes a plot with items 010, 140, 020, 040 of radar 0/sic; time of day in 1/128 s. */
static void take_plot_at(struct asterix_scans *scans, uint8_t sic, uint32_t time_128,
                         uint16_t azimuth)
{
    const uint8_t bytes[] = {
        0xf0, 0,    sic,  (uint8_t)(time_128 >> 16), (uint8_t)(time_128 >> 8), (uint8_t)time_128,
        0x20, 0x10, 0x00, (uint8_t)(azimuth >> 8),   (uint8_t)azimuth};

    take_record(scans, ASTERIX_PLOTS, bytes, sizeof bytes);
}

/* Azimuth of the antenna at a time: north at whole turns since midnight. */
static uint16_t antenna_azimuth_at(uint32_t time_128)
{
    return (uint16_t)(time_128 % (TURN_S * HZ) * ASTERIX_TURN / (TURN_S * HZ));
}

static void take_plot_at_antenna(struct asterix_scans *scans, uint32_t time_128)
{
    take_plot_at(scans, 1, time_128, antenna_azimuth_at(time_128));
}

static void take_north_marker(struct asterix_scans *scans, uint8_t sic, uint32_t time_128)
{
    const uint8_t bytes[] = {
        0xe0, 0, sic, 1, (uint8_t)(time_128 >> 16), (uint8_t)(time_128 >> 8), (uint8_t)time_128};

    take_record(scans, ASTERIX_SERVICE, bytes, sizeof bytes);
}

/* Takes the sector crossing message of the antenna at that time. */
static void take_sector_crossing(struct asterix_scans *scans, uint32_t time_128)
{
    const uint8_t bytes[] = {0xf0,
                             0,
                             1,
                             2,
                             (uint8_t)(time_128 >> 16),
                             (uint8_t)(time_128 >> 8),
                             (uint8_t)time_128,
                             (uint8_t)(antenna_azimuth_at(time_128) >> 8)};

    take_record(scans, ASTERIX_SERVICE, bytes, sizeof bytes);
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

static void expect_no_scan(struct asterix_scans *scans)
{
    struct asterix_scan scan;

    assert_false(asterix_scans_next(scans, &scan));
}

/*
 * Eight sectors a turn; plots come after the next sector's crossing message, some before that of
 * their own sector.
 */
static void test_sector_crossings_make_a_scan_each(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(false, 0, 30);
    struct asterix_scan scan;

    (void)state;
    for (uint32_t i = 0; i < 24; i++) {
        uint32_t time_128 = 64 * i;

        take_sector_crossing(scans, time_128);
        if (i > 0 && i % 3 == 0) {
            take_plot_at_antenna(scans, time_128 - 1); /* belongs to the sector before */
            take_plot_at_antenna(scans, time_128);     /* belongs to the sector that begins */
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
    expect_no_scan(scans);
    assert_int_equal(asterix_scans_counts(scans)->placed, 14);
    asterix_scans_close(scans);
}

/* The same messages joined to turns: some without plots, the last one partial. */
static void test_sectors_are_joined_to_turns(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(true, 0, 30);

    (void)state;
    for (uint32_t i = 0; i < 21; i++) {
        take_sector_crossing(scans, 64 * i);
        if (i % 8 == 3 && i != 11) {
            take_plot_at_antenna(scans, 64 * i + 5);
        }
    }
    asterix_scans_finish(scans);
    expect_scan(scans, 0, 512, 1);
    expect_scan(scans, 512, 1024, 0);
    expect_scan(scans, 1024, 64 * 20, 1);
    expect_no_scan(scans);
    asterix_scans_close(scans);
}

/* North markers alone: plots before the first marker and after the last one are parts of a turn. */
static void test_north_markers_alone_make_turns(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(true, 0, 30);
    struct asterix_scan scan;

    (void)state;
    take_plot_at_antenna(scans, 300);
    take_plot_at_antenna(scans, 400);
    for (uint32_t turn = 1; turn < 4; turn++) {
        take_north_marker(scans, 1, 512 * turn);
        take_plot_at_antenna(scans, 512 * turn + 500);
        take_plot_at_antenna(scans, 512 * turn + 2); /* later than the plot seen after it */
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
    /* the partial turn ends at the last plot's time, 500 */
    expect_scan(scans, 512 * 3, 512 * 3 + 500, 1);
    expect_no_scan(scans);
    assert_int_equal(asterix_scans_counts(scans)->unplaced, 1);
    asterix_scans_close(scans);
}

/* A north marker and the sector crossing at north are one crossing of the antenna. */
static void test_north_marker_and_sector_crossing_count_once(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(false, 0, 30);

    (void)state;
    for (uint32_t i = 0; i < 17; i++) {
        if (i % 8 == 0) {
            take_north_marker(scans, 1, 64 * i);
        }
        take_sector_crossing(scans, 64 * i);
    }
    asterix_scans_finish(scans);
    for (uint32_t i = 0; i < 16; i++) {
        expect_scan(scans, 64 * i, 64 * i + 64, 0);
    }
    expect_no_scan(scans);
    assert_int_equal(asterix_scans_counts(scans)->gaps, 0);
    asterix_scans_close(scans);
}

/*
 * A lost crossing message joins two sectors; a turn without any crossing is a gap without a scan.
 */
static void test_a_lost_crossing_joins_two_sectors(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(false, 0, 30);

    (void)state;
    for (uint32_t i = 0; i < 32; i++) {
        if (i != 5 && (i < 10 || i > 20)) {
            take_sector_crossing(scans, 64 * i);
        }
        if (i == 15) {
            take_plot_at_antenna(scans, 64 * i);
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
    expect_no_scan(scans);
    assert_int_equal(asterix_scans_counts(scans)->gaps, 1);
    assert_int_equal(asterix_scans_counts(scans)->unplaced, 1);
    asterix_scans_close(scans);
}

/* A sector is complete a second after its end; plots of it that come later are counted as late. */
static void test_late_plots_are_counted(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(false, 0, 30);

    (void)state;
    for (uint32_t i = 0; i <= 3; i++) {
        take_sector_crossing(scans, 64 * i);
    }
    expect_scan(scans, 0, 64, 0);
    expect_no_scan(scans);
    assert_int_equal(asterix_scans_settled_time_128(scans), 64 - HZ);
    take_plot_at_antenna(scans, 70);
    take_sector_crossing(scans, 64 * 4);
    expect_scan(scans, 64, 128, 1);
    take_plot_at_antenna(scans, 64);
    take_plot_at_antenna(scans, 10);
    for (uint32_t i = 5; i <= 8; i++) {
        take_sector_crossing(scans, 64 * i);
    }
    take_plot_at_antenna(scans, 70);
    asterix_scans_finish(scans);
    /* plots just before the completed scan */
    assert_int_equal(asterix_scans_counts(scans)->unplaced, 2);
    assert_int_equal(asterix_scans_counts(scans)->late, 1);
    assert_int_equal(asterix_scans_counts(scans)->placed, 1);
    asterix_scans_close(scans);
}

static void test_time_of_day_passes_midnight(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(true, 0, 30);
    const uint32_t day = ASTERIX_DAY;

    (void)state;
    take_north_marker(scans, 1, day - 512);
    take_plot_at_antenna(scans, day - 3);
    take_north_marker(scans, 1, 0);
    take_plot_at_antenna(scans, 100);
    take_plot_at_antenna(scans, day - 2); /* out of order across midnight */
    take_north_marker(scans, 1, 512);
    asterix_scans_finish(scans);
    expect_scan(scans, (int64_t)day - 512, day, 2);
    expect_scan(scans, day, (int64_t)day + 512, 1);
    expect_no_scan(scans);
    asterix_scans_close(scans);
}

/*
 * One wild time is ignored; a pause of an hour is believed at its second message; going back in
 * time is not.
 */
static void test_a_single_wild_time_is_ignored(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(false, 0, 0);
    struct asterix_scan scan;
    const uint32_t hour = 3600 * HZ;
    size_t count = 0;

    (void)state;
    take_plot_at_antenna(scans, 1000);
    take_plot_at_antenna(scans, 5 * hour);
    take_plot_at_antenna(scans, 1100);
    take_plot_at_antenna(scans, hour);
    take_plot_at_antenna(scans, hour + 10);
    take_plot_at_antenna(scans, 1200);
    take_plot_at_antenna(scans, 1201);
    take_plot_at_antenna(scans, hour + 20);
    take_plot_at(scans, 1, ASTERIX_DAY, 0);
    asterix_scans_finish(scans);
    for (int64_t times[] = {1000, 1100, hour + 10, hour + 20}; asterix_scans_next(scans, &scan);
         count++) {
        assert_int_equal(scan.time_128, times[count]);
    }
    assert_int_equal(count, 4);
    assert_int_equal(asterix_scans_counts(scans)->bad_times, 5);
    asterix_scans_close(scans);
}

/* The first time of day is put on the day nearest to the reference time. */
static void test_day_of_the_first_plot_follows_the_reference_time(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(false, 0, 0);
    struct asterix_scan scan;

    (void)state;
    asterix_scans_set_day(scans, INT64_C(3) * ASTERIX_DAY - 50);
    take_plot_at_antenna(scans, 100);
    asterix_scans_finish(scans);
    assert_true(asterix_scans_next(scans, &scan));
    assert_int_equal(scan.time_128, INT64_C(3) * ASTERIX_DAY + 100);
    asterix_scans_close(scans);
    assert_int_equal(asterix_time_us(1), 7813);
    assert_int_equal(asterix_time_us(-128), -1000000);
}

/*
 * A radar without crossings is known as such after wait_s; then plots within interval_s are a scan.
 */
static void test_plots_without_crossings_are_cut_by_interval(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(true, 2, 3);

    (void)state;
    for (uint32_t i = 0; i < 30; i++) {
        take_plot_at_antenna(scans, 64 * i);
    }
    asterix_scans_finish(scans);
    for (uint32_t i = 0; i < 7; i++) {
        expect_scan(scans, 256 * i, 256 * i + 256, 4);
    }
    expect_scan(scans, 256 * 7, 256 * 8, 2);
    expect_no_scan(scans);
    asterix_scans_close(scans);
}

/*
 * One of two radars falls silent: its scans are still completed, and the other does not wait for
 * it.
 */
static void test_a_silent_radar_is_not_waited_for(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(true, 0, 30);
    struct asterix_scan scan;
    size_t of_second = 0;

    (void)state;
    for (uint32_t turn = 0; turn < 40; turn++) {
        take_north_marker(scans, 1, 512 * turn);
        if (turn < 4) {
            take_north_marker(scans, 2, 512 * turn + 256);
        }
    }
    while (asterix_scans_next(scans, &scan)) {
        of_second += scan.sensor_id == 2;
    }
    assert_int_equal(of_second, 3);
    assert_true(asterix_scans_settled_time_128(scans) > 512 * 36);
    asterix_scans_close(scans);
}

/* Takes a plot with items 010, 140, 020, 040, 090 (flight level) and 120 (calculated Doppler). */
static void take_plot_with_height_and_doppler(struct asterix_scans *scans, uint32_t time_128,
                                              uint16_t level, uint8_t doppler_flag, int doppler_mps)
{
    uint16_t azimuth = antenna_azimuth_at(time_128);
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

    take_record(scans, ASTERIX_PLOTS, bytes, sizeof bytes);
}

/*
 * All plots of a scan have a height and a speed, or none has; heights correct the slant range to
 * ground.
 */
static void test_all_plots_of_a_scan_measure_the_same(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(true, 0, 30);
    struct asterix_scan scan;

    (void)state;
    take_north_marker(scans, 1, 0);
    take_plot_with_height_and_doppler(scans, 10, 400, 0, -100);
    take_plot_with_height_and_doppler(scans, 20, 0x3fff, 0, 511);
    take_north_marker(scans, 1, 512);
    take_plot_with_height_and_doppler(scans, 530, 800, 0, 5);
    /* flight level not validated; Doppler speed doubtful */
    take_plot_with_height_and_doppler(scans, 540, 0x8000 | 800, 0x80, 5);
    take_north_marker(scans, 1, 1024);
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
     * 16 NM at 20,000 ft: on a flat earth 29001.5 m; 67 m of curvature below the radar's level add
     * about 14 m
     */
    assert_true(fabs(scan.marks[0].ground_m - 28997.4) < 20);
    assert_int_equal(asterix_scans_counts(scans)->levels_bad, 1);
    assert_int_equal(asterix_scans_counts(scans)->levels_left, 1);
    assert_int_equal(asterix_scans_counts(scans)->dopplers_bad, 1);
    assert_int_equal(asterix_scans_counts(scans)->dopplers_left, 1);
    asterix_scans_close(scans);
}

/* Messages that are no plot of a target are left out and counted. */
static void test_what_is_no_target_plot_is_left_out(void **state)
{
    struct asterix_scans *scans = open_asterix_scans(true, 0, 0);
    const uint8_t simulated[] = {0x20, 0x30}, fixed[] = {0x20, 0x22}, test[] = {0x20, 0x21, 0x80};
    const uint8_t beyond[] = {0x20, 0x21, 0x40}, none[] = {0x20, 0x00},
                  bare[] = {0xc0, 0, 1, 0, 0, 9};
    const uint8_t zero[] = {0xf0, 0, 1, 0, 0, 9, 0x20, 0, 0, 1, 1};

    (void)state;
    take_record(scans, ASTERIX_PLOTS, simulated, sizeof simulated);
    take_record(scans, ASTERIX_PLOTS, fixed, sizeof fixed);
    take_record(scans, ASTERIX_PLOTS, test, sizeof test);
    take_record(scans, ASTERIX_PLOTS, beyond, sizeof beyond);
    take_record(scans, ASTERIX_PLOTS, none, sizeof none);
    take_record(scans, ASTERIX_PLOTS, bare, sizeof bare);
    take_record(scans, ASTERIX_PLOTS, zero, sizeof zero);
    asterix_scans_finish(scans);
    expect_no_scan(scans);
    assert_int_equal(asterix_scans_counts(scans)->plots, 7);
    assert_int_equal(asterix_scans_counts(scans)->not_real, 3);
    assert_int_equal(asterix_scans_counts(scans)->no_detection, 1);
    assert_int_equal(asterix_scans_counts(scans)->incomplete, 3);
    asterix_scans_close(scans);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sector_crossings_make_a_scan_each),
        cmocka_unit_test(test_sectors_are_joined_to_turns),
        cmocka_unit_test(test_north_markers_alone_make_turns),
        cmocka_unit_test(test_north_marker_and_sector_crossing_count_once),
        cmocka_unit_test(test_a_lost_crossing_joins_two_sectors),
        cmocka_unit_test(test_late_plots_are_counted),
        cmocka_unit_test(test_time_of_day_passes_midnight),
        cmocka_unit_test(test_a_single_wild_time_is_ignored),
        cmocka_unit_test(test_day_of_the_first_plot_follows_the_reference_time),
        cmocka_unit_test(test_plots_without_crossings_are_cut_by_interval),
        cmocka_unit_test(test_a_silent_radar_is_not_waited_for),
        cmocka_unit_test(test_all_plots_of_a_scan_measure_the_same),
        cmocka_unit_test(test_what_is_no_target_plot_is_left_out),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
