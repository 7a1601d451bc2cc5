/* SPDX-License-Identifier: MIT */
/*
 * Density of clutter in the initiation: maps over the ground or over a radar's range and azimuth,
 * and the share of each sensor.
 */
#include "initiator_setup.h"

#define SCANS 6 /* even, so that two sensors have equal numbers */
#define SCAN_S 2.0
#define RANGE_M 10000.0

static const struct rho_extent around = {-10000.0f, 10000.0f, -10000.0f, 10000.0f};
static const double around_m2 = 20000.0 * 20000.0;

static struct rho_initiator_config test_config(void)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.scans = SCANS;
    config.min_scans = SCANS; /* candidates do not matter in this test */
    config.v_max_mps = 400.0f;
    config.area_is_fixed = 1;
    config.area = around;
    return config;
}

static double density_at(int32_t sensor_id, double x_m, double y_m)
{
    double density = rho_initiator_density(&initiator, sensor_id, (float)x_m, (float)y_m);
    assert_true(isfinite(density));
    assert_true(density > 0.0);
    return density;
}

/* Scans of sensors 1 and 2 in turn, with these numbers of clutter plots. */
static void search_two_sensors(int first, int second)
{
    struct rho_initiator_config config = test_config();
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_clutter_plots(&around, k % 2 ? second : first);
        push_scan((struct rho_scan){.sensor_id = k % 2 ? 2 : 1}, SCAN_S * k, NULL);
    }
    search_window(RHO_SEARCH_BATCH);
}

static void the_sensor_with_more_clutter_has_the_higher_density(void **state)
{
    (void)state;
    static const int counts[][2] = {{10, 20}, {10, 40}, {5, 100}, {60, 90}, {0, 30}};
    for (size_t i = 0; i < NUM(counts); i++) {
        search_two_sensors(counts[i][0], counts[i][1]);
        double first = density_at(1, 3000.0, 3000.0), second = density_at(2, 3000.0, 3000.0);
        assert_true(second > 1.05 * first);
        assert_true(second * counts[i][0] < first * counts[i][1]);
        search_two_sensors(counts[i][1], counts[i][0]);
        assert_true(density_at(1, 3000.0, 3000.0) > 1.05 * density_at(2, 3000.0, 3000.0));
    }
}

/*
 * Three scans of a sensor are averaged with one scan of the mean, 10 plots: 16 and 4 plots a scan
 * count as 14.5 and 5.5.
 */
static void a_sensors_density_is_averaged_with_one_mean_scan(void **state)
{
    (void)state;
    search_two_sensors(4, 16);
    double mean = density_at(99, 0.0, 0.0);
    assert_float_equal(mean, 10.0 / around_m2, 0.001 * mean);
    assert_float_equal(density_at(1, 0.0, 0.0), 5.5 / around_m2, 0.001 * mean);
    assert_float_equal(density_at(2, 0.0, 0.0), 14.5 / around_m2, 0.001 * mean);
}

static void a_single_sensor_and_unknown_ones_have_the_mean_density(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        /* a single sensor's scans may differ without making it several sensors */
        add_clutter_plots(&around, 5 * k);
        push_scan((struct rho_scan){.sensor_id = -7}, SCAN_S * k, NULL);
    }
    search_window(RHO_SEARCH_BATCH);
    for (double x_m = -9000.0; x_m < 10000.0; x_m += 1000.0) {
        double own = density_at(-7, x_m, 2000.0);
        assert_float_equal(own, density_at(0, x_m, 2000.0), 0.0);
        assert_float_equal(own, density_at(INT32_MAX, x_m, 2000.0), 0.0);
    }
    assert_float_equal(density_at(-7, 0.0, 0.0), 12.5 / around_m2, 0.3 * 12.5 / around_m2);
    assert_float_equal(initiator.density_per_m2, 12.5 / around_m2, 1e-3 * 12.5 / around_m2);
}

static void a_search_after_every_scan_has_densities_of_sensors(void **state)
{
    (void)state;
    search_two_sensors(4, 16);
    search_window(RHO_SEARCH_NEWEST);
    double ratio = density_at(2, 0.0, 0.0) / density_at(1, 0.0, 0.0);
    assert_float_equal(ratio, 14.5 / 5.5, 0.01);
}

/*
 * Adds clutter uniform in range and azimuth about the radar, and `more` plots in a hot spot of a
 * tenth of the circle and a quarter of the range.
 */
static void add_polar_clutter(const struct rho_sensor *radar, int count, int more,
                              double sigma_cross_m)
{
    for (int i = 0; i < count + more; i++) {
        int hot = i >= count;
        double range_m = hot ? uniform(0.5, 0.75) * RANGE_M : uniform(0.0, RANGE_M);
        double azimuth = hot ? uniform(0.2, 0.4) * PI : uniform(-PI, PI);
        add_plot(radar->x_m + range_m * cos(azimuth), radar->y_m + range_m * sin(azimuth), 10.0,
                 sigma_cross_m);
    }
}

static void search_radar_window(const struct rho_sensor *radar, int count, int more,
                                double sigma_cross_m)
{
    struct rho_initiator_config config = test_config();
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_polar_clutter(radar, count, more, sigma_cross_m);
        push_scan((struct rho_scan){.sensor_id = radar->sensor_id}, SCAN_S * k, radar);
    }
    search_window(RHO_SEARCH_BATCH);
}

/*
 * Mean over directions and windows of the density at a range, relative to the true one, count / (2
 * pi range RANGE_M).
 */
static double mean_density_ratio(const struct rho_sensor *radar, double range_m, int count)
{
    double sum = 0.0;
    for (int window = 0; window < 20; window++) {
        random_state = (uint64_t)window + 1;
        search_radar_window(radar, count, 0, 100.0);
        for (double azimuth = -3.0; azimuth < 3.1; azimuth += 0.5) {
            double density = density_at(radar->sensor_id, radar->x_m + range_m * cos(azimuth),
                                        radar->y_m + range_m * sin(azimuth));
            sum += density * 2.0 * PI * range_m * RANGE_M / count / 20.0 / 13.0;
        }
    }
    return sum;
}

static void the_density_of_a_radars_clutter_falls_with_range(void **state)
{
    (void)state;
    const struct rho_sensor middle = sensor_at(0.0, 0.0), beside = sensor_at(-1500.0, 2500.0);
    static const double ranges_m[] = {300.0, 1000.0, 2500.0, 5000.0, 9000.0};
    for (size_t i = 0; i < NUM(ranges_m); i++) {
        /* a map of one cell */
        assert_float_equal(mean_density_ratio(&middle, ranges_m[i], 5), 1.0, 0.1);
        assert_float_equal(mean_density_ratio(&middle, ranges_m[i], 100), 1.0, 0.15);
        assert_float_equal(mean_density_ratio(&beside, ranges_m[i], 100), 1.0, 0.15);
    }
}

static void the_density_is_bounded_near_the_radar(void **state)
{
    (void)state;
    const struct rho_sensor radar = sensor_at(500.0, 500.0);
    search_radar_window(&radar, 5, 0, 100.0); /* a map of one cell, equal in all directions */
    double at_radar = density_at(0, 500.0, 500.0);
    assert_float_equal(density_at(0, 500.0, 550.0), at_radar, 0.0);
    assert_float_equal(density_at(0, 500.0, 1500.0) / at_radar, 0.1, 0.01);
    assert_true(density_at(0, 500.0, 1.0e6) > 0.0);
    assert_true(density_at(0, 1.0e6, -1.0e6) > 0.0);
}

/* No plots, or plots at the radar's own place, which have no range. */
static void windows_without_plots_or_ranges_have_a_density(void **state)
{
    (void)state;
    struct rho_initiator_config config = test_config();
    const struct rho_sensor radar = sensor_at(0.0, 0.0);
    for (int count = 0; count < 3; count++) {
        for (int kind = RHO_SEARCH_BATCH; kind <= RHO_SEARCH_NEWEST; kind++) {
            start_initiator(&config);
            for (int k = 0; k < SCANS; k++) {
                for (int i = 0; i < count; i++) {
                    add_plot(0.0, 0.0, 10.0, 100.0);
                }
                push_scan((struct rho_scan){0}, SCAN_S * k, &radar);
                search_window((enum rho_search)kind);
                density_at(0, 0.0, 0.0);
                density_at(0, 5000.0, -5000.0);
            }
        }
    }
}

static void a_hot_spot_in_range_and_azimuth_has_a_higher_density(void **state)
{
    (void)state;
    const struct rho_sensor radar = sensor_at(0.0, 0.0);
    double hot = 0.0, cold = 0.0, plain = 0.0;
    for (int window = 0; window < 20; window++) {
        search_radar_window(&radar, 100, 50, 100.0);
        double range_m = 0.625 * RANGE_M, azimuth = 0.3 * PI;
        hot += density_at(0, range_m * cos(azimuth), range_m * sin(azimuth)) / 20.0;
        cold += density_at(0, -range_m * cos(azimuth), range_m * sin(azimuth)) / 20.0;
        search_radar_window(&radar, 100, 0, 100.0);
        plain += density_at(0, range_m * cos(azimuth), range_m * sin(azimuth)) / 20.0;
    }
    /* the spot has 21 times the plots, but is smaller than a cell */
    assert_true(hot > 4.0 * plain);
    assert_true(hot > 5.0 * cold);
    assert_float_equal(cold, plain, 0.5 * plain);
}

#if RHO_MAX_DENSITY_MAPS > 1
/* Two radars in turn, with different numbers of plots, uniform in their own range and azimuth. */
static void search_two_radars(const struct rho_sensor radars[2], const int counts[2],
                              enum rho_search kind)
{
    struct rho_initiator_config config = test_config();
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        add_polar_clutter(&radars[k % 2], counts[k % 2], 0, 100.0);
        push_scan((struct rho_scan){.sensor_id = radars[k % 2].sensor_id}, SCAN_S * k,
                  &radars[k % 2]);
    }
    search_window(kind);
}

/* Mean over directions of a radar's density at a range, relative to the true one. */
static double density_ratio(const struct rho_sensor *radar, double range_m, int count)
{
    double sum = 0.0;
    for (double azimuth = -3.0; azimuth < 3.1; azimuth += 0.5) {
        double density = density_at(radar->sensor_id, radar->x_m + range_m * cos(azimuth),
                                    radar->y_m + range_m * sin(azimuth));
        sum += density * 2.0 * PI * range_m * RANGE_M / count / 13.0;
    }
    return sum;
}

static void each_of_two_radars_has_its_own_density(void **state)
{
    (void)state;
    struct rho_sensor radars[2] = {sensor_at(-3000.0, 0.0), sensor_at(3000.0, 0.0)};
    static const int counts[2] = {100, 30};
    static const double ranges_m[] = {300.0, 1000.0, 2500.0, 5000.0, 9000.0};
    double sums[2][NUM(ranges_m)] = {{0.0}};
    radars[1].sensor_id = 2;
    for (int window = 0; window < 20; window++) {
        random_state = (uint64_t)window + 1;
        search_two_radars(radars, counts, window % 2 ? RHO_SEARCH_NEWEST : RHO_SEARCH_BATCH);
        for (size_t i = 0; i < 2 * NUM(ranges_m); i++) {
            sums[i % 2][i / 2] +=
                density_ratio(&radars[i % 2], ranges_m[i / 2], counts[i % 2]) / 20.0;
        }
    }
    for (size_t i = 0; i < 2 * NUM(ranges_m); i++) {
        assert_float_equal(sums[i % 2][i / 2], 1.0, 0.2);
    }
}

/*
 * At a place that one of two radars covers, the mean scan has half of its clutter. Sensor 99 is
 * unknown and has the mean.
 */
static void a_radars_clutter_does_not_count_beyond_its_range(void **state)
{
    (void)state;
    struct rho_sensor radars[2] = {sensor_at(-3000.0, 0.0), sensor_at(3000.0, 0.0)};
    static const int counts[2] = {30, 30};
    radars[0].sensor_id = 1;
    radars[1].sensor_id = 2;
    for (int window = 0; window < 10; window++) {
        search_two_radars(radars, counts, RHO_SEARCH_BATCH);
        double own = density_at(2, 10500.0, 0.0);
        assert_true(density_at(1, 10500.0, 0.0) > 0.0);
        assert_float_equal(rho_initiator_density(&initiator, 99, 10500.0f, 0.0f), 0.5 * own,
                           0.05 * own);
    }
}
#endif

/* The map of `count` plots at even azimuths of a sector about east, with ranges that vary. */
static const struct rho_density_map *sector_map(int count, double sector_rad)
{
    struct rho_initiator_config config = test_config();
    const struct rho_sensor radar = sensor_at(0.0, 0.0);
    int added = 0;
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        for (; added < count * (k + 1) / SCANS; added++) {
            const double azimuth_rad = sector_rad * ((double)added / (count - 1) - 0.5);
            const double range_m = 500.0 + 7000.0 * (added * 7 % count) / (count - 1.0);
            add_plot(range_m * cos(azimuth_rad), range_m * sin(azimuth_rad), 10.0, 100.0);
        }
        push_scan((struct rho_scan){0}, SCAN_S * k, &radar);
    }
    search_window(RHO_SEARCH_BATCH);
    return &initiator.density[0];
}

static void a_sector_is_recognised_from_16_plots_on(void **state)
{
    (void)state;
    assert_int_equal(sector_map(15, 0.5)->is_polar, 0);
    assert_int_equal(sector_map(16, 0.5)->is_polar, 1);
}

/*
 * A sector is extended by the mean gap between plots; from 5 rad on it counts as the whole circle.
 */
static void a_sector_of_5_rad_or_more_is_taken_as_the_circle(void **state)
{
    (void)state;
    assert_float_equal(sector_map(61, 4.9 * 60.0 / 62.0)->height, 4.9, 1e-3);
    assert_float_equal(sector_map(61, 5.1 * 60.0 / 62.0)->height, 2.0 * PI, 1e-5);
    assert_float_equal(sector_map(61, 0.0)->height, 1e-3, 1e-9);
}

/*
 * Expects the same density everywhere: five plots a scan make a single cell, which is uniform in a
 * map of the ground.
 */
static void expect_uniform_density(double sigma_cross_m, const struct rho_sensor *even,
                                   const struct rho_sensor *odd)
{
    struct rho_initiator_config config = test_config();
    start_initiator(&config);
    for (int k = 0; k < SCANS; k++) {
        const struct rho_sensor *sensor = k % 2 ? odd : even;
        for (int i = 0; i < 5; i++) {
            add_plot(uniform(-9000.0, 9000.0), uniform(-9000.0, 9000.0), 10.0, sigma_cross_m);
        }
        push_scan((struct rho_scan){.sensor_id = sensor->sensor_id}, SCAN_S * k, sensor);
    }
    search_window(RHO_SEARCH_BATCH);
    for (double x_m = 0.0; x_m < 10000.0; x_m += 500.0) {
        double mean = 5.0 / around_m2;
        assert_float_equal(density_at(even->sensor_id, x_m, x_m), mean, 1e-4 * mean);
    }
}

static void the_map_is_of_the_ground_without_one_radar_inside_the_area(void **state)
{
    (void)state;
    const struct rho_sensor middle = sensor_at(0.0, 0.0), outside = sensor_at(0.0, -10001.0);
    struct rho_sensor other = sensor_at(100.0, 100.0);
    other.sensor_id = 2;
    expect_uniform_density(10.0, &middle, &middle);
    expect_uniform_density(100.0, &outside, &outside);
    expect_uniform_density(100.0, &middle, &other);
}

/*
 * A radar's clutter may be uniform on the ground: a density of 1 / range would be too low in the
 * corners.
 */
static void clutter_even_on_the_ground_makes_a_map_of_the_ground(void **state)
{
    (void)state;
    const struct rho_sensor middle = sensor_at(0.0, 0.0);
    struct rho_initiator_config config = test_config();
    for (int window = 0; window < 20; window++) {
        start_initiator(&config);
        for (int k = 0; k < SCANS; k++) {
            for (int i = 0; i < 30; i++) {
                add_plot(uniform(-10000.0, 10000.0), uniform(-10000.0, 10000.0), 10.0, 100.0);
            }
            push_scan((struct rho_scan){0}, SCAN_S * k, &middle);
        }
        search_window(RHO_SEARCH_BATCH);
        double mean = 30.0 / around_m2;
        assert_float_equal(density_at(0, 100.0, 100.0), mean, 0.5 * mean);
        assert_float_equal(density_at(0, 9000.0, 9000.0), mean, 0.5 * mean);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_sensor_with_more_clutter_has_the_higher_density),
        cmocka_unit_test(a_sensors_density_is_averaged_with_one_mean_scan),
        cmocka_unit_test(a_single_sensor_and_unknown_ones_have_the_mean_density),
        cmocka_unit_test(a_search_after_every_scan_has_densities_of_sensors),
        cmocka_unit_test(the_density_of_a_radars_clutter_falls_with_range),
        cmocka_unit_test(the_density_is_bounded_near_the_radar),
        cmocka_unit_test(windows_without_plots_or_ranges_have_a_density),
        cmocka_unit_test(a_hot_spot_in_range_and_azimuth_has_a_higher_density),
        cmocka_unit_test(a_sector_is_recognised_from_16_plots_on),
        cmocka_unit_test(a_sector_of_5_rad_or_more_is_taken_as_the_circle),
        cmocka_unit_test(the_map_is_of_the_ground_without_one_radar_inside_the_area),
        cmocka_unit_test(clutter_even_on_the_ground_makes_a_map_of_the_ground),
#if RHO_MAX_DENSITY_MAPS > 1
        cmocka_unit_test(each_of_two_radars_has_its_own_density),
        cmocka_unit_test(a_radars_clutter_does_not_count_beyond_its_range),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
