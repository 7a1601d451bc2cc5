/* SPDX-License-Identifier: MIT */
/*
 * The gate of bearings of a track with one filter: density, variance, limit, own times and
 * elevations, compared with the linearised filter in double precision.
 */
#include "dense_filter_bearing_measurement.h"
#include "dense_filter_slope_measurement.h"
#include "kalman_checks.h"
#include "rhotrack/detail/track.h"

#define NUM_CASES 6000
#define NOISE 2.0f /* spectral density of white acceleration, m^2/s^3 */

/*
 * Tolerances, relative to 1 + the distance and to the log determinant; largest errors seen: 7e-4,
 * 2e-6.
 */
#define DISTANCE_ERROR 2e-3
#define LOG_ERROR 1e-5

/* The gate's result in double precision, at the bearing's own time. */
struct expected {
    double distance2, log_det;
};

/* The track's result: ln of the density of bearing and slope, and the bearing's variance. */
struct result {
    double log_density, variance;
};

/* Scores a bearing of a scan at time 0 by the track of a plain Kalman filter. */
static int test_gate(const struct rho_kalman *kalman, const struct rho_bearing_scan *place,
                     const struct rho_bearing *bearing, struct result *result)
{
    const struct rho_track track = {.filter = RHO_TRACK_KALMAN, .kalman = *kalman};
    const struct rho_track_model model = {.noise_density = NOISE};
    struct rho_bearing_scan scan = *place;
    float density = 1.0f, variance = 1.0f;

    scan.num_bearings = 1;
    scan.bearings = bearing;
    const struct rho_weighed_bearings look = {.scan = &scan};
    const int is_in = rho_track_score_bearing(&track, &model, &look, 0, &density, &variance);
    *result = (struct result){log((double)density), variance};
    return is_in;
}

/* Tests a bearing of a sensor at this place. */
static int is_in_gate(const struct rho_kalman *kalman, const struct rho_bearing *bearing, float x_m,
                      float y_m, struct result *result)
{
    const struct rho_bearing_scan scan = {.x_m = x_m, .y_m = y_m};
    return test_gate(kalman, &scan, bearing, result);
}

static struct expected expected_gate(const struct rho_kalman *kalman,
                                     const struct rho_bearing *bearing, const double place[2])
{
    const double offset_s = bearing->offset_us * 1e-6;
    struct dense at = dense_of(kalman->state, kalman->covariance);

    dense_predict(&at, offset_s, offset_s > 0.0 ? (double)NOISE : 0.0);
    const struct dense_measurement m =
        dense_bearing(&at, place, bearing->bearing_rad, bearing->sigma_rad);
    const double range = hypot(at.x[0] - place[0], at.x[1] - place[1]);
    double variance = m.r[0][0];
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            variance += m.h[0][i] * m.h[0][j] * at.p[i][j];
        }
    }
    return (struct expected){m.y[0] * m.y[0] / variance, log(variance / (range * range))};
}

/* An estimate without a height, elements correlated, 5 to 100 km from `place` in any direction. */
static struct rho_kalman random_estimate(const double place[2])
{
    struct rho_kalman kalman;
    const double range = pow(10.0, uniform(3.7, 5.0)), direction = uniform(-DENSE_PI, DENSE_PI);

    random_covariance(kalman.covariance, 2.0);
    for (int i = 0; i < STATES; ++i) {
        kalman.covariance[RHO_AT(5, i)] = 0.0f;
        kalman.covariance[RHO_AT(i < 2 ? 2 : i, i < 2 ? i : 2)] = 0.0f;
        kalman.state[i] = i == 3 || i == 4 ? (float)uniform(-300.0, 300.0) : 0.0f;
    }
    kalman.state[0] = (float)(place[0] + range * cos(direction));
    kalman.state[1] = (float)(place[1] + range * sin(direction));
    return kalman;
}

/*
 * A bearing some sigmas off the estimate. A third of the bearings are at the scan's time, a third
 * at any time within 5 s of it, a third after it.
 */
static struct rho_bearing random_bearing_near(const struct rho_kalman *kalman,
                                              const double place[2], int n)
{
    struct dense at = dense_of(kalman->state, kalman->covariance);
    struct rho_bearing bearing = {.snr_db = 3.0f};

    bearing.offset_us = n % 3 == 0 ? 0 : (int32_t)uniform(n % 3 == 1 ? -5e6 : 0.0, 5e6);
    dense_predict(&at, bearing.offset_us * 1e-6, 0.0);
    bearing.sigma_rad = (float)pow(10.0, uniform(-4.0, -1.5));
    const double range = hypot(at.x[0] - place[0], at.x[1] - place[1]);
    const double spread = hypot(sqrt(at.p[0][0] + at.p[1][1]) / range, (double)bearing.sigma_rad);
    const double off = 2.5 * spread * normal();
    bearing.bearing_rad = (float)remainder(dense_bearing_of(at.x, place) + off, 2.0 * DENSE_PI);
    return bearing;
}

static void the_distance_agrees_with_the_linearised_filter(void **state)
{
    int inside = 0;

    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const double place[2] = {2000.0, -7000.0};
        const struct rho_kalman kalman = random_estimate(place);
        const struct rho_bearing bearing = random_bearing_near(&kalman, place, n);
        const struct expected expected = expected_gate(&kalman, &bearing, place);
        struct result result;

        const int is_in = is_in_gate(&kalman, &bearing, 2000.0f, -7000.0f, &result);
        if (fabs(expected.distance2 / (double)RHO_GATE_CHI2_1D - 1.0) > 2e-3) {
            assert_int_equal(is_in, expected.distance2 < (double)RHO_GATE_CHI2_1D);
        }
        if (is_in) {
            inside++;
            assert_float_equal(result.log_density,
                               -0.5 * (log(2.0 * DENSE_PI) + expected.log_det + expected.distance2),
                               DISTANCE_ERROR * (1.0 + expected.distance2) +
                                   LOG_ERROR * fabs(expected.log_det));
            assert_float_equal(log(result.variance), expected.log_det,
                               LOG_ERROR * fabs(expected.log_det));
        }
    }
    assert_in_range(inside, NUM_CASES / 2, NUM_CASES * 9 / 10);
}

/* Targets are drawn from the track's covariance, bearings with their noise. */
static void the_gate_misses_one_true_bearing_in_a_thousand(void **state)
{
    struct rho_kalman kalman = opened_filter(2, 2500.0f, 100.0f);
    int outside = 0;

    (void)state;
    kalman.state[0] = -40000.0f; /* due west, where bearings wrap */
    kalman.state[1] = 0.0f;
    for (int n = 0; n < 100000; ++n) {
        const double x = -40000.0 + 50.0 * normal();
        const double y = 50.0 * normal();
        const double error = 0.002 * normal();
        const struct rho_bearing bearing = {
            .bearing_rad = (float)remainder(atan2(y, x) + error, 2.0 * DENSE_PI),
            .sigma_rad = 0.002f};
        struct result result;

        outside += !is_in_gate(&kalman, &bearing, 0.0f, 0.0f, &result);
    }
    print_message("outside the gate: %d of 100000\n", outside);
    assert_in_range(outside, 60, 140); /* 100 expected, standard deviation 10 */
}

/* The target is north-east at the scan's time, and farther east at the bearing's own time. */
static void the_gate_is_at_the_bearings_own_time(void **state)
{
    struct rho_kalman kalman = opened_filter(2, 100.0f, 1.0f);
    struct result result;
    struct rho_bearing bearing = {.bearing_rad = 0.5f, .sigma_rad = 0.001f};

    (void)state;
    kalman.state[0] = 1000.0f;
    kalman.state[1] = 1000.0f;
    kalman.state[3] = 400.0f;
    assert_int_equal(is_in_gate(&kalman, &bearing, 0.0f, 0.0f, &result), 0);
    bearing.offset_us = 2076000; /* the target is at (1830, 1000) m then */
    assert_int_equal(is_in_gate(&kalman, &bearing, 0.0f, 0.0f, &result), 1);
    assert_true(result.log_density > -0.5 * log(2.0 * DENSE_PI * result.variance) - 0.05);
    bearing.offset_us = -2076000;
    assert_int_equal(is_in_gate(&kalman, &bearing, 0.0f, 0.0f, &result), 0);
}

static void assert_outside_gate(const struct rho_kalman *kalman, struct rho_bearing bearing,
                                float x_m)
{
    struct result result;

    assert_int_equal(is_in_gate(kalman, &bearing, x_m, 0.0f, &result), 0);
}

static void invalid_bearings_and_estimates_are_outside_the_gate(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY, 1e30f};
    struct rho_bearing bearing = {.bearing_rad = 1.1f, .sigma_rad = 0.01f};
    struct rho_kalman kalman = opened_filter(2, 100.0f, 1.0f); /* the estimate is at (100, 200) m */
    struct result result;

    (void)state;
    assert_int_equal(is_in_gate(&kalman, &bearing, 0.0f, 0.0f, &result), 1);
    kalman.state[1] = 0.4f;
    assert_outside_gate(&kalman, bearing, 100.5f); /* the target is at the sensor's place */
    kalman.state[1] = 200.0f;
    for (size_t k = 0; k < NUM(bad); ++k) {
        assert_outside_gate(&kalman,
                            (struct rho_bearing){.bearing_rad = bad[k], .sigma_rad = 0.01f}, 0.0f);
        assert_outside_gate(&kalman, bearing, bad[k]);
        struct rho_kalman worse = kalman;
        worse.state[0] = bad[k];
        assert_outside_gate(&worse, bearing, 0.0f);
    }
    assert_outside_gate(&kalman, (struct rho_bearing){.bearing_rad = 1.1f, .sigma_rad = NAN}, 0.0f);
    assert_outside_gate(&kalman, (struct rho_bearing){.bearing_rad = 1.1f, .sigma_rad = INFINITY},
                        0.0f);
    kalman.covariance[0] = NAN;
    assert_outside_gate(&kalman, bearing, 0.0f);
}

/* ---- elevations ------------------------------------------------------------------------------ */

/* The slope of the estimate, and its distance and ln of its density, at the bearing's own time. */
struct expected_slope {
    double distance2, log_density;
};

static struct expected_slope expected_slope_gate(const struct rho_kalman *kalman,
                                                 const struct rho_bearing *bearing,
                                                 const struct rho_bearing_scan *scan)
{
    const double offset_s = bearing->offset_us * 1e-6;
    const double tangent = tan(bearing->elevation_rad);
    const struct rho_slope slope = {
        .x_m = scan->x_m,
        .y_m = scan->y_m,
        .z_m = scan->z_m,
        .value = (float)tangent,
        .sigma = (float)((double)bearing->sigma_elevation_rad * (1.0 + tangent * tangent))};
    struct dense at = dense_of(kalman->state, kalman->covariance);

    dense_predict(&at, offset_s, offset_s > 0.0 ? (double)NOISE : 0.0);
    const struct dense_measurement m = dense_slope(&at, &slope);
    const double range = hypot(at.x[0] - (double)scan->x_m, at.x[1] - (double)scan->y_m);
    const double variance = dense_innovation_variance(&at, &m) / (range * range);
    const double off = m.y[0] / range;
    return (struct expected_slope){off * off / variance,
                                   -0.5 * (log(2.0 * DENSE_PI * variance) + off * off / variance)};
}

/* A correlated estimate with a height, 5 to 100 km from the scan's place. */
static struct rho_kalman random_estimate_with_height(const struct rho_bearing_scan *scan)
{
    const double place[2] = {scan->x_m, scan->y_m};
    struct rho_kalman kalman = random_estimate(place);

    random_covariance(kalman.covariance, 2.0);
    kalman.state[2] = (float)uniform(0.0, 12000.0);
    kalman.state[5] = (float)uniform(-50.0, 50.0);
    return kalman;
}

static void slopes_agree_with_the_linearised_filter(void **state)
{
    const struct rho_bearing_scan scan = {.x_m = 2000.0f, .y_m = -7000.0f, .z_m = 150.0f};
    const double place[2] = {2000.0, -7000.0};
    int inside = 0, outside_by_slope = 0;

    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_kalman kalman = random_estimate_with_height(&scan);
        struct rho_bearing bearing = random_bearing_near(&kalman, place, n);
        struct dense at = dense_of(kalman.state, kalman.covariance);
        struct result result, plain;

        dense_predict(&at, bearing.offset_us * 1e-6, 0.0);
        const double range = hypot(at.x[0] - place[0], at.x[1] - place[1]);
        const double spread =
            hypot(sqrt(at.p[2][2]) / range,
                  bearing.sigma_elevation_rad = (float)pow(10.0, uniform(-4.0, -1.5)));
        bearing.elevation_rad =
            (float)fmin(1.3, atan2(at.x[2] - 150.0, range) + 2.5 * spread * normal());
        const struct expected expected = expected_gate(&kalman, &bearing, place);
        const struct expected_slope slope = expected_slope_gate(&kalman, &bearing, &scan);
        const int is_in = test_gate(&kalman, &scan, &bearing, &result);
        if (fabs(expected.distance2 / (double)RHO_GATE_CHI2_1D - 1.0) > 2e-3 &&
            fabs(slope.distance2 / (double)RHO_GATE_CHI2_1D - 1.0) > 2e-3) {
            assert_int_equal(is_in, expected.distance2 < (double)RHO_GATE_CHI2_1D &&
                                        slope.distance2 < (double)RHO_GATE_CHI2_1D);
        }
        bearing.sigma_elevation_rad = 0.0f;
        const int is_in_without = test_gate(&kalman, &scan, &bearing, &plain);
        assert_true(is_in_without || !is_in);
        outside_by_slope += is_in_without && !is_in;
        if (is_in) {
            inside++;
            assert_float_equal(result.log_density - plain.log_density, slope.log_density,
                               2e-3 * (1.0 + slope.distance2) + 1e-5 * fabs(slope.log_density));
            assert_true(plain.variance == result.variance);
        }
    }
    assert_in_range(inside, NUM_CASES / 3, NUM_CASES * 9 / 10);
    assert_true(outside_by_slope > NUM_CASES / 20);
}

/* The density is that of a slope, not of an elevation: they differ where it is steep. */
static void a_wrong_elevation_is_outside_the_gate(void **state)
{
    struct rho_kalman kalman = opened_filter(3, 100.0f, 1.0f);
    const struct rho_bearing_scan scan = {.z_m = 200.0f};
    struct rho_bearing bearing = {.sigma_rad = 0.001f, .sigma_elevation_rad = 0.001f};
    struct result result;

    (void)state;
    kalman.state[0] = 3000.0f;
    kalman.state[1] = 0.0f;
    kalman.state[2] = 4200.0f;
    bearing.elevation_rad = (float)atan2(4000.0, 3000.0);
    assert_int_equal(test_gate(&kalman, &scan, &bearing, &result), 1);
    const double slope = 4.0 / 3.0, sigma = 0.001 * (1.0 + slope * slope);
    const double variance =
        pow(sigma, 2.0) * (1.0 + 100.0 / 9e6) + 100.0 * (1.0 + slope * slope) / 9e6;
    struct result plain;
    const struct rho_bearing level = {.sigma_rad = 0.001f};
    assert_int_equal(test_gate(&kalman, &scan, &level, &plain), 1);
    assert_float_equal(result.log_density - plain.log_density,
                       -0.5 * log(2.0 * DENSE_PI * variance), 2e-3);
    bearing.elevation_rad += 0.05f;
    assert_int_equal(test_gate(&kalman, &scan, &bearing, &result), 0);
    bearing.elevation_rad -= 0.1f;
    assert_int_equal(test_gate(&kalman, &scan, &bearing, &result), 0);
    bearing.sigma_elevation_rad = 0.0f;
    assert_int_equal(test_gate(&kalman, &scan, &bearing, &result), 1);
    assert_true(result.log_density == plain.log_density);
}

static void a_track_without_a_height_ignores_elevations(void **state)
{
    const struct rho_kalman kalman = opened_filter(2, 100.0f, 1.0f);
    const struct rho_bearing_scan scan = {.z_m = 200.0f};

    (void)state;
    for (int n = 0; n < 100; ++n) {
        struct result result, plain;
        struct rho_bearing bearing = {.offset_us = n % 2 * 1000,
                                      .bearing_rad = (float)atan2(200.0, 100.0),
                                      .sigma_rad = 0.001f,
                                      .elevation_rad = (float)uniform(-1.5, 1.5),
                                      .sigma_elevation_rad = 0.001f};

        assert_int_equal(test_gate(&kalman, &scan, &bearing, &result), 1);
        bearing.sigma_elevation_rad = 0.0f;
        assert_int_equal(test_gate(&kalman, &scan, &bearing, &plain), 1);
        assert_true(result.log_density == plain.log_density);
    }
}

/* Elevations steeper than RHO_ELEVATION_MAX_RAD are not measured: the bearing alone counts. */
static void steep_elevations_are_not_tested(void **state)
{
    struct rho_kalman kalman = opened_filter(3, 100.0f, 1.0f);
    const struct rho_bearing_scan scan = {.z_m = 0.0f};
    struct rho_bearing bearing = {.bearing_rad = (float)atan2(200.0, 100.0),
                                  .sigma_rad = 0.001f,
                                  .elevation_rad = 1.45f,
                                  .sigma_elevation_rad = 0.001f};
    struct result result;

    (void)state;
    assert_int_equal(test_gate(&kalman, &scan, &bearing, &result), 1);
    bearing.elevation_rad = 1.39f;
    assert_int_equal(test_gate(&kalman, &scan, &bearing, &result), 0);
}

/*
 * Targets are drawn from the track's covariance, bearings and elevations with their noise: each of
 * the two misses one in a thousand.
 */
static void the_gate_misses_two_true_elevated_bearings_in_a_thousand(void **state)
{
    struct rho_kalman kalman = opened_filter(3, 2500.0f, 100.0f);
    const struct rho_bearing_scan scan = {.z_m = 100.0f};
    int outside = 0, outside_by_slope = 0;

    (void)state;
    kalman.state[0] = -20000.0f;
    kalman.state[1] = 0.0f;
    kalman.state[2] = 8000.0f;
    for (int n = 0; n < 100000; ++n) {
        const double x = -20000.0 + 50.0 * normal(), y = 50.0 * normal();
        const double z = 8000.0 + 50.0 * normal();
        struct rho_bearing bearing = {
            .bearing_rad = (float)remainder(atan2(y, x) + 0.002 * normal(), 2.0 * DENSE_PI),
            .sigma_rad = 0.002f,
            .elevation_rad = (float)(atan2(z - 100.0, hypot(x, y)) + 0.002 * normal()),
            .sigma_elevation_rad = 0.002f};
        struct result result;
        const int is_in = test_gate(&kalman, &scan, &bearing, &result);

        outside += !is_in;
        bearing.sigma_elevation_rad = 0.0f;
        outside_by_slope += !is_in && test_gate(&kalman, &scan, &bearing, &result);
    }
    print_message("outside the gate: %d of 100000, by slope %d\n", outside, outside_by_slope);
    assert_in_range(outside, 140, 260); /* 200 expected, standard deviation 14 */
    assert_in_range(outside_by_slope, 60, 140);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_distance_agrees_with_the_linearised_filter),
        cmocka_unit_test(the_gate_misses_one_true_bearing_in_a_thousand),
        cmocka_unit_test(the_gate_is_at_the_bearings_own_time),
        cmocka_unit_test(invalid_bearings_and_estimates_are_outside_the_gate),
        cmocka_unit_test(slopes_agree_with_the_linearised_filter),
        cmocka_unit_test(a_wrong_elevation_is_outside_the_gate),
        cmocka_unit_test(a_track_without_a_height_ignores_elevations),
        cmocka_unit_test(steep_elevations_are_not_tested),
        cmocka_unit_test(the_gate_misses_two_true_elevated_bearings_in_a_thousand),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
