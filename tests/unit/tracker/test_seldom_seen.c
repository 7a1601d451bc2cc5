/* SPDX-License-Identifier: MIT */
/*
 * Where many objects are seldom seen, a new one needs more evidence to be confirmed. Figures are
 * tested with tracks made by hand, with the private header.
 */
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define SIGMA_M 20.0
#define SPEED_MPS 150.0
#define TURN_S 4.0
#define HIT_NAT log(1.0 / 0.3)
#define TARGETS 4 /* targets that are seen in every scan */

static int turn;

static void start_tracker(void)
{
    begin_tracker_by_rate(20);
    turn = 0;
}

/* Adds clutter, and targets that fly far from the tested places. */
static void see_targets_and_clutter(void)
{
    for (int i = 0; i < 10; i++) {
        const double x_m = uniform(-40000.0, 80000.0);
        (void)add_plot(x_m, uniform(-60000.0, 60000.0), SIGMA_M);
    }
    for (int i = 0; i < TARGETS; i++) {
        add_noisy_plot(-30000.0 + SPEED_MPS * TURN_S * (turn % 100), 40000.0 + 5000.0 * i, SIGMA_M);
    }
}

static void step_turn(void)
{
    see_targets_and_clutter();
    step_at(TURN_S * turn++);
}

/*
 * Something moves like a target, is seen `hits` times in a row and then no more for ten turns.
 * Returns turns in which it was reported as confirmed or coasting.
 */
static int count_turns_reporting_short_lived_target(double x_m, double y_m, int hits)
{
    int reported = 0;
    for (int k = 0; k < hits + 10; k++) {
        const double at_m = x_m + SPEED_MPS * TURN_S * k;
        if (k < hits) {
            add_noisy_plot(at_m, y_m, SIGMA_M);
        }
        step_turn();
        for (unsigned i = 0; i < report.num_tracks; i++) {
            const struct rho_track_report *track = &report.tracks[i];
            reported +=
                track->status != RHO_TRACK_TENTATIVE &&
                hypot((double)track->state[0] - at_m, (double)track->state[1] - y_m) < 3000.0;
        }
    }
    return reported;
}

static double place_of_number(int n)
{
    return -40000.0 + 7000.0 * (n % 10);
}

static void where_tracks_last_they_are_confirmed_at_three_plots(void **state)
{
    (void)state;
    start_tracker();
    for (int n = 0; n < 8; n++) {
        assert_true(count_turns_reporting_short_lived_target(-20000.0, place_of_number(n), 20) >=
                    18);
    }
    assert_true(tracker.seldom < 1.0f);
    assert_true(tracker.established > 8.0f);
}

static void a_few_short_lived_tracks_change_nothing(void **state)
{
    (void)state;
    start_tracker();
    for (int k = 0; k < 30; k++) {
        step_turn();
    }
    assert_true(count_turns_reporting_short_lived_target(-20000.0, -30000.0, 4) > 0);
    assert_true(count_turns_reporting_short_lived_target(-20000.0, -20000.0, 20) >= 18);
}

static void where_objects_are_seldom_seen_more_hits_are_needed(void **state)
{
    int first = 0, last = 0;
    (void)state;
    start_tracker();
    for (int k = 0; k < 30; k++) {
        step_turn();
    }
    for (int n = 0; n < 24; n++) {
        const int reported =
            count_turns_reporting_short_lived_target(-20000.0, place_of_number(n), 4);
        first += n < 4 ? reported : 0;
        last += n >= 20 ? reported : 0;
    }
    assert_true(tracker.seldom > 10.0f);
    assert_true(first >= 8);   /* two turns at least for each of the first four */
    assert_int_equal(last, 0); /* the last one was never confirmed */
    const int reported = count_turns_reporting_short_lived_target(-20000.0, -30000.0, 20);
    assert_in_range(reported, 12, 24); /* a real target is confirmed, at three plots or later */
    for (int n = 0; n < 6; n++) {
        (void)count_turns_reporting_short_lived_target(-20000.0, place_of_number(n), 20);
    }
    assert_true(tracker.established > 8.0f);
}

static void short_lived_tracks_are_forgotten_after_a_while(void **state)
{
    (void)state;
    start_tracker();
    for (int n = 0; n < 12; n++) {
        (void)count_turns_reporting_short_lived_target(-20000.0, place_of_number(n), 4);
    }
    assert_true(tracker.seldom > 5.0f);
    for (int k = 0; k < 1200; k++) {
        step_turn();
    }
    assert_true(tracker.seldom < 1.0f);
    assert_true(count_turns_reporting_short_lived_target(-20000.0, -30000.0, 20) >= 18);
}

/* ---- evidence by formula --------------------------------------------------------------------- */

static void expect_close(double is, double wanted)
{
    assert_true(fabs(is - wanted) <= 1e-4 * fabs(wanted) + 1e-6);
}

static void make_track(unsigned row, uint16_t hits, uint16_t misses)
{
    tracker.tracks[row] = (struct rho_track){.status = RHO_TRACK_CONFIRMED,
                                             .hits = hits,
                                             .misses = misses,
                                             .seen_nat = (float)(hits * HIT_NAT),
                                             .missed = (float)misses,
                                             .plot = -1};
    tracker.num_tracks = (uint16_t)(row + 1);
}

/*
 * Formula at the head of seldom_seen.c, for tracks seen in 0.3 of a target's
 * looks, one in ten of all.
 */
static void the_evidence_needed_equals_its_formula(void **state)
{
    struct step at = {.tracker = &tracker,
                      .look = {
                          .tracker = &tracker,
                          .fates = report.fates,
                          .teaches = 1,
                          .pd = 0.8f,
                      }};
    const double hit_nat = HIT_NAT, wanted = 3.0 * 1600.0 / 3600.0;
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    make_track(0, 100, 20);
    make_track(1, 16, 5); /* established */
    make_track(2, 15, 5); /* not yet established, but almost, by its evidence */
    make_track(3, 7, 3);
    tracker.wanted_per_hour = 3.0f;
    tracker.seldom = 20.0f;
    tracker.established = 4.0f;
    tracker.counted_us = 0;
    at.look.time_us = 400000000;
    rho_evidence_update(&at);
    const double kept = exp(-400.0 / 1600.0), ended = 20.0 * kept, established = 4.0 * kept;
    /* ten looks of the stated 0.8, and those at tracks of eight hits or more */
    const double pd = (8.0 + 100.0 + 16.0 + 15.0) / (10.0 + 120.0 + 21.0 + 20.0);
    expect_close((double)tracker.seldom, ended);
    expect_close((double)tracker.established, established);
    expect_close((double)at.miss_nat, log((1.0 - 0.3 * pd) / (1.0 - pd)));
    const double miss_nat = (double)at.miss_nat;
    /* almost: the evidence of twice three hits */
    assert_true(15.0 * hit_nat - 5.0 * miss_nat > 6.0 * hit_nat);
    assert_true(7.0 * hit_nat - 3.0 * miss_nat < 6.0 * hit_nat);
    const double excess = ended - wanted - 0.5 * sqrt(ended);
    expect_close((double)at.needed_nat,
                 3.0 * hit_nat + log(10.0 * excess / (established + 1.0 + 2.0)));
    /* one hit more or less than the evidence needed */
    const double needed = (double)at.needed_nat;
    const uint16_t hits = (uint16_t)ceil(needed / hit_nat);
    make_track(3, hits, 0);
    assert_false(rho_evidence_is_lacking(&at, &tracker.tracks[3]));
    make_track(3, (uint16_t)(hits - 1), 0);
    assert_true(rho_evidence_is_lacking(&at, &tracker.tracks[3]));
}

/* Established with its sixteenth plot, whichever row of the scan it has. */
static void a_track_is_established_with_its_sixteenth_plot(void **state)
{
    const struct step at = {.tracker = &tracker, .miss_nat = 2.0f};
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int16_t plot = -1; plot < 2; plot++) {
        for (uint16_t hits = 15; hits < 18; hits++) {
            tracker.established = 0.0f;
            make_track(0, hits, 0);
            tracker.tracks[0].plot = plot;
            rho_evidence_count(&at, &tracker.tracks[0]);
            assert_true(tracker.established == (hits == 16 && plot >= 0 ? 1.0f : 0.0f));
        }
    }
}

/*
 * A track whose score was once that of a target, and whose misses outweigh its hits by one hit, is
 * of an object that is seldom seen. It counts once.
 */
static void an_object_that_is_seldom_seen_counts_once(void **state)
{
    const struct step at = {.tracker = &tracker, .miss_nat = 2.0f};
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    tracker.confirm_mnat = 5000;
    for (int i = 0; i < 3; i++) {
        struct rho_track *track = &tracker.tracks[0];
        tracker.seldom = 0.0f;
        make_track(0, 3, 0);
        track->missed = (float)((4.0 * HIT_NAT + (i == 1 ? -0.01 : 0.01)) / 2.0);
        track->score_max_mnat = i == 2 ? 4999 : 5000;
        for (int scan = 0; scan < 3; scan++) {
            rho_evidence_count(&at, track);
        }
        assert_true(tracker.seldom == (i == 0 ? 1.0f : 0.0f));
        assert_int_equal(track->is_seldom, i == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(where_tracks_last_they_are_confirmed_at_three_plots),
        cmocka_unit_test(a_few_short_lived_tracks_change_nothing),
        cmocka_unit_test(where_objects_are_seldom_seen_more_hits_are_needed),
        cmocka_unit_test(short_lived_tracks_are_forgotten_after_a_while),
        cmocka_unit_test(the_evidence_needed_equals_its_formula),
        cmocka_unit_test(a_track_is_established_with_its_sixteenth_plot),
        cmocka_unit_test(an_object_that_is_seldom_seen_counts_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
