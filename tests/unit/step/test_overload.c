/* SPDX-License-Identifier: MIT */
/*
 * More tracks, plots and hypotheses than the capacity, in the embedded profile: existing tracks
 * stay as they are, and what found no room is counted. A workstation's capacities are too large to
 * fill in a unit test.
 */
#include "tracker_setup.h"

#ifndef RHO_PROFILE_WORKSTATION

#define TARGETS 60
#define FIRST 20 /* targets that have tracks before the overload */
#define PLOTS 400
#define QUIET 12 /* scans with these targets alone */
#define SCANS 60

/* Targets in rows 8 km apart, at 200 m/s along x. */
static void see_target(int i, int k)
{
    const double x_m = 8000.0 * (i % 10) + 400.0 * k + 20.0 * normal();
    add_plot(x_m, 8000.0 * (i / 10) + 20.0 * normal(), 20.0);
}

static void see_clutter(uint32_t up_to)
{
    while (num_plots < up_to) {
        const double x_m = uniform(-1e4, 11e4);
        add_plot(x_m, uniform(-1e4, 6e4), 20.0);
    }
}

/* A scan with the first targets' plots at its beginning, all other targets among clutter. */
static void see_more_than_capacity(int k)
{
    for (int i = 0; i < TARGETS; i++) {
        see_target(i, k);
    }
    see_clutter(PLOTS);
}

static void track_first_targets(void)
{
    for (int k = 0; k < QUIET; k++) {
        for (int i = 0; i < FIRST; i++) {
            see_target(i, k);
        }
        step_at(2.0 * k);
    }
    assert_int_equal(report.num_tracks, FIRST);
    assert_int_equal(tracker.counters.tracks_confirmed, FIRST);
}

static void expect_first_targets_tracked(int k)
{
    for (uint32_t id = 1; id <= FIRST; id++) {
        const struct rho_track_report *track = report_of(id);
        assert_non_null(track);
        assert_true(track->status == RHO_TRACK_CONFIRMED || track->status == RHO_TRACK_COASTING);
        double nearest_m = 1e9;
        for (int i = 0; i < FIRST; i++) {
            const double off_m = hypot((double)track->state[0] - 8000.0 * (i % 10) - 400.0 * k,
                                       (double)track->state[1] - 8000.0 * (i / 10));
            nearest_m = off_m < nearest_m ? off_m : nearest_m;
        }
        assert_true(nearest_m < 150.0);
    }
}

static void start_tracker_for_overload(uint8_t gate)
{
    use_usual_configs(11);
    config.gate = gate;
    config.accel_max_mps2 = 30.0f;
    begin_tracker();
}

/* Tracks never confirmed are replaced by ones with more evidence, confirmed ones are not. */
static void overload_keeps_existing_tracks_and_is_counted(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_tracker_for_overload((uint8_t)gate);
        track_first_targets();
        const struct rho_tracker_counters then = tracker.counters;
        for (int k = QUIET; k < SCANS; k++) {
            see_more_than_capacity(k);
            step_at(2.0 * k);
            expect_first_targets_tracked(k);
            /* of plots beyond the capacity only claimed ones have another fate */
            assert_in_range(report.fates_total[RHO_FATE_NO_ROOM],
                            PLOTS - RHO_MAX_PLOTS - RHO_MAX_TRACKS, PLOTS - RHO_MAX_PLOTS);
            assert_true(report.num_tracks <= RHO_MAX_TRACKS);
            assert_true(report.num_ended <= RHO_MAX_TRACKS);
        }
        assert_int_equal(report.num_tracks, RHO_MAX_TRACKS);
        assert_true(tracker.counters.tracks_no_room > then.tracks_no_room);
        assert_true(tracker.counters.candidates_dropped > 0);
        assert_int_equal(tracker.counters.tracks_started - tracker.counters.tracks_ended,
                         RHO_MAX_TRACKS);
    }
}

/*
 * 32 tracks in clutter so dense that each would need eight hypotheses, with three available for
 * each.
 */
static void hypotheses_cut_in_crowds_are_counted(void **state)
{
    (void)state;
    start_tracker_for_overload(RHO_TRACKER_BEST);
    track_first_targets();
    for (int k = QUIET; k < QUIET + 12; k++) {
        for (int i = 0; i < FIRST; i++) {
            see_target(i, k);
            for (int n = 0; n < 11; n++) {
                const double x_m = 8000.0 * (i % 10) + 400.0 * k + uniform(-100.0, 100.0);
                add_plot(x_m, 8000.0 * (i / 10) + uniform(-100.0, 100.0), 20.0);
            }
        }
        step_at(2.0 * k);
        for (unsigned i = 0; i < report.num_tracks; i++) {
            assert_true(report.tracks[i].num_hypotheses >= 1);
        }
    }
    expect_first_targets_tracked(QUIET + 11);
    assert_true(tracker.counters.hypotheses_cut > 0);
    assert_true(tracker.counters.gate_plots_dropped > 0);
}

static void within_capacity_no_loss_is_counted(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        start_tracker_for_overload((uint8_t)gate);
        track_first_targets();
        assert_int_equal(tracker.counters.tracks_no_room, 0);
        assert_int_equal(tracker.counters.candidates_dropped, 0);
        assert_int_equal(tracker.counters.hypotheses_cut, 0);
        assert_int_equal(tracker.counters.gate_plots_dropped, 0);
        assert_int_equal(tracker.counters.updates_refused, 0);
        assert_int_equal(tracker.counters.fates[RHO_FATE_NO_ROOM], 0);
    }
}

/*
 * A full table of tracks with plots so imprecise that four new targets have more evidence; those of
 * `gone` are not seen from scan 5 on. The new targets appear by scan 8. Returns how many replaced
 * tracks had been confirmed and were reported as ended.
 */
static unsigned count_confirmed_tracks_replaced(uint32_t gone, int late)
{
    unsigned ended = 0;
    start_tracker_for_overload(RHO_TRACKER_BEST);
    for (int k = 0; k < 9; k++) {
        for (uint32_t i = 0; i < RHO_MAX_TRACKS; i++) {
            if (k < 5 || i >= gone) {
                add_plot(8000.0 * (i % 8) + 400.0 * k, 8000.0 * (i / 8), 400.0);
            }
        }
        for (int i = 0; i < 4 && k >= late; i++) {
            add_plot(-4000.0 + 400.0 * k, 4000.0 + 8000.0 * i, 2.0);
        }
        step_at(2.0 * k);
        assert_int_equal(report.num_tracks, k < 3 ? 0 : RHO_MAX_TRACKS);
        ended += report.num_ended;
    }
    return ended;
}

static void confirmed_tracks_are_never_replaced_by_new_ones(void **state)
{
    (void)state;
    assert_int_equal(count_confirmed_tracks_replaced(0, 5), 0);
    for (uint32_t i = 0; i < RHO_MAX_TRACKS; i++) {
        assert_int_equal(report.tracks[i].track_id, i + 1);
        assert_int_equal(report.tracks[i].status, RHO_TRACK_CONFIRMED);
    }
    assert_int_equal(tracker.counters.tracks_no_room, 4);
    assert_int_equal(tracker.counters.tracks_ended, 0);
}

/* All replaced tracks had been confirmed. */
static void replaced_tracks_in_doubt_are_reported_as_ended(void **state)
{
    (void)state;
    assert_int_equal(count_confirmed_tracks_replaced(4, 5), 4);
    assert_int_equal(tracker.counters.tracks_ended, 4);
}

/* ---- scans with more plots than the capacity ------------------------------------------------- */

/* The targets' plots come last in the scan, behind so much clutter. */
static void see_targets_last(int k, uint32_t behind)
{
    see_clutter(behind);
    for (int i = 0; i < FIRST; i++) {
        see_target(i, k);
    }
}

static void tracks_find_plots_beyond_the_capacity(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        unsigned there = 0;
        start_tracker_for_overload((uint8_t)gate);
        track_first_targets();
        for (int k = QUIET; k < SCANS; k++) {
            /* the targets' plots: in the second part, in the third, across both */
            see_targets_last(k, k % 3 == 0   ? RHO_MAX_PLOTS + 7
                                : k % 3 == 1 ? 700
                                             : 2 * RHO_MAX_PLOTS - 9);
            step_at(2.0 * k);
        }
        for (uint32_t id = 1; id <= FIRST; id++) {
            there += report_of(id) != NULL && report_of(id)->plot >= RHO_MAX_PLOTS;
        }
        print_message("gate %d: %u of %d\n", gate, there, FIRST);
        assert_true(there >= FIRST - 2);
    }
}

/* A claimed plot is reported by its row in the whole scan, and is the target's. */
static void claimed_plots_beyond_the_capacity_are_reported_by_row(void **state)
{
    (void)state;
    start_tracker_for_overload(RHO_TRACKER_BEST);
    track_first_targets();
    see_targets_last(QUIET, RHO_MAX_PLOTS + 50);
    step_at(2.0 * QUIET);
    for (uint32_t id = 1; id <= FIRST; id++) {
        const struct rho_track_report *track = report_of(id);
        assert_non_null(track);
        assert_in_range(track->plot, RHO_MAX_PLOTS + 50, RHO_MAX_PLOTS + 50 + FIRST - 1);
    }
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], FIRST);
    assert_int_equal(report.fates_total[RHO_FATE_NO_ROOM], 50);
}

/*
 * Plots in order of y: the gone targets would have been in the last part, where the initiator has
 * measured no clutter density. Their tracks still end.
 */
static void tracks_of_gone_targets_end_in_overfull_scans(void **state)
{
    (void)state;
    unsigned believed = 0;
    start_tracker_for_overload(RHO_TRACKER_BEST);
    track_first_targets();
    for (int k = QUIET; k < QUIET + 20; k++) {
        for (int band = 0; band < 4; band++) {
            for (uint32_t i = 0; i < RHO_MAX_PLOTS; i++) {
                const double x_m = uniform(-1e4, 11e4), off_m = uniform(0.0, 1e4);
                add_plot(x_m, 2e4 - 1e4 * band + off_m, 20.0);
            }
        }
        step_at(2.0 * k);
        for (uint32_t id = 1; id <= FIRST; id++) {
            const struct rho_track_report *track = report_of(id);
            believed += track != NULL && track->status != RHO_TRACK_TENTATIVE;
        }
    }
    print_message("%u of %d track-scans\n", believed, 20 * FIRST);
    /* each may stay confirmed for the 2 scans that misses take */
    assert_true(believed < 5 * FIRST);
}

/* Bad plots are INVALID there, too; plots beyond four times the capacity are never read. */
static void plots_beyond_four_times_the_capacity_are_ignored(void **state)
{
    (void)state;
    start_tracker_for_overload(RHO_TRACKER_BEST);
    track_first_targets();
    see_clutter(RHO_MAX_PLOTS + 10);
    plots[RHO_MAX_PLOTS + 3].x_m = NAN;
    see_targets_last(QUIET, 4 * RHO_MAX_PLOTS);
    step_at(2.0 * QUIET);
    assert_int_equal(report.fates_total[RHO_FATE_INVALID], 1);
    for (uint32_t id = 1; id <= FIRST; id++) {
        const struct rho_track_report *track = report_of(id);
        assert_non_null(track);
        assert_true(track->plot < 4 * RHO_MAX_PLOTS);
        assert_int_equal(track->status, RHO_TRACK_COASTING);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(overload_keeps_existing_tracks_and_is_counted),
        cmocka_unit_test(hypotheses_cut_in_crowds_are_counted),
        cmocka_unit_test(within_capacity_no_loss_is_counted),
        cmocka_unit_test(confirmed_tracks_are_never_replaced_by_new_ones),
        cmocka_unit_test(replaced_tracks_in_doubt_are_reported_as_ended),
        cmocka_unit_test(tracks_find_plots_beyond_the_capacity),
        cmocka_unit_test(claimed_plots_beyond_the_capacity_are_reported_by_row),
        cmocka_unit_test(tracks_of_gone_targets_end_in_overfull_scans),
        cmocka_unit_test(plots_beyond_four_times_the_capacity_are_ignored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
