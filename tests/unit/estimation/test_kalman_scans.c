/* SPDX-License-Identifier: MIT */
/*
 * Fifty scans of a radar from polar plots to estimates, compared with double precision, which uses
 * another conversion and another form of the update.
 */
#include "dense_filter.h"
#include "kalman_checks.h"

#define NUM_SCANS 50
#define NUM_START 25 /* until then vague velocities have left rounding errors in the covariances */
#define SPEED_VARIANCE 1e5f

static const struct rho_sensor somewhere = {
    .sensor_id = 3, .x_m = 1200.0f, .y_m = -3400.0f, .z_m = 250.0f};
static const double there_m[3] = {1200.0, -3400.0, 250.0};

struct radar {
    const char *name;
    uint32_t measures;
    double from_m[3], velocity_mps[3]; /* the target's place and velocity, relative to the radar */
    float sigma_range_m, sigma_azimuth_rad, sigma_elevation_rad, sigma_range_rate_mps;
    float interval_s, noise_density;
    /* tolerances until and after NUM_START, in sigmas, and relative for variances */
    double start, settled;
};

#define ALL (RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE)

/*
 * Largest seen of each radar, before and after NUM_START: 0.011 and 6e-4; 0.013 and 5e-4; 0.17 and
 * 0.0096; 0.20 and 0.0016. The first scans are worst: each rotation raises the variance of the
 * velocity along by 2^-20 of the vague one across.
 */
static const struct radar radars[] = {
    {.name = "air, with heights",
     .measures = ALL,
     .from_m = {-40e3, 15e3, 6e3},
     .velocity_mps = {180.0, 60.0, -5.0},
     .sigma_range_m = 15.0f,
     .sigma_azimuth_rad = 0.003f,
     .sigma_elevation_rad = 0.005f,
     .sigma_range_rate_mps = 1.5f,
     .interval_s = 4.0f,
     .noise_density = 1.0f,
     .start = 0.03,
     .settled = 2e-3},
    {.name = "air, level",
     .measures = RHO_MEASURES_RANGE_RATE,
     .from_m = {-40e3, 15e3, 0.0},
     .velocity_mps = {180.0, 60.0, 0.0},
     .sigma_range_m = 15.0f,
     .sigma_azimuth_rad = 0.003f,
     .sigma_range_rate_mps = 1.5f,
     .interval_s = 4.0f,
     .noise_density = 1.0f,
     .start = 0.03,
     .settled = 2e-3},
    {.name = "far, a hundred times sharper along than across",
     .measures = ALL,
     .from_m = {150e3, 120e3, 9e3},
     .velocity_mps = {-240.0, 30.0, 0.0},
     .sigma_range_m = 5.0f,
     .sigma_azimuth_rad = 0.003f,
     .sigma_elevation_rad = 0.004f,
     .sigma_range_rate_mps = 0.5f,
     .interval_s = 10.0f,
     .noise_density = 0.1f,
     .start = 0.4,
     .settled = 0.02},
    {.name = "near, passing by",
     .measures = ALL,
     .from_m = {-1500.0, 300.0, 100.0},
     .velocity_mps = {60.0, 5.0, 2.0},
     .sigma_range_m = 2.0f,
     .sigma_azimuth_rad = 0.01f,
     .sigma_elevation_rad = 0.01f,
     .sigma_range_rate_mps = 0.2f,
     .interval_s = 1.0f,
     .noise_density = 0.5f,
     .start = 0.4,
     .settled = 5e-3},
};

/* A polar plot with noise at a time, rounded to float. */
static struct rho_polar_plot measure_polar(const struct radar *radar, double time_s)
{
    double d[3], product = 0.0;

    for (int i = 0; i < 3; ++i) {
        d[i] = radar->from_m[i] + time_s * radar->velocity_mps[i];
        product += d[i] * radar->velocity_mps[i];
    }
    const double ground = hypot(d[0], d[1]), range = hypot(ground, d[2]);
    return (struct rho_polar_plot){
        .range_m = (float)(range + radar->sigma_range_m * normal()),
        .azimuth_rad = (float)(atan2(d[1], d[0]) + radar->sigma_azimuth_rad * normal()),
        .elevation_rad = (float)(atan2(d[2], ground) + radar->sigma_elevation_rad * normal()),
        .range_rate_mps = (float)(product / range + radar->sigma_range_rate_mps * normal()),
        .sigma_range_m = radar->sigma_range_m,
        .sigma_azimuth_rad = radar->sigma_azimuth_rad,
        .sigma_elevation_rad = radar->sigma_elevation_rad,
        .sigma_range_rate_mps = radar->sigma_range_rate_mps};
}

/* The unbiased conversion described in types.h, in double precision. */
static struct dense_place convert_in_double_precision(const struct rho_polar_plot *polar, int axes)
{
    const double e = axes == 3 ? polar->elevation_rad : 0.0, a = polar->azimuth_rad;
    const double azimuth2 = pow(polar->sigma_azimuth_rad, 2);
    const double elevation2 = axes == 3 ? pow(polar->sigma_elevation_rad, 2) : 0.0;
    const double slant = polar->range_m * exp(0.5 * elevation2), level = slant * cos(e);
    const double ground = level * exp(0.5 * azimuth2);
    const double at[3] = {there_m[0] + ground * cos(a), there_m[1] + ground * sin(a),
                          there_m[2] + slant * sin(e)};
    const double spread2 = 0.5 * (pow(level * azimuth2, 2) + pow(polar->range_m * elevation2, 2));
    const double variance[3] = {pow(polar->sigma_range_m, 2) + spread2, level * level * azimuth2,
                                pow(polar->range_m, 2) * elevation2};

    return dense_place_of(there_m, at, axes, variance);
}

static void step_filter(struct rho_kalman *kalman, const struct radar *radar,
                        const struct rho_polar_plot *polar)
{
    struct rho_measurement seen;
    struct rho_plot plot;

    assert_int_equal(rho_kalman_predict(kalman, radar->interval_s, radar->noise_density), RHO_OK);
    assert_int_equal(rho_measurement_from_polar(polar, radar->measures, &somewhere, &plot), RHO_OK);
    rho_measurement_from_plot(&plot, radar->measures, &somewhere, &seen);
    assert_int_equal(rho_kalman_update_position(kalman, &seen, SPEED_VARIANCE), RHO_OK);
    assert_int_equal(
        rho_kalman_update_range_rate(kalman, &somewhere, plot.range_rate_mps,
                                     plot.sigma_range_rate_mps * plot.sigma_range_rate_mps),
        RHO_OK);
}

static void step_reference(struct dense *d, const struct radar *radar,
                           const struct rho_polar_plot *polar)
{
    const int axes = radar->measures & RHO_MEASURES_Z ? 3 : 2;
    const struct dense_place place = convert_in_double_precision(polar, axes);
    struct dense_measurement rate;

    if (d->p[0][0] > 0.0) {
        dense_predict(d, radar->interval_s, radar->noise_density);
        dense_update_place(d, &place, 0, axes);
    } else {
        dense_open_place(d, &place, 0, axes, SPEED_VARIANCE);
    }
    rate = dense_range_rate(d, there_m, axes, polar->range_rate_mps,
                            pow(polar->sigma_range_rate_mps, 2));
    dense_update(d, &rate);
}

/* Compares along the line of sight, where the radar is sharp and cancellation largest. */
static void assert_near_along_line_of_sight(const struct rho_kalman *kalman,
                                            const struct dense *expected, double relative)
{
    const struct dense got = dense_of(kalman->state, kalman->covariance);
    double off = 0.0, variance = 0.0, expected_variance = 0.0;

    for (int i = 0; i < 3; ++i) {
        const double d = expected->x[i] - there_m[i]; /* 0 for a closed axis */

        off += d * (got.x[i] - expected->x[i]);
        for (int j = 0; j < 3; ++j) {
            const double product = d * (expected->x[j] - there_m[j]);

            variance += product * got.p[i][j];
            expected_variance += product * expected->p[i][j];
        }
    }
    assert_float_equal(variance / expected_variance, 1.0, relative);
    assert_float_equal(off / sqrt(expected_variance), 0.0, relative);
}

/* Both filters run on their own, each with its own linearisations. */
static void compare_fifty_scans(const struct radar *radar)
{
    struct dense expected = {.x = {0.0}};
    struct rho_kalman kalman;

    rho_kalman_init(&kalman);
    for (int k = 0; k < NUM_SCANS; ++k) {
        const struct rho_polar_plot polar = measure_polar(radar, radar->interval_s * k);
        const double relative = k < NUM_START ? radar->start : radar->settled;

        step_filter(&kalman, radar, &polar);
        step_reference(&expected, radar, &polar);
        assert_near_dense(kalman.state, kalman.covariance, &expected, &expected, relative);
        assert_near_along_line_of_sight(&kalman, &expected, relative);
        assert_true(is_positive_definite(&kalman));
    }
}

static void fifty_scans_agree_with_the_double_precision_filter(void **state)
{
    (void)state;
    for (size_t i = 0; i < NUM(radars); ++i) {
        print_message("           %s\n", radars[i].name);
        compare_fifty_scans(&radars[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fifty_scans_agree_with_the_double_precision_filter),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
