/* SPDX-License-Identifier: MIT */
/*
 * Crossings of bearings compared with rays intersected in double precision, and their covariance
 * with that of many noisy bearings.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "rhotrack/detail/bearing_crossing.h"

#define PI 3.14159265358979323846
#define RANGE_MAX_M 100000.0f

static uint64_t random_state = 1;

static double uniform(double from, double to)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(random_state >> 11) / 9007199254740992.0;
}

static double normal(void)
{
    double sum = -6.0;
    for (int i = 0; i < 12; i++) {
        sum += uniform(0.0, 1.0);
    }
    return sum;
}

static struct rho_crossing_base base;
static struct rho_crossing crossing;

static void set_base(double x_a_m, double y_a_m, double x_b_m, double y_b_m)
{
    assert_int_equal(
        rho_crossing_set_base(&base, (float)x_a_m, (float)y_a_m, (float)x_b_m, (float)y_b_m),
        RHO_OK);
}

/* Places two sensors 5 to 20 km apart in any direction. */
static void set_random_base(void)
{
    double length_m = uniform(5e3, 20e3), direction = uniform(-PI, PI);
    double x_m = uniform(-20e3, 20e3), y_m = uniform(-20e3, 20e3);
    set_base(x_m, y_m, x_m + length_m * cos(direction), y_m + length_m * sin(direction));
}

/*
 * Ranges of the lines' intersection from sensors a and b, negative behind a sensor; sine of their
 * angle.
 */
struct rays {
    double a_m, b_m, sine;
};

static struct rays ranges_and_sine_of_crossing_rays(float bearing_a, float bearing_b)
{
    double ca = cos(bearing_a), sa = sin(bearing_a), cb = cos(bearing_b), sb = sin(bearing_b);
    double dx = (double)base.x_b_m - (double)base.x_a_m;
    double dy = (double)base.y_b_m - (double)base.y_a_m, sine = ca * sb - sa * cb;
    return (struct rays){(dx * sb - dy * cb) / sine, (dx * sa - dy * ca) / sine, sine};
}

/* True if float may decide differently than double. */
static int is_borderline(struct rays rays)
{
    return fabs(rays.sine) < 1e-4 || fabs(rays.a_m - RANGE_MAX_M) < 100.0 ||
           fabs(rays.b_m - RANGE_MAX_M) < 100.0 || fabs(rays.a_m) < 1.0 || fabs(rays.b_m) < 1.0;
}

static void crossings_agree_with_intersected_rays(void **state)
{
    (void)state;
    int met = 0;
    for (int run = 0; run < 200000; run++) {
        set_random_base();
        float a = (float)uniform(-PI, PI), b = (float)uniform(-PI, PI);
        struct rays rays = ranges_and_sine_of_crossing_rays(a, b);
        if (is_borderline(rays)) {
            continue;
        }
        int meets =
            rays.a_m > 0.0 && rays.b_m > 0.0 && rays.a_m < RANGE_MAX_M && rays.b_m < RANGE_MAX_M;
        enum rho_crossing_fate fate = rho_crossing_find(&base, a, b, RANGE_MAX_M, &crossing);
        assert_int_equal(fate == RHO_CROSSING_MEETS, meets);
        if (!meets && rays.a_m > 0.0 && rays.b_m > 0.0) {
            assert_int_equal(fate, RHO_CROSSING_RANGE);
        }
        met += meets;
    }
    assert_true(met > 20000);
}

static void crossing_places_are_exact_to_a_metre(void **state)
{
    (void)state;
    for (int run = 0; run < 200000; run++) {
        set_random_base();
        double range_m = uniform(1e3, 80e3), direction = uniform(-PI, PI);
        double x_m = base.x_a_m + range_m * cos(direction);
        double y_m = base.y_a_m + range_m * sin(direction);
        float a = (float)atan2(y_m - base.y_a_m, x_m - base.x_a_m);
        float b = (float)atan2(y_m - base.y_b_m, x_m - base.x_b_m);
        struct rays rays = ranges_and_sine_of_crossing_rays(a, b);
        if (rays.b_m > 80e3 || fabs(rays.sine) < 0.02) {
            continue;
        }
        assert_int_equal(rho_crossing_find(&base, a, b, RANGE_MAX_M, &crossing),
                         RHO_CROSSING_MEETS);
        assert_float_equal(crossing.x_m, base.x_a_m + rays.a_m * cos(a), 1.0);
        assert_float_equal(crossing.y_m, base.y_a_m + rays.a_m * sin(a), 1.0);
        assert_float_equal(crossing.range_a_m, rays.a_m, 1.0);
        assert_float_equal(crossing.range_b_m, rays.b_m, 1.0);
        assert_float_equal(sin(crossing.delta_rad), fabs(rays.sine), 1e-6);
    }
}

/* With sensors at (0, +-10 km), as in the paper's figures. */
static void bearings_that_do_not_meet_tell_why(void **state)
{
    (void)state;
    set_base(0, -10e3, 0, 10e3);
    assert_int_equal(rho_crossing_find(&base, 0.1f, 3.0f, 1e6f, &crossing), RHO_CROSSING_SIDES);
    assert_int_equal(rho_crossing_find(&base, -0.1f, 0.1f, 1e6f, &crossing), RHO_CROSSING_APART);
    assert_int_equal(rho_crossing_find(&base, 0.5f, 0.5f, 1e6f, &crossing), RHO_CROSSING_APART);
    assert_int_equal(rho_crossing_find(&base, 0.1f, -0.1f, 99e3f, &crossing), RHO_CROSSING_RANGE);
    assert_int_equal(rho_crossing_find(&base, 0.1f, -0.1f, 101e3f, &crossing), RHO_CROSSING_MEETS);
    assert_float_equal(crossing.x_m, 10e3 / tan(0.1), 1.0);
    assert_float_equal(crossing.y_m, 0.0, 1.0);
    assert_int_equal(rho_crossing_find(&base, NAN, -0.1f, 1e6f, &crossing), RHO_CROSSING_APART);
    assert_int_equal(rho_crossing_find(&base, 0.1f, INFINITY, 1e6f, &crossing), RHO_CROSSING_APART);
}

/* Nearly parallel lines a kilometre apart meet at 10^9 m if they differ by a microradian. */
static void bearings_less_than_a_microradian_apart_are_parallel(void **state)
{
    (void)state;
    set_base(0.0, 0.0, 0.0, 1000.0);
    assert_int_equal(rho_crossing_find(&base, 0.0f, -0.8e-6f, RANGE_MAX_M, &crossing),
                     RHO_CROSSING_APART);
    assert_int_equal(rho_crossing_find(&base, 0.0f, -1.3e-6f, RANGE_MAX_M, &crossing),
                     RHO_CROSSING_RANGE);
}

static void a_crossing_behind_the_base_is_found(void **state)
{
    (void)state;
    set_base(0, -10e3, 0, 10e3);
    float a = (float)atan2(10e3 + 5e3, -30e3), b = (float)atan2(5e3 - 10e3, -30e3);
    assert_int_equal(rho_crossing_find(&base, a, b, RANGE_MAX_M, &crossing), RHO_CROSSING_MEETS);
    assert_float_equal(crossing.x_m, -30e3, 1.0);
    assert_float_equal(crossing.y_m, 5e3, 1.0);
}

static void the_crossing_angle_is_the_difference_of_the_bearings(void **state)
{
    (void)state;
    set_base(0, -10e3, 0, 10e3);
    assert_float_equal(rho_crossing_angle_rad(&base, 0.1f, -0.2f), 0.3, 1e-6);
    assert_float_equal(rho_crossing_angle_rad(&base, -0.2f, 0.1f), -0.3, 1e-6);
    assert_float_equal(rho_crossing_angle_rad(&base, 3.0f, -3.0f), 2.0 * PI - 6.0, 1e-6);
    assert_float_equal(rho_crossing_angle_rad(&base, 0.1f, 3.0f), -PI, 1e-6);
}

/* It does not matter which sensor is a and which is b. */
static void exchanging_the_sensors_gives_the_same_crossing(void **state)
{
    (void)state;
    for (int run = 0; run < 20000; run++) {
        set_random_base();
        float a = (float)uniform(-PI, PI), b = (float)uniform(-PI, PI);
        struct rays rays = ranges_and_sine_of_crossing_rays(a, b);
        enum rho_crossing_fate fate = rho_crossing_find(&base, a, b, RANGE_MAX_M, &crossing);
        struct rho_crossing first = crossing;
        set_base(base.x_b_m, base.y_b_m, base.x_a_m, base.y_a_m);
        enum rho_crossing_fate other = rho_crossing_find(&base, b, a, RANGE_MAX_M, &crossing);
        if (is_borderline(rays)) {
            continue;
        }
        assert_int_equal(fate, other);
        if (fate == RHO_CROSSING_MEETS && fabs(rays.sine) > 0.02) {
            assert_float_equal(first.x_m, crossing.x_m, 1.0);
            assert_float_equal(first.y_m, crossing.y_m, 1.0);
        }
    }
}

static void the_covariance_agrees_with_noisy_bearings(void **state)
{
    (void)state;
    const float a = 0.35f, b = -0.12f, sigma_a = 0.002f, sigma_b = 0.001f;
    float covariance[3];
    double sum[3] = {0}, mean[2] = {0};
    const int runs = 40000;
    set_base(0, -10e3, 0, 10e3);
    assert_int_equal(rho_crossing_find(&base, a, b, 1e6f, &crossing), RHO_CROSSING_MEETS);
    const struct rho_crossing_ray ray_a = {cosf(a), sinf(a), crossing.range_a_m, sigma_a};
    const struct rho_crossing_ray ray_b = {cosf(b), sinf(b), crossing.range_b_m, sigma_b};
    rho_crossing_covariance(&ray_a, &ray_b, covariance);
    for (int run = 0; run < runs; run++) {
        struct rho_crossing noisy;
        float seen_a = a + (float)(sigma_a * normal()), seen_b = b + (float)(sigma_b * normal());
        assert_int_equal(rho_crossing_find(&base, seen_a, seen_b, 1e6f, &noisy),
                         RHO_CROSSING_MEETS);
        double x = (double)noisy.x_m - crossing.x_m, y = (double)noisy.y_m - crossing.y_m;
        mean[0] += x / runs;
        mean[1] += y / runs;
        sum[0] += x * x / runs;
        sum[1] += x * y / runs;
        sum[2] += y * y / runs;
    }
    assert_float_equal(covariance[0] / (sum[0] - mean[0] * mean[0]), 1.0, 0.03);
    assert_float_equal(covariance[1] / (sum[1] - mean[0] * mean[1]), 1.0, 0.06);
    assert_float_equal(covariance[2] / (sum[2] - mean[1] * mean[1]), 1.0, 0.03);
}

static void invalid_sensor_places_are_refused(void **state)
{
    (void)state;
    set_base(0, 0, 100, 0);
    struct rho_crossing_base before = base;
    assert_int_equal(rho_crossing_set_base(&base, 5, 5, 5, 5.5f), RHO_ERROR_VALUE);
    assert_int_equal(rho_crossing_set_base(&base, 5, NAN, 5, 50), RHO_ERROR_VALUE);
    assert_int_equal(rho_crossing_set_base(&base, 2.1e6f, 0, 5, 50), RHO_ERROR_VALUE);
    assert_int_equal(rho_crossing_set_base(&base, 0, 0, 5, INFINITY), RHO_ERROR_VALUE);
    assert_memory_equal(&before, &base, sizeof base);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crossings_agree_with_intersected_rays),
        cmocka_unit_test(crossing_places_are_exact_to_a_metre),
        cmocka_unit_test(bearings_that_do_not_meet_tell_why),
        cmocka_unit_test(bearings_less_than_a_microradian_apart_are_parallel),
        cmocka_unit_test(a_crossing_behind_the_base_is_found),
        cmocka_unit_test(the_crossing_angle_is_the_difference_of_the_bearings),
        cmocka_unit_test(exchanging_the_sensors_gives_the_same_crossing),
        cmocka_unit_test(the_covariance_agrees_with_noisy_bearings),
        cmocka_unit_test(invalid_sensor_places_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
