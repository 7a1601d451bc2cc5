/* SPDX-License-Identifier: MIT */
/*
 * The probability that a track's target exists, and the tracks in doubt: no longer believed but not
 * yet ended, and how they are reported. Starts that share their newest plot. The mean time of
 * straight flight (steady_s).
 */
#include <stdio.h>

#include "life_chain.h"
#include "tracker_setup.h"

#define SCAN_S 2.0
#define LAST 12 /* scan until which the target is seen at first */

/* A target at 250 m/s along x. */
static void see_target(int k)
{
    const double x_m = 500.0 * k + uniform(-8.0, 8.0);
    add_plot(x_m, uniform(-8.0, 8.0), 10.0);
}

static void step_scans(int from, int to)
{
    for (int k = from; k < to; k++) {
        see_target(k);
        step_at(SCAN_S * k);
    }
}

static enum rho_track_status status_of_track_1(void)
{
    const struct rho_track_report *first = report_of(1);
    return first ? first->status : RHO_TRACK_FREE;
}

/* ---- the chain of a target's life ------------------------------------------------------------ */

static struct life_chain chain;
static double blind;

/* Steps scan k; the chain takes the evidence that the track's score shows. */
static void step_scan_with_chain(int k, int is_seen)
{
    const struct rho_tracker_life rates = rho_tracker_life(&tracker);
    const enum rho_track_status before = report.tracks[0].status;
    const double score_nat = (double)report.tracks[0].score_nat;
    const double interval_s = fmax(SCAN_S, (double)tracker.tracks[0].seen_every_s);
    if (is_seen) {
        see_target(k);
    }
    step_at(SCAN_S * k);
    chain_pass(&chain, SCAN_S / interval_s, &rates, blind);
    if (report.num_tracks > 0) {
        const double gain_nat = (double)report.tracks[0].score_nat - score_nat;
        chain.is_established = report.tracks[0].hits >= 16;
        chain_weigh(&chain, &gain_nat, 1, &blind,
                    tracker.tracks[0].misses_in_row <= config.coast_scans_max);
        assert_float_equal(tracker.tracks[0].visible, chain.visible, 3e-4);
        assert_float_equal(tracker.tracks[0].hidden, chain.hidden, 3e-4);
        assert_int_equal(report.tracks[0].status, chain_status(&chain, before, !is_seen));
    } else { /* the last miss, of which there is no report */
        const double gain_nat = log(1.0 - chain.share * (double)config.pd);
        chain_weigh(&chain, &gain_nat, 1, &blind, 0);
        assert_true(chain_exists(&chain) < CHAIN_ENDED + 2e-3);
    }
}

static void start_with_chain(uint64_t seed, float pd)
{
    use_usual_configs(seed);
    config.pd = initiation.pd = pd;
    begin_tracker();
    step_scans(0, 4);
    assert_int_equal(status_of_track_1(), RHO_TRACK_CONFIRMED);
    chain = chain_of_start((double)report.tracks[0].score_nat - 1e-3 * tracker.confirm_mnat);
    blind = 0.0;
}

/* Misses until the track ends; is_seen: bits of the scans after the start with a plot. */
static int misses_until_end(float pd, uint32_t is_seen, int scans)
{
    int misses = 0;
    start_with_chain(1, pd);
    for (int k = 4; k < 4 + scans; k++) {
        step_scan_with_chain(k, is_seen >> (k - 4) & 1u);
        assert_int_equal(report.num_tracks, 1);
    }
    for (int k = 4 + scans; report.num_tracks > 0 && misses < 60; k++, misses++) {
        step_scan_with_chain(k, 0);
    }
    assert_int_equal(report.num_ended, 1);
    assert_int_equal(report.ended[0], 1);
    return misses;
}

/* Visible, hidden or gone: as the chain says, before and after 16 hits, with misses among them. */
static void existence_follows_the_chain_of_a_targets_life(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const float pd = i ? 0.9f : 0.5f;
        const int young = misses_until_end(pd, 0x3f, 6), old = misses_until_end(pd, 0x3ffff, 18);
        const int faded = misses_until_end(pd, 0x1eb5ff, 21),
                  back = misses_until_end(pd, 0x3c0ff, 18);
        print_message("pd %.1f: ends after %d, %d, %d, %d misses\n", (double)pd, young, old, faded,
                      back);
        assert_in_range(young, i ? 4 : 8, i ? 16 : 24);
        assert_in_range(old, i ? 4 : 8, i ? 16 : 24);
    }
}

/* ---- blind looks ----------------------------------------------------------------------------- */

#define TEN 10

static struct life_chain ten[TEN];
static double existed[TEN], lost_nat[TEN]; /* before a scan, and what it took from the score */

/* Adds plots of the targets whose tracks are in rows from num_missed on. */
static void see_ten_targets(int k, int num_missed)
{
    for (int i = 0; i < TEN; i++) {
        int row = 0;
        while (row < num_missed && fabs((double)report.tracks[row].state[1] - 3000.0 * i) > 300.0) {
            row++;
        }
        if (row == num_missed) {
            add_plot(500.0 * k, 3000.0 * i + uniform(-8.0, 8.0), 10.0);
        }
    }
}

/* Steps a scan that misses the first tracks; ten chains take the same evidence. */
static void step_ten_targets(int k, int num_missed)
{
    const struct rho_tracker_life rates = rho_tracker_life(&tracker);
    double gain_nat[TEN], interval_s[TEN];
    for (int i = 0; i < TEN; i++) {
        existed[i] = (double)(tracker.tracks[i].visible + tracker.tracks[i].hidden);
        interval_s[i] = fmax(SCAN_S, (double)tracker.tracks[i].seen_every_s);
        gain_nat[i] = -(double)report.tracks[i].score_nat;
    }
    see_ten_targets(k, num_missed);
    step_at(SCAN_S * k);
    assert_int_equal(report.num_tracks, TEN);
    for (int i = 0; i < TEN; i++) {
        assert_int_equal(report.tracks[i].track_id, i + 1);
        gain_nat[i] += (double)report.tracks[i].score_nat;
        lost_nat[i] = -gain_nat[i];
        chain_pass(&ten[i], SCAN_S / interval_s[i], &rates, blind);
    }
    chain_weigh(ten, gain_nat, TEN, &blind, 1);
    for (int i = 0; i < TEN; i++) {
        assert_float_equal(tracker.tracks[i].visible, ten[i].visible, 1e-3);
        assert_float_equal(tracker.tracks[i].hidden, ten[i].hidden, 1e-3);
    }
}

static void start_ten_targets(void)
{
    use_usual_configs(1);
    config.learn_pd_min = 1.0f; /* the P_D is the stated one */
    begin_tracker();
    for (int k = 0; k < 20; k++) {
        see_ten_targets(k, 0);
        step_at(SCAN_S * k);
    }
    assert_int_equal(report.num_tracks, TEN);
    for (int i = 0; i < TEN; i++) {
        assert_true(report.tracks[i].hits >= 16 && report.tracks[i].track_id == (uint32_t)i + 1);
        ten[i] = (struct life_chain){.visible = (double)tracker.tracks[i].visible,
                                     .hidden = (double)tracker.tracks[i].hidden,
                                     .share = 1.0,
                                     .is_established = 1};
    }
    blind = 0.0;
}

static double existence_of_row(int row)
{
    return (double)(tracker.tracks[row].visible + tracker.tracks[row].hidden);
}

/* What a look takes from all tracks at once is the sensor's fault: they keep their probability. */
static void a_look_that_misses_all_tracks_is_blind(void **state)
{
    (void)state;
    start_ten_targets();
    step_ten_targets(20, TEN);
    for (int i = 0; i < TEN; i++) {
        assert_float_equal(lost_nat[i], -log(0.1), 0.01); /* nothing told of a blind look before */
        assert_true(existence_of_row(i) > existed[i] - 0.006); /* but what time takes: 1 / 200 */
    }
    /* the next look is blind with 0.8, and so takes less from the score */
    for (int k = 21; k < 24; k++) {
        step_ten_targets(k, TEN);
        for (int i = 0; i < TEN; i++) {
            assert_float_equal(lost_nat[i], -log(1.0 - 0.9 * 0.2), 0.03);
            assert_true(existence_of_row(i) > existed[i] - 0.006);
            assert_int_equal(report.tracks[i].status, RHO_TRACK_COASTING);
        }
    }
    /* it sees again: the next miss is the track's own */
    step_ten_targets(24, 0);
    for (int i = 0; i < TEN; i++) {
        assert_int_equal(report.tracks[i].status, RHO_TRACK_CONFIRMED);
    }
    step_ten_targets(25, 1);
    assert_float_equal(lost_nat[0], -log(0.1), 0.01);
}

static void a_track_missed_alone_loses_its_probability(void **state)
{
    (void)state;
    start_ten_targets();
    for (int k = 20; k < 23; k++) {
        step_ten_targets(k, 1);
        assert_true(existence_of_row(0) < existed[0] - 0.02);
        for (int i = 1; i < TEN; i++) {
            assert_true(existence_of_row(i) > 0.999);
        }
    }
    assert_int_equal(report.tracks[0].status, RHO_TRACK_TENTATIVE);
}

/* ---- learned rates of life ------------------------------------------------------------------- */

/*
 * The prior: one target in 200 scans leaves, and one is hidden; it weighs 400 scans.
 */
static void expect_rates(double scans, double gone, double least_returned, double most_returned)
{
    const struct rho_tracker_life life = rho_tracker_life(&tracker);
    assert_float_equal(life.lived_scans, scans, 5e-3 * scans + 1e-3);
    assert_float_equal(life.death, (gone + 2.0) / (scans + 400.0), 2e-5);
    assert_float_equal(life.appear, 1.0 / (0.7 * config.coast_scans_max), 1e-5);
    assert_true(life.hide > (least_returned + 1.98) / (scans + 400.0) - 2e-5);
    assert_true(life.hide < (most_returned + 2.02) / (scans + 400.0) + 2e-5);
}

/* Two targets, so that a scan without one of them is not blind. */
static void step_two_targets(int k, int num_seen)
{
    if (num_seen > 1) {
        see_target(k);
    }
    add_plot(500.0 * k, 5000.0 + uniform(-8.0, 8.0), 10.0);
    step_at(SCAN_S * k);
}

static void rates_of_life_are_learned_from_established_tracks(void **state)
{
    const double kept = exp(-SCAN_S / 1600.0);
    double scans = 0.0;
    int k = 0;
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (; k < 16; k++) {
        step_two_targets(k, 2);
    }
    assert_true(report.tracks[0].hits == 16 && report.tracks[1].hits == 16);
    expect_rates(0.0, 0.0, 0.0, 0.0);
    for (; k < 200; k++) { /* each scan of each track counts, and fades in half an hour */
        step_two_targets(k, 2);
        scans = (scans + 2.0) * kept;
    }
    expect_rates(scans, 0.0, 0.0, 0.0);
    /* missed four times and seen again, ten times: each time it was probably hidden */
    for (; k < 300; k++) {
        step_two_targets(k, k % 10 < 4 ? 1 : 2);
        scans = (scans + 2.0) * kept;
    }
    assert_int_equal(report.num_tracks, 2);
    assert_int_equal(tracker.counters.tracks_started, 2);
    expect_rates(scans, 0.0, 6.0, 10.0);
    for (; report.num_tracks > 1 && k < 340; k++) {
        step_two_targets(k, 1);
        scans = (scans + 2.0) * kept;
    }
    assert_int_equal(report.num_ended, 1);
    expect_rates(scans, 1.0, 5.5, 10.0);
}

static void without_a_tracker_there_are_no_rates(void **state)
{
    static struct rho_tracker none;
    (void)state;
    for (int i = 0; i < 2; i++) {
        const struct rho_tracker_life life = rho_tracker_life(i ? &none : NULL);
        assert_true(life.death == 0.0f && life.hide == 0.0f && life.appear == 0.0f &&
                    life.lived_scans == 0.0f);
    }
}

/* ---- doubted tracks -------------------------------------------------------------------------- */

static void a_track_in_doubt_comes_back_with_its_identity(void **state)
{
    (void)state;
    for (int misses = 3; misses <= 4; misses++) {
        use_usual_configs((uint64_t)misses);
        begin_tracker();
        step_scans(0, LAST);
        for (int k = LAST; k < LAST + misses; k++) {
            step_at(SCAN_S * k);
            assert_int_equal(status_of_track_1(),
                             k < LAST + 2 ? RHO_TRACK_COASTING : RHO_TRACK_TENTATIVE);
            assert_int_equal(report.tracks[0].is_in_doubt, k >= LAST + 2);
        }
        step_scans(LAST + misses, LAST + misses + 3);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].track_id, 1);
        assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
        assert_int_equal(report.tracks[0].is_in_doubt, 0);
        assert_int_equal(tracker.counters.tracks_started, 1);
        assert_int_equal(tracker.counters.tracks_ended, 0);
        /* confirmed once; after the doubt it is not counted as confirmed again */
        assert_int_equal(tracker.counters.tracks_confirmed, 1);
    }
}

static void a_doubted_track_that_ends_is_reported_as_ended(void **state)
{
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    step_scans(0, LAST);
    enum rho_track_status before = RHO_TRACK_CONFIRMED;
    int k = LAST;
    for (step_at(SCAN_S * k); report.num_tracks > 0 && k < LAST + 30; step_at(SCAN_S * ++k)) {
        assert_int_equal(report.num_ended, 0);
        before = status_of_track_1();
    }
    assert_int_equal(before, RHO_TRACK_TENTATIVE);
    assert_int_equal(report.num_tracks, 0);
    assert_int_equal(report.num_ended, 1);
    assert_int_equal(report.ended[0], 1);
    assert_int_equal(tracker.counters.tracks_confirmed, 1);
    assert_int_equal(tracker.counters.tracks_ended, 1);
}

/* A track is confirmed above the score of a start, which takes further plots. */
static void tracks_never_confirmed_are_not_reported_as_ended(void **state)
{
    (void)state;
    use_usual_configs(1);
    initiation.false_tracks_per_hour = 0.001f;
    initiation.scans = 4;
    initiation.min_scans = 3;
    begin_tracker();
    for (int k = 0; k < 20 && tracker.counters.tracks_started == 0; k++) {
        for (int i = 0; i < 60; i++) {
            const double x_m = uniform(-2e4, 2e4);
            add_plot(x_m, uniform(-2e4, 2e4), 10.0);
        }
        see_target(k);
        step_at(SCAN_S * k);
    }
    if (tracker.counters.tracks_started == 0 || report.tracks[0].status != RHO_TRACK_TENTATIVE) {
        fail_msg("the scene starts no tentative track");
    }
    uint32_t ended = 0;
    for (int k = 20; k < 30 && report.num_tracks > 0; k++) {
        step_at(SCAN_S * k);
        ended += report.num_ended;
    }
    assert_int_equal(report.num_tracks, 0);
    assert_int_equal(tracker.counters.tracks_confirmed, 0);
    assert_int_equal(tracker.counters.tracks_ended, tracker.counters.tracks_started);
    assert_int_equal(ended, 0);
}

/*
 * A weak track stands where a target appears, and takes its first plots. They start a better one
 * all the same: confirmed as soon as without the weak track, which ends.
 */
static void a_weak_track_keeps_no_target_from_starting(void **state)
{
    unsigned scans[2] = {0, 0};
    (void)state;
    for (int run = 0; run < 40; run++) {
        const int is_weak_there = run % 2;
        int is_confirmed = 0;
        begin_tracker_by_rate(1 + (uint64_t)run / 2);
        for (int k = 0; k < 40 && !is_confirmed; k++) {
            for (int i = 0; i < 30; i++) {
                const double x_m = uniform(-5e3, 2e4);
                add_plot(x_m, uniform(-1e4, 1e4), 10.0);
            }
            if (k >= 20) {
                add_noisy_plot(300.0 * (k - 20), 0.0, 10.0);
            }
            step_at(SCAN_S * k);
            for (unsigned i = 0; i < report.num_tracks && k >= 20; i++) {
                const struct rho_track_report *track = &report.tracks[i];
                is_confirmed |= track->status == RHO_TRACK_CONFIRMED &&
                                hypot((double)track->state[0] - 300.0 * (k - 20),
                                      (double)track->state[1]) < 50.0;
            }
            scans[is_weak_there] += k >= 20;
            if (k == 19 && is_weak_there) { /* it flies up at 150 m/s, and was never seen so */
                struct rho_track_plot seen[3];
                for (int i = 0; i < 3; i++) {
                    seen[i] = (struct rho_track_plot){
                        .time_us = report.time_us - (int64_t)(2 - i) * 2000000,
                        .sensor_id = 1,
                        .row = -1,
                        .plot = {.y_m = 300.0f * (float)(i - 3) + 100.0f,
                                 .sigma_range_m = 10.0f,
                                 .sigma_cross_m = 10.0f}};
                }
                assert_int_equal(rho_tracker_start_track(&tracker, seen, 3,
                                                         tracker.confirm_mnat - 9000, &report),
                                 RHO_OK);
            }
        }
        assert_true(is_confirmed);
    }
    printf("scans until confirmed: %.1f, beside a weak track %.1f\n", scans[0] / 20.0,
           scans[1] / 20.0);
    assert_true(scans[1] < scans[0] + 8);
}

/*
 * Where a sensor sees half of its targets, misses are common: each halves the odds that a target is
 * still there, where it would leave a tenth of them at a sensor that sees nine in ten.
 */
static void misses_of_a_low_pd_sensor_raise_less_doubt(void **state)
{
    (void)state;
    for (int is_low = 0; is_low < 2; is_low++) {
        use_usual_configs(1);
        config.pd = initiation.pd = is_low ? 0.5f : 0.9f;
        begin_tracker();
        step_scans(0, LAST);
        assert_int_equal(status_of_track_1(), RHO_TRACK_CONFIRMED);
        int coasting = 0;
        for (int k = LAST; k < LAST + 20; k++) {
            step_at(SCAN_S * k);
            coasting += status_of_track_1() == RHO_TRACK_COASTING;
        }
        assert_in_range(coasting, is_low ? 3 : 2, is_low ? 8 : 2); /* its hits have raised pd */
    }
}

/*
 * The misses of a target that leaves count for P_D of all looks until its track ends, so that a
 * sensor that sees little does not end tracks; of its place they are taken back then, where targets
 * may always leave.
 */
static void last_misses_are_taken_back_from_the_place(void **state)
{
    float looks = 0.0f, hits = 0.0f;
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    step_scans(0, 30);
    const struct rho_tracker_sensor *row = &tracker.sensors[0];
    const float before = row->looks - row->hits;
    for (int k = 30; k < 60 && report.num_tracks > 0; k++) {
        step_at(SCAN_S * k);
    }
    assert_int_equal(report.num_tracks, 0);
    assert_true(row->looks - row->hits > before + 1.5f);
    for (unsigned i = 0; i < RHO_PD_PLACES; i++) {
        looks += row->places[i].looks;
        hits += row->places[i].hits;
        assert_true(row->places[i].looks >= row->places[i].hits);
    }
    assert_true(hits > 40.0f); /* each look has a ring and an octant */
    assert_true(looks - hits < 2.0f * before + 0.5f);
}

/* One step may end all tracks. */
static void all_tracks_ended_in_a_step_are_reported(void **state)
{
    enum { TRACKS = 16 };
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int k = 0; k < LAST; k++) {
        for (int i = 0; i < TRACKS; i++) {
            add_plot(500.0 * k, 3000.0 * i + normal(), 10.0);
        }
        step_at(SCAN_S * k);
    }
    assert_int_equal(report.num_tracks, TRACKS);
    int k = LAST;
    for (step_at(SCAN_S * k); report.num_ended == 0 && k < LAST + 30; step_at(SCAN_S * ++k)) {
        assert_int_equal(report.num_tracks, TRACKS);
    }
    assert_int_equal(report.num_tracks, 0);
    assert_int_equal(report.num_ended, TRACKS);
    for (uint32_t i = 0; i < TRACKS; i++) {
        assert_int_equal(report.ended[i], i + 1);
    }
    assert_int_equal(tracker.counters.tracks_confirmed, TRACKS);
}

/* ---- starts that share their newest plot ----------------------------------------------------- */

/* Two targets meet in one plot of the scan in which both could start, and part again. */
static void of_two_starts_from_one_newest_plot_one_waits(void **state)
{
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int k = 0; k < 6; k++) {
        const double y_m = 400.0 * (3 - k);
        add_plot(500.0 * k, y_m, 10.0);
        if (k != 3) {
            add_plot(500.0 * k, -y_m, 10.0);
        }
        step_at(SCAN_S * k);
        assert_int_equal(tracker.counters.tracks_started, k < 3 ? 0 : k == 3 ? 1 : 2);
    }
    assert_int_equal(report.num_tracks, 2);
    assert_true(report.tracks[0].state[4] * report.tracks[1].state[4] < 0.0f);
}

/* Older plots shared with other tracks do not matter: each target has its own newest plot. */
static void starts_from_different_newest_plots_are_both_made(void **state)
{
    (void)state;
    use_usual_configs(1);
    begin_tracker();
    for (int k = 0; k < 4; k++) {
        add_plot(500.0 * k, 1000.0, 10.0);
        add_plot(500.0 * k, -1000.0, 10.0);
        step_at(SCAN_S * k);
    }
    assert_int_equal(tracker.counters.tracks_started, 2);
}

/* ---- mean time of straight flight ------------------------------------------------------------ */

static void steady_s_out_of_range_is_refused(void **state)
{
    static const float bad_s[] = {NAN, INFINITY, -INFINITY, -1.0f, -1e-6f, 1.0001e5f, 2e5f};
    static const float good_s[] = {0.0f, 1e-6f, 60.0f, 1e5f};
    static struct rho_tracker then;
    (void)state;
    use_usual_configs(1);
    memset(&tracker, 0x5a, sizeof tracker);
    memcpy(&then, &tracker, sizeof tracker);
    for (size_t i = 0; i < sizeof bad_s / sizeof bad_s[0]; i++) {
        config.steady_s = bad_s[i];
        assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_ERROR_CONFIG);
        assert_memory_equal(&tracker, &then, sizeof tracker);
    }
    for (size_t i = 0; i < sizeof good_s / sizeof good_s[0]; i++) {
        config.steady_s = good_s[i];
        begin_tracker();
    }
}

struct flight {
    double early_m, straight_m, turning_m; /* root mean square errors in each phase */
    double sure;   /* mean manoeuvre probability in the turn's second half */
    unsigned kept; /* runs in which one track followed the target to the end */
};

/*
 * 100 s straight, of which 10 s do not count and the next 30 s are "early"; then 3 g for 20 s; 50 m
 * noise, a plot a second.
 */
static struct flight fly_and_turn(float steady_s)
{
    enum { RUNS = 12, BEGIN = 10, EARLY = 40, STRAIGHT = 100, TURN = 20 };
    struct flight flight = {0};
    for (int run = 0; run < RUNS; run++) {
        double x_m = 0.0, y_m = 0.0, course_rad = 0.4;
        use_usual_configs(100 + (uint64_t)run);
        config.accel_max_mps2 = 40.0f;
        config.steady_s = steady_s;
        begin_tracker();
        for (int k = 0; k < STRAIGHT + TURN; k++) {
            const double seen_m = x_m + 50.0 * normal();
            add_plot(seen_m, y_m + 50.0 * normal(), 50.0);
            step_at(k);
            const struct rho_track_report *track = report_of(1);
            if (track && k >= BEGIN) {
                const double off_m =
                    hypot((double)track->state[0] - x_m, (double)track->state[1] - y_m);
                double *into = k < EARLY      ? &flight.early_m
                               : k < STRAIGHT ? &flight.straight_m
                                              : &flight.turning_m;
                *into += off_m * off_m / RUNS /
                         (k < EARLY      ? EARLY - BEGIN
                          : k < STRAIGHT ? STRAIGHT - EARLY
                                         : TURN);
                flight.sure += k >= STRAIGHT + TURN / 2
                                   ? (double)track->maneuver_probability / RUNS / (TURN / 2)
                                   : 0.0;
            }
            for (int part = 0; part < 100; part++) {
                course_rad += k >= STRAIGHT ? 0.01 * 30.0 / 250.0 : 0.0;
                x_m += 2.5 * cos(course_rad);
                y_m += 2.5 * sin(course_rad);
            }
        }
        const struct rho_track_report *track = report_of(1);
        flight.kept += track && track->misses <= 2 && tracker.counters.tracks_started == 1;
    }
    flight.early_m = sqrt(flight.early_m);
    flight.straight_m = sqrt(flight.straight_m);
    flight.turning_m = sqrt(flight.turning_m);
    return flight;
}

/*
 * Targets straight for a while are known equally well whatever steady_s is: it matters before that.
 */
static void steady_s_improves_straight_flight_and_keeps_turns(void **state)
{
    (void)state;
    const struct flight restless = fly_and_turn(0.0f), steady = fly_and_turn(300.0f);
    print_message("early %.1f, with steady_s 300 s %.1f m; straight %.1f, %.1f m; turning %.1f, "
                  "%.1f m; sure %.2f, %.2f\n",
                  restless.early_m, steady.early_m, restless.straight_m, steady.straight_m,
                  restless.turning_m, steady.turning_m, restless.sure, steady.sure);
    assert_true(steady.early_m < 0.9 * restless.early_m); /* measured: 38 m and 31 m */
    assert_true(restless.straight_m < 28.0);              /* measured: 24 m in both */
    assert_true(steady.straight_m < 28.0);
    assert_true(restless.turning_m < 72.0); /* measured: 63 m and 64 m */
    assert_true(steady.turning_m < 72.0);
    assert_true(restless.sure > 0.45 && steady.sure > 0.3); /* measured: 0.63 and 0.50 */
    assert_int_equal(restless.kept, 12);
    assert_int_equal(steady.kept, 12);
}

/* A steady_s shorter than manoeuvres last counts as their duration. */
static void a_steady_s_shorter_than_manoeuvres_has_no_effect(void **state)
{
    static struct rho_report other;
    (void)state;
    for (int i = 0; i < 2; i++) {
        use_usual_configs(1);
        config.steady_s = i ? 1.0f : 0.0f;
        begin_tracker();
        step_scans(0, 20);
        if (i == 0) {
            other = report;
        }
    }
    assert_memory_equal(&report, &other, sizeof report);
}

/* ---- standing objects ------------------------------------------------------------------------ */

static void tracks_that_come_to_a_stand_end_above_v_min(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        for (int has_least = 0; has_least < 2; has_least++) {
            unsigned ended = 0;
            use_usual_configs(3);
            config.gate = (uint8_t)gate;
            config.v_min_mps = has_least ? 50.0f : 0.0f;
            begin_tracker();
            for (int k = 0; k < 40; k++) {
                /* the track flies, then takes plots of something that stands still */
                add_plot(k < 20 ? 400.0 * k - 8000.0 : 10.0 * normal(), 10.0 * normal(), 10.0);
                step_at(2.0 * k);
                for (unsigned i = 0; i < report.num_ended; i++) {
                    ended += report.ended[i] == 1;
                }
            }
            if (has_least) {
                assert_int_equal(ended, 1);
            } else {
                assert_true(report.num_tracks >= 1);
            }
        }
    }
}

static void v_min_out_of_range_is_refused(void **state)
{
    static const float bad[] = {-1.0f, NAN, INFINITY, 701.0f};
    (void)state;
    use_usual_configs(3);
    begin_tracker();
    static struct rho_tracker before;
    before = tracker;
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        config.v_max_mps = 700.0f;
        config.v_min_mps = bad[i];
        assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_ERROR_CONFIG);
        assert_memory_equal(&tracker, &before, sizeof tracker);
    }
    config.v_min_mps = 700.0f;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(existence_follows_the_chain_of_a_targets_life),
        cmocka_unit_test(a_look_that_misses_all_tracks_is_blind),
        cmocka_unit_test(a_track_missed_alone_loses_its_probability),
        cmocka_unit_test(rates_of_life_are_learned_from_established_tracks),
        cmocka_unit_test(without_a_tracker_there_are_no_rates),
        cmocka_unit_test(a_track_in_doubt_comes_back_with_its_identity),
        cmocka_unit_test(a_doubted_track_that_ends_is_reported_as_ended),
        cmocka_unit_test(tracks_never_confirmed_are_not_reported_as_ended),
        cmocka_unit_test(a_weak_track_keeps_no_target_from_starting),
        cmocka_unit_test(misses_of_a_low_pd_sensor_raise_less_doubt),
        cmocka_unit_test(last_misses_are_taken_back_from_the_place),
        cmocka_unit_test(all_tracks_ended_in_a_step_are_reported),
        cmocka_unit_test(of_two_starts_from_one_newest_plot_one_waits),
        cmocka_unit_test(starts_from_different_newest_plots_are_both_made),
        cmocka_unit_test(steady_s_out_of_range_is_refused),
        cmocka_unit_test(steady_s_improves_straight_flight_and_keeps_turns),
        cmocka_unit_test(a_steady_s_shorter_than_manoeuvres_has_no_effect),
        cmocka_unit_test(tracks_that_come_to_a_stand_end_above_v_min),
        cmocka_unit_test(v_min_out_of_range_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
