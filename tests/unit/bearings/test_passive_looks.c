/* SPDX-License-Identifier: MIT */
/*
 * Tracks from bearings of looks that have times and places of their own: sensors that look in turn,
 * that move, that stand together, and as many as there may be.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "true_association.h"

/* Sensors look one after the other, this far apart, each scan in a frame of its own. */
static void look_in_turn(struct scene *from, double apart_s)
{
    from->has_single_scans = 1;
    for (unsigned s = 0; s < from->sensors; s++) {
        from->offset_s[s] = apart_s * s;
    }
}

static void expect_good_figures(const char *what, const struct scene *from, unsigned runs)
{
    struct figures figures = figures_of_scenes(from, runs);
    print_figures(what, &figures);
    assert_true(found_share(&figures) >= 0.98);
    assert_true(ghosts_a_run(&figures) <= 0.04);
    assert_true(error_ratio(&figures) <= 1.08);
    assert_in_range((int)(100.0 * figures.nees / figures.found), 340, 480);
}

static void sensors_that_look_in_turn_find_the_targets(void **state)
{
    (void)state;
    struct scene from = scene_of(2, 2, 0.1, 1.0, 0.0);
    random_state = 21;
    look_in_turn(&from, 5.0);
    expect_good_figures("2 sensors in turn", &from, 100);
    from = scene_of(3, 3, 0.1, 0.9, 1.0);
    look_in_turn(&from, 3.3);
    expect_good_figures("3 sensors in turn, P_D 0.9, 1 false", &from, 60);
}

/* The scans of a frame have their own times, which need not be those of the frame. */
static void scans_of_a_frame_have_their_own_times(void **state)
{
    (void)state;
    struct scene from = scene_of(3, 3, 0.05, 0.9, 1.0);
    random_state = 22;
    from.offset_s[0] = 2.5;
    from.offset_s[1] = -1.5;
    expect_good_figures("times in a frame", &from, 60);
}

/* The track nearest to a target of the last search at time_s; NULL: none within a kilometre. */
static const struct rho_passive_track *track_of(const struct target *truth, double time_s)
{
    const struct rho_passive_track *nearest = NULL;
    double least_m = 1000.0;
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        double off_m = hypot((double)passive.tracks[i].x_m - target_x_m(truth, time_s),
                             (double)passive.tracks[i].y_m - target_y_m(truth, time_s));
        if (off_m < least_m) {
            least_m = off_m;
            nearest = &passive.tracks[i];
        }
    }
    return nearest;
}

static void expect_within_errors(double a, double b, double variance_a, double variance_b)
{
    assert_true(fabs(a - b) < 4.0 * sqrt(variance_a + variance_b));
}

/* Looks of 2.5 s apart and looks of one time, of the same targets; the states are 5 s apart. */
static void looks_in_turn_give_the_tracks_of_looks_of_one_time(void **state)
{
    (void)state;
    for (unsigned run = 0; run < 20; run++) {
        struct scene from = scene_of(3, 1, 0.05, 1.0, 0.0);
        draw_seeded_scene(&from, 500 + run);
        search_into(&passive);
        assert_int_equal(passive.num_tracks, 1);
        const struct rho_passive_track of_one_time = passive.tracks[0];
        look_in_turn(&scene, 2.5);
        see_all_looks(&scene);
        search_into(&passive);
        assert_int_equal(passive.batch.newest_us, 75000000);
        assert_int_equal(passive.batch.num_scans, 8);
        assert_int_equal(passive.num_tracks, 1);
        assert_non_null(track_of(&scene.target[0], 75.0));
        const struct rho_passive_track *in_turn = &passive.tracks[0];
        assert_int_equal(in_turn->hits, 24);
        assert_int_equal(in_turn->scans, 0xff);
        expect_within_errors(in_turn->x_m, of_one_time.x_m + 5.0 * of_one_time.vx_mps,
                             in_turn->covariance[0], of_one_time.covariance[0]);
        expect_within_errors(in_turn->y_m, of_one_time.y_m + 5.0 * of_one_time.vy_mps,
                             in_turn->covariance[2], of_one_time.covariance[2]);
        expect_within_errors(in_turn->vx_mps, of_one_time.vx_mps, in_turn->covariance[5],
                             of_one_time.covariance[5]);
        expect_within_errors(in_turn->vy_mps, of_one_time.vy_mps, in_turn->covariance[9],
                             of_one_time.covariance[9]);
    }
}

/* Sensors that fly past each other, 250 m/s, and a slow one. */
static struct scene moving_sensors(unsigned sensors, unsigned targets, double pd,
                                   double false_bearings)
{
    struct scene from = scene_of(sensors, targets, 0.1, pd, false_bearings);
    from.sensor_vx_mps[0] = 150.0;
    from.sensor_vy_mps[0] = 200.0;
    from.sensor_vx_mps[1] = -150.0;
    from.sensor_vy_mps[1] = -200.0;
    from.sensor_vy_mps[2] = -20.0;
    return from;
}

static void sensors_that_move_find_the_targets(void **state)
{
    (void)state;
    struct scene from = moving_sensors(2, 2, 1.0, 0.0);
    from.sensor_y_m[0] = -20e3;
    from.sensor_y_m[1] = 20e3;
    random_state = 23;
    expect_good_figures("2 sensors move", &from, 100);
    look_in_turn(&from, 5.0);
    expect_good_figures("2 sensors move, in turn", &from, 100);
    from = moving_sensors(3, 3, 0.9, 1.0);
    look_in_turn(&from, 3.3);
    expect_good_figures("3 sensors move, in turn", &from, 60);
}

/* The batch has the newest place of each sensor, and the place of each look. */
static void each_look_keeps_its_place(void **state)
{
    (void)state;
    struct scene from = moving_sensors(3, 1, 1.0, 0.0);
    look_in_turn(&from, 3.0);
    draw_seeded_scene(&from, 24);
    search_into(&passive);
    for (unsigned s = 0; s < 3; s++) {
        for (unsigned k = 0; k < 8; k++) {
            const struct rho_batch_look *look = &passive.batch.looks[k][s];
            assert_int_equal(look->offset_us, 3000000 * s);
            assert_true(look->x_m == (float)look_x_m(&scene, k, s));
            assert_true(look->y_m == (float)look_y_m(&scene, k, s));
        }
        assert_true(passive.batch.sensors[s].x_m == (float)look_x_m(&scene, 7, s));
        assert_true(passive.batch.sensors[s].y_m == (float)look_y_m(&scene, 7, s));
    }
}

static void put_at_place_of(struct scene *from, unsigned sensor, unsigned other)
{
    from->sensor_x_m[sensor] = from->sensor_x_m[other];
    from->sensor_y_m[sensor] = from->sensor_y_m[other];
}

/* Sensors 0 and 1 at one place, and the others elsewhere. */
static void sensors_at_one_place_find_targets_with_others_elsewhere(void **state)
{
    (void)state;
    const unsigned sensors = RHO_MAX_PASSIVE_SENSORS < 4 ? RHO_MAX_PASSIVE_SENSORS : 4;
    struct scene from = scene_of(sensors, 3, 0.1, 0.9, 1.0);
    random_state = 25;
    put_at_place_of(&from, 1, 0);
    expect_good_figures("2 sensors at one place", &from, 60);
    from.sensor_x_m[1] += 0.5; /* nearer than any base of crossings */
    expect_good_figures("2 sensors half a metre apart", &from, 60);
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        unsigned hits[SCENE_SENSORS] = {0};
        for (unsigned k = 0; k < scene.scans; k++) {
            for (unsigned s = 0; s < sensors; s++) {
                hits[s] += passive.tracks[i].claim[k][s] > 0;
            }
        }
        assert_true(hits[0] > 0 && hits[1] > 0 && hits[2] > 0);
    }
}

static void one_place_alone_starts_nothing(void **state)
{
    (void)state;
    for (unsigned sensors = 2; sensors <= 3; sensors++) {
        for (unsigned run = 0; run < 10; run++) {
            struct scene from = scene_of(sensors, 2, 0.1, 1.0, 1.0);
            for (unsigned s = 1; s < sensors; s++) {
                put_at_place_of(&from, s, 0);
            }
            from.sensor_y_m[1] += run % 2 ? 0.9 : 0.0;
            draw_seeded_scene(&from, 600 + run);
            search_into(&passive);
            assert_int_equal(passive.batch.num_sensors, sensors);
            assert_int_equal(passive.work.crossings, 0);
            assert_int_equal(passive.num_tracks, 0);
        }
    }
}

static void as_many_sensors_as_there_may_be_find_the_targets(void **state)
{
    (void)state;
    struct scene from = scene_of(RHO_MAX_PASSIVE_SENSORS, 4, 0.1, 0.9, 1.0);
    random_state = 26;
    expect_good_figures("all sensors", &from, 25);
    look_in_turn(&from, 1.2);
    expect_good_figures("all sensors in turn", &from, 25);
    assert_int_equal(passive.batch.num_sensors, RHO_MAX_PASSIVE_SENSORS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sensors_that_look_in_turn_find_the_targets),
        cmocka_unit_test(scans_of_a_frame_have_their_own_times),
        cmocka_unit_test(looks_in_turn_give_the_tracks_of_looks_of_one_time),
        cmocka_unit_test(sensors_that_move_find_the_targets),
        cmocka_unit_test(each_look_keeps_its_place),
        cmocka_unit_test(sensors_at_one_place_find_targets_with_others_elsewhere),
        cmocka_unit_test(one_place_alone_starts_nothing),
        cmocka_unit_test(as_many_sensors_as_there_may_be_find_the_targets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
