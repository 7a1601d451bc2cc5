/* SPDX-License-Identifier: MIT */
/*
 * What a scene's sensors see of its targets: antenna timing, noise, biases, detections, coverage,
 * resolution, and events. Seeds are fixed; bounds are four standard deviations.
 */
#include "scene_text.h"

#define FLYERS                                                                                     \
    "\"targets\": [{\"count\": 40, \"range_m\": [5000, 60000], \"speed_mps\": [100, 300], "        \
    "\"keep_range_m\": [2000, 79000], \"turns\": {\"every_s\": [50, 100], \"across_mps2\": 5}}]"
#define STANDING_ONE                                                                               \
    "\"targets\": [{\"at_m\": [30000, 40000], \"speed_mps\": 0, \"heading_rad\": 0}]"

static struct scene_run *observe_scene_text(const char *text, struct scene **scene, uint64_t seed)
{
    *scene = scene_of_text(text);
    return scene_observe(*scene, seed, 0);
}

static void free_observation(struct scene_run *run, struct scene *scene)
{
    scene_run_free(run);
    scene_free(scene);
}

static size_t count_all_plots(const struct scene_run *run)
{
    size_t count = 0;

    for (size_t i = 0; i < run->num_scans; i++) {
        count += run->scans[i].num_plots;
    }
    return count;
}

/* Counts the plots of targets by their number, `each` of which count as one. */
static void count_plots_by_target(const struct scene_run *run, int each, size_t *seen)
{
    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            seen[run->scans[i].plots[k].target_id / each]++;
        }
    }
}

/*
 * Checks errors of all plots against the truth at their own times, in sigmas, and the antenna's
 * azimuth.
 */
static void check_plot_errors(const char *text, const double bias[2], bool turns)
{
    struct scene *scene;
    struct scene_run *run = observe_scene_text(text, &scene, 1);
    struct moments range = {0}, azimuth = {0}, rate = {0};
    const struct scene_sensor *sensor = &scene->sensors[0];

    for (size_t i = 0; i < run->num_scans; i++) {
        const struct scene_scan *scan = &run->scans[i];

        for (size_t k = 0; k < scan->num_plots; k++) {
            const struct scene_plot *plot = &scan->plots[k];
            struct motion at = path_motion_at(&run->paths[plot->target_id], plot->t_s);
            double x_m = at.x_m - sensor->x_m, y_m = at.y_m - sensor->y_m,
                   range_m = hypot(x_m, y_m);
            double azimuth_rad = atan2(y_m, x_m);
            double looked_rad =
                sensor->start_rad - (plot->t_s - sensor->start_s) / sensor->turn_s * PORTABLE_TURN;

            add_moment(&range, (plot->range_m - range_m - bias[0]) / 30);
            add_moment(&azimuth,
                       remainder(plot->azimuth_rad - azimuth_rad - bias[1], PORTABLE_TURN) / 0.003);
            add_moment(&rate, plot->range_rate_mps - (x_m * at.vx_mps + y_m * at.vy_mps) / range_m);
            assert_true(plot->t_s <= scan->end_s + 1e-9);
            assert_true(plot->t_s >= scan->end_s -
                                         (turns ? sensor->turn_s / (double)sensor->sectors : 0) -
                                         1e-9);
            if (turns) { /* the antenna's azimuth is the target's, with its bias */
                assert_near(remainder(looked_rad - azimuth_rad - bias[1], PORTABLE_TURN), 0, 1e-9);
            }
        }
    }
    assert_true(range.count > 3000);
    assert_share(range.count, 40 * 100, 0.9);
    assert_near(mean_of_moments(&range), 0, 4 / sqrt(range.count));
    assert_near(mean_of_moments(&azimuth), 0, 4 / sqrt(range.count));
    assert_near(sigma_of_moments(&range), 1, 4 / sqrt(2 * range.count));
    assert_near(sigma_of_moments(&azimuth), 1, 4 / sqrt(2 * range.count));
    if (sensor->has_range_rate) {
        assert_near(mean_of_moments(&rate), 0, 8 / sqrt(range.count));
        assert_near(sigma_of_moments(&rate), 2, 8 / sqrt(2 * range.count));
    }
    free_observation(run, scene);
}

static void turning_radars_measure_with_their_noise_and_biases(void **state)
{
    (void)state;
    const double none[2] = {0, 0}, some[2] = {70, -0.01};

    check_plot_errors(SCENE("400", RADAR(""), "," FLYERS), none, true);
    check_plot_errors(
        SCENE("402", RADAR(", \"sectors\": 32, \"start_s\": 1.7, \"sigma_range_rate_mps\": 2"),
              "," FLYERS),
        none, true);
    check_plot_errors(
        SCENE("400", RADAR(", \"range_bias_m\": 70, \"azimuth_bias_rad\": -0.01"), "," FLYERS),
        some, true);
}

static void radars_that_do_not_turn_see_all_targets_at_once(void **state)
{
    (void)state;
    const double none[2] = {0, 0};

    check_plot_errors(
        SCENE("200",
              "{\"interval_s\": 2, \"range_m\": [1000, 80000], \"sigma_range_m\": 30, "
              "\"sigma_azimuth_rad\": 0.003}",
              "," FLYERS),
        none, false);
}

/*
 * A radar that measures x and y has no place of its own, so it sees targets that pass the origin.
 */
static void radars_of_x_and_y_see_targets_at_the_origin(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("7", "{\"interval_s\": 1, \"sigma_m\": 1, \"pd\": 1}",
              ", \"targets\": [{\"at_m\": [-300, 0], \"velocity_mps\": [100, 0]}]"),
        &scene, 1);

    assert_int_equal(count_all_plots(run), 7);
    free_observation(run, scene);
}

static void ambiguous_range_rates_are_folded_into_their_interval(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("400", RADAR(", \"sigma_range_rate_mps\": 0.001, \"range_rate_span_mps\": 40"),
              "," FLYERS),
        &scene, 1);

    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];
            struct motion at = path_motion_at(&run->paths[plot->target_id], plot->t_s);
            double rate = (at.x_m * at.vx_mps + at.y_m * at.vy_mps) / hypot(at.x_m, at.y_m);

            assert_true(fabs(plot->range_rate_mps) <= 20);
            assert_near(remainder(plot->range_rate_mps - rate, 40), 0, 0.01);
        }
    }
    free_observation(run, scene);
}

static void no_plots_come_from_beyond_the_coverage(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run =
        observe_scene_text(SCENE("4000", RADAR(", \"sector_rad\": [3, -2], \"pd\": 1"),
                                 ",\"targets\": [{\"count\": 100, \"range_m\": [0, "
                                 "100000], \"speed_mps\": [100, 300]}]"),
                           &scene, 1);
    size_t covered = 0;

    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->num_paths; k++) {
            struct motion at = path_motion_at(&run->paths[k], run->scans[i].end_s);

            covered += scene_covers_place(scene, at.x_m, at.y_m);
        }
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];
            struct motion at = path_motion_at(&run->paths[plot->target_id], plot->t_s);
            double range_m = hypot(at.x_m, at.y_m), azimuth_rad = atan2(at.y_m, at.x_m);

            assert_true(range_m >= 1000 && range_m <= 80000);
            assert_true(azimuth_rad >= 3 || azimuth_rad <= -2);
        }
        assert_near(run->scans[i].from_rad, 3, 1e-12);
        assert_near(run->scans[i].to_rad, -2, 1e-12);
    }
    assert_true(covered > 1000);
    /* +- one turn at each end of a target's life */
    assert_near((double)count_all_plots(run), (double)covered, 200);
    free_observation(run, scene);
}

static void pd_falls_with_range(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("8000", RADAR(", \"pd\": [[20000, 0.9], [60000, 0.5]]"),
              ",\"targets\": [{\"at_m\": [10000, 0], \"speed_mps\": 0, \"heading_rad\": 0},"
              "{\"at_m\": [0, 40000], \"speed_mps\": 0, \"heading_rad\": 0},"
              "{\"at_m\": [-70000, 0], \"speed_mps\": 0, \"heading_rad\": 0}]"),
        &scene, 1);
    size_t seen[3] = {0};

    assert_int_equal(run->num_scans, 2000);
    count_plots_by_target(run, 1, seen);
    assert_share(seen[0], 2000, 0.9);
    assert_share(seen[1], 2000, 0.7);
    assert_share(seen[2], 2000, 0.5);
    free_observation(run, scene);
}

static void outages_and_masks_suppress_plots(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("4000", RADAR(", \"pd\": 1"),
              "," STANDING_ONE
              ", \"events\": [{\"kind\": \"outage\", \"from_s\": 401, \"until_s\": 500},"
              "{\"kind\": \"outage\", \"from_s\": 600, \"until_s\": 700, \"is_silent\": false},"
              "{\"kind\": \"mask\", \"from_s\": 1000, \"until_s\": 1200, \"sector_rad\": [0.9, 1]},"
              "{\"kind\": \"mask\", \"from_s\": 1300, \"until_s\": 1400, \"range_m\": [0, 49000]},"
              "{\"kind\": \"fades\", \"from_s\": 2000, \"until_s\": 4000, \"pd\": 0.25}]"),
        &scene, 1);
    size_t faded = 0;

    for (size_t i = 0; i < run->num_scans; i++) {
        double end_s = run->scans[i].end_s;
        size_t expected =
            !(end_s >= 600.1 && end_s < 703.9) && !(end_s >= 1000.1 && end_s < 1203.9);

        assert_false(end_s >= 401 && end_s - 4 < 500);
        if (end_s < 2000) {
            if (end_s > 604 && end_s <= 700) {
                assert_int_equal(run->scans[i].num_plots, 0);
            } else if (end_s > 1004 && end_s <= 1200) {
                assert_int_equal(run->scans[i].num_plots, 0);
            } else if (expected) {
                assert_int_equal(run->scans[i].num_plots, 1);
            }
        } else if (end_s > 2004) {
            faded += run->scans[i].num_plots;
        }
    }
    /* without those that began after 396 s and before 500 s */
    assert_int_equal(run->num_scans, 1000 - 25);
    assert_share(faded, 499, 0.25);
    free_observation(run, scene);
}

static void random_fades_suppress_their_share_of_plots(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("40000", RADAR(", \"pd\": 1"),
              ",\"targets\": [{\"count\": 20, \"range_m\": [5000, 70000], \"speed_mps\": 0},"
              "{\"count\": 20, \"range_m\": [5000, 70000], \"speed_mps\": 0}],"
              "\"events\": [{\"kind\": \"fades\", \"per_hour\": 6, \"for_s\": [40, 80],"
              "\"targets\": [1]}]"),
        &scene, 1);
    size_t seen[2] = {0};

    count_plots_by_target(run, 20, seen);
    assert_int_equal(seen[0], 20 * 10000);
    /* some of 1333 fades of 60 s overlap: the free share is exp(-6 * 60 / 3600) */
    assert_near((double)seen[1] / 200000, exp(-0.1), 0.01);
    free_observation(run, scene);
}

static void fades_count_in_their_part_of_the_coverage(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("16000", RADAR(", \"pd\": 0.95"),
              ",\"targets\": [{\"at_m\": [40000, 10000], \"speed_mps\": 0, \"heading_rad\": 0},"
              "{\"at_m\": [60000, 10000], \"speed_mps\": 0, \"heading_rad\": 0},"
              "{\"at_m\": [-40000, 10000], \"speed_mps\": 0, \"heading_rad\": 0},"
              "{\"at_m\": [0, -40000], \"speed_mps\": 0, \"heading_rad\": 0, \"body\": "
              "{\"length_m\": 9, \"width_m\": 2, \"scatterers\": 1, \"seen\": 1}}],"
              "\"events\": ["
              "{\"kind\": \"fades\", \"sector_rad\": [-1.2, 1.2], \"pd\": 0.45},"
              "{\"kind\": \"fades\", \"range_m\": [50000, 70000], \"pd\": 0.25},"
              "{\"kind\": \"fades\", \"sector_rad\": [-2, -1], \"pd\": 0.7}]"),
        &scene, 1);
    size_t seen[4] = {0};

    count_plots_by_target(run, 1, seen);
    assert_share(seen[0], 4000, 0.45);
    assert_share(seen[1], 4000, 0.25); /* in both: the lower one */
    assert_share(seen[2], 4000, 0.95);
    assert_share(seen[3], 4000, 0.7); /* a body's scatterers, too */
    free_observation(run, scene);
}

static void a_target_may_give_split_plots(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("16000", RADAR(""),
              "," STANDING_ONE
              ", \"events\": [{\"kind\": \"split\", \"share\": 0.3, \"range_m\": [400, 600],"
              "\"azimuth_sigmas\": [20, 20]}]"),
        &scene, 1);
    struct moments first = {0}, second = {0}, azimuth = {0};

    for (size_t i = 0; i < run->num_scans; i++) {
        assert_true(run->scans[i].num_plots <= 2);
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];

            assert_int_equal(plot->target_id, 0);
            add_moment(plot->range_m > 50200 ? &second : &first, plot->range_m - 50000);
            if (plot->range_m > 50200) {
                add_moment(&azimuth, plot->azimuth_rad - atan2(4, 3));
            }
        }
    }
    assert_share(first.count, 4000, 0.9);
    assert_share(second.count, first.count, 0.3);
    assert_near(mean_of_moments(&second), 500, 4 * 65 / sqrt(second.count));
    assert_near(sigma_of_moments(&second), sqrt(30 * 30 + 200 * 200 / 12.), 5);
    assert_near(mean_of_moments(&azimuth), 0.06, 4 * 0.003 / sqrt(second.count));
    free_observation(run, scene);
}

static void unresolved_targets_give_one_plot(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("8000", RADAR(", \"resolution_m\": 200, \"resolution_rad\": 0.014, \"pd\": 0.6"),
              ",\"targets\": [{\"at_m\": [30000, 0], \"speed_mps\": 0, \"heading_rad\": 0},"
              "{\"at_m\": [30150, 200], \"speed_mps\": 0, \"heading_rad\": 0},"
              "{\"at_m\": [29700, 0], \"speed_mps\": 0, \"heading_rad\": 0},"
              "{\"at_m\": [30000, -600], \"speed_mps\": 0, \"heading_rad\": 0}]"),
        &scene, 1);
    size_t seen[4] = {0};
    struct moments range = {0};

    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];

            seen[plot->target_id]++;
            if (plot->target_id < 2) {
                add_moment(&range, plot->range_m);
            }
        }
    }
    assert_share(seen[0] + seen[1], 2000, 1 - 0.4 * 0.4);
    assert_share(seen[2], 2000, 0.6);
    assert_share(seen[3], 2000, 0.6);
    assert_near(mean_of_moments(&range), (30000 + hypot(30150, 200)) / 2,
                4 * 30 / sqrt(range.count));
    free_observation(run, scene);
}

static void passive_sensors_measure_bearings(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        "{\"version\": 1, \"duration_s\": 8000, \"passive\": [{\"at_m\": [0, -10000], "
        "\"interval_s\": 4,"
        "\"sigma_rad\": 0.002, \"pd\": 0.8, \"false_bearings\": 1.5, \"false_sector_rad\": [-1, "
        "1]}],"
        "\"targets\": [{\"at_m\": [30000, 30000], \"speed_mps\": 0, \"heading_rad\": 0}],"
        "\"clutter\": [{\"kind\": \"uniform\", \"plots\": 50}]}",
        &scene, 1);
    struct moments right = {0}, wrong = {0};

    assert_int_equal(run->num_scans, 2000);
    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];

            add_moment(plot->target_id < 0 ? &wrong : &right, plot->azimuth_rad);
        }
    }
    assert_share(right.count, 2000, 0.8);
    assert_near(mean_of_moments(&right), atan2(40000, 30000), 4 * 0.002 / sqrt(right.count));
    assert_near(sigma_of_moments(&right), 0.002, 4 * 0.002 / sqrt(2 * right.count));
    assert_poisson(wrong.count, 3000);
    assert_near(mean_of_moments(&wrong), 0, 4 * 0.577 / sqrt(wrong.count));
    assert_near(sigma_of_moments(&wrong), 0.577, 0.03);
    free_observation(run, scene);
}

static void passive_sensors_may_measure_elevations(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        "{\"version\": 1, \"duration_s\": 8000, \"passive\": [{\"interval_s\": 4, \"z_m\": 100, "
        "\"sigma_rad\": 0.002, \"sigma_elevation_rad\": 0.003, \"false_bearings\": 1}], "
        "\"targets\": [{\"at_m\": [3000, 4000, 5100], \"velocity_mps\": [0, 0, 0]}]}",
        &scene, 1);
    struct moments right = {0}, wrong = {0};

    assert_true(scene->has_heights && scene->has_elevations);
    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];

            add_moment(plot->target_id < 0 ? &wrong : &right, plot->elevation_rad);
        }
    }
    assert_near(mean_of_moments(&right), atan2(5000, 5000), 4 * 0.003 / sqrt(right.count));
    assert_near(sigma_of_moments(&right), 0.003, 4 * 0.003 / sqrt(2 * right.count));
    assert_near(mean_of_moments(&wrong), 0.3927, 4 * 0.2267 / sqrt(wrong.count));
    free_observation(run, scene);
}

static void false_bearings_may_come_in_bursts(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        "{\"version\": 1, \"duration_s\": 8000, \"passive\": [{\"interval_s\": 4, \"sigma_rad\": "
        "0.002, \"false_bearings\": 2, \"is_geometric\": true}], \"targets\": []}",
        &scene, 1);
    size_t without = 0;

    for (size_t i = 0; i < run->num_scans; i++) {
        without += run->scans[i].num_plots == 0;
    }
    /* a geometric number of mean 2: none in a third of 2000 scans, variance 6 */
    assert_share(without, 2000, 1.0 / 3.0);
    assert_near((double)count_all_plots(run), 4000, 4 * sqrt(6 * 2000));
    free_observation(run, scene);
}

static void a_camera_may_sway(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        "{\"version\": 1, \"duration_s\": 1200, \"passive\": [{\"interval_s\": 1, \"sigma_rad\": "
        "0.001, \"pd\": 0.999, \"sway_rad\": 0.02, \"sway_s\": 40}], \"targets\": [{\"at_m\": "
        "[100, "
        "0], \"velocity_mps\": [0.001, 0]}]}",
        &scene, 1);
    double sine = 0, square = 0;

    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            const double rad = run->scans[i].plots[k].azimuth_rad;
            sine += rad * sin(2 * 3.14159265 * run->scans[i].plots[k].t_s / 40);
            square += rad * rad;
        }
    }
    assert_near(sine / (double)run->num_scans, 0.01, 0.0002);
    assert_near(square / (double)run->num_scans, 0.0002 + 1e-6, 1e-5);
    free_observation(run, scene);
}

static void scans_come_in_the_order_of_their_reception(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene_text(
        SCENE("400", RADAR("") "," RADAR(", \"start_s\": 1.7, \"late_share\": 0.25, \"late_s\": 5"),
              "," FLYERS),
        &scene, 1);
    size_t late = 0, second = 0;

    for (size_t i = 0; i < run->num_scans; i++) {
        const struct scene_scan *scan = &run->scans[i];

        assert_near(scan->end_s, 4.0 * (double)(scan->number + 1) + (scan->sensor ? 1.7 : 0), 1e-9);
        assert_true(i == 0 || scan->received_s >= run->scans[i - 1].received_s);
        late += scan->received_s > scan->end_s + 4.9;
        second += scan->sensor == 1;
    }
    assert_int_equal(second, 99);
    assert_share(late, 99, 0.25);
    free_observation(run, scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turning_radars_measure_with_their_noise_and_biases),
        cmocka_unit_test(radars_that_do_not_turn_see_all_targets_at_once),
        cmocka_unit_test(radars_of_x_and_y_see_targets_at_the_origin),
        cmocka_unit_test(ambiguous_range_rates_are_folded_into_their_interval),
        cmocka_unit_test(no_plots_come_from_beyond_the_coverage),
        cmocka_unit_test(pd_falls_with_range),
        cmocka_unit_test(outages_and_masks_suppress_plots),
        cmocka_unit_test(random_fades_suppress_their_share_of_plots),
        cmocka_unit_test(fades_count_in_their_part_of_the_coverage),
        cmocka_unit_test(a_target_may_give_split_plots),
        cmocka_unit_test(unresolved_targets_give_one_plot),
        cmocka_unit_test(passive_sensors_measure_bearings),
        cmocka_unit_test(passive_sensors_may_measure_elevations),
        cmocka_unit_test(false_bearings_may_come_in_bursts),
        cmocka_unit_test(a_camera_may_sway),
        cmocka_unit_test(scans_come_in_the_order_of_their_reception),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
