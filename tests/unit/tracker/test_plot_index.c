/* SPDX-License-Identifier: MIT */
/*
 * Which plots a track considers must not depend on other plots far away, or on the order of plots
 * (RHO_PLOT_STRIPS; the same holds without strips).
 */
#include "tracker_setup.h"

#define TARGETS 12
#define CLUTTER 100
#define SCANS 14

struct target {
    double x_m, y_m, vx_mps, vy_mps;
};

static struct target targets[TARGETS];
static int targets_of[PLOTS_MAX]; /* target of each plot by its row; -1: clutter */
static struct rho_report other;
static int other_targets_of[PLOTS_MAX];

static void begin_scene(uint8_t gate)
{
    use_usual_configs(7);
    config.gate = gate;
    begin_tracker();
    for (int i = 0; i < TARGETS; i++) {
        const double course_rad = uniform(-3.14159, 3.14159);
        const double x_m = uniform(-3e4, 3e4), y_m = uniform(-3e4, 3e4);
        targets[i] = (struct target){x_m, y_m, 250.0 * cos(course_rad), 250.0 * sin(course_rad)};
    }
}

static void add_plot_of(int target, double x_m, double y_m, double offset_s)
{
    targets_of[num_plots] = target;
    add_plot(x_m, y_m, 20.0)->offset_us = (int32_t)lround(offset_s * 1e6);
}

/*
 * Adds plots of targets and clutter; turn_s: at their own times, up to so much later than the scan.
 */
static void see_targets_and_clutter(int k, double turn_s)
{
    for (int i = 0; i < TARGETS; i++) {
        const double own_s = floor(uniform(0.0, turn_s) * 1e6) * 1e-6, t_s = 2.0 * k + own_s;
        const double x_m = targets[i].x_m + targets[i].vx_mps * t_s + 20.0 * normal();
        add_plot_of(i, x_m, targets[i].y_m + targets[i].vy_mps * t_s + 20.0 * normal(), own_s);
    }
    for (int i = 0; i < CLUTTER; i++) {
        const double x_m = uniform(-4e4, 4e4), y_m = uniform(-4e4, 4e4);
        add_plot_of(-1, x_m, y_m, floor(uniform(0.0, turn_s) * 1e6) * 1e-6);
    }
}

static uint64_t order_state = 1;

/* Shuffles plots with its own random numbers, so that the scene stays the same. */
static void shuffle_plots(void)
{
    for (uint32_t i = num_plots; i > 1; i--) {
        order_state = order_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        const uint32_t k = (uint32_t)(order_state >> 33) % i;
        const struct rho_plot plot = plots[i - 1];
        const int of = targets_of[i - 1];
        plots[i - 1] = plots[k];
        targets_of[i - 1] = targets_of[k];
        plots[k] = plot;
        targets_of[k] = of;
    }
}

static int target_of_track(const struct rho_track_report *track, const int *of)
{
    return track->plot < 0 ? -2 : of[track->plot];
}

static const struct rho_track_report *track_of_same_state(const struct rho_track_report *track)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if (memcmp(report.tracks[i].state, track->state, sizeof track->state) == 0) {
            return &report.tracks[i];
        }
    }
    return NULL;
}

/*
 * Both runs report the same tracks, with the same bits and the same target's plot; identities may
 * be in another order.
 */
static void expect_same_tracks(void)
{
    assert_int_equal(report.num_tracks, other.num_tracks);
    assert_int_equal(report.num_ended, other.num_ended);
    assert_memory_equal(report.fates_total, other.fates_total, sizeof report.fates_total);
    for (unsigned i = 0; i < other.num_tracks; i++) {
        const struct rho_track_report *track = &other.tracks[i], *twin = track_of_same_state(track);
        assert_non_null(twin);
        assert_int_equal(target_of_track(twin, targets_of),
                         target_of_track(track, other_targets_of));
        assert_int_equal(twin->hits, track->hits);
        assert_memory_equal(twin->covariance, track->covariance, sizeof track->covariance);
    }
}

/* ---- the order of plots ---------------------------------------------------------------------- */

/* Steps both orders scan by scan, each with its own objects. */
static unsigned compare_both_orders(uint8_t gate, double turn_s)
{
    static struct rho_tracker other_tracker;
    static struct rho_initiator other_initiator;
    static struct rho_plot kept[PLOTS_MAX];
    unsigned most = 0;
    begin_scene(gate);
    other_tracker = tracker;
    other_initiator = initiator;
    for (int k = 0; k < SCANS; k++) {
        see_targets_and_clutter(k, turn_s);
        const struct rho_scan scan = {
            .time_us = 2000000 * (int64_t)k, .num_plots = num_plots, .plots = kept};
        memcpy(kept, plots, sizeof kept);
        memcpy(other_targets_of, targets_of, sizeof targets_of);
        assert_int_equal(rho_tracker_step(&other_tracker, &other_initiator, &scan, &other), RHO_OK);
        shuffle_plots();
        step_at(2.0 * k);
        expect_same_tracks();
        most = report.num_tracks > most ? report.num_tracks : most;
    }
    return most;
}

static void plots_in_any_order_make_the_same_tracks(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        assert_true(compare_both_orders((uint8_t)gate, 0.0) >= TARGETS);
    }
}

static void plots_with_own_times_in_any_order_make_the_same_tracks(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        assert_true(compare_both_orders((uint8_t)gate, 1.9) >= TARGETS);
    }
}

/* ---- plots far away -------------------------------------------------------------------------- */

/* One track at the origin, flying along x at 300 m/s; no other tracks are started. */
static void start_one_track(uint8_t gate)
{
    use_usual_configs(3);
    config.gate = gate;
    begin_tracker();
    for (int k = 0; k < 8; k++) {
        add_plot(600.0 * (k - 8), 0.0, 20.0);
        for (int i = 0; i < 4 && k == 0; i++) {
            add_plot(i & 1 ? 2e6 : -2e6, i & 2 ? 2e6 : -2e6,
                     20.0); /* keeps the area over which clutter is spread */
        }
        step_at(2.0 * k);
    }
    assert_int_equal(report.num_tracks, 1);
}

static void step_copy(const struct rho_tracker *from, struct rho_tracker *tracker_then)
{
    const struct rho_scan scan = {.time_us = 16000000, .num_plots = num_plots, .plots = plots};
    *tracker_then = *from;
    memset(&report, 0xee, sizeof report);
    assert_int_equal(rho_tracker_step(tracker_then, NULL, &scan, &report), RHO_OK);
}

/*
 * Steps the plot at (x, y), with its own time and noise, alone and then among far plots: the
 * track's result is the same. Returns 1 if the track claimed the plot.
 */
static int is_claimed_also_among_far_plots(double x_m, double y_m, int32_t offset_us,
                                           double sigma_m)
{
    /*
     * extents that the strips are laid over: the plot alone, one x, narrow, wide, maximal, one
     * side, crowded
     */
    static const double from_m[] = {1.0, 5e4, -2e4, -2e6, 9e4, -2e6, 1e5};
    static const double to_m[] = {1.0, 5e4, 2e4, 2e6, 2e6, -9e4, 1.001e5};
    static struct rho_tracker then;
    struct rho_track_report alone;
    num_plots = 0;
    add_plot(x_m, y_m, sigma_m)->offset_us = offset_us;
    step_copy(&tracker, &then);
    alone = report.tracks[0];
    for (size_t i = 1; i < sizeof from_m / sizeof from_m[0]; i++) {
        num_plots = 0;
        for (int n = 0; n < 120; n++) {
            const double at_m = n == 0 ? from_m[i] : n == 1 ? to_m[i] : uniform(from_m[i], to_m[i]);
            add_plot(at_m, n % 2 ? 8e4 : -8e4, 20.0);
        }
        plots[60].x_m = (float)x_m;
        plots[60].y_m = (float)y_m;
        plots[60].sigma_range_m = plots[60].sigma_cross_m = (float)sigma_m;
        plots[60].offset_us = offset_us;
        step_copy(&tracker, &then);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].plot, alone.plot < 0 ? -1 : 60);
        assert_memory_equal(report.tracks[0].state, alone.state, sizeof alone.state);
        assert_memory_equal(&report.tracks[0].score_nat, &alone.score_nat, sizeof alone.score_nat);
    }
    num_plots = 0;
    return alone.plot >= 0;
}

static void far_plots_do_not_hide_a_plot_in_the_gate(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        int claimed = 0, refused = 0;
        start_one_track((uint8_t)gate);
        for (double x_m = -300.0; x_m <= 300.0; x_m += 12.5) {
            const int is_claimed = is_claimed_also_among_far_plots(x_m, 0.0, 0, 20.0);
            claimed += is_claimed;
            refused += !is_claimed;
        }
        assert_true(claimed >= 3 && refused >= 3);
    }
}

/* Seconds before or after the scan's time a target is hundreds of metres away, in other strips. */
static void plots_of_own_times_are_found_in_other_strips(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_one_track((uint8_t)gate);
        for (int offset_s = -1; offset_s <= 8; offset_s++) {
            assert_true(
                is_claimed_also_among_far_plots(300.0 * offset_s, 0.0, offset_s * 1000000, 20.0));
            assert_false(is_claimed_also_among_far_plots(300.0 * offset_s + 2500.0, 0.0,
                                                         offset_s * 1000000, 20.0));
        }
    }
}

/* One plot of a scan may have a much larger sigma than the others. */
static void plots_with_large_sigmas_are_found(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_one_track((uint8_t)gate);
        assert_true(is_claimed_also_among_far_plots(500.0, 0.0, 0, 300.0));
        assert_true(is_claimed_also_among_far_plots(-500.0, 100.0, 0, 300.0));
        assert_false(is_claimed_also_among_far_plots(500.0, 0.0, 0, 10.0));
    }
}

/* ---- plots at the limits of places, on borders of strips ------------------------------------- */

/* Tracks a target that flies along y at x_m, alone or with plots at all limits of places. */
static void track_target_at(double x_m, int has_others)
{
    use_usual_configs(5);
    begin_tracker();
    for (int k = 0; k < 8; k++) {
        add_plot(x_m, 400.0 * k, 20.0);
        for (int i = 0; i < 4 && has_others; i++) {
            add_plot(i & 1 ? 2e6 : -2e6, i & 2 ? 2e6 : -2e6, 20.0);
        }
        add_plot(NAN, 0.0, 20.0);
        add_plot(INFINITY, 0.0, 20.0);
        step_at(2.0 * k);
        if (k >= 4) {
            assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
            assert_int_equal(report.fates_total[RHO_FATE_INVALID], 2);
        }
    }
}

static void plots_at_the_limits_of_places_are_claimed(void **state)
{
    static const double x_m[] = {-2e6, -1999999.0, -1.0, 0.0, 1.0, 1999999.0, 2e6};
    (void)state;
    for (size_t i = 0; i < sizeof x_m / sizeof x_m[0]; i++) {
        track_target_at(x_m[i], 0);
        track_target_at(x_m[i], 1);
    }
}

/*
 * At as many places as there are strips and some more, exactly on their borders: 1024 m wide, or a
 * power of two of it.
 */
static void plots_on_borders_of_strips_are_claimed(void **state)
{
    enum { COUNT = 17 };
    (void)state;
    for (int shift = 0; shift < 3; shift++) {
        use_usual_configs(5);
        begin_tracker();
        for (int k = 0; k < 8; k++) {
            for (int i = 0; i < COUNT; i++) {
                add_plot(i * 4096.0 * (1 << shift), 300.0 * k, 1.0);
            }
            step_at(2.0 * k);
        }
        assert_int_equal(report.num_tracks, COUNT);
        assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], COUNT);
        assert_int_equal(tracker.counters.tracks_started, COUNT);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plots_in_any_order_make_the_same_tracks),
        cmocka_unit_test(plots_with_own_times_in_any_order_make_the_same_tracks),
        cmocka_unit_test(far_plots_do_not_hide_a_plot_in_the_gate),
        cmocka_unit_test(plots_of_own_times_are_found_in_other_strips),
        cmocka_unit_test(plots_with_large_sigmas_are_found),
        cmocka_unit_test(plots_at_the_limits_of_places_are_claimed),
        cmocka_unit_test(plots_on_borders_of_strips_are_claimed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
