/* SPDX-License-Identifier: MIT */
/*
 * A radar's scans and frames of bearings update the same tracks; hostile frames; snapshots;
 * identical bytes.
 */
#include "bearing_frame_chain.h"

#define RADAR_X_M (-5000.0f)
#define RANGE_SIGMA_M 60.0
#define CROSS_SIGMA_M 400.0
#define DENSITY 6.25 /* density of the white acceleration that start_chain(5) assumes */

static struct rho_initiator initiator, initiator_then;
static struct rho_tracker tracker_then;
static struct rho_passive passive_then;
static struct rho_report report_then;
static struct rho_plot plot;
/* gate of the tracker (enum rho_tracker_gate), and whether inputs are estimated */
static uint8_t gate_used, has_inputs;

/* ---- a radar and passive sensors ------------------------------------------------------------- */

/*
 * Sets the gate after start_chain, which takes the default; an EKF that is told all associations
 * has the same model.
 */
static void set_tracker_gate(uint8_t gate)
{
    struct rho_tracker_config config = tracker.config;
    config.gate = gate;
    config.input.is_estimated = has_inputs;
    config.input.model = RHO_INPUT_PHYSICAL;
    config.input.sigma_mps2 = 5.0f;
    config.input.noise_density = 1.0f;
    config.input.noise_m = config.input.noise_mps = 0.0f;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
}

static void start_tracker_and_radar(void)
{
    struct rho_initiator_config config;
    const struct rho_sensor radar = {
        .sensor_id = 1, .x_m = RADAR_X_M, .pd = 0.9f, .range_max_m = 150e3f};
    rho_initiator_config_default(&config);
    config.v_max_mps = 450.0f;
    start_chain(5.0f);
    set_tracker_gate(gate_used);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &config), RHO_OK);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
}

/*
 * The radar's plot of the target at time_s: precise along the line of sight, imprecise across it.
 */
static void step_radar_scan_at(int64_t time_us, double time_s)
{
    double x_m = target_x_m(&scene.target[0], time_s), y_m = target_y_m(&scene.target[0], time_s);
    double azimuth_rad = atan2(y_m, x_m - (double)RADAR_X_M);
    double along_m = RANGE_SIGMA_M * normal();
    double across_m = CROSS_SIGMA_M * normal();
    double c = cos(azimuth_rad), s = sin(azimuth_rad);
    plot = (struct rho_plot){.x_m = (float)(x_m + along_m * c - across_m * s),
                             .y_m = (float)(y_m + along_m * s + across_m * c),
                             .sigma_range_m = (float)RANGE_SIGMA_M,
                             .sigma_cross_m = (float)CROSS_SIGMA_M};
    const struct rho_scan scan = {
        .time_us = time_us, .sensor_id = 1, .num_plots = 1, .plots = &plot};
    memset(&report, 0xee, sizeof report);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    check_report();
}

static void step_radar_scan(double time_s)
{
    step_radar_scan_at(llround(time_s * 1e6), time_s);
}

static void draw_one_target_and_start_tracker_and_radar(unsigned seed)
{
    random_state = seed;
    scene = scene_of(2, 1, 0.1, 1.0, 0.0);
    scene.target[0] = random_target(270.0);
    start_tracker_and_radar();
}

/* Errors of the radar alone, of the radar with bearings, and of an EKF with both. */
struct figures {
    double alone2, both2, ekf2;
    unsigned rows;
};

static void fly_radar_and_bearings(unsigned seed, int has_bearings, struct figures *figures)
{
    draw_one_target_and_start_tracker_and_radar(seed);
    for (unsigned k = 0; k < 12; k++) {
        step_radar_scan(10.0 * k);
    }
    assert_int_equal(report.num_tracks, 1);
    const uint32_t track_id = report.tracks[0].track_id;
    struct ekf ekf = ekf_from_track(&report.tracks[0]);
    for (unsigned k = 12; k < 26; k++) {
        step_radar_scan(10.0 * k);
        assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
        ekf_predict(&ekf, k > 12 ? 6.0 : 10.0, DENSITY);
        ekf_take_plot(&ekf, (double)RADAR_X_M, 0.0, &plot);
        see_frame(k, 10.0 * k + 4.0);
        ekf_predict(&ekf, 4.0, DENSITY);
        if (has_bearings) {
            step_frame(&full.frame);
            ekf_take_frame(&ekf, k, 0);
            assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 2);
            assert_int_equal(report.tracks[0].hits + report.tracks[0].misses, 12 + 3 * (k - 11));
        }
    }
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].track_id, track_id);
    assert_int_equal(tracker.counters.tracks_started, 1);
    const double time_s = 250.0 + (has_bearings ? 4.0 : 0.0);
    const double error2 = pow(track_error_m(&report.tracks[0], &scene.target[0], time_s), 2.0);
    if (has_bearings) {
        figures->both2 += error2;
        figures->ekf2 += pow(ekf_error_m(&ekf, &scene.target[0], time_s), 2.0);
        figures->rows++;
    } else {
        figures->alone2 += error2;
    }
}

/* RMS error with bearings over that of the EKF, which is told all associations. */
static double error_ratio_to_ekf(enum rho_tracker_gate by)
{
    struct figures figures = {0};
    gate_used = (uint8_t)by;
    for (unsigned seed = 1; seed <= 40; seed++) {
        fly_radar_and_bearings(seed, 0, &figures);
        fly_radar_and_bearings(seed, 1, &figures);
    }
    double alone_m = sqrt(figures.alone2 / figures.rows),
           ratio = sqrt(figures.both2 / figures.ekf2);
    double both_m = sqrt(figures.both2 / figures.rows);
    print_message(
        "gate %d: a radar's track: rms %.0f m, with bearings %.0f m, %.4f of the filter's\n",
        (int)by, alone_m, both_m, ratio);
    assert_true(both_m < 0.7 * alone_m);
    return ratio;
}

static void bearings_improve_a_track_of_a_radar(void **state)
{
    (void)state;
    double nearest = error_ratio_to_ekf(RHO_TRACKER_NEAREST);
    double hough = error_ratio_to_ekf(RHO_TRACKER_HOUGH);
    double best = error_ratio_to_ekf(RHO_TRACKER_BEST);
    assert_true(nearest > 0.97 && nearest < 1.05);
    /* with one plot in the gate there is no choice, so it equals the EKF */
    assert_true(hough > 0.97 && hough < 1.05);
    /* 0.59: the targets fly straight, and gate best detects it */
    assert_true(best > 0.5 && best < 0.7);
}

static void a_track_started_by_bearings_takes_plots_of_a_radar(void **state)
{
    (void)state;
    double before_m = 0.0, after_m = 0.0;
    unsigned claimed = 0;
    for (unsigned seed = 1; seed <= 20; seed++) {
        draw_one_target_and_start_tracker_and_radar(seed);
        fly_frames(0, 10, 10.0);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].hits, 20);
        const uint32_t track_id = report.tracks[0].track_id;
        before_m += (double)report.tracks[0].sigma_m;
        for (unsigned k = 0; k < 12; k++) {
            step_radar_scan(91.0 + 10.0 * k);
            assert_int_equal(report.num_tracks, 1);
            if (report.fates[0] == RHO_FATE_CLAIMED) {
                claimed += k >= 2;
                assert_int_equal(report.tracks[0].sensor_id, 1);
                assert_int_equal(report.tracks[0].plot, 0);
            }
            fly_frame(10 + k, 10.0);
            assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 2);
        }
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].track_id, track_id);
        assert_int_equal(tracker.counters.tracks_started, 1);
        after_m += (double)report.tracks[0].sigma_m;
        assert_true(track_error_m(&report.tracks[0], &scene.target[0], 210.0) <
                    5.0 * (double)report.tracks[0].sigma_m);
    }
    print_message("%u of 200 plots claimed, sigma %.2f of before\n", claimed, after_m / before_m);
    /* until the third scan the clutter density is that of plots at one place */
    assert_in_range(claimed, gate_used == RHO_TRACKER_NEAREST ? 200 : 198, 200);
    assert_true(after_m < 0.9 * before_m);
}

/*
 * Scan and frame of one time are both accepted; a scan earlier than a frame is late, and vice
 * versa.
 */
static void scans_and_frames_share_one_order_of_time(void **state)
{
    (void)state;
    draw_one_target_and_start_tracker_and_radar(4);
    for (unsigned k = 0; k < 10; k++) {
        step_radar_scan(10.0 * k);
        fly_frame(k, 10.0);
    }
    assert_int_equal(tracker.counters.scans_accepted, 30);
    step_radar_scan(90.0);
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
    step_radar_scan(89.999999);
    assert_int_equal(report.fates[0], RHO_FATE_STALE);
    step_radar_scan(95.0);
    see_frame(10, 94.0);
    step_frame(&full.frame);
    assert_int_equal(report.fates_total[RHO_FATE_STALE], 2);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(tracker.counters.scans_late, 3);
}

/* ---- identical bytes ------------------------------------------------------------------------- */

/* Steps targets, clutter and a radar from step `from` to step `to` - 1. */
static void step_scans_and_frames(unsigned from, unsigned to)
{
    for (unsigned k = from; k < to; k++) {
        if (k % 3 == 0) {
            step_radar_scan(5.0 * k);
        }
        fly_frame(k, 5.0);
    }
}

static void start_mixed_scene(void)
{
    random_state = 77;
    scene = scene_of(3, 3, 0.1, 0.9, 1.0);
    for (unsigned i = 0; i < 3; i++) {
        scene.target[i] = random_target(200.0);
    }
    start_tracker_and_radar();
}

static void expect_same_bytes(void)
{
    assert_memory_equal(&report, &report_then, sizeof report);
    assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
    assert_memory_equal(&passive, &passive_then, sizeof passive);
    assert_memory_equal(&initiator, &initiator_then, sizeof initiator);
}

static void copy_objects(void)
{
    tracker_then = tracker;
    passive_then = passive;
    initiator_then = initiator;
    report_then = report;
}

/* The result does not depend on what the objects or the stack held before. */
static void the_same_input_gives_the_same_bytes(void **state)
{
    (void)state;
    start_mixed_scene();
    step_scans_and_frames(0, 40);
    assert_true(tracker.counters.tracks_started >= 3);
    copy_objects();
    memset(&tracker, 0xa5, sizeof tracker);
    memset(&passive, 0xa5, sizeof passive);
    memset(&initiator, 0xa5, sizeof initiator);
    volatile uint8_t dirt[16384];
    for (unsigned i = 0; i < sizeof dirt; i++) {
        dirt[i] = 0xa5;
    }
    start_mixed_scene();
    step_scans_and_frames(0, 40);
    /* padding of a configuration is the caller's */
    memcpy(&tracker_then.config, &tracker.config, sizeof tracker.config);
    memcpy(&passive_then.config, &passive.config, sizeof passive.config);
    memcpy(&initiator_then.config, &initiator.config, sizeof initiator.config);
    expect_same_bytes();
}

static void a_snapshot_continues_with_the_same_bytes(void **state)
{
    (void)state;
    static uint8_t snapshot[sizeof tracker + sizeof passive + sizeof initiator];
    struct scene scene_then;
    start_mixed_scene();
    step_scans_and_frames(0, 20);
    memcpy(snapshot, &tracker, sizeof tracker);
    memcpy(snapshot + sizeof tracker, &passive, sizeof passive);
    memcpy(snapshot + sizeof tracker + sizeof passive, &initiator, sizeof initiator);
    scene_then = scene;
    uint64_t random_then = random_state;
    step_scans_and_frames(20, 40);
    copy_objects();
    memcpy(&tracker, snapshot, sizeof tracker);
    memcpy(&passive, snapshot + sizeof tracker, sizeof passive);
    memcpy(&initiator, snapshot + sizeof tracker + sizeof passive, sizeof initiator);
    scene = scene_then;
    random_state = random_then;
    step_scans_and_frames(20, 40);
    expect_same_bytes();
}

/* ---- hostile frames -------------------------------------------------------------------------- */

/* A number that is mostly plausible, sometimes anything. */
static float hostile_float(double from, double to)
{
    return float_or_any(from, to, 0.02);
}

static int32_t hostile_offset_us(void)
{
    double what = uniform(0.0, 1.0);
    return what < 0.8 ? 0 : what < 0.9 ? (int32_t)random_bits() : (int32_t)uniform(-6e7, 6e7);
}

/* Puts hostile values near what the sensors see of the scene. */
static void put_hostile_values(struct rho_bearing_scan *scan, struct look *look)
{
    for (unsigned i = 0; i < look->count; i++) {
        struct rho_bearing *bearing = &look->bearings[i];
        bearing->offset_us = hostile_offset_us();
        bearing->sigma_rad =
            uniform(0.0, 1.0) < 0.9 ? bearing->sigma_rad : hostile_float(-0.1, 0.6);
        bearing->bearing_rad =
            uniform(0.0, 1.0) < 0.9 ? bearing->bearing_rad : hostile_float(-4.0, 4.0);
    }
    scan->sector_from_rad = uniform(0.0, 1.0) < 0.9 ? 0.0f : hostile_float(-6.2, 6.2);
    scan->sector_to_rad = uniform(0.0, 1.0) < 0.9 ? 0.0f : hostile_float(-6.2, 6.2);
    scan->time_us += uniform(0.0, 1.0) < 0.9 ? 0 : (int64_t)uniform(-6.5e7, 6.5e7);
    scan->z_m = uniform(0.0, 1.0) < 0.98 ? scan->z_m : NAN;
    scan->x_m = uniform(0.0, 1.0) < 0.95 ? scan->x_m : hostile_float(-1e5, 1e5);
    scan->sensor_id = uniform(0.0, 1.0) < 0.99 ? scan->sensor_id : (int32_t)random_bits();
}

/* The frame's time goes on by anything from 0 to days, and sometimes back. */
static int64_t hostile_next_time_us(int64_t time_us)
{
    double what = uniform(0.0, 1.0);
    return time_us + (what < 0.9    ? (int64_t)uniform(0.0, 2e7)
                      : what < 0.95 ? -(int64_t)uniform(0.0, 2e7)
                      : what < 0.99 ? (int64_t)exp(uniform(0.0, 26.0))
                                    : 0);
}

static void hostile_frames_keep_the_tracker_sound(void **state)
{
    (void)state;
    unsigned taken = 0, refused = 0;
    int has_filters = 0;
    uint32_t started = 0, claimed = 0;
    for (unsigned run = 0; run < 6; run++) {
        int64_t time_us = run == 0 ? -RHO_LIMIT_TIME_US : 0;
        random_state = 500 + run;
        scene = scene_of(3, 3, 0.1, 0.95, 0.5);
        for (unsigned i = 0; i < 3; i++) {
            scene.target[i] = random_target(400.0);
        }
        start_tracker_and_radar();
        for (unsigned k = 0; k < 120; k++) {
            if (k % 40 < 12 || k % 3 == 0) { /* the first target also gives a plot of the radar */
                step_radar_scan_at(time_us, 10.0 * (k % 40));
                has_filters |=
                    tracker.num_tracks > 0 && tracker.tracks[0].filter != RHO_TRACK_KALMAN;
            }
            see_frame(k, 10.0 * (k % 40));
            for (unsigned s = 0; s < 3 && k % 40 >= 12; s++) {
                put_hostile_values(&full.scans[s], &scene.look[scene_slot_of(k)][s]);
            }
            int64_t shift_us = time_us - full.frame.time_us;
            for (unsigned s = 0; s < 3; s++) {
                full.scans[s].time_us += shift_us;
            }
            full.frame.time_us = time_us;
            full.frame.num_scans = (uint32_t)uniform(k % 40 < 12 ? 3.0 : 0.0, 3.999);
            for (uint32_t s = 0; s < full.frame.num_scans; s++) {
                copy_objects();
                enum rho_status status = rho_tracker_step_bearings(
                    &tracker, uniform(0.0, 1.0) < 0.97 ? &passive : NULL, &full.scans[s], &report);
                if (status == RHO_OK) {
                    const struct rho_frame look = {.num_scans = 1, .scans = &full.scans[s]};
                    check_fate_counts_add_up(&look);
                    check_report();
                    taken++;
                } else {
                    expect_same_bytes();
                    refused++;
                }
            }
            time_us = k % 40 < 12 ? time_us + 10000000 : hostile_next_time_us(time_us);
        }
        started += tracker.counters.tracks_started;
        claimed += tracker.counters.fates[RHO_FATE_CLAIMED];
    }
    print_message("hostile frames: %u taken, %u refused, %u tracks started, %u bearings claimed\n",
                  taken, refused, (unsigned)started, (unsigned)claimed);
    assert_true(taken > 450 && refused > 10);
    assert_true(started > 15 && claimed > 250);
    assert_int_equal(has_filters, has_inputs || gate_used == RHO_TRACKER_BEST);
}

/* ---- the tests above, for each gate ---------------------------------------------------------- */

int main(void)
{
    static const struct {
        const char *name;
        uint8_t gate, has_inputs;
    } ways[] = {
        {"nearest", RHO_TRACKER_NEAREST, 0},
        {"hough, input estimation", RHO_TRACKER_HOUGH, 1},
        {"best", RHO_TRACKER_BEST, 0},
    };
    const struct CMUnitTest figures[] = {
        cmocka_unit_test(bearings_improve_a_track_of_a_radar),
    };
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_track_started_by_bearings_takes_plots_of_a_radar),
        cmocka_unit_test(scans_and_frames_share_one_order_of_time),
        cmocka_unit_test(the_same_input_gives_the_same_bytes),
        cmocka_unit_test(a_snapshot_continues_with_the_same_bytes),
        cmocka_unit_test(hostile_frames_keep_the_tracker_sound),
    };
    int failed = cmocka_run_group_tests(figures, NULL, NULL);
    for (unsigned i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        gate_used = ways[i].gate;
        has_inputs = ways[i].has_inputs;
        failed += cmocka_run_group_tests_name(ways[i].name, tests, NULL, NULL);
    }
    return failed;
}
