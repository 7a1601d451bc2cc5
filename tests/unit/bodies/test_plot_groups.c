/* SPDX-License-Identifier: MIT */
/*
 * Which plots of a scan one target can have given, at both sides of each limit. Tracks and their
 * bodies are made by hand, which takes the private header: those of a scene never stand at a limit.
 */
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#define LONGEST_M 10.0f
#define SECOND (RHO_BODIES ? 1 : 0) /* row of the other track; without bodies nothing runs */

static const struct rho_sensor radar = {.sensor_id = 1, .pd = 0.9f, .range_max_m = 5e3f};
static struct rho_scan scan;
static struct step at;

static void prepare(uint32_t measures)
{
    use_usual_configs(1);
    config.v_max_mps = initiation.v_max_mps = 60.0f;
    config.work_max = 0;
    begin_tracker();
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    assert_int_equal(rho_tracker_set_body_max(&tracker, LONGEST_M), RHO_OK);
    scan = (struct rho_scan){.sensor_id = 1, .measures = measures, .plots = plots};
}

/* A plot of 0.5 m and 1 m/s, 1 km east of the radar. */
static void see(double x_m, double y_m, double rate_mps)
{
    struct rho_plot *plot = add_plot(1000.0 + x_m, y_m, 0.5);
    plot->range_rate_mps = (float)rate_mps;
    plot->sigma_range_rate_mps = 1.0f;
}

/*
 * One that flies east at 10 m/s, 1 m and 1 m/s uncertain, whose body is known from so many plots.
 */
static void have_track(float plots_of_body)
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
                                     .plots = plots_of_body,
                                     .has_heading = 1};
    tracker.num_tracks = tracker.bodies.count = 1;
}

static void group(void)
{
    static struct rho_scan grouped;
    scan.num_plots = num_plots;
    at = (struct step){.tracker = &tracker,
                       .scan = &scan,
                       .report = &report,
                       .sensor = &radar,
                       .num_inputs = num_plots,
                       .num_gated = num_plots,
                       .in_view = {3}};
    rho_tracker_group_plots(&at, &grouped);
}

static int owner_of(uint32_t plot)
{
    const struct rho_groups *groups = &tracker.bodies.groups;
    return plot >= RHO_BODY_PLOTS || groups->owner[plot] == RHO_NO_ROW ? -1 : groups->owner[plot];
}

static int contender_of(uint32_t plot)
{
    const struct rho_groups *groups = &tracker.bodies.groups;
    return plot >= RHO_BODY_PLOTS || groups->contender[plot] == RHO_NO_ROW
               ? -1
               : groups->contender[plot];
}

/* ---- plots of no track ----------------------------------------------------------------------- */

static unsigned groups_of_two(uint32_t measures, double apart_m, double rate_mps)
{
    prepare(measures);
    see(0.0, 0.0, 0.0);
    see(0.0, apart_m, rate_mps);
    group();
    return tracker.bodies.groups.count;
}

/* Two sigmas of both beyond the longest target: 10 + 2 (0.5 + 0.5). */
static void two_plots_of_one_target_are_as_far_apart_as_it_is_long(void **state)
{
    (void)state;
    assert_int_equal(groups_of_two(0, 11.9, 0.0), 1);
    assert_int_equal(groups_of_two(0, 12.1, 0.0), 2);
    assert_int_equal(groups_of_two(0, -11.9, 0.0), 1);
}

/*
 * Four sigmas: root(1 + 1 + (0.1^2 + 0.02^2) d^2) m/s, d across the line of sight, 0.41 of the
 * longest at most; or the noise of both places.
 */
static void two_range_rates_of_one_target_are_alike(void **state)
{
    (void)state;
    assert_int_equal(groups_of_two(RHO_MEASURES_RANGE_RATE, 5.0, 5.85), 1);
    assert_int_equal(groups_of_two(RHO_MEASURES_RANGE_RATE, 5.0, 5.95), 2);
    assert_int_equal(groups_of_two(RHO_MEASURES_RANGE_RATE, 5.0, -5.85), 1);
    assert_int_equal(groups_of_two(RHO_MEASURES_RANGE_RATE, 5.0, -5.95), 2);
    assert_int_equal(groups_of_two(RHO_MEASURES_RANGE_RATE, 1.0, 5.69), 1);
    assert_int_equal(groups_of_two(RHO_MEASURES_RANGE_RATE, 1.0, 5.74), 2);
    assert_int_equal(groups_of_two(0, 5.0, 99.0), 1);
}

/* ---- a track's plots ------------------------------------------------------------------------- */

/* Three sigmas: along root(1 + 7.75 + 0.25) m, across root(1 + 0.25 + 0.25) m. */
static void a_body_has_a_gate_along_and_across(void **state)
{
    (void)state;
    prepare(0);
    have_track(100.0f);
    see(8.9, 0.0, 0.0);
    see(-9.1, 0.0, 0.0);
    see(0.0, 3.6, 0.0);
    see(0.0, -3.75, 0.0);
    group();
    assert_int_equal(owner_of(0), 0);
    assert_int_equal(owner_of(1), -1);
    assert_int_equal(owner_of(2), 0);
    assert_int_equal(owner_of(3), -1);
}

/* Four sigmas of both, 8 m/s, and 0.3 m/s a metre. */
static void a_body_has_the_range_rate_of_its_track(void **state)
{
    (void)state;
    prepare(RHO_MEASURES_RANGE_RATE);
    have_track(100.0f);
    see(0.0, 0.0, 17.9);
    see(0.0, 0.0, 18.1);
    see(5.0, 0.0, 19.4);
    see(5.0, 0.0, 19.6);
    group();
    for (uint32_t i = 0; i < 4; i++) {
        assert_int_equal(owner_of(i), i % 2 ? -1 : 0);
    }
}

/*
 * Two tracks that differ by their velocity alone. A plot is the one's whose velocity says its range
 * rate, by -2 ln of the likelihoods; the other one contends for it where that is less than 6.
 */
static void range_rates_tell_whose_plot_it_is(void **state)
{
    (void)state;
    prepare(RHO_MEASURES_RANGE_RATE);
    have_track(100.0f);
    tracker.tracks[SECOND] = tracker.tracks[0];
    tracker.bodies.of[SECOND] = tracker.bodies.of[0];
    tracker.tracks[SECOND].track_id = tracker.bodies.of[SECOND].track_id = 2;
    tracker.tracks[SECOND].kalman.state[RHO_VX] = 14.0f;
    tracker.num_tracks = tracker.bodies.count = 2;
    see(0.0, 0.0, 10.0); /* 16 / 2 off the second one's */
    see(0.0, 0.0, 11.5);
    see(0.0, 0.0, 12.5);
    see(0.0, 0.0, 14.0);
    see(0.0, 0.0, 10.45); /* (3.55^2 - 0.45^2) / 2 = 6.2 */
    see(0.0, 0.0, 10.55); /* (3.45^2 - 0.55^2) / 2 = 5.8 */
    group();
    for (uint32_t i = 0; i < 6; i++) {
        const int is_second = i == 2 || i == 3, is_contested = i == 1 || i == 2 || i == 5;
        assert_int_equal(owner_of(i), is_second);
        assert_int_equal(contender_of(i), is_contested ? !is_second : -1);
    }
}

/* ---- the rest -------------------------------------------------------------------------------- */

static void a_body_of_unknown_length_is_half_as_long_as_the_longest(void **state)
{
    (void)state;
    prepare(0);
    assert_float_equal(rho_tracker_body_prior_variance_m2(&tracker), 5.0 * 5.0 / 12.0, 1e-6);
}

/* Six units for a plot and a body; two for two plots, one for each that is passed over. */
static void work_is_counted(void **state)
{
    (void)state;
    prepare(0);
    have_track(100.0f);
    see(0.0, 0.0, 0.0);
    group();
    assert_int_equal(at.work, 6);
    (void)groups_of_two(0, 5.0, 0.0);
    assert_int_equal(at.work, 2 + 2 * 1);
    tracker.config.work_max = 800000;
    group();
    assert_int_equal(at.share.end, 200000); /* of all work a quarter */
}

static void rows_are_those_of_the_plots_again(void **state)
{
    (void)state;
    prepare(0);
    have_track(100.0f);
    see(0.0, 100.0, 0.0);
    see(1.0, 105.0, 0.0); /* of the first one's group */
    see(0.0, 0.0, 0.0);
    group();
    assert_int_equal(tracker.bodies.groups.count, 2);
    tracker.tracks[0].plot = 1;
    report.fates[0] = RHO_FATE_HELD;
    report.fates[1] = RHO_FATE_CLAIMED;
    rho_tracker_ungroup_plots(&at, &scan);
    assert_int_equal(tracker.tracks[0].plot, 2);
    assert_int_equal(report.fates[1], RHO_FATE_HELD);
    assert_int_equal(report.fates[2], RHO_FATE_CLAIMED);
    tracker.tracks[0].plot = -1;
    rho_tracker_ungroup_plots(&at, &scan);
    assert_int_equal(tracker.tracks[0].plot, -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_plots_of_one_target_are_as_far_apart_as_it_is_long),
        cmocka_unit_test(two_range_rates_of_one_target_are_alike),
        cmocka_unit_test(a_body_has_a_gate_along_and_across),
        cmocka_unit_test(a_body_has_the_range_rate_of_its_track),
        cmocka_unit_test(range_rates_tell_whose_plot_it_is),
        cmocka_unit_test(a_body_of_unknown_length_is_half_as_long_as_the_longest),
        cmocka_unit_test(work_is_counted),
        cmocka_unit_test(rows_are_those_of_the_plots_again),
    };
    return RHO_BODIES ? cmocka_run_group_tests(tests, NULL, NULL) : 0;
}
