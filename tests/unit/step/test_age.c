/* SPDX-License-Identifier: MIT */
/*
 * Speeds that no target has end a track: a tenth beyond v_max, where the speed is known that well,
 * in three updates in a row.
 */
#include "tracker_setup.h"

#define V_MAX_MPS 100.0

/* Scans with a plot of a target that is so fast until its track ends; 0: it does not. */
static int scans_until_too_fast(double speed_mps, double sigma_m)
{
    draw(1);
    config.gate = RHO_TRACKER_NEAREST;
    config.v_max_mps = (float)V_MAX_MPS;
    config.accel_max_mps2 = 0.5f;
    begin();
    for (int k = 0; k < 60; k++) {
        const double slow_mps = 0.9 * V_MAX_MPS, late_s = k > 30 ? 2.0 * (k - 30) : 0.0;
        add(5000.0 + slow_mps * 2.0 * k + (speed_mps - slow_mps) * late_s, 0.0, sigma_m);
        step(2.0 * k);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_tenth_beyond_the_fastest_is_no_target),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
