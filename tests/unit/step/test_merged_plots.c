/* SPDX-License-Identifier: MIT */
/*
 * Two old tracks whose targets the sensor sees as one share its plot: they part again as
 * themselves, and a pair of which one has gone does not go on for ever.
 */
#include "tracker_setup.h"

#if RHO_SHARES_PLOTS

#define SIGMA_M 50.0
#define PD 0.95
#define RUNS 40
#define SPEED_MPS 200.0

/* How the scan just stepped was shared. */
struct share {
    int plot; /* -1: not */
    unsigned tracks;
};

static struct share find_share(void)
{
    struct share share = {-1, 0};
    for (unsigned i = 0; i < report.num_tracks; i++) {
        for (unsigned k = i + 1; k < report.num_tracks; k++) {
            if (report.tracks[i].plot >= 0 && report.tracks[i].plot == report.tracks[k].plot) {
                share.plot = report.tracks[i].plot;
                share.tracks++;
            }
        }
    }
    return share;
}

/*
 * A plot has two tracks at most, is claimed then, and both say so. Returns whether one was shared.
 */
static int check_share(void)
{
    const struct share share = find_share();
    if (share.plot < 0) {
        return 0;
    }
    unsigned owners = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        owners += report.tracks[i].plot == share.plot;
    }
    assert_int_equal(owners, 2);
    assert_int_equal(report.fates[share.plot], RHO_FATE_CLAIMED);
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if (report.tracks[i].plot == share.plot) {
            assert_int_equal(report.tracks[i].update_age_us, 0);
        }
    }
    return 1;
}

static void begin_pair(uint64_t seed)
{
    use_usual_configs(seed);
    config.pd = (float)PD;
    initiation.pd = (float)PD;
    begin_tracker();
}

static void see_with(double pd, double x_m, double y_m)
{
    if (uniform(0.0, 1.0) < pd) {
        const double at_m = x_m + SIGMA_M * normal();
        add_plot(at_m, y_m + SIGMA_M * normal(), SIGMA_M);
    }
}

static void see(double x_m, double y_m)
{
    see_with(PD, x_m, y_m);
}

/* One plot, in the middle, which there is where either of the two is seen. */
static void see_as_one(double x_m, double y_m)
{
    see_with(1.0 - (1.0 - PD) * (1.0 - PD), x_m, y_m);
}

/* Both, as one where they are nearer than a sigma to their middle. */
static void see_pair(double x_m, double half_m)
{
    if (fabs(half_m) < SIGMA_M) {
        see_as_one(x_m, 0.0);
    } else {
        see(x_m, half_m);
        see(x_m, -half_m);
    }
}

/* ---- two that fly together for a while ------------------------------------------------------- */

#define APPROACH 40
#define TOGETHER 30
#define PARTING 30

/* Half of what lies between them: smoothly from 600 m to 0, and back. */
static double half_way_m(int k)
{
    const double left = k < APPROACH              ? 1.0 - (double)k / APPROACH
                        : k < APPROACH + TOGETHER ? 0.0
                                                  : (double)(k - APPROACH - TOGETHER) / PARTING;
    return 600.0 * left * left * (3.0 - 2.0 * left);
}

struct pair_run {
    unsigned shared; /* scans */
    /* from start to end, nothing else started, nothing ended, sides kept or changed */
    int are_both_kept;
    unsigned least_tracks; /* once both were there */
};

static struct pair_run fly_together(uint64_t seed)
{
    struct pair_run run = {.least_tracks = 2};
    begin_pair(seed);
    for (int k = 0; k < APPROACH + TOGETHER + PARTING; k++) {
        see_pair(SPEED_MPS * k, half_way_m(k));
        step_at(k);
        run.shared += (unsigned)check_share();
        run.least_tracks =
            k > 10 && report.num_tracks < run.least_tracks ? report.num_tracks : run.least_tracks;
    }
    const struct rho_track_report *one = report_of(1), *two = report_of(2);
    run.are_both_kept = one && two && tracker.counters.tracks_ended == 0 &&
                        one->status == RHO_TRACK_CONFIRMED && two->status == RHO_TRACK_CONFIRMED &&
                        one->state[1] * two->state[1] < 0.0f;
    return run;
}

static void two_that_are_seen_as_one_for_long_part_as_themselves(void **state)
{
    unsigned kept = 0, shared = 0, dropped = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= RUNS; seed++) {
        const struct pair_run run = fly_together(seed);
        kept += run.are_both_kept != 0;
        shared += run.shared;
        dropped += run.least_tracks < 2;
    }
    /* 29 and 6 of 40; none and 40 where nothing is shared */
    assert_true(kept >= 27);
    assert_true(dropped <= 8);
    assert_true(shared > RUNS * TOGETHER / 2);
}

/* ---- two that cross -------------------------------------------------------------------------- */

static void crossing_targets_keep_their_velocities(void **state)
{
    unsigned kept = 0, shared = 0;
    double error_mps = 0.0;
    (void)state;
    for (uint64_t seed = 1; seed <= RUNS; seed++) {
        begin_pair(seed);
        for (int k = 0; k < 60; k++) {
            see_pair(SPEED_MPS * k, 40.0 * (k - 30));
            step_at(k);
            shared += (unsigned)check_share();
            for (unsigned i = 0; i < report.num_tracks && k == 33; i++) {
                error_mps += fabs(fabs((double)report.tracks[i].state[4]) - 40.0) / RUNS / 2.0;
            }
        }
        const struct rho_track_report *one = report_of(1), *two = report_of(2);
        kept += one && two && tracker.counters.tracks_started == 2 &&
                one->state[4] * two->state[4] < 0.0f;
    }
    /* all of 40, three scans each; 2.1 m/s */
    assert_true(kept >= RUNS - 1);
    assert_true(shared >= RUNS);
    assert_true(error_mps < 4.0);
}

/* ---- one that is gone ------------------------------------------------------------------------ */

/*
 * Side by side, then one of them is not there any more. Returns scans until there is one confirmed
 * track.
 */
static int outlive(uint64_t seed, double apart_m)
{
    begin_pair(seed);
    for (int k = 0; k < 120; k++) {
        see(SPEED_MPS * k, 0.0);
        if (k < 30) {
            see(SPEED_MPS * k, apart_m);
        }
        step_at(k);
        check_share();
        unsigned believed = 0;
        for (unsigned i = 0; i < report.num_tracks; i++) {
            believed += report.tracks[i].status == RHO_TRACK_CONFIRMED ||
                        report.tracks[i].status == RHO_TRACK_COASTING;
        }
        if (k >= 30 && believed <= 1) {
            return k - 29;
        }
    }
    return 999;
}

static void one_that_is_gone_beside_another_is_doubted_soon(void **state)
{
    int longest = 0, sum = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= RUNS; seed++) {
        const int scans = outlive(seed, 3.0 * SIGMA_M);
        longest = scans > longest ? scans : longest;
        sum += scans;
    }
    /* 13 scans, and 37 */
    assert_true(sum <= 16 * RUNS);
    assert_true(longest <= 60);
}

static void a_pair_that_never_parts_is_not_kept_for_ever(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= RUNS; seed++) {
        begin_pair(seed);
        int doubted = 0;
        for (int k = 0; k < 140; k++) {
            see_pair(SPEED_MPS * k, k < 30 ? 20.0 * (30 - k) : 0.0);
            step_at(k);
            check_share();
            for (unsigned i = 0; i < report.num_tracks && k > 40; i++) {
                doubted |= report.tracks[i].status == RHO_TRACK_TENTATIVE;
            }
            doubted |= k > 40 && report.num_tracks < 2;
        }
        assert_true(doubted);
    }
}

/* ---- who shares ------------------------------------------------------------------------------ */

/*
 * Two that are there from the start, exact, 30 m apart, and seen as one from `from` on: scans that
 * were shared.
 */
static unsigned scans_shared(uint8_t gate, int from)
{
    unsigned shared = 0;
    use_usual_configs(1);
    config.gate = gate;
    begin_tracker();
    for (int k = 0; k < from + 4; k++) {
        add_plot(SPEED_MPS * k, k < from ? 30.0 : 15.0, 10.0);
        if (k < from) {
            add_plot(SPEED_MPS * k, 0.0, 10.0);
        }
        step_at(k);
        shared += (unsigned)check_share();
    }
    return shared;
}

static void old_tracks_share_in_each_gate_and_new_ones_do_not(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        assert_int_equal(scans_shared((uint8_t)gate, 6),
                         0); /* hits are no ten until the last scan */
        assert_int_equal(scans_shared((uint8_t)gate, 14), 4);
    }
}

static void a_plot_has_two_tracks_at_most(void **state)
{
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int k = 0; k < 20; k++) {
        if (k < 14) {
            add_plot(SPEED_MPS * k, 30.0, 10.0);
            add_plot(SPEED_MPS * k, 0.0, 10.0);
            add_plot(SPEED_MPS * k, -30.0, 10.0);
        } else {
            add_plot(SPEED_MPS * k, 0.0, 10.0);
        }
        step_at(k);
        assert_int_equal(check_share(), k >= 14);
    }
}

/* Two that are seen apart have a plot each, however near they are. */
static void what_is_seen_apart_is_not_shared(void **state)
{
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int k = 0; k < 40; k++) {
        add_plot(SPEED_MPS * k, 15.0, 10.0);
        add_plot(SPEED_MPS * k, -15.0, 10.0);
        step_at(k);
        assert_int_equal(check_share(), 0);
        assert_int_equal(report.num_tracks, k < 3 ? 0 : 2);
    }
}

/* A miss of one five sigmas from the other is a miss, though the other's plot is in its gate. */
static void one_that_is_far_shares_nothing(void **state)
{
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int k = 0; k < 40; k++) {
        add_plot(SPEED_MPS * k, 0.0, 10.0);
        if (k != 20 && k != 30) {
            add_plot(SPEED_MPS * k, 50.0, 10.0);
        }
        step_at(k);
        assert_int_equal(check_share(), 0);
    }
    assert_int_equal(report.num_tracks, 2);
    assert_int_equal(report.tracks[0].misses + report.tracks[1].misses, 2);
}

/*
 * Two 300 m apart, 40 km from the sensor, whose plots are good to 30 m in range and to 170 m
 * across. Three scans show one of them alone, or the middle: scans that were shared.
 */
static unsigned scans_shared_apart(double along_m, double across_m, int is_one)
{
    unsigned shared = 0;
    use_usual_configs(1);
    config.accel_max_mps2 = 20.0f; /* each one's plots are in the other's gate */
    begin_tracker();
    for (int k = 0; k < 24; k++) {
        const int is_missed = k >= 20 && k < 23;
        const double share = is_missed && is_one ? 0.5 : 0.0;
        for (int i = 0; i < 2 - is_missed; i++) {
            struct rho_plot *plot = add_plot(40000.0 - 4.0 * SPEED_MPS * k + (i + share) * along_m,
                                             (i + share) * across_m, 30.0);
            plot->sigma_cross_m = 170.0f;
        }
        step_at(4.0 * k);
        shared += (unsigned)check_share();
    }
    assert_int_equal(report.num_tracks, 2);
    return shared;
}

/*
 * One behind the other are told apart by their ranges, however bad the azimuths are; abreast they
 * are not.
 */
static void those_whose_ranges_differ_share_nothing(void **state)
{
    (void)state;
    assert_int_equal(scans_shared_apart(300.0, 0.0, 0), 0);
    assert_int_equal(scans_shared_apart(0.0, 300.0, 1), 3);
}

/*
 * Two abreast, seen as one from scan 20 on, half an interval after the scan's time: both keep to
 * their plot's time.
 */
static void a_shared_plot_has_its_own_time(void **state)
{
    (void)state;
    for (int offset_s = 0; offset_s <= 5; offset_s += 5) {
        begin_pair(5);
        for (int k = 0; k < 32; k++) {
            const double x_m = SPEED_MPS * (10.0 * k + offset_s);
            const int is_one = k >= 20;
            for (int i = 0; i < 2 - is_one; i++) {
                add_plot(x_m, is_one ? 30.0 : 60.0 * i, SIGMA_M)->offset_us = offset_s * 1000000;
            }
            step_at(10.0 * k);
        }
        assert_int_equal(report.num_tracks, 2);
        assert_int_equal(find_share().tracks, 1);
        for (unsigned i = 0; i < 2; i++) {
            assert_float_equal(report.tracks[i].state[0], SPEED_MPS * 310.0, 60.0);
            assert_float_equal(report.tracks[i].state[1], 30.0, 40.0);
        }
    }
}

/* Two scans that show neither: the one that the plots are claimed by is believed again. */
static void a_pair_that_was_missed_is_seen_again(void **state)
{
    (void)state;
    begin_pair(6);
    for (int k = 0; k < 30; k++) {
        for (int i = 0; i < (k < 20 ? 2 : k < 22 ? 0 : 1); i++) {
            add_plot(SPEED_MPS * 10.0 * k, k < 20 ? 60.0 * i : 30.0, SIGMA_M);
        }
        step_at(10.0 * k);
    }
    unsigned confirmed = 0;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        confirmed += report.tracks[i].status == RHO_TRACK_CONFIRMED;
    }
    assert_true(confirmed >= 1);
}

/*
 * Two abreast for twenty scans, missed in two, and in the next one seen as one; or each by a plot
 * of its own, which is vague.
 */
static double sigma_after(int is_shared)
{
    begin_pair(8);
    for (int k = 0; k < 23; k++) {
        const double x_m = SPEED_MPS * 10.0 * k;
        for (int i = 0; i < 2 && (k < 20 || (k == 22 && !is_shared)); i++) {
            add_plot(x_m, 60.0 * i, k < 20 ? SIGMA_M : sqrt(2.0) * SIGMA_M);
        }
        if (k == 22 && is_shared) {
            add_plot(x_m, 30.0, SIGMA_M);
        }
        step_at(10.0 * k);
    }
    assert_int_equal(report.num_tracks, 2);
    assert_int_equal(find_share().tracks, is_shared);
    return (double)report.tracks[0].sigma_m;
}

/*
 * Where the tracks know little each knows of the plot what (4 r + p) (n + p) - p^2 over
 * 4 r + n + 4 p becomes, r + n / 4: with a cell of n = 4 r it is as vague as root 2 sigmas.
 */
static void a_shared_plot_is_a_vague_one(void **state)
{
    (void)state;
    const double shared_m = sigma_after(1), vague_m = sigma_after(0);
    assert_true(fabs(shared_m - vague_m) < 0.06 * vague_m);
}

/* Two abreast are seen as one by the last plot of a scan, the first one that has no room. */
static void a_shared_plot_beyond_the_capacity_is_told_by_its_row(void **state)
{
    (void)state;
    if (!RHO_CLAIMS_BEYOND) {
        skip();
    }
    begin_pair(7);
    for (int k = 0; k < 25; k++) {
        const double x_m = SPEED_MPS * 10.0 * k;
        for (int i = 0; i < RHO_MAX_PLOTS && k == 24; i++) {
            add_plot(x_m + 500.0 * i, 40000.0, SIGMA_M);
        }
        for (int i = 0; i < (k < 20 ? 2 : 1); i++) {
            add_plot(x_m, k < 20 ? 60.0 * i : 30.0, SIGMA_M);
        }
        step_at(10.0 * k);
    }
    assert_int_equal(report.num_tracks, 2);
    assert_int_equal(find_share().plot, RHO_MAX_PLOTS);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_that_are_seen_as_one_for_long_part_as_themselves),
        cmocka_unit_test(crossing_targets_keep_their_velocities),
        cmocka_unit_test(one_that_is_gone_beside_another_is_doubted_soon),
        cmocka_unit_test(a_pair_that_never_parts_is_not_kept_for_ever),
        cmocka_unit_test(old_tracks_share_in_each_gate_and_new_ones_do_not),
        cmocka_unit_test(a_plot_has_two_tracks_at_most),
        cmocka_unit_test(what_is_seen_apart_is_not_shared),
        cmocka_unit_test(one_that_is_far_shares_nothing),
        cmocka_unit_test(those_whose_ranges_differ_share_nothing),
        cmocka_unit_test(a_shared_plot_has_its_own_time),
        cmocka_unit_test(a_pair_that_was_missed_is_seen_again),
        cmocka_unit_test(a_shared_plot_is_a_vague_one),
        cmocka_unit_test(a_shared_plot_beyond_the_capacity_is_told_by_its_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
