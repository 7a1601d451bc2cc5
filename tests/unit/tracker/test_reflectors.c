/* SPDX-License-Identifier: MIT */
/*
 * Walls that show targets a second time: images start nothing and end, and targets behind the wall
 * are found.
 */
#include "tracker_setup.h"

#define SENSOR 1

/* The wall is the line y = 40 m; the radar stands at the origin. */
static const struct rho_reflector wall = {-300.0f, 40.0f, 300.0f, 40.0f};

static void prepare(unsigned num_walls)
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

static void see(const struct car *car, double t_s)
{
    add_noisy_plot(car->x_m + car->vx_mps * t_s, car->y_m + car->vy_mps * t_s, 0.5);
}

static struct car image_of(const struct car *car)
{
    return (struct car){car->x_m, 80.0 - car->y_m, car->vx_mps, -car->vy_mps};
}

static void look(int k)
{
    step_scan((struct rho_scan){.time_us = INT64_C(100000) * k, .sensor_id = SENSOR});
}

static unsigned num_behind(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        count += report.tracks[i].state[1] > 40.0f;
    }
    return count;
}

static const struct car front = {-60.0, 20.0, 12.0, 0.3};

static void images_start_nothing(void **state)
{
    (void)state;
    for (unsigned walls = 0; walls < 2; walls++) {
        unsigned behind = 0, ghosts = 0;
        prepare(walls);
        for (int k = 0; k < 60; k++) {
            const struct car image = image_of(&front);
            see(&front, 0.1 * k);
            if (k % 5 != 3) {
                see(&image, 0.1 * k);
            }
            look(k);
            behind += num_behind();
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

/* Behind the wall, and elsewhere than the image; or where it is, but moving otherwise. */
static void targets_behind_the_wall_are_found(void **state)
{
    static const struct car cars[] = {
        {-60.0, 75.0, 12.0, 0.0}, {40.0, 60.0, -15.0, 0.0}, {-20.0, 58.0, 4.0, 0.2}};
    (void)state;
    for (size_t i = 0; i < sizeof cars / sizeof cars[0]; i++) {
        unsigned seen = 0;
        uint32_t first_id = 0;
        prepare(1);
        for (int k = 0; k < 80; k++) {
            const struct car image = image_of(&front);
            see(&front, 0.1 * k);
            if (k % 3 == 0) {
                see(&image, 0.1 * k);
            }
            see(&cars[i], 0.1 * k);
            look(k);
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

/* A wall has ends, and shows nothing to a radar on its other side. */
static void no_image_is_where_the_wall_is_not(void **state)
{
    /* elsewhere the line of sight to the image crosses no wall */
    static const struct rho_reflector elsewhere[] = {{100.0f, 40.0f, 300.0f, 40.0f},
                                                     {-300.0f, 90.0f, 300.0f, 90.0f},
                                                     {-300.0f, -10.0f, 300.0f, -10.0f}};
    (void)state;
    for (size_t i = 0; i < sizeof elsewhere / sizeof elsewhere[0]; i++) {
        prepare(0);
        assert_int_equal(rho_tracker_set_reflectors(&tracker, &elsewhere[i], 1), RHO_OK);
        for (int k = 0; k < 40; k++) {
            const struct car image = image_of(&front);
            see(&front, 0.1 * k);
            see(&image, 0.1 * k);
            look(k);
            assert_int_equal(report.fates_total[RHO_FATE_GHOST], 0);
        }
        assert_int_equal(num_behind(), 1);
    }
}

/* With range rates, a plot at the image's place is one only if its range rate is the image's. */
static void range_rates_tell_images_apart(void **state)
{
    (void)state;
    for (int is_image = 0; is_image < 2; is_image++) {
        uint32_t ghosts = 0;
        prepare(1);
        for (int k = 0; k < 40; k++) {
            const double t_s = 0.1 * k, x_m = front.x_m + front.vx_mps * t_s;
            const struct car image = image_of(&front);
            see(&front, t_s);
            plots[0].range_rate_mps =
                (float)((x_m * 12.0 + (20.0 + 0.3 * t_s) * 0.3) / hypot(x_m, 20.0 + 0.3 * t_s));
            see(&image, t_s);
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

/* An established track of its own kind stays, though it moves as an image for a while. */
static void an_established_track_stays(void **state)
{
    uint32_t id = 0;
    (void)state;
    prepare(1);
    for (int k = 0; k < 120; k++) {
        const struct car image = image_of(&front);
        if (k >= 50) { /* before, only the one behind the wall is there */
            see(&front, 0.1 * k);
        }
        see(&image, 0.1 * k);
        look(k);
        if (k == 40) {
            assert_int_equal(report.num_tracks, 1);
            id = report.tracks[0].track_id;
        }
    }
    assert_non_null(report_of(id));
    assert_int_equal(report.num_tracks, 2);
}

/* ---- limits from both sides ------------------------------------------------------------------ */

/* Without noise, but stated as others: where tracks are is where cars are. */
static void see_exactly(const struct car *car, double t_s)
{
    (void)add_plot(car->x_m + car->vx_mps * t_s, car->y_m + car->vy_mps * t_s, 0.5);
}

static void tell(const struct rho_reflector *told)
{
    assert_int_equal(rho_tracker_set_reflectors(&tracker, told, told ? 1 : 0), RHO_OK);
}

static const struct car plain = {-60.0, 20.0, 12.0, 0.0};

/* The line of sight to the image passes the end of the wall by so many of the track's sigmas. */
static unsigned ghosts_beside(double sigmas)
{
    const struct car image = image_of(&plain);
    prepare(0);
    for (int k = 0; k < 30; k++) {
        see_exactly(&plain, 0.1 * k);
        look(k);
    }
    const double x_m = plain.x_m + plain.vx_mps * 3.0, crossing_m = x_m * 40.0 / image.y_m;
    const double end_m = crossing_m + sigmas * (double)report.tracks[0].sigma_m;
    const struct rho_reflector told = {(float)end_m, 40.0f, 300.0f, 40.0f};
    tell(&told);
    see_exactly(&plain, 3.0);
    see_exactly(&image, 3.0);
    look(30);
    return report.fates_total[RHO_FATE_GHOST];
}

static void a_line_of_sight_may_pass_the_end_by_three_sigmas(void **state)
{
    (void)state;
    assert_int_equal(ghosts_beside(2.2), 1);
    assert_int_equal(ghosts_beside(4.4), 0);
}

/* How far one is off the image of the other in x, y and their rates, in chi-square. */
static double chi2_of(const struct rho_track_report *of, const struct rho_track_report *one)
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
    for (int k = 0; k < 4; k++) { /* elimination: each pivot has its part of chi2 */
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

/* A young track so far off the image, when the wall is told: whether it ends. */
static int ends_off(double off_m, double *chi2)
{
    struct car near = image_of(&plain);
    near.x_m += off_m;
    for (int is_told = 0; is_told < 2; is_told++) {
        prepare(0);
        for (int k = 0; k < 32; k++) {
            see_exactly(&plain, 0.1 * k);
            if (k >= 20) {
                see_exactly(&near, 0.1 * k);
            }
            tell(is_told && k == 31 ? &wall : NULL);
            look(k);
        }
        if (!is_told) {
            assert_int_equal(report.num_tracks, 2);
            *chi2 = chi2_of(&report.tracks[0], &report.tracks[1]);
        }
    }
    return report.num_tracks == 1;
}

/* chi2 18.5 in four dimensions, by place and velocity. */
static void a_young_track_at_an_image_ends(void **state)
{
    double most = 0.0, least = 1e9;
    (void)state;
    for (int i = 0; i < 40; i++) {
        double chi2;
        const int ends = ends_off(0.05 * i, &chi2);
        most = ends ? fmax(chi2, most) : most;
        least = ends ? least : fmin(chi2, least);
    }
    assert_true(most > 14.0 && most < 22.0);
    assert_true(least > 16.0 && least < 28.0);
}

/* At the image for so long that it is established, seen in so many of ten looks: it ends. */
static int ends_seen(int of_ten)
{
    const struct car image = image_of(&plain);
    prepare(0);
    for (int k = 0; k < 100; k++) {
        see_exactly(&plain, 0.1 * k);
        if (k < 6 || k * of_ten % 10 < of_ten) {
            see_exactly(&image, 0.1 * k);
        }
        tell(k == 90 ? &wall : NULL);
        look(k);
        if (k == 90) {
            return report.num_tracks == 1;
        }
        assert_true(k < 10 || report.num_tracks == 2);
    }
    return -1;
}

static void an_established_track_at_an_image_ends_where_it_is_seen_seldom(void **state)
{
    (void)state;
    assert_int_equal(ends_seen(5), 1);
    assert_int_equal(ends_seen(8), 0);
}

/* Units of the step with a wall, over those without: a plot beside the image's gate, or none. */
static uint32_t work_of_wall(int has_plot)
{
    uint32_t work[2];
    for (int is_told = 0; is_told < 2; is_told++) {
        const struct car image = image_of(&plain);
        prepare(0);
        for (int k = 0; k <= 40; k++) {
            see_exactly(&plain, 0.1 * k);
            tell(is_told && k == 40 ? &wall : NULL);
            if (has_plot && k == 40) { /* in the corner of its box */
                (void)add_plot(image.x_m + image.vx_mps * 4.0 + 2.0, image.y_m + 2.0, 0.5);
            }
            look(k);
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
    /* one image is made, and one plot tested */
    assert_int_equal(work_of_wall(0), 12);
    assert_int_equal(work_of_wall(1), 12 + 3);
}

#define CARS (RHO_MAX_TRACKS < 400 ? RHO_MAX_TRACKS : 400)
#define BEYOND RHO_TRACKER_WORK_BEYOND

/*
 * Young tracks in front of all walls that there can be: each is compared with images of the others.
 */
static void many_young_tracks_and_walls_cost_no_more_than_they_may(void **state)
{
    struct rho_reflector walls[RHO_MAX_REFLECTORS];
    uint32_t partial = 0;
    (void)state;
    prepare(0);
    for (int i = 0; i < RHO_MAX_REFLECTORS; i++) {
        walls[i] = (struct rho_reflector){-2e3f, 900.0f + (float)i, 2e3f, 900.0f + (float)i};
    }
    assert_int_equal(rho_tracker_set_reflectors(&tracker, walls, RHO_MAX_REFLECTORS), RHO_OK);
    tracker.config.work_max = initiator.config.work_max = 200000;
    for (int k = 0; k < 12; k++) {
        for (int i = 0; i < CARS; i++) {
            const struct car car = {40.0 * (i % 20) - 400.0, 20.0 + 40.0 * (i / 20 % 20), 8.0, 0.0};
            see(&car, 0.1 * k);
        }
        look(k);
        assert_true(tracker.work.work <= 200000 + BEYOND);
        partial += report.is_partial;
    }
    assert_true(report.num_tracks > CARS / 2u);
    print_message("%u tracks, %u units at most, %u partial steps\n", (unsigned)report.num_tracks,
                  (unsigned)tracker.work.work_worst, (unsigned)partial);
}

static void walls_are_checked(void **state)
{
    struct rho_reflector walls[RHO_MAX_REFLECTORS + 1];
    struct rho_tracker before;
    (void)state;
    prepare(1);
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
        cmocka_unit_test(images_start_nothing),
        cmocka_unit_test(targets_behind_the_wall_are_found),
        cmocka_unit_test(no_image_is_where_the_wall_is_not),
        cmocka_unit_test(range_rates_tell_images_apart),
        cmocka_unit_test(an_established_track_stays),
        cmocka_unit_test(many_young_tracks_and_walls_cost_no_more_than_they_may),
        cmocka_unit_test(walls_are_checked),
        cmocka_unit_test(a_line_of_sight_may_pass_the_end_by_three_sigmas),
        cmocka_unit_test(a_young_track_at_an_image_ends),
        cmocka_unit_test(an_established_track_at_an_image_ends_where_it_is_seen_seldom),
        cmocka_unit_test(work_of_images_is_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
