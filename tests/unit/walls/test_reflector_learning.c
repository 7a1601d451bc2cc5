/* SPDX-License-Identifier: MIT */
/*
 * Walls that are not configured are learned from images of passing cars; lanes, formations and
 * clutter are not taken for walls; learned walls are used, saved and forgotten.
 */
#include "rhotrack/reflectors.h"
#include "rhotrack/snapshot.h"
#include "tracker_setup.h"

#define SENSOR 1
#define STEP_S 0.1
#define WALL_M 40.0 /* y of the wall, m */
#define BEHIND_M 45.0f
#define EVERY 50  /* steps from one car to the next */
#define DRIVE 150 /* steps that each car is seen */

static struct rho_reflector_learning learning;

static void prepare_tracker(uint64_t seed)
{
    const struct rho_sensor radar = {.sensor_id = SENSOR, .pd = 0.9f, .range_max_m = 1e3f};
    use_usual_configs(seed);
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    assert_int_equal(rho_reflector_learning_init(&learning, sizeof learning), RHO_OK);
}

static void step_tracker_and_learning(int k)
{
    static struct rho_plot seen[PLOTS_MAX];
    struct rho_scan scan = {.time_us = INT64_C(100000) * k, .sensor_id = SENSOR};
    memcpy(seen, plots, sizeof seen);
    const uint32_t count = num_plots;
    step_scan(scan);
    scan.plots = seen;
    scan.num_plots = count;
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, &report), RHO_OK);
    assert_true(rho_reflector_learning_is_sound(&learning));
    assert_true(k % 100 > 0 || rho_tracker_is_sound(&tracker));
}

/*
 * Place of car i at step k in one of three lanes; returns 0 before it comes and after it has gone.
 */
static int car_place(int i, int k, double *x_m, double *y_m)
{
    const double speed_mps = 18.0 + i % 4;
    *x_m = (i % 3 == 1 ? 1.0 : -1.0) * (speed_mps * STEP_S * (k - EVERY * i) - 140.0);
    *y_m = 20.0 + 5.0 * (i % 3);
    return k >= EVERY * i && k < EVERY * i + DRIVE;
}

/* Adds plots of all cars at a step, and of their images with this probability. */
static void add_traffic_plots(int k, double share)
{
    double x_m, y_m;
    for (int i = k / EVERY - DRIVE / EVERY; i <= k / EVERY; i++) {
        if (i < 0 || !car_place(i, k, &x_m, &y_m)) {
            continue;
        }
        if (uniform(0.0, 1.0) < 0.9) {
            add_noisy_plot(x_m, y_m, 0.5);
        }
        if (uniform(0.0, 1.0) < share) {
            add_noisy_plot(x_m, 2.0 * WALL_M - y_m, 0.5);
        }
    }
}

static unsigned count_walls(struct rho_reflector *wall)
{
    unsigned count = 0;
    for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
        count += rho_reflector_learning_wall(&learning, i, wall) != 0;
    }
    return count;
}

static unsigned count_tracks_behind_wall(void)
{
    unsigned count = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        count += report.tracks[i].state[RHO_Y] > BEHIND_M;
    }
    return count;
}

static void expect_wall_at_40_m(const struct rho_reflector *wall)
{
    assert_true(fabs((double)wall->from_y_m - WALL_M) < 1.0);
    assert_true(fabs((double)wall->to_y_m - WALL_M) < 1.0);
    assert_true(fabs((double)(wall->to_x_m - wall->from_x_m)) > 50.0);
}

static void a_wall_is_learned_from_the_images_of_passing_cars(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        static const double shares[] = {0.3, 0.9};
        for (size_t s = 0; s < 2; s++) {
            struct rho_reflector wall;
            unsigned before = 0, after = 0;
            prepare_tracker(seed);
            for (int k = 0; k < 1500; k++) {
                add_traffic_plots(k, shares[s]);
                step_tracker_and_learning(k);
                before += k < 600 ? count_tracks_behind_wall() : 0;
                after += k >= 800 ? count_tracks_behind_wall() : 0;
            }
            assert_int_equal(count_walls(&wall), 1);
            expect_wall_at_40_m(&wall);
            assert_int_equal(tracker.num_reflectors, 1);
            assert_memory_equal(&tracker.reflectors[0], &wall, sizeof wall);
            print_message("%u tracks of images before, %u after\n", before, after);
            assert_true(before > 30);
            assert_true(after < 7); /* tracks in 700 steps */
        }
    }
}

/*
 * Images are nearer to their cars than the longest body allowed, until bodies are known to be
 * shorter.
 */
static void a_wall_is_learned_if_bodies_may_be_35_m_long(void **state)
{
    struct rho_reflector wall;
    (void)state;
    if (!RHO_BODIES) {
        skip();
    }
    prepare_tracker(2);
    assert_int_equal(rho_tracker_set_body_max(&tracker, 35.0f), RHO_OK);
    for (int k = 0; k < 1500; k++) {
        add_traffic_plots(k, 0.3);
        step_tracker_and_learning(k);
    }
    assert_int_equal(count_walls(&wall), 1);
    expect_wall_at_40_m(&wall);
}

/* The walls are at 40 m and at -10 m; each mirrors the cars only. */
static void walls_on_both_sides_are_learned(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        struct rho_reflector wall;
        prepare_tracker(seed);
        for (int k = 0; k < 2500; k++) {
            double x_m, y_m;
            for (int i = k / EVERY - DRIVE / EVERY; i <= k / EVERY; i++) {
                if (i >= 0 && car_place(i, k, &x_m, &y_m)) {
                    add_noisy_plot(x_m, y_m, 0.5);
                    if (uniform(0.0, 1.0) < 0.6) {
                        add_noisy_plot(x_m, 2.0 * WALL_M - y_m, 0.5);
                    }
                    if (uniform(0.0, 1.0) < 0.5) {
                        add_noisy_plot(x_m, -2.0 * 10.0 - y_m, 0.5);
                    }
                }
            }
            step_tracker_and_learning(k);
        }
        assert_int_equal(count_walls(&wall), 2);
    }
}

static void without_images_nothing_is_learned(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        struct rho_reflector wall;
        prepare_tracker(seed);
        for (int k = 0; k < 1000; k++) {
            add_traffic_plots(k, 0.0);
            for (int i = 0; i < 12; i++) { /* about as much clutter before the line as behind it */
                const double x_m = uniform(-150.0, 150.0), y_m = uniform(5.0, 90.0);
                (void)add_plot(x_m, y_m, 0.5);
            }
            step_tracker_and_learning(k);
        }
        assert_int_equal(count_walls(&wall), 0);
        assert_int_equal(tracker.num_reflectors, 0);
    }
}

/*
 * Cars pass side by side in two lanes, pair after pair, and mirror each other in the middle of the
 * road. Errors of plots and places in the lane make their distances unequal.
 */
static void cars_in_two_lanes_are_not_taken_for_a_wall(void **state)
{
    /* half the distance of the lanes, sigma of plots, sigma of the place in the lane */
    static const double cases[][3] = {
        {4.0, 0.5, 0.0}, {1.75, 0.5, 0.0}, {2.0, 0.3, 0.0}, {2.0, 0.3, 0.3}};
    (void)state;
    for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
        const double half_m = cases[c][0], sigma_m = cases[c][1];
        double off_m[2 * 60];
        struct rho_reflector wall;
        unsigned most = 0;
        prepare_tracker(3 + c);
        for (int i = 0; i < 2 * 60; i++) {
            off_m[i] = cases[c][2] * normal();
        }
        for (int k = 0; k < 3000; k++) {
            double x_m, y_m;
            for (int i = k / EVERY - DRIVE / EVERY; i <= k / EVERY; i++) {
                if (i >= 0 && car_place(3 * i, 2 * EVERY * i + k, &x_m, &y_m)) {
                    add_noisy_plot(x_m, 40.0 - half_m + off_m[2 * i], sigma_m);
                    add_noisy_plot(x_m, 40.0 + half_m + off_m[2 * i + 1], sigma_m);
                }
            }
            step_tracker_and_learning(k);
            for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
                const unsigned now = learning.lines[i].witnesses_for;
                most = now > most ? now : most;
            }
            assert_int_equal(count_walls(&wall), 0);
        }
        assert_true(most >= 8);
    }
}

/* Lanes 3.5 m apart beside a guard rail, with cars off the middle of their lanes. */
static void a_rail_beside_two_lanes_is_learned(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        double off_m[40];
        struct rho_reflector wall;
        prepare_tracker(seed);
        for (int i = 0; i < 40; i++) {
            off_m[i] = 0.3 * normal();
        }
        for (int k = 0; k < 2000; k++) {
            double x_m, y_m;
            for (int i = k / EVERY - DRIVE / EVERY; i <= k / EVERY; i++) {
                if (i >= 0 && car_place(i, k, &x_m, &y_m)) {
                    y_m = WALL_M - (i % 2 ? 5.0 : 8.5) + off_m[i];
                    add_noisy_plot(x_m, y_m, 0.5);
                    if (uniform(0.0, 1.0) < 0.7) {
                        add_noisy_plot(x_m, 2.0 * WALL_M - y_m, 0.5);
                    }
                }
            }
            step_tracker_and_learning(k);
        }
        assert_int_equal(count_walls(&wall), 1);
        expect_wall_at_40_m(&wall);
    }
}

/*
 * Eight cars abreast: four pairs mirror each other in one line, at four distances, and no pair
 * comes later.
 */
static void a_formation_is_not_taken_for_a_wall(void **state)
{
    struct rho_reflector wall;
    unsigned most = 0;
    (void)state;
    prepare_tracker(4);
    for (int k = 0; k < 600; k++) {
        for (int i = 0; i < 8; i++) {
            add_noisy_plot(12.0 * STEP_S * k - 300.0, 60.0 + 10.0 * i, 0.5);
        }
        step_tracker_and_learning(k);
        for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
            most = learning.lines[i].witnesses_for > most ? learning.lines[i].witnesses_for : most;
        }
        assert_int_equal(count_walls(&wall), 0);
    }
    assert_true(most >= 4);
}

/* Cars on both sides of the radar that mirror one another, lane by lane: what a wall would show. */
static void a_line_through_the_radar_is_not_taken_for_a_wall(void **state)
{
    struct rho_reflector wall;
    struct rho_sensor radar = {.sensor_id = SENSOR, .pd = 0.9f, .range_max_m = 1e3f};
    unsigned most = 0;
    (void)state;
    prepare_tracker(4);
    radar.y_m = (float)WALL_M;
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    for (int k = 0; k < 1500; k++) {
        add_traffic_plots(k, 0.9);
        step_tracker_and_learning(k);
        for (unsigned i = 0; i < RHO_LEARNED_REFLECTORS; i++) {
            most = learning.lines[i].witnesses_for > most ? learning.lines[i].witnesses_for : most;
        }
        assert_int_equal(count_walls(&wall), 0);
    }
    assert_true(most >= 8);
}

static void a_car_behind_a_learned_wall_is_tracked(void **state)
{
    unsigned found = 0;
    (void)state;
    prepare_tracker(6);
    for (int k = 0; k < 1500; k++) {
        add_traffic_plots(k, 0.3);
        if (k >= 1200) { /* at the distance of images, but slower */
            add_noisy_plot(0.6 * (k - 1200) - 100.0, 55.0, 0.5);
        }
        step_tracker_and_learning(k);
        found += k >= 1230 && count_tracks_behind_wall() >= 1;
    }
    assert_int_equal(tracker.num_reflectors, 1);
    assert_true(found >= 255);
}

/*
 * One of the two configured walls is the one that images show; configured walls come first in the
 * list.
 */
static void configured_walls_stay_and_are_not_learned_again(void **state)
{
    static const struct rho_reflector told[] = {{-300.0f, -40.0f, 300.0f, -40.0f},
                                                {-300.0f, 40.0f, 300.0f, 40.0f}};
    (void)state;
    for (unsigned num_told = 1; num_told <= 2; num_told++) {
        struct rho_reflector wall;
        prepare_tracker(7);
        assert_int_equal(rho_tracker_set_reflectors(&tracker, told, num_told), RHO_OK);
        for (int k = 0; k < 1200; k++) {
            add_traffic_plots(k, 0.9);
            step_tracker_and_learning(k);
        }
        assert_int_equal(count_walls(&wall), 2 - num_told);
        assert_int_equal(tracker.num_reflectors, 2);
        assert_memory_equal(tracker.reflectors, told, num_told * sizeof told[0]);
        /* without configured walls a learned one remains */
        assert_int_equal(rho_tracker_set_reflectors(&tracker, NULL, 0), RHO_OK);
        step_tracker_and_learning(1200);
        assert_int_equal(tracker.num_reflectors, 2 - num_told);
    }
}

/* A configured wall in line with the learned one: with a gap between them both stay. */
static void a_wall_in_line_with_a_configured_one_is_learned_behind_a_gap(void **state)
{
    static const struct rho_reflector told[] = {{200.0f, 40.0f, 400.0f, 40.0f},
                                                {-200.0f, 40.0f, -400.0f, 40.0f},
                                                {-200.0f, 40.0f, 0.0f, 40.0f}};
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        struct rho_reflector wall;
        prepare_tracker(7);
        assert_int_equal(rho_tracker_set_reflectors(&tracker, &told[i], 1), RHO_OK);
        for (int k = 0; k < 1200; k++) {
            add_traffic_plots(k, 0.9);
            step_tracker_and_learning(k);
        }
        assert_int_equal(count_walls(&wall), i < 2); /* the third one covers half of the wall */
    }
}

/*
 * Before, one wall was learned; then one is configured: it goes first, and the learned one is kept.
 */
static void a_wall_configured_later_goes_first_and_learned_ones_stay(void **state)
{
    static const struct rho_reflector told = {-300.0f, -40.0f, 300.0f, -40.0f};
    struct rho_reflector wall;
    (void)state;
    prepare_tracker(7);
    for (int k = 0; k < 1200; k++) {
        add_traffic_plots(k, 0.9);
        step_tracker_and_learning(k);
    }
    assert_int_equal(count_walls(&wall), 1);
    assert_int_equal(tracker.num_reflectors, 1);
    assert_int_equal(rho_tracker_set_reflectors(&tracker, &told, 1), RHO_OK);
    step_tracker_and_learning(1200);
    assert_int_equal(tracker.num_reflectors, 2);
    assert_memory_equal(&tracker.reflectors[0], &told, sizeof told);
    assert_memory_equal(&tracker.reflectors[1], &wall, sizeof wall);
}

static void a_wall_that_is_gone_is_forgotten(void **state)
{
    struct rho_reflector wall;
    int k = 0;
    (void)state;
    prepare_tracker(8);
    for (; k < 900; k++) {
        add_traffic_plots(k, 0.3);
        step_tracker_and_learning(k);
    }
    assert_int_equal(tracker.num_reflectors, 1);
    for (; k < 4000; k++) {
        add_traffic_plots(k, 0.0);
        step_tracker_and_learning(k);
    }
    assert_int_equal(count_walls(&wall), 0);
    assert_int_equal(tracker.num_reflectors, 0);
}

/* A snapshot holds the learned walls, and another tracker goes on with them. */
static void a_snapshot_keeps_walls(void **state)
{
    static uint8_t image[sizeof learning + 256] __attribute__((aligned(8)));
    struct rho_snapshot_part part = {
        .kind = RHO_SNAPSHOT_REFLECTORS, .object = &learning, .size = sizeof learning};
    struct rho_reflector before, after;
    size_t size;
    (void)state;
    prepare_tracker(9);
    for (int k = 0; k < 900; k++) {
        add_traffic_plots(k, 0.3);
        step_tracker_and_learning(k);
    }
    assert_int_equal(count_walls(&before), 1);
    assert_int_equal(rho_snapshot_save(&part, 1, 0, image, sizeof image, &size), RHO_OK);
    prepare_tracker(9);
    assert_int_equal(rho_snapshot_load(&part, 1, image, size), RHO_OK);
    assert_int_equal(count_walls(&after), 1);
    assert_memory_equal(&before, &after, sizeof after);
    step_tracker_and_learning(901);
    assert_int_equal(tracker.num_reflectors, 1);
    learning.lines[2].slope = NAN;
    assert_int_equal(rho_snapshot_save(&part, 1, 0, image, sizeof image, &size), RHO_ERROR_STATE);
}

/* Expects unsound learning, restores the line, and expects a sound one. */
static void expect_unsound_then_restore(struct rho_learned_reflector *line,
                                        const struct rho_learned_reflector *good)
{
    assert_false(rho_reflector_learning_is_sound(&learning));
    *line = *good;
    assert_true(rho_reflector_learning_is_sound(&learning));
}

/* Each invalid value of a line, as a damaged snapshot may have it, is found. */
static void invalid_lines_are_found_unsound(void **state)
{
    struct rho_reflector wall;
    struct rho_learned_reflector *line = &learning.lines[0];
    (void)state;
    prepare_tracker(9);
    for (int k = 0; k < 900; k++) {
        add_traffic_plots(k, 0.3);
        step_tracker_and_learning(k);
    }
    while (!line->is_used) {
        line++;
    }
    assert_int_equal(count_walls(&wall), 1);
    const struct rho_learned_reflector good = *line;
    line->cos_along = line->sin_along = 0.0f; /* a direction of no length */
    expect_unsound_then_restore(line, &good);
    line->cos_along = line->sin_along = 1.0f;
    expect_unsound_then_restore(line, &good);
    line->variance[0] = -1.0f;
    expect_unsound_then_restore(line, &good);
    line->variance[2] = -1e-6f;
    expect_unsound_then_restore(line, &good);
    line->variance[1] = 1.0f;
    expect_unsound_then_restore(line, &good);
    line->variance[1] = NAN;
    expect_unsound_then_restore(line, &good);
    line->from_m = line->to_m + 1.0f;
    expect_unsound_then_restore(line, &good);
    line->offset_m = RHO_LIMIT_POSITION_M;
    line->x_m = RHO_LIMIT_POSITION_M;
    line->y_m = RHO_LIMIT_POSITION_M;
    expect_unsound_then_restore(line, &good);
    line->distance_m2 = NAN;
    expect_unsound_then_restore(line, &good);
    line->off_m2 = -1.0f;
    expect_unsound_then_restore(line, &good);
    line->witnesses[1].off_m = NAN;
    expect_unsound_then_restore(line, &good);
    line->is_used = 2;
    expect_unsound_then_restore(line, &good);
    line->is_taken = 0;
    expect_unsound_then_restore(line, &good);
}

static void an_old_scan_teaches_nothing(void **state)
{
    struct rho_reflector_learning before;
    (void)state;
    config.late_max_s = 10.0f;
    prepare_tracker(2);
    for (int k = 0; k < 120; k++) {
        add_traffic_plots(k, 0.9);
        step_tracker_and_learning(k);
    }
    before = learning;
    add_traffic_plots(115, 0.9);
    step_tracker_and_learning(115);
    assert_memory_equal(&before, &learning, sizeof learning);
}

static void calls_with_invalid_arguments_change_nothing(void **state)
{
    struct rho_reflector_learning before;
    struct rho_reflector wall = {0};
    struct rho_scan scan = {.sensor_id = SENSOR};
    struct rho_tracker *none = NULL;
    (void)state;
    assert_int_equal(rho_reflector_learning_init(NULL, sizeof learning), RHO_ERROR_NULL);
    assert_int_equal(rho_reflector_learning_init(&learning, 3), RHO_ERROR_SIZE);
    prepare_tracker(1);
    step_tracker_and_learning(0);
    before = learning;
    assert_int_equal(rho_reflector_learning_step(NULL, &tracker, &scan, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_reflector_learning_step(&learning, none, &scan, &report), RHO_ERROR_NULL);
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, NULL, &report),
                     RHO_ERROR_NULL);
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, NULL), RHO_ERROR_NULL);
    scan.num_plots = 1;
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, &report),
                     RHO_ERROR_NULL);
    scan = (struct rho_scan){.time_us = 5};
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, &report),
                     RHO_ERROR_VALUE);
    assert_int_equal(rho_reflector_learning_wall(&learning, 0, &wall), 0);
    assert_int_equal(rho_reflector_learning_wall(NULL, 0, &wall), 0);
    assert_int_equal(rho_reflector_learning_wall(&learning, RHO_LEARNED_REFLECTORS, &wall), 0);
    assert_memory_equal(&before, &learning, sizeof learning);
    learning.magic = 0;
    scan.time_us = 0;
    assert_int_equal(rho_reflector_learning_step(&learning, &tracker, &scan, &report),
                     RHO_ERROR_STATE);
    assert_false(rho_reflector_learning_is_sound(&learning));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_is_learned_from_the_images_of_passing_cars),
        cmocka_unit_test(a_wall_is_learned_if_bodies_may_be_35_m_long),
        cmocka_unit_test(walls_on_both_sides_are_learned),
        cmocka_unit_test(without_images_nothing_is_learned),
        cmocka_unit_test(cars_in_two_lanes_are_not_taken_for_a_wall),
        cmocka_unit_test(a_rail_beside_two_lanes_is_learned),
        cmocka_unit_test(a_formation_is_not_taken_for_a_wall),
        cmocka_unit_test(a_line_through_the_radar_is_not_taken_for_a_wall),
        cmocka_unit_test(a_car_behind_a_learned_wall_is_tracked),
        cmocka_unit_test(configured_walls_stay_and_are_not_learned_again),
        cmocka_unit_test(a_wall_in_line_with_a_configured_one_is_learned_behind_a_gap),
        cmocka_unit_test(a_wall_configured_later_goes_first_and_learned_ones_stay),
        cmocka_unit_test(a_wall_that_is_gone_is_forgotten),
        cmocka_unit_test(a_snapshot_keeps_walls),
        cmocka_unit_test(invalid_lines_are_found_unsound),
        cmocka_unit_test(an_old_scan_teaches_nothing),
        cmocka_unit_test(calls_with_invalid_arguments_change_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
