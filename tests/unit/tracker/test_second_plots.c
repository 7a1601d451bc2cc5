/* SPDX-License-Identifier: MIT */
/*
 * Second plots of one target: one track, once second plots are known; targets that fly together or
 * separate keep or get their own. Figures are tested with tracks and tables made by hand, with the
 * private header.
 */
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define TARGETS 6
#define SIGMA_M 20.0
#define SPEED_MPS 150.0
#define TURN_S 4.0

/*
 * Adds a target's plot with P_D 0.9, and with probability `second` another one up to 6 sigmas off
 * on each axis.
 */
static void see_target_with_second_plot(double x_m, double y_m, double second)
{
    const int is_seen = uniform(0.0, 1.0) < 0.9, is_second = uniform(0.0, 1.0) < second;
    const double dx_m = SIGMA_M * normal(), dy_m = SIGMA_M * normal();
    if (!is_seen) {
        return;
    }
    (void)add_plot(x_m + dx_m, y_m + dy_m, SIGMA_M);
    if (is_second) {
        const double off_m = uniform(-6.0, 6.0) * SIGMA_M, more_m = SIGMA_M * normal();
        (void)add_plot(x_m + off_m + more_m, y_m + uniform(-6.0, 6.0) * SIGMA_M, SIGMA_M);
    }
}

static void see_clutter(void)
{
    for (int i = 0; i < 10; i++) {
        const double x_m = uniform(-40000.0, 80000.0);
        (void)add_plot(x_m, uniform(-40000.0, 80000.0), SIGMA_M);
    }
}

/* Targets far from each other on parallel courses. */
static void see_targets(int k, double second)
{
    for (int i = 0; i < TARGETS; i++) {
        see_target_with_second_plot(-30000.0 + SPEED_MPS * TURN_S * k, 8000.0 * i, second);
    }
}

static int count_confirmed_tracks_near(double x_m, double y_m, double far_m)
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

static float second_plots_per_look(void)
{
    const struct rho_second_plots *table = &tracker.sensors[0].second_plots;
    return table->looks > 0.0f ? table->plots / table->looks : 0.0f;
}

static void a_target_with_second_plots_has_one_track(void **state)
{
    (void)state;
    int others = 0, switches = 0;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        begin_tracker_by_rate(seed);
        for (int k = 0; k < 120; k++) {
            see_targets(k, 0.3);
            see_clutter();
            step_at(TURN_S * k);
            for (int i = 0; i < TARGETS && k >= 30; i++) {
                const int num = count_confirmed_tracks_near(-30000.0 + SPEED_MPS * TURN_S * k,
                                                            8000.0 * i, 1000.0);
                others += num > 1 ? num - 1 : 0;
                switches += num == 0;
            }
        }
        assert_float_equal(second_plots_per_look(), 0.3f, 0.1f);
    }
    /* out of 2700 */
    assert_in_range(others, 0, 350);
    assert_in_range(switches, 0, 40);
}

static void without_second_plots_the_learned_rate_is_low(void **state)
{
    (void)state;
    begin_tracker_by_rate(1);
    for (int k = 0; k < 120; k++) {
        see_targets(k, 0.0);
        see_clutter();
        step_at(TURN_S * k);
    }
    assert_float_equal(second_plots_per_look(), 0.0f, 0.01f);
}

/*
 * Two targets 12 sigmas apart keep two tracks, among targets with second plots up to 6 sigmas off.
 */
static void two_targets_abreast_keep_two_tracks(void **state)
{
    (void)state;
    int both = 0;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        begin_tracker_by_rate(seed);
        for (int k = 0; k < 120; k++) {
            const double x_m = -30000.0 + SPEED_MPS * TURN_S * k;
            see_targets(k, 0.3);
            see_target_with_second_plot(x_m, -8000.0, 0.0);
            see_target_with_second_plot(x_m, -8000.0 - 12.0 * SIGMA_M, 0.0);
            see_clutter();
            step_at(TURN_S * k);
            both += k >= 20 && count_confirmed_tracks_near(x_m, -8000.0, 1000.0) >= 2;
        }
    }
    assert_in_range(both, 294, 300);
}

/*
 * A target separates with 60 m/s from scan 60 on: 12 sigmas apart after one scan, and in most runs
 * two tracks four scans later.
 */
static void a_separating_target_gets_a_track(void **state)
{
    (void)state;
    int found = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        begin_tracker_by_rate(seed);
        for (int k = 0; k <= 65; k++) {
            const double x_m = -30000.0 + SPEED_MPS * TURN_S * k;
            see_targets(k, 0.3);
            if (k > 60) {
                see_target_with_second_plot(x_m + 60.0 * TURN_S * (k - 60), 0.0, 0.3);
            }
            see_clutter();
            step_at(TURN_S * k);
        }
        found += count_confirmed_tracks_near(-30000.0 + SPEED_MPS * TURN_S * 65, 0.0, 1500.0) >= 2;
    }
    assert_in_range(found, 7, 10);
}

#endif

#if RHO_MAX_ECHOES > 0

/* ---- scores by formula ----------------------------------------------------------------------- */

static const struct rho_sensor radar = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 1e5f};
static struct rho_scan scan;
static struct step at;

/* Confirmed tracks with 8 hits and no plot; the second may be on the first one's target. */
static void start_with_tracks(unsigned num_tracks)
{
    use_usual_configs(1);
    config.work_max = 0;
    begin_tracker();
    memset(&report, 0, sizeof report);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    tracker.unclaimed_plots = 100.0f; /* on an area of 100 by 100 km */
    tracker.extent = (struct rho_extent){-50000.0f, 50000.0f, -50000.0f, 50000.0f};
    tracker.num_tracks = (uint16_t)num_tracks;
    for (unsigned row = 0; row < num_tracks; row++) {
        tracker.tracks[row] = (struct rho_track){.track_id = row + 1,
                                                 .status = RHO_TRACK_CONFIRMED,
                                                 .hits = 8,
                                                 .plot = -1,
                                                 .was_confirmed = 1,
                                                 .visible = 1.0f,
                                                 .seen_share = 1.0f,
                                                 .older_id = row};
        tracker.tracks[row].kalman.state[RHO_X] = 20000.0f;
    }
    scan = (struct rho_scan){.sensor_id = 1, .plots = plots};
    tracker.clutter_map.is_looked = 1;
    tracker.num_rows = 1;
    tracker.sensors[0].sensor.sensor_id = 1;
    at = (struct step){.tracker = &tracker,
                       .report = &report,
                       .look = {.tracker = &tracker,
                                .fates = report.fates,
                                .teaches = 1,
                                .row = tracker.sensors,
                                .scan = &scan,
                                .sensor = &radar,
                                .in_view = {3},
                                .log_pd = -0.1f,
                                .log_miss = -2.3f}};
}

/* Adds a plot so many sigmas of 10 m off a place 20 km east. */
static void add_plot_in_sigmas(double along, double across)
{
    (void)add_plot(20000.0 + 10.0 * along, 10.0 * across, 10.0);
    tracker.clutter_map.denser[num_plots - 1] = 0.0f;
    report.fates[num_plots - 1] = RHO_FATE_HELD;
    scan.num_plots = at.look.num_inputs = at.look.num_gated = num_plots;
}

static void set_claim(unsigned row, uint32_t plot)
{
    tracker.tracks[row].plot = (int16_t)plot;
}

/* Scores second plots after the tracks' claims, with the gain in nat of each track's pairs. */
static void score_second_plots(const double gains_nat[2][2])
{
    assert_int_equal(rho_assignment_begin(&tracker.assignment, tracker.num_tracks, num_plots),
                     RHO_OK);
    for (unsigned row = 0; gains_nat && row < 2; row++) {
        for (unsigned plot = 0; plot < num_plots; plot++) {
            if (gains_nat[row][plot] > 0.0) {
                rho_score_add_pair(&tracker, row, plot,
                                   (float)gains_nat[row][plot] - at.look.log_miss);
            }
        }
    }
    for (uint32_t i = 0; i < num_plots; i++) {
        tracker.assignment.column_row[i] = -1;
    }
    rho_plots_index(&tracker, &at.look); /* before plots are claimed */
    for (unsigned row = 0; row < tracker.num_tracks; row++) {
        const int16_t plot = tracker.tracks[row].plot;
        if (plot >= 0) {
            tracker.assignment.column_row[plot] = (int16_t)row;
            report.fates[plot] = RHO_FATE_CLAIMED;
        }
    }
    rho_second_plots_take_look(&at);
}

static void expect_close(double is, double wanted)
{
    assert_true(fabs(is - wanted) <= 3e-4 * fabs(wanted) + 1e-6);
}

static struct rho_second_plots *second_plot_table(void)
{
    return &tracker.sensors[0].second_plots;
}

static void fill_second_plot_table(float looks)
{
    static const float along[RHO_SECOND_BINS] = {2.0f, 1.0f, 1.0f, 0.5f, 0.5f, 0.5f, 0.3f, 0.2f};
    struct rho_second_plots *table = second_plot_table();
    *table = (struct rho_second_plots){.looks = looks, .plots = 6.0f};
    for (int bin = 0; bin < RHO_SECOND_BINS; bin++) {
        table->along[bin] = along[bin];
        table->across[bin] = along[RHO_SECOND_BINS - 1 - bin];
    }
}

/*
 * Expected density of a bin on one axis, over both sides, per sigma; the prior counts as 4 plots.
 */
static double expected_density_of_bin_per_sigma(const float *sums, unsigned bin)
{
    static const double end[] = {1, 2, 3, 4, 6, 8, 12, 16};
    static const double prior[] = {0.26, 0.24, 0.18, 0.12, 0.1, 0.05, 0.03, 0.02};
    return 0.5 * ((double)sums[bin] + 4.0 * prior[bin]) /
           ((6.0 + 4.0) * (end[bin] - (bin > 0 ? end[bin - 1] : 0.0)));
}

/*
 * Rates: the sensor's prior is a hundredth with ten looks, the track's is the sensor's with ten
 * looks.
 */
static void second_plot_scores_equal_their_formula(void **state)
{
    static const double sigmas[][2] = {{0.5, 0.5}, {2.5, 7.0}, {15.0, 3.5}, {-11.0, -15.5}};
    static const unsigned bins[][2] = {{0, 0}, {2, 5}, {7, 3}, {6, 7}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        start_with_tracks(1);
        fill_second_plot_table(50.0f);
        tracker.tracks[0].second_looks = 20.0f;
        tracker.tracks[0].second_plots = 3.0f;
        add_plot_in_sigmas(0.0, 0.0);
        add_plot_in_sigmas(sigmas[i][0], sigmas[i][1]);
        set_claim(0, 0);
        const double of_sensor = (6.0 + 10.0 * 0.01) / (50.0 + 10.0);
        const double rate = (3.0 + 10.0 * of_sensor) / (20.0 + 10.0);
        const double per_m2 =
            expected_density_of_bin_per_sigma(second_plot_table()->along, bins[i][0]) *
            expected_density_of_bin_per_sigma(second_plot_table()->across, bins[i][1]) / 100.0;
        const double ratio = rate * per_m2 / (100.0 / 1e10);
        score_second_plots(NULL);
        expect_close((double)tracker.clutter_map.denser[1], log(1.0 + ratio));
        /* counts that the scan adds */
        expect_close((double)tracker.tracks[0].second_plots, 3.0 + ratio / (1.0 + ratio));
        expect_close((double)tracker.tracks[0].second_looks, 21.0);
        expect_close((double)second_plot_table()->looks, 51.0);
        expect_close((double)second_plot_table()->plots, 6.0 + ratio / (1.0 + ratio));
    }
}

/* A track of eight hits teaches. Sums are halved at 1000 looks of the sensor and 50 of a track. */
static void learned_second_plots_are_kept_and_halved(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const int is_full = i % 2, is_new = i / 2;
        start_with_tracks(1);
        fill_second_plot_table(is_full ? 1000.0f : 999.0f);
        tracker.tracks[0].second_looks = is_full ? 50.0f : 49.0f;
        tracker.tracks[0].hits = is_new ? 7 : 8;
        add_plot_in_sigmas(0.0, 0.0);
        set_claim(0, 0);
        score_second_plots(NULL);
        expect_close((double)second_plot_table()->looks,
                     is_new ? (is_full ? 1000.0 : 999.0) : (is_full ? 501.0 : 1000.0));
        expect_close((double)tracker.tracks[0].second_looks,
                     is_new ? (is_full ? 50.0 : 49.0) : (is_full ? 26.0 : 50.0));
    }
}

/* Work: twelve units for a plot within root 2 times 16 sigmas; none for one beyond. */
static void work_of_second_plots_is_counted(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        start_with_tracks(1);
        fill_second_plot_table(50.0f);
        add_plot_in_sigmas(0.0, 0.0);
        add_plot_in_sigmas(i ? 24.0 : 22.0, 0.0);
        set_claim(0, 0);
        score_second_plots(NULL);
        assert_int_equal(at.work.spent, i ? 0 : 12);
    }
}

/* Up to its twelfth hit a track beside a confirmed one may be on the same target. */
static void after_twelve_hits_a_track_is_a_target_of_its_own(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        start_with_tracks(2);
        fill_second_plot_table(50.0f);
        tracker.tracks[1].older_id = 0;
        tracker.tracks[1].hits = i ? 13 : 12;
        add_plot_in_sigmas(0.0, 0.0);
        add_plot_in_sigmas(3.5, 0.0);
        set_claim(0, 0);
        set_claim(1, 1);
        score_second_plots((const double[2][2]){{5.0, 0.0}, {0.0, 1.0}});
        assert_int_equal(tracker.tracks[1].older_id, !i);
    }
}

/* ---- evidence for one target or two ---------------------------------------------------------- */

/* Evidence for one target, in nat, after a scan; before_nat: evidence before it. */
static double change_of_one_target_evidence_nat(int older_plot, int plot, double far,
                                                const double gains_nat[2][2], float before_nat)
{
    start_with_tracks(2);
    fill_second_plot_table(50.0f);
    tracker.tracks[1].one_target_nat = before_nat;
    add_plot_in_sigmas(0.0, 0.0);
    add_plot_in_sigmas(far, 0.0);
    if (older_plot >= 0) {
        set_claim(0, (uint32_t)older_plot);
    }
    if (plot >= 0) {
        set_claim(1, (uint32_t)plot);
    }
    score_second_plots(gains_nat);
    return (double)tracker.tracks[1].one_target_nat - (double)before_nat;
}

static void a_shared_plot_and_a_miss_each_add_little_evidence(void **state)
{
    (void)state;
    for (int plot = 0; plot < 2; plot++) {
        expect_close(change_of_one_target_evidence_nat(plot, plot, 300.0, NULL, 0.0f), 0.3);
        expect_close(change_of_one_target_evidence_nat(plot, -1, 300.0, NULL, 0.0f), 1.0);
    }
}

/*
 * The younger track is missed although the plot is in its gate: two targets could claim it in two
 * ways.
 */
static void a_younger_track_that_misses_a_plot_in_its_gate_adds_evidence(void **state)
{
    const double rate = ((6.0 + 0.1) / 60.0 * 10.0) / 10.0;
    (void)state;
    for (int plot = 0; plot < 2; plot++) {
        const double both[2][2] = {{plot ? 0.0 : 5.0, plot ? 5.0 : 0.0},
                                   {plot ? 0.0 : 4.0, plot ? 4.0 : 0.0}};
        const double younger[2][2] = {{0.0, 0.0}, {both[1][0], both[1][1]}};
        expect_close(change_of_one_target_evidence_nat(plot, -1, 300.0, both, 0.0f),
                     2.3 - log(2.0) - rate);
        expect_close(change_of_one_target_evidence_nat(plot, -1, 300.0, younger, 0.0f), 2.3 - rate);
    }
}

/* Two plots far apart: the evidence falls by the gain of the younger track. */
static void two_plots_lower_the_evidence_by_the_gain_of_the_younger(void **state)
{
    (void)state;
    expect_close(change_of_one_target_evidence_nat(
                     0, 1, 300.0, (const double[2][2]){{5.0, 0.0}, {0.0, 1.2}}, 0.0f),
                 -1.2);
    expect_close(change_of_one_target_evidence_nat(
                     1, 0, 300.0, (const double[2][2]){{0.0, 5.0}, {1.2, 0.0}}, 0.0f),
                 -1.2);
}

/* A scan changes the evidence by 3 nat at most; above 3 nat the younger track ends. */
static void evidence_above_3_nat_ends_the_younger_track(void **state)
{
    static const double both[2][2] = {{5.0, 5.0}, {4.0, 4.0}}, far[2][2] = {{5.0, 0.0}, {0.0, 9.0}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        const int plot = i / 2;
        start_with_tracks(2);
        fill_second_plot_table(50.0f);
        at.look.log_miss = -20.0f;
        tracker.tracks[1].one_target_nat = i % 2 ? 0.1f : -0.1f;
        add_plot_in_sigmas(0.0, 0.0);
        add_plot_in_sigmas(300.0, 0.0);
        set_claim(0, (uint32_t)plot);
        score_second_plots(both);
        assert_int_equal(tracker.tracks[1].status == RHO_TRACK_FREE, i % 2);
        expect_close((double)tracker.tracks[1].one_target_nat, i % 2 ? 3.0 : 2.9);
    }
    expect_close(change_of_one_target_evidence_nat(0, 1, 300.0, far, 0.0f), -3.0);
}

#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
#if RHO_MAX_ECHOES > 0
        cmocka_unit_test(a_target_with_second_plots_has_one_track),
        cmocka_unit_test(without_second_plots_the_learned_rate_is_low),
        cmocka_unit_test(two_targets_abreast_keep_two_tracks),
        cmocka_unit_test(a_separating_target_gets_a_track),
        cmocka_unit_test(second_plot_scores_equal_their_formula),
        cmocka_unit_test(learned_second_plots_are_kept_and_halved),
        cmocka_unit_test(work_of_second_plots_is_counted),
        cmocka_unit_test(after_twelve_hits_a_track_is_a_target_of_its_own),
        cmocka_unit_test(a_shared_plot_and_a_miss_each_add_little_evidence),
        cmocka_unit_test(a_younger_track_that_misses_a_plot_in_its_gate_adds_evidence),
        cmocka_unit_test(two_plots_lower_the_evidence_by_the_gain_of_the_younger),
        cmocka_unit_test(evidence_above_3_nat_ends_the_younger_track),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
