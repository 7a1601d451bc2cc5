/* SPDX-License-Identifier: MIT */
/*
 * Out-of-sequence scans: up to late_max_s old they update tracks nearly as if they had come in
 * time; older ones are stale.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/tracker.h"

#define TARGETS 10
#define SCANS 120
#define FIRST_JUDGED 20
#define INTERVAL_US INT64_C(4000000)
#define SIGMA_M 50.0f

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;

static void start_tracker(uint8_t gate, float late_max_s)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start_config;

    memset(&report, 0, sizeof report);
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start_config);
    config.gate = gate;
    config.late_max_s = late_max_s;
    config.v_max_mps = start_config.v_max_mps = 400.0f;
    config.accel_max_mps2 = 10.0f;
    config.pd = start_config.pd = 0.95f;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &start_config), RHO_OK);
}

/* ---- one target, almost without noise -------------------------------------------------------- */

/*
 * Steps the scan at time k with the target (200 m/s) or without it, and with a plot that stands far
 * away.
 */
static void step_lone_target(int k, int has_target, int has_other)
{
    const struct rho_plot target = {.x_m = 800.0f * (float)k + 5.0f * sinf((float)k),
                                    .y_m = 1000.0f,
                                    .sigma_range_m = 10.0f,
                                    .sigma_cross_m = 10.0f};
    struct rho_plot plots[2] = {target, target};
    const struct rho_scan scan = {.time_us = k * INTERVAL_US,
                                  .num_plots = (uint32_t)(has_target + has_other),
                                  .plots = has_target ? plots : plots + 1};

    plots[1].y_m = 20000.0f + 300.0f * sinf(17.0f * (float)k);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
}

static void track_target_until(int last)
{
    for (int k = 0; k <= last; k++) {
        step_lone_target(k, 1, 0);
    }
    assert_int_equal(report.num_tracks, 1);
}

static void a_late_scan_updates_tracks_and_starts_none(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_tracker(gate, 20.0f);
        track_target_until(9);
        step_lone_target(11, 1, 0);
        const struct rho_track_report before = report.tracks[0];
        const uint32_t held = tracker.counters.fates[RHO_FATE_HELD];

        step_lone_target(10, 1, 1);
        assert_int_equal(report.time_us, 11 * INTERVAL_US);
        assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
        assert_int_equal(report.fates[1], RHO_FATE_STALE);
        assert_int_equal(report.tracks[0].plot, 0);
        assert_int_equal(report.tracks[0].hits, before.hits + 1);
        assert_true(report.tracks[0].score_nat > before.score_nat);
        assert_true(report.tracks[0].sigma_m < before.sigma_m);
        assert_float_equal(report.tracks[0].state[0], 8800.0f, 20.0f);
        assert_int_equal(report.tracks[0].update_age_us, before.update_age_us);
        assert_int_equal(tracker.time_us, 11 * INTERVAL_US);
        assert_int_equal(tracker.counters.scans_retrodicted, 1);
        assert_int_equal(tracker.counters.scans_late, 0);
        assert_int_equal(tracker.counters.fates[RHO_FATE_HELD], held);
        step_lone_target(12, 1, 0); /* the next scan in time updates the track as before */
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].plot, 0);
    }
}

static void a_late_scan_without_the_target_counts_a_miss(void **state)
{
    (void)state;
    start_tracker(RHO_TRACKER_BEST, 20.0f);
    track_target_until(9);
    step_lone_target(11, 1, 0);
    const struct rho_track_report before = report.tracks[0];

    step_lone_target(10, 0, 1);
    assert_int_equal(report.tracks[0].misses, before.misses + 1);
    assert_true(report.tracks[0].score_nat < before.score_nat - 2.0f);
    assert_float_equal(report.tracks[0].state[0], before.state[0], 0.5f);
    assert_float_equal(report.tracks[0].sigma_m, before.sigma_m, 0.05f * before.sigma_m);
}

/*
 * The scan of a whole turn has no neighbouring sector: a miss counts if the track is in it, though
 * the sector's edge cuts the gate.
 */
static void a_late_miss_at_the_edge_of_a_full_turn_counts(void **state)
{
    const struct rho_sensor sensor = {.pd = 0.95f,
                                      .range_max_m = 1e5f,
                                      .x_m = 4000.0f,
                                      .y_m = 999.0f, /* the target flies 1 m inside the edge */
                                      .sector_from_rad = 0.0f,
                                      .sector_to_rad = 1.0f};
    (void)state;
    for (int is_late = 0; is_late < 2; is_late++) {
        start_tracker(RHO_TRACKER_BEST, 20.0f);
        track_target_until(9);
        assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
        if (is_late) {
            step_lone_target(11, 1, 0);
        }
        const struct rho_track_report before = report.tracks[0];

        step_lone_target(10, 0, 1);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].misses, before.misses + 1);
    }
}

static void scans_later_than_late_max_s_are_stale(void **state)
{
    static struct rho_tracker before;
    (void)state;
    start_tracker(RHO_TRACKER_BEST, 7.9f);
    track_target_until(12);
    before = tracker;
    step_lone_target(10, 1, 1); /* 8 s after the last scan */
    assert_int_equal(report.fates_total[RHO_FATE_STALE], 2);
    assert_int_equal(tracker.counters.scans_late, 1);
    assert_int_equal(tracker.counters.scans_retrodicted, 0);
    assert_int_equal(report.tracks[0].plot, -1);
    before.counters = tracker.counters;
    assert_memory_equal(&tracker, &before, sizeof tracker);
    step_lone_target(11, 1, 0); /* 4 s late */
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
}

/* Tracks outside a late scan's sector stay where they are, whatever the times are. */
static void a_late_scan_of_another_place_moves_no_track(void **state)
{
    static struct rho_tracker before;
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        for (int early = 0; early < 2; early++) {
            const int64_t start_us = early ? INT64_C(-1000000000) : 0;
            struct rho_scan scan = {.num_plots = 1};

            start_tracker(gate, 20.0f);
            for (int k = 0; k < 8; k++) {
                const struct rho_plot plot = {.x_m = 20000.0f + 800.0f * (float)k,
                                              .sigma_range_m = 10.0f,
                                              .sigma_cross_m = 10.0f};
                scan.time_us = start_us + k * INTERVAL_US;
                scan.plots = &plot;
                assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
            }
            assert_int_equal(report.num_tracks, 1);
            before = tracker;
            scan = (struct rho_scan){.time_us = scan.time_us - INTERVAL_US / 2,
                                     .sector_from_rad = 2.0f,
                                     .sector_to_rad = 2.5f};
            assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
            assert_int_equal(report.num_tracks, 1);
            assert_int_equal(tracker.tracks[0].time_us, before.tracks[0].time_us);
            assert_memory_equal(&tracker.tracks[0].kalman, &before.tracks[0].kalman,
                                sizeof before.tracks[0].kalman);
        }
    }
}

static void an_uninitialised_initiator_is_refused(void **state)
{
    const struct rho_scan scan = {.time_us = 8 * INTERVAL_US};
    (void)state;
    start_tracker(RHO_TRACKER_BEST, 20.0f);
    track_target_until(9);
    memset(&initiator, 0x11, sizeof initiator);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_ERROR_STATE);
}

/* A sensor's newest scan is given twice, with another sensor's in between. */
static void a_scan_given_twice_is_stale(void **state)
{
    const struct rho_scan other = {.time_us = 10 * INTERVAL_US, .sensor_id = 3};
    (void)state;
    start_tracker(RHO_TRACKER_BEST, 20.0f);
    track_target_until(9);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &other, &report), RHO_OK);
    step_lone_target(9, 1, 0);
    assert_int_equal(report.fates[0], RHO_FATE_STALE);
    assert_int_equal(tracker.counters.scans_late, 1);
}

/*
 * Counts scans of sensor 2 until its target, which no other sensor sees, is confirmed; 0: it never
 * is.
 */
static int scans_to_confirm(uint8_t gate, int is_late)
{
    const struct rho_sensor blind = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 100.0f};
    static struct rho_initiator own;
    struct rho_initiator_config config;

    start_tracker(gate, 20.0f);
    rho_initiator_config_default(&config);
    config.v_max_mps = 400.0f;
    assert_int_equal(rho_initiator_init(&own, sizeof own, &config), RHO_OK);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &blind), RHO_OK);
    for (int k = 0; k < 20; k++) {
        const struct rho_plot plot = {.x_m = 800.0f * (float)k + 5.0f * sinf((float)k),
                                      .y_m = 1000.0f,
                                      .sigma_range_m = 10.0f,
                                      .sigma_cross_m = 10.0f};
        const struct rho_scan seen = {
            .time_us = k * INTERVAL_US, .sensor_id = 2, .num_plots = 1, .plots = &plot};
        const struct rho_scan other = {.time_us = seen.time_us + 3 * INTERVAL_US / 4,
                                       .sensor_id = 1};

        if (!is_late) {
            assert_int_equal(rho_tracker_step(&tracker, &own, &seen, &report), RHO_OK);
        }
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &other, &report), RHO_OK);
        if (is_late) {
            assert_int_equal(rho_tracker_step(&tracker, &own, &seen, &report), RHO_OK);
            assert_true(report.time_us == other.time_us);
        }
        if (report.num_tracks == 1 && report.tracks[0].status == RHO_TRACK_CONFIRMED) {
            assert_float_equal(report.tracks[0].state[0], 800.0f * ((float)k + 0.75f), 40.0f);
            assert_int_equal(tracker.counters.fates[RHO_FATE_STALE], 0);
            return k + 1;
        }
    }
    return 0;
}

static void a_radar_whose_scans_are_always_late_starts_tracks(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        const int in_time = scans_to_confirm(gate, 0), late = scans_to_confirm(gate, 1);
        print_message("gate %d: %d scans in time, %d late\n", gate, in_time, late);
        assert_true(in_time > 0 && late == in_time);
    }
}

static void late_max_s_0_takes_no_late_scan(void **state)
{
    (void)state;
    start_tracker(RHO_TRACKER_BEST, 0.0f);
    track_target_until(9);
    step_lone_target(11, 1, 0);
    step_lone_target(10, 1, 0);
    assert_int_equal(report.fates[0], RHO_FATE_STALE);
    assert_int_equal(tracker.counters.scans_late, 1);
}

static void late_max_s_beyond_a_minute_is_refused(void **state)
{
    const float bad[] = {-0.1f, 60.1f, NAN, INFINITY};
    struct rho_tracker_config config;
    (void)state;
    rho_tracker_config_default(&config);
    assert_float_equal(config.late_max_s, 20.0f, 0.0f);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        config.late_max_s = bad[i];
        assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_ERROR_CONFIG);
    }
    config.late_max_s = 60.0f;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
}

/* ---- accuracy with and without late scans ---------------------------------------------------- */

static double truth_m[SCANS][TARGETS][2];
static struct rho_plot plots[SCANS][TARGETS];
static uint32_t num_plots[SCANS];

/* Aircraft of 150 to 250 m/s that begin and end turns of up to 1 g. */
static void draw_scans_of_aircraft(uint64_t seed)
{
    random_state = seed;
    for (int i = 0; i < TARGETS; i++) {
        double x_m = 20000.0 * i, y_m = 5000.0 * uniform(0.0, 1.0), turn = 0.0;
        double heading = 6.28 * uniform(0.0, 1.0), speed = 150.0 + 100.0 * uniform(0.0, 1.0);

        for (int k = 0; k < SCANS; k++) {
            if (uniform(0.0, 1.0) < 0.05) {
                turn = uniform(0.0, 1.0) < 0.5 ? 0.0 : 0.08 * (uniform(0.0, 1.0) - 0.5);
            }
            heading += 4.0 * turn;
            x_m += 4.0 * speed * cos(heading);
            y_m += 4.0 * speed * sin(heading);
            truth_m[k][i][0] = x_m;
            truth_m[k][i][1] = y_m;
        }
    }
    for (int k = 0; k < SCANS; k++) {
        num_plots[k] = 0;
        for (int i = 0; i < TARGETS; i++) {
            float dx_m = SIGMA_M * (float)normal(), dy_m = SIGMA_M * (float)normal();

            if (uniform(0.0, 1.0) < 0.95) {
                plots[k][num_plots[k]++] = (struct rho_plot){.x_m = (float)truth_m[k][i][0] + dx_m,
                                                             .y_m = (float)truth_m[k][i][1] + dy_m,
                                                             .sigma_range_m = SIGMA_M,
                                                             .sigma_cross_m = SIGMA_M};
            }
        }
    }
}

struct worth {
    double sum_m2;
    int judged, lost;
};

/*
 * Errors of confirmed tracks at the report's time; a target without a track near it counts as lost.
 */
static void add_errors_of_report(struct worth *worth)
{
    int k = (int)(report.time_us / INTERVAL_US);

    for (int i = 0; k >= FIRST_JUDGED && k % 5 != 3 && i < TARGETS; i++) {
        double best_m = 1000.0;

        for (uint32_t t = 0; t < report.num_tracks; t++) {
            const struct rho_track_report *track = &report.tracks[t];
            double error_m = hypot((double)track->state[0] - truth_m[k][i][0],
                                   (double)track->state[1] - truth_m[k][i][1]);

            if (track->status != RHO_TRACK_TENTATIVE && error_m < best_m) {
                best_m = error_m;
            }
        }
        worth->sum_m2 += best_m < 1000.0 ? best_m * best_m : 0.0;
        worth->judged += best_m < 1000.0;
        worth->lost += best_m >= 1000.0;
    }
}

static void step_scan_of_all_aircraft(int k)
{
    const struct rho_scan scan = {
        .time_us = k * INTERVAL_US, .num_plots = num_plots[k], .plots = plots[k]};

    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
}

/* One scan in five comes `behind` scans late; 0: all in time. */
static struct worth run_with_every_fifth_scan_late(int behind, float late_max_s)
{
    struct worth worth = {0};

    for (uint64_t seed = 1; seed <= 6; seed++) {
        draw_scans_of_aircraft(seed);
        start_tracker(RHO_TRACKER_BEST, late_max_s);
        for (int k = 0; k < SCANS; k++) {
            int is_late = behind > 0 && k > 10 && k % 5 == 3;
            int before = k - behind;

            if (!is_late) {
                step_scan_of_all_aircraft(k);
            }
            if (behind > 0 && before > 10 && before % 5 == 3) {
                step_scan_of_all_aircraft(before);
            }
            if (!is_late) {
                add_errors_of_report(&worth);
            }
        }
    }
    return worth;
}

static double rmse_m(const struct worth *worth)
{
    return sqrt(worth->sum_m2 / worth->judged);
}

static void late_scans_improve_tracks_nearly_as_much_as_timely_ones(void **state)
{
    struct worth in_time = run_with_every_fifth_scan_late(0, 20.0f);
    (void)state;
    for (int behind = 1; behind <= 2; behind++) {
        struct worth taken = run_with_every_fifth_scan_late(behind, 20.0f),
                     dropped = run_with_every_fifth_scan_late(behind, 0.0f);

        print_message("%d late: %.1f m in time, %.1f m taken, %.1f m dropped\n", behind,
                      rmse_m(&in_time), rmse_m(&taken), rmse_m(&dropped));
        assert_true(taken.lost <= in_time.lost);
        /* until it comes, a scan two scans late is missing in two reports */
        assert_true(rmse_m(&taken) < (behind == 1 ? 1.05 : 1.1) * rmse_m(&in_time));
        assert_true(rmse_m(&taken) < 1.01 * rmse_m(&dropped));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_late_scan_updates_tracks_and_starts_none),
        cmocka_unit_test(a_late_scan_without_the_target_counts_a_miss),
        cmocka_unit_test(a_late_miss_at_the_edge_of_a_full_turn_counts),
        cmocka_unit_test(scans_later_than_late_max_s_are_stale),
        cmocka_unit_test(a_late_scan_of_another_place_moves_no_track),
        cmocka_unit_test(an_uninitialised_initiator_is_refused),
        cmocka_unit_test(a_scan_given_twice_is_stale),
        cmocka_unit_test(a_radar_whose_scans_are_always_late_starts_tracks),
        cmocka_unit_test(late_max_s_0_takes_no_late_scan),
        cmocka_unit_test(late_max_s_beyond_a_minute_is_refused),
        cmocka_unit_test(late_scans_improve_tracks_nearly_as_much_as_timely_ones),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
