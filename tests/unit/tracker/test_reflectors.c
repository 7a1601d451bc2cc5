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
    draw(5);
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    begin();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    assert_int_equal(rho_tracker_set_reflectors(&tracker, &wall, num_walls), RHO_OK);
}

struct car {
    double x_m, y_m, vx_mps, vy_mps;
};

static void see(const struct car *car, double t_s)
{
    add_noisy(car->x_m + car->vx_mps * t_s, car->y_m + car->vy_mps * t_s, 0.5);
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
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
