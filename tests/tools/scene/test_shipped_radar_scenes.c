/* SPDX-License-Identifier: MIT */
/*
 * The scenes polar, doppler, rotating and two-radars: noise and biases, detections, clutter, places
 * of targets, sectors, late arrivals. Seeds are fixed; bounds are four standard deviations.
 */
#include "scene_text.h"

#include "tools/scene_for_tracker.h"

#define SEED 4711

static struct scene_run *observe_scene(const char *name, const char *const *sets, size_t num_sets,
                                       uint64_t run, struct scene **scene)
{
    *scene = scene_load_by_name(name, sets, num_sets);
    return scene_observe(*scene, SEED, run);
}

static void free_observation(struct scene_run *run, struct scene *scene)
{
    scene_run_free(run);
    scene_free(scene);
}

/* Errors of plots in sigmas of their radar, without its biases; and the number of clutter plots. */
struct errors {
    struct moments range, azimuth, rate;
    size_t clutter;
};

static struct errors plot_errors_of_radar(const struct scene_run *run, size_t radar)
{
    const struct scene_sensor *sensor = &run->scene->sensors[radar];
    struct errors errors = {.clutter = 0};

    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; run->scans[i].sensor == radar && k < run->scans[i].num_plots; k++) {
            const struct scene_plot *plot = &run->scans[i].plots[k];
            struct motion at;
            double x_m, y_m, range_m;

            if (plot->target_id < 0) {
                errors.clutter++;
                continue;
            }
            at = path_motion_at(&run->paths[plot->target_id], plot->t_s);
            x_m = at.x_m - sensor->x_m;
            y_m = at.y_m - sensor->y_m;
            range_m = hypot(x_m, y_m);
            add_moment(&errors.range,
                       (plot->range_m - range_m - sensor->range_bias_m) / sensor->sigma_range_m);
            add_moment(&errors.azimuth,
                       remainder(plot->azimuth_rad - atan2(y_m, x_m) - sensor->azimuth_bias_rad,
                                 PORTABLE_TURN) /
                           sensor->sigma_azimuth_rad);
            add_moment(&errors.rate,
                       plot->range_rate_mps - (x_m * at.vx_mps + y_m * at.vy_mps) / range_m);
        }
    }
    return errors;
}

static void assert_standard_normal(const struct moments *moments)
{
    assert_near(mean_of_moments(moments), 0.0, 4.0 / sqrt(moments->count));
    assert_near(sigma_of_moments(moments), 1.0, 4.0 / sqrt(2.0 * moments->count));
}

static void scene_polar_has_its_documented_noise_and_clutter(void **state)
{
    (void)state;
    const char *sets[] = {"targets.0.count=400", "radars.0.sigma_range_rate_mps=1"};
    struct scene *scene;
    struct scene_run *run = observe_scene("polar", sets, 2, 0, &scene);
    struct errors errors = plot_errors_of_radar(run, 0);

    assert_int_equal(run->num_scans, 15);
    assert_standard_normal(&errors.range);
    assert_standard_normal(&errors.azimuth);
    assert_standard_normal(&errors.rate);
    assert_share(errors.range.count, 15.0 * 400.0, 0.99);
    assert_poisson((double)errors.clutter, 1500.0);
    for (size_t i = 0; i < run->num_paths; i++) {
        for (double t_s = 0.0; t_s <= 60.0; t_s += 4.0) {
            struct motion at = path_motion_at(&run->paths[i], t_s);
            double range_m = hypot(at.x_m, at.y_m), speed_mps = hypot(at.vx_mps, at.vy_mps);

            assert_true(range_m >= 19900.0 && range_m <= 60100.0);
            assert_true(speed_mps >= 100.0 && speed_mps <= 400.0);
        }
    }
    free_observation(run, scene);
}

/* Range rates of clutter that stands still have a standard deviation of 1 m/s. */
static void clutter_of_scene_doppler_stands_still(void **state)
{
    (void)state;
    const char *sets[] = {"targets=[]", "clutter.0.plots=0", "clutter.1.plots=400"};
    struct scene *scene;
    struct scene_run *run = observe_scene("doppler", sets, 3, 0, &scene);
    struct moments rates = {0};

    for (size_t i = 0; i < run->num_scans; i++) {
        for (size_t k = 0; k < run->scans[i].num_plots; k++) {
            add_moment(&rates, run->scans[i].plots[k].range_rate_mps);
        }
    }
    assert_poisson(rates.count, 6000.0);
    assert_standard_normal(&rates);
    free_observation(run, scene);
}

/*
 * Sectors follow one another clockwise; the last of three targets turns at 2 m/s^2 for 20 s, the
 * others fly straight.
 */
static void scene_rotating_has_sectors_and_a_turning_target(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene("rotating", NULL, 0, 0, &scene);

    assert_int_equal(run->num_scans, 15 * 32);
    for (size_t i = 0; i < run->num_scans; i++) {
        double turned_rad = PORTABLE_TURN / 32.0 * (double)(i + 1);

        assert_near(run->scans[i].end_s, 0.125 * (double)(i + 1), 1e-9);
        assert_near(remainder(run->scans[i].from_rad + turned_rad, PORTABLE_TURN), 0.0, 1e-6);
    }
    for (size_t i = 0; i < run->num_paths; i++) {
        double turning_s = 0.0;

        for (double t_s = 0.0; t_s < 59.9; t_s += 0.1) {
            struct motion a = path_motion_at(&run->paths[i], t_s),
                          b = path_motion_at(&run->paths[i], t_s + 0.1);
            double mps2 = hypot(b.vx_mps - a.vx_mps, b.vy_mps - a.vy_mps) / 0.1;

            assert_true(mps2 < 2.01);
            turning_s += mps2 > 1.99 ? 0.1 : 0.0;
        }
        assert_near(turning_s, i == 2 ? 20.0 : 0.0, 0.3);
    }
    free_observation(run, scene);
}

static void scene_two_radars_has_its_configured_biases(void **state)
{
    (void)state;
    const char *sets[] = {"radars.1.time_bias_s=0.5"};
    struct scene *scene;
    struct scene_run *run = observe_scene("two-radars", sets, 1, 0, &scene);

    for (size_t radar = 0; radar < 2; radar++) {
        struct errors errors = plot_errors_of_radar(run, radar);
        double sign = radar == 0 ? 1.0 : -1.0;

        assert_near(scene->sensors[radar].range_bias_m, sign * 50.0, 0.0);
        assert_near(scene->sensors[radar].azimuth_bias_rad, sign * PORTABLE_TURN / 3600.0, 1e-9);
        assert_standard_normal(&errors.range);
        assert_standard_normal(&errors.azimuth);
        assert_poisson((double)errors.clutter, 20.0 * (radar == 0 ? 60.0 : 149.0));
    }
    free_observation(run, scene);
}

static double range_from_radar(const struct scene_sensor *radar, const struct motion *at)
{
    return hypot(at->x_m - radar->x_m, at->y_m - radar->y_m);
}

/* Aircraft keep five nautical miles apart, in range of at least one radar, and mostly of both. */
static void aircraft_of_two_radars_are_mostly_seen_by_both(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene("two-radars", NULL, 0, 1, &scene);

    assert_int_equal(run->num_paths, 20);
    for (size_t i = 0; i < 20; i++) {
        size_t both = 0;

        for (int t_s = 0; t_s < 600; t_s++) {
            struct motion at = path_motion_at(&run->paths[i], t_s);
            double first_m = range_from_radar(&scene->sensors[0], &at);
            double second_m = range_from_radar(&scene->sensors[1], &at);
            bool first = first_m >= 4000.0 && first_m <= 148000.0;
            bool second = second_m >= 3000.0 && second_m <= 98000.0;

            assert_true(first || second);
            both += first && second;
            for (size_t j = 0; j < i; j++) {
                struct motion other = path_motion_at(&run->paths[j], t_s);

                assert_true(hypot(at.x_m - other.x_m, at.y_m - other.y_m) >= 9260.0);
            }
        }
        assert_true(both >= 479);
    }
    free_observation(run, scene);
}

/*
 * Scans are in order of arrival, a fifth of them 300 ms late; the second radar starts at any point
 * of its turn.
 */
static void a_fifth_of_scene_two_radars_scans_is_300_ms_late(void **state)
{
    (void)state;
    struct scene *scene;
    struct scene_run *run = observe_scene("two-radars", NULL, 0, 2, &scene);
    struct scene_run *other = scene_observe(scene, SEED, 3);
    double first_s = INFINITY, others_s = INFINITY;
    size_t late = 0;

    for (size_t i = 0; i < run->num_scans; i++) {
        double after_s = run->scans[i].received_s - run->scans[i].end_s;

        assert_true(i == 0 || run->scans[i].received_s >= run->scans[i - 1].received_s);
        assert_true(fabs(after_s) < 1e-9 || fabs(after_s - 0.3) < 1e-9);
        late += after_s > 0.1;
        first_s = fmin(first_s, run->scans[i].sensor == 1 ? run->scans[i].end_s : INFINITY);
    }
    for (size_t i = 0; i < other->num_scans; i++) {
        others_s = fmin(others_s, other->scans[i].sensor == 1 ? other->scans[i].end_s : INFINITY);
    }
    assert_share(late, run->num_scans, 0.2);
    assert_true(first_s >= 0.125 && first_s < 4.125 && fabs(first_s - others_s) > 1e-3);
    assert_true(fabs(run->scans[0].from_rad - other->scans[0].from_rad) > 1e-6);
    scene_run_free(other);
    free_observation(run, scene);
}

/* Scan times follow the radar's own clock, as do times of plots. */
static void scan_times_follow_the_biased_radar_clock(void **state)
{
    (void)state;
    static struct rho_plot plots[RHO_MAX_PLOTS];
    const char *sets[] = {"radars.1.time_bias_s=-0.5", "radars.0.sectors=1", "radars.1.sectors=1"};
    struct scene *scene;
    struct scene_run *run = observe_scene("two-radars", sets, 3, 2, &scene);

    for (size_t i = 0; i < run->num_scans; i++) {
        const struct scene_scan *seen = &run->scans[i];
        const struct scene_sensor *radar = &scene->sensors[seen->sensor];
        struct rho_sensor known = scene_sensor_without_biases(radar);
        struct rho_scan scan = scene_scan_for_tracker(run, seen, &known, plots);

        assert_near((double)scan.time_us * 1e-6, seen->end_s - (seen->sensor == 1 ? 0.5 : 0.0),
                    1e-6);
        assert_int_equal(scan.num_plots, seen->num_plots);
        for (size_t k = 0; k < scan.num_plots; k++) {
            assert_true(plots[k].offset_us <= 0 && plots[k].offset_us >= -1e6 * radar->turn_s - 1);
        }
    }
    free_observation(run, scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scene_polar_has_its_documented_noise_and_clutter),
        cmocka_unit_test(clutter_of_scene_doppler_stands_still),
        cmocka_unit_test(scene_rotating_has_sectors_and_a_turning_target),
        cmocka_unit_test(scene_two_radars_has_its_configured_biases),
        cmocka_unit_test(aircraft_of_two_radars_are_mostly_seen_by_both),
        cmocka_unit_test(a_fifth_of_scene_two_radars_scans_is_300_ms_late),
        cmocka_unit_test(scan_times_follow_the_biased_radar_clock),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
