/* SPDX-License-Identifier: MIT */
/*
 * Measurements in a radar's own level frame: places of known targets, and the noise of an elevation
 * computed from range and height.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "base/random.h"
#include "io/csv/radar_axes.h"

#define PI 3.14159265358979323846

/* In double precision; cmocka compares as float32. */
static void assert_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance)) {
        fail_msg("%.12g is not %.12g to %g", a, b, tolerance);
    }
}

static const double radar[3] = {50.5, 11.5, 400}, target[3] = {49.9, 10.4, 9000};

/* A radar 120 km east and 55 km north of the origin of the common frame. */
struct scene {
    struct local_frame *common, *own;
    struct radar_axes *frame;
    double seen_m[3], place_m[3]; /* the target in the radar's frame and in the common frame */
    struct radar_look look;       /* the radar's measurement of the target */
};

static double length_m(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static struct scene open_radar_scene(bool has_own_north)
{
    struct scene scene = {.common = local_frame_open(50, 10, 100),
                          .own = local_frame_open(radar[0], radar[1], radar[2])};

    scene.frame = radar_axes_open(scene.common, radar, has_own_north);
    local_frame_to_local(scene.own, target, scene.seen_m);
    local_frame_to_local(scene.common, target, scene.place_m);
    scene.look.range_m = length_m(scene.seen_m);
    scene.look.azimuth_rad = atan2(scene.seen_m[1], scene.seen_m[0]);
    scene.look.elevation_rad = asin(scene.seen_m[2] / scene.look.range_m);
    return scene;
}

static void close_radar_scene(struct scene *scene)
{
    radar_axes_close(scene->frame);
    local_frame_close(scene->common);
    local_frame_close(scene->own);
}

/* Place in the common frame to which a look from the radar points. */
static void place_of_look(const struct scene *scene, const struct radar_look *look,
                          double place_m[3])
{
    const double *from_m = radar_axes_place_m(scene->frame);
    double ground_m = look->range_m * cos(look->elevation_rad);

    place_m[0] = from_m[0] + ground_m * cos(look->azimuth_rad);
    place_m[1] = from_m[1] + ground_m * sin(look->azimuth_rad);
    place_m[2] = from_m[2] + look->range_m * sin(look->elevation_rad);
}

static void assert_look_is_at_target(const struct scene *scene, const struct radar_look *look)
{
    double place_m[3];

    place_of_look(scene, look, place_m);
    for (int i = 0; i < 3; i++) {
        assert_near(place_m[i], scene->place_m[i], 0.01);
    }
}

static void with_elevation_both_angles_are_converted_to_the_common_frame(void **state)
{
    struct scene scene = open_radar_scene(true);
    struct radar_look look = scene.look;

    (void)state;
    radar_axes_look_to_common(scene.frame, true, &look);
    assert_look_is_at_target(&scene, &look);
    /* the two level planes are tilted against each other */
    assert_true(fabs(look.elevation_rad - scene.look.elevation_rad) > 0.005);
    close_radar_scene(&scene);
}

/*
 * Without elevation the azimuth is turned by the convergence alone, some hundredths of a degree off
 * the full rotation.
 */
static void without_elevation_the_azimuth_is_turned_by_the_convergence(void **state)
{
    struct scene scene = open_radar_scene(true);
    struct radar_look flat = scene.look, whole = scene.look;

    (void)state;
    radar_axes_look_to_common(scene.frame, false, &flat);
    radar_axes_look_to_common(scene.frame, true, &whole);
    assert_near(flat.azimuth_rad - scene.look.azimuth_rad, radar_axes_turn_rad(scene.frame), 1e-12);
    assert_near(flat.azimuth_rad, whole.azimuth_rad, 2e-3);
    assert_true(fabs(radar_axes_turn_rad(scene.frame)) > 0.019);
    assert_near(flat.elevation_rad, scene.look.elevation_rad, 0);
    close_radar_scene(&scene);
}

static void range_and_height_give_the_place_of_the_target(void **state)
{
    const struct radar_height height = {target[2], 30, 50};
    struct scene scene = open_radar_scene(true);
    struct radar_look look = scene.look;
    double sigma_rad = 0;

    (void)state;
    look.elevation_rad = 0;
    assert_true(radar_axes_height_elevation(scene.frame, 0, &height, &look, &sigma_rad));
    assert_look_is_at_target(&scene, &look);
    close_radar_scene(&scene);
}

/*
 * A radar whose place is given in metres counts azimuths in the common frame; the height stays
 * exact.
 */
static void azimuths_already_in_the_common_frame_are_kept(void **state)
{
    const struct radar_height height = {target[2], 30, 50};
    struct scene scene = open_radar_scene(false);
    struct radar_look look = scene.look;
    double sigma_rad = 0;

    (void)state;
    radar_axes_look_to_common(scene.frame, true, &look);
    assert_near(look.azimuth_rad, scene.look.azimuth_rad, 0);
    assert_near(radar_axes_turn_rad(scene.frame), 0, 0);
    look.azimuth_rad += local_frame_convergence_rad(scene.own, scene.common);
    assert_true(radar_axes_height_elevation(scene.frame, 0, &height, &look, &sigma_rad));
    assert_look_is_at_target(&scene, &look);
    close_radar_scene(&scene);
}

/*
 * Simulates ranges and heights and computes places: their spread upwards and along is what the
 * sigmas say.
 */
static void check_spread_against_sigma(const double on_earth[3])
{
    enum { RUNS = 4000 };
    const struct radar_height height = {on_earth[2], 40, 25};
    struct local_frame *own = local_frame_open(radar[0], radar[1], radar[2]);
    struct radar_axes *frame = radar_axes_open(own, radar, true);
    struct random random = random_start(3, 0, 0);
    double true_m[3], up_m2 = 0, along_m2 = 0, sigma_rad = 0;

    local_frame_to_local(own, on_earth, true_m);
    const double range_m = length_m(true_m), azimuth = atan2(true_m[1], true_m[0]);
    const double elevation = asin(true_m[2] / range_m);
    for (int i = 0; i < RUNS; i++) {
        struct radar_look look = {range_m + 25 * random_normal(&random), azimuth, 0};
        struct radar_height drawn = height;
        double ignored;

        drawn.alt_m += 40 * random_normal(&random);
        assert_true(radar_axes_height_elevation(frame, 0, &drawn, &look, &ignored));
        double up_m = look.range_m * sin(look.elevation_rad - elevation);
        double along_m = look.range_m * cos(look.elevation_rad - elevation) - range_m;
        up_m2 += up_m * up_m / RUNS;
        along_m2 += along_m * along_m / RUNS;
    }
    struct radar_look look = {range_m, azimuth, 0};
    assert_true(radar_axes_height_elevation(frame, 0, &height, &look, &sigma_rad));
    print_message("range %.0f m, elevation %.1f deg: sigma up %.1f m, spread %.1f m\n", range_m,
                  elevation * 180 / PI, sigma_rad * range_m, sqrt(up_m2));
    assert_near(sqrt(up_m2) / (sigma_rad * range_m), 1, 0.05); /* within 4 standard errors */
    assert_near(sqrt(along_m2) / 25, 1, 0.05);
    radar_axes_close(frame);
    local_frame_close(own);
}

static void the_elevation_sigma_equals_the_simulated_spread(void **state)
{
    (void)state;
    check_spread_against_sigma(
        (const double[3]){50.5, 13.5, 11000}); /* low over the horizon, far away */
    check_spread_against_sigma(
        (const double[3]){50.6, 11.55, 11000}); /* near, at 45 degrees of elevation */
    check_spread_against_sigma(
        (const double[3]){50.55, 11.53, 11000}); /* at 60 degrees of elevation */
}

static void on_a_flat_earth_elevation_follows_from_the_triangle(void **state)
{
    const struct radar_height height = {3050, 30, 50};
    struct radar_look look = {5000, 0.7, 0};
    double sigma_rad = 0;

    (void)state;
    assert_true(radar_axes_height_elevation(NULL, 50, &height, &look, &sigma_rad));
    assert_near(look.range_m * sin(look.elevation_rad), 3000, 1e-9);
    assert_near(look.range_m * cos(look.elevation_rad), 4000, 1e-9);
    assert_near(look.azimuth_rad, 0.7, 0);
    /* error upwards (dh - sin e dr) / cos e, with sin e = 3/5 and cos e = 4/5 */
    assert_near(sigma_rad * 5000, hypot(30, 0.6 * 50) / 0.8, 1e-9);
}

static void heights_beyond_the_range_are_refused(void **state)
{
    struct local_frame *common = local_frame_open(50, 10, 100);
    struct radar_axes *frame = radar_axes_open(common, radar, true);
    struct radar_height height = {7401, 30, 50};
    struct radar_look look = {7000, 0.7, 0.1};
    double sigma_rad = 0.5;

    (void)state;
    assert_false(radar_axes_height_elevation(frame, 0, &height, &look, &sigma_rad));
    assert_false(radar_axes_height_elevation(NULL, 400, &height, &look, &sigma_rad));
    height.alt_m = -6601;
    assert_false(radar_axes_height_elevation(frame, 0, &height, &look, &sigma_rad));
    assert_false(radar_axes_height_elevation(NULL, 400, &height, &look, &sigma_rad));
    assert_near(look.azimuth_rad, 0.7, 0);
    assert_near(look.elevation_rad, 0.1, 0);
    height.alt_m = 7400; /* straight up: the place on the ground cannot be computed */
    assert_true(radar_axes_height_elevation(NULL, 400, &height, &look, &sigma_rad));
    assert_near(sigma_rad, 0.5, 0);
    radar_axes_close(frame);
    local_frame_close(common);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(with_elevation_both_angles_are_converted_to_the_common_frame),
        cmocka_unit_test(without_elevation_the_azimuth_is_turned_by_the_convergence),
        cmocka_unit_test(range_and_height_give_the_place_of_the_target),
        cmocka_unit_test(azimuths_already_in_the_common_frame_are_kept),
        cmocka_unit_test(the_elevation_sigma_equals_the_simulated_spread),
        cmocka_unit_test(on_a_flat_earth_elevation_follows_from_the_triangle),
        cmocka_unit_test(heights_beyond_the_range_are_refused),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
