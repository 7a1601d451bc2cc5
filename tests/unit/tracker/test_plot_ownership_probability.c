/* SPDX-License-Identifier: MIT */
/*
 * Support, shared evidence and clutter of a track's last look: of a lone target, of two that share
 * plots, of a miss, and beside tracks that end and start.
 */
#include "tracker_setup.h"

#define SCAN_S 2.0

static struct rho_tracker_evidence evidence;

/* Whether the track's evidence is known; then it adds up to 1. */
static int look(uint32_t track_id)
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
/* The track of the northern or the southern one. */
static uint32_t id_of(int is_north)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        if ((report.tracks[i].state[1] > 0.0f) == is_north) {
            return report.tracks[i].track_id;
        }
    }
    return 0;
}
#endif

/* Two targets that fly beside each other, so many metres apart. */
static void add_pair(int k, double apart_m)
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
        add_pair(k, apart_m);
        step_at(SCAN_S * k);
    }
    assert_int_equal(report.num_tracks, 2);
}

static void targets_far_apart_have_all_to_themselves(void **state)
{
    (void)state;
    for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
        fly_pair(10, 4000.0, gate);
        for (uint32_t id = 1; id <= 2; id++) {
            assert_int_equal(look(id), RHO_KEEPS_OFFERS);
            if (RHO_KEEPS_OFFERS) {
                assert_true(evidence.support > 0.99f);
                assert_float_equal(evidence.shared, 0.0, 1e-6);
            }
        }
    }
}

#if RHO_KEEPS_OFFERS

/* One plot in the middle of both is claimed by one, and shared by both. */
static void a_plot_between_two_targets_is_shared(void **state)
{
    (void)state;
    fly_pair(10, 60.0, RHO_TRACKER_BEST);
    add_plot(-9000.0 + 200.0 * SCAN_S * 10, 0.0, 10.0);
    step_at(SCAN_S * 10);
    assert_int_equal(report.num_tracks, 2);
    for (uint32_t id = 1; id <= 2; id++) {
        assert_true(look(id));
        assert_true(evidence.shared > 0.4f && evidence.shared < 0.51f);
        assert_float_equal(evidence.shared, evidence.support, 0.02);
    }
    /* and a plot that is near one of them is more its own than the other's */
    fly_pair(10, 60.0, RHO_TRACKER_BEST);
    const uint32_t north = id_of(1), south = id_of(0);
    add_plot(-9000.0 + 200.0 * SCAN_S * 10, 22.0, 10.0);
    step_at(SCAN_S * 10);
    assert_true(look(north));
    const struct rho_tracker_evidence near = evidence;
    assert_true(look(south));
    assert_true(near.support > evidence.support + 0.2f);
    assert_true(near.shared < 0.4f);
    assert_true(evidence.clutter > near.clutter);
}

static void a_miss_is_clutter_alone(void **state)
{
    (void)state;
    fly_pair(10, 4000.0, RHO_TRACKER_BEST);
    add_plot(-9000.0 + 200.0 * SCAN_S * 10, 2000.0, 10.0);
    step_at(SCAN_S * 10);
    assert_true(look(id_of(0)));
    assert_float_equal(evidence.clutter, 1.0, 0.0);
    assert_true(look(id_of(1)));
    assert_true(evidence.support > 0.99f);
}

/* A plot near the gate's border is little better than none. */
static void a_poor_plot_may_be_clutter(void **state)
{
    (void)state;
    float before = 0.0f;
    for (int off = 0; off <= 6; off++) {
        fly_pair(10, 4000.0, RHO_TRACKER_NEAREST);
        add_plot(-9000.0 + 200.0 * SCAN_S * 10, 2000.0 + 15.0 * off, 10.0);
        step_at(SCAN_S * 10);
        assert_true(look(id_of(1)));
        assert_true(evidence.clutter >= before);
        before = evidence.clutter;
    }
    assert_true(before > 0.5f);
}

/* The first track ends; what the second one's gate offered goes along with it. */
static void evidence_stays_with_its_track(void **state)
{
    (void)state;
    fly_pair(10, 4000.0, RHO_TRACKER_BEST);
    const int is_north = id_of(1) == 2;
    for (int k = 10; k < 40 && report.num_tracks == 2; k++) {
        add_plot(-9000.0 + 200.0 * SCAN_S * k, is_north ? 2000.0 : -2000.0, 10.0);
        step_at(SCAN_S * k);
        assert_true(look(2));
        assert_true(evidence.support > 0.99f);
    }
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].track_id, 2);
    assert_int_equal(rho_tracker_evidence_of(&tracker, 1, &evidence), 0);
}

static void a_track_of_this_step_and_one_not_looked_at_have_none(void **state)
{
    (void)state;
    use_usual_configs(2);
    begin_tracker();
    for (int k = 0; report.num_tracks == 0 || k == 0; k++) {
        add_pair(k, 4000.0);
        step_at(SCAN_S * k);
        assert_true(k < 8);
    }
    assert_int_equal(look(1), 0);
    for (int k = 4; k < 10; k++) {
        add_pair(k, 4000.0);
        step_at(SCAN_S * k);
    }
    assert_int_equal(look(1), 1);
    /* a sector in the west: both fly in the east by now, nobody looks there */
    step_scan((struct rho_scan){.time_us = 20000000,
                                .sector_from_rad = RHO_SECTORS ? 1.0f : 0.0f,
                                .sector_to_rad = RHO_SECTORS ? 1.5f : 0.0f});
    assert_int_equal(look(1), !RHO_SECTORS);
}

/* The lowest tentative track gives way: rows behind it move up. */
static void a_full_tracker_keeps_evidence_in_its_place(void **state)
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
        assert_true(look(id));
        assert_true(evidence.support > 0.99f);
    }
    for (unsigned i = 2; i < RHO_MAX_TRACKS; i++) {
        assert_int_equal(rho_tracker_evidence_of(&tracker, i, &evidence), 0);
    }
}

#endif

static void evidence_of_nothing_is_not_known(void **state)
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
        cmocka_unit_test(targets_far_apart_have_all_to_themselves),
#if RHO_KEEPS_OFFERS
        cmocka_unit_test(a_plot_between_two_targets_is_shared),
        cmocka_unit_test(a_miss_is_clutter_alone),
        cmocka_unit_test(a_poor_plot_may_be_clutter),
        cmocka_unit_test(evidence_stays_with_its_track),
        cmocka_unit_test(a_track_of_this_step_and_one_not_looked_at_have_none),
        cmocka_unit_test(a_full_tracker_keeps_evidence_in_its_place),
#endif
        cmocka_unit_test(evidence_of_nothing_is_not_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
