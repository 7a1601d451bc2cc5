/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "random_draws.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

#define PI 3.14159265358979323846
#define ALL (RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE)

static struct rho_polar_plot random_polar_plot(void)
{
    return (struct rho_polar_plot){.offset_us = 1500,
                                   .range_m = (float)uniform(500.0, 90000.0),
                                   .azimuth_rad = (float)uniform(-PI, PI),
                                   .elevation_rad = (float)uniform(-1.5, 1.5),
                                   .range_rate_mps = -77.0f,
                                   .sigma_range_m = 15.0f,
                                   .sigma_azimuth_rad = 0.003f,
                                   .sigma_elevation_rad = 0.005f,
                                   .sigma_range_rate_mps = 1.5f,
                                   .snr_db = 12.0f};
}

static const struct rho_sensor somewhere = {.sensor_id = 3,
                                            .x_m = 1200.0f,
                                            .y_m = -3400.0f,
                                            .z_m = 250.0f,
                                            .pd = 0.9f,
                                            .range_max_m = 1e5f,
                                            .range_bias_m = 50.0f,
                                            .azimuth_bias_rad = 0.002f,
                                            .time_bias_s = 0.25f};

/* ---- conversion of polar plots -------------------------------------------------------------- */

static void polar_plots_are_converted_to_places(void **state)
{
    (void)state;
    for (int i = 0; i < 2000; i++) {
        struct rho_polar_plot polar = random_polar_plot();
        const struct rho_sensor *sensor = i % 2 ? &somewhere : NULL;
        int has_z = i % 3 != 0;
        struct rho_plot plot;
        assert_int_equal(rho_measurement_from_polar(&polar, has_z ? ALL : 0u, sensor, &plot),
                         RHO_OK);
        double range = polar.range_m - (sensor ? 50.0 : 0.0);
        double azimuth = polar.azimuth_rad - (sensor ? (double)0.002f : 0.0);
        double elevation = has_z ? polar.elevation_rad : 0.0;
        double up = has_z ? exp(0.5 * pow(0.005, 2)) : 1.0, round = exp(0.5 * pow(0.003, 2));
        double level = range * up * cos(elevation);
        double expected[3] = {level * round * cos(azimuth), level * round * sin(azimuth),
                              range * up * sin(elevation)};
        double tolerance = 1e-6 * range + 1e-3;
        assert_float_equal(plot.x_m, expected[0] + (sensor ? 1200.0 : 0.0), tolerance);
        assert_float_equal(plot.y_m, expected[1] + (sensor ? -3400.0 : 0.0), tolerance);
        assert_float_equal(plot.z_m, has_z ? expected[2] + (sensor ? 250.0 : 0.0) : 0.0, tolerance);
        assert_int_equal(plot.offset_us, sensor ? 1500 - 250000 : 1500);
        assert_float_equal(plot.range_rate_mps, has_z ? -77.0f : 0.0f, 0.0f);
        assert_float_equal(plot.sigma_cross_m, level * 0.003, 1e-5 * range + 1e-3);
        assert_float_equal(plot.snr_db, 12.0f, 0.0f);
    }
}

/* Errors of converted plots over many noisy measurements of one target. */
struct spread {
    /* mean, and covariance, along, across and up the line of sight */
    double mean[3], covariance[3][3];
    /* mean error along the line of sight of a conversion without debiasing */
    double plain_along;
};

static struct spread errors_of_conversion(double range_m, double sigma_rad, double elevation,
                                          int count)
{
    struct spread spread = {{0.0}, {{0.0}}, 0.0};
    double azimuth = 0.7, ce = cos(elevation), se = sin(elevation);
    double axis[3][3] = {{ce * cos(azimuth), ce * sin(azimuth), se},
                         {-sin(azimuth), cos(azimuth), 0.0},
                         {-se * cos(azimuth), -se * sin(azimuth), ce}};
    for (int n = 0; n < count; n++) {
        struct rho_polar_plot polar = {
            .range_m = (float)(range_m + 15.0 * normal()),
            .azimuth_rad = (float)(azimuth + sigma_rad * normal()),
            .elevation_rad = (float)(elevation + sigma_rad * normal()),
            .sigma_range_m = 15.0f,
            .sigma_azimuth_rad = (float)sigma_rad,
            .sigma_elevation_rad = (float)sigma_rad,
        };
        struct rho_plot plot;
        assert_int_equal(rho_measurement_from_polar(&polar, RHO_MEASURES_Z, NULL, &plot), RHO_OK);
        double error[3] = {plot.x_m - range_m * axis[0][0], plot.y_m - range_m * axis[0][1],
                           plot.z_m - range_m * axis[0][2]};
        double seen[3];
        for (int i = 0; i < 3; i++) {
            seen[i] = axis[i][0] * error[0] + axis[i][1] * error[1] + axis[i][2] * error[2];
            spread.mean[i] += seen[i] / count;
        }
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++) {
                spread.covariance[i][j] += seen[i] * seen[j] / count;
            }
        }
        double plain_x = polar.range_m * cos(polar.elevation_rad) * cos(polar.azimuth_rad);
        double plain_y = polar.range_m * cos(polar.elevation_rad) * sin(polar.azimuth_rad);
        double plain_z = polar.range_m * sin(polar.elevation_rad);
        spread.plain_along +=
            (axis[0][0] * plain_x + axis[0][1] * plain_y + axis[0][2] * plain_z - range_m) / count;
    }
    return spread;
}

/* Checks that converted places are unbiased and have the stated sigmas along, across and up. */
static void check_conversion_errors(double range_m, double sigma_rad, double elevation,
                                    double plain_conversion_bias_m)
{
    enum { COUNT = 40000 };
    struct spread spread = errors_of_conversion(range_m, sigma_rad, elevation, COUNT);
    struct rho_polar_plot polar = {
        .range_m = (float)range_m,
        .azimuth_rad = 0.7f,
        .elevation_rad = (float)elevation,
        .sigma_range_m = 15.0f,
        .sigma_azimuth_rad = (float)sigma_rad,
        .sigma_elevation_rad = (float)sigma_rad,
    };
    struct rho_plot plot;
    assert_int_equal(rho_measurement_from_polar(&polar, RHO_MEASURES_Z, NULL, &plot), RHO_OK);
    const double said[3] = {plot.sigma_range_m, plot.sigma_cross_m, plot.sigma_up_m};
    for (int i = 0; i < 3; i++) {
        assert_float_equal(spread.mean[i], 0.0, 4.0 * said[i] / sqrt(COUNT) + 0.02);
        assert_float_equal(sqrt(spread.covariance[i][i]) / said[i], 1.0, 0.03);
        for (int j = 0; j < i; j++) {
            assert_float_equal(spread.covariance[i][j] / (said[i] * said[j]), 0.0, 0.05);
        }
    }
    assert_float_equal(spread.plain_along, -plain_conversion_bias_m,
                       4.0 * said[0] / sqrt(COUNT) + 0.05 * plain_conversion_bias_m);
}

static void converted_places_are_unbiased_with_the_stated_noise(void **state)
{
    (void)state;
    /* bias r sigma^2 / 2 for each of two angles */
    check_conversion_errors(60000.0, 0.003, 0.1, 0.54);
    check_conversion_errors(100000.0, 0.03, 0.1, 90.0); /* a bias of six times the range's sigma */
    check_conversion_errors(20000.0, 0.03, -0.6, 0.5 * 20000.0 * 0.0009 * (1.0 + pow(cos(0.6), 2)));
}

/* ---- refused and valid plots ---------------------------------------------------------------- */

#define REFUSED(what)                                                                              \
    do {                                                                                           \
        struct rho_polar_plot bad = good;                                                          \
        what;                                                                                      \
        assert_int_equal(rho_measurement_from_polar(&bad, ALL, NULL, &plot), RHO_ERROR_VALUE);     \
        assert_memory_equal(&plot, &before, sizeof plot);                                          \
    } while (0)

static void polar_plots_out_of_range_are_refused(void **state)
{
    (void)state;
    struct rho_polar_plot good = random_polar_plot();
    struct rho_plot plot, before;
    memset(&plot, 0x33, sizeof plot);
    before = plot;
    good.range_m = 5000.0f;
    REFUSED(bad.range_m = 0.0f);
    REFUSED(bad.range_m = -1.0f);
    REFUSED(bad.range_m = INFINITY);
    REFUSED(bad.range_m = NAN);
    REFUSED(bad.range_m = 2.1e6f);
    REFUSED(bad.azimuth_rad = 3.15f);
    REFUSED(bad.azimuth_rad = -3.15f);
    REFUSED(bad.azimuth_rad = NAN);
    REFUSED(bad.elevation_rad = 1.58f);
    REFUSED(bad.elevation_rad = -1.58f);
    REFUSED(bad.elevation_rad = NAN);
    REFUSED(bad.sigma_range_m = 0.0f);
    REFUSED(bad.sigma_range_m = -5.0f);
    REFUSED(bad.sigma_azimuth_rad = 0.0f);
    REFUSED(bad.sigma_azimuth_rad = 0.6f);
    REFUSED(bad.sigma_elevation_rad = -0.1f);
    REFUSED(bad.sigma_range_rate_mps = 0.0f);
    REFUSED(bad.range_rate_mps = INFINITY);
    REFUSED(bad.range_rate_mps = NAN);
    REFUSED(bad.range_rate_mps = -20001.0f);
    REFUSED(bad.offset_us = RHO_LIMIT_OFFSET_US + 1);
    assert_int_equal(rho_measurement_from_polar(NULL, 0, NULL, &plot), RHO_ERROR_NULL);
    assert_int_equal(rho_measurement_from_polar(&good, 0, NULL, NULL), RHO_ERROR_NULL);
    assert_memory_equal(&plot, &before, sizeof plot);
}

static void plots_made_invalid_by_biases_are_refused(void **state)
{
    (void)state;
    struct rho_polar_plot polar = random_polar_plot();
    struct rho_plot plot;
    struct rho_sensor sensor = somewhere;
    polar.range_m = 50.0f; /* the range is the bias */
    assert_int_equal(rho_measurement_from_polar(&polar, ALL, &sensor, &plot), RHO_ERROR_VALUE);
    polar.range_m = 51.0f;
    assert_int_equal(rho_measurement_from_polar(&polar, ALL, &sensor, &plot), RHO_OK);
    polar.offset_us = -RHO_LIMIT_OFFSET_US;
    assert_int_equal(rho_measurement_from_polar(&polar, ALL, &sensor, &plot), RHO_ERROR_VALUE);
    polar.offset_us = 0;
    polar.range_m = 1.5e6f;
    polar.azimuth_rad = 0.0f;
    polar.elevation_rad = 0.0f;
    sensor.x_m = 1.0e6f;
    assert_int_equal(rho_measurement_from_polar(&polar, ALL, &sensor, &plot), RHO_ERROR_VALUE);
}

#define SENSOR_REFUSED(field, value)                                                               \
    do {                                                                                           \
        struct rho_sensor bad = somewhere;                                                         \
        bad.field = (value);                                                                       \
        assert_int_equal(rho_measurement_from_polar(&good, ALL, &bad, &plot), RHO_ERROR_VALUE);    \
    } while (0)

static void sensors_with_invalid_places_or_biases_are_refused(void **state)
{
    (void)state;
    const struct rho_polar_plot good = random_polar_plot();
    struct rho_plot plot;
    SENSOR_REFUSED(x_m, NAN);
    SENSOR_REFUSED(y_m, INFINITY);
    SENSOR_REFUSED(z_m, -3e6f);
    SENSOR_REFUSED(range_bias_m, NAN);
    SENSOR_REFUSED(azimuth_bias_rad, 0.6f);
    SENSOR_REFUSED(time_bias_s, NAN);
    SENSOR_REFUSED(time_bias_s, 3e38f);
    SENSOR_REFUSED(time_bias_s, -11.0f);
}

/* A sigma across 10^5 times that along, at any azimuth. */
static void very_thin_covariances_stay_positive_definite(void **state)
{
    (void)state;
    for (int i = 0; i < 360; i++) {
        double azimuth_rad = i * 0.0174532925;
        struct rho_plot plot = {.x_m = (float)(1e5 * cos(azimuth_rad)),
                                .y_m = (float)(1e5 * sin(azimuth_rad)),
                                .sigma_range_m = 1.0f,
                                .sigma_cross_m = 1e5f};
        struct rho_measurement seen;
        float packed[6];
        rho_measurement_from_plot(&plot, 0, NULL, &seen);
        rho_measurement_covariance(&seen, packed);
        double determinant = (double)packed[0] * packed[2] - (double)packed[1] * packed[1];
        assert_true(packed[0] > 0.0f && packed[2] > 0.0f && determinant > 0.0);
    }
}

static void values_of_unmeasured_fields_do_not_make_a_plot_invalid(void **state)
{
    (void)state;
    struct rho_polar_plot polar = random_polar_plot();
    struct rho_plot plot;
    polar.elevation_rad = polar.range_rate_mps = polar.sigma_elevation_rad = NAN;
    polar.sigma_range_rate_mps = NAN;
    assert_int_equal(rho_measurement_from_polar(&polar, 0, NULL, &plot), RHO_OK);
    assert_true(rho_measurement_is_valid_plot(&plot, 0));
    plot.z_m = plot.sigma_up_m = plot.vx_mps = plot.range_rate_mps = NAN;
    assert_true(rho_measurement_is_valid_plot(&plot, 0));
    assert_false(rho_measurement_is_valid_plot(&plot, RHO_MEASURES_Z));
    assert_false(rho_measurement_is_valid_plot(&plot, RHO_MEASURES_VELOCITY));
    assert_false(rho_measurement_is_valid_plot(&plot, RHO_MEASURES_RANGE_RATE));
}

static void one_invalid_field_makes_a_plot_invalid(void **state)
{
    (void)state;
    const struct rho_plot good = {.x_m = 1.0f,
                                  .sigma_range_m = 1.0f,
                                  .sigma_cross_m = 1.0f,
                                  .sigma_up_m = 1.0f,
                                  .sigma_mps = 1.0f,
                                  .sigma_range_rate_mps = 1.0f};
    const uint32_t all = ALL | RHO_MEASURES_VELOCITY;
    const size_t fields[] = {offsetof(struct rho_plot, x_m),
                             offsetof(struct rho_plot, y_m),
                             offsetof(struct rho_plot, z_m),
                             offsetof(struct rho_plot, vx_mps),
                             offsetof(struct rho_plot, vy_mps),
                             offsetof(struct rho_plot, vz_mps),
                             offsetof(struct rho_plot, range_rate_mps),
                             offsetof(struct rho_plot, sigma_range_m),
                             offsetof(struct rho_plot, sigma_cross_m),
                             offsetof(struct rho_plot, sigma_up_m),
                             offsetof(struct rho_plot, sigma_mps),
                             offsetof(struct rho_plot, sigma_range_rate_mps)};
    const float bad[] = {NAN, INFINITY, -INFINITY, 3.0e6f};
    assert_true(rho_measurement_is_valid_plot(&good, all));
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        for (size_t k = 0; k < 4; k++) {
            struct rho_plot plot = good;
            memcpy((char *)&plot + fields[i], &bad[k], sizeof bad[k]);
            assert_false(rho_measurement_is_valid_plot(&plot, all));
        }
    }
    struct rho_plot late = good;
    late.offset_us = INT32_MIN;
    assert_false(rho_measurement_is_valid_plot(&late, 0));
}

/* ---- covariances ---------------------------------------------------------------------------- */

static void covariances_have_the_axes_of_the_line_of_sight(void **state)
{
    (void)state;
    for (int n = 0; n < 1000; n++) {
        struct rho_plot plot = {.x_m = (float)uniform(-5e4, 5e4),
                                .y_m = (float)uniform(-5e4, 5e4),
                                .z_m = (float)uniform(-2e4, 2e4),
                                .sigma_range_m = (float)uniform(1.0, 100.0),
                                .sigma_cross_m = (float)uniform(1.0, 900.0),
                                .sigma_up_m = (float)uniform(1.0, 500.0)};
        struct rho_measurement seen;
        float packed[6];
        int has_z = n % 2;
        rho_measurement_from_plot(&plot, has_z ? RHO_MEASURES_Z : 0u, &somewhere, &seen);
        rho_measurement_covariance(&seen, packed);
        double d[3] = {plot.x_m - 1200.0, plot.y_m + 3400.0, has_z ? plot.z_m - 250.0 : 0.0};
        double ground = hypot(d[0], d[1]), range = hypot(ground, d[2]);
        double axis[3][3] = {
            {d[0] / range, d[1] / range, d[2] / range},
            {-d[1] / ground, d[0] / ground, 0.0},
            {-d[2] * d[0] / range / ground, -d[2] * d[1] / range / ground, ground / range}};
        double sigma[3] = {plot.sigma_range_m, plot.sigma_cross_m, has_z ? plot.sigma_up_m : 0.0};
        double largest = fmax(sigma[0], fmax(sigma[1], sigma[2]));
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j <= i; j++) {
                double sum = 0.0;
                for (int k = 0; k < 3; k++) {
                    sum += sigma[k] * sigma[k] * axis[k][i] * axis[k][j];
                }
                assert_float_equal(packed[i * (i + 1) / 2 + j], sum, 2e-6 * largest * largest);
            }
        }
    }
}

static void plots_without_a_line_of_sight_are_isotropic(void **state)
{
    (void)state;
    struct rho_plot plot = {.x_m = 1200.2f,
                            .y_m = -3400.0f,
                            .z_m = 5000.0f,
                            .sigma_range_m = 10.0f,
                            .sigma_cross_m = 30.0f,
                            .sigma_up_m = 20.0f};
    struct rho_measurement seen;
    float packed[6];
    rho_measurement_from_plot(&plot, RHO_MEASURES_Z, &somewhere, &seen);
    rho_measurement_covariance(&seen, packed);
    /* overhead: the line of sight is vertical, and the horizontal axes have any azimuth */
    const float overhead[6] = {400.0f, 0.0f, 900.0f, 0.0f, 0.0f, 100.0f};
    for (int i = 0; i < 6; i++) {
        assert_float_equal(packed[i], overhead[i], 1e-3f);
    }
    rho_measurement_from_plot(&plot, 0, &somewhere, &seen);
    rho_measurement_covariance(&seen, packed);
    assert_true(seen.is_isotropic);
    const float expected[3] = {900.0f, 0.0f, 900.0f};
    for (int i = 0; i < 3; i++) {
        assert_float_equal(packed[i], expected[i], 1e-3f);
    }
    plot.x_m = 5000.0f;
    plot.sigma_cross_m = 10.0f;
    rho_measurement_from_plot(&plot, 0, &somewhere, &seen);
    assert_true(seen.is_isotropic);
    rho_measurement_from_plot(&plot, RHO_MEASURES_Z, &somewhere, &seen);
    assert_false(seen.is_isotropic);
}

/* ---- range rates and coverage --------------------------------------------------------------- */

static double range_rate_of(const double state[6], int use_z)
{
    double d[3] = {state[0] - 1200.0, state[1] + 3400.0, use_z ? state[2] - 250.0 : 0.0};
    double range = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    return (d[0] * state[3] + d[1] * state[4] + d[2] * (use_z ? state[5] : 0.0)) / range;
}

static void predicted_range_rates_and_their_derivatives_are_right(void **state)
{
    (void)state;
    for (int n = 0; n < 500; n++) {
        double at[6];
        float single[6], row[6], rate;
        int use_z = n % 2;
        for (int i = 0; i < 6; i++) {
            single[i] = (float)(i < 3 ? uniform(-3e4, 3e4) : uniform(-400.0, 400.0));
            at[i] = single[i];
        }
        assert_int_equal(rho_measurement_predict_rate(single, &somewhere, use_z, row, &rate), 1);
        assert_float_equal(rate, range_rate_of(at, use_z), 2e-3);
        for (int i = 0; i < 6; i++) {
            double step = i < 3 ? 1.0 : 0.01, up[6], down[6];
            memcpy(up, at, sizeof at);
            memcpy(down, at, sizeof at);
            up[i] += step;
            down[i] -= step;
            assert_float_equal(
                row[i], (range_rate_of(up, use_z) - range_rate_of(down, use_z)) / (2.0 * step),
                1e-5);
        }
    }
    const float there[6] = {1200.5f, -3400.0f, 250.0f, 100.0f, 0.0f, 0.0f};
    float row[6] = {0.0f}, rate = 5.0f;
    assert_int_equal(rho_measurement_predict_rate(there, &somewhere, 1, row, &rate), 0);
    assert_float_equal(rate, 5.0f, 0.0f);
    assert_int_equal(rho_measurement_predict_rate(there, NULL, 1, row, &rate), 1);
}

static void a_place_is_covered_within_sector_and_range(void **state)
{
    (void)state;
    struct rho_sensor sensor = {.sensor_id = 1,
                                .x_m = 1000.0f,
                                .pd = 0.9f,
                                .range_min_m = 100.0f,
                                .range_max_m = 5000.0f,
                                .sector_from_rad = 2.0f,
                                .sector_to_rad = -2.0f}; /* across +-pi */
    assert_true(rho_measurement_covers(&sensor, 0.0f, 0.0f, -1000.0f, 10.0f));
    assert_true(rho_measurement_covers(&sensor, 0.0f, 0.0f, -1000.0f, -10.0f));
    /* outside the sensor's sector */
    assert_false(rho_measurement_covers(&sensor, 0.0f, 0.0f, 3000.0f, 0.0f));
    /* below range_min_m */
    assert_false(rho_measurement_covers(&sensor, 0.0f, 0.0f, 950.0f, 0.0f));
    /* beyond range_max_m */
    assert_false(rho_measurement_covers(&sensor, 0.0f, 0.0f, -4100.0f, 0.0f));
    assert_true(rho_measurement_covers(&sensor, 3.0f, -3.0f, -1000.0f, 10.0f));
    /* outside the scan's sector */
    assert_false(rho_measurement_covers(&sensor, -3.1f, -2.0f, -1000.0f, 10.0f));
    assert_true(rho_measurement_covers(NULL, 0.0f, 0.0f, 1e6f, 1e6f));
    assert_false(rho_measurement_covers(NULL, 0.0f, 0.5f, 1e6f, 1e6f));
}

/* ---- bearings, learned sigmas, time biases --------------------------------------------------- */

static void bearings_out_of_range_are_invalid(void **state)
{
    const struct rho_bearing good = {.bearing_rad = RHO_PI, .sigma_rad = 0.002f};
    struct rho_bearing bad = good;

    (void)state;
    assert_true(rho_bearing_is_valid(&good));
    bad.bearing_rad = nextafterf(RHO_PI, 4.0f);
    assert_false(rho_bearing_is_valid(&bad));
    bad.bearing_rad = NAN;
    assert_false(rho_bearing_is_valid(&bad));
    bad = good;
    bad.sigma_rad = nextafterf(RHO_LIMIT_SIGMA_RAD_MAX, INFINITY);
    assert_false(rho_bearing_is_valid(&bad));
    bad.sigma_rad = nextafterf(RHO_LIMIT_SIGMA_RAD_MIN, 0.0f);
    assert_false(rho_bearing_is_valid(&bad));
    bad.sigma_rad = RHO_LIMIT_SIGMA_RAD_MIN;
    assert_true(rho_bearing_is_valid(&bad));
}

static void learned_percentages_scale_the_sigmas(void **state)
{
    const struct rho_sensor stated = {.sensor_id = 1};
    const struct rho_sensor learned = {.sigma_range_percent = 50, .sigma_cross_percent = 250};
    const struct rho_sensor sharper = {.sigma_range_percent = 50, .sigma_cross_percent = 80};
    const struct rho_sigma_factors factors = rho_measurement_sigma_factors(&learned);

    (void)state;
    assert_true(factors.range == 0.5f && factors.cross == 2.5f);
    assert_true(rho_measurement_sigma_factors(&stated).range == 1.0f);
    assert_true(rho_measurement_sigma_factors(NULL).cross == 1.0f);
    assert_true(rho_measurement_factor_max(&learned) == 2.5f);
    assert_true(rho_measurement_factor_max(&sharper) == 1.0f);
    assert_true(rho_measurement_factor_max(NULL) == 1.0f);
}

static void time_biases_are_rounded_to_microseconds(void **state)
{
    static const struct {
        float bias_s;
        int32_t expected_us;
    } cases[] = {{0.0f, 0},    {0.5f, 500000}, {-0.5f, -500000},
                 {1.6e-6f, 2}, {-1.6e-6f, -2}, {0.4e-6f, 0}};

    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct rho_sensor sensor = {.time_bias_s = cases[i].bias_s};

        assert_int_equal(rho_measurement_time_bias_us(&sensor), cases[i].expected_us);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polar_plots_are_converted_to_places),
        cmocka_unit_test(converted_places_are_unbiased_with_the_stated_noise),
        cmocka_unit_test(polar_plots_out_of_range_are_refused),
        cmocka_unit_test(sensors_with_invalid_places_or_biases_are_refused),
        cmocka_unit_test(very_thin_covariances_stay_positive_definite),
        cmocka_unit_test(plots_made_invalid_by_biases_are_refused),
        cmocka_unit_test(values_of_unmeasured_fields_do_not_make_a_plot_invalid),
        cmocka_unit_test(one_invalid_field_makes_a_plot_invalid),
        cmocka_unit_test(covariances_have_the_axes_of_the_line_of_sight),
        cmocka_unit_test(plots_without_a_line_of_sight_are_isotropic),
        cmocka_unit_test(predicted_range_rates_and_their_derivatives_are_right),
        cmocka_unit_test(a_place_is_covered_within_sector_and_range),
        cmocka_unit_test(bearings_out_of_range_are_invalid),
        cmocka_unit_test(learned_percentages_scale_the_sigmas),
        cmocka_unit_test(time_biases_are_rounded_to_microseconds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
