/* SPDX-License-Identifier: MIT */
/*
 * Bearings of sensors that look at times and from places of their own: a frame of each scan, and
 * sensors that move or stand together.
 */
#include "bearing_frame_chain.h"

#define RUNS 20u
#define FRAMES 20u
#define SQUARES_MAX 6.0 /* of errors by their covariance, mean: 4 where it is correct */

/* Sums over runs. */
struct looks_figures {
    unsigned rows, found_early;
    double nees;
};

static void fly_looks(int is_in_turn, unsigned k)
{
    if (is_in_turn) {
        fly_sensors_in_turn(k, 10.0);
    } else {
        fly_frame(k, 10.0);
    }
}

/*
 * Steps all frames, or their scans in turn. Expects one track of each target, which keeps its
 * number to the end.
 */
static void fly_and_add_figures(int is_in_turn, struct looks_figures *figures)
{
    const unsigned targets = scene.targets;
    start_chain(5.0f);
    for (unsigned k = 0; k < FRAMES; k++) {
        fly_looks(is_in_turn, k);
        assert_true(report.num_tracks <= targets);
        figures->found_early += k == BATCH - 1 && report.num_tracks == targets;
    }
    assert_int_equal(report.num_tracks, targets);
    assert_int_equal(tracker.counters.tracks_started, targets);
    assert_int_equal(tracker.counters.tracks_ended, 0);
    const double time_s = (double)report.time_us * 1e-6;
    for (unsigned i = 0; i < targets; i++) {
        const struct target *target = &scene.target[i];
        const struct rho_track_report *track = track_nearest_to(target, time_s);
        const double truth[4] = {target_x_m(target, time_s), target_y_m(target, time_s),
                                 target->vx_mps, target->vy_mps};
        assert_non_null(track);
        figures->nees += nees_of(track, truth);
        figures->rows++;
    }
}

static void expect_covariances_and_starts(const char *name, const struct looks_figures *figures,
                                          unsigned runs)
{
    print_message("%s: %u of %u runs within a batch, NEES %.2f\n", name, figures->found_early, runs,
                  figures->nees / figures->rows);
    assert_true(figures->found_early * 10 >= runs * 9);
    assert_true(figures->nees / figures->rows < SQUARES_MAX);
}

/* Of 600 runs all keep the numbers of tracks, and 578 begin them with the third look. */
static void sensors_that_look_in_turn_start_and_keep_tracks(void **state)
{
    (void)state;
    for (unsigned sensors = 2; sensors <= 3; sensors++) {
        for (unsigned targets = 1; targets <= 2; targets++) {
            struct looks_figures figures = {0};
            for (unsigned seed = 1; seed <= RUNS; seed++) {
                random_state = seed;
                scene = scene_of(sensors, targets, 0.1, 1.0, 0.0);
                for (unsigned i = 0; i < targets; i++) {
                    scene.target[i] = random_target(10.0 * FRAMES);
                }
                fly_and_add_figures(1, &figures);
            }
            expect_covariances_and_starts("in turn", &figures, RUNS);
        }
    }
}

/* A row of looks is searched with its last: the track is there before the fourth row begins. */
static void the_third_look_of_the_last_sensor_starts_the_track(void **state)
{
    (void)state;
    random_state = 3;
    scene = scene_of(3, 1, 0.1, 1.0, 0.0);
    scene.target[0] = random_target(10.0 * FRAMES);
    start_chain(5.0f);
    for (unsigned k = 0; k < ROWS_MIN; k++) {
        assert_int_equal(report.num_tracks * (k > 0), 0);
        fly_sensors_in_turn(k, 10.0);
        assert_int_equal(passive.batch.num_scans, k + 1);
        assert_int_equal(passive.batch.is_whole, 1);
    }
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
    assert_int_equal(tracker.counters.plots_initiated, 3 * ROWS_MIN);
    assert_int_equal(count_bearings_of_track_in_batch(1), 3 * ROWS_MIN);
}

static void moving_sensors_start_and_keep_tracks(void **state)
{
    (void)state;
    for (int is_in_turn = 0; is_in_turn < 2; is_in_turn++) {
        struct looks_figures figures = {0};
        for (unsigned seed = 1; seed <= RUNS; seed++) {
            random_state = seed;
            scene = scene_of(2, 1, 0.1, 0.95, 0.2);
            scene.target[0] = random_target(10.0 * FRAMES);
            scene.sensor_vx_mps[0] = scene.sensor_vx_mps[1] = 20.0;
            scene.sensor_vy_mps[0] = 30.0;
            scene.sensor_vy_mps[1] = -20.0;
            fly_and_add_figures(is_in_turn, &figures);
        }
        expect_covariances_and_starts(is_in_turn ? "moving, in turn" : "moving", &figures, RUNS);
    }
}

/* The third sensor stands where the second does: both see the same, and the first crosses both. */
static void sensors_at_one_place_support_each_other(void **state)
{
    (void)state;
    struct looks_figures figures = {0};
    for (unsigned seed = 1; seed <= RUNS; seed++) {
        random_state = seed;
        scene = scene_of(3, 2, 0.1, 0.95, 0.2);
        scene.sensor_x_m[2] = scene.sensor_x_m[1];
        scene.sensor_y_m[2] = scene.sensor_y_m[1];
        for (unsigned i = 0; i < 2; i++) {
            scene.target[i] = random_target(10.0 * FRAMES);
        }
        fly_and_add_figures(0, &figures);
    }
    expect_covariances_and_starts("two at one place", &figures, RUNS);
}

static void sensors_at_one_place_alone_start_no_track(void **state)
{
    (void)state;
    for (int is_in_turn = 0; is_in_turn < 2; is_in_turn++) {
        random_state = 4;
        scene = scene_of(2, 2, 0.1, 1.0, 1.0);
        scene.sensor_y_m[0] = scene.sensor_y_m[1];
        for (unsigned i = 0; i < 2; i++) {
            scene.target[i] = random_target(10.0 * FRAMES);
        }
        start_chain(5.0f);
        for (unsigned k = 0; k < FRAMES; k++) {
            fly_looks(is_in_turn, k);
        }
        assert_int_equal(tracker.counters.tracks_started, 0);
        assert_int_equal(tracker.counters.fates[RHO_FATE_GHOST], 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sensors_that_look_in_turn_start_and_keep_tracks),
        cmocka_unit_test(the_third_look_of_the_last_sensor_starts_the_track),
        cmocka_unit_test(moving_sensors_start_and_keep_tracks),
        cmocka_unit_test(sensors_at_one_place_support_each_other),
        cmocka_unit_test(sensors_at_one_place_alone_start_no_track),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
