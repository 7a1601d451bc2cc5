/* SPDX-License-Identifier: MIT */
/*
 * One bearing, two tracks. A radar tracks two boats in line with a camera at the origin, which sees
 * them as one: its looks end neither track, and keep none alive.
 */
#include "../tracker_setup.h"

#define LOOKS 8

static void look_from_camera(double t_s)
{
    const struct rho_bearing bearing = {.bearing_rad = 0.0f, .sigma_rad = 0.01f};
    const struct rho_bearing_scan scan = {
        .time_us = llround(t_s * 1e6), .sensor_id = 2, .num_bearings = 1, .bearings = &bearing};
    assert_int_equal(rho_tracker_step_bearings(&tracker, NULL, &scan, &report), RHO_OK);
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
}

/* Boats in line or side by side, and the camera's eight looks. Gets the changes of the scores. */
static void look_at_two_boats(int are_in_line, double change_nat[2])
{
    float before_nat[2];
    use_usual_configs(5);
    config.v_max_mps = initiation.v_max_mps = 20.0f;
    config.v_min_mps = initiation.v_min_mps = 0.0f;
    config.accel_max_mps2 = 0.5f;
    begin_tracker();
    for (int t_s = 0; t_s < 16; t_s++) {
        add_noisy_plot(200.0 + 4.0 * t_s, 0.0, 2.0);
        add_noisy_plot(400.0 + 4.0 * t_s, are_in_line ? 0.0 : 200.0, 2.0);
        step_at(t_s);
    }
    assert_int_equal(report.num_tracks, 2);
    for (int i = 0; i < 2; i++) {
        before_nat[i] = report.tracks[i].score_nat;
    }
    for (int k = 0; k < LOOKS; k++) {
        look_from_camera(15.1 + 0.1 * k);
    }
    assert_int_equal(report.num_tracks, 2);
    for (int i = 0; i < 2; i++) {
        change_nat[i] = (double)report.tracks[i].score_nat - (double)before_nat[i];
    }
}

/* Of two tracks that a bearing may be of the first one took it, and the other counted a miss. */
static void a_bearing_of_two_tracks_is_no_evidence(void **state)
{
    double change_nat[2];
    (void)state;
    look_at_two_boats(1, change_nat);
    print_message("in line: %.1f and %.1f nat\n", change_nat[0], change_nat[1]);
    for (int i = 0; i < 2; i++) {
        assert_true(change_nat[i] > -0.2 * LOOKS && change_nat[i] < LOOKS);
    }
}

static void a_bearing_of_one_track_is_evidence(void **state)
{
    double change_nat[2];
    (void)state;
    look_at_two_boats(0, change_nat);
    print_message("apart: %.1f and %.1f nat\n", change_nat[0], change_nat[1]);
    assert_true(fmax(change_nat[0], change_nat[1]) > 2.0 * LOOKS);
    assert_true(fmin(change_nat[0], change_nat[1]) < -0.2 * LOOKS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_bearing_of_two_tracks_is_no_evidence),
        cmocka_unit_test(a_bearing_of_one_track_is_evidence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
