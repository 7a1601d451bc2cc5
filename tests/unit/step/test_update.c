/* SPDX-License-Identifier: MIT */
/*
 * A car that stops at once, while it is missed now and then: where targets may stand, the track
 * goes on where it stands.
 */
#include "rhotrack/tracker.h"
#include "tracker_setup.h"

/* Tracks of a car at 12 m/s that stops after 60 scans, and stands for 60; 1: the first one's. */
static uint32_t track_of_stopped_car(uint64_t seed, float v_min_mps, float accel_max_mps2)
{
    use_usual_configs(seed);
    rho_initiator_config_default(&initiation);
    config.v_max_mps = initiation.v_max_mps = 70.0f;
    config.v_min_mps = initiation.v_min_mps = v_min_mps;
    config.accel_max_mps2 = accel_max_mps2;
    begin_tracker();
    for (int k = 0; k < 120; k++) {
        /* two scans behind the stop the car is missed, and then seen again */
        if (k != 61 && k != 62 && uniform(0.0, 1.0) < 0.9) {
            add_noisy_plot(60.0 - 12.0 * 0.05 * (k < 60 ? k : 60), 20.0, 0.2);
        }
        add_plot(uniform(-150.0, 150.0), 100.0, 0.2);
        step_at(0.05 * k);
    }
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if (fabs((double)report.tracks[i].state[0] - 24.0) < 2.0 &&
            fabs((double)report.tracks[i].state[1] - 20.0) < 2.0) {
            return report.tracks[i].track_id;
        }
    }
    return 0;
}

static void a_car_that_stops_at_once_keeps_its_track(void **state)
{
    int kept = 0, lost = 0;
    (void)state;
    if (!RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES)) {
        skip();
    }
    for (uint64_t seed = 1; seed <= 40; seed++) {
        kept += track_of_stopped_car(seed, 0.0f, 10.0f) == 1;
        /* it cannot stop that hard, in 2 s at 5 m/s^2 */
        lost += track_of_stopped_car(seed, 0.0f, 5.0f) != 1;
    }
    assert_int_equal(kept, 40);
    assert_true(lost > 20);
    /* nor where what is slow is no target */
    assert_int_not_equal(track_of_stopped_car(1, 1.0f, 10.0f), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_car_that_stops_at_once_keeps_its_track),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
