/* SPDX-License-Identifier: MIT */
/*
 * Paths of a scene's targets: angles compared with libm, legs with small integration steps, groups
 * within their stated extent.
 */
#include "scene_text.h"

static void portable_sine_and_cosine_equal_libm(void **state)
{
    (void)state;
    struct random random = random_start(1, 2, 3);

    for (int i = 0; i < 200000; i++) {
        double angle =
            random_between(&random, -1.0, 1.0) * pow(10.0, random_between(&random, -8.0, 4.0));
        double x = random_normal(&random) * pow(10.0, random_between(&random, -6.0, 6.0));
        double y = random_normal(&random) * pow(10.0, random_between(&random, -6.0, 6.0));

        assert_near(portable_sin(angle), sin(angle), 2e-15 + 1e-16 * fabs(angle));
        assert_near(portable_cos(angle), cos(angle), 2e-15 + 1e-16 * fabs(angle));
        assert_near(portable_atan2(y, x), atan2(y, x), 2e-15);
    }
    assert_near(portable_atan2(0.0, 0.0), 0.0, 0.0);
    assert_near(portable_atan2(0.0, -3.0), PORTABLE_PI, 1e-15);
    assert_near(portable_atan2(-2.0, 0.0), -PORTABLE_PI / 2.0, 1e-15);
    assert_near(portable_sin(0.0), 0.0, 0.0);
}

static struct scene_path *paths_of_targets(const char *targets, double duration_s, uint64_t seed,
                                           size_t *count)
{
    char text[4096];
    struct scene *scene;
    struct scene_path *paths;

    snprintf(text, sizeof text, SCENE("%g", RADAR(""), ", \"targets\": [%s]"), duration_s, targets);
    scene = scene_of_text(text);
    paths = targets_draw_paths(&scene->targets, "test.json", duration_s, seed, 0, 0, count);
    scene_free(scene);
    return paths;
}

static void free_paths(struct scene_path *paths, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        path_free(&paths[i]);
    }
    free(paths);
}

/* A path's places are the integral of its velocity, which has no jumps. */
static void assert_path_is_smooth(const struct scene_path *path, double until_s,
                                  double accel_max_mps2)
{
    const double step_s = 0.01;
    struct motion last = path_motion_at(path, path->from_s);

    for (int i = 1; path->from_s + i * step_s < until_s; i++) {
        struct motion at = path_motion_at(path, path->from_s + i * step_s);

        assert_near(at.x_m - last.x_m, 0.5 * (at.vx_mps + last.vx_mps) * step_s, 1e-2);
        assert_near(at.y_m - last.y_m, 0.5 * (at.vy_mps + last.vy_mps) * step_s, 1e-2);
        assert_near(hypot(at.vx_mps - last.vx_mps, at.vy_mps - last.vy_mps), 0.0,
                    accel_max_mps2 * step_s * 1.01 + 1e-6);
        last = at;
    }
}

static void a_target_flies_its_legs(void **state)
{
    (void)state;
    size_t count;
    struct scene_path *paths = paths_of_targets(
        "{\"at_m\": [1000, 2000], \"velocity_mps\": [100, 0], \"from_s\": 5, \"legs\": ["
        "{\"for_s\": 10}, {\"turn_deg\": 90, \"across_mps2\": 10}, {\"for_s\": 5},"
        "{\"to_speed_mps\": 50, \"along_mps2\": 5}, {\"for_s\": 4, \"turn_degps\": -3},"
        "{\"for_s\": 10, \"along_mps2\": 2, \"across_mps2\": 4},"
        "{\"to_speed_mps\": 0, \"along_mps2\": 10}, {\"for_s\": 20},"
        "{\"to_speed_mps\": 30, \"along_mps2\": 3}]}",
        200, 1, &count);
    double quarter_s = PORTABLE_PI / 2.0 * 100.0 / 10.0;
    struct motion at;

    assert_int_equal(count, 1);
    assert_path_is_smooth(paths, 150, 12);
    at = path_motion_at(paths, 15);
    assert_near(at.x_m, 2000, 1e-6);
    /* a quarter of a circle of 1000 m radius to the left */
    at = path_motion_at(paths, 15 + quarter_s);
    assert_near(at.x_m, 3000, 1e-6);
    assert_near(at.y_m, 3000, 1e-6);
    assert_near(at.vx_mps, 0, 1e-6);
    assert_near(at.vy_mps, 100, 1e-6);
    at = path_motion_at(paths, 15 + quarter_s + 5 + 10); /* slowed down to 50 m/s within 10 s */
    assert_near(at.vy_mps, 50, 1e-6);
    assert_near(at.y_m, 3000 + 500 + 750, 1e-6);
    at = path_motion_at(paths, 15 + quarter_s + 19);
    assert_near(atan2(at.vy_mps, at.vx_mps), (90 - 12) * PORTABLE_PI / 180, 1e-9);
    at = path_motion_at(paths, 15 + quarter_s + 29 + 7 + 10); /* it has stopped */
    assert_near(hypot(at.vx_mps, at.vy_mps), 0, 1e-6);
    at = path_motion_at(paths, 190);
    assert_near(hypot(at.vx_mps, at.vy_mps), 30, 1e-6);
    free_paths(paths, count);
}

static struct motion motion_at(const char *targets, uint64_t seed, double t_s)
{
    char text[2048];
    struct scene *scene;
    struct scene_path *paths;
    struct motion at;
    size_t count;

    snprintf(text, sizeof text,
             SCENE("100", "{\"interval_s\": 1, \"sigma_m\": 9}", ", \"targets\": [%s]"), targets);
    scene = scene_of_text(text);
    paths = targets_draw_paths(&scene->targets, "test.json", 100, seed, 0, 0, &count);
    at = path_motion_at(paths, t_s);
    free_paths(paths, count);
    scene_free(scene);
    return at;
}

/*
 * One acceleration in a fixed direction, whatever the heading, and upwards; the velocity reached is
 * kept.
 */
static void accelerations_have_a_given_direction(void **state)
{
    (void)state;
    const char *target = "{\"at_m\": [100, 200, 300], \"velocity_mps\": [-6, -8, 2], \"legs\": "
                         "[{\"for_s\": 10}, {\"for_s\": 4, \"accel_mps2\": [1, -2, 3]}, "
                         "{\"for_s\": 2}, {\"for_s\": 4, \"accel_mps2\": [-1, 2, -3]}]}";
    struct motion at = motion_at(target, 1, 12);

    assert_near(at.x_m, 100 - 72 + 2, 1e-6);
    assert_near(at.y_m, 200 - 96 - 4, 1e-6);
    assert_near(at.z_m, 300 + 24 + 6, 1e-6);
    at = motion_at(target, 1, 16);
    assert_near(at.vx_mps, -2, 1e-6);
    assert_near(at.vy_mps, -16, 1e-6);
    assert_near(at.vz_mps, 14, 1e-6);
    at = motion_at(target, 1, 30);
    assert_near(at.x_m, 100 - 180 + 8 + 8 + 8, 1e-6);
    assert_near(at.z_m, 300 + 60 + 24 + 24 + 24, 1e-6);
    assert_near(at.vz_mps, 2, 1e-6);
}

static void a_target_passes_its_waypoints(void **state)
{
    (void)state;
    const char *target = "{\"points\": [[5, 100, 200], [10, 150, 200], [20, 150, 100]]}";

    assert_near(motion_at(target, 1, 7.5).x_m, 125, 1e-9);
    assert_near(motion_at(target, 1, 7.5).vx_mps, 10, 1e-9);
    assert_near(motion_at(target, 1, 10).x_m, 150, 1e-9);
    assert_near(motion_at(target, 1, 20).y_m, 100, 1e-9);
    assert_near(motion_at(target, 1, 22).y_m, 80, 1e-9);
}

/*
 * A random acceleration in each of n intervals: the variance of the velocity grows as n, of the
 * place about as n^3 / 3.
 */
static void random_accelerations_make_a_target_wander(void **state)
{
    (void)state;
    const char *target = "{\"at_m\": [0, 0, 0], \"velocity_mps\": [10, 0], \"shake\": "
                         "{\"every_s\": 0.5, \"sigma_mps2\": 2}}";
    struct moments place = {0}, height = {0}, velocity = {0};
    const double n = 100;

    for (uint64_t seed = 0; seed < 1000; seed++) {
        struct motion at = motion_at(target, seed, 50), before = motion_at(target, seed, 49.999);

        assert_near(at.x_m - before.x_m, 0.001 * at.vx_mps, 1e-5);
        add_moment(&place, at.x_m - 500);
        add_moment(&height, at.z_m);
        add_moment(&velocity, at.vy_mps);
    }
    assert_near(mean_of_moments(&place), 0, 4 * 2 * 0.25 * sqrt(n * n * n / 3 / 1000));
    assert_near(sigma_of_moments(&place), 2 * 0.25 * sqrt(n * n * n / 3), 0.09 * 290);
    assert_near(sigma_of_moments(&height), 2 * 0.25 * sqrt(n * n * n / 3), 0.09 * 290);
    assert_near(sigma_of_moments(&velocity), 2 * 0.5 * sqrt(n), 0.9);
}

static void a_child_target_starts_where_its_parent_is(void **state)
{
    (void)state;
    size_t count;
    struct scene_path *paths = paths_of_targets(
        "{\"at_m\": [0, 9000], \"speed_mps\": 200, \"heading_rad\": 1,"
        " \"legs\": [{\"for_s\": 10}, {\"for_s\": 50, \"turn_degps\": 2}]},"
        "{\"parent\": 0, \"from_s\": 30, \"speed_change_mps\": 20, \"heading_change_rad\": 0.1}",
        100, 1, &count);
    struct motion parent = path_motion_at(&paths[0], 30), child = path_motion_at(&paths[1], 30);

    assert_int_equal(count, 2);
    assert_near(child.x_m, parent.x_m, 1e-9);
    assert_near(child.y_m, parent.y_m, 1e-9);
    assert_near(hypot(child.vx_mps, child.vy_mps), 220, 1e-9);
    assert_near(atan2(child.vy_mps, child.vx_mps) - atan2(parent.vy_mps, parent.vx_mps), 0.1, 1e-9);
    free_paths(paths, count);
}

static void groups_have_the_configured_spread(void **state)
{
    (void)state;
    size_t count;
    struct scene_path *paths =
        paths_of_targets("{\"count\": 2000, \"about_m\": [500, -300], \"range_m\": [10000, 40000],"
                         " \"azimuth_rad\": [0, 1], \"speed_mps\": [100, 300], \"from_s\": [5, 25],"
                         " \"life_s\": [30, 50]}",
                         100, 3, &count);
    struct moments speed = {0}, azimuth = {0}, square = {0}, from = {0}, life = {0}, heading = {0};

    assert_int_equal(count, 2000);
    for (size_t i = 0; i < count; i++) {
        struct motion at = path_motion_at(&paths[i], paths[i].from_s);
        double range_m = hypot(at.x_m - 500, at.y_m + 300);

        assert_true(range_m >= 9999.9 && range_m <= 40000.1);
        add_moment(&square, range_m * range_m);
        add_moment(&speed, hypot(at.vx_mps, at.vy_mps));
        add_moment(&azimuth, atan2(at.y_m + 300, at.x_m - 500));
        add_moment(&heading, atan2(at.vy_mps, at.vx_mps));
        add_moment(&from, paths[i].from_s);
        add_moment(&life, paths[i].until_s - paths[i].from_s);
    }
    /* uniform: mean in the middle, standard deviation width / sqrt(12) */
    assert_near(mean_of_moments(&speed), 200, 4 * 57.7 / sqrt(2000));
    assert_near(sigma_of_moments(&speed), 57.7, 2);
    assert_near(mean_of_moments(&azimuth), 0.5, 4 * 0.289 / sqrt(2000));
    /* uniform over the area */
    assert_near(mean_of_moments(&square), 8.5e8, 4 * 4.33e8 / sqrt(2000));
    assert_near(mean_of_moments(&heading), 0, 4 * 1.81 / sqrt(2000));
    assert_near(mean_of_moments(&from), 15, 4 * 5.77 / sqrt(2000));
    assert_near(mean_of_moments(&life), 40, 4 * 5.77 / sqrt(2000));
    free_paths(paths, count);
}

static void targets_stay_within_keep_range_m(void **state)
{
    (void)state;
    size_t count;
    struct scene_path *paths = paths_of_targets(
        "{\"count\": 30, \"range_m\": [5000, 20000], \"speed_mps\": [100, 200],"
        " \"keep_range_m\": [2000, 30000], \"turns\": {\"every_s\": [20, 60],"
        " \"across_mps2\": [5, 10], \"turn_deg\": [30, 180]},"
        " \"speed_changes\": {\"every_s\": [50, 100], \"along_mps2\": 2},"
        " \"stops\": {\"every_s\": [100, 200], \"for_s\": [5, 10], \"along_mps2\": 10}}",
        600, 4, &count);
    size_t turning = 0, standing = 0;

    for (size_t i = 0; i < count; i++) {
        assert_path_is_smooth(&paths[i], 600, 10);
        for (int t = 0; t < 600; t++) {
            struct motion at = path_motion_at(&paths[i], t),
                          next = path_motion_at(&paths[i], t + 0.1);
            double turn = at.vx_mps * next.vy_mps - at.vy_mps * next.vx_mps;

            assert_true(hypot(at.x_m, at.y_m) > 1800 && hypot(at.x_m, at.y_m) < 30200);
            assert_true(hypot(at.vx_mps, at.vy_mps) < 200.001);
            turning += fabs(turn) > 1.0;
            standing += hypot(at.vx_mps, at.vy_mps) < 1e-6;
        }
    }
    assert_true(turning > 600 * 30 / 10 && turning < 600 * 30 / 2);
    assert_true(standing > 300 && standing < 3000);
    free_paths(paths, count);
}

static void targets_stay_within_their_box(void **state)
{
    (void)state;
    size_t count;
    struct scene_path *paths =
        paths_of_targets("{\"count\": 500, \"box_m\": [0, 9000, 0, 9000], \"speed_mps\": [10, 80],"
                         " \"keep_box_m\": [0, 9000, 1000, 8000]}",
                         100, 4, &count);

    for (size_t i = 0; i < count; i++) {
        struct motion first = path_motion_at(&paths[i], 0), last = path_motion_at(&paths[i], 100);

        assert_true(fmin(first.x_m, last.x_m) >= 0 && fmax(first.x_m, last.x_m) <= 9000);
        assert_true(fmin(first.y_m, last.y_m) >= 1000 && fmax(first.y_m, last.y_m) <= 8000);
    }
    free_paths(paths, count);
}

static void replaced_targets_keep_the_number_constant(void **state)
{
    (void)state;
    size_t count, total = 0;
    struct scene_path *paths = paths_of_targets(
        "{\"count\": 40, \"range_m\": [5000, 20000], \"speed_mps\": 100, \"life_s\": [50, 150],"
        " \"is_replaced\": true}",
        2000, 5, &count);

    for (int t = 0; t < 2000; t += 10) {
        size_t there = 0;

        for (size_t i = 0; i < count; i++) {
            there += t >= paths[i].from_s && t < paths[i].until_s;
        }
        assert_int_equal(there, 40);
    }
    for (size_t i = 0; i < count; i++) {
        total += paths[i].from_s >= 0.0;
    }
    assert_near((double)total, 40 * 2000 / 100., 4 * sqrt(40 * 20.) + 40);
    free_paths(paths, count);
}

static void adding_targets_changes_no_path_of_others(void **state)
{
    (void)state;
    const char *group = "{\"count\": 5, \"range_m\": [5000, 20000], \"speed_mps\": [100, 200]}";
    char more[512];
    size_t count, more_count, again_count;
    struct scene_path *paths = paths_of_targets(group, 100, 7, &count), *again, *others;

    snprintf(more, sizeof more, "%s, %s, {\"at_m\": [0, 0], \"velocity_mps\": [1, 1]}", group,
             group);
    again = paths_of_targets(more, 100, 7, &more_count);
    others = paths_of_targets(group, 100, 8, &again_count);
    assert_int_equal(more_count, 11);
    for (size_t i = 0; i < count; i++) {
        struct motion at = path_motion_at(&paths[i], 50), same = path_motion_at(&again[i], 50);
        struct motion next = path_motion_at(&again[5 + i], 50),
                      other = path_motion_at(&others[i], 50);

        assert_memory_equal(&at, &same, sizeof at);
        assert_memory_not_equal(&at, &next, sizeof at);
        assert_memory_not_equal(&at, &other, sizeof at);
    }
    free_paths(paths, count);
    free_paths(again, more_count);
    free_paths(others, again_count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(portable_sine_and_cosine_equal_libm),
        cmocka_unit_test(a_target_flies_its_legs),
        cmocka_unit_test(accelerations_have_a_given_direction),
        cmocka_unit_test(a_target_passes_its_waypoints),
        cmocka_unit_test(random_accelerations_make_a_target_wander),
        cmocka_unit_test(targets_stay_within_their_box),
        cmocka_unit_test(a_child_target_starts_where_its_parent_is),
        cmocka_unit_test(groups_have_the_configured_spread),
        cmocka_unit_test(targets_stay_within_keep_range_m),
        cmocka_unit_test(replaced_targets_keep_the_number_constant),
        cmocka_unit_test(adding_targets_changes_no_path_of_others),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
