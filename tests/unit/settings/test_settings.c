/* SPDX-License-Identifier: MIT */
#include "rhotrack/settings.h"
#include "tracker_setup.h"

static struct rho_settings settings;
static struct rho_passive_config search;
static struct rho_passive passive;

/* Applies the settings to default configurations, as a program does. */
static void apply_settings(void)
{
    memset(&config, 0, sizeof config);
    memset(&initiation, 0, sizeof initiation);
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&initiation);
    rho_passive_config_default(&search);
    rho_settings_apply(&settings, &config, &initiation, &search);
}

/*
 * Initialises a tracker, an initiator and a passive search, and sets a sensor, all with the
 * settings.
 */
static void init_objects_with_settings(void)
{
    struct rho_sensor sensor = {.sensor_id = 1};

    apply_settings();
    begin_tracker();
    assert_int_equal(rho_passive_init(&passive, sizeof passive, &search), RHO_OK);
    rho_settings_apply_sensor(&settings, &sensor);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

/* Defaults and fields */

static void test_default_settings_leave_the_default_configs(void **state)
{
    struct rho_tracker_config track = {0};
    struct rho_initiator_config start = {0};

    (void)state;
    rho_tracker_config_default(&track);
    rho_initiator_config_default(&start);
    rho_settings_default(&settings);
    apply_settings();
    assert_memory_equal(&config, &track, sizeof track);
    assert_memory_equal(&initiation, &start, sizeof start);
}

static void test_each_field_goes_to_its_configs(void **state)
{
    struct rho_sensor sensor = {.sensor_id = 7, .x_m = 5.0f};
    struct rho_polar_plot plot = {.range_m = 99.0f};

    (void)state;
    settings = (struct rho_settings){.v_min_mps = 2.0f,
                                     .v_max_mps = 70.0f,
                                     .accel_max_mps2 = 4.0f,
                                     .pd = 0.7f,
                                     .scan_interval_s = 3.0f,
                                     .sigma_range_m = 11.0f,
                                     .sigma_azimuth_rad = 0.012f,
                                     .sigma_elevation_rad = 0.013f,
                                     .sigma_range_rate_mps = 1.4f,
                                     .range_min_m = 10.0f,
                                     .range_max_m = 20000.0f,
                                     .area_is_fixed = 1,
                                     .area = {-1.0f, 2.0f, -3.0f, 4.0f},
                                     .false_tracks_per_hour = 0.5f,
                                     .scans = 6,
                                     .min_scans = 4,
                                     .coast_scans_max = 9,
                                     .work_max = 1234};
    apply_settings();
    assert_true(config.v_min_mps == 2.0f && config.v_max_mps == 70.0f && config.pd == 0.7f);
    assert_true(config.accel_max_mps2 == 4.0f && config.late_max_s == 6.0f);
    assert_true(config.coast_scans_max == 9 && config.work_max == 1234);
    assert_true(initiation.v_min_mps == 2.0f && initiation.v_max_mps == 70.0f);
    assert_true(initiation.pd == 0.7f && initiation.false_tracks_per_hour == 0.5f);
    assert_true(initiation.turn_mps2 == 0.2f * 4.0f && initiation.work_max == 1234);
    assert_true(initiation.scans == 6 && initiation.min_scans == 4);
    assert_true(initiation.area_is_fixed == 1);
    assert_memory_equal(&initiation.area, &settings.area, sizeof settings.area);
    assert_true(search.v_max_mps == 70.0f && search.pd == 0.7f && search.range_max_m == 20000.0f);
    assert_true(search.false_tracks_per_hour == 0.5f && search.scans == 8);
    assert_true(search.work_max == 1234);
    rho_settings_apply_sensor(&settings, &sensor);
    assert_true(sensor.pd == 0.7f && sensor.range_min_m == 10.0f && sensor.range_max_m == 20000.0f);
    assert_true(sensor.sensor_id == 7 && sensor.x_m == 5.0f);
    rho_settings_apply_noise(&settings, &plot);
    assert_true(plot.sigma_range_m == 11.0f && plot.sigma_azimuth_rad == 0.012f);
    assert_true(plot.sigma_elevation_rad == 0.013f && plot.sigma_range_rate_mps == 1.4f);
    assert_true(plot.range_m == 99.0f);
    rho_settings_apply(&settings, NULL, NULL, NULL);
}

static void test_derived_fields_keep_to_their_limits(void **state)
{
    (void)state;
    rho_settings_default(&settings);
    settings.scan_interval_s = 40.0f;
    settings.range_max_m = 600000.0f;
    apply_settings();
    assert_true(config.late_max_s == 60.0f);
    assert_true(search.range_max_m == 500000.0f);
    settings.range_max_m = 200.0f;
    apply_settings();
    assert_true(search.range_max_m == 1000.0f);
}

/* Bounds */

static const struct bounds {
    const char *field;
    float *value;
    float min, max;
    int is_open; /* max itself is refused */
} bounds[] = {
    {"v_max_mps", &settings.v_max_mps, 1.0f, 2e4f, 0},
    {"v_min_mps", &settings.v_min_mps, 0.0f, 700.0f, 1},
    {"accel_max_mps2", &settings.accel_max_mps2, 0.0f, 1000.0f, 0},
    {"pd", &settings.pd, 0.01f, 0.999f, 0},
    {"scan_interval_s", &settings.scan_interval_s, 1e-3f, 3600.0f, 0},
    {"sigma_range_m", &settings.sigma_range_m, 1e-3f, 1e5f, 0},
    {"sigma_azimuth_rad", &settings.sigma_azimuth_rad, 1e-6f, 0.5f, 0},
    {"sigma_elevation_rad", &settings.sigma_elevation_rad, 1e-6f, 0.5f, 0},
    {"sigma_range_rate_mps", &settings.sigma_range_rate_mps, 1e-3f, 1e5f, 0},
    {"sigma_rad", &settings.sigma_rad, 1e-6f, 0.5f, 0},
    {"range_max_m", &settings.range_max_m, 1.0f, 4e6f, 0},
    {"range_min_m", &settings.range_min_m, 0.0f, 1e5f, 1},
    {"area.x_max_m", &settings.area.x_max_m, -2e6f, 2e6f, 0},
    {"area.y_max_m", &settings.area.y_max_m, -2e6f, 2e6f, 0},
    {"area.x_min_m", &settings.area.x_min_m, -2e6f, 1e4f, 1},
    {"area.y_min_m", &settings.area.y_min_m, -2e6f, 1e4f, 1},
    {"false_tracks_per_hour", &settings.false_tracks_per_hour, 1e-6f, 1e6f, 0},
};

static void set_defaults_with_area(void)
{
    rho_settings_default(&settings);
    settings.area_is_fixed = 1;
    settings.area = (struct rho_extent){-1e4f, 1e4f, -1e4f, 1e4f};
}

static void assert_settings_refused(const char *field, float value, float min, float max)
{
    struct rho_settings_fault fault = {0};

    assert_int_equal(rho_settings_check(&settings, &fault), RHO_ERROR_CONFIG);
    assert_int_equal(rho_settings_check(&settings, NULL), RHO_ERROR_CONFIG);
    assert_string_equal(fault.field, field);
    assert_true(fault.value == value || (isnan(value) && isnan(fault.value)));
    assert_true(fault.min == min && fault.max == max);
}

static void assert_settings_accepted(void)
{
    struct rho_settings_fault fault = {.value = 42.0f};

    assert_int_equal(rho_settings_check(&settings, &fault), RHO_OK);
    assert_true(fault.value == 42.0f);
    init_objects_with_settings();
}

static void test_each_number_beyond_its_bounds_is_refused_by_name(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
        const struct bounds *field = &bounds[i];
        const float below = nextafterf(field->min, -INFINITY);
        const float above = field->is_open ? field->max : nextafterf(field->max, INFINITY);
        const float refused[] = {below, above, -INFINITY, INFINITY, NAN};

        for (size_t k = 0; k < sizeof refused / sizeof *refused; k++) {
            set_defaults_with_area();
            *field->value = refused[k];
            assert_settings_refused(field->field, refused[k], field->min, field->max);
        }
    }
}

static void test_each_number_at_its_bounds_is_accepted(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof bounds / sizeof *bounds; i++) {
        const struct bounds *field = &bounds[i];

        for (int at_max = 0; at_max < 2; at_max++) {
            set_defaults_with_area();
            settings.area.x_min_m = settings.area.y_min_m = -2e6f;
            *field->value = field->is_open ? nextafterf(field->max, -INFINITY) : field->max;
            if (!at_max) {
                settings.v_min_mps = settings.range_min_m = 0.0f;
                *field->value = field->min;
            }
            if (settings.area.x_max_m > -2e6f && settings.area.y_max_m > -2e6f) {
                assert_settings_accepted();
            }
        }
    }
}

static void test_counts_beyond_their_bounds_are_refused(void **state)
{
    (void)state;
    rho_settings_default(&settings);
    settings.scans = settings.min_scans = 3;
    settings.coast_scans_max = 1;
    settings.work_max = 0;
    assert_settings_accepted();
    settings.scans = settings.min_scans = RHO_MAX_SCANS;
    settings.coast_scans_max = 255;
    settings.work_max = RHO_LIMIT_WORK;
    assert_settings_accepted();
    settings.work_max++;
    assert_settings_refused("work_max", 1e8f, 0.0f, 1e8f);
    settings.coast_scans_max = 256;
    assert_settings_refused("coast_scans_max", 256.0f, 1.0f, 255.0f);
    settings.coast_scans_max = 0;
    assert_settings_refused("coast_scans_max", 0.0f, 1.0f, 255.0f);
    settings.coast_scans_max = 5;
    settings.standing = 2;
    assert_settings_refused("standing", 2.0f, 0.0f, 1.0f);
    settings.standing = RHO_STANDING_TARGETS;
    settings.min_scans = RHO_MAX_SCANS + 1;
    assert_settings_refused("min_scans", RHO_MAX_SCANS + 1.0f, 3.0f, RHO_MAX_SCANS);
    settings.min_scans = 2;
    assert_settings_refused("min_scans", 2.0f, 3.0f, RHO_MAX_SCANS);
    settings.scans = RHO_MAX_SCANS + 1;
    assert_settings_refused("scans", RHO_MAX_SCANS + 1.0f, 3.0f, RHO_MAX_SCANS);
    settings.scans = 2;
    assert_settings_refused("scans", 2.0f, 3.0f, RHO_MAX_SCANS);
}

static void test_an_unused_area_is_not_checked(void **state)
{
    (void)state;
    rho_settings_default(&settings);
    settings.area.x_min_m = NAN;
    assert_settings_accepted();
}

static void test_no_settings_are_refused(void **state)
{
    struct rho_settings_fault fault = {.value = 42.0f};

    (void)state;
    assert_int_equal(rho_settings_check(NULL, &fault), RHO_ERROR_NULL);
    assert_true(fault.value == 42.0f);
}

/* Presets */

#define SCANS 60
#define TURN_FROM 30 /* scan from which on the target makes a right-angled turn */
#define CLUTTER 20   /* clutter plots a scan, over the whole range */

/* A typical target of each preset. */
static const struct target {
    enum rho_preset preset;
    double range_m, speed_mps;
    uint32_t measures;
} targets[RHO_NUM_PRESETS] = {
    {RHO_PRESET_EN_ROUTE, 150e3, 240.0, 0},
    {RHO_PRESET_APPROACH, 30e3, 120.0, 0},
    {RHO_PRESET_MARINE, 8e3, 9.0, 0},
    {RHO_PRESET_COASTAL_HARBOUR, 6e3, 7.0, 0},
    {RHO_PRESET_DRONE_DEFENCE, 3e3, 18.0, RHO_MEASURES_RANGE_RATE},
    {RHO_PRESET_TRAFFIC, 60.0, 14.0, RHO_MEASURES_RANGE_RATE},
};

static struct mover {
    double x_m, y_m, heading_rad, speed_mps;
} mover;

/* Moves the target to the next scan in a hundred steps. */
static void move_target(int k)
{
    const double dt_s = (double)settings.scan_interval_s / 100.0;
    const double rate_radps = 0.5 * (double)settings.accel_max_mps2 / mover.speed_mps;

    for (int i = 0; i < 100; i++) {
        if (k >= TURN_FROM && mover.heading_rad < 1.5707963) {
            mover.heading_rad += rate_radps * dt_s;
        }
        mover.x_m += mover.speed_mps * cos(mover.heading_rad) * dt_s;
        mover.y_m += mover.speed_mps * sin(mover.heading_rad) * dt_s;
    }
}

static void add_polar(double range_m, double azimuth_rad, double rate_mps, uint32_t measures)
{
    struct rho_polar_plot polar = {.range_m = (float)range_m,
                                   .azimuth_rad = (float)remainder(azimuth_rad, 6.283185307179586),
                                   .range_rate_mps = (float)rate_mps};

    rho_settings_apply_noise(&settings, &polar);
    assert_int_equal(rho_measurement_from_polar(&polar, measures, NULL, &plots[num_plots++]),
                     RHO_OK);
}

static void add_scan_plots(uint32_t measures)
{
    const double range_m = hypot(mover.x_m, mover.y_m);
    const double azimuth_rad = atan2(mover.y_m, mover.x_m);
    const double rate_mps = mover.speed_mps * cos(mover.heading_rad - azimuth_rad);
    const double dr_m = (double)settings.sigma_range_m * normal();
    const double da_rad = (double)settings.sigma_azimuth_rad * normal();
    const double dv_mps = (double)settings.sigma_range_rate_mps * normal();

    if (uniform(0.0, 1.0) < (double)settings.pd) {
        add_polar(range_m + dr_m, azimuth_rad + da_rad, rate_mps + dv_mps, measures);
    }
    for (int i = 0; i < CLUTTER; i++) {
        const double at_m =
            uniform((double)settings.range_min_m + 1.0, (double)settings.range_max_m);
        const double at_rad = uniform(-3.1, 3.1);

        add_polar(at_m, at_rad, uniform(-20.0, 20.0), measures);
    }
}

static double distance_m(const struct rho_track_report *track)
{
    return hypot((double)track->state[0] - mover.x_m, (double)track->state[1] - mover.y_m);
}

/* Checks that at most one track is confirmed, within four of the plots' standard deviations. */
static void check_at_most_one_confirmed_track(uint32_t *track_id)
{
    const double across_m = hypot(mover.x_m, mover.y_m) * (double)settings.sigma_azimuth_rad;
    const double sigma_m = fmax(across_m, (double)settings.sigma_range_m);

    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];

        if (track->status != RHO_TRACK_TENTATIVE) {
            assert_true(*track_id == 0 || *track_id == track->track_id);
            assert_true(distance_m(track) < 4.0 * sigma_m);
            *track_id = track->track_id;
        }
    }
}

static void test_each_preset_tracks_its_target(void **state)
{
    (void)state;
    for (size_t i = 0; i < RHO_NUM_PRESETS; i++) {
        const struct target *target = &targets[i];
        uint32_t track_id = 0;

        random_state = 1;
        rho_settings_preset(&settings, target->preset);
        /* ships at berth, hovering drones and queues stand; aircraft do not */
        assert_int_equal(settings.standing, target->preset > RHO_PRESET_APPROACH);
        assert_settings_accepted();
        mover =
            (struct mover){-0.6 * target->range_m, 0.8 * target->range_m, 0.0, target->speed_mps};
        for (int k = 0; k < SCANS; k++) {
            add_scan_plots(target->measures);
            step_scan(
                (struct rho_scan){.time_us = llround(k * (double)settings.scan_interval_s * 1e6),
                                  .sensor_id = 1,
                                  .measures = target->measures});
            check_at_most_one_confirmed_track(&track_id);
            assert_true(track_id > 0 || k < 7);
            move_target(k);
        }
        assert_int_equal(tracker.counters.tracks_confirmed, 1);
        assert_non_null(report_of(track_id));
    }
}

static void test_an_unknown_preset_gives_the_default_settings(void **state)
{
    struct rho_settings expected;

    (void)state;
    memset(&settings, 0, sizeof settings);
    memset(&expected, 0, sizeof expected);
    rho_settings_default(&expected);
    rho_settings_preset(&settings, RHO_NUM_PRESETS);
    assert_memory_equal(&settings, &expected, sizeof expected);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_default_settings_leave_the_default_configs),
        cmocka_unit_test(test_each_field_goes_to_its_configs),
        cmocka_unit_test(test_derived_fields_keep_to_their_limits),
        cmocka_unit_test(test_each_number_beyond_its_bounds_is_refused_by_name),
        cmocka_unit_test(test_each_number_at_its_bounds_is_accepted),
        cmocka_unit_test(test_counts_beyond_their_bounds_are_refused),
        cmocka_unit_test(test_an_unused_area_is_not_checked),
        cmocka_unit_test(test_no_settings_are_refused),
        cmocka_unit_test(test_each_preset_tracks_its_target),
        cmocka_unit_test(test_an_unknown_preset_gives_the_default_settings),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
