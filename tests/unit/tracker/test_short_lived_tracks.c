/* SPDX-License-Identifier: MIT */
/*
 * Where tracks end early, a new one is confirmed only when it is seen as targets are; elsewhere at
 * once.
 */
#include "tracker_setup.h"

#define SIGMA_M 20.0
#define SPEED_MPS 150.0
#define TURN_S 4.0
#define TARGETS 4 /* targets, seen all the time */

static int turn;

static void begin_turns(void)
{
    begin_by_rate(20);
    turn = 0;
}

/* Clutter, and targets that fly far from all else. */
static void see_sky(void)
{
    for (int i = 0; i < 10; i++) {
        const double x_m = uniform(-40000.0, 80000.0);
        (void)add(x_m, uniform(-60000.0, 60000.0), SIGMA_M);
    }
    for (int i = 0; i < TARGETS; i++) {
        add_noisy(-30000.0 + SPEED_MPS * TURN_S * (turn % 100), 40000.0 + 5000.0 * i, SIGMA_M);
    }
}

static void take_turn(void)
{
    see_sky();
    step(TURN_S * turn++);
}

/*
 * Something that moves as a target does and is seen `hits` times in a row, then no more for ten
 * turns. Returns the turns in which it was reported as confirmed or coasting.
 */
static int show(double x_m, double y_m, int hits)
{
    int reported = 0;
    for (int k = 0; k < hits + 10; k++) {
        const double at_m = x_m + SPEED_MPS * TURN_S * k;
        if (k < hits) {
            add_noisy(at_m, y_m, SIGMA_M);
        }
        take_turn();
        for (unsigned i = 0; i < report.num_tracks; i++) {
            const struct rho_track_report *track = &report.tracks[i];
            reported +=
                track->status != RHO_TRACK_TENTATIVE &&
                hypot((double)track->state[0] - at_m, (double)track->state[1] - y_m) < 3000.0;
        }
    }
    return reported;
}

static double somewhere(int n)
{
    return -40000.0 + 7000.0 * (n % 10);
}

static void a_track_that_lasts_is_believed_at_its_third_plot(void **state)
{
    (void)state;
    begin_turns();
    for (int n = 0; n < 8; n++) {
        assert_true(show(-20000.0, somewhere(n), 20) >= 18);
    }
    assert_true(tracker.ended_early < 1.0f);
    assert_true(tracker.established > 8.0f);
}

static void a_few_deaths_are_chance(void **state)
{
    (void)state;
    begin_turns();
    for (int k = 0; k < 30; k++) {
        take_turn();
    }
    assert_true(show(-20000.0, -30000.0, 4) > 0);
    assert_true(show(-20000.0, -20000.0, 20) >= 18);
}

static void where_tracks_die_young_hits_are_counted(void **state)
{
    int first = 0, last = 0;
    (void)state;
    begin_turns();
    for (int k = 0; k < 30; k++) {
        take_turn();
    }
    for (int n = 0; n < 24; n++) {
        const int reported = show(-20000.0, somewhere(n), 4);
        first += n < 4 ? reported : 0;
        last += n >= 20 ? reported : 0;
    }
    assert_true(tracker.ended_early > 10.0f);
    assert_true(first > 8);    /* each for some turns */
    assert_int_equal(last, 0); /* none any more */
    const int reported = show(-20000.0, -30000.0, 20);
    assert_in_range(reported, 12, 17); /* a target is believed some turns later */
    for (int n = 0; n < 6; n++) {
        (void)show(-20000.0, somewhere(n), 20);
    }
    assert_true(tracker.established > 8.0f);
}

static void what_died_is_forgotten(void **state)
{
    (void)state;
    begin_turns();
    for (int n = 0; n < 12; n++) {
        (void)show(-20000.0, somewhere(n), 4);
    }
    assert_true(tracker.ended_early > 6.0f);
    for (int k = 0; k < 1200; k++) {
        take_turn();
    }
    assert_true(tracker.ended_early < 1.0f);
    assert_true(show(-20000.0, -30000.0, 20) >= 18);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_track_that_lasts_is_believed_at_its_third_plot),
        cmocka_unit_test(a_few_deaths_are_chance),
        cmocka_unit_test(where_tracks_die_young_hits_are_counted),
        cmocka_unit_test(what_died_is_forgotten),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
