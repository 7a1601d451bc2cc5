/* SPDX-License-Identifier: MIT */
/*
 * Margins of tracks from bearings: how much better they score than any other explanation. For
 * sensors at (0, +-b) and targets at (x, +-y) the ghosts are on the x axis at x b / (b + y) and x b
 * / (b - y). If y is constant and x changes evenly the ghosts move evenly, too, and cannot be told
 * from targets.
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
#define START_MNAT 4605 /* a ratio of a hundred to one, which the tracker requires */

static void set_scene(unsigned sensors, unsigned targets, double first_target_vy_mps)
{
    scene = scene_of(sensors, targets, 0.1, 1.0, 0.0);
    scene.target[0] = (struct target){60e3, 3e3, -200.0, first_target_vy_mps};
    scene.target[1] = (struct target){60e3, -3e3, -200.0, 0.0};
    scene.target[2] = (struct target){40e3, 30e3, -100.0, -250.0};
    set_scan_times(&scene);
}

static double final_error_m(const struct rho_passive_track *track, const struct target *target)
{
    double end_s = scene_span_s(&scene);
    return hypot(track->x_m - target_x_m(target, end_s), track->y_m - target_y_m(target, end_s));
}

/* The track within 1.5 km of a target; NULL: none. */
static const struct rho_passive_track *track_of_target(unsigned target)
{
    for (unsigned i = 0; i < passive.num_tracks; i++) {
        if (final_error_m(&passive.tracks[i], &scene.target[target]) < 1500.0) {
            return &passive.tracks[i];
        }
    }
    return NULL;
}

static void draw_and_search(void)
{
    see_all_looks(&scene);
    assert_int_equal(search_scene(&passive, &scene), RHO_OK);
    assert_true(are_tracks_finite_with_right_claims(&passive));
}

static void test_two_targets_and_their_two_ghosts_have_next_to_no_margin(void **state)
{
    (void)state;
    random_state = 41;
    set_scene(2, 2, 0.0);
    unsigned kept = 0;
    for (int run = 0; run < RUNS; run++) {
        draw_and_search();
        assert_int_equal(passive.num_tracks, 2);
        for (unsigned i = 0; i < 2; i++) {
            assert_in_range(passive.tracks[i].margin_mnat, 0, 8000);
            kept += passive.tracks[i].margin_mnat >= START_MNAT;
        }
    }
    assert_in_range(kept, 0, 2);
}

/* In each run both targets are found and have a large margin. */
static void expect_clear_targets(void)
{
    for (int run = 0; run < RUNS; run++) {
        draw_and_search();
        assert_int_equal(passive.num_tracks, 2);
        for (unsigned i = 0; i < 2; i++) {
            assert_non_null(track_of_target(i));
            assert_true(passive.tracks[i].margin_mnat > 20000);
        }
    }
}

static void test_targets_whose_ghosts_accelerate_have_a_large_margin(void **state)
{
    (void)state;
    random_state = 42;
    set_scene(2, 2, 100.0);
    expect_clear_targets();
}

static void test_a_third_sensor_gives_targets_a_large_margin(void **state)
{
    (void)state;
    random_state = 43;
    set_scene(3, 2, 0.0);
    expect_clear_targets();
}

static void test_an_unambiguous_target_has_a_large_margin_beside_ambiguous_ones(void **state)
{
    (void)state;
    random_state = 44;
    set_scene(2, 3, 0.0);
    for (int run = 0; run < RUNS; run++) {
        draw_and_search();
        assert_int_equal(passive.num_tracks, 3);
        const struct rho_passive_track *clear = track_of_target(2);
        assert_non_null(clear);
        assert_true(clear->margin_mnat > 20000);
        for (unsigned i = 0; i < 3; i++) {
            assert_true(&passive.tracks[i] == clear || passive.tracks[i].margin_mnat <= 8000);
        }
    }
}

/* The only other explanation of a single track is no track: its margin is its score. */
static void test_the_margin_of_a_lone_target_is_its_score(void **state)
{
    (void)state;
    random_state = 45;
    set_scene(2, 1, 0.0);
    for (int run = 0; run < RUNS; run++) {
        draw_and_search();
        assert_int_equal(passive.num_tracks, 1);
        assert_in_range(passive.tracks[0].margin_mnat, passive.tracks[0].score_mnat - 2,
                        passive.tracks[0].score_mnat + 2); /* rounding of float */
    }
}

static unsigned started_after(unsigned frames)
{
    start_chain(5.0f);
    fly_frames(0, frames, 10.0);
    return tracker.counters.tracks_started;
}

static void test_the_tracker_starts_no_track_that_ghosts_explain_as_well(void **state)
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
        cmocka_unit_test(test_targets_whose_ghosts_accelerate_have_a_large_margin),
        cmocka_unit_test(test_a_third_sensor_gives_targets_a_large_margin),
        cmocka_unit_test(test_an_unambiguous_target_has_a_large_margin_beside_ambiguous_ones),
        cmocka_unit_test(test_the_margin_of_a_lone_target_is_its_score),
        cmocka_unit_test(test_the_tracker_starts_no_track_that_ghosts_explain_as_well),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
