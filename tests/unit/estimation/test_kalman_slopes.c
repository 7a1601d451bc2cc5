/* SPDX-License-Identifier: MIT */
/*
 * Slopes of bearings in the Kalman filter: linearisation, updates and first heights, compared with
 * double precision.
 */
#include <float.h>

#include "dense_filter_slope_measurement.h"
#include "kalman_checks.h"

#define NUM_CASES 3000
#define PI 3.14159265358979323846

/* Relative to the range and to sigmas of the estimate before; largest seen: 2e-7, 3e-6. */
#define OFF_RELATIVE 6e-7
#define UPDATE_RELATIVE 1e-5

/* A sensor in whole metres, a slope of up to 2 and a sigma of 1e-5 to 0.03. */
static struct rho_slope random_slope(void)
{
    return (struct rho_slope){.x_m = (float)floor(uniform(-3e4, 3e4)),
                              .y_m = (float)floor(uniform(-3e4, 3e4)),
                              .z_m = (float)floor(uniform(-100.0, 3000.0)),
                              .value = (float)uniform(-2.0, 2.0),
                              .sigma = (float)pow(10.0, uniform(-5.0, -1.5))};
}

/* A correlated estimate with sigmas of 1 to 100, 3 to 160 km from the place, near the slope. */
static struct rho_kalman random_estimate(const struct rho_slope *slope)
{
    struct rho_kalman kalman;
    const double range = pow(10.0, uniform(3.5, 5.2)), direction = uniform(-PI, PI);

    random_covariance(kalman.covariance, 2.0);
    for (int i = 3; i < STATES; ++i) {
        kalman.state[i] = (float)uniform(-500.0, 500.0);
    }
    kalman.state[0] = (float)((double)slope->x_m + range * cos(direction));
    kalman.state[1] = (float)((double)slope->y_m + range * sin(direction));
    kalman.state[2] = (float)((double)slope->z_m + (double)slope->value * range +
                              3.0 * (double)slope->sigma * range * normal() + 50.0 * normal());
    return kalman;
}

static void the_linearised_slope_agrees_with_its_derivative(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_slope slope = random_slope();
        const struct rho_kalman kalman = random_estimate(&slope);
        const struct dense at = dense_of(kalman.state, kalman.covariance);
        const struct dense_measurement expected = dense_slope(&at, &slope);
        const double range = hypot(at.x[0] - (double)slope.x_m, at.x[1] - (double)slope.y_m);
        struct rho_kalman_bearing seen;

        assert_int_equal(rho_kalman_linearise_slope(&kalman, &slope, &seen), 1);
        assert_float_equal(seen.range_m, range, 3e-7 * range);
        assert_float_equal(seen.off_m, expected.y[0], OFF_RELATIVE * range);
        assert_float_equal(seen.variance_m2, expected.r[0][0], 2e-6 * expected.r[0][0]);
        for (int i = 0; i < STATES; ++i) {
            assert_float_equal(seen.row[i], expected.h[0][i], 1e-6);
        }
    }
}

/* The place is uncertain by 10 % of the range: the noise is that of drawn places and slopes. */
static void the_noise_is_that_of_drawn_places(void **state)
{
    const struct rho_slope slope = {.value = 0.2f, .sigma = 0.05f};
    struct rho_kalman kalman = opened_filter(3, 1e6f, 100.0f);
    struct rho_kalman_bearing seen;
    double sum = 0.0;
    const int draws = 200000;

    (void)state;
    kalman.state[0] = 1500.0f;
    kalman.state[1] = 2000.0f;
    for (int n = 0; n < draws; ++n) {
        const double along = 2500.0 + 1000.0 * normal();

        sum += pow((double)slope.sigma * normal() * along, 2.0);
    }
    assert_int_equal(rho_kalman_linearise_slope(&kalman, &slope, &seen), 1);
    assert_float_equal(seen.variance_m2, sum / draws, 0.02 * sum / draws);
}

static void assert_slope_undefined(const struct rho_kalman *kalman, const struct rho_slope *slope)
{
    struct rho_kalman_bearing seen, guard;
    struct rho_kalman updated = *kalman;

    memset(&guard, 0x5a, sizeof guard);
    seen = guard;
    assert_int_equal(rho_kalman_linearise_slope(kalman, slope, &seen), 0);
    assert_memory_equal(&seen, &guard, sizeof seen);
    assert_int_equal(rho_kalman_update_slope(&updated, slope, 100.0f), RHO_OK);
    assert_changed_nothing(&updated, kalman);
}

static void nothing_is_done_without_a_slope_or_within_a_metre(void **state)
{
    const float bad[] = {NAN, INFINITY, -INFINITY, FLT_MAX, 3e19f};

    (void)state;
    for (int axes = 2; axes <= 3; ++axes) {
        struct rho_kalman kalman = opened_filter(axes, 1e4f, 100.0f); /* at (100, 200) m */
        struct rho_slope slope = {.x_m = 50.0f, .y_m = 20.0f, .value = 0.1f};

        assert_slope_undefined(&kalman, &slope);
        slope.sigma = -0.01f;
        assert_slope_undefined(&kalman, &slope);
        slope.sigma = NAN;
        assert_slope_undefined(&kalman, &slope);
        slope = (struct rho_slope){.x_m = 100.7f, .y_m = 199.3f, .value = 0.1f, .sigma = 0.01f};
        assert_slope_undefined(&kalman, &slope);
        slope.x_m = 101.0f;
        slope.y_m = 200.0f;
        struct rho_kalman_bearing seen;
        assert_int_equal(rho_kalman_linearise_slope(&kalman, &slope, &seen), 1);
        for (size_t k = 0; k < NUM(bad); ++k) {
            struct rho_kalman worse = kalman;

            worse.state[k % 2] = bad[k];
            assert_slope_undefined(&worse, &slope);
        }
    }
}

static void updates_agree_with_the_joseph_form(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_slope slope = random_slope();
        struct rho_kalman kalman = random_estimate(&slope);
        const struct dense before = dense_of(kalman.state, kalman.covariance);
        const struct dense_measurement m = dense_slope(&before, &slope);
        const double range =
            hypot(before.x[0] - (double)slope.x_m, before.x[1] - (double)slope.y_m);
        const double rounding = OFF_RELATIVE * range / sqrt(dense_innovation_variance(&before, &m));
        struct dense expected = before;

        dense_update(&expected, &m);
        assert_int_equal(rho_kalman_update_slope(&kalman, &slope, 7.0f), RHO_OK);
        for (int i = 0; i < STATES; ++i) {
            const double sigma = sqrt(before.p[i][i]);

            assert_float_equal(kalman.state[i], expected.x[i],
                               (UPDATE_RELATIVE + rounding) * sigma +
                                   DENSE_ROUNDING * fabs(expected.x[i]));
            for (int j = 0; j <= i; ++j) {
                assert_float_equal(kalman.covariance[RHO_AT(i, j)], expected.p[i][j],
                                   UPDATE_RELATIVE * sigma * sqrt(before.p[j][j]));
            }
        }
        assert_true(is_positive_definite(&kalman));
    }
}

/* Without a height, or a slope, nothing is told against a bearing. */
static void the_density_of_a_slope_agrees_with_the_linearised_filter(void **state)
{
    const struct rho_slope none = {.sigma = 0.0f};

    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_slope slope = random_slope();
        struct rho_kalman kalman = random_estimate(&slope);
        const struct dense at = dense_of(kalman.state, kalman.covariance);
        const struct dense_measurement m = dense_slope(&at, &slope);
        const double range = hypot(at.x[0] - (double)slope.x_m, at.x[1] - (double)slope.y_m);
        const double variance = dense_innovation_variance(&at, &m);
        const double expected = m.y[0] * m.y[0] / variance;
        float nis = -1.0f;
        const double density = (double)rho_kalman_slope_density(&kalman, &slope, &nis);

        assert_float_equal(nis, expected, 1e-2 * (1.0 + expected));
        if (expected < 20.0) {
            assert_float_equal(
                density, range / sqrt(2.0 * 3.14159265358979 * variance) * exp(-0.5 * (double)nis),
                1e-3 * density);
        }
        assert_true(rho_kalman_slope_density(&kalman, &none, &nis) == 1.0f && nis == 0.0f);
        close_axis(&kalman, 2);
        nis = 1.0f;
        assert_true(rho_kalman_slope_density(&kalman, &slope, &nis) == 1.0f && nis == 0.0f);
    }
}

/* A height that another estimate saw is that of this one, too, with the covariances of its own. */
static void a_height_of_another_estimate_is_taken(void **state)
{
    (void)state;
    for (int n = 0; n < 100; ++n) {
        const struct rho_slope slope = random_slope();
        struct rho_kalman kalman = random_estimate(&slope);
        struct rho_kalman_bearing seen;

        close_axis(&kalman, 2);
        assert_int_equal(rho_kalman_linearise_slope(&kalman, &slope, &seen), 1);
        seen.off_m = 1234.0f;
        assert_int_equal(rho_kalman_open_height(&kalman, &seen, 81.0f), RHO_OK);
        assert_true(kalman.state[2] == 1234.0f && kalman.covariance[RHO_AT(5, 5)] == 81.0f);
        const double with_x = -(double)seen.row[0] * (double)kalman.covariance[0] -
                              (double)seen.row[1] * (double)kalman.covariance[RHO_AT(1, 0)];
        assert_float_equal(
            kalman.covariance[RHO_AT(2, 0)], with_x,
            1e-5 * sqrt((double)kalman.covariance[0] * (double)kalman.covariance[RHO_AT(2, 2)]));
        seen.variance_m2 = NAN;
        close_axis(&kalman, 2);
        assert_int_equal(rho_kalman_open_height(&kalman, &seen, 81.0f), RHO_ERROR_VALUE);
    }
}

/* The first height is that of the line of sight; its variance has the range's and the slope's. */
static void a_first_slope_gives_a_height(void **state)
{
    (void)state;
    for (int n = 0; n < NUM_CASES; ++n) {
        const struct rho_slope slope = random_slope();
        struct rho_kalman kalman = random_estimate(&slope);

        close_axis(&kalman, 2);
        const struct rho_kalman closed = kalman;
        const struct dense before = dense_of(kalman.state, kalman.covariance);
        const struct dense_measurement m = dense_slope(&before, &slope);
        const double range =
            hypot(before.x[0] - (double)slope.x_m, before.x[1] - (double)slope.y_m);
        const double variance = dense_innovation_variance(&before, &m);

        assert_int_equal(rho_kalman_update_slope(&kalman, &slope, 81.0f), RHO_OK);
        assert_float_equal(kalman.state[2], (double)slope.z_m + (double)slope.value * range,
                           OFF_RELATIVE * range);
        assert_float_equal(kalman.covariance[RHO_AT(2, 2)], variance, 1e-5 * variance);
        assert_true(kalman.state[5] == 0.0f && kalman.covariance[RHO_AT(5, 5)] == 81.0f);
        for (int i = 0; i < STATES; ++i) {
            for (int j = 0; j <= i && i % 3 < 2; ++j) {
                if (j % 3 < 2) {
                    assert_true(kalman.covariance[RHO_AT(i, j)] == closed.covariance[RHO_AT(i, j)]);
                }
            }
            assert_true(i % 3 == 2 || kalman.state[i] == closed.state[i]);
        }
        assert_true(is_positive_definite(&kalman));
    }
}

/*
 * A place that a radar knows well, seen by a camera every second while the target climbs: heights
 * have the errors that the covariance tells. 99.9 % of mean NEES of 300 runs are within the bounds.
 */
static void heights_from_slopes_have_the_errors_that_they_tell(void **state)
{
    double nees = 0.0;
    const int runs = 300;

    (void)state;
    for (int n = 0; n < runs; ++n) {
        const double climb = 20.0 * normal(), height = uniform(500.0, 5000.0);
        struct rho_kalman kalman = opened_filter(2, 100.0f, 4.0f);

        kalman.state[0] = (float)(8000.0 + 10.0 * normal());
        kalman.state[1] = (float)(6000.0 + 10.0 * normal());
        kalman.state[3] = (float)(100.0 + 2.0 * normal());
        kalman.state[4] = (float)(50.0 + 2.0 * normal());
        for (int k = 0; k < 20; ++k) {
            const double range = hypot(8000.0 + 100.0 * k, 6000.0 + 50.0 * k);
            const double elevation = atan2(height + climb * k - 30.0, range) + 0.001 * normal();
            const struct rho_bearing_scan scan = {.z_m = 30.0f};
            const struct rho_bearing bearing = {.elevation_rad = (float)elevation,
                                                .sigma_elevation_rad = 0.001f};
            const struct rho_slope slope = rho_measurement_slope(&scan, &bearing);

            assert_int_equal(rho_kalman_update_slope(&kalman, &slope, 400.0f), RHO_OK);
            if (k < 19) {
                assert_int_equal(rho_kalman_predict(&kalman, 1.0f, 0.0f), RHO_OK);
            }
        }
        const double off[2] = {(double)kalman.state[2] - height - 19.0 * climb,
                               (double)kalman.state[5] - climb};
        const double zz = (double)kalman.covariance[RHO_AT(2, 2)],
                     vz = (double)kalman.covariance[RHO_AT(5, 2)],
                     vv = (double)kalman.covariance[RHO_AT(5, 5)];
        nees += (off[0] * off[0] * vv - 2.0 * off[0] * off[1] * vz + off[1] * off[1] * zz) /
                (zz * vv - vz * vz) / runs;
    }
    print_message("NEES of height and climb: %.3f\n", nees);
    assert_true(nees > 1.6 && nees < 2.4);
}

/*
 * Elevations of one sensor tell nothing of the range: its error is that of before, however many
 * there are, and so is what the covariance tells of it.
 */
static void slopes_of_one_place_leave_the_range_uncertain(void **state)
{
    double nees = 0.0;
    const int runs = 2000;

    (void)state;
    for (int n = 0; n < runs; ++n) {
        struct rho_kalman kalman = opened_filter(2, 1e6f, 0.01f);

        kalman.state[0] = (float)(40000.0 + 1000.0 * normal());
        kalman.state[1] = 0.0f;
        kalman.covariance[RHO_AT(1, 1)] = 100.0f;
        for (int k = 0; k < 4; ++k) {
            const struct rho_bearing_scan scan = {.z_m = 0.0f};
            const struct rho_bearing bearing = {
                .elevation_rad = (float)(atan2(8000.0, 40000.0) + 0.001 * normal()),
                .sigma_elevation_rad = 0.001f};
            const struct rho_slope slope = rho_measurement_slope(&scan, &bearing);

            assert_int_equal(rho_kalman_update_slope(&kalman, &slope, 0.01f), RHO_OK);
        }
        nees += pow((double)kalman.state[0] - 40000.0, 2.0) /
                (double)kalman.covariance[RHO_AT(0, 0)] / runs;
    }
    print_message("NEES of the range: %.2f\n", nees);
    assert_true(nees > 0.85 && nees < 1.15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_linearised_slope_agrees_with_its_derivative),
        cmocka_unit_test(the_noise_is_that_of_drawn_places),
        cmocka_unit_test(nothing_is_done_without_a_slope_or_within_a_metre),
        cmocka_unit_test(updates_agree_with_the_joseph_form),
        cmocka_unit_test(the_density_of_a_slope_agrees_with_the_linearised_filter),
        cmocka_unit_test(a_height_of_another_estimate_is_taken),
        cmocka_unit_test(a_first_slope_gives_a_height),
        cmocka_unit_test(heights_from_slopes_have_the_errors_that_they_tell),
        cmocka_unit_test(slopes_of_one_place_leave_the_range_uncertain),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
