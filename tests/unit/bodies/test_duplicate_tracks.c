/* SPDX-License-Identifier: MIT */
/*
 * Of two tracks on one target the younger ends. For the limits both tracks are made by hand, with
 * the private header.
 */
#include "../../src/bodies/bodies.h"
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#if RHO_BODIES

#define LONGEST_M 10.0f

static struct step at;

/* A track that drives east at 10 m/s, with a body 4 m long and 2 m wide. */
static void make_track_with_body(unsigned row, float x_m, float y_m, unsigned hits)
{
    struct rho_track *track = &tracker.tracks[row];
    *track = (struct rho_track){
        .track_id = row + 1u, .status = RHO_TRACK_CONFIRMED, .hits = (uint16_t)hits, .plot = -1};
    track->kalman.state[RHO_X] = x_m;
    track->kalman.state[RHO_Y] = y_m;
    track->kalman.state[RHO_VX] = 10.0f;
    for (int i = 0; i < 2; i++) {
        track->kalman.covariance[RHO_AT(i, i)] = 0.01f;
        track->kalman.covariance[RHO_AT(3 + i, 3 + i)] = 0.01f;
    }
    tracker.bodies.of[row] = (struct rho_body_filter){.track_id = row + 1u,
                                                      .along_m2 = 16.0f / 12.0f,
                                                      .across_m2 = 4.0f / 12.0f,
                                                      .cos_heading = 1.0f,
                                                      .has_heading = 1,
                                                      .plots = 100.0f};
}

/* Two tracks, and a plot owned by the older one for which the younger contends. */
static void make_two_tracks(float x_m, float y_m, unsigned hits)
{
    struct rho_groups *groups = &tracker.bodies.groups;
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, LONGEST_M), RHO_OK);
    make_track_with_body(0, 100.0f, 0.0f, hits);
    make_track_with_body(1, 100.0f + x_m, y_m, hits);
    tracker.num_tracks = tracker.bodies.count = 2;
    memset(groups, 0xff, sizeof *groups);
    groups->owner[0] = 0;
    groups->contender[0] = 1;
    groups->owner[1] = 1;
    at = (struct step){.tracker = &tracker,
                       .report = &report,
                       .look = {.tracker = &tracker,
                                .fates = report.fates,
                                .teaches = 1,
                                .num_gated = 2,
                                .in_view = {3}}};
    memset(&report, 0, sizeof report);
}

/* Scans until the younger track ends; 0: not within a hundred scans. */
static unsigned scans_until_younger_ends(void)
{
    for (unsigned scan = 1; scan <= 100; scan++) {
        at.look.time_us = 50000 * (int64_t)scan;
        rho_bodies_end_duplicates(&at);
        if (tracker.tracks[1].status == RHO_TRACK_FREE) {
            assert_int_equal(tracker.tracks[0].status, RHO_TRACK_CONFIRMED);
            /* the older track takes over the plots */
            assert_int_equal(tracker.bodies.groups.owner[1], 0);
            return scan;
        }
    }
    return 0;
}

static void the_younger_of_two_overlapping_tracks_ends(void **state)
{
    (void)state;
    make_two_tracks(0.0f, 0.0f, 1000);
    assert_int_equal(scans_until_younger_ends(), 38);
    make_two_tracks(0.0f, 0.0f, 1000);
    /* the younger owns the plot, the older contends: the same result */
    tracker.bodies.groups.owner[0] = 1;
    tracker.bodies.groups.contender[0] = 0;
    assert_int_equal(scans_until_younger_ends(), 38);
    make_two_tracks(0.0f, 0.0f, 1000);
    tracker.bodies.groups.contender[0] = RHO_NO_ROW; /* no plot has two contenders */
    assert_int_equal(scans_until_younger_ends(), 0);
    for (unsigned row = 0; row < 2; row++) { /* no heading is known */
        make_two_tracks(0.0f, 0.0f, 1000);
        tracker.bodies.of[row].has_heading = 0;
        assert_int_equal(scans_until_younger_ends(), 0);
    }
    make_two_tracks(0.0f, 0.0f, 1000);
    at.look.teaches = 0;
    assert_int_equal(scans_until_younger_ends(), 0);
}

/*
 * Both tracks contend for each other's plots, and the older one is near its own end: it still goes
 * on.
 */
static void the_older_of_two_overlapping_tracks_stays(void **state)
{
    (void)state;
    make_two_tracks(0.0f, 0.0f, 1000);
    tracker.bodies.groups.contender[1] = 0;
    tracker.bodies.of[0].doubt.doubled = 30.9f;
    tracker.bodies.of[1].doubt.doubled = 30.9f;
    assert_int_equal(scans_until_younger_ends(), 1);
    assert_float_equal(tracker.bodies.of[0].doubt.doubled, 30.9 * (1.0 - 1.0 / 80.0), 1e-3);
}

/* Overlap in every second scan is enough, as 80 scans are remembered; in every fourth it is not. */
static void overlap_must_last_for_enough_scans(void **state)
{
    (void)state;
    for (unsigned every = 2; every <= 4; every += 2) {
        make_two_tracks(0.0f, 0.0f, 1000);
        for (unsigned scan = 1; scan <= 400; scan++) {
            at.look.time_us = 50000 * (int64_t)scan;
            tracker.bodies.groups.contender[0] = scan % every ? RHO_NO_ROW : 1;
            rho_bodies_end_duplicates(&at);
        }
        assert_int_equal(tracker.tracks[1].status == RHO_TRACK_FREE, every == 2);
    }
}

/* The middles may be half of the mean length and width apart: 2 m and 1 m. */
static void a_duplicate_ends_only_if_bodies_overlap_by_half(void **state)
{
    (void)state;
    const struct {
        float x_m, y_m;
        int ends;
    } cases[] = {{1.95f, 0.0f, 1}, {2.05f, 0.0f, 0},  {-1.95f, 0.0f, 1}, {-2.05f, 0.0f, 0},
                 {0.0f, 0.95f, 1}, {0.0f, -1.05f, 0}, {1.9f, 0.9f, 1},   {0.0f, 1.05f, 0}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        make_two_tracks(cases[i].x_m, cases[i].y_m, 1000);
        assert_int_equal(scans_until_younger_ends() > 0, cases[i].ends);
    }
}

/*
 * Velocities of one target differ by four sigmas of both at most: 0.8 m/s if each sigma is 0.1 m/s.
 */
static void tracks_of_different_velocity_stay(void **state)
{
    (void)state;
    make_two_tracks(0.0f, 0.0f, 1000);
    tracker.tracks[1].kalman.state[RHO_VX] = 10.75f;
    assert_int_equal(scans_until_younger_ends(), 38);
    make_two_tracks(0.0f, 0.0f, 1000);
    tracker.tracks[1].kalman.state[RHO_VX] = 10.85f;
    assert_int_equal(scans_until_younger_ends(), 0);
}

/* Half and 0.15 of the longest body, less a sigma of both places across. */
static void of_two_new_tracks_within_half_a_body_one_ends(void **state)
{
    (void)state;
    const struct {
        float x_m, y_m;
        unsigned hits;
        int ends;
    } cases[] = {{4.9f, 0.0f, 10, 1},  {5.1f, 0.0f, 10, 0}, {0.0f, 1.25f, 10, 1},
                 {0.0f, 1.35f, 10, 0}, {4.9f, 0.0f, 19, 1}, {4.9f, 0.0f, 20, 0}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        make_two_tracks(cases[i].x_m, cases[i].y_m, cases[i].hits);
        assert_int_equal(scans_until_younger_ends() == 1, cases[i].ends);
    }
    make_two_tracks(4.0f, 0.0f, 10); /* the track with more hits goes on */
    tracker.tracks[0].hits = 9;
    rho_bodies_end_duplicates(&at);
    assert_int_equal(tracker.tracks[0].status, RHO_TRACK_FREE);
    assert_int_equal(tracker.tracks[1].status, RHO_TRACK_CONFIRMED);
    for (int is_near = 0; is_near < 2; is_near++) { /* both head north-east */
        const float along_m = is_near ? 4.9f : 5.1f, c = 0.70710678f;
        make_two_tracks(c * along_m, c * along_m, 10);
        for (int row = 0; row < 2; row++) {
            tracker.tracks[row].kalman.state[RHO_VX] = tracker.tracks[row].kalman.state[RHO_VY] =
                7.0f;
            tracker.bodies.of[row].cos_heading = tracker.bodies.of[row].sin_heading = c;
        }
        assert_int_equal(scans_until_younger_ends() == 1, is_near);
    }
    /* a heading off by 0.1 rad shifts the other track's place across by 0.8 m */
    make_two_tracks(4.0f, 1.4f, 10);
    tracker.bodies.of[0].heading_sigma_rad = 0.1f;
    assert_int_equal(scans_until_younger_ends(), 1);
    make_two_tracks(4.0f, 1.4f, 10);
    tracker.bodies.of[0].has_heading = 0;
    assert_int_equal(scans_until_younger_ends(), 0);
}

/* ---- in a scene ------------------------------------------------------------------------------ */

/* Without this rule, a truck that appears suddenly starts two tracks in one of ten runs. */
static void a_suddenly_appearing_truck_has_one_track(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 20; seed++) {
        use_usual_configs(seed);
        config.v_max_mps = initiation.v_max_mps = 50.0f;
        begin_tracker();
        assert_int_equal(rho_tracker_set_body_max(&tracker, 15.0f), RHO_OK);
        for (int k = 0; k < 80; k++) {
            for (int i = 0; i < 8; i++) {
                if (uniform(0.0, 1.0) < 0.6) {
                    add_noisy_plot(40.0 + 0.25 * k + 1.6 * i, i % 2 ? 1.25 : -1.25, 0.3);
                }
            }
            step_at(0.05 * k);
        }
        assert_int_equal(report.num_tracks, 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_younger_of_two_overlapping_tracks_ends),
        cmocka_unit_test(the_older_of_two_overlapping_tracks_stays),
        cmocka_unit_test(overlap_must_last_for_enough_scans),
        cmocka_unit_test(a_duplicate_ends_only_if_bodies_overlap_by_half),
        cmocka_unit_test(tracks_of_different_velocity_stay),
        cmocka_unit_test(of_two_new_tracks_within_half_a_body_one_ends),
        cmocka_unit_test(a_suddenly_appearing_truck_has_one_track),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
