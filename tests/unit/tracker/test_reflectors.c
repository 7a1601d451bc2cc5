/* SPDX-License-Identifier: MIT */
/*
 * Walls that mirror targets: images start no tracks and end as tracks, and targets behind the wall
 * are found.
 */
#include "tracker_setup.h"

#define SENSOR 1

/* The wall is the line y = 40 m; the radar stands at the origin. */
static const struct rho_reflector wall = {-300.0f, 40.0f, 300.0f, 40.0f};

static void start_tracker_with_walls(unsigned num_walls)
{
    const struct rho_sensor radar = {.sensor_id = SENSOR, .pd = 0.9f, .range_max_m = 1e3f};
    use_usual_configs(5);
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    assert_int_equal(rho_tracker_set_reflectors(&tracker, &wall, num_walls), RHO_OK);
}

struct car {
    double x_m, y_m, vx_mps, vy_mps;
};

static void see_car(const struct car *car, double t_s)
{
    add_noisy_plot(car->x_m + car->vx_mps * t_s, car->y_m + car->vy_mps * t_s, 0.5);
}

static struct car image_of(const struct car *car)
{
    return (struct car){car->x_m, 80.0 - car->y_m, car->vx_mps, -car->vy_mps};
}

static void step_scan_of_added_plots(int k)
{
    step_scan((struct rho_scan){.time_us = INT64_C(100000) * k, .sensor_id = SENSOR});
}

static unsigned count_tracks_behind_wall(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        count += report.tracks[i].state[1] > 40.0f;
    }
    return count;
}

static const struct car front = {-60.0, 20.0, 12.0, 0.3};

static void images_start_no_tracks(void **state)
{
    (void)state;
    for (unsigned walls = 0; walls < 2; walls++) {
        unsigned behind = 0, ghosts = 0;
        start_tracker_with_walls(walls);
        for (int k = 0; k < 60; k++) {
            const struct car image = image_of(&front);
            see_car(&front, 0.1 * k);
            if (k % 5 != 3) {
                see_car(&image, 0.1 * k);
            }
            step_scan_of_added_plots(k);
            behind += count_tracks_behind_wall();
            ghosts += report.fates_total[RHO_FATE_GHOST];
        }
        if (walls) {
            assert_int_equal(behind, 0);
            assert_int_equal(report.num_tracks, 1);
            assert_true(ghosts > 35);
        } else {
            assert_true(behind > 40);
            assert_int_equal(ghosts, 0);
        }
    }
}

/* Targets behind the wall away from the image, or at the image but moving differently. */
static void targets_behind_the_wall_are_found(void **state)
{
    static const struct car cars[] = {
        {-60.0, 75.0, 12.0, 0.0}, {40.0, 60.0, -15.0, 0.0}, {-20.0, 58.0, 4.0, 0.2}};
    (void)state;
    for (size_t i = 0; i < sizeof cars / sizeof cars[0]; i++) {
        unsigned seen = 0;
        uint32_t first_id = 0;
        start_tracker_with_walls(1);
        for (int k = 0; k < 80; k++) {
            const struct car image = image_of(&front);
            see_car(&front, 0.1 * k);
            if (k % 3 == 0) {
                see_car(&image, 0.1 * k);
            }
            see_car(&cars[i], 0.1 * k);
            step_scan_of_added_plots(k);
            for (unsigned n = 0; n < report.num_tracks && k >= 20; n++) {
                if (report.tracks[n].state[1] > 40.0f) {
                    first_id = first_id ? first_id : report.tracks[n].track_id;
                    seen += report.tracks[n].track_id == first_id;
                }
            }
        }
        assert_true(seen >= 58);
        assert_int_equal(report.num_tracks, 2);
    }
}

/* A wall has ends, and gives no images to a radar on its other side. */
static void images_need_the_line_of_sight_to_cross_the_wall(void **state)
{
    /* away from the wall, the line of sight to the image does not cross it */
    static const struct rho_reflector elsewhere[] = {{100.0f, 40.0f, 300.0f, 40.0f},
                                                     {-300.0f, 90.0f, 300.0f, 90.0f},
                                                     {-300.0f, -10.0f, 300.0f, -10.0f}};
    (void)state;
    for (size_t i = 0; i < sizeof elsewhere / sizeof elsewhere[0]; i++) {
        start_tracker_with_walls(0);
        assert_int_equal(rho_tracker_set_reflectors(&tracker, &elsewhere[i], 1), RHO_OK);
        for (int k = 0; k < 40; k++) {
            const struct car image = image_of(&front);
            see_car(&front, 0.1 * k);
            see_car(&image, 0.1 * k);
            step_scan_of_added_plots(k);
            assert_int_equal(report.fates_total[RHO_FATE_GHOST], 0);
        }
        assert_int_equal(count_tracks_behind_wall(), 1);
    }
}

/* With range rates, a plot at the image's place is an image only at the image's range rate. */
static void plots_of_another_range_rate_are_no_images(void **state)
{
    (void)state;
    for (int is_image = 0; is_image < 2; is_image++) {
        uint32_t ghosts = 0;
        start_tracker_with_walls(1);
        for (int k = 0; k < 40; k++) {
            const double t_s = 0.1 * k, x_m = front.x_m + front.vx_mps * t_s;
            const struct car image = image_of(&front);
            see_car(&front, t_s);
            plots[0].range_rate_mps =
                (float)((x_m * 12.0 + (20.0 + 0.3 * t_s) * 0.3) / hypot(x_m, 20.0 + 0.3 * t_s));
            see_car(&image, t_s);
            plots[1].range_rate_mps = is_image ? (float)((x_m * 12.0 - (60.0 - 0.3 * t_s) * 0.3) /
                                                         hypot(x_m, 60.0 - 0.3 * t_s))
                                               : 25.0f;
            plots[0].sigma_range_rate_mps = plots[1].sigma_range_rate_mps = 0.3f;
            step_scan((struct rho_scan){.time_us = INT64_C(100000) * k,
                                        .sensor_id = SENSOR,
                                        .measures = RHO_MEASURES_RANGE_RATE});
            ghosts += report.fates_total[RHO_FATE_GHOST];
        }
        assert_true(is_image ? ghosts > 30 : ghosts == 0);
    }
}

/* An established track stays, though it moves like an image for a while. */
static void an_established_track_at_an_image_stays(void **state)
{
    uint32_t id = 0;
    (void)state;
    start_tracker_with_walls(1);
    for (int k = 0; k < 120; k++) {
        const struct car image = image_of(&front);
        if (k >= 50) { /* until k = 50, only the target behind the wall is there */
            see_car(&front, 0.1 * k);
        }
        see_car(&image, 0.1 * k);
        step_scan_of_added_plots(k);
        if (k == 40) {
            assert_int_equal(report.num_tracks, 1);
            id = report.tracks[0].track_id;
        }
    }
    assert_non_null(report_of(id));
    assert_int_equal(report.num_tracks, 2);
}

/* ---- limits from both sides ------------------------------------------------------------------ */

/* Adds a plot without noise but with the usual sigmas, so that tracks are where cars are. */
static void see_exactly(const struct car *car, double t_s)
{
    (void)add_plot(car->x_m + car->vx_mps * t_s, car->y_m + car->vy_mps * t_s, 0.5);
}

static void set_wall(const struct rho_reflector *told)
{
    assert_int_equal(rho_tracker_set_reflectors(&tracker, told, told ? 1 : 0), RHO_OK);
}

static const struct car plain = {-60.0, 20.0, 12.0, 0.0};

/* The line of sight to the image passes the end of the wall by so many sigmas of the track. */
static unsigned count_ghosts_past_end(double sigmas)
{
    const struct car image = image_of(&plain);
    start_tracker_with_walls(0);
    for (int k = 0; k < 30; k++) {
        see_exactly(&plain, 0.1 * k);
        step_scan_of_added_plots(k);
    }
    const double x_m = plain.x_m + plain.vx_mps * 3.0, crossing_m = x_m * 40.0 / image.y_m;
    const double end_m = crossing_m + sigmas * (double)report.tracks[0].sigma_m;
    const struct rho_reflector told = {(float)end_m, 40.0f, 300.0f, 40.0f};
    set_wall(&told);
    see_exactly(&plain, 3.0);
    see_exactly(&image, 3.0);
    step_scan_of_added_plots(30);
    return report.fates_total[RHO_FATE_GHOST];
}

static void images_reach_three_sigmas_past_the_end_of_a_wall(void **state)
{
    (void)state;
    assert_int_equal(count_ghosts_past_end(2.2), 1);
    assert_int_equal(count_ghosts_past_end(4.4), 0);
}

/* Chi-square of the difference of a track from the image of the other, in x, y and their rates. */
static double chi2_to_image(const struct rho_track_report *of, const struct rho_track_report *one)
{
    static const int rows[4] = {0, 1, 3, 4};
    double s[4][5], chi2 = 0.0;
    const double image[4] = {(double)of->state[0], 80.0 - (double)of->state[1],
                             (double)of->state[3], -(double)of->state[4]};
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            const int a = rows[i > j ? i : j], b = rows[i > j ? j : i];
            const double sign = i % 2 == j % 2 ? 1.0 : -1.0;
            s[i][j] =
                (double)one->covariance[RHO_AT(a, b)] + sign * (double)of->covariance[RHO_AT(a, b)];
        }
        s[i][4] = (double)one->state[rows[i]] - image[i];
    }
    for (int k = 0; k < 4; k++) { /* Gaussian elimination: each pivot adds its part of chi2 */
        chi2 += s[k][4] * s[k][4] / s[k][k];
        for (int i = k + 1; i < 4; i++) {
            const double factor = s[i][k] / s[k][k];
            for (int j = k; j < 5; j++) {
                s[i][j] -= factor * s[k][j];
            }
        }
    }
    return chi2;
}

/* Whether a young track so far off the image ends when the wall is set. */
static int does_track_end_off_image(double off_m, double *chi2)
{
    struct car near = image_of(&plain);
    near.x_m += off_m;
    for (int is_told = 0; is_told < 2; is_told++) {
        start_tracker_with_walls(0);
        for (int k = 0; k < 32; k++) {
            see_exactly(&plain, 0.1 * k);
            if (k >= 20) {
                see_exactly(&near, 0.1 * k);
            }
            set_wall(is_told && k == 31 ? &wall : NULL);
            step_scan_of_added_plots(k);
        }
        if (!is_told) {
            assert_int_equal(report.num_tracks, 2);
            *chi2 = chi2_to_image(&report.tracks[0], &report.tracks[1]);
        }
    }
    return report.num_tracks == 1;
}

/* The limit is chi2 = 18.5 in four dimensions, of place and velocity. */
static void a_young_track_within_chi2_18_5_of_an_image_ends(void **state)
{
    double most = 0.0, least = 1e9;
    (void)state;
    for (int i = 0; i < 40; i++) {
        double chi2;
        const int ends = does_track_end_off_image(0.05 * i, &chi2);
        most = ends ? fmax(chi2, most) : most;
        least = ends ? least : fmin(chi2, least);
    }
    assert_true(most > 14.0 && most < 22.0);
    assert_true(least > 16.0 && least < 28.0);
}

/* A track at the image is established and then seen in so many of ten looks: whether it ends. */
static int does_track_end_seen(int of_ten)
{
    const struct car image = image_of(&plain);
    start_tracker_with_walls(0);
    for (int k = 0; k < 100; k++) {
        see_exactly(&plain, 0.1 * k);
        if (k < 6 || k * of_ten % 10 < of_ten) {
            see_exactly(&image, 0.1 * k);
        }
        set_wall(k == 90 ? &wall : NULL);
        step_scan_of_added_plots(k);
        if (k == 90) {
            return report.num_tracks == 1;
        }
        assert_true(k < 10 || report.num_tracks == 2);
    }
    return -1;
}

static void an_established_track_at_an_image_ends_if_rarely_seen(void **state)
{
    (void)state;
    assert_int_equal(does_track_end_seen(5), 1);
    assert_int_equal(does_track_end_seen(8), 0);
}

/*
 * Work units of a step with a wall over those without; with a plot beside the image's gate, or
 * none.
 */
static uint32_t work_of_wall(int has_plot)
{
    uint32_t work[2];
    for (int is_told = 0; is_told < 2; is_told++) {
        const struct car image = image_of(&plain);
        start_tracker_with_walls(0);
        for (int k = 0; k <= 40; k++) {
            see_exactly(&plain, 0.1 * k);
            set_wall(is_told && k == 40 ? &wall : NULL);
            if (has_plot && k == 40) { /* in the corner of the image's search box */
                (void)add_plot(image.x_m + image.vx_mps * 4.0 + 2.0, image.y_m + 2.0, 0.5);
            }
            step_scan_of_added_plots(k);
        }
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.fates_total[RHO_FATE_GHOST], 0);
        work[is_told] = tracker.work.work;
    }
    return work[1] - work[0];
}

static void work_of_images_is_counted(void **state)
{
    (void)state;
    /* one image is computed, and one plot tested */
    assert_int_equal(work_of_wall(0), 12);
    assert_int_equal(work_of_wall(1), 12 + 3);
}

#define CARS (RHO_MAX_TRACKS < 400 ? RHO_MAX_TRACKS : 400)
#define BEYOND RHO_TRACKER_WORK_BEYOND

/*
 * The largest number of walls and of young tracks: each track is compared with images of the
 * others.
 */
static void work_of_many_tracks_and_walls_is_bounded(void **state)
{
    struct rho_reflector walls[RHO_MAX_REFLECTORS];
    uint32_t partial = 0;
    (void)state;
    start_tracker_with_walls(0);
    for (int i = 0; i < RHO_MAX_REFLECTORS; i++) {
        walls[i] = (struct rho_reflector){-2e3f, 900.0f + (float)i, 2e3f, 900.0f + (float)i};
    }
    assert_int_equal(rho_tracker_set_reflectors(&tracker, walls, RHO_MAX_REFLECTORS), RHO_OK);
    tracker.config.work_max = initiator.config.work_max = 200000;
    for (int k = 0; k < 12; k++) {
        for (int i = 0; i < CARS; i++) {
            const struct car car = {40.0 * (i % 20) - 400.0, 20.0 + 40.0 * (i / 20 % 20), 8.0, 0.0};
            see_car(&car, 0.1 * k);
        }
        step_scan_of_added_plots(k);
        assert_true(tracker.work.work <= 200000 + BEYOND);
        partial += report.is_partial;
    }
    assert_true(report.num_tracks > CARS / 2u);
    print_message("%u tracks, %u units at most, %u partial steps\n", (unsigned)report.num_tracks,
                  (unsigned)tracker.work.work_worst, (unsigned)partial);
}

static void bad_walls_are_refused(void **state)
{
    struct rho_reflector walls[RHO_MAX_REFLECTORS + 1];
    struct rho_tracker before;
    (void)state;
    start_tracker_with_walls(1);
    for (int i = 0; i <= RHO_MAX_REFLECTORS; i++) {
        walls[i] = wall;
    }
    before = tracker;
    assert_int_equal(rho_tracker_set_reflectors(NULL, walls, 1), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_set_reflectors(&tracker, NULL, 1), RHO_ERROR_NULL);
    assert_int_equal(rho_tracker_set_reflectors(&tracker, walls, RHO_MAX_REFLECTORS + 1),
                     RHO_ERROR_CAPACITY);
    walls[1].to_x_m = NAN;
    assert_int_equal(rho_tracker_set_reflectors(&tracker, walls, 2), RHO_ERROR_VALUE);
    walls[1].to_x_m = walls[1].from_x_m + 0.5f;
    assert_int_equal(rho_tracker_set_reflectors(&tracker, walls, 2), RHO_ERROR_VALUE);
    assert_memory_equal(&before, &tracker, sizeof tracker);
    before.magic = 0;
    assert_int_equal(rho_tracker_set_reflectors(&before, walls, 1), RHO_ERROR_STATE);
    walls[1] = wall;
    assert_int_equal(rho_tracker_set_reflectors(&tracker, walls, RHO_MAX_REFLECTORS), RHO_OK);
    assert_true(rho_tracker_is_sound(&tracker));
    tracker.reflectors[1].from_y_m = INFINITY;
    assert_false(rho_tracker_is_sound(&tracker));
    assert_int_equal(rho_tracker_set_reflectors(&tracker, NULL, 0), RHO_OK);
    assert_true(rho_tracker_is_sound(&tracker));
    tracker.num_reflectors = RHO_MAX_REFLECTORS + 1;
    assert_false(rho_tracker_is_sound(&tracker));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(images_start_no_tracks),
        cmocka_unit_test(targets_behind_the_wall_are_found),
        cmocka_unit_test(images_need_the_line_of_sight_to_cross_the_wall),
        cmocka_unit_test(plots_of_another_range_rate_are_no_images),
        cmocka_unit_test(an_established_track_at_an_image_stays),
        cmocka_unit_test(work_of_many_tracks_and_walls_is_bounded),
        cmocka_unit_test(bad_walls_are_refused),
        cmocka_unit_test(images_reach_three_sigmas_past_the_end_of_a_wall),
        cmocka_unit_test(a_young_track_within_chi2_18_5_of_an_image_ends),
        cmocka_unit_test(an_established_track_at_an_image_ends_if_rarely_seen),
        cmocka_unit_test(work_of_images_is_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
