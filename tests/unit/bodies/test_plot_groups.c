/* SPDX-License-Identifier: MIT */
/*
 * Which plots of a scan one target can have given, at both sides of each limit. Tracks and bodies
 * are made by hand, with the private header, as those of a scene never stand exactly at a limit.
 */
#include "../../src/bodies/bodies.h"
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define LONGEST_M 10.0f
/* row of the second track; builds without bodies skip these tests */
#define SECOND (RHO_BODIES ? 1 : 0)

static const struct rho_sensor radar = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 5e3f};
static struct rho_scan scan;
static struct step at;

static void start_tracker_with_bodies(uint32_t measures)
{
    use_usual_configs(1);
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    config.work_max = 0;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    assert_int_equal(rho_tracker_set_body_max(&tracker, LONGEST_M), RHO_OK);
    scan = (struct rho_scan){.sensor_id = 1, .measures = measures, .plots = plots};
}

/* Adds a plot of 0.5 m and 1 m/s sigma, 1 km east of the radar. */
static void add_plot_near_track(double x_m, double y_m, double rate_mps)
{
    struct rho_plot *plot = add_plot(1000.0 + x_m, y_m, 0.5);
    plot->range_rate_mps = (float)rate_mps;
    plot->sigma_range_rate_mps = 1.0f;
}

/*
 * A track flying east at 10 m/s, with sigmas of 1 m and 1 m/s, whose body was shaped by so many
 * plots.
 */
static void make_track_with_body(float plots_seen_so_far)
{
    struct rho_track *track = &tracker.tracks[0];
    struct rho_body_filter *body = &tracker.bodies.of[0];
    *track = (struct rho_track){.track_id = 1, .status = RHO_TRACK_CONFIRMED, .plot = -1};
    track->kalman.state[RHO_X] = 1000.0f;
    track->kalman.state[RHO_VX] = 10.0f;
    for (int i = 0; i < 2; i++) {
        track->kalman.covariance[RHO_AT(i, i)] = track->kalman.covariance[RHO_AT(3 + i, 3 + i)] =
            1.0f;
    }
    *body = (struct rho_body_filter){.track_id = 1,
                                     .along_m2 = 7.75f,
                                     .across_m2 = 0.25f,
                                     .along = {.weight = 1e6f},
                                     .across = {.weight = 1e6f},
                                     .prior_m2 = 1.0f,
                                     .cos_heading = 1.0f,
                                     .plots = plots_seen_so_far,
                                     .plots_a_look = 1.0f,
                                     .has_heading = 1};
    tracker.num_tracks = tracker.bodies.count = 1;
}

static void group_plots(void)
{
    static struct rho_scan grouped;
    scan.num_plots = num_plots;
    at = (struct step){.tracker = &tracker,
                       .grouped = &grouped,
                       .report = &report,
                       .look = {.tracker = &tracker,
                                .fates = report.fates,
                                .teaches = 1,
                                .scan = &scan,
                                .sensor = &radar,
                                .num_inputs = num_plots,
                                .num_gated = num_plots,
                                .in_view = {3}}};
    rho_bodies_group(&at);
}

static int owner_of_plot(uint32_t plot)
{
    const struct rho_groups *groups = &tracker.bodies.groups;
    return plot >= RHO_BODY_PLOTS || groups->owner[plot] == RHO_NO_ROW ? -1 : groups->owner[plot];
}

static int contender_of_plot(uint32_t plot)
{
    const struct rho_groups *groups = &tracker.bodies.groups;
    return plot >= RHO_BODY_PLOTS || groups->contender[plot] == RHO_NO_ROW
               ? -1
               : groups->contender[plot];
}

/* ---- plots without a track ------------------------------------------------------------------- */

static unsigned count_groups_of_two_plots(uint32_t measures, double apart_m, double rate_mps)
{
    start_tracker_with_bodies(measures);
    add_plot_near_track(0.0, 0.0, 0.0);
    add_plot_near_track(0.0, apart_m, rate_mps);
    group_plots();
    return tracker.bodies.groups.count;
}

/* Plots may be two sigmas of both beyond the longest target apart: 10 + 2 (0.5 + 0.5) m. */
static void plots_within_the_longest_length_form_one_group(void **state)
{
    (void)state;
    assert_int_equal(count_groups_of_two_plots(0, 11.9, 0.0), 1);
    assert_int_equal(count_groups_of_two_plots(0, 12.1, 0.0), 2);
    assert_int_equal(count_groups_of_two_plots(0, -11.9, 0.0), 1);
}

/*
 * Range rates may differ by four sigmas of their noise, 1 m/s each, and by two of a turn and of the
 * speed across the line of sight: root(16 (1 + 1) + 4 (0.1^2 + 0.02^2) d^2) m/s, with d across the
 * line of sight at most 0.41 of the longest, or the noise of both places.
 */
static void plots_of_different_range_rates_form_two_groups(void **state)
{
    (void)state;
    assert_int_equal(count_groups_of_two_plots(RHO_MEASURES_RANGE_RATE, 5.0, 5.7), 1);
    assert_int_equal(count_groups_of_two_plots(RHO_MEASURES_RANGE_RATE, 5.0, 5.74), 2);
    assert_int_equal(count_groups_of_two_plots(RHO_MEASURES_RANGE_RATE, 5.0, -5.7), 1);
    assert_int_equal(count_groups_of_two_plots(RHO_MEASURES_RANGE_RATE, 5.0, -5.74), 2);
    assert_int_equal(count_groups_of_two_plots(RHO_MEASURES_RANGE_RATE, 1.0, 5.65), 1);
    assert_int_equal(count_groups_of_two_plots(RHO_MEASURES_RANGE_RATE, 1.0, 5.69), 2);
    assert_int_equal(count_groups_of_two_plots(0, 5.0, 99.0), 1);
}

/* ---- plots of a track ------------------------------------------------------------------------ */

/* The gate is three sigmas: along root(1 + 7.75 + 0.25) m, across root(1 + 0.25 + 0.25) m. */
static void a_track_owns_plots_within_its_body_gate(void **state)
{
    (void)state;
    start_tracker_with_bodies(0);
    make_track_with_body(100.0f);
    add_plot_near_track(8.9, 0.0, 0.0);
    add_plot_near_track(-9.1, 0.0, 0.0);
    add_plot_near_track(0.0, 3.6, 0.0);
    add_plot_near_track(0.0, -3.75, 0.0);
    group_plots();
    assert_int_equal(owner_of_plot(0), 0);
    assert_int_equal(owner_of_plot(1), -1);
    assert_int_equal(owner_of_plot(2), 0);
    assert_int_equal(owner_of_plot(3), -1);
}

/*
 * The gate in range rate is four sigmas of both, 8 m/s, and 0.3 m/s for each metre off the middle.
 */
static void a_track_owns_plots_of_its_range_rate_only(void **state)
{
    (void)state;
    start_tracker_with_bodies(RHO_MEASURES_RANGE_RATE);
    make_track_with_body(100.0f);
    add_plot_near_track(0.0, 0.0, 17.9);
    add_plot_near_track(0.0, 0.0, 18.1);
    add_plot_near_track(5.0, 0.0, 19.4);
    add_plot_near_track(5.0, 0.0, 19.6);
    group_plots();
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(owner_of_plot(i), i % 2 ? -1 : 0);
    }
}

/*
 * Two tracks that differ in velocity alone. A plot goes to the track whose range rate is likelier,
 * by -2 ln of the likelihoods; the other track contends for it if the difference is below 6.
 */
static void range_rates_decide_which_track_owns_a_plot(void **state)
{
    (void)state;
    start_tracker_with_bodies(RHO_MEASURES_RANGE_RATE);
    make_track_with_body(100.0f);
    tracker.tracks[SECOND] = tracker.tracks[0];
    tracker.bodies.of[SECOND] = tracker.bodies.of[0];
    tracker.tracks[SECOND].track_id = tracker.bodies.of[SECOND].track_id = 2;
    tracker.tracks[SECOND].kalman.state[RHO_VX] = 14.0f;
    tracker.bodies.of[SECOND].two_nat = 30.0f; /* they are known to be two */
    tracker.num_tracks = tracker.bodies.count = 2;
    add_plot_near_track(0.0, 0.0, 10.0); /* 16 / 2 worse for the second track */
    add_plot_near_track(0.0, 0.0, 11.5);
    add_plot_near_track(0.0, 0.0, 12.5);
    add_plot_near_track(0.0, 0.0, 14.0);
    add_plot_near_track(0.0, 0.0, 10.45); /* (3.55^2 - 0.45^2) / 2 = 6.2 */
    add_plot_near_track(0.0, 0.0, 10.55); /* (3.45^2 - 0.55^2) / 2 = 5.8 */
    group_plots();
    for (uint32_t i = 0; i < 6; i++) {
        const int is_second = i == 2 || i == 3, is_contested = i == 1 || i == 2 || i == 5;
        assert_int_equal(owner_of_plot(i), is_second);
        assert_int_equal(contender_of_plot(i), is_contested ? !is_second : -1);
    }
}

/* ---- work and rows --------------------------------------------------------------------------- */

static void the_gate_of_an_unknown_body_is_half_the_longest(void **state)
{
    (void)state;
    start_tracker_with_bodies(0);
    assert_float_equal(rho_bodies_prior_m2(&tracker), 5.0 * 5.0 / 12.0, 1e-6);
}

/*
 * Work units: four for a plot and a body, two for a pair of plots, one for each skipped plot; and
 * two for each track, and one for each plot near it, as its neighbours are looked for.
 */
static void work_of_grouping_is_counted(void **state)
{
    (void)state;
    start_tracker_with_bodies(0);
    make_track_with_body(100.0f);
    add_plot_near_track(0.0, 0.0, 0.0);
    group_plots();
    assert_int_equal(at.work.spent, 4 + 2 + 1);
    (void)count_groups_of_two_plots(0, 5.0, 0.0);
    assert_int_equal(at.work.spent, 2 + 2 * 1);
    tracker.config.work_max = 800000;
    group_plots();
    assert_int_equal(at.work.share.end, 200000); /* grouping may use a quarter of all work */
}

static void group_rows_are_mapped_back_to_plot_rows(void **state)
{
    (void)state;
    start_tracker_with_bodies(0);
    make_track_with_body(100.0f);
    add_plot_near_track(0.0, 100.0, 0.0);
    add_plot_near_track(1.0, 105.0, 0.0); /* in the group of the first plot */
    add_plot_near_track(0.0, 0.0, 0.0);
    group_plots();
    assert_int_equal(tracker.bodies.groups.count, 2);
    tracker.tracks[0].plot = 1;
    report.fates[0] = RHO_FATE_HELD;
    report.fates[1] = RHO_FATE_CLAIMED;
    rho_bodies_ungroup(&tracker, &at.look, &scan);
    assert_int_equal(tracker.tracks[0].plot, 2);
    assert_int_equal(report.fates[1], RHO_FATE_HELD);
    assert_int_equal(report.fates[2], RHO_FATE_CLAIMED);
    tracker.tracks[0].plot = -1;
    rho_bodies_ungroup(&tracker, &at.look, &scan);
    assert_int_equal(tracker.tracks[0].plot, -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plots_within_the_longest_length_form_one_group),
        cmocka_unit_test(plots_of_different_range_rates_form_two_groups),
        cmocka_unit_test(a_track_owns_plots_within_its_body_gate),
        cmocka_unit_test(a_track_owns_plots_of_its_range_rate_only),
        cmocka_unit_test(range_rates_decide_which_track_owns_a_plot),
        cmocka_unit_test(the_gate_of_an_unknown_body_is_half_the_longest),
        cmocka_unit_test(work_of_grouping_is_counted),
        cmocka_unit_test(group_rows_are_mapped_back_to_plot_rows),
    };
    return RHO_BODIES ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
