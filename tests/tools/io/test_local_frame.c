/* SPDX-License-Identifier: MIT */
/*
 * Latitude, longitude and height to local metres: a published example, textbook formulas for
 * comparison, and back again.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

#include "base/random.h"
#include "io/csv/local_frame.h"

#define DEG_RAD (3.14159265358979323846264338328L / 180)
#define PI 3.14159265358979323846

static void ecef_of_geodetic(const double geodetic[3], long double ecef_m[3])
{
    const long double a = 6378137.0L, f = 1 / 298.257223563L, e2 = f * (2 - f);
    long double lat = geodetic[0] * DEG_RAD, lon = geodetic[1] * DEG_RAD;
    long double normal = a / sqrtl(1 - e2 * sinl(lat) * sinl(lat));

    ecef_m[0] = (normal + geodetic[2]) * cosl(lat) * cosl(lon);
    ecef_m[1] = (normal + geodetic[2]) * cosl(lat) * sinl(lon);
    ecef_m[2] = (normal * (1 - e2) + geodetic[2]) * sinl(lat);
}

static void local_of_geodetic(const double origin[3], const double geodetic[3], double place_m[3])
{
    long double lat = origin[0] * DEG_RAD, lon = origin[1] * DEG_RAD, from[3], to[3];

    ecef_of_geodetic(origin, from);
    ecef_of_geodetic(geodetic, to);
    for (int i = 0; i < 3; i++) {
        to[i] -= from[i];
    }
    long double outward = cosl(lon) * to[0] + sinl(lon) * to[1];
    place_m[0] = (double)(-sinl(lon) * to[0] + cosl(lon) * to[1]);
    place_m[1] = (double)(-sinl(lat) * outward + cosl(lat) * to[2]);
    place_m[2] = (double)(cosl(lat) * outward + sinl(lat) * to[2]);
}

/* In double precision; cmocka compares as float32. */
static void assert_close(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance)) {
        fail_msg("%.12g is not %.12g to %g", a, b, tolerance);
    }
}

static void assert_near(const double a[3], const double b[3], double tolerance_m)
{
    for (int i = 0; i < 3; i++) {
        assert_close(a[i], b[i], tolerance_m);
    }
}

static double length_m(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static const double origins[][3] = {{0, 0, 0},           {52.5, 13.4, 34},  {-33.9, 151.2, -5},
                                    {64.1, -21.9, 4000}, {51.0, 179.9, 0},  {89.9, 45, 100},
                                    {-90, 0, 2800},      {23.4, -180, 9000}};
#define NUM_ORIGINS (sizeof origins / sizeof *origins)

static struct local_frame *open_frame_at(const double origin[3])
{
    return local_frame_open(origin[0], origin[1], origin[2]);
}

/* Example of IOGP Guidance Note 7-2, EPSG method 9837, printed to a millimetre. */
static void the_example_of_epsg_9837_is_reproduced(void **state)
{
    const double geodetic[3] = {53 + 48 / 60.0 + 33.820 / 3600, 2 + 7 / 60.0 + 46.380 / 3600, 73};
    const double published_m[3] = {-189013.869, -128642.040, -4220.171};
    struct local_frame *frame = local_frame_open(55, 5, 200);
    double place_m[3];

    (void)state;
    local_frame_to_local(frame, geodetic, place_m);
    assert_near(place_m, published_m, 0.01);
    local_frame_close(frame);
}

static void conversions_equal_textbook_formulas_both_ways(void **state)
{
    struct random random;

    (void)state;
    random = random_start(1, 0, 0);
    for (size_t i = 0; i < NUM_ORIGINS; i++) {
        struct local_frame *frame = open_frame_at(origins[i]);
        double worst_m = 0;

        for (int run = 0; run < 500; run++) {
            double place_m[3], again_m[3], geodetic[3];
            double range_m = 2e6 * random_uniform(&random),
                   azimuth = 2 * PI * random_uniform(&random);

            place_m[0] = range_m * cos(azimuth);
            place_m[1] = range_m * sin(azimuth);
            place_m[2] = -range_m * range_m / 2 / 6.371e6 + 40000 * (random_uniform(&random) - 0.5);
            local_frame_to_geodetic(frame, place_m, geodetic);
            assert_true(fabs(geodetic[0]) <= 90 && fabs(geodetic[1]) <= 180);
            local_frame_to_local(frame, geodetic, again_m);
            assert_near(again_m, place_m, 1e-3);
            local_of_geodetic(origins[i], geodetic, again_m);
            assert_near(again_m, place_m, 1e-3);
            worst_m = fmax(worst_m, fabs(again_m[2] - place_m[2]));
        }
        print_message("origin %g %g: worst %.1e m\n", origins[i][0], origins[i][1], worst_m);
        local_frame_close(frame);
    }
}

static void local_axes_point_east_north_and_up(void **state)
{
    struct local_frame *frame = local_frame_open(50, 10, 100);
    const double east[3] = {50, 10.001, 100}, north[3] = {50.001, 10, 100}, up[3] = {50, 10, 200};
    double place_m[3];

    (void)state;
    local_frame_to_local(frame, east, place_m);
    assert_true(place_m[0] > 71 && place_m[0] < 72 && fabs(place_m[1]) < 0.01);
    local_frame_to_local(frame, north, place_m);
    assert_true(place_m[1] > 111 && place_m[1] < 112 && fabs(place_m[0]) < 1e-6);
    local_frame_to_local(frame, up, place_m);
    assert_near(place_m, (double[3]){0, 0, 100}, 1e-6);
    local_frame_close(frame);
}

static void places_across_the_date_line_are_near(void **state)
{
    struct local_frame *frame = local_frame_open(10, 179.99, 0);
    const double here[3] = {10, -179.99, 0}, same[3] = {10, 180.01, 0};
    double place_m[3], same_m[3];

    (void)state;
    local_frame_to_local(frame, here, place_m);
    local_frame_to_local(frame, same, same_m);
    assert_near(place_m, same_m, 1e-6);
    assert_true(place_m[0] > 2190 && place_m[0] < 2200);
    local_frame_close(frame);
}

static void at_height_finds_the_geodetic_place(void **state)
{
    struct local_frame *frame = local_frame_open(50, 10, 100);

    (void)state;
    for (int km = 0; km <= 1400; km += 100) {
        double geodetic[3], place_m[3];

        local_frame_at_height(frame, km * 1e3, -km * 1e3, 2500, geodetic);
        local_frame_to_local(frame, geodetic, place_m);
        assert_close(geodetic[2], 2500, 1e-3);
        assert_close(place_m[0], km * 1e3, 1e-3);
        assert_close(place_m[1], -km * 1e3, 1e-3);
    }
    local_frame_close(frame);
}

/*
 * For small differences in longitude the convergence is sin(latitude) times the difference: seen
 * from a western sensor, true north at an eastern one is turned.
 */
static void frames_differ_by_the_meridian_convergence(void **state)
{
    struct local_frame *common = local_frame_open(50, 10, 0);
    struct local_frame *east = local_frame_open(50, 12, 0), *south = local_frame_open(48, 10, 300);

    (void)state;
    assert_close(local_frame_convergence_rad(common, common), 0, 1e-12);
    assert_close(local_frame_convergence_rad(south, common), 0, 1e-12);
    assert_close(local_frame_convergence_rad(east, common), sin(50 * PI / 180) * 2 * PI / 180,
                 1e-4);
    local_frame_close(common);
    local_frame_close(east);
    local_frame_close(south);
}

static void conversion_between_frames_keeps_distances(void **state)
{
    struct local_frame *one = local_frame_open(50, 10, 0), *other = local_frame_open(51, 13, 500);
    const double a_m[3] = {10000, -20000, 3000}, b_m[3] = {-70000, 5000, 12000};
    double a[3], b[3], before[3], after[3];

    (void)state;
    local_frame_convert_place(one, other, a_m, a);
    local_frame_convert_place(one, other, b_m, b);
    for (int i = 0; i < 3; i++) {
        before[i] = a_m[i] - b_m[i];
        after[i] = a[i] - b[i];
    }
    assert_close(length_m(before), length_m(after), 1e-6);
    local_frame_convert_place(other, one, a, a);
    assert_near(a, a_m, 1e-6);
    local_frame_close(one);
    local_frame_close(other);
}

/* A known place as a radar sees it: range and azimuth by the textbook formulas. */
static void check_place_from_range_and_height(const double radar[3], const double target[3])
{
    struct local_frame *frame = open_frame_at(radar);
    double seen_m[3], found_m[3];

    local_of_geodetic(radar, target, seen_m);
    const struct local_frame_plot plot = {.range_m = length_m(seen_m),
                                          .azimuth_rad = atan2(seen_m[1], seen_m[0]),
                                          .alt_m = target[2]};
    assert_true(local_frame_from_slant_range(frame, &plot, found_m));
    /*
     * near the zenith the range hardly depends on the place: tolerance of 0.1 mm of height,
     * converted to ground distance
     */
    double ground_m = hypot(seen_m[0], seen_m[1]);
    double slope = fmax(1.0, fabs(seen_m[2]) / fmax(ground_m, 1.0));
    assert_near(found_m, seen_m, 2e-3 * slope);
    local_frame_close(frame);
}

static void range_azimuth_and_height_give_the_place(void **state)
{
    struct random random;

    (void)state;
    random = random_start(2, 0, 0);
    for (size_t i = 0; i < NUM_ORIGINS; i++) {
        for (int run = 0; run < 300; run++) {
            double away_deg = 5 * random_uniform(&random) * random_uniform(&random);
            double azimuth = 2 * PI * random_uniform(&random);
            double lat = origins[i][0] * 0.94 + away_deg * sin(azimuth);
            double lon = origins[i][1] + away_deg * cos(azimuth) / cos(lat * PI / 180);
            const double target[3] = {lat, lon, 14000 * random_uniform(&random)};

            check_place_from_range_and_height(
                (double[3]){origins[i][0] * 0.94, origins[i][1], origins[i][2]}, target);
        }
    }
}

static void a_height_that_the_range_cannot_reach_is_refused(void **state)
{
    struct local_frame *radar = local_frame_open(50, 10, 400);
    double place_m[3] = {1, 2, 3};

    (void)state;
    assert_false(local_frame_from_slant_range(radar, &(struct local_frame_plot){5000, 0.3, 5400.01},
                                              place_m));
    assert_false(local_frame_from_slant_range(
        radar, &(struct local_frame_plot){5000, 0.3, -4600.01}, place_m));
    assert_near(place_m, (double[3]){1, 2, 3}, 0);
    assert_true(
        local_frame_from_slant_range(radar, &(struct local_frame_plot){5000, 0.3, 5400}, place_m));
    assert_near(place_m, (double[3]){0, 0, 5000}, 1.5);
    assert_true(
        local_frame_from_slant_range(radar, &(struct local_frame_plot){5000, 0.3, 5399}, place_m));
    assert_close(length_m(place_m), 5000, 1e-6);
    assert_close(atan2(place_m[1], place_m[0]), 0.3, 1e-9);
    local_frame_close(radar);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_example_of_epsg_9837_is_reproduced),
        cmocka_unit_test(conversions_equal_textbook_formulas_both_ways),
        cmocka_unit_test(local_axes_point_east_north_and_up),
        cmocka_unit_test(places_across_the_date_line_are_near),
        cmocka_unit_test(at_height_finds_the_geodetic_place),
        cmocka_unit_test(frames_differ_by_the_meridian_convergence),
        cmocka_unit_test(conversion_between_frames_keeps_distances),
        cmocka_unit_test(range_azimuth_and_height_give_the_place),
        cmocka_unit_test(a_height_that_the_range_cannot_reach_is_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
