/* SPDX-License-Identifier: MIT */
/*
 * Slopes of bearings with an elevation compared with tangents in double precision, and the limits
 * of elevations.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "random_draws.h"
#include "rhotrack/detail/measurement.h"

#define NUM(array) (sizeof(array) / sizeof((array)[0]))
#define HALF_PI 1.57079637f /* the float nearest to pi/2, which is larger */

static const struct rho_bearing_scan scan = {.x_m = 1200.0f, .y_m = -340.0f, .z_m = 56.0f};

static struct rho_slope slope_of(float elevation_rad, float sigma_rad)
{
    const struct rho_bearing bearing = {.bearing_rad = 0.5f,
                                        .sigma_rad = 0.001f,
                                        .elevation_rad = elevation_rad,
                                        .sigma_elevation_rad = sigma_rad};

    return rho_measurement_slope(&scan, &bearing);
}

/* Relative errors; largest seen: 4e-7 at elevations near the limit. */
static void slopes_are_tangents_from_the_scans_place(void **state)
{
    (void)state;
    for (int n = 0; n < 20000; ++n) {
        const float elevation = (float)uniform(-1.4, 1.4);
        const float sigma = (float)pow(10.0, uniform(-6.0, -0.31));
        const struct rho_slope slope = slope_of(elevation, sigma);
        const double tangent = tan(elevation);
        const double scaled = (double)sigma * (1.0 + tangent * tangent);

        assert_true(slope.x_m == scan.x_m && slope.y_m == scan.y_m && slope.z_m == scan.z_m);
        assert_float_equal(slope.value, tangent, 3e-6 * fabs(tangent) + 1e-7);
        assert_float_equal(slope.sigma, scaled, 6e-6 * scaled);
    }
    assert_true(slope_of(0.0f, 0.01f).value == 0.0f && slope_of(0.0f, 0.01f).sigma == 0.01f);
}

/* Drawn elevations near a steep one have tangents with the slope's sigma. */
static void the_sigma_is_that_of_drawn_elevations(void **state)
{
    const double elevation = 0.9, sigma = 0.002;
    double sum = 0.0, squares = 0.0;
    const int draws = 40000;

    (void)state;
    for (int n = 0; n < draws; ++n) {
        const double off =
            (double)slope_of((float)(elevation + sigma * normal()), (float)sigma).value -
            tan(elevation);
        sum += off;
        squares += off * off;
    }
    const double seen = sqrt(squares / draws - sum * sum / draws / draws);
    assert_float_equal(slope_of((float)elevation, (float)sigma).sigma, seen, 0.02 * seen);
}

static void steep_elevations_and_none_are_not_measured(void **state)
{
    const float steep[] = {1.4001f, -1.4001f, 1.5f, -1.5f, HALF_PI, -HALF_PI};

    (void)state;
    for (size_t k = 0; k < NUM(steep); ++k) {
        assert_true(slope_of(steep[k], 0.01f).sigma == 0.0f);
    }
    assert_true(slope_of(RHO_ELEVATION_MAX_RAD, 0.01f).sigma > 0.0f);
    assert_true(slope_of(-RHO_ELEVATION_MAX_RAD, 0.01f).sigma > 0.0f);
    assert_true(slope_of(0.3f, 0.0f).sigma == 0.0f);
}

static int is_valid_with_elevation(float elevation_rad, float sigma_rad)
{
    return rho_bearing_is_valid(&(struct rho_bearing){.bearing_rad = 0.5f,
                                                      .sigma_rad = 0.001f,
                                                      .elevation_rad = elevation_rad,
                                                      .sigma_elevation_rad = sigma_rad});
}

static void elevations_and_their_sigmas_out_of_range_are_invalid(void **state)
{
    const float good_rad[] = {0.0f, HALF_PI, -HALF_PI, 1e-30f, RHO_ELEVATION_MAX_RAD};
    const float bad_rad[] = {1.5708f, -1.5708f, 3.0f, NAN, INFINITY, -INFINITY};
    const float good_sigma[] = {RHO_LIMIT_SIGMA_RAD_MIN, 0.002f, RHO_LIMIT_SIGMA_RAD_MAX};
    const float bad_sigma[] = {-0.002f, -1e-30f, 0.99e-6f, 1e-30f,
                               0.5001f, NAN,     INFINITY, -INFINITY};

    (void)state;
    for (size_t i = 0; i < NUM(good_sigma); ++i) {
        for (size_t k = 0; k < NUM(good_rad); ++k) {
            assert_true(is_valid_with_elevation(good_rad[k], good_sigma[i]));
        }
        for (size_t k = 0; k < NUM(bad_rad); ++k) {
            assert_false(is_valid_with_elevation(bad_rad[k], good_sigma[i]));
        }
    }
    for (size_t k = 0; k < NUM(bad_sigma); ++k) {
        assert_false(is_valid_with_elevation(0.1f, bad_sigma[k]));
    }
}

/* Without a sigma the elevation is not read. */
static void an_elevation_that_is_not_measured_may_be_anything(void **state)
{
    const float any[] = {0.0f, 100.0f, NAN, -INFINITY};

    (void)state;
    for (size_t k = 0; k < NUM(any); ++k) {
        assert_true(is_valid_with_elevation(any[k], 0.0f));
        assert_true(slope_of(any[k], 0.0f).value == 0.0f);
        assert_true(slope_of(any[k], 0.0f).sigma == 0.0f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(slopes_are_tangents_from_the_scans_place),
        cmocka_unit_test(the_sigma_is_that_of_drawn_elevations),
        cmocka_unit_test(steep_elevations_and_none_are_not_measured),
        cmocka_unit_test(elevations_and_their_sigmas_out_of_range_are_invalid),
        cmocka_unit_test(an_elevation_that_is_not_measured_may_be_anything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
