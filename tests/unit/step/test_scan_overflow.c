/* SPDX-License-Identifier: MIT */
/*
 * More of everything than there is room for, in the embedded profile: tracks that there are stay as
 * they are, and what had no room is counted. The workstation's capacities are not filled in a unit
 * test.
 */
#include "tracker_setup.h"

#ifndef RHO_PROFILE_WORKSTATION

#define TARGETS 60
#define FIRST 20 /* targets that have tracks before the others come */
#define PLOTS 400
#define QUIET 12 /* scans with the first targets alone */
#define SCANS 60

/* In rows 8 km apart, 200 m/s along x. */
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

/* The targets that have tracks first in the scan, all others among clutter. */
static void see_too_much(int k)
{
    for (int i = 0; i < TARGETS; i++) {
        see_target(i, k);
    }
    see_clutter(PLOTS);
}

static void fly_quietly(void)
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

static void expect_first_tracks(int k)
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

static void begin_overload(uint8_t gate)
{
    use_usual_configs(11);
    config.gate = gate;
    config.accel_max_mps2 = 30.0f;
    begin_tracker();
}

/* Tracks that never were believed give way to what has more evidence, those that were do not. */
static void existing_tracks_are_kept_and_all_else_is_counted(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        begin_overload((uint8_t)gate);
        fly_quietly();
        const struct rho_tracker_counters then = tracker.counters;
        for (int k = QUIET; k < SCANS; k++) {
            see_too_much(k);
            step_at(2.0 * k);
            expect_first_tracks(k);
            /* of those beyond only what tracks claim has another fate */
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
 * 32 tracks in clutter so dense that each would want eight hypotheses, of which there are three a
 * track.
 */
static void crowded_tracks_count_what_was_cut(void **state)
{
    (void)state;
    begin_overload(RHO_TRACKER_BEST);
    fly_quietly();
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
    expect_first_tracks(QUIET + 11);
    assert_true(tracker.counters.hypotheses_cut > 0);
    assert_true(tracker.counters.gate_plots_dropped > 0);
}

static void nothing_is_counted_where_there_is_room(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        begin_overload((uint8_t)gate);
        fly_quietly();
        assert_int_equal(tracker.counters.tracks_no_room, 0);
        assert_int_equal(tracker.counters.candidates_dropped, 0);
        assert_int_equal(tracker.counters.hypotheses_cut, 0);
        assert_int_equal(tracker.counters.gate_plots_dropped, 0);
        assert_int_equal(tracker.counters.updates_refused, 0);
        assert_int_equal(tracker.counters.fates[RHO_FATE_NO_ROOM], 0);
    }
}

/*
 * A full table of tracks with plots so vague that new targets' four are more evidence than they
 * have; those of `gone` are not seen from scan 5 on. The new ones are there at scan 8. Returns how
 * many had been confirmed and were reported as ended.
 */
static unsigned fill_and_add(uint32_t gone, int late)
{
    unsigned ended = 0;
    begin_overload(RHO_TRACKER_BEST);
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

static void tracks_that_are_believed_never_give_way(void **state)
{
    (void)state;
    assert_int_equal(fill_and_add(0, 5), 0);
    for (uint32_t i = 0; i < RHO_MAX_TRACKS; i++) {
        assert_int_equal(report.tracks[i].track_id, i + 1);
        assert_int_equal(report.tracks[i].status, RHO_TRACK_CONFIRMED);
    }
    assert_int_equal(tracker.counters.tracks_no_room, 4);
    assert_int_equal(tracker.counters.tracks_ended, 0);
}

/* They had been confirmed. */
static void tracks_in_doubt_that_give_way_are_reported_as_ended(void **state)
{
    (void)state;
    assert_int_equal(fill_and_add(4, 5), 4);
    assert_int_equal(tracker.counters.tracks_ended, 4);
}

/* ---- scans of more plots than have room ------------------------------------------------------ */

/* The targets' plots are the last ones of the scan, behind so much clutter. */
static void see_late(int k, uint32_t behind)
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
        begin_overload((uint8_t)gate);
        fly_quietly();
        for (int k = QUIET; k < SCANS; k++) {
            /* in the second part, in the third, and across the border of both */
            see_late(k, k % 3 == 0 ? RHO_MAX_PLOTS + 7 : k % 3 == 1 ? 700 : 2 * RHO_MAX_PLOTS - 9);
            step_at(2.0 * k);
        }
        for (uint32_t id = 1; id <= FIRST; id++) {
            there += report_of(id) != NULL && report_of(id)->plot >= RHO_MAX_PLOTS;
        }
        print_message("gate %d: %u of %d\n", gate, there, FIRST);
        assert_true(there >= FIRST - 2);
    }
}

/* Which of them was claimed is told by its row in the whole scan, and it is the target's. */
static void a_claimed_plot_beyond_is_told_by_its_row(void **state)
{
    (void)state;
    begin_overload(RHO_TRACKER_BEST);
    fly_quietly();
    see_late(QUIET, RHO_MAX_PLOTS + 50);
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
 * Plots in the order of y: the targets, which have gone, were in the last part, where the initiator
 * has seen no clutter. Their tracks are not kept alive by it.
 */
static void tracks_of_what_has_gone_end_in_any_part(void **state)
{
    (void)state;
    unsigned believed = 0;
    begin_overload(RHO_TRACKER_BEST);
    fly_quietly();
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
    assert_true(believed < 5 * FIRST); /* 2 scans each are the misses that tell */
}

/* Bad ones are INVALID there as well; what lies beyond four times the capacity nobody looks at. */
static void plots_far_beyond_are_nobody_s(void **state)
{
    (void)state;
    begin_overload(RHO_TRACKER_BEST);
    fly_quietly();
    see_clutter(RHO_MAX_PLOTS + 10);
    plots[RHO_MAX_PLOTS + 3].x_m = NAN;
    see_late(QUIET, 4 * RHO_MAX_PLOTS);
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
        cmocka_unit_test(existing_tracks_are_kept_and_all_else_is_counted),
        cmocka_unit_test(crowded_tracks_count_what_was_cut),
        cmocka_unit_test(nothing_is_counted_where_there_is_room),
        cmocka_unit_test(tracks_that_are_believed_never_give_way),
        cmocka_unit_test(tracks_in_doubt_that_give_way_are_reported_as_ended),
        cmocka_unit_test(tracks_find_plots_beyond_the_capacity),
        cmocka_unit_test(a_claimed_plot_beyond_is_told_by_its_row),
        cmocka_unit_test(tracks_of_what_has_gone_end_in_any_part),
        cmocka_unit_test(plots_far_beyond_are_nobody_s),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 0;
}

#endif
