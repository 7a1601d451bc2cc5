/* SPDX-License-Identifier: MIT */
/*
 * Second plots of one target: one track, once they are known; targets that fly together or separate
 * keep or get their own.
 */
#include "tracker_setup.h"

#define TARGETS 6
#define SIGMA_M 20.0
#define SPEED_MPS 150.0
#define TURN_S 4.0

static void begin_turns(uint64_t seed)
{
    draw(seed);
    initiation.scans = 7;
    initiation.min_scans = 0;
    initiation.false_tracks_per_hour = 1.0f;
    config.accel_max_mps2 = 20.0f;
    begin();
}

/* Its plot, P_D .9; and with `second` a chance of another one up to 6 sigmas off on each axis. */
static void see(double x_m, double y_m, double second)
{
    const int is_seen = uniform(0.0, 1.0) < 0.9, is_second = uniform(0.0, 1.0) < second;
    const double dx_m = SIGMA_M * normal(), dy_m = SIGMA_M * normal();
    if (!is_seen) {
        return;
    }
    (void)add(x_m + dx_m, y_m + dy_m, SIGMA_M);
    if (is_second) {
        const double off_m = uniform(-6.0, 6.0) * SIGMA_M, more_m = SIGMA_M * normal();
        (void)add(x_m + off_m + more_m, y_m + uniform(-6.0, 6.0) * SIGMA_M, SIGMA_M);
    }
}

static void see_clutter(void)
{
    for (int i = 0; i < 10; i++) {
        const double x_m = uniform(-40000.0, 80000.0);
        (void)add(x_m, uniform(-40000.0, 80000.0), SIGMA_M);
    }
}

/* Targets far from each other, on parallel lines. */
static void see_targets(int k, double second)
{
    for (int i = 0; i < TARGETS; i++) {
        see(-30000.0 + SPEED_MPS * TURN_S * k, 8000.0 * i, second);
    }
}

static int num_near(double x_m, double y_m, double far_m)
{
    int num = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        num += track->status != RHO_TRACK_TENTATIVE &&
               hypot((double)track->state[0] - x_m, (double)track->state[1] - y_m) < far_m;
    }
    return num;
}

#if RHO_MAX_ECHOES > 0

static float rate(void)
{
    const struct rho_second_plots *table = &tracker.second_plots[0];
    return table->looks > 0.0f ? table->plots / table->looks : 0.0f;
}

static void one_target_has_one_track(void **state)
{
    (void)state;
    int others = 0, switches = 0;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        begin_turns(seed);
        for (int k = 0; k < 120; k++) {
            see_targets(k, 0.3);
            see_clutter();
            step(TURN_S * k);
            for (int i = 0; i < TARGETS && k >= 30; i++) {
                const int num = num_near(-30000.0 + SPEED_MPS * TURN_S * k, 8000.0 * i, 1000.0);
                others += num > 1 ? num - 1 : 0;
                switches += num == 0;
            }
        }
        assert_float_equal(rate(), 0.3f, 0.1f);
    }
    /* of 2700 */
    assert_in_range(others, 0, 350);
    assert_in_range(switches, 0, 40);
}

static void without_second_plots_none_are_expected(void **state)
{
    (void)state;
    begin_turns(1);
    for (int k = 0; k < 120; k++) {
        see_targets(k, 0.0);
        see_clutter();
        step(TURN_S * k);
    }
    assert_float_equal(rate(), 0.0f, 0.01f);
}

/* 12 sigmas apart, among targets with second plots up to 6: two tracks. */
static void two_abreast_keep_two_tracks(void **state)
{
    (void)state;
    int both = 0;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        begin_turns(seed);
        for (int k = 0; k < 120; k++) {
            const double x_m = -30000.0 + SPEED_MPS * TURN_S * k;
            see_targets(k, 0.3);
            see(x_m, -8000.0, 0.0);
            see(x_m, -8000.0 - 12.0 * SIGMA_M, 0.0);
            see_clutter();
            step(TURN_S * k);
            both += k >= 20 && num_near(x_m, -8000.0, 1000.0) >= 2;
        }
    }
    assert_in_range(both, 294, 300);
}

/*
 * 60 m/s faster from scan 60 on: 12 sigmas apart after one scan; two tracks four scans after that
 * in most runs.
 */
static void one_that_separates_gets_a_track(void **state)
{
    (void)state;
    int found = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        begin_turns(seed);
        for (int k = 0; k <= 65; k++) {
            const double x_m = -30000.0 + SPEED_MPS * TURN_S * k;
            see_targets(k, 0.3);
            if (k > 60) {
                see(x_m + 60.0 * TURN_S * (k - 60), 0.0, 0.3);
            }
            see_clutter();
            step(TURN_S * k);
        }
        found += num_near(-30000.0 + SPEED_MPS * TURN_S * 65, 0.0, 1500.0) >= 2;
    }
    assert_in_range(found, 7, 10);
}

#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
#if RHO_MAX_ECHOES > 0
        cmocka_unit_test(one_target_has_one_track),
        cmocka_unit_test(without_second_plots_none_are_expected),
        cmocka_unit_test(two_abreast_keep_two_tracks),
        cmocka_unit_test(one_that_separates_gets_a_track),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
