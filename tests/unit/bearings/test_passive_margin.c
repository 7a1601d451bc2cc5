/* SPDX-License-Identifier: MIT */
/*
 * How much tracks of bearings are worth over any other explanation. Two sensors at (0, -b) and (0,
 * b), targets at (x, y) and (x, -y): the ghosts are at x b / (b + y) and x b / (b - y) on the axis
 * between the sensors. Where y stands still and x moves evenly they move evenly too, and nothing
 * tells them from the targets.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "bearing_frame_chain.h"

#define RUNS 20
#define START_MNAT 4605 /* a hundred to one: what the tracker asks for */

/* ---- scenes ---------------------------------------------------------------------------------- */

static void set_scene(unsigned sensors, unsigned targets, double away_mps)
{
    scene = scene_of(sensors, targets, 0.1, 1.0, 0.0);
    scene.target[0] = (struct target){60e3, 3e3, -200.0, away_mps};
    scene.target[1] = (struct target){60e3, -3e3, -200.0, 0.0};
    scene.target[2] = (struct target){40e3, 30e3, -100.0, -250.0};
    set_scan_times(&scene);
}

static double miss_m(const struct rho_passive_track *track, const struct target *target)
{
    double end_s = scene_span_s(&scene);
    return hypot(track->x_m - target_x_m(target, end_s), track->y_m - target_y_m(target, end_s));
}

/* The track within 1.5 km of a target, NULL where there is none. */
static const struct rho_passive_track *found_of(unsigned target)
{
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        if (miss_m(&passive.tracks[i], &scene.target[target]) < 1500.0) {
            return &passive.tracks[i];
        }
    }
    return NULL;
}

static void search_anew(void)
{
    see_all_looks(&scene);
    assert_int_equal(search_scene(&passive, &scene), RHO_OK);
    assert_true(are_tracks_sound(&passive));
}

/* ---- margins --------------------------------------------------------------------------------- */

static void test_two_targets_and_their_two_ghosts_have_next_to_no_margin(void **state)
{
    (void)state;
    random_state = 41;
    set_scene(2, 2, 0.0);
    unsigned kept = 0;
    for (int run = 0; run < RUNS; run++) {
        search_anew();
        assert_int_equal(passive.num_tracks, 2);
        for (unsigned i = 0; i < 2; i++) {
            assert_in_range(passive.tracks[i].margin_mnat, 0, 8000);
            kept += passive.tracks[i].margin_mnat >= START_MNAT;
        }
    }
    assert_in_range(kept, 0, 2);
}

/* Both are found, run after run, and nothing else explains their bearings. */
static void expect_clear_targets(void)
{
    for (int run = 0; run < RUNS; run++) {
        search_anew();
        assert_int_equal(passive.num_tracks, 2);
        for (unsigned i = 0; i < 2; i++) {
            assert_non_null(found_of(i));
            assert_true(passive.tracks[i].margin_mnat > 20000);
        }
    }
}

static void test_targets_whose_ghosts_turn_have_a_margin(void **state)
{
    (void)state;
    random_state = 42;
    set_scene(2, 2, 100.0);
    expect_clear_targets();
}

static void test_a_third_sensor_tells_targets_from_their_ghosts(void **state)
{
    (void)state;
    random_state = 43;
    set_scene(3, 2, 0.0);
    expect_clear_targets();
}

static void test_a_clear_target_has_its_own_margin(void **state)
{
    (void)state;
    random_state = 44;
    set_scene(2, 3, 0.0);
    for (int run = 0; run < RUNS; run++) {
        search_anew();
        assert_int_equal(passive.num_tracks, 3);
        const struct rho_passive_track *clear = found_of(2);
        assert_non_null(clear);
        assert_true(clear->margin_mnat > 20000);
        for (unsigned i = 0; i < 3; i++) {
            assert_true(&passive.tracks[i] == clear || passive.tracks[i].margin_mnat <= 8000);
        }
    }
}

/* A track alone is worth its score over none. */
static void test_the_margin_of_a_lone_target_is_its_score(void **state)
{
    (void)state;
    random_state = 45;
    set_scene(2, 1, 0.0);
    for (int run = 0; run < RUNS; run++) {
        search_anew();
        assert_int_equal(passive.num_tracks, 1);
        assert_in_range(passive.tracks[0].margin_mnat, passive.tracks[0].score_mnat - 2,
                        passive.tracks[0].score_mnat + 2); /* float32 */
    }
}

/* ---- the tracker ----------------------------------------------------------------------------- */

static unsigned started_after(unsigned frames)
{
    start_chain(5.0f);
    fly_frames(0, frames, 10.0);
    return tracker.counters.tracks_started;
}

static void test_the_tracker_waits_where_ghosts_are_as_good(void **state)
{
    (void)state;
    random_state = 46;
    set_scene(2, 2, 0.0);
    assert_int_equal(started_after(BATCH + 2), 0);
    set_scene(2, 2, 100.0);
    assert_int_equal(started_after(BATCH), 2);
    set_scene(3, 2, 0.0);
    assert_int_equal(started_after(BATCH), 2);
    set_scene(2, 3, 0.0);
    assert_int_equal(started_after(BATCH), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_two_targets_and_their_two_ghosts_have_next_to_no_margin),
        cmocka_unit_test(test_targets_whose_ghosts_turn_have_a_margin),
        cmocka_unit_test(test_a_third_sensor_tells_targets_from_their_ghosts),
        cmocka_unit_test(test_a_clear_target_has_its_own_margin),
        cmocka_unit_test(test_the_margin_of_a_lone_target_is_its_score),
        cmocka_unit_test(test_the_tracker_waits_where_ghosts_are_as_good),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
