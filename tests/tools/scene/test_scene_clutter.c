/* SPDX-License-Identifier: MIT */
/*
 * Each source of a scene's clutter: number, place, time and rate of its plots; and that no source
 * changes the plots of targets.
 */
#include "scene_text.h"

#define CLUTTER(list) ", \"clutter\": [" list "]"
#define TURNS 1000

struct seen {
    struct scene *scene;
    struct scene_run *run;
    struct moments scan, range, azimuth, x, y, rate;
};

/* All clutter of a scene in order of time, and its moments. */
static struct seen collect_clutter(const char *text)
{
    struct seen seen = {.scene = scene_of_text(text)};

    seen.run = scene_observe(seen.scene, 5, 0);
    for (size_t i = 0; i < seen.run->num_scans; i++) {
        const struct scene_scan *scan = &seen.run->scans[i];
        double count = 0;

        for (size_t k = 0; k < scan->num_plots; k++) {
            const struct scene_plot *plot = &scan->plots[k];

            if (plot->target_id < 0) {
                double looked_rad = PORTABLE_PI / 2 - plot->t_s / 4 * PORTABLE_TURN;

                count += 1;
                add_moment(&seen.range, plot->range_m);
                add_moment(&seen.azimuth, plot->azimuth_rad);
                add_moment(&seen.x, plot->range_m * cos(plot->azimuth_rad));
                add_moment(&seen.y, plot->range_m * sin(plot->azimuth_rad));
                add_moment(&seen.rate, plot->range_rate_mps);
                assert_true(plot->t_s <= scan->end_s && plot->t_s >= scan->end_s - 4.0000001);
                /* the plot's time is when the antenna pointed at it, but for azimuth noise */
                assert_near(remainder(looked_rad - plot->azimuth_rad, PORTABLE_TURN), 0, 0.02);
            }
        }
        add_moment(&seen.scan, count);
    }
    return seen;
}

static void free_clutter(struct seen *seen)
{
    scene_run_free(seen->run);
    scene_free(seen->scene);
}

static void uniform_clutter_fills_the_area_evenly(void **state)
{
    (void)state;
    struct seen seen = collect_clutter(
        SCENE("4000", RADAR(", \"sigma_range_rate_mps\": 1"),
              CLUTTER("{\"kind\": \"uniform\", \"plots\": 50, \"range_rate_max_mps\": 90}")));

    assert_near(mean_of_moments(&seen.scan), 50, 4 * sqrt(50. / TURNS));
    assert_near(sigma_of_moments(&seen.scan), sqrt(50), 4 * sqrt(50) / sqrt(2. * TURNS));
    assert_near(mean_of_moments(&seen.range), 40500, 4 * 22800 / sqrt(seen.range.count));
    assert_near(sigma_of_moments(&seen.range), 79000 / sqrt(12), 150);
    assert_near(mean_of_moments(&seen.azimuth), 0, 4 * 1.81 / sqrt(seen.range.count));
    assert_near(sigma_of_moments(&seen.azimuth), PORTABLE_TURN / sqrt(12), 0.02);
    assert_near(sigma_of_moments(&seen.rate), 180 / sqrt(12), 0.6);
    free_clutter(&seen);
    seen = collect_clutter(
        SCENE("4000", RADAR(""),
              CLUTTER("{\"kind\": \"uniform\", \"plots\": 20, \"range_m\": [5000, 9000],"
                      "\"sector_rad\": [3, -3], \"from_s\": 1000, \"until_s\": 3000}")));
    assert_near(mean_of_moments(&seen.scan), 10, 4 * sqrt(20. / 500) / 2);
    assert_near(mean_of_moments(&seen.range), 7000, 4 * 1155 / sqrt(seen.range.count));
    assert_near(mean_of_moments(&seen.x), -7000 * sin(0.1416) / 0.1416, 60);
    free_clutter(&seen);
}

static void a_weather_cell_drifts_with_the_wind(void **state)
{
    (void)state;
    struct seen seen = collect_clutter(
        SCENE("4000", RADAR(", \"sigma_range_rate_mps\": 1"),
              CLUTTER("{\"kind\": \"cell\", \"plots\": 30, \"at_m\": [-30000, 20000],"
                      "\"velocity_mps\": [10, 0], \"radius_m\": 2000}")));
    size_t last = seen.run->num_scans - 1;
    struct moments x = {0};

    assert_near(mean_of_moments(&seen.scan), 30, 4 * sqrt(30. / TURNS));
    /* half of the way */
    assert_near(mean_of_moments(&seen.x), -10000, 4 * 11700 / sqrt(seen.x.count));
    assert_near(mean_of_moments(&seen.y), 20000, 4 * 2000 / sqrt(seen.y.count));
    assert_near(sigma_of_moments(&seen.y), 2000, 4 * 2000 / sqrt(2 * seen.y.count));
    for (size_t i = last - 50; i < last; i++) {
        for (size_t k = 0; k < seen.run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &seen.run->scans[i].plots[k];

            add_moment(&x, plot->range_m * cos(plot->azimuth_rad) - 10 * plot->t_s);
        }
    }
    assert_near(mean_of_moments(&x), -30000, 4 * 2000 / sqrt(x.count));
    free_clutter(&seen);
    seen = collect_clutter(SCENE(
        "4000", RADAR(""),
        CLUTTER(
            "{\"kind\": \"cell\", \"shape\": \"disc\", \"plots\": 30, \"at_m\": [-30000, 20000],"
            "\"radius_m\": 2000}")));
    assert_near(sigma_of_moments(&seen.y), 1000, 4 * 1000 / sqrt(2 * seen.y.count));
    for (size_t i = 0; i < seen.run->num_scans; i++) {
        for (size_t k = 0; k < seen.run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &seen.run->scans[i].plots[k];

            assert_true(hypot(plot->range_m * cos(plot->azimuth_rad) + 30000,
                              plot->range_m * sin(plot->azimuth_rad) - 20000) < 2000.1);
        }
    }
    free_clutter(&seen);
}

static void clutter_of_towers_stands_still(void **state)
{
    (void)state;
    struct seen seen = collect_clutter(
        SCENE("4000", RADAR(", \"sigma_range_rate_mps\": 1"),
              CLUTTER("{\"kind\": \"standing\", \"places_m\": [[20000, 0], [0, -50000]],"
                      "\"pd\": 0.5}")));
    struct moments far = {0}, azimuth = {0};

    assert_share(seen.range.count, 2 * TURNS, 0.5);
    assert_near(mean_of_moments(&seen.rate), 0, 4 / sqrt(seen.rate.count));
    assert_near(sigma_of_moments(&seen.rate), 1, 0.1);
    for (size_t i = 0; i < seen.run->num_scans; i++) {
        for (size_t k = 0; k < seen.run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &seen.run->scans[i].plots[k];

            if (plot->range_m > 30000) {
                add_moment(&far, plot->range_m);
                add_moment(&azimuth, plot->azimuth_rad);
            }
        }
    }
    assert_near(mean_of_moments(&far), 50000, 4 * 30 / sqrt(far.count));
    assert_near(sigma_of_moments(&far), 30, 4 * 30 / sqrt(2 * far.count));
    assert_near(sigma_of_moments(&azimuth), 0.003, 4 * 0.003 / sqrt(2 * far.count));
    free_clutter(&seen);
    seen = collect_clutter(SCENE(
        "400", RADAR(""),
        CLUTTER(
            "{\"kind\": \"standing\", \"count\": 2000, \"pd\": 1, \"range_m\": [20000, 60000]}")));
    assert_true(seen.range.count == 2000 * 100);
    /* uniform over the area: mean of the square */
    assert_near(seen.range.squares / seen.range.count, 2e9, 4 * 0.92e9 / sqrt(2000));
    free_clutter(&seen);
}

static void sea_spikes_last_some_scans(void **state)
{
    (void)state;
    struct seen seen = collect_clutter(SCENE(
        "40000", RADAR(""),
        CLUTTER("{\"kind\": \"spikes\", \"born_per_s\": 0.05, \"life_s\": [8, 32], \"pd\": 0.7,"
                "\"range_m\": [3000, 9000], \"speed_mps\": 2}")));

    /* each lives for 20 s, five turns; some are alive at the start */
    assert_near(seen.range.count, 40000 * 0.05 * 5 * 0.7, 4 * 0.7 * sqrt(40000 * 0.05 * (25 + 3)));
    assert_near(mean_of_moments(&seen.x), 0, 400);
    assert_true(seen.range.count > 0 && sigma_of_moments(&seen.x) > 3000 &&
                sigma_of_moments(&seen.x) < 6000);
    free_clutter(&seen);
}

static void a_jamming_strobe_fills_a_wedge(void **state)
{
    (void)state;
    struct seen seen =
        collect_clutter(SCENE("400", RADAR(""),
                              CLUTTER("{\"kind\": \"strobe\", \"plots\": 60, \"azimuth_rad\": 0.5,"
                                      "\"width_rad\": 0.04, \"azimuth_radps\": 0.001}")));
    struct moments off = {0};

    assert_near(mean_of_moments(&seen.scan), 60, 4 * sqrt(60. / 100));
    for (size_t i = 0; i < seen.run->num_scans; i++) {
        for (size_t k = 0; k < seen.run->scans[i].num_plots; k++) {
            add_moment(&off, seen.run->scans[i].plots[k].azimuth_rad - 0.5 -
                                 0.001 * (seen.run->scans[i].end_s - 4));
        }
    }
    assert_near(mean_of_moments(&off), 0, 4 * 0.0116 / sqrt(off.count));
    assert_near(sigma_of_moments(&off), 0.04 / sqrt(12), 0.0004);
    assert_near(mean_of_moments(&seen.range), 40500, 4 * 22800 / sqrt(seen.range.count));
    free_clutter(&seen);
}

static void birds_fly_together_as_a_flock(void **state)
{
    (void)state;
    struct seen seen = collect_clutter(SCENE(
        "2000", RADAR(""),
        CLUTTER("{\"kind\": \"flock\", \"count\": 100, \"at_m\": [30000, 0], \"radius_m\": 3000,"
                "\"velocity_mps\": [-10, 5], \"speed_mps\": 4, \"pd\": 0.5}")));

    assert_share(seen.range.count, 100 * 500, 0.5);
    assert_near(mean_of_moments(&seen.x), 20000, 4 * 3000 / sqrt(100));
    assert_near(mean_of_moments(&seen.y), 5000, 4 * 3000 / sqrt(100));
    for (size_t i = 0; i < 100; i++) { /* speed: that of the flock and 1.5 times 4 m/s at most */
        size_t count, num_paths;
        struct scene_path *paths;
        struct scene_mover *birds =
            draw_persistent_clutter(seen.scene, 0, 5, 0, &count, &paths, &num_paths);
        struct motion at;

        assert_true(folded_motion_at(&birds[i], &seen.scene->sensors[0], 77, &at));
        assert_true(hypot(at.vx_mps + 10, at.vy_mps - 5) < 6.001);
        free(birds);
    }
    free_clutter(&seen);
}

static void second_time_echoes_are_folded_in_range(void **state)
{
    (void)state;
    struct seen seen = collect_clutter(
        SCENE("400", RADAR(", \"sigma_range_rate_mps\": 1"),
              CLUTTER("{\"kind\": \"second-time-around\", \"unambiguous_range_m\": 80000, "
                      "\"pd\": 1, \"targets\":"
                      "[{\"at_m\": [100000, 0], \"velocity_mps\": [50, 0]},"
                      "{\"at_m\": [0, 70000], \"speed_mps\": 0, \"heading_rad\": 0}]}")));
    struct moments off = {0};

    assert_int_equal(seen.run->num_paths, 0); /* birds are no targets */
    assert_true(seen.range.count == 100);
    for (size_t i = 0; i < seen.run->num_scans; i++) {
        const struct scene_plot *plot = &seen.run->scans[i].plots[0];

        add_moment(&off, plot->range_m - (20000 + 50 * plot->t_s));
        assert_near(plot->azimuth_rad, 0, 0.015);
        assert_near(plot->range_rate_mps, 50, 5);
    }
    assert_near(mean_of_moments(&off), 0, 4 * 30 / sqrt(off.count));
    free_clutter(&seen);
}

/*
 * Clutter about a climbing target: its number is constant and it fills the ball, spread also by the
 * target's motion and noise.
 */
static void clutter_about_a_target_moves_with_it(void **state)
{
    (void)state;
    struct scene *scene = scene_of_text(SCENE(
        "1000", "{\"interval_s\": 2, \"sigma_m\": 7, \"sigma_mps\": 3, \"pd\": 1}",
        ", \"targets\": [{\"at_m\": [30000, 40000, 100], \"velocity_mps\": [100, 20, 5]}]" CLUTTER(
            "{\"kind\": \"about-targets\", \"count\": 4, \"width_rad\": 0.02, "
            "\"from_s\": 10}")));
    struct scene_run *run = scene_observe(scene, 5, 0);
    struct moments share = {0}, x = {0}, z = {0}, noise = {0}, velocity = {0};

    assert_int_equal(run->num_scans, 500);
    for (size_t i = 0; i < run->num_scans; i++) {
        const struct scene_scan *scan = &run->scans[i];
        struct motion at = path_motion_at(run->paths, scan->end_s);
        double radius_m = sqrt(at.x_m * at.x_m + at.y_m * at.y_m + at.z_m * at.z_m) * sin(0.01);

        assert_int_equal(scan->num_plots, scan->end_s < 10 ? 1 : 5);
        for (size_t k = 0; k < scan->num_plots; k++) {
            const struct scene_plot *plot = &scan->plots[k];
            double dx_m = plot->x_m - at.x_m, dy_m = plot->y_m - at.y_m, dz_m = plot->z_m - at.z_m;

            if (plot->target_id < 0) {
                double r_m = sqrt(dx_m * dx_m + dy_m * dy_m + dz_m * dz_m);

                add_moment(&share, pow(r_m / radius_m, 3));
                add_moment(&x, dx_m / radius_m);
                add_moment(&z, dz_m / radius_m);
                assert_near(plot->vx_mps, 100 + dx_m / 2, 1e-6);
                assert_near(plot->vz_mps, 5 + dz_m / 2, 1e-6);
            } else {
                add_moment(&noise, dx_m);
                add_moment(&noise, dz_m);
                add_moment(&velocity, plot->vx_mps - 100);
                add_moment(&velocity, plot->vz_mps - 5);
            }
        }
    }
    assert_near(mean_of_moments(&share), 0.5, 4 * 0.289 / sqrt(share.count));
    assert_near(mean_of_moments(&x), 0, 4 * 0.447 / sqrt(share.count));
    assert_near(sigma_of_moments(&x), sqrt(0.2), 0.03);
    assert_near(sigma_of_moments(&z), sqrt(0.2), 0.03);
    assert_near(sigma_of_moments(&noise), 7, 4 * 7 / sqrt(2 * noise.count));
    assert_near(sigma_of_moments(&velocity), 3, 4 * 3 / sqrt(2 * noise.count));
    scene_run_free(run);
    scene_free(scene);
}

static void adding_clutter_changes_no_plot_of_a_target(void **state)
{
    (void)state;
    const char *targets =
        "\"targets\": [{\"count\": 20, \"range_m\": [5000, 60000], \"speed_mps\": [100, 300]}]";
    char plain[1024], full[2048];
    struct seen one, other;
    size_t found = 0, same = 0;

    snprintf(plain, sizeof plain, SCENE("400", RADAR(""), ", %s"), targets);
    snprintf(
        full, sizeof full,
        SCENE("400", RADAR(""),
              ", %s" CLUTTER(
                  "{\"kind\": \"uniform\", \"plots\": 50}, {\"kind\": \"standing\", \"count\": 9},"
                  "{\"kind\": \"spikes\", \"born_per_s\": 1, \"life_s\": 9}")),
        targets);
    one = collect_clutter(plain);
    other = collect_clutter(full);
    assert_int_equal(one.run->num_scans, other.run->num_scans);
    for (size_t i = 0; i < one.run->num_scans; i++) {
        const struct scene_scan *few = &one.run->scans[i], *many = &other.run->scans[i];
        size_t next = 0;

        for (size_t k = 0; k < many->num_plots; k++) {
            if (many->plots[k].target_id >= 0) {
                assert_true(next < few->num_plots);
                /* all members, without the bytes that pad the last one */
                assert_memory_equal(&many->plots[k], &few->plots[next],
                                    offsetof(struct scene_plot, target_id) + sizeof(int));
                next++;
                found++;
            }
        }
        assert_int_equal(next, few->num_plots);
        same += few->num_plots;
    }
    assert_int_equal(found, same);
    assert_true(found > 1000);
    free_clutter(&one);
    free_clutter(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_clutter_fills_the_area_evenly),
        cmocka_unit_test(a_weather_cell_drifts_with_the_wind),
        cmocka_unit_test(clutter_of_towers_stands_still),
        cmocka_unit_test(sea_spikes_last_some_scans),
        cmocka_unit_test(a_jamming_strobe_fills_a_wedge),
        cmocka_unit_test(birds_fly_together_as_a_flock),
        cmocka_unit_test(second_time_echoes_are_folded_in_range),
        cmocka_unit_test(clutter_about_a_target_moves_with_it),
        cmocka_unit_test(adding_clutter_changes_no_plot_of_a_target),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
