/* SPDX-License-Identifier: MIT */
/*
 * What a step takes from the clutter map and teaches it: the density that an echo and a strobe add
 * at a plot, compared with the formulas in double precision, at both sides of each limit. Echoes
 * are made by hand, with the private header, as those of a scene never stand exactly at a limit.
 */
#include "../../src/tracker/clutter.h"
#include "../../src/tracker/plots.h"
#include "../../src/tracker/sensors.h"
#include "../../src/tracker/step.h"
#include "tracker_setup.h"

#if RHO_MAX_ECHOES > 0

#define RANGE_MAX_M 80000.0
#define PI 3.14159265358979

static const struct rho_sensor radar = {
    .sensor_id = 1, .pd = 0.9f, .range_max_m = (float)RANGE_MAX_M};
static struct rho_scan scan;
static struct step at;

static void start_tracker(uint32_t measures)
{
    use_usual_configs(1);
    config.v_min_mps = initiation.v_min_mps = 30.0f;
    config.work_max = 0;
    begin_tracker();
    memset(&report, 0, sizeof report);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
    scan = (struct rho_scan){.sensor_id = 1, .measures = measures, .plots = plots};
}

static void begin_step_with_plots(void)
{
    scan.num_plots = num_plots;
    tracker.num_rows = 1;
    tracker.sensors[0].sensor.sensor_id = 1;
    at = (struct step){.tracker = &tracker,
                       .report = &report,
                       .look = {.tracker = &tracker,
                                .fates = report.fates,
                                .teaches = 1,
                                .row = tracker.sensors,
                                .time_us = 4000000,
                                .scan = &scan,
                                .sensor = &radar,
                                .num_inputs = num_plots,
                                .num_gated = num_plots,
                                .sigma_max_m = 10.0f,
                                .range_rates_mps = 700.0f}};
    for (uint32_t i = 0; i < num_plots; i++) {
        report.fates[i] = RHO_FATE_HELD;
    }
    tracker.unclaimed_plots = 100.0f; /* on an area of 100 by 100 km */
    tracker.extent = (struct rho_extent){-50000.0f, 50000.0f, -50000.0f, 50000.0f};
    rho_plots_index(&tracker, &at.look);
    rho_echoes_predict(&tracker, &at.look, &at.work);
}

static const double usual_per_m2 = 100.0 / 1e10;

static struct rho_clutter_map *clutter_map(void)
{
    return &tracker.clutter_map;
}

static void expect_close(double is, double wanted)
{
    assert_true(fabs(is - wanted) <= 2e-4 * fabs(wanted) + 1e-7);
}

/* ---- echoes: fixed places that often give plots ---------------------------------------------- */

/*
 * An echo 20 km east, seen 20 times and in the last scan, with a sigma of 20 m along and almost 0
 * across the line of sight.
 */
static struct rho_echo *make_known_echo(void)
{
    struct rho_echo *echo = &clutter_map()->echoes[0];
    *echo = (struct rho_echo){.time_us = 4000000,
                              .sensor_id = 1,
                              .x_m = 20000.0f,
                              .along = {400.0f, 0.0f, 4.0f},
                              .across = {1.0f, 0.0f, 4.0f},
                              .plot = -1,
                              .hits = 20};
    return echo;
}

/*
 * Density that the echo adds at a plot of 10 m, so many sigmas off: root(400 + 100) m along, root(1
 * + 100) m across.
 */
static double density_of_echo_at(double along, double across)
{
    start_tracker(0);
    make_known_echo();
    (void)add_plot(20000.0 + along * sqrt(500.0), across * sqrt(101.0), 10.0);
    begin_step_with_plots();
    return (double)clutter_map()->denser[0];
}

static void an_echo_adds_clutter_density_within_its_gate(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const double sigmas = i == 3 ? -4.2 : 1.5 * i, denser = density_of_echo_at(sigmas, 0.0);
        const double probability =
            (double)rho_clutter_map_return_probability(clutter_map(), 0, 20, 1);
        const double per_m2 =
            probability * exp(-0.5 * sigmas * sigmas) / (2.0 * PI * sqrt(500.0 * 101.0));
        expect_close(denser, log(1.0 + per_m2 / usual_per_m2));
    }
    /* the squared sigmas sum to 18 */
    assert_true(density_of_echo_at(2.9, 3.0) > 0.0);
    assert_true(density_of_echo_at(3.1, 3.0) == 0.0);
}

/* Work units: four for each plot in the box, none six sigmas off; ten with range rates. */
static void work_for_echoes_is_counted(void **state)
{
    (void)state;
    (void)density_of_echo_at(1.0, 0.0);
    assert_int_equal(at.work.spent, 4);
    (void)density_of_echo_at(6.5, 0.0);
    assert_int_equal(at.work.spent, 0);
    start_tracker(RHO_MEASURES_RANGE_RATE);
    make_known_echo();
    add_plot(20000.0, 0.0, 10.0)->sigma_range_rate_mps = 1.0f;
    begin_step_with_plots();
    assert_int_equal(at.work.spent, 10);
}

/* Density of a normal range rate over the uniform one. */
static double range_rate_density_over_uniform(double off_mps, double variance)
{
    return 700.0 * exp(-0.5 * off_mps * off_mps / variance) / sqrt(2.0 * PI * variance);
}

/*
 * Some echo plots have the echo's own rate; of the others half are within 1 m/s and half anywhere.
 */
static void range_rates_scale_the_density_of_an_echo(void **state)
{
    static const double rates_mps[] = {0.0, 1.5, 4.0, 9.0}, plots_seen[] = {0.0, 20.0};
    (void)state;
    for (int i = 0; i < 8; i++) {
        const double rate_mps = rates_mps[i % 4], seen = plots_seen[i / 4];
        start_tracker(RHO_MEASURES_RANGE_RATE);
        make_known_echo();
        struct rho_plot *plot = add_plot(20000.0, 0.0, 10.0);
        plot->range_rate_mps = (float)rate_mps;
        plot->sigma_range_rate_mps = 1.0f;
        clutter_map()->rate_plots = (float)seen;
        clutter_map()->exact_plots = (float)seen / 4.0f;
        begin_step_with_plots();
        const double variance = 1.0 + 4.0, share = (seen / 4.0 + 0.3 * 10.0) / (seen + 10.0);
        const double ratio =
            share * range_rate_density_over_uniform(rate_mps, variance) +
            (1.0 - share) * (0.5 + 0.5 * range_rate_density_over_uniform(rate_mps, variance + 1.0));
        const double probability =
            (double)rho_clutter_map_return_probability(clutter_map(), 0, 20, 1);
        const double per_m2 = probability * ratio / (2.0 * PI * sqrt(500.0 * 101.0));
        expect_close((double)clutter_map()->denser[0], log(1.0 + per_m2 / usual_per_m2));
    }
}

/* A range variance of a hundredth of the range's square, sigma 8 km, drops the echo. */
static void an_echo_of_uncertain_place_is_dropped(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        start_tracker(0);
        make_known_echo()->along[0] = i ? 6.41e7f : 6.38e7f;
        (void)add_plot(0.0, 20000.0, 10.0);
        begin_step_with_plots();
        assert_int_equal(clutter_map()->echoes[0].hits, i ? 0 : 20);
    }
}

/* An echo takes a plot from a weight of 0.3 on, whichever row the plot has. */
static void an_echo_takes_a_plot_of_weight_above_0_3(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        for (int row = 0; row < 2; row++) {
            start_tracker(0);
            struct rho_echo *echo = make_known_echo();
            if (row == 1) {
                (void)add_plot(0.0, 20000.0, 10.0);
            }
            (void)add_plot(20000.0, 0.0, 10.0);
            begin_step_with_plots();
            assert_int_equal(echo->plot, row);
            assert_true(echo->weight > 0.0f);
            echo->weight = i ? 0.31f : 0.29f;
            rho_echoes_update(&tracker, &at.look);
            assert_int_equal(echo->hits, 20 + i);
            assert_int_equal(clutter_map()->echoes[1].hits, row == 1 || i == 0);
        }
    }
}

/* Sums of range rates are halved at a thousand plots. */
static void range_rate_sums_of_the_clutter_map_are_halved_at_1000(void **state)
{
    static const float before[] = {999.0f, 1000.0f}, after[] = {1000.0f, 501.0f};
    (void)state;
    for (int i = 0; i < 2; i++) {
        start_tracker(RHO_MEASURES_RANGE_RATE);
        make_known_echo();
        add_plot(20000.0, 0.0, 10.0)->sigma_range_rate_mps = 1.0f;
        begin_step_with_plots();
        clutter_map()->echoes[0].weight = 0.9f;
        clutter_map()->rate_plots = before[i];
        rho_echoes_update(&tracker, &at.look);
        assert_true(clutter_map()->rate_plots == after[i]);
    }
}

/* ---- duration of map updates in turns -------------------------------------------------------- */

/* A scan counts as half a turn if two sensors were heard in the last minute. */
static void sensors_silent_for_a_minute_do_not_count(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        start_tracker(0);
        begin_step_with_plots();
        at.look.time_us = 100000000;
        tracker.num_rows = 2;
        tracker.sensors[0].pace =
            (struct rho_tracker_pace){.is_heard = 1, .time_us = at.look.time_us};
        tracker.sensors[1].pace.is_heard = 1;
        tracker.sensors[1].pace.time_us = at.look.time_us - (i ? 61000000 : 59000000);
        const float before = clutter_map()->scans_to_blocks;
        rho_echoes_update(&tracker, &at.look);
        assert_float_equal(before - clutter_map()->scans_to_blocks, i ? 1.0 : 0.5, 1e-6);
    }
}

/* ---- tracks that are targets teach no clutter ------------------------------------------------ */

/* After twelve hits a confirmed track is a target if it is fast or has left its start. */
static int do_twelve_hits_make_a_target(uint16_t hits, float v_min_mps, float moved_m)
{
    struct rho_track *track = &tracker.tracks[0];
    start_tracker(0);
    tracker.config.v_min_mps = v_min_mps;
    (void)add_plot(0.0, 20000.0, 10.0);
    begin_step_with_plots();
    tracker.num_tracks = 1;
    *track = (struct rho_track){.track_id = 1,
                                .status = RHO_TRACK_CONFIRMED,
                                .plot = 0,
                                .hits = hits,
                                .was_confirmed = 1,
                                .start_sigma_m = 5.0f};
    track->kalman.state[RHO_X] = moved_m;
    track->kalman.state[RHO_VX] = 40.0f;
    for (int axis = 0; axis < 2; axis++) {
        track->kalman.covariance[RHO_AT(axis, axis)] = 25.0f;
        track->kalman.covariance[RHO_AT(3 + axis, 3 + axis)] = 1.0f;
    }
    track->visible = 1.0f;
    rho_life_apply(&at, track, 0);
    rho_echoes_update(&tracker, &at.look);
    return track->has_taken_back;
}

static void tracks_of_12_hits_that_moved_are_known_moving_targets(void **state)
{
    (void)state;
    assert_false(do_twelve_hits_make_a_target(11, 30.0f, 0.0f));
    assert_true(do_twelve_hits_make_a_target(12, 30.0f, 0.0f));
    /* a target counts as standing still within eight sigmas of both places */
    assert_false(do_twelve_hits_make_a_target(12, 0.0f, 79.0f));
    assert_true(do_twelve_hits_make_a_target(12, 0.0f, 81.0f));
}

/* ---- what never moved ------------------------------------------------------------------------ */

/* With `targets` no plot becomes an echo where targets may stand; a taught echo stays. */
static void what_never_moved_is_no_echo_where_it_may_be_a_target(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        start_tracker(0);
        (void)make_known_echo();
        tracker.config.standing = i % 2 ? RHO_STANDING_TARGETS : RHO_STANDING_CLUTTER;
        clutter_map()->v_min_mps = i / 2 ? 10.0f : 0.0f;
        (void)add_plot(0.0, 20000.0, 10.0);
        begin_step_with_plots();
        rho_echoes_update(&tracker, &at.look);
        assert_int_equal(clutter_map()->echoes[1].hits, i == 1 ? 0 : 1);
        assert_int_equal(clutter_map()->echoes[0].hits, 20);
    }
}

/* Where an operator's track is, echoes are no clutter: 18 variances of both places. */
static void an_operators_track_takes_the_echo_out_of_the_clutter(void **state)
{
    const double reach_m = sqrt(18.0 * (25.0 + 400.0 + 1.0));
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct rho_track *track = &tracker.tracks[0];
        start_tracker(0);
        struct rho_echo *echo = make_known_echo();
        (void)add_plot(20000.0, 0.0, 10.0);
        clutter_map()->v_min_mps = 0.0f;
        echo->along[0] = 400.0f;
        echo->across[0] = 1.0f;
        tracker.num_tracks = 1;
        *track = (struct rho_track){.track_id = 1, .status = RHO_TRACK_CONFIRMED, .plot = 0};
        track->is_operators = i > 0;
        track->kalman.state[RHO_X] = 20000.0f;
        track->kalman.state[RHO_Y] = (float)(i > 1 ? reach_m + 1.0 : reach_m - 1.0);
        for (int axis = 0; axis < 2; axis++) {
            track->kalman.covariance[RHO_AT(axis, axis)] = 25.0f;
        }
        begin_step_with_plots();
        assert_int_equal(clutter_map()->denser[0] > 0.0f, i != 1);
        rho_echoes_update(&tracker, &at.look);
        /* and its plots become none, so that the echo is as it was when the track is dropped */
        assert_int_equal(clutter_map()->echoes[1].hits, 0);
        assert_int_equal(echo->hits, i == 0 ? 21 : 20);
    }
}

/* ---- strobes: jammed directions -------------------------------------------------------------- */

/* Plots in one direction, in the eighths of the range from `first` on, and `others` all round. */
static int has_strobe(int count, int first, int eighths, double last_m, int others)
{
    const double bin_rad = 2.0 * PI / RHO_ECHO_STROBES;
    start_tracker(0);
    for (int i = 0; i < count; i++) {
        const double range_m = RANGE_MAX_M / 8.0 * (first + i % eighths + 0.5);
        (void)add_plot(i == count - 1 && last_m > 0.0 ? last_m : range_m, 0.01 * range_m * bin_rad,
                       10.0);
    }
    for (int i = 0; i < others; i++) {
        const double azimuth_rad = 3.0 * bin_rad + (2.0 * PI - 6.0 * bin_rad) * i / others;
        (void)add_plot(30000.0 * cos(azimuth_rad), 30000.0 * sin(azimuth_rad), 10.0);
    }
    begin_step_with_plots();
    return clutter_map()->denser[0] > 0.0f;
}

static void a_strobe_has_more_than_eight_plots(void **state)
{
    (void)state;
    assert_false(has_strobe(8, 0, 6, 0.0, 0));
    assert_true(has_strobe(9, 0, 6, 0.0, 0));
}

/* A strobe has more than six times the plots of other directions. */
static void a_strobe_has_six_times_the_plots_of_other_directions(void **state)
{
    const int others = 150;
    const double usual = others * 3.0 / (RHO_ECHO_STROBES - 3.0), least = 8.0 + 6.0 * usual;
    (void)state;
    assert_true(usual > 0.5);
    assert_false(has_strobe((int)floor(least), 0, 6, 0.0, others));
    assert_true(has_strobe((int)floor(least) + 1, 0, 6, 0.0, others));
}

/* In six eighths of the range, the last of which includes plots beyond it. */
static void a_strobe_covers_six_eighths_of_the_range(void **state)
{
    (void)state;
    assert_false(has_strobe(20, 2, 5, 0.0, 0));
    assert_true(has_strobe(20, 2, 6, 0.0, 0));
    assert_true(has_strobe(20, 2, 5, 1.01 * RANGE_MAX_M, 0));
    assert_false(has_strobe(20, 3, 5, 1.01 * RANGE_MAX_M, 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_echo_adds_clutter_density_within_its_gate),
        cmocka_unit_test(work_for_echoes_is_counted),
        cmocka_unit_test(range_rates_scale_the_density_of_an_echo),
        cmocka_unit_test(an_echo_of_uncertain_place_is_dropped),
        cmocka_unit_test(an_echo_takes_a_plot_of_weight_above_0_3),
        cmocka_unit_test(range_rate_sums_of_the_clutter_map_are_halved_at_1000),
        cmocka_unit_test(sensors_silent_for_a_minute_do_not_count),
        cmocka_unit_test(what_never_moved_is_no_echo_where_it_may_be_a_target),
        cmocka_unit_test(an_operators_track_takes_the_echo_out_of_the_clutter),
        cmocka_unit_test(tracks_of_12_hits_that_moved_are_known_moving_targets),
        cmocka_unit_test(a_strobe_has_more_than_eight_plots),
        cmocka_unit_test(a_strobe_has_six_times_the_plots_of_other_directions),
        cmocka_unit_test(a_strobe_covers_six_eighths_of_the_range),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
