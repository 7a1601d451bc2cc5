/* SPDX-License-Identifier: MIT */
/*
 * Speeds that no target has end a track: a tenth beyond v_max, where the speed is known that well,
 * in three updates in a row. One that is surely too slow ends at once, which is tried with a track
 * that is made by hand: that takes the private header.
 */
#include "../../src/step/phases.h"
#include "tracker_setup.h"

#define V_MAX_MPS 100.0

/* Scans with a plot of a target that is so fast until its track ends; 0: it does not. */
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

static void a_tenth_beyond_the_fastest_is_no_target(void **state)
{
    (void)state;
    assert_int_equal(scans_until_too_fast(1.06 * V_MAX_MPS, 2.0), 0);
    /* the filter follows in four; two more are the third in a row */
    assert_int_equal(scans_until_too_fast(1.2 * V_MAX_MPS, 2.0), 7);
    /* with 80 m of noise the speed must be known within an eighth first, for two sigmas */
    assert_int_equal(scans_until_too_fast(1.25 * V_MAX_MPS, 80.0), 15);
}

/* Three sigmas of 1 m/s below 30 m/s. */
static void what_is_surely_too_slow_is_no_target(void **state)
{
    const struct rho_track_limits limits = {.tentative_mnat = -100000,
                                            .fall_mnat = 100000,
                                            .doubt_mnat = 90000,
                                            .misses_in_row_max = 9};
    (void)state;
    for (int i = 0; i < 2; i++) {
        use_usual_configs(1);
        config.v_min_mps = 30.0f;
        begin_tracker();
        struct rho_track *track = &tracker.tracks[0];
        struct step at = {.tracker = &tracker, .report = &report};
        *track = (struct rho_track){.track_id = 1,
                                    .status = RHO_TRACK_CONFIRMED,
                                    .hits = 20,
                                    .plot = -1,
                                    .was_confirmed = 1};
        tracker.num_tracks = 1;
        track->kalman.state[RHO_VX] = i ? 27.1f : 26.9f;
        for (int axis = 0; axis < 2; axis++) {
            track->kalman.covariance[RHO_AT(axis, axis)] = 100.0f;
            track->kalman.covariance[RHO_AT(3 + axis, 3 + axis)] = 1.0f;
        }
        rho_tracker_confirm_or_end_track(&at, track, 0, &limits);
        assert_int_equal(track->status, i ? RHO_TRACK_CONFIRMED : RHO_TRACK_FREE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tenth_beyond_the_fastest_is_no_target),
        cmocka_unit_test(what_is_surely_too_slow_is_no_target),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
