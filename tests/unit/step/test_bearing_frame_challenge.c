/* SPDX-License-Identifier: MIT */
/* Tracks of bearings are challenged: ghosts that were tracked give way to the targets. */
#include "bearing_frame_chain.h"

#define FRAMES 20u
#define THIRD_FROM 8u /* frame from which on the third sensor sees */

static void keep_bearings_of(struct look *look, int target)
{
    unsigned kept = 0;
    for (unsigned i = 0; i < look->count; i++) {
        if (look->target[i] == target) {
            look->bearings[kept] = look->bearings[i];
            look->target[kept++] = target;
        }
    }
    look->count = kept;
}

/*
 * Two targets side by side, whose ghosts fly as straight. At first each of two sensors sees another
 * target, so that the ghost between them starts as a track; then the two see both targets, which
 * agrees with two ghosts as well as with the targets; at last a third sensor sees the targets.
 */
static void fly_ghost_frame(unsigned k)
{
    see_frame(k, 10.0 * k);
    struct look *look = scene.look[scene_slot_of(k)];
    for (unsigned s = 0; k < 4 && s < 2; s++) {
        keep_bearings_of(&look[s], (int)s);
    }
    look[2].is_absent = k < THIRD_FROM;
    fill_frame(&scene, scene_slot_of(k), &full);
    step_frame(&full.frame);
}

static void start_with_ghosts(unsigned seed)
{
    random_state = seed;
    scene = scene_of(3, 2, 0.1, 1.0, 0.0);
    for (unsigned i = 0; i < 2; i++) {
        scene.target[i] = (struct target){.x_m = 50e3, .y_m = i > 0 ? -4e3 : 4e3, .vx_mps = -150.0};
    }
    start_chain(5.0f);
}

static int has_ended(uint32_t track_id)
{
    unsigned i = 0;
    while (i < report.num_ended && report.ended[i] != track_id) {
        i++;
    }
    return i < report.num_ended;
}

static int is_within(uint32_t value, uint32_t from, uint32_t to)
{
    return value >= from && value <= to;
}

/* One ghost's number goes on with a target, the other's ends, the other target has a new one. */
static void a_pair_of_ghosts_gives_way_to_the_targets(void **state)
{
    (void)state;
    for (unsigned seed = 1; seed <= 20; seed++) {
        unsigned exchanged = 0;
        start_with_ghosts(seed);
        for (unsigned k = 0; k < FRAMES; k++) {
            fly_ghost_frame(k);
            if (k >= ROWS_MIN - 1 && k < THIRD_FROM) {
                assert_true(report.num_tracks >= 1);
                assert_int_equal(report.tracks[0].track_id, 1);
                assert_true(fabsf(report.tracks[0].state[1]) < 1000.0f); /* between the targets */
            }
            /* bearings start a track once, though a found track takes those of others */
            assert_int_equal(tracker.counters.fates[RHO_FATE_HELD] +
                                 tracker.counters.fates[RHO_FATE_GHOST],
                             tracker.counters.plots_initiated + tracker.counters.plots_clutter +
                                 count_bearings_of_track_in_batch(0));
            if (report.num_ended == 0) {
                continue;
            }
            exchanged++;
            assert_int_equal(report.num_ended, 1);
            assert_int_equal(report.num_tracks, 2);
            const uint32_t kept_id = report.tracks[0].track_id;
            assert_true(is_within(kept_id, 1, 2));
            assert_true(has_ended(3 - kept_id));
            assert_int_equal(report.tracks[1].track_id, 3);
            /* the kept track goes on as a found one does: confirmed, and with the batch's hits */
            for (unsigned i = 0; i < 2; i++) {
                assert_int_equal(report.tracks[i].status, RHO_TRACK_CONFIRMED);
                assert_true(report.tracks[i].hits <= scene.sensors * BATCH);
                assert_true(count_bearings_of_track_in_batch(report.tracks[i].track_id) > BATCH);
            }
            assert_int_equal(count_bearings_of_track_in_batch(3 - kept_id), 0);
        }
        assert_int_equal(exchanged, 1);
        assert_int_equal(report.num_tracks, 2);
        assert_int_equal(tracker.counters.tracks_started, 3);
        assert_int_equal(tracker.counters.tracks_ended, 1);
        const double time_s = 10.0 * (FRAMES - 1);
        for (unsigned i = 0; i < 2; i++) {
            const struct rho_track_report *track = track_nearest_to(&scene.target[i], time_s);
            assert_non_null(track);
            assert_true(track_error_m(track, &scene.target[i], time_s) <
                        5.0 * (double)track->sigma_m);
        }
        assert_ptr_not_equal(track_nearest_to(&scene.target[0], time_s),
                             track_nearest_to(&scene.target[1], time_s));
    }
}

/* A track that an operator vouches for is not challenged, though the bearings speak for others. */
static void an_operators_track_is_not_challenged(void **state)
{
    (void)state;
    start_with_ghosts(1);
    for (unsigned k = 0; k < FRAMES; k++) {
        fly_ghost_frame(k);
        assert_int_equal(has_ended(1), 0);
        if (k == THIRD_FROM - 1) {
            assert_int_equal(tracker.tracks[0].track_id, 1);
            tracker.tracks[0].is_operators = 1;
        }
        if (k >= ROWS_MIN - 1) {
            assert_non_null(track_with_id(1));
        }
    }
    assert_true(fabsf(track_with_id(1)->state[1]) < 1000.0f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pair_of_ghosts_gives_way_to_the_targets),
        cmocka_unit_test(an_operators_track_is_not_challenged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
