/* SPDX-License-Identifier: MIT */
/*
 * Support, shared evidence and clutter probability of a track's last look: a single target, two
 * that share plots, a miss, and while other tracks end and start.
 */
#include "tracker_setup.h"

#define SCAN_S 2.0

static struct rho_tracker_evidence evidence;

/* Whether the track's evidence is known; if so, its three parts sum to 1. */
static int read_evidence_of(uint32_t track_id)
{
    for (unsigned i = 0; i < tracker.num_tracks; i++) {
        if (tracker.tracks[i].track_id == track_id) {
            memset(&evidence, 0x5a, sizeof evidence);
            if (!rho_tracker_evidence_of(&tracker, i, &evidence)) {
                return 0;
            }
            assert_float_equal(evidence.support + evidence.shared + evidence.clutter, 1.0, 1e-5);
            assert_true(evidence.support >= 0.0f && evidence.shared >= 0.0f &&
                        evidence.clutter >= 0.0f);
            return 1;
        }
    }
    return 0;
}

#if RHO_KEEPS_OFFERS
/* Identity of the northern or the southern track. */
static uint32_t track_id_of(int is_north)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if ((report.tracks[i].state[1] > 0.0f) == is_north) {
            return report.tracks[i].track_id;
        }
    }
    return 0;
}
#endif

/* Adds plots of two targets that fly beside each other, apart_m apart. */
static void add_plots_of_pair(int k, double apart_m)
{
    const double t_s = SCAN_S * k;
    add_plot(-9000.0 + 200.0 * t_s, 0.5 * apart_m, 10.0);
    add_plot(-9000.0 + 200.0 * t_s, -0.5 * apart_m, 10.0);
}

static void fly_pair(int scans, double apart_m, int gate)
{
    use_usual_configs(1);
    config.gate = (uint8_t)gate;
    begin_tracker();
    for (int k = 0; k < scans; k++) {
        add_plots_of_pair(k, apart_m);
        step_at(SCAN_S * k);
    }
    assert_int_equal(report.num_tracks, 2);
}

static void far_apart_targets_own_their_plots_alone(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        fly_pair(10, 4000.0, gate);
        for (uint32_t id = 1; id <= 2; id++) {
            assert_int_equal(read_evidence_of(id), RHO_KEEPS_OFFERS);
            if (RHO_KEEPS_OFFERS) {
                assert_true(evidence.support > 0.99f);
                assert_float_equal(evidence.shared, 0.0, 1e-6);
            }
        }
    }
}

#if RHO_KEEPS_OFFERS

/* A plot in the middle of both is claimed by one track and supports both. */
static void a_plot_between_two_targets_supports_both(void **state)
{
    (void)state;
    fly_pair(10, 60.0, RHO_TRACKER_BEST);
    add_plot(-9000.0 + 200.0 * SCAN_S * 10, 0.0, 10.0);
    step_at(SCAN_S * 10);
    assert_int_equal(report.num_tracks, 2);
    for (uint32_t id = 1; id <= 2; id++) {
        assert_true(read_evidence_of(id));
        assert_true(evidence.shared > 0.4f && evidence.shared < 0.51f);
        assert_float_equal(evidence.shared, evidence.support, 0.02);
    }
    /* a plot near one of them supports this track more */
    fly_pair(10, 60.0, RHO_TRACKER_BEST);
    const uint32_t north = track_id_of(1), south = track_id_of(0);
    add_plot(-9000.0 + 200.0 * SCAN_S * 10, 22.0, 10.0);
    step_at(SCAN_S * 10);
    assert_true(read_evidence_of(north));
    const struct rho_tracker_evidence near = evidence;
    assert_true(read_evidence_of(south));
    assert_true(near.support > evidence.support + 0.2f);
    assert_true(near.shared < 0.4f);
    assert_true(evidence.clutter > near.clutter);
}

static void after_a_miss_all_evidence_is_clutter(void **state)
{
    (void)state;
    fly_pair(10, 4000.0, RHO_TRACKER_BEST);
    add_plot(-9000.0 + 200.0 * SCAN_S * 10, 2000.0, 10.0);
    step_at(SCAN_S * 10);
    assert_true(read_evidence_of(track_id_of(0)));
    assert_float_equal(evidence.clutter, 1.0, 0.0);
    assert_true(read_evidence_of(track_id_of(1)));
    assert_true(evidence.support > 0.99f);
}

/* A plot near the gate's border is likely clutter. */
static void a_plot_at_the_gate_border_is_likely_clutter(void **state)
{
    (void)state;
    float before = 0.0f;
    for (int off = 0; off <= 6; off++) {
        fly_pair(10, 4000.0, RHO_TRACKER_NEAREST);
        add_plot(-9000.0 + 200.0 * SCAN_S * 10, 2000.0 + 15.0 * off, 10.0);
        step_at(SCAN_S * 10);
        assert_true(read_evidence_of(track_id_of(1)));
        assert_true(evidence.clutter >= before);
        before = evidence.clutter;
    }
    assert_true(before > 0.5f);
}

/* The first track ends; the second one's evidence moves to its row. */
static void evidence_follows_its_track_to_another_row(void **state)
{
    (void)state;
    fly_pair(10, 4000.0, RHO_TRACKER_BEST);
    const int is_north = track_id_of(1) == 2;
    for (int k = 10; k < 40 && report.num_tracks == 2; k++) {
        add_plot(-9000.0 + 200.0 * SCAN_S * k, is_north ? 2000.0 : -2000.0, 10.0);
        step_at(SCAN_S * k);
        assert_true(read_evidence_of(2));
        assert_true(evidence.support > 0.99f);
    }
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].track_id, 2);
    assert_int_equal(rho_tracker_evidence_of(&tracker, 1, &evidence), 0);
}

static void new_and_unobserved_tracks_have_no_evidence(void **state)
{
    (void)state;
    use_usual_configs(2);
    begin_tracker();
    for (int k = 0; report.num_tracks == 0 || k == 0; k++) {
        add_plots_of_pair(k, 4000.0);
        step_at(SCAN_S * k);
        assert_true(k < 8);
    }
    assert_int_equal(read_evidence_of(1), 0);
    for (int k = 4; k < 10; k++) {
        add_plots_of_pair(k, 4000.0);
        step_at(SCAN_S * k);
    }
    assert_int_equal(read_evidence_of(1), 1);
    /* a sector in the west: both targets are in the east, unobserved */
    step_scan((struct rho_scan){.time_us = 20000000,
                                .sector_from_rad = RHO_SECTORS ? 1.0f : 0.0f,
                                .sector_to_rad = RHO_SECTORS ? 1.5f : 0.0f});
    assert_int_equal(read_evidence_of(1), !RHO_SECTORS);
}

/* A new track replaces the lowest tentative one, and rows behind it move up. */
static void a_replaced_track_does_not_shift_evidence_of_others(void **state)
{
    (void)state;
    const struct rho_track_plot plot = {
        .plot = {.x_m = 5e4f, .y_m = 5e4f, .sigma_range_m = 10.0f, .sigma_cross_m = 10.0f},
        .sensor_id = 0,
        .row = -1};
    struct rho_track_plot later;
    fly_pair(10, 4000.0, RHO_TRACKER_BEST);
    later = plot;
    later.time_us = tracker.time_us;
    assert_int_equal(rho_tracker_start_track(&tracker, &later, 1, -1, &report), RHO_OK);
    for (int i = 0; report.num_tracks < RHO_MAX_TRACKS; i++) {
        later.plot.x_m = 1e5f + 500.0f * (float)i;
        assert_int_equal(rho_tracker_start_track(&tracker, &later, 1, 5000, &report), RHO_OK);
    }
    assert_int_equal(rho_tracker_start_track(&tracker, &later, 1, 6000, &report), RHO_OK);
    assert_int_equal(tracker.counters.tracks_no_room, 1);
    assert_int_equal(report.num_tracks, RHO_MAX_TRACKS);
    for (uint32_t id = 1; id <= 2; id++) {
        assert_true(read_evidence_of(id));
        assert_true(evidence.support > 0.99f);
    }
    for (unsigned i = 2; i < RHO_MAX_TRACKS; i++) {
        assert_int_equal(rho_tracker_evidence_of(&tracker, i, &evidence), 0);
    }
}

#endif

static void missing_tracks_and_null_pointers_have_no_evidence(void **state)
{
    (void)state;
    fly_pair(10, 4000.0, RHO_TRACKER_BEST);
    assert_int_equal(rho_tracker_evidence_of(NULL, 0, &evidence), 0);
    assert_int_equal(rho_tracker_evidence_of(&tracker, 0, NULL), 0);
    assert_int_equal(rho_tracker_evidence_of(&tracker, 2, &evidence), 0);
    tracker.magic = 0;
    assert_int_equal(rho_tracker_evidence_of(&tracker, 0, &evidence), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(far_apart_targets_own_their_plots_alone),
#if RHO_KEEPS_OFFERS
        cmocka_unit_test(a_plot_between_two_targets_supports_both),
        cmocka_unit_test(after_a_miss_all_evidence_is_clutter),
        cmocka_unit_test(a_plot_at_the_gate_border_is_likely_clutter),
        cmocka_unit_test(evidence_follows_its_track_to_another_row),
        cmocka_unit_test(new_and_unobserved_tracks_have_no_evidence),
        cmocka_unit_test(a_replaced_track_does_not_shift_evidence_of_others),
#endif
        cmocka_unit_test(missing_tracks_and_null_pointers_have_no_evidence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
