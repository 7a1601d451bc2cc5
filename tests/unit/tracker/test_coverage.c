/* SPDX-License-Identifier: MIT */
/*
 * Scans of sensors that cannot see a track leave its estimate as it is, to the last bit; sectors of
 * a turn lose no plot at their edges.
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
#define NEAR 1 /* sees the target */
#define FAR 2  /* does not */
#define STRAIGHT_S 48.0

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;

static void start(uint8_t gate)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start_config;

    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start_config);
    config.gate = gate;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &start_config), RHO_OK);
}

static void describe(int32_t sensor_id, float x_m, float range_max_m)
{
    const struct rho_sensor sensor = {
        .sensor_id = sensor_id, .x_m = x_m, .pd = 0.9f, .range_max_m = range_max_m};

    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

/* One plot, with some error that only k makes, or none (x_m NAN). */
static void step(struct rho_initiator *with, int32_t sensor_id, int64_t time_us, double x_m,
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
 * Thirty scans of a target that weaves; of the other sensor one of every `every` in between, or
 * none (0).
 */
static struct rho_track_report fly(uint8_t gate, int every)
{
    start(gate);
    describe(NEAR, 0.0f, 50000.0f);
    describe(FAR, 400000.0f, 50000.0f);
    for (int k = 0; k < 30; k++) {
        double t_s = 2.0 * k;
        /*
         * initiation is of all sensors: what is compared is what happens to a track that is there
         */
        struct rho_initiator *with = k < 8 ? &initiator : NULL;

        step(with, NEAR, 2 * k * SECOND_US, 10000.0 + 200.0 * t_s, 5000.0 + 40.0 * sin(t_s / 10.0),
             k);
        if (every > 0 && k >= 8 && k % every == 0) {
            /*
             * gate best weighs its hypotheses against the clutter, of which there is one measure
             * for all sensors
             */
            step(NULL, FAR, (2 * k + 1) * SECOND_US,
                 gate == RHO_TRACKER_BEST ? NAN : 400000.0 + 900.0 * k, 3000.0, k);
            assert_int_equal(report.num_tracks, 1);
            assert_int_equal(report.tracks[0].plot, -1);
        }
    }
    step(NULL, NEAR, 60 * SECOND_US, NAN, 0.0, 0);
    assert_int_equal(report.num_tracks, 1);
    return report.tracks[0];
}

static void who_cannot_see_a_track_changes_no_bit_of_it(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        struct rho_track_report alone = fly(gate, 0);

        for (int every = 1; every <= 3; every++) {
            struct rho_track_report beside = fly(gate, every);

            assert_memory_equal(beside.state, alone.state, sizeof alone.state);
            assert_memory_equal(beside.covariance, alone.covariance, sizeof alone.covariance);
            assert_memory_equal(beside.accel_mps2, alone.accel_mps2, sizeof alone.accel_mps2);
            assert_int_equal(beside.hits, alone.hits);
            assert_int_equal(beside.misses, alone.misses);
        }
    }
}

/* It is reported at their times all the same: moved on, and less sure. */
static void it_is_reported_where_it_will_be(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        float was_x_m, was_sigma_m;

        start(gate);
        describe(NEAR, 0.0f, 50000.0f);
        describe(FAR, 400000.0f, 50000.0f);
        for (int k = 0; k < 12; k++) {
            step(&initiator, NEAR, 2 * k * SECOND_US, 10000.0 + 400.0 * k, 5000.0, k);
        }
        assert_int_equal(report.num_tracks, 1);
        was_x_m = report.tracks[0].state[0];
        was_sigma_m = report.tracks[0].sigma_m;
        step(NULL, FAR, 27 * SECOND_US, NAN, 0.0, 0);
        assert_float_equal(report.tracks[0].state[0], was_x_m + 1000.0f, 150.0f);
        assert_true(report.tracks[0].sigma_m > 1.5f * was_sigma_m);
        assert_int_equal(report.tracks[0].update_age_us, 5 * SECOND_US);
    }
}

/* A track that nobody looks at is not carried on for ever. */
static void what_nobody_looks_at_ends(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start(gate);
        describe(FAR, 400000.0f, 50000.0f);
        for (int k = 0; k < 12; k++) {
            step(&initiator, NEAR, 2 * k * SECOND_US, 10000.0 + 400.0 * k, 5000.0, k);
        }
        assert_int_equal(report.num_tracks, 1);
        for (int k = 0; k < 20000 && report.num_tracks > 0; k++) {
            step(NULL, FAR, (30 + 10 * k) * SECOND_US, NAN, 0.0, 0);
        }
        assert_int_equal(report.num_tracks, 0);
    }
}

/*
 * A turn in 16 sectors, stepped one by one; the target goes round through them, and is as often at
 * an edge as not.
 */
static void no_plot_is_lost_at_the_edge_of_a_sector(void **state)
{
    const double width_rad = 6.283185307179586 / 16.0;

    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start(gate);
        describe(NEAR, 0.0f, 50000.0f);
        for (int k = 0; k < 68; k++) {
            double turned = 1.0 + (k - 8) / 20.0; /* sectors: at an edge every twenty turns */
            int is_at_edge = k % 20 == 8;
            /* the antenna's lobe is wide: the sector before may bring what is at the edge */
            int brings = ((int)floor(turned + 0.001) - (is_at_edge && k % 40 < 20)) & 15;
            double bearing_rad = width_rad * (turned + (k < 8 ? 0.0 : brings / 16.0 / 20.0));
            struct rho_plot plot = {
                .x_m = (float)(20000.0 * cos(bearing_rad)) + 8.0f * sinf(2.3f * (float)k),
                .y_m = (float)(20000.0 * sin(bearing_rad)) + 8.0f * cosf(5.1f * (float)k),
                .sigma_range_m = 10.0f,
                .sigma_cross_m = 10.0f};

            for (int sector = 0; sector < 16; sector++) {
                int is_turn = k < 8; /* initiation wants whole turns */
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
 * A fast target, and a plot of it that is some time older or younger than its scan: nowhere near
 * where it is at the scan's.
 */
static void a_plot_far_off_in_its_own_time_is_claimed(void **state)
{
    (void)state;
    for (uint8_t gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        for (int sign = -1; sign <= 1; sign += 2) {
            start(gate);
            describe(NEAR, 0.0f, 50000.0f);
            for (int k = 0; k < 12; k++) {
                step(&initiator, NEAR, 2 * k * SECOND_US, 10000.0 + 1000.0 * k, 5000.0, k);
            }
            assert_int_equal(report.num_tracks, 1);
            const float x_m = 22000.0f + 700.0f * (float)sign; /* 500 m/s, 1.4 s */
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
                        40.0f); /* at the scan's time */
        }
    }
}

/*
 * A radar of 16 sectors, 4 s a turn; the target flies straight, and then turns at 20 m/s^2. Between
 * looks a report goes on with the turn.
 */
static void between_looks_a_report_goes_on_with_the_turn(void **state)
{
    (void)state;
    const double turn_s = 4.0, radius_m = 3125.0, rate = 250.0 / 3125.0;
    double sum = 0.0, at_looks = 0.0;
    int count = 0, looks = 0;
    start(RHO_TRACKER_BEST);
    describe(NEAR, 0.0f, 50000.0f);
    for (int k = 0; k < 30 * 16; k++) {
        double t_s = turn_s * k / 16.0, angle = t_s > STRAIGHT_S ? rate * (t_s - STRAIGHT_S) : 0.0;
        double x_m = 5000.0 + 250.0 * fmin(t_s, STRAIGHT_S) + radius_m * sin(angle);
        double y_m = 500.0 + radius_m * (1.0 - cos(angle));
        int is_looked_at = k % 16 == 8;
        const struct rho_plot plot = {.x_m = (float)x_m + 8.0f * sinf(2.3f * (float)k),
                                      .y_m = (float)y_m + 8.0f * cosf(5.1f * (float)k),
                                      .sigma_range_m = 10.0f,
                                      .sigma_cross_m = 10.0f};
        /* one that looks where the target is, and fifteen that do not */
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
    assert_true(sqrt(sum / count) < 75.0); /* 58; 93 without the acceleration */
}

/*
 * A second radar at the same place sees a target beyond its range as far as eight standard
 * deviations of the track's place and a twentieth of its own range away, and no farther.
 */
static void the_margin_of_the_range_is_as_derived(void **state)
{
    static struct rho_tracker before;
    const float range_m = 2000.0f; /* of the target from it: both parts of the margin count */

    (void)state;
    start(RHO_TRACKER_NEAREST);
    describe(NEAR, 0.0f, 50000.0f);
    for (int k = 0; k < 20; k++) {
        step(&initiator, NEAR, 2 * k * SECOND_US, 10000.0 + 200.0 * k, 0.0, k);
    }
    assert_int_equal(report.num_tracks, 1);
    const struct rho_track_report track = report.tracks[0];
    const float margin_m = 8.0f * track.sigma_m + 0.05f * range_m;
    before = tracker;
    for (int is_within = 0; is_within <= 1; is_within++) {
        const float share = is_within ? 0.95f : 1.05f;
        const struct rho_plot plot = {.x_m = track.state[0],
                                      .y_m = track.state[1],
                                      .sigma_range_m = 60.0f, /* it may be a plot of the radar */
                                      .sigma_cross_m = 60.0f};
        const struct rho_scan scan = {
            .time_us = 38 * SECOND_US, .sensor_id = FAR, .num_plots = 1, .plots = &plot};

        tracker = before;
        describe(FAR, track.state[0] - range_m, range_m - share * margin_m);
        assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
        assert_int_equal(report.tracks[0].plot, is_within ? 0 : -1);
    }
}

/* Whether the plot is within the coverage, 1 .. 50 km to the east, 30 degrees to either side. */
static int is_covered(double x_m, double y_m, double sigma_range_m, double sigma_cross_m)
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
    start(RHO_TRACKER_NEAREST);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    assert_int_equal(tracker.counters.plots_outside, report.fates_total[RHO_FATE_INVALID]);
    return report.fates_total[RHO_FATE_INVALID] == 0;
}

/* A target at the border has plots up to four standard deviations beyond it. */
static void plots_just_beyond_the_coverage_are_of_it(void **state)
{
    (void)state;
    for (int beyond = 3; beyond <= 5; beyond += 2) {
        const double angle = 0.5 + 0.01 * beyond; /* 100 m at 10 km */
        const int expected = beyond < 4;
        assert_int_equal(is_covered(5e4 + 100.0 * beyond, 0.0, 100.0, 1.0), expected);
        assert_int_equal(is_covered(1e3 - 50.0 * beyond, 0.0, 50.0, 1.0), expected);
        assert_int_equal(is_covered(1e4 * cos(angle), 1e4 * sin(angle), 1.0, 100.0), expected);
        assert_int_equal(is_covered(1e4 * cos(angle), -1e4 * sin(angle), 1.0, 100.0), expected);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(who_cannot_see_a_track_changes_no_bit_of_it),
        cmocka_unit_test(it_is_reported_where_it_will_be),
        cmocka_unit_test(what_nobody_looks_at_ends),
        cmocka_unit_test(no_plot_is_lost_at_the_edge_of_a_sector),
        cmocka_unit_test(a_plot_far_off_in_its_own_time_is_claimed),
        cmocka_unit_test(the_margin_of_the_range_is_as_derived),
        cmocka_unit_test(plots_just_beyond_the_coverage_are_of_it),
        cmocka_unit_test(between_looks_a_report_goes_on_with_the_turn),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
