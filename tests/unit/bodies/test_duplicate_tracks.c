/* SPDX-License-Identifier: MIT */
/*
 * Of two tracks of one target the younger ends. At the limits both are made by hand, which takes
 * the private header.
 */
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#if RHO_BODIES

#define LONGEST_M 10.0f

static struct step at;

/* One that drives east at 10 m/s, 4 m long and 2 m wide. */
static void have_track(unsigned row, float x_m, float y_m, unsigned hits)
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

/* Two tracks, and a plot of the older one for which the younger contends. */
static void have_two(float x_m, float y_m, unsigned hits)
{
    struct rho_groups *groups = &tracker.bodies.groups;
    use_usual_configs(1);
    begin_tracker();
    assert_int_equal(rho_tracker_set_body_max(&tracker, LONGEST_M), RHO_OK);
    have_track(0, 100.0f, 0.0f, hits);
    have_track(1, 100.0f + x_m, y_m, hits);
    tracker.num_tracks = tracker.bodies.count = 2;
    memset(groups, 0xff, sizeof *groups);
    groups->owner[0] = 0;
    groups->contender[0] = 1;
    groups->owner[1] = 1;
    at = (struct step){.tracker = &tracker, .report = &report, .num_gated = 2, .in_view = {3}};
    memset(&report, 0, sizeof report);
}

/* Scans until the younger track ends; 0: not within a hundred. */
static unsigned scans_to_end(void)
{
    for (unsigned scan = 1; scan <= 100; scan++) {
        at.time_us = 50000 * (int64_t)scan;
        rho_tracker_end_duplicate_tracks(&at);
        if (tracker.tracks[1].status == RHO_TRACK_FREE) {
            assert_int_equal(tracker.tracks[0].status, RHO_TRACK_CONFIRMED);
            assert_int_equal(tracker.bodies.groups.owner[1], 0); /* the older one has its plots */
            return scan;
        }
    }
    return 0;
}

static void the_younger_of_two_on_each_other_ends(void **state)
{
    (void)state;
    have_two(0.0f, 0.0f, 1000);
    assert_int_equal(scans_to_end(), 38);
    have_two(0.0f, 0.0f, 1000);
    tracker.bodies.groups.owner[0] = 1; /* whose plot it is does not matter */
    tracker.bodies.groups.contender[0] = 0;
    assert_int_equal(scans_to_end(), 38);
    have_two(0.0f, 0.0f, 1000);
    tracker.bodies.groups.contender[0] = RHO_NO_ROW; /* no plot says so */
    assert_int_equal(scans_to_end(), 0);
    for (unsigned row = 0; row < 2; row++) { /* nor does a heading */
        have_two(0.0f, 0.0f, 1000);
        tracker.bodies.of[row].has_heading = 0;
        assert_int_equal(scans_to_end(), 0);
    }
    have_two(0.0f, 0.0f, 1000);
    at.is_late = 1;
    assert_int_equal(scans_to_end(), 0);
}

/* Both contend for each other's plots; the older one, near its own end, goes on. */
static void the_older_is_not_ended_by_itself(void **state)
{
    (void)state;
    have_two(0.0f, 0.0f, 1000);
    tracker.bodies.groups.contender[1] = 0;
    tracker.bodies.of[0].doubt.doubled = 30.9f;
    tracker.bodies.of[1].doubt.doubled = 30.9f;
    assert_int_equal(scans_to_end(), 1);
    assert_float_equal(tracker.bodies.of[0].doubt.doubled, 30.9 * (1.0 - 1.0 / 80.0), 1e-3);
}

/* Every other scan is enough: 80 are remembered. One of four is not. */
static void what_lasts_counts(void **state)
{
    (void)state;
    for (unsigned every = 2; every <= 4; every += 2) {
        have_two(0.0f, 0.0f, 1000);
        for (unsigned scan = 1; scan <= 400; scan++) {
            at.time_us = 50000 * (int64_t)scan;
            tracker.bodies.groups.contender[0] = scan % every ? RHO_NO_ROW : 1;
            rho_tracker_end_duplicate_tracks(&at);
        }
        assert_int_equal(tracker.tracks[1].status == RHO_TRACK_FREE, every == 2);
    }
}

/* A quarter of both lengths and widths: 2 m and 1 m. */
static void half_of_each_lies_on_the_other(void **state)
{
    (void)state;
    const struct {
        float x_m, y_m;
        int ends;
    } cases[] = {{1.95f, 0.0f, 1}, {2.05f, 0.0f, 0},  {-1.95f, 0.0f, 1}, {-2.05f, 0.0f, 0},
                 {0.0f, 0.95f, 1}, {0.0f, -1.05f, 0}, {1.9f, 0.9f, 1},   {0.0f, 1.05f, 0}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        have_two(cases[i].x_m, cases[i].y_m, 1000);
        assert_int_equal(scans_to_end() > 0, cases[i].ends);
    }
}

/* Velocities of one target differ by four sigmas of both: 0.8 m/s, each sigma 0.1 m/s. */
static void those_that_pass_each_other_stay(void **state)
{
    (void)state;
    have_two(0.0f, 0.0f, 1000);
    tracker.tracks[1].kalman.state[RHO_VX] = 10.75f;
    assert_int_equal(scans_to_end(), 38);
    have_two(0.0f, 0.0f, 1000);
    tracker.tracks[1].kalman.state[RHO_VX] = 10.85f;
    assert_int_equal(scans_to_end(), 0);
}

/* Half and 0.15 of the longest, less a sigma of both places across. */
static void of_new_tracks_nearer_to_each_other_than_a_body_one_ends(void **state)
{
    (void)state;
    const struct {
        float x_m, y_m;
        unsigned hits;
        int ends;
    } cases[] = {{4.9f, 0.0f, 10, 1},  {5.1f, 0.0f, 10, 0}, {0.0f, 1.25f, 10, 1},
                 {0.0f, 1.35f, 10, 0}, {4.9f, 0.0f, 19, 1}, {4.9f, 0.0f, 20, 0}};
    for (unsigned i = 0; i < sizeof cases / sizeof *cases; i++) {
        have_two(cases[i].x_m, cases[i].y_m, cases[i].hits);
        assert_int_equal(scans_to_end() == 1, cases[i].ends);
    }
    have_two(4.0f, 0.0f, 10); /* the one with more hits goes on */
    tracker.tracks[0].hits = 9;
    rho_tracker_end_duplicate_tracks(&at);
    assert_int_equal(tracker.tracks[0].status, RHO_TRACK_FREE);
    assert_int_equal(tracker.tracks[1].status, RHO_TRACK_CONFIRMED);
    for (int is_near = 0; is_near < 2; is_near++) { /* north-east */
        const float along_m = is_near ? 4.9f : 5.1f, c = 0.70710678f;
        have_two(c * along_m, c * along_m, 10);
        for (int row = 0; row < 2; row++) {
            tracker.tracks[row].kalman.state[RHO_VX] = tracker.tracks[row].kalman.state[RHO_VY] =
                7.0f;
            tracker.bodies.of[row].cos_heading = tracker.bodies.of[row].sin_heading = c;
        }
        assert_int_equal(scans_to_end() == 1, is_near);
    }
    have_two(4.0f, 1.4f, 10); /* a heading that is off by 0.1 rad turns the line by 0.8 m */
    tracker.bodies.of[0].heading_sigma_rad = 0.1f;
    assert_int_equal(scans_to_end(), 1);
    have_two(4.0f, 1.4f, 10);
    tracker.bodies.of[0].has_heading = 0;
    assert_int_equal(scans_to_end(), 0);
}

/* ---- seen ------------------------------------------------------------------------------------ */

/* A truck that is there at once has started two tracks in one of ten runs. */
static void a_truck_that_appears_has_one_track(void **state)
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
        cmocka_unit_test(the_younger_of_two_on_each_other_ends),
        cmocka_unit_test(the_older_is_not_ended_by_itself),
        cmocka_unit_test(what_lasts_counts),
        cmocka_unit_test(half_of_each_lies_on_the_other),
        cmocka_unit_test(those_that_pass_each_other_stay),
        cmocka_unit_test(of_new_tracks_nearer_to_each_other_than_a_body_one_ends),
        cmocka_unit_test(a_truck_that_appears_has_one_track),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
