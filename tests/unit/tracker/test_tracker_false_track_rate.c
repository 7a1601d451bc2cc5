/* SPDX-License-Identifier: MIT */
/*
 * The wanted false-track rate while clutter changes: a dense start, a plot far away, a pause,
 * sensors of different measurements, a narrow sector. All plots are clutter, so every confirmed
 * track is false.
 */
#include "initiator_setup.h"

#include "rhotrack/tracker.h"

#define SCAN_S 2.0

static struct rho_tracker tracker;
static struct rho_report report;
static double side_m, time_s;
static int32_t sensor_id;

/* Allows one false track an hour; the area is given or measured. */
static void start_tracker(double side, int area_is_fixed)
{
    struct rho_initiator_config config;
    struct rho_tracker_config maintain;
    rho_initiator_config_default(&config);
    rho_tracker_config_default(&maintain);
    config.v_min_mps = 100.0f;
    config.v_max_mps = maintain.v_max_mps = 400.0f;
    config.area_is_fixed = area_is_fixed;
    config.area = (struct rho_extent){0.0f, (float)side, 0.0f, (float)side};
    start_initiator(&config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &maintain), RHO_OK);
    side_m = side;
    time_s = 0.0;
    sensor_id = 0;
}

static void step_scan(uint32_t measures)
{
    struct rho_scan scan = {.time_us = llround(time_s * 1e6),
                            .sensor_id = sensor_id,
                            .measures = measures,
                            .num_plots = num_plots,
                            .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    num_plots = 0;
    time_s += SCAN_S;
}

static void step_scan_of_clutter(int count, uint32_t measures)
{
    for (int i = 0; i < count; i++) {
        struct rho_plot *plot = add_plot(uniform(0.0, side_m), uniform(0.0, side_m), 10.0, 10.0);
        plot->z_m = (float)uniform(0.0, 20000.0);
        plot->sigma_up_m = 10.0f;
        plot->range_rate_mps = (float)uniform(-400.0, 400.0);
        plot->sigma_range_rate_mps = 1.0f;
    }
    step_scan(measures);
}

static unsigned count_tracks_confirmed_so_far(void)
{
    return tracker.counters.tracks_confirmed;
}

/* 60 plots a km^2: no set of three plots is evidence, however well it fits. */
static void very_dense_clutter_at_the_start_confirms_nothing(void **state)
{
    (void)state;
    unsigned sum = 0;
    random_state = 3;
    for (int run = 0; run < 4; run++) {
        start_tracker(1826.0, 1);
        for (int k = 0; k < 6; k++) {
            step_scan_of_clutter(poisson(50.0) + poisson(50.0) + poisson(50.0) + poisson(50.0), 0);
        }
        sum += count_tracks_confirmed_so_far();
    }
    assert_int_equal(sum, 0);
}

/* The far plot would make the area a thousand times as large, and clutter as thin. */
static void a_plot_far_out_does_not_lower_the_clutter_density(void **state)
{
    (void)state;
    random_state = 5;
    start_tracker(10000.0, 0);
    for (int k = 0; k < 600; k++) {
        if (k == 20) {
            add_plot(1.9e6, 1.9e6, 10.0, 10.0);
        }
        step_scan_of_clutter(poisson(10.0), 0);
    }
    assert_true(count_tracks_confirmed_so_far() <= 4); /* expected number 0.3 */
}

static void a_pause_does_not_lower_the_clutter_density(void **state)
{
    (void)state;
    unsigned sum = 0;
    random_state = 7;
    for (int run = 0; run < 6; run++) {
        start_tracker(10000.0, 0);
        for (int k = 0; k < 32; k++) {
            time_s += k == 20 ? 600.0 : 0.0;
            step_scan_of_clutter(poisson(50.0) + poisson(50.0), 0);
        }
        sum += count_tracks_confirmed_so_far();
    }
    assert_true(sum <= 2); /* expected number 0.1 */
}

/* A coordinate that one sensor does not measure must not count as known to a millimetre. */
static void sensors_of_different_measurements_keep_the_false_track_rate(void **state)
{
    (void)state;
    random_state = 9;
    for (uint32_t more = RHO_MEASURES_Z; more <= RHO_MEASURES_RANGE_RATE;
         more += RHO_MEASURES_RANGE_RATE - RHO_MEASURES_Z) {
        start_tracker(10000.0, 1);
        for (int k = 0; k < 600; k++) {
            sensor_id = k % 2;
            step_scan_of_clutter(poisson(30.0), k % 2 ? more : 0);
        }
        assert_true(count_tracks_confirmed_so_far() <= 5); /* expected number 0.3 */
    }
}

/* A sector of 0.2 rad: most of the square around the plots is empty. */
static void a_narrow_sector_keeps_the_false_track_rate(void **state)
{
    (void)state;
    random_state = 13;
    start_tracker(0.0, 0);
    for (int k = 0; k < 1500; k++) {
        int count = poisson(20.0);
        for (int i = 0; i < count; i++) {
            double range_m = uniform(1000.0, 65000.0), azimuth_rad = uniform(0.0, 0.2);
            add_plot(range_m * cos(azimuth_rad), range_m * sin(azimuth_rad), 15.0, 0.003 * range_m);
        }
        step_scan(0);
    }
    assert_true(count_tracks_confirmed_so_far() <= 5); /* expected number 0.8 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(very_dense_clutter_at_the_start_confirms_nothing),
        cmocka_unit_test(a_plot_far_out_does_not_lower_the_clutter_density),
        cmocka_unit_test(a_pause_does_not_lower_the_clutter_density),
        cmocka_unit_test(sensors_of_different_measurements_keep_the_false_track_rate),
        cmocka_unit_test(a_narrow_sector_keeps_the_false_track_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
