/* SPDX-License-Identifier: MIT */
/*
 * What holds for each gate: no plot has two tracks, fates add up, no hypothesis is lost, results
 * are byte-identical. That gate best is refused in builds with fewer hypotheses than tracks cannot
 * be tested at run time.
 */
#include "gates_scene.h"

#define NUM_SCANS 40

/* gates, each plain or with input estimation */
static const struct {
    uint8_t gate, has_inputs;
} ways[] = {{RHO_TRACKER_BEST, 0},
            {RHO_TRACKER_HOUGH, 0},
            {RHO_TRACKER_NEAREST, 0},
            {RHO_TRACKER_HOUGH, 1},
            {RHO_TRACKER_NEAREST, 1}};
#define NUM_WAYS (sizeof ways / sizeof ways[0])

static void set_up_gate(unsigned way, uint64_t seed)
{
    set_up_scene(ways[way].gate, seed);
    if (ways[way].has_inputs) {
        estimate_inputs();
    }
}

/* ---- scenes ---------------------------------------------------------------------------------- */

/*
 * Four targets that meet in the middle, two side by side, two that turn; seen with misses among
 * clutter.
 */
static void set_eight_targets_of_scene(void)
{
    static const struct target targets[] = {
        {-4000.0, -4000.0, 3000.0, 200.0, 0.7854, 0.0, 0.0, 0.0},
        {4000.0, -4000.0, 3100.0, 200.0, 2.3562, 0.0, 0.0, 0.0},
        {-4000.0, 4000.0, 5000.0, 205.0, -0.7854, 0.0, 0.0, 0.0},
        {4000.0, 4000.0, 5200.0, 195.0, -2.3562, 0.0, 0.0, 0.0},
        {-7000.0, 6000.0, 2000.0, 250.0, 0.0, 0.0, 0.0, 0.0},
        {-7000.0, 6060.0, 2000.0, 250.0, 0.0, 0.0, 0.0, 0.0},
        {0.0, -7000.0, 1000.0, 220.0, 0.0, 25.0, 12.0, 24.0},
        {3000.0, -7000.0, 8000.0, 300.0, 1.5708, -30.0, 15.0, 22.0},
    };
    scene.num_targets = 8;
    memcpy(scene.target, targets, sizeof targets);
    scene.pd = 0.85;
    scene.clutter = 25.0;
}

enum { FLAT, OWN_TIMES, HEIGHTS, POLAR, VELOCITIES, SECTORS, ALL_OF_IT, DENSE, NUM_KINDS };

static void set_up_scene_variant(int kind)
{
    int all = kind == ALL_OF_IT;
    set_eight_targets_of_scene();
    scene.turn_s = kind == OWN_TIMES || all ? 0.9 : 0.0;
    scene.measures |= kind == HEIGHTS || all ? RHO_MEASURES_Z : 0u;
    scene.sigma_cross_m = kind == POLAR || all ? 60.0 : 0.0;
    scene.measures |= kind == POLAR || all ? RHO_MEASURES_RANGE_RATE : 0u;
    scene.measures |= kind == VELOCITIES ? RHO_MEASURES_VELOCITY : 0u;
    scene.num_sectors = kind == SECTORS ? 3 : 0;
    scene.interval_s = kind == SECTORS ? 0.4 : 1.0;
    if (kind == DENSE) {
        scene.sigma_m = 40.0;
        scene.clutter = 150.0;
        scene.half_area_m = 5000.0;
    }
}

/* Steps on without targets until all tracks have ended. */
static void end_all_tracks(int k)
{
    scene.num_targets = 0;
    scene.clutter = 0.0;
    scene.num_sectors = 0;
    for (int i = 0; i < 45; i++) { /* hidden for three turns of three sectors, at most */
        step_tracker(k + i);
    }
    assert_int_equal(report.num_tracks, 0);
    assert_int_equal(tracker.hypotheses.num_free, RHO_MAX_HYPOTHESES);
}

static void every_gate_keeps_counters_and_pool_consistent(void **state)
{
    (void)state;
    for (unsigned way = 0; way < NUM_WAYS; way++) {
        for (int kind = 0; kind < NUM_KINDS; kind++) {
            unsigned most = 0, followed = 0;
            set_up_gate(way, 100 + (uint64_t)kind);
            set_up_scene_variant(kind);
            begin_tracker();
            for (int k = 0; k < NUM_SCANS; k++) {
                step_tracker(k);
                for (unsigned i = 0; i < report.num_tracks; i++) {
                    most = report.tracks[i].num_hypotheses > most ? report.tracks[i].num_hypotheses
                                                                  : most;
                }
            }
            for (unsigned i = 0; i < scene.num_targets; i++) {
                followed += confirmed_track_nearest_to_target(i, scene.interval_s * (NUM_SCANS - 1),
                                                              300.0) != NULL;
            }
            /* measured: all targets, but for one that turns in dense clutter */
            assert_true(followed + (kind == DENSE && ways[way].gate != RHO_TRACKER_BEST) >=
                        scene.num_targets);
            assert_in_range(tracker.counters.tracks_started, kind == SECTORS ? 7 : 8, 30);
            assert_int_equal(tracker.counters.updates_refused, 0);
            assert_true(kind == DENSE || tracker.counters.hypotheses_cut == 0);
            assert_int_equal(most, ways[way].gate != RHO_TRACKER_BEST ? 1
                                   : kind == DENSE                    ? RHO_HYPOTHESES_OF_TRACK
                                                                      : most);
            end_all_tracks(NUM_SCANS);
        }
    }
}

/* ---- identical bytes ------------------------------------------------------------------------- */

static struct rho_tracker tracker_then;
static struct rho_initiator initiator_then;
static struct rho_report report_then;
static uint64_t random_then;

static void start_scene_of_all_variants(unsigned way)
{
    set_up_gate(way, 9);
    set_up_scene_variant(ALL_OF_IT);
    begin_tracker();
}

static void replays_and_snapshots_give_identical_bytes(void **state)
{
    (void)state;
    for (unsigned way = 0; way < NUM_WAYS; way++) {
        static uint8_t snapshot[sizeof tracker + sizeof initiator];
        start_scene_of_all_variants(way);
        for (int k = 0; k < 20; k++) {
            step_tracker(k);
        }
        memcpy(snapshot, &tracker, sizeof tracker);
        memcpy(snapshot + sizeof tracker, &initiator, sizeof initiator);
        random_then = random_state;
        for (int k = 20; k < NUM_SCANS; k++) {
            step_tracker(k);
        }
        memcpy(&tracker_then, &tracker, sizeof tracker);
        memcpy(&initiator_then, &initiator, sizeof initiator);
        memcpy(&report_then, &report, sizeof report);
        /* restored from the middle of the run */
        memcpy(&tracker, snapshot, sizeof tracker);
        memcpy(&initiator, snapshot + sizeof tracker, sizeof initiator);
        random_state = random_then;
        for (int k = 20; k < NUM_SCANS; k++) {
            step_tracker(k);
        }
        assert_memory_equal(&report, &report_then, sizeof report);
        assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
        assert_memory_equal(&initiator, &initiator_then, sizeof initiator);
        /* and into memory of other bytes */
        memset(&tracker, 0xa5, sizeof tracker);
        memset(&initiator, 0xa5, sizeof initiator);
        start_scene_of_all_variants(way);
        for (int k = 0; k < NUM_SCANS; k++) {
            step_tracker(k);
        }
        assert_memory_equal(&report, &report_then, sizeof report);
        assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
    }
}

/* ---- too late scans -------------------------------------------------------------------------- */

/*
 * A too late scan changes counters alone; its report shows the tracks at its time, and later scans
 * are unaffected.
 */
static void too_late_scans_change_nothing_and_report_at_their_time(void **state)
{
    (void)state;
    for (unsigned way = 0; way < NUM_WAYS; way++) {
        set_up_gate(way, 3);
        scene.num_targets = 1;
        scene.target[0] = (struct target){-4000.0, 500.0, 0.0, 200.0, 0.0, 20.0, 10.0, 30.0};
        begin_tracker();
        for (int k = 0; k < 20; k++) {
            step_tracker(k);
        }
        memcpy(&tracker_then, &tracker, sizeof tracker);
        memcpy(&initiator_then, &initiator, sizeof initiator);
        memcpy(&report_then, &report, sizeof report);
        float x_m = report.tracks[0].state[0], vx_mps = report.tracks[0].state[3];
        struct rho_scan scan = {.time_us = 18000000, .num_plots = 1, .plots = plots};
        assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
        assert_int_equal(report.fates_total[RHO_FATE_STALE], 1);
        assert_int_equal(report.time_us, 18000000);
        assert_int_equal(report.num_tracks, 1);
        assert_float_equal(report.tracks[0].state[0], x_m - vx_mps, 5.0f);
        assert_float_equal(report.tracks[0].state[3], vx_mps, way > 2 ? 25.0f : 0.01f);
        assert_int_equal(report.tracks[0].num_hypotheses, report_then.tracks[0].num_hypotheses);
        tracker_then.counters = tracker.counters;
        assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
        assert_memory_equal(&initiator, &initiator_then, sizeof initiator);
    }
}

/* ---- configuration --------------------------------------------------------------------------- */

static void expect_config_refused(const struct rho_tracker_config *bad)
{
    memset(&tracker, 0x5a, sizeof tracker);
    memcpy(&tracker_then, &tracker, sizeof tracker);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, bad), RHO_ERROR_CONFIG);
    assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
}

/* Unused parameters of a gate must be within their ranges, too. */
static void bad_configurations_of_gates_are_refused(void **state)
{
    static const float cells_rad[] = {0.0f, 0.00099f, 1.5709f, -0.1f, NAN, INFINITY};
    struct rho_tracker_config bad;
    (void)state;
    for (unsigned way = 0; way < NUM_WAYS; way++) {
        set_up_gate(way, 1);
        begin_tracker(); /* a valid tracker */
        for (unsigned i = 0; i < sizeof cells_rad / sizeof cells_rad[0]; i++) {
            bad = config;
            bad.theta_cell_rad = cells_rad[i];
            expect_config_refused(&bad);
        }
        for (unsigned planes = 0; planes < 256; planes = planes ? planes + 31 : 8) {
            bad = config;
            bad.planes = (uint8_t)planes;
            expect_config_refused(&bad);
        }
        for (unsigned gate = RHO_NUM_TRACKER_GATES; gate < 256; gate++) {
            bad = config;
            bad.gate = (uint8_t)gate;
            expect_config_refused(&bad);
        }
        for (int field = 0; field < 7; field++) {
            bad = config;
            bad.input.model = field == 0 ? RHO_NUM_INPUT_MODELS : bad.input.model;
            bad.input.sigma_mps2 = field == 1 ? NAN : bad.input.sigma_mps2;
            bad.input.threshold = field == 2 ? 0.0f : bad.input.threshold;
            bad.input.gamma = field == 3 ? 1.01f : bad.input.gamma;
            bad.input.noise_density = field == 4 ? -1.0f : bad.input.noise_density;
            bad.input.noise_m = field == 5 ? INFINITY : bad.input.noise_m;
            bad.input.velocity_variance = field == 6 ? 0.0f : bad.input.velocity_variance;
            expect_config_refused(&bad);
        }
    }
}

static void limits_of_configuration_ranges_are_accepted(void **state)
{
    (void)state;
    set_up_scene(RHO_TRACKER_HOUGH, 1);
    config.planes = RHO_GATE_PLANE_YZ;
    config.theta_cell_rad = 1e-3f;
    begin_tracker();
    config.planes = 1;
    config.theta_cell_rad = 1.5707963f;
    begin_tracker();
    config.accel_max_mps2 = 0.0f;
    config.gate = RHO_TRACKER_BEST;
    begin_tracker();
    config.accel_max_mps2 = 1000.0f;
    config.v_max_mps = 1.0f;
    begin_tracker();
    config.v_max_mps = RHO_LIMIT_SPEED_MPS;
    begin_tracker();
}

static void the_default_gate_is_best(void **state)
{
    (void)state;
    struct rho_tracker_config given;
    rho_tracker_config_default(&given);
    assert_int_equal(given.gate, RHO_TRACKER_BEST);
    assert_int_equal(given.input.is_estimated, 0);
    assert_int_equal(given.planes, 7);
    assert_float_equal(given.theta_cell_rad, 0.08726646f, 1e-7f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_gate_keeps_counters_and_pool_consistent),
        cmocka_unit_test(replays_and_snapshots_give_identical_bytes),
        cmocka_unit_test(too_late_scans_change_nothing_and_report_at_their_time),
        cmocka_unit_test(bad_configurations_of_gates_are_refused),
        cmocka_unit_test(limits_of_configuration_ranges_are_accepted),
        cmocka_unit_test(the_default_gate_is_best),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
