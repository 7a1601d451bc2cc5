/* SPDX-License-Identifier: MIT */
/*
 * Where tracks end early, a new one is confirmed only when it is seen as targets are; elsewhere at
 * once. The figures are those of tracks that are made by hand, which takes the private header.
 */
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define SIGMA_M 20.0
#define SPEED_MPS 150.0
#define TURN_S 4.0
#define TARGETS 4 /* targets, seen all the time */

static int turn;

static void begin_turns(void)
{
    begin_tracker_by_rate(20);
    turn = 0;
}

/* Clutter, and targets that fly far from all else. */
static void see_sky(void)
{
    for (int i = 0; i < 10; i++) {
        const double x_m = uniform(-40000.0, 80000.0);
        (void)add_plot(x_m, uniform(-60000.0, 60000.0), SIGMA_M);
    }
    for (int i = 0; i < TARGETS; i++) {
        add_noisy_plot(-30000.0 + SPEED_MPS * TURN_S * (turn % 100), 40000.0 + 5000.0 * i, SIGMA_M);
    }
}

static void take_turn(void)
{
    see_sky();
    step_at(TURN_S * turn++);
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
            add_noisy_plot(at_m, y_m, SIGMA_M);
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

/* ---- figures --------------------------------------------------------------------------------- */

static void expect_close(double is, double wanted)
{
    assert_true(fabs(is - wanted) <= 1e-4 * fabs(wanted) + 1e-6);
}

static void have(unsigned row, uint16_t hits, uint16_t misses)
{
    tracker.tracks[row] = (struct rho_track){
        .status = RHO_TRACK_CONFIRMED, .hits = hits, .misses = misses, .plot = -1};
    tracker.num_tracks = (uint16_t)(row + 1);
}

/* As the head of evidence_after_short_lived_tracks.c derives it, for 0.3 of a target's looks and
 * one in ten. */
static void the_evidence_needed_is_as_derived(void **state)
{
    struct step at = {.tracker = &tracker};
    const double hit_nat = log(1.0 / 0.3), wanted = 3.0 * 1600.0 / 3600.0;
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    have(0, 100, 20);
    have(1, 16, 5); /* established */
    have(2, 15, 5); /* not yet: almost, by its evidence */
    have(3, 7, 3);
    tracker.wanted_per_hour = 3.0f;
    tracker.ended_early = 20.0f;
    tracker.established = 4.0f;
    tracker.counted_us = 0;
    at.time_us = 400000000;
    rho_tracker_fade_counts_set_evidence_needed(&at);
    const double kept = exp(-400.0 / 1600.0), ended = 20.0 * kept, established = 4.0 * kept;
    const double pd = (9.0 + 100.0 + 16.0) / (10.0 + 120.0 + 21.0);
    expect_close((double)tracker.ended_early, ended);
    expect_close((double)tracker.established, established);
    expect_close((double)at.miss_nat, log((1.0 - 0.3 * pd) / (1.0 - pd)));
    const double miss_nat = (double)at.miss_nat;
    assert_true(15.0 * hit_nat - 5.0 * miss_nat > 6.0 * hit_nat); /* almost: twice three hits */
    assert_true(7.0 * hit_nat - 3.0 * miss_nat < 6.0 * hit_nat);
    const double excess = ended - wanted - 0.5 * sqrt(ended);
    expect_close((double)at.needed_nat,
                 3.0 * hit_nat + log(10.0 * excess / (established + 1.0 + 2.0)));
    /* a hit more or less about the evidence needed */
    const double needed = (double)at.needed_nat;
    const uint16_t hits = (uint16_t)ceil(needed / hit_nat);
    have(3, hits, 0);
    assert_false(rho_tracker_lacks_evidence(&at, &tracker.tracks[3]));
    have(3, (uint16_t)(hits - 1), 0);
    assert_true(rho_tracker_lacks_evidence(&at, &tracker.tracks[3]));
}

/* With its sixteenth plot, whichever row of the scan that is. */
static void a_track_is_established_with_its_sixteenth_plot(void **state)
{
    struct step at = {.tracker = &tracker};
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int16_t plot = -1; plot < 2; plot++) {
        for (uint16_t hits = 15; hits < 18; hits++) {
            tracker.established = 0.0f;
            have(0, hits, 0);
            tracker.tracks[0].plot = plot;
            rho_tracker_count_if_newly_established(&at, &tracker.tracks[0]);
            assert_true(tracker.established == (hits == 16 && plot >= 0 ? 1.0f : 0.0f));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_track_that_lasts_is_believed_at_its_third_plot),
        cmocka_unit_test(a_few_deaths_are_chance),
        cmocka_unit_test(where_tracks_die_young_hits_are_counted),
        cmocka_unit_test(what_died_is_forgotten),
        cmocka_unit_test(the_evidence_needed_is_as_derived),
        cmocka_unit_test(a_track_is_established_with_its_sixteenth_plot),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
