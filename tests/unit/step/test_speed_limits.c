/* SPDX-License-Identifier: MIT */
/*
 * Speeds that no target has end a track: a tenth above v_max, known that well, in three updates in
 * a row. A track surely below v_min ends at once; that track is made by hand, with the private
 * header.
 */
#include "../../src/step/phases.h"
#include "tracker_setup.h"

#define V_MAX_MPS 100.0

/* Scans with plots of a target at this speed until its track ends; 0: it does not end. */
static int scans_until_too_fast(double speed_mps, double sigma_m)
{
    use_usual_configs(1);
    config.gate = RHO_TRACKER_NEAREST;
    config.v_max_mps = (float)V_MAX_MPS;
    config.accel_max_mps2 = 0.5f;
    begin_tracker();
    for (int k = 0; k < 60; k++) {
        const double slow_mps = 0.9 * V_MAX_MPS, late_s = k > 30 ? 2.0 * (k - 30) : 0.0;
        add_plot(5000.0 + slow_mps * 2.0 * k + (speed_mps - slow_mps) * late_s, 0.0, sigma_m);
        step_at(2.0 * k);
        if (tracker.counters.tracks_too_fast > 0) {
            return k - 30;
        }
    }
    assert_int_equal(report.num_tracks, 1);
    return 0;
}

static void tracks_a_tenth_faster_than_v_max_end(void **state)
{
    (void)state;
    assert_int_equal(scans_until_too_fast(1.06 * V_MAX_MPS, 2.0), 0);
    /* the filter needs four scans to follow; two more make three in a row */
    assert_int_equal(scans_until_too_fast(1.2 * V_MAX_MPS, 2.0), 7);
    /* with 80 m noise, two sigmas of the speed must first fall below an eighth */
    assert_int_equal(scans_until_too_fast(1.25 * V_MAX_MPS, 80.0), 15);
}

/* The limit is three sigmas of 1 m/s below 30 m/s. */
static void tracks_surely_slower_than_v_min_end(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        use_usual_configs(1);
        config.v_min_mps = 30.0f;
        begin_tracker();
        struct rho_track *track = &tracker.tracks[0];
        struct step at = {.tracker = &tracker,
                          .report = &report,
                          .look = {
                              .tracker = &tracker,
                              .fates = report.fates,
                              .teaches = 1,
                          }};
        *track = (struct rho_track){.track_id = 1,
                                    .status = RHO_TRACK_CONFIRMED,
                                    .hits = 20,
                                    .plot = -1,
                                    .was_confirmed = 1,
                                    .visible = 1.0f};
        tracker.num_tracks = 1;
        track->kalman.state[RHO_VX] = i ? 27.1f : 26.9f;
        for (int axis = 0; axis < 2; axis++) {
            track->kalman.covariance[RHO_AT(axis, axis)] = 100.0f;
            track->kalman.covariance[RHO_AT(3 + axis, 3 + axis)] = 1.0f;
        }
        rho_removal_of_track(&at, track);
        assert_int_equal(track->status, i ? RHO_TRACK_CONFIRMED : RHO_TRACK_FREE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tracks_a_tenth_faster_than_v_max_end),
        cmocka_unit_test(tracks_surely_slower_than_v_min_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
