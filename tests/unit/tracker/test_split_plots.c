/* SPDX-License-Identifier: MIT */
/*
 * Second plots of one target: one track, once they are known; targets that fly together or separate
 * keep or get their own. The figures are those of tracks and tables that are made by hand, which
 * takes the private header.
 */
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define TARGETS 6
#define SIGMA_M 20.0
#define SPEED_MPS 150.0
#define TURN_S 4.0

static void begin_turns(uint64_t seed)
{
    use_usual_configs(seed);
    initiation.scans = 7;
    initiation.min_scans = 0;
    initiation.false_tracks_per_hour = 1.0f;
    config.accel_max_mps2 = 20.0f;
    begin_tracker();
}

/* Its plot, P_D .9; and with `second` a chance of another one up to 6 sigmas off on each axis. */
static void see(double x_m, double y_m, double second)
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
            step_at(TURN_S * k);
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
        step_at(TURN_S * k);
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
            step_at(TURN_S * k);
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
            step_at(TURN_S * k);
        }
        found += num_near(-30000.0 + SPEED_MPS * TURN_S * 65, 0.0, 1500.0) >= 2;
    }
    assert_in_range(found, 7, 10);
}

#endif

#if RHO_MAX_ECHOES > 0

/* ---- figures --------------------------------------------------------------------------------- */

static const struct rho_sensor radar = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 1e5f};
static struct rho_scan scan;
static struct step at;

/*
 * Tracks that were confirmed, with 8 hits and no plot, the second maybe one of the first's target.
 */
static void prepare(unsigned num_tracks)
{
    use_usual_configs(1);
    config.work_max = 0;
    begin_tracker();
    memset(&report, 0, sizeof report);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    tracker.unclaimed_plots = 100.0f; /* on 100 by 100 km */
    tracker.extent = (struct rho_extent){-50000.0f, 50000.0f, -50000.0f, 50000.0f};
    tracker.num_tracks = (uint16_t)num_tracks;
    for (unsigned row = 0; row < num_tracks; row++) {
        tracker.tracks[row] = (struct rho_track){.track_id = row + 1,
                                                 .status = RHO_TRACK_CONFIRMED,
                                                 .hits = 8,
                                                 .plot = -1,
                                                 .was_confirmed = 1,
                                                 .older_id = row};
        tracker.tracks[row].kalman.state[RHO_X] = 20000.0f;
    }
    scan = (struct rho_scan){.sensor_id = 1, .plots = plots};
    tracker.clutter_map.is_looked = 1;
    at = (struct step){.tracker = &tracker,
                       .scan = &scan,
                       .report = &report,
                       .sensor = &radar,
                       .in_view = {3},
                       .log_pd = -0.1f,
                       .log_miss = -2.3f};
}

/* So many sigmas of 10 m from 20 km east. */
static void put(double along, double across)
{
    (void)add_plot(20000.0 + 10.0 * along, 10.0 * across, 10.0);
    tracker.clutter_map.denser[num_plots - 1] = 0.0f;
    report.fates[num_plots - 1] = RHO_FATE_HELD;
    scan.num_plots = at.num_inputs = at.num_gated = num_plots;
}

static void claim(unsigned row, uint32_t plot)
{
    tracker.tracks[row].plot = (int16_t)plot;
}

/* What the step decides on, with the gains in nat of what each of two tracks was offered. */
static void expect(const double gains_nat[2][2])
{
    assert_int_equal(rho_assignment_begin(&tracker.assignment, tracker.num_tracks, num_plots),
                     RHO_OK);
    for (unsigned row = 0; gains_nat && row < 2; row++) {
        for (unsigned plot = 0; plot < num_plots; plot++) {
            if (gains_nat[row][plot] > 0.0) {
                rho_tracker_add_assignment_pair(&at, row, plot,
                                                (float)gains_nat[row][plot] - at.log_miss);
            }
        }
    }
    for (uint32_t i = 0; i < num_plots; i++) {
        tracker.assignment.column_row[i] = -1;
    }
    rho_tracker_index_plots(&at); /* as before they are claimed */
    for (unsigned row = 0; row < tracker.num_tracks; row++) {
        const int16_t plot = tracker.tracks[row].plot;
        if (plot >= 0) {
            tracker.assignment.column_row[plot] = (int16_t)row;
            report.fates[plot] = RHO_FATE_CLAIMED;
        }
    }
    rho_tracker_learn_second_plots_end_duplicates(&at);
}

static void expect_close(double is, double wanted)
{
    assert_true(fabs(is - wanted) <= 3e-4 * fabs(wanted) + 1e-6);
}

static struct rho_second_plots *table_of_radar(void)
{
    return &tracker.second_plots[0];
}

static void fill_table(float looks)
{
    static const float along[RHO_SECOND_BINS] = {2.0f, 1.0f, 1.0f, 0.5f, 0.5f, 0.5f, 0.3f, 0.2f};
    struct rho_second_plots *table = table_of_radar();
    *table = (struct rho_second_plots){.sensor_id = 1, .looks = looks, .plots = 6.0f};
    for (int bin = 0; bin < RHO_SECOND_BINS; bin++) {
        table->along[bin] = along[bin];
        table->across[bin] = along[RHO_SECOND_BINS - 1 - bin];
    }
}

/* Share of an axis' bin a sigma, of both sides; 4 plots are the prior's. */
static double share_of(const float *sums, unsigned bin)
{
    static const double end[] = {1, 2, 3, 4, 6, 8, 12, 16};
    static const double prior[] = {0.26, 0.24, 0.18, 0.12, 0.1, 0.05, 0.03, 0.02};
    return 0.5 * ((double)sums[bin] + 4.0 * prior[bin]) /
           ((6.0 + 4.0) * (end[bin] - (bin > 0 ? end[bin - 1] : 0.0)));
}

/* A hundredth of ten looks is the sensor's prior, its rate in ten looks the track's. */
static void a_second_plot_is_expected_as_derived(void **state)
{
    static const double sigmas[][2] = {{0.5, 0.5}, {2.5, 7.0}, {15.0, 3.5}, {-11.0, -15.5}};
    static const unsigned bins[][2] = {{0, 0}, {2, 5}, {7, 3}, {6, 7}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        prepare(1);
        fill_table(50.0f);
        tracker.tracks[0].second_looks = 20.0f;
        tracker.tracks[0].second_plots = 3.0f;
        put(0.0, 0.0);
        put(sigmas[i][0], sigmas[i][1]);
        claim(0, 0);
        const double of_sensor = (6.0 + 10.0 * 0.01) / (50.0 + 10.0);
        const double rate = (3.0 + 10.0 * of_sensor) / (20.0 + 10.0);
        const double per_m2 = share_of(table_of_radar()->along, bins[i][0]) *
                              share_of(table_of_radar()->across, bins[i][1]) / 100.0;
        const double ratio = rate * per_m2 / (100.0 / 1e10);
        expect(NULL);
        expect_close((double)tracker.clutter_map.denser[1], log(1.0 + ratio));
        /* what it teaches */
        expect_close((double)tracker.tracks[0].second_plots, 3.0 + ratio / (1.0 + ratio));
        expect_close((double)tracker.tracks[0].second_looks, 21.0);
        expect_close((double)table_of_radar()->looks, 51.0);
        expect_close((double)table_of_radar()->plots, 6.0 + ratio / (1.0 + ratio));
    }
}

/* A track of eight hits teaches. Sums are halved at 1000 looks of the sensor, and 50 of a track. */
static void what_is_taught_is_remembered(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const int is_full = i % 2, is_new = i / 2;
        prepare(1);
        fill_table(is_full ? 1000.0f : 999.0f);
        tracker.tracks[0].second_looks = is_full ? 50.0f : 49.0f;
        tracker.tracks[0].hits = is_new ? 7 : 8;
        put(0.0, 0.0);
        claim(0, 0);
        expect(NULL);
        expect_close((double)table_of_radar()->looks,
                     is_new ? (is_full ? 1000.0 : 999.0) : (is_full ? 501.0 : 1000.0));
        expect_close((double)tracker.tracks[0].second_looks,
                     is_new ? (is_full ? 50.0 : 49.0) : (is_full ? 26.0 : 50.0));
    }
}

/* Twelve units for a plot within root 2 times 16 sigmas; none for one beyond. */
static void work_for_second_plots_is_counted(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        prepare(1);
        fill_table(50.0f);
        put(0.0, 0.0);
        put(i ? 24.0 : 22.0, 0.0);
        claim(0, 0);
        expect(NULL);
        assert_int_equal(at.work, i ? 0 : 12);
    }
}

/* Up to its twelfth hit a track beside a confirmed one may be one of the same target. */
static void a_track_with_more_hits_is_another_target(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        prepare(2);
        fill_table(50.0f);
        tracker.tracks[1].older_id = 0;
        tracker.tracks[1].hits = i ? 13 : 12;
        put(0.0, 0.0);
        put(3.5, 0.0);
        claim(0, 0);
        claim(1, 1);
        expect((const double[2][2]){{5.0, 0.0}, {0.0, 1.0}});
        assert_int_equal(tracker.tracks[1].older_id, !i);
    }
}

/* ---- one target or two ----------------------------------------------------------------------- */

/* The evidence for one target that a scan adds; before: what there was. */
static double evidence(int older_plot, int plot, double far, const double gains_nat[2][2],
                       float before_nat)
{
    prepare(2);
    fill_table(50.0f);
    tracker.tracks[1].one_target_nat = before_nat;
    put(0.0, 0.0);
    put(far, 0.0);
    if (older_plot >= 0) {
        claim(0, (uint32_t)older_plot);
    }
    if (plot >= 0) {
        claim(1, (uint32_t)plot);
    }
    expect(gains_nat);
    return (double)tracker.tracks[1].one_target_nat - (double)before_nat;
}

static void a_shared_plot_and_a_miss_tell_a_little(void **state)
{
    (void)state;
    for (int plot = 0; plot < 2; plot++) {
        expect_close(evidence(plot, plot, 300.0, NULL, 0.0f), 0.3);
        expect_close(evidence(plot, -1, 300.0, NULL, 0.0f), 1.0);
    }
}

/* The younger is missed, though the plot is in its gate: in both, two targets have two ways. */
static void a_plot_in_both_gates_tells_by_the_miss(void **state)
{
    const double rate = ((6.0 + 0.1) / 60.0 * 10.0) / 10.0;
    (void)state;
    for (int plot = 0; plot < 2; plot++) {
        const double both[2][2] = {{plot ? 0.0 : 5.0, plot ? 5.0 : 0.0},
                                   {plot ? 0.0 : 4.0, plot ? 4.0 : 0.0}};
        const double younger[2][2] = {{0.0, 0.0}, {both[1][0], both[1][1]}};
        expect_close(evidence(plot, -1, 300.0, both, 0.0f), 2.3 - log(2.0) - rate);
        expect_close(evidence(plot, -1, 300.0, younger, 0.0f), 2.3 - rate);
    }
}

/* Far from each other: the younger's gain is that of two targets. */
static void two_plots_tell_by_the_younger_s_gain(void **state)
{
    (void)state;
    expect_close(evidence(0, 1, 300.0, (const double[2][2]){{5.0, 0.0}, {0.0, 1.2}}, 0.0f), -1.2);
    expect_close(evidence(1, 0, 300.0, (const double[2][2]){{0.0, 5.0}, {1.2, 0.0}}, 0.0f), -1.2);
}

/* A scan adds or takes 3 nat at most, and beyond 3 the younger ends. */
static void one_target_ends_the_younger(void **state)
{
    static const double both[2][2] = {{5.0, 5.0}, {4.0, 4.0}}, far[2][2] = {{5.0, 0.0}, {0.0, 9.0}};
    (void)state;
    for (int i = 0; i < 4; i++) {
        const int plot = i / 2;
        prepare(2);
        fill_table(50.0f);
        at.log_miss = -20.0f;
        tracker.tracks[1].one_target_nat = i % 2 ? 0.1f : -0.1f;
        put(0.0, 0.0);
        put(300.0, 0.0);
        claim(0, (uint32_t)plot);
        expect(both);
        assert_int_equal(tracker.tracks[1].status == RHO_TRACK_FREE, i % 2);
        expect_close((double)tracker.tracks[1].one_target_nat, i % 2 ? 3.0 : 2.9);
    }
    expect_close(evidence(0, 1, 300.0, far, 0.0f), -3.0);
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
        cmocka_unit_test(a_second_plot_is_expected_as_derived),
        cmocka_unit_test(what_is_taught_is_remembered),
        cmocka_unit_test(work_for_second_plots_is_counted),
        cmocka_unit_test(a_track_with_more_hits_is_another_target),
        cmocka_unit_test(a_shared_plot_and_a_miss_tell_a_little),
        cmocka_unit_test(a_plot_in_both_gates_tells_by_the_miss),
        cmocka_unit_test(two_plots_tell_by_the_younger_s_gain),
        cmocka_unit_test(one_target_ends_the_younger),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
