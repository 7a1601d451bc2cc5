/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "rhotrack/tracker.h"

#define SCAN_US 2000000

static struct rho_tracker tracker, other_tracker, before_tracker;
static struct rho_initiator initiator, other_initiator;
static struct rho_report report, other_report;
static struct rho_plot plots[RHO_MAX_PLOTS + 50];
static uint32_t num_plots, seed = 5;

static uint32_t random_24_bits(void)
{
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

static float uniform(float from, float to)
{
    return from + (to - from) * (float)random_24_bits() / 16777216.0f;
}

/* rate: false tracks an hour; 0: tracks start and are confirmed with a score of 0. */
static void start_tracker_with(struct rho_tracker_config maintain, unsigned scans,
                               unsigned min_scans, float rate)
{
    struct rho_initiator_config initiate;
    rho_initiator_config_default(&initiate);
    initiate.scans = (uint16_t)scans;
    initiate.min_scans = (uint16_t)min_scans;
    initiate.false_tracks_per_hour = rate;
    initiate.v_max_mps = 400.0f;
    maintain.v_max_mps = 400.0f;
    maintain.accel_max_mps2 = 5.0f;
    num_plots = 0;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &maintain), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &initiate), RHO_OK);
}

static void start_tracker(void)
{
    struct rho_tracker_config config;
    rho_tracker_config_default(&config);
    config.late_max_s = 0.5f;
    start_tracker_with(config, 5, 4, 0.0f);
}

static void add_plot(float x_m, float y_m)
{
    plots[num_plots++] =
        (struct rho_plot){.x_m = x_m, .y_m = y_m, .sigma_range_m = 10.0f, .sigma_cross_m = 10.0f};
}

static void check_fate_sums(const struct rho_scan *scan)
{
    uint32_t sum = 0, counted = 0;
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        sum += report.fates_total[fate];
        counted += tracker.counters.fates[fate];
    }
    assert_int_equal(sum, scan->num_plots);
    assert_int_equal(report.num_plots, scan->num_plots);
    assert_int_equal(counted, tracker.counters.plots_in);
    for (unsigned i = 1; i < report.num_tracks; i++) {
        assert_true(report.tracks[i - 1].track_id < report.tracks[i].track_id);
    }
}

static void step_at(int64_t time_us)
{
    struct rho_scan scan = {.time_us = time_us, .num_plots = num_plots, .plots = plots};
    memset(&report, 0xee, sizeof report);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    check_fate_sums(&scan);
    num_plots = 0;
}

static void step_scan_number(int k)
{
    step_at((int64_t)SCAN_US * k);
}

/* A target at 250 m/s along x, seen in scans from .. to - 1. */
static void track_target(int from, int to)
{
    for (int k = from; k < to; k++) {
        add_plot(500.0f * (float)k + uniform(-8.0f, 8.0f), uniform(-8.0f, 8.0f));
        step_scan_number(k);
    }
}

static void bad_init_and_sensors_are_refused(void **state)
{
    (void)state;
    struct rho_tracker_config good, bad;
    struct rho_sensor sensor = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 1000.0f};
    rho_tracker_config_default(&good);
    memset(&tracker, 0, sizeof tracker);
    before_tracker = tracker;
    assert_int_equal(rho_tracker_init(NULL, sizeof tracker, &good), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_init(&tracker, 1, &good), RHO_ERROR_SIZE);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_ERROR_STATE);
    for (int i = 0; i < 4; i++) {
        bad = good;
        bad.pd = i == 0 ? NAN : bad.pd;
        bad.v_max_mps = i == 1 ? 0.0f : bad.v_max_mps;
        bad.accel_max_mps2 = i == 2 ? -1.0f : bad.accel_max_mps2;
        bad.coast_scans_max = i == 3 ? 0 : bad.coast_scans_max;
        assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &bad), RHO_ERROR_CONFIG);
    }
    assert_memory_equal(&tracker, &before_tracker, sizeof tracker);
    start_tracker();
    for (int i = 0; i < RHO_MAX_SENSORS; i++) {
        sensor.sensor_id = i;
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
        /* setting a sensor again replaces it */
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    }
    before_tracker = tracker;
    sensor.sensor_id = RHO_MAX_SENSORS;
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_ERROR_CAPACITY);
    sensor.sensor_id = 0;
    sensor.range_max_m = 0.0f;
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_ERROR_CONFIG);
    sensor.range_max_m = 1000.0f;
    assert_int_equal(rho_tracker_set_sensor(&tracker, NULL), RHO_ERROR_NULL);
    assert_memory_equal(&tracker, &before_tracker, sizeof tracker);
}

/*
 * A refused init leaves the object unchanged. Init clears it before the hypotheses' motion model is
 * checked, so every configuration within its ranges must give a valid model.
 */
static void every_configuration_within_its_ranges_initialises(void **state)
{
    static const float accels_mps2[] = {0.0f, 1e-30f, 1e-3f, 1.0f, 1000.0f};
    static const float speeds_mps[] = {1.0f, 30.0f, RHO_LIMIT_SPEED_MPS};
    static const float steady_s[] = {0.0f, 1.0f, 1e5f};
    struct rho_tracker_config config;

    (void)state;
    rho_tracker_config_default(&config);
    for (unsigned i = 0; i < 5 * 3 * 3; i++) {
        config.accel_max_mps2 = accels_mps2[i % 5];
        config.v_max_mps = speeds_mps[i / 5 % 3];
        config.steady_s = steady_s[i / 15];
        assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    }
}

/* A plot raises a track's score by ln 100 less where clutter is 100 times as dense. */
static void a_stated_clutter_density_lowers_scores(void **state)
{
    float score_nat[2];

    (void)state;
    assert_int_equal(rho_tracker_set_clutter(NULL, 1.0f), RHO_ERROR_NULL);
    memset(&tracker, 0, sizeof tracker);
    assert_int_equal(rho_tracker_set_clutter(&tracker, 1.0f), RHO_ERROR_STATE);
    for (int i = 0; i < 2; i++) {
        struct rho_scan scan = {.time_us = SCAN_US, .plots = plots};
        struct rho_track_plot start = {.row = -1};

        start_tracker();
        assert_int_equal(rho_tracker_set_clutter(&tracker, -1.0f), RHO_ERROR_VALUE);
        assert_int_equal(rho_tracker_set_clutter(&tracker, NAN), RHO_ERROR_VALUE);
        assert_int_equal(rho_tracker_set_clutter(&tracker, i ? 1e-9f : 1e-11f), RHO_OK);
        assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
        add_plot(0.0f, 0.0f);
        start.plot = plots[0];
        start.time_us = scan.time_us;
        assert_int_equal(rho_tracker_start_track(&tracker, &start, 1, 0, &report), RHO_OK);
        scan.time_us = 2 * SCAN_US;
        scan.num_plots = 1;
        assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
        score_nat[i] = report.tracks[0].score_nat;
    }
    assert_float_equal(score_nat[0] - score_nat[1], logf(100.0f), 0.1f);
    assert_int_equal(rho_tracker_set_clutter(&tracker, 0.0f), RHO_OK);
    assert_int_equal(rho_tracker_is_sound(&tracker), 1);
    tracker.clutter_per_m2 = NAN;
    assert_int_equal(rho_tracker_is_sound(&tracker), 0);
}

static void forgotten_sensors_free_their_place(void **state)
{
    struct rho_sensor sensor = {.pd = 0.9f, .range_max_m = 1000.0f};

    (void)state;
    assert_int_equal(rho_tracker_forget_sensor(NULL, 0), RHO_ERROR_NULL);
    memset(&tracker, 0, sizeof tracker);
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 0), RHO_ERROR_STATE);
    start_tracker();
    before_tracker = tracker;
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 0), RHO_ERROR_STATE);
    assert_memory_equal(&tracker, &before_tracker, sizeof tracker);
    for (int i = 0; i < RHO_MAX_SENSORS; i++) {
        sensor.sensor_id = i;
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    }
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 0), RHO_OK);
    assert_int_equal(rho_tracker_forget_sensor(&tracker, 0), RHO_ERROR_STATE);
    assert_int_equal(tracker.num_sensors, RHO_MAX_SENSORS - 1);
    sensor.sensor_id = RHO_MAX_SENSORS;
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    for (int i = 1; i <= RHO_MAX_SENSORS; i++) {
        assert_int_equal(rho_tracker_forget_sensor(&tracker, i), RHO_OK);
    }
    /* the counter aside, as if the sensor had never been described */
    assert_memory_equal(&tracker, &before_tracker, sizeof tracker);
}

static void refused_scans_change_nothing(void **state)
{
    (void)state;
    struct rho_scan scan = {.time_us = 100, .num_plots = 1, .plots = NULL};
    start_tracker();
    track_target(0, 3);
    before_tracker = tracker;
    other_initiator = initiator;
    other_report = report;
    assert_int_equal(rho_tracker_step(NULL, &initiator, &scan, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, NULL, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, NULL), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_ERROR_NULL);
    scan.plots = plots;
    scan.sector_to_rad = NAN;
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_ERROR_VALUE);
    scan.sector_to_rad = 0.0f;
    scan.time_us = INT64_MAX;
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_ERROR_VALUE);
    scan.time_us = INT64_MIN;
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_ERROR_VALUE);
    scan.time_us = 3 * SCAN_US;
    initiator.magic++;
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_ERROR_STATE);
    initiator.magic--;
    assert_memory_equal(&tracker, &before_tracker, sizeof tracker);
    assert_memory_equal(&initiator, &other_initiator, sizeof initiator);
    assert_memory_equal(&report, &other_report, sizeof report);
}

static void every_plot_has_one_fate(void **state)
{
    (void)state;
    start_tracker();
    track_target(0, 6);
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
    add_plot(3000.0f, 0.0f);
    add_plot(-7000.0f, 4000.0f);
    add_plot(NAN, 0.0f);
    add_plot(0.0f, INFINITY);
    add_plot(3.0e6f, 0.0f);
    add_plot(0.0f, 0.0f);
    plots[5].sigma_cross_m = 0.0f;
    add_plot(0.0f, 0.0f);
    plots[6].offset_us = INT32_MIN;
    step_scan_number(6);
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
    assert_int_equal(report.fates[1], RHO_FATE_HELD);
    for (int i = 2; i < 7; i++) {
        assert_int_equal(report.fates[i], RHO_FATE_INVALID);
    }
    assert_int_equal(report.fates_total[RHO_FATE_INVALID], 5);
}

static void plots_beyond_the_capacity_get_fate_no_room(void **state)
{
    (void)state;
    start_tracker();
    for (int i = 0; i < RHO_MAX_PLOTS + 50; i++) {
        add_plot(uniform(-9e4f, 9e4f), uniform(-9e4f, 9e4f));
    }
    step_scan_number(0);
    assert_int_equal(report.fates_total[RHO_FATE_HELD], RHO_MAX_PLOTS);
    assert_int_equal(report.fates_total[RHO_FATE_NO_ROOM], 50);
}

static void plots_of_too_late_scans_are_stale(void **state)
{
    (void)state;
    start_tracker();
    track_target(0, 6);
    before_tracker = tracker;
    add_plot(1.0f, 1.0f);
    add_plot(2.0f, 2.0f);
    step_scan_number(4);
    assert_int_equal(report.fates_total[RHO_FATE_STALE], 2);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(tracker.counters.scans_late, 1);
    tracker.counters = before_tracker.counters;
    assert_memory_equal(&tracker, &before_tracker, sizeof tracker);
}

static void a_track_is_started_kept_and_ended(void **state)
{
    (void)state;
    start_tracker();
    track_target(0, 3);
    assert_int_equal(report.num_tracks, 0);
    track_target(3, 10);
    assert_int_equal(report.num_tracks, 1);
    const struct rho_track_report *track = &report.tracks[0];
    assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
    assert_int_equal(track->plot, 0);
    assert_float_equal(track->state[0], 4500.0f, 15.0f);
    assert_float_equal(track->state[3], 250.0f, 5.0f);
    assert_int_equal(tracker.counters.plots_initiated, 4);
    for (int k = 10; k < 14; k++) {
        step_scan_number(k);
        /* two misses in ten looks are usual; four are rarer than the end of a target */
        assert_true(k == 12 ||
                    report.tracks[0].status == (k < 12 ? RHO_TRACK_COASTING : RHO_TRACK_TENTATIVE));
        assert_int_equal(report.num_ended, 0);
        assert_int_equal(report.tracks[0].plot, -1);
        assert_int_equal(report.tracks[0].update_age_us, SCAN_US * (k - 9));
    }
    int k = 14;
    for (; k < 30 && report.num_tracks > 0; k++) {
        step_scan_number(k);
        assert_true(report.num_tracks == 0 || report.tracks[0].status == RHO_TRACK_TENTATIVE);
    }
    assert_in_range(k, 21, 27); /* after 11 to 17 misses: it may have been hidden */
    assert_int_equal(report.num_tracks, 0);
    assert_int_equal(report.num_ended, 1);
    assert_int_equal(report.ended[0], 1);
    assert_int_equal(tracker.counters.tracks_ended, 1);
}

static void misses_count_only_within_the_scans_sector(void **state)
{
    (void)state;
    struct rho_sensor near = {.sensor_id = 7, .pd = 0.9f, .range_max_m = 1000.0f};
    start_tracker();
    track_target(0, 10);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &near), RHO_OK);
    for (int k = 10; k < 30; k++) {
        struct rho_scan scan = {.time_us = (int64_t)SCAN_US * k, .sensor_id = k % 2 ? 7 : 0};
        if (k % 2 == 0) {
            scan.sector_from_rad = 1.0f; /* a sector away from the track at azimuth 0 */
            scan.sector_to_rad = 2.0f;
        }
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].misses, 0);
    }
}

static void crossing_targets_keep_their_identities(void **state)
{
    (void)state;
    start_tracker();
    for (int k = 0; k < 20; k++) {
        float t_s = 2.0f * (float)k;
        add_plot(200.0f * t_s - 4000.0f + uniform(-5.0f, 5.0f), 60.0f * t_s - 1200.0f);
        add_plot(200.0f * t_s - 4000.0f + uniform(-5.0f, 5.0f), 1200.0f - 60.0f * t_s);
        step_scan_number(k);
    }
    assert_int_equal(report.num_tracks, 2);
    assert_int_equal(tracker.counters.tracks_started, 2);
    assert_true((report.tracks[0].state[4] > 0.0f) != (report.tracks[1].state[4] > 0.0f));
    for (unsigned i = 0; i < 2; i++) {
        float up = report.tracks[i].state[4] > 0.0f ? 1.0f : -1.0f;
        assert_float_equal(report.tracks[i].state[1], up * 1080.0f, 20.0f);
        assert_int_equal(report.tracks[i].hits, 20);
    }
}

static void without_an_initiator_tracks_continue_and_none_start(void **state)
{
    (void)state;
    start_tracker();
    track_target(0, 6);
    add_plot(3000.0f, 0.0f);
    add_plot(-3000.0f, 50.0f);
    struct rho_scan scan = {.time_us = (int64_t)SCAN_US * 6, .num_plots = 2, .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
    assert_int_equal(report.fates[1], RHO_FATE_NO_ROOM);
}

static void a_snapshot_continues_with_the_same_bytes(void **state)
{
    (void)state;
    start_tracker();
    track_target(0, 8);
    other_tracker = tracker;
    other_initiator = initiator;
    uint32_t seed_then = seed;
    track_target(8, 14);
    other_report = report;
    before_tracker = tracker;
    tracker = other_tracker;
    initiator = other_initiator;
    seed = seed_then;
    track_target(8, 14);
    assert_memory_equal(&report, &other_report, sizeof report);
    assert_memory_equal(&tracker, &before_tracker, sizeof tracker);
}

static void gaps_of_a_century_end_tracks_and_do_no_harm(void **state)
{
    (void)state;
    start_tracker();
    track_target(0, 8);
    step_at(INT64_C(3600000000) * 24 * 365 * 100); /* a century */
    assert_int_equal(report.num_tracks, 0);
    assert_int_equal(report.num_ended, 1);
    step_at(RHO_LIMIT_TIME_US);
    assert_int_equal(report.num_tracks, 0);
}

static void starts_without_room_in_the_table_are_counted(void **state)
{
    (void)state;
    enum { ROWS = RHO_MAX_TRACKS + 4 };
    if (ROWS > RHO_MAX_PLOTS || ROWS > RHO_MAX_CANDIDATES * 4 || RHO_MAX_TRACKS > 100) {
        skip(); /* a workstation's track table is too large to fill in a unit test */
    }
    start_tracker();
    for (int k = 0; k < 8; k++) {
        int to = k < 4 ? 20 : ROWS; /* the list of candidates is shorter than the track table */
        for (int i = 0; i < to; i++) {
            add_plot(500.0f * (float)k, 3000.0f * (float)i);
        }
        step_scan_number(k);
    }
    assert_int_equal(report.num_tracks, RHO_MAX_TRACKS);
    assert_int_equal(tracker.counters.tracks_no_room, 4);
    assert_int_equal(tracker.counters.tracks_started, RHO_MAX_TRACKS);
}

/* ---- hostile input --------------------------------------------------------------------------- */

static float hostile_number(void)
{
    static const float odd[] = {NAN, INFINITY, -INFINITY, 3.4e38f, -3.4e38f, 1e-45f, 0.0f, 2.0e6f};
    return random_24_bits() % 8 == 0 ? odd[random_24_bits() % 8] : uniform(-5000.0f, 5000.0f);
}

static void add_hostile_plot(void)
{
    add_plot(hostile_number(), hostile_number());
    struct rho_plot *plot = &plots[num_plots - 1];
    plot->z_m = hostile_number();
    plot->vx_mps = hostile_number() * 0.1f;
    plot->vy_mps = hostile_number() * 0.1f;
    plot->vz_mps = hostile_number();
    plot->sigma_mps = random_24_bits() % 4 ? 5.0f : hostile_number();
    plot->sigma_up_m = random_24_bits() % 4 ? 20.0f : hostile_number();
    if (random_24_bits() % 8 == 0) {
        plot->sigma_range_m = plot->sigma_cross_m = hostile_number();
        plot->offset_us = (int32_t)(random_24_bits() * 300u);
    }
}

static void check_reports_finite(void)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        for (int k = 0; k < 6; k++) {
            assert_true(isfinite(track->state[k]));
            assert_true(track->covariance[RHO_AT(k, k)] >= 0.0f);
        }
        assert_true(isfinite(track->sigma_m) && isfinite(track->score_nat));
    }
}

static void hostile_plots_leave_reports_finite(void **state)
{
    (void)state;
    int64_t time_us = -50000000;
    start_tracker();
    for (int k = 0; k < 3000; k++) {
        for (uint32_t i = random_24_bits() % 30; i > 0; i--) {
            add_hostile_plot();
        }
        struct rho_scan scan = {.time_us = time_us,
                                .sensor_id = (int32_t)(random_24_bits() % 3),
                                .measures = random_24_bits() % 8,
                                .num_plots = num_plots,
                                .plots = plots};
        memset(&report, 0xee, sizeof report);
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
        check_fate_sums(&scan);
        check_reports_finite();
        num_plots = 0;
        time_us += random_24_bits() % 16 == 0 ? -1000000 : (int64_t)(random_24_bits() % 4000000);
    }
    assert_true(tracker.counters.scans_late > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bad_init_and_sensors_are_refused),
        cmocka_unit_test(every_configuration_within_its_ranges_initialises),
        cmocka_unit_test(a_stated_clutter_density_lowers_scores),
        cmocka_unit_test(forgotten_sensors_free_their_place),
        cmocka_unit_test(refused_scans_change_nothing),
        cmocka_unit_test(every_plot_has_one_fate),
        cmocka_unit_test(plots_beyond_the_capacity_get_fate_no_room),
        cmocka_unit_test(plots_of_too_late_scans_are_stale),
        cmocka_unit_test(a_track_is_started_kept_and_ended),
        cmocka_unit_test(misses_count_only_within_the_scans_sector),
        cmocka_unit_test(crossing_targets_keep_their_identities),
        cmocka_unit_test(without_an_initiator_tracks_continue_and_none_start),
        cmocka_unit_test(a_snapshot_continues_with_the_same_bytes),
        cmocka_unit_test(gaps_of_a_century_end_tracks_and_do_no_harm),
        cmocka_unit_test(starts_without_room_in_the_table_are_counted),
        cmocka_unit_test(hostile_plots_leave_reports_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
