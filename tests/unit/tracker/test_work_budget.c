/* SPDX-License-Identifier: MIT */
/*
 * A step's work is bounded for any input: each track has a share of it, crowded tracks score the
 * nearest plots, and what was left out is counted. A limit that is not reached changes nothing.
 */
#include "tracker_setup.h"

#define TARGETS 8
#define CROWD 200 /* plots about one target */
#define QUIET 8   /* scans before the crowd appears */
#define SCANS 20
#define WORK_MAX 20000u
/* Work beyond the limit: an echo and a track, once begun, are finished with all plots near them. */
#define BEYOND (30u * (CROWD + TARGETS))

static double target_x_m(int i, int k)
{
    return 9000.0 * i + 200.0 * k;
}

static void see_targets(int k)
{
    for (int i = 0; i < TARGETS; i++) {
        const double x_m = target_x_m(i, k) + 20.0 * normal();
        add_plot(x_m, 5000.0 * (i % 3) + 20.0 * normal(), 20.0);
    }
}

/* Plots within the gate of target 0, closer than their noise. */
static void see_crowd(int k, double spread_m)
{
    for (int i = 0; i < CROWD; i++) {
        const double x_m = target_x_m(0, k) + spread_m * normal();
        add_plot(x_m, spread_m * normal(), 20.0);
    }
}

static void start_with_work_limit(uint32_t work_max, uint8_t gate)
{
    use_usual_configs(11);
    config.gate = gate;
    config.work_max = initiation.work_max = work_max;
    begin_tracker();
}

static const uint8_t gates[] = {RHO_TRACKER_BEST, RHO_TRACKER_NEAREST, RHO_TRACKER_HOUGH};

/* Steps existing tracks without a search, so that they have the whole limit. */
static void step_without_search(double t_s, int32_t sensor_id)
{
    const struct rho_scan scan = {.time_us = (int64_t)(1e6 * t_s),
                                  .sensor_id = sensor_id,
                                  .num_plots = num_plots,
                                  .plots = plots};
    assert_int_equal(rho_tracker_step(&tracker, NULL, &scan, &report), RHO_OK);
    num_plots = 0;
}

static void a_step_never_exceeds_its_work_limit(void **state)
{
    (void)state;
    for (unsigned g = 0; g < sizeof gates; g++) {
        uint32_t unlimited = 0;
        for (uint32_t work_max = RHO_LIMIT_WORK; work_max >= 1000;
             work_max = work_max > WORK_MAX ? WORK_MAX : work_max / 4) {
            start_with_work_limit(RHO_LIMIT_WORK, gates[g]);
            for (int k = 0; k < QUIET; k++) {
                see_targets(k);
                step_at(2.0 * k);
            }
            assert_int_equal(report.num_tracks, TARGETS);
            tracker.config.work_max = work_max;
            for (int k = QUIET; k < SCANS; k++) {
                see_targets(k);
                see_crowd(k, 30.0);
                step_without_search(2.0 * k, 1);
                assert_true(tracker.work.work <= work_max + BEYOND);
            }
            print_message("gate %u, limit %u: worst %u, left out %u\n", gates[g],
                          (unsigned)work_max, (unsigned)tracker.work.work_worst,
                          (unsigned)tracker.work.plots_not_tried);
            unlimited = work_max == RHO_LIMIT_WORK ? tracker.work.work_worst : unlimited;
            assert_int_equal(tracker.work.partial_steps > 0, tracker.work.plots_not_tried > 0);
            assert_int_equal(tracker.work.plots_not_tried > 0, work_max < unlimited);
        }
    }
}

static void plots_left_out_for_work_are_counted(void **state)
{
    (void)state;
    start_with_work_limit(WORK_MAX, RHO_TRACKER_BEST);
    for (int k = 0; k < QUIET; k++) {
        see_targets(k);
        step_at(2.0 * k);
        assert_int_equal(report.is_partial, 0);
    }
    assert_int_equal(tracker.work.partial_steps, 0);
    assert_int_equal(tracker.work.plots_not_tried, 0);
    see_targets(QUIET);
    see_crowd(QUIET, 30.0);
    step_at(2.0 * QUIET);
    assert_int_equal(report.is_partial, 1);
    assert_int_equal(tracker.work.partial_steps, 1);
    assert_true(tracker.work.plots_not_tried > 0);
}

/* The crowded track stays near its target, and the others are as without the crowd. */
static void a_crowd_at_one_track_leaves_work_for_others(void **state)
{
    (void)state;
    static struct rho_report alone;
    for (int is_crowded = 0; is_crowded < 2; is_crowded++) {
        start_with_work_limit(WORK_MAX, RHO_TRACKER_BEST);
        for (int k = 0; k < SCANS; k++) {
            const int comes = k >= QUIET && is_crowded;
            see_targets(k);
            const uint64_t drawn = random_state;
            if (comes) {
                see_crowd(k, 60.0);
            }
            random_state = drawn;
            step_at(2.0 * k);
            assert_int_equal(report.is_partial, comes);
        }
        if (!is_crowded) {
            alone = report;
        }
    }
    assert_int_equal(alone.num_tracks, TARGETS);
    for (uint32_t id = 1; id <= TARGETS; id++) {
        const struct rho_track_report *track = report_of(id), *was = &alone.tracks[id - 1];
        assert_non_null(track);
        assert_int_equal(was->track_id, id);
        if (hypot((double)was->state[0] - target_x_m(0, SCANS - 1), (double)was->state[1]) <
            400.0) {
            assert_true(hypot((double)(track->state[0] - was->state[0]),
                              (double)(track->state[1] - was->state[1])) < 150.0);
        } else {
            assert_memory_equal(track->state, was->state, sizeof track->state);
        }
    }
}

/* No limit, and one that is not reached, give the same bytes. */
static void an_unreached_work_limit_changes_nothing(void **state)
{
    (void)state;
    static struct rho_report unlimited;
    for (unsigned g = 0; g < sizeof gates; g++) {
        for (int run = 0; run < 2; run++) {
            start_with_work_limit(run == 0 ? 0 : RHO_LIMIT_WORK, gates[g]);
            for (int k = 0; k < SCANS; k++) {
                see_targets(k);
                see_crowd(k, 300.0);
                step_at(2.0 * k);
                assert_int_equal(report.is_partial, 0);
            }
            if (run == 0) {
                unlimited = report;
            }
        }
        assert_memory_equal(&unlimited, &report, sizeof report);
    }
}

/* If too many plots are in the gate, those nearest to the prediction are scored. */
static void under_a_work_limit_the_nearest_plots_are_scored(void **state)
{
    (void)state;
    start_with_work_limit(WORK_MAX / 8u, RHO_TRACKER_BEST);
    for (int k = 0; k < QUIET; k++) {
        add_plot(200.0 * k + normal(), normal(), 20.0);
        step_at(2.0 * k);
    }
    assert_int_equal(report.num_tracks, 1);
    for (int i = 0; i < CROWD; i++) {
        add_plot(200.0 * QUIET + 70.0 + 0.1 * i, 0.0, 20.0);
    }
    add_plot(200.0 * QUIET, 0.0, 20.0);
    step_at(2.0 * QUIET);
    assert_int_equal(report.is_partial, 1);
    assert_int_equal(report.tracks[0].plot, CROWD);
}

#if RHO_MAX_ECHOES > 0
/* One sensor's echoes are more than the work limit; the other sensor's are few. */
static void echoes_beyond_the_work_limit_are_matched_in_turns(void **state)
{
    (void)state;
    unsigned partial = 0, before = 0;
    use_usual_configs(5);
    config.work_max = 600;
    begin_tracker();
    for (int k = 0; k < 2 * SCANS; k++) {
        const int is_heavy = k % 2 == 0;
        for (int i = 0; i < (is_heavy ? 100 : 3); i++) {
            const double x_m = 40.0 * (i % 10) + (is_heavy ? 0.0 : 90e3) + normal();
            add_plot(x_m, 40.0 * (i / 10) + normal(), 20.0);
        }
        step_without_search(k, is_heavy ? 1 : 2);
        if (!is_heavy) {
            assert_int_equal(report.is_partial, 0);
            assert_int_equal(tracker.clutter_map.first_echo, before);
        } else if (report.is_partial) {
            assert_int_not_equal(tracker.clutter_map.first_echo, before);
            partial++;
        }
        before = tracker.clutter_map.first_echo;
    }
    assert_true(partial > SCANS / 2);
}
#endif

/* ---- work units by formula ------------------------------------------------------------------- */

/* Units of a single plot for each hypothesis of its track, with these measurements. */
static uint32_t work_units_of_plot(uint8_t gate, uint32_t measures, int32_t offset_us)
{
    uint32_t hypotheses = 0;
    start_with_work_limit(0, gate);
    for (int k = 0; k <= QUIET; k++) {
        struct rho_plot *plot = add_plot(200.0 * k, 0.0, 20.0);
        plot->sigma_up_m = 20.0f;
        plot->vx_mps = 100.0f;
        plot->sigma_mps = 5.0f;
        plot->offset_us = offset_us;
        const struct rho_scan scan = {.time_us = INT64_C(2000000) * k,
                                      .measures = measures,
                                      .num_plots = num_plots,
                                      .plots = plots};
        hypotheses = k == QUIET ? report.tracks[0].num_hypotheses : 0;
        assert_int_equal(rho_tracker_step(&tracker, k < QUIET ? &initiator : NULL, &scan, &report),
                         RHO_OK);
        num_plots = 0;
    }
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(tracker.work.work % hypotheses, 0);
    return tracker.work.work / hypotheses;
}

/* A gate test; the place; its own time; and a velocity in the plane or with height. */
static void plots_in_a_gate_cost_units_by_their_measurements(void **state)
{
    const uint32_t flat = RHO_MEASURES_VELOCITY, high = flat | RHO_MEASURES_Z;
    (void)state;
    assert_int_equal(work_units_of_plot(RHO_TRACKER_NEAREST, 0, 0), 12);
    assert_int_equal(work_units_of_plot(RHO_TRACKER_BEST, 0, 0), 20);
    assert_int_equal(work_units_of_plot(RHO_TRACKER_BEST, 0, 1000), 20 + 60);
    assert_int_equal(work_units_of_plot(RHO_TRACKER_BEST, flat, 0), 20 + 70);
    assert_int_equal(work_units_of_plot(RHO_TRACKER_BEST, high, 0), 20 + 140);
}

/* Of 256 plots in order of x an eighth is in the track's box: four skipped plots cost one unit. */
static void skipped_plots_cost_a_quarter_of_a_unit(void **state)
{
    (void)state;
    if (RHO_PLOT_STRIPS > 1 || RHO_MAX_PLOTS < 256) {
        skip();
    }
    start_with_work_limit(0, RHO_TRACKER_NEAREST);
    for (int k = 0; k < QUIET; k++) {
        (void)add_plot(200.0 * k, 0.0, 20.0);
        step_at(2.0 * k);
    }
    for (int i = 0; i < 256; i++) {
        (void)add_plot(200.0 * QUIET + 5000.0 * i, 0.0, 20.0);
    }
    step_without_search(2.0 * QUIET, 0);
    assert_int_equal(tracker.work.work, 12 + 256 / 8 / 4);
}

/*
 * A quarter of the limit is for claims, half of it reserved in equal parts: the first of eight
 * tracks has an eighth of that, and a quarter of the other half. That is 3/64 of the limit, 60
 * plots of 12 units each.
 */
static void each_track_has_its_share_of_the_work(void **state)
{
    (void)state;
    start_with_work_limit(RHO_LIMIT_WORK, RHO_TRACKER_NEAREST);
    for (int k = 0; k < QUIET; k++) {
        see_targets(k);
        step_at(2.0 * k);
    }
    assert_int_equal(report.num_tracks, TARGETS);
    const float *at = report.tracks[0].state;
    tracker.config.work_max = 64 * 60 * 12 / 3;
    see_targets(QUIET);
    for (int i = 0; i < CROWD; i++) {
        (void)add_plot((double)at[0] + 2.0 * (double)at[3] + 0.1 * i, (double)at[1], 20.0);
    }
    step_without_search(2.0 * QUIET, 1);
    assert_in_range(tracker.work.plots_not_tried, CROWD - 60, CROWD + TARGETS - 60);
}

static void too_large_work_limits_are_refused(void **state)
{
    (void)state;
    use_usual_configs(1);
    config.work_max = RHO_LIMIT_WORK + 1u;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_ERROR_CONFIG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_step_never_exceeds_its_work_limit),
        cmocka_unit_test(plots_left_out_for_work_are_counted),
        cmocka_unit_test(a_crowd_at_one_track_leaves_work_for_others),
        cmocka_unit_test(an_unreached_work_limit_changes_nothing),
        cmocka_unit_test(under_a_work_limit_the_nearest_plots_are_scored),
#if RHO_MAX_ECHOES > 0
        cmocka_unit_test(echoes_beyond_the_work_limit_are_matched_in_turns),
#endif
        cmocka_unit_test(too_large_work_limits_are_refused),
        cmocka_unit_test(plots_in_a_gate_cost_units_by_their_measurements),
        cmocka_unit_test(each_track_has_its_share_of_the_work),
        cmocka_unit_test(skipped_plots_cost_a_quarter_of_a_unit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
