/* SPDX-License-Identifier: MIT */
/*
 * Scans of sensors that do not cover a track leave its estimate unchanged to the last bit; no plot
 * is lost at the edges of a turn's sectors.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/tracker.h"

#define SECOND_US INT64_C(1000000)
#define NEAR 1 /* a sensor that covers the target */
#define FAR 2  /* a sensor that does not */
#define STRAIGHT_S 48.0

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;

static void start_tracker(uint8_t gate)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start_config;

    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start_config);
    config.gate = gate;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &start_config), RHO_OK);
}

static void describe_sensor(int32_t sensor_id, float x_m, float range_max_m)
{
    const struct rho_sensor sensor = {
        .sensor_id = sensor_id, .x_m = x_m, .pd = 0.9f, .range_max_m = range_max_m};

    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

/* Steps a scan with one plot, with an error that depends on k alone, or without plots (x_m NAN). */
static void step_plot(struct rho_initiator *with, int32_t sensor_id, int64_t time_us, double x_m,
                      double y_m, int k)
{
    const struct rho_plot plot = {.x_m = (float)x_m + 8.0f * sinf(2.3f * (float)k),
                                  .y_m = (float)y_m + 8.0f * cosf(5.1f * (float)k),
                                  .sigma_range_m = 10.0f,
                                  .sigma_cross_m = 10.0f};
    const struct rho_scan scan = {.time_us = time_us,
                                  .sensor_id = sensor_id,
                                  .num_plots = isnan(x_m) ? 0 : 1,
                                  .plots = &plot};

    assert_int_equal(rho_tracker_step(&tracker, with, &scan, &report), RHO_OK);
}

/*
 * Thirty scans of a weaving target; one scan of the other sensor after every `every` scans, 0:
 * none.
 */
static struct rho_track_report fly_weaving_target(uint8_t gate, int scans_per_other_scan)
{
    start_tracker(gate);
    describe_sensor(NEAR, 0.0f, 50000.0f);
    describe_sensor(FAR, 400000.0f, 50000.0f);
    for (int k = 0; k < 30; k++) {
        double t_s = 2.0 * k;
        /* all sensors take part in initiation, so only the existing track is compared */
        struct rho_initiator *with = k < 8 ? &initiator : NULL;

        step_plot(with, NEAR, 2 * k * SECOND_US, 10000.0 + 200.0 * t_s,
                  5000.0 + 40.0 * sin(t_s / 10.0), k);
        if (scans_per_other_scan > 0 && k >= 8 && k % scans_per_other_scan == 0) {
            /* gate best scores hypotheses against the clutter density, which all sensors share */
            step_plot(NULL, FAR, (2 * k + 1) * SECOND_US,
                      gate == RHO_TRACKER_BEST ? NAN : 400000.0 + 900.0 * k, 3000.0, k);
            assert_int_equal(report.num_tracks, 1);
            assert_int_equal(report.tracks[0].plot, -1);
        }
    }
    step_plot(NULL, NEAR, 60 * SECOND_US, NAN, 0.0, 0);
    assert_int_equal(report.num_tracks, 1);
    return report.tracks[0];
}

static void scans_that_do_not_cover_a_track_leave_it_unchanged(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        struct rho_track_report alone = fly_weaving_target(gate, 0);

        for (int every = 1; every <= 3; every++) {
            struct rho_track_report beside = fly_weaving_target(gate, every);

            assert_memory_equal(beside.state, alone.state, sizeof alone.state);
            assert_memory_equal(beside.covariance, alone.covariance, sizeof alone.covariance);
            assert_memory_equal(beside.accel_mps2, alone.accel_mps2, sizeof alone.accel_mps2);
            assert_int_equal(beside.hits, alone.hits);
            assert_int_equal(beside.misses, alone.misses);
        }
    }
}

/* Each report gives the track predicted to its time, with a larger covariance. */
static void scans_that_do_not_cover_a_track_report_it_predicted(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        float was_x_m, was_sigma_m;

        start_tracker(gate);
        describe_sensor(NEAR, 0.0f, 50000.0f);
        describe_sensor(FAR, 400000.0f, 50000.0f);
        for (int k = 0; k < 12; k++) {
            step_plot(&initiator, NEAR, 2 * k * SECOND_US, 10000.0 + 400.0 * k, 5000.0, k);
        }
        assert_int_equal(report.num_tracks, 1);
        was_x_m = report.tracks[0].state[0];
        was_sigma_m = report.tracks[0].sigma_m;
        step_plot(NULL, FAR, 27 * SECOND_US, NAN, 0.0, 0);
        assert_float_equal(report.tracks[0].state[0], was_x_m + 1000.0f, 150.0f);
        assert_true(report.tracks[0].sigma_m > 1.5f * was_sigma_m);
        assert_int_equal(report.tracks[0].update_age_us, 5 * SECOND_US);
    }
}

/* A track outside the coverage of all sensors ends after a while. */
static void tracks_outside_all_coverage_end(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_tracker(gate);
        describe_sensor(FAR, 400000.0f, 50000.0f);
        for (int k = 0; k < 12; k++) {
            step_plot(&initiator, NEAR, 2 * k * SECOND_US, 10000.0 + 400.0 * k, 5000.0, k);
        }
        assert_int_equal(report.num_tracks, 1);
        for (int k = 0; k < 20000 && report.num_tracks > 0; k++) {
            step_plot(NULL, FAR, (30 + 10 * k) * SECOND_US, NAN, 0.0, 0);
        }
        assert_int_equal(report.num_tracks, 0);
    }
}

/*
 * A turn in 16 sectors, stepped one by one; the target moves through them and is often at an edge.
 */
static void plots_at_the_edges_of_sectors_are_claimed(void **state)
{
    const double width_rad = 6.283185307179586 / 16.0;

    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_tracker(gate);
        describe_sensor(NEAR, 0.0f, 50000.0f);
        for (int k = 0; k < 68; k++) {
            /* angle in sectors: at an edge every twenty turns */
            double turned = 1.0 + (k - 8) / 20.0;
            int is_at_edge = k % 20 == 8;
            /* the antenna's beam is wide: the sector before may contain a target at the edge */
            int brings = ((int)floor(turned + 0.001) - (is_at_edge && k % 40 < 20)) & 15;
            double bearing_rad = width_rad * (turned + (k < 8 ? 0.0 : brings / 16.0 / 20.0));
            struct rho_plot plot = {
                .x_m = (float)(20000.0 * cos(bearing_rad)) + 8.0f * sinf(2.3f * (float)k),
                .y_m = (float)(20000.0 * sin(bearing_rad)) + 8.0f * cosf(5.1f * (float)k),
                .sigma_range_m = 10.0f,
                .sigma_cross_m = 10.0f};

            for (int sector = 0; sector < 16; sector++) {
                int is_turn = k < 8; /* the first turns come whole, for initiation */
                struct rho_scan scan = {.time_us = (int64_t)k * 4 * SECOND_US +
                                                   (is_turn ? 0 : sector * SECOND_US / 4),
                                        .sensor_id = NEAR,
                                        .num_plots = is_turn || sector == brings,
                                        .plots = &plot};

                scan.sector_from_rad = is_turn ? 0.0f : (float)(width_rad * sector);
                scan.sector_to_rad = is_turn ? 0.0f : (float)(width_rad * (sector + 1));
                if (!is_turn || sector == 0) {
                    assert_int_equal(
                        rho_tracker_step(&tracker, is_turn ? &initiator : NULL, &scan, &report),
                        RHO_OK);
                    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED],
                                     k < 8 ? report.fates_total[RHO_FATE_CLAIMED] : scan.num_plots);
                }
            }
        }
        assert_int_equal(report.num_tracks, 1);
    }
}

/*
 * A fast target and a plot 1.4 s older or younger than its scan, far from the target's place at the
 * scan's time.
 */
static void plots_far_from_the_scan_time_are_claimed(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            start_tracker(gate);
            describe_sensor(NEAR, 0.0f, 50000.0f);
            for (int k = 0; k < 12; k++) {
                step_plot(&initiator, NEAR, 2 * k * SECOND_US, 10000.0 + 1000.0 * k, 5000.0, k);
            }
            assert_int_equal(report.num_tracks, 1);
            const float x_m = 22000.0f + 700.0f * (float)sign; /* 500 m/s for 1.4 s */
            const struct rho_plot plot = {.offset_us = sign * 1400000,
                                          .x_m = x_m,
                                          .y_m = 5000.0f,
                                          .sigma_range_m = 10.0f,
                                          .sigma_cross_m = 10.0f};
            const struct rho_scan scan = {
                .time_us = 24 * SECOND_US, .sensor_id = NEAR, .num_plots = 1, .plots = &plot};
            assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
            assert_int_equal(report.tracks[0].plot, 0);
            assert_true(fabsf(report.tracks[0].state[0] - 22000.0f) <
                        40.0f); /* the state is at the scan's time */
        }
    }
}

/*
 * A radar of 16 sectors, 4 s a turn; the target flies straight, then turns at 20 m/s^2. Reports
 * between looks continue the turn.
 */
static void reports_between_looks_continue_the_manoeuvre(void **state)
{
    (void)state;
    const double turn_s = 4.0, radius_m = 3125.0, rate = 250.0 / 3125.0;
    double sum = 0.0, at_looks = 0.0;
    int count = 0, looks = 0;
    start_tracker(RHO_TRACKER_BEST);
    describe_sensor(NEAR, 0.0f, 50000.0f);
    for (int k = 0; k < 30 * 16; k++) {
        double t_s = turn_s * k / 16.0, angle = t_s > STRAIGHT_S ? rate * (t_s - STRAIGHT_S) : 0.0;
        double x_m = 5000.0 + 250.0 * fmin(t_s, STRAIGHT_S) + radius_m * sin(angle);
        double y_m = 500.0 + radius_m * (1.0 - cos(angle));
        int is_looked_at = k % 16 == 8;
        const struct rho_plot plot = {.x_m = (float)x_m + 8.0f * sinf(2.3f * (float)k),
                                      .y_m = (float)y_m + 8.0f * cosf(5.1f * (float)k),
                                      .sigma_range_m = 10.0f,
                                      .sigma_cross_m = 10.0f};
        /* one sector covers the target, fifteen do not */
        const struct rho_scan scan = {.time_us = (int64_t)(1e6 * t_s),
                                      .sensor_id = NEAR,
                                      .sector_from_rad = is_looked_at ? -1.5f : 2.5f,
                                      .sector_to_rad = is_looked_at ? 1.5f : 3.0f,
                                      .num_plots = (uint32_t)is_looked_at,
                                      .plots = &plot};
        assert_int_equal(
            rho_tracker_step(&tracker, is_looked_at ? &initiator : NULL, &scan, &report), RHO_OK);
        if (t_s < STRAIGHT_S + 12.0 || report.num_tracks != 1) {
            continue;
        }
        double dx_m = (double)report.tracks[0].state[0] - x_m;
        double dy_m = (double)report.tracks[0].state[1] - y_m;
        sum += dx_m * dx_m + dy_m * dy_m;
        count++;
        at_looks += is_looked_at ? dx_m * dx_m + dy_m * dy_m : 0.0;
        looks += is_looked_at;
    }
    print_message("rms %.1f m, at looks %.1f m\n", sqrt(sum / count), sqrt(at_looks / looks));
    assert_true(count > 200 && looks > 10);
    assert_true(sqrt(sum / count) < 75.0); /* measured 58 m; 93 m without the acceleration */
}

/*
 * A second radar at the same place misses a target beyond its range within eight standard
 * deviations of the track's place and a twentieth of its range, and no farther.
 */
static void coverage_has_a_margin_of_eight_sigmas_and_a_twentieth_of_range(void **state)
{
    static struct rho_tracker before;
    /* range from the second radar, where both parts of the margin matter */
    const float range_m = 2000.0f;

    (void)state;
    start_tracker(RHO_TRACKER_NEAREST);
    describe_sensor(NEAR, 0.0f, 50000.0f);
    for (int k = 0; k < 20; k++) {
        step_plot(&initiator, NEAR, 2 * k * SECOND_US, 10000.0 + 200.0 * k, 0.0, k);
    }
    assert_int_equal(report.num_tracks, 1);
    const struct rho_track_report track = report.tracks[0];
    const float margin_m = 8.0f * track.sigma_m + 0.05f * range_m;
    before = tracker;
    for (int is_within = 0; is_within <= 1; is_within++) {
        const float share = is_within ? 0.95f : 1.05f;
        const struct rho_plot plot = {.x_m = track.state[0],
                                      .y_m = track.state[1],
                                      /* plots that may be of the second radar */
                                      .sigma_range_m = 60.0f,
                                      .sigma_cross_m = 60.0f};
        const struct rho_scan scan = {
            .time_us = 38 * SECOND_US, .sensor_id = FAR, .num_plots = 1, .plots = &plot};

        tracker = before;
        describe_sensor(FAR, track.state[0] - range_m, range_m - share * margin_m);
        assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
        assert_int_equal(report.tracks[0].plot, is_within ? 0 : -1);
    }
}

/* Whether a plot is within the coverage of 1 .. 50 km to the east, 30 degrees to either side. */
static int is_plot_within_coverage(double x_m, double y_m, double sigma_range_m,
                                   double sigma_cross_m)
{
    const struct rho_sensor sensor = {.sensor_id = NEAR,
                                      .pd = 0.9f,
                                      .range_min_m = 1e3f,
                                      .range_max_m = 5e4f,
                                      .sector_from_rad = -0.5f,
                                      .sector_to_rad = 0.5f};
    const struct rho_plot plot = {.x_m = (float)x_m,
                                  .y_m = (float)y_m,
                                  .sigma_range_m = (float)sigma_range_m,
                                  .sigma_cross_m = (float)sigma_cross_m};
    const struct rho_scan scan = {.sensor_id = NEAR, .num_plots = 1, .plots = &plot};
    start_tracker(RHO_TRACKER_NEAREST);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    assert_int_equal(tracker.counters.plots_outside, report.fates_total[RHO_FATE_INVALID]);
    return report.fates_total[RHO_FATE_INVALID] == 0;
}

/* Plots up to four standard deviations beyond the border count as covered. */
static void plots_up_to_four_sigmas_beyond_the_coverage_are_covered(void **state)
{
    (void)state;
    for (int beyond = 3; beyond <= 5; beyond += 2) {
        const double angle = 0.5 + 0.01 * beyond; /* cross-range sigma of 100 m at 10 km */
        const int expected = beyond < 4;
        assert_int_equal(is_plot_within_coverage(5e4 + 100.0 * beyond, 0.0, 100.0, 1.0), expected);
        assert_int_equal(is_plot_within_coverage(1e3 - 50.0 * beyond, 0.0, 50.0, 1.0), expected);
        assert_int_equal(is_plot_within_coverage(1e4 * cos(angle), 1e4 * sin(angle), 1.0, 100.0),
                         expected);
        assert_int_equal(is_plot_within_coverage(1e4 * cos(angle), -1e4 * sin(angle), 1.0, 100.0),
                         expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scans_that_do_not_cover_a_track_leave_it_unchanged),
        cmocka_unit_test(scans_that_do_not_cover_a_track_report_it_predicted),
        cmocka_unit_test(tracks_outside_all_coverage_end),
        cmocka_unit_test(plots_at_the_edges_of_sectors_are_claimed),
        cmocka_unit_test(plots_far_from_the_scan_time_are_claimed),
        cmocka_unit_test(coverage_has_a_margin_of_eight_sigmas_and_a_twentieth_of_range),
        cmocka_unit_test(plots_up_to_four_sigmas_beyond_the_coverage_are_covered),
        cmocka_unit_test(reports_between_looks_continue_the_manoeuvre),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
