/* SPDX-License-Identifier: MIT */
/*
 * Frames of bearings: identities, misses, sensors that are late, blind or look elsewhere, and
 * bearings' own times.
 */
#include "bearing_frame_chain.h"
#include "life_chain.h"

#define MISS_NAT 2.302585 /* -ln(1 - pd) of the default */

static uint8_t gate_of_tracks; /* enum rho_tracker_gate */

/* A target that is found and followed until frame 11 at 110 s. */
static void track_random_target_for_twelve_frames(unsigned seed)
{
    random_state = seed;
    scene = scene_of(2, 1, 0.1, 1.0, 0.0);
    start_chain(5.0f);
    use_gate(gate_of_tracks);
    scene.target[0] = random_target(240.0);
    fly_frames(0, 12, 10.0);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
    assert_int_equal(report.tracks[0].hits, 24);
    assert_int_equal(report.tracks[0].misses, 0);
}

/* ---- identities of crossing targets ---------------------------------------------------------- */

/* A target range_m away from sensor 0 at time_s; velocity along the line of sight and across it. */
static struct target target_passing_by(double range_m, double direction_rad, double along_mps,
                                       double across_mps, double time_s)
{
    double c = cos(direction_rad), s = sin(direction_rad);
    struct target target = {.vx_mps = along_mps * c - across_mps * s,
                            .vy_mps = along_mps * s + across_mps * c};
    target.x_m = scene.sensor_x_m[0] + range_m * c - time_s * target.vx_mps;
    target.y_m = scene.sensor_y_m[0] + range_m * s - time_s * target.vy_mps;
    return target;
}

/* At 96 s both targets are on one bearing of sensor 0, 20 km apart; their bearings cross. */
static void draw_crossing_targets(void)
{
    double direction_rad = uniform(0.1, 0.6), rate = uniform(0.0003, 0.002);
    double near_mps = uniform(-60.0, 60.0);
    rate = uniform(-1.0, 1.0) < 0.0 ? -rate : rate;
    double far_mps = 55e3 * (near_mps / 35e3 + rate);
    double near_along_mps = uniform(-150.0, 150.0);
    scene.target[0] = target_passing_by(35e3, direction_rad, near_along_mps, near_mps, 96.0);
    scene.target[1] = target_passing_by(55e3, direction_rad, uniform(-150.0, 150.0), far_mps, 96.0);
}

/*
 * Three sensors, as with two the ghosts of such targets fly as straight as the targets. In 299 of
 * 300 runs identities are kept.
 */
static void targets_that_cross_at_one_sensor_keep_their_identities(void **state)
{
    (void)state;
    unsigned kept = 0;
    for (unsigned seed = 1; seed <= 30; seed++) {
        const struct rho_track_report *track[2];
        uint32_t track_id[2];
        random_state = seed;
        scene = scene_of(3, 2, 0.1, 0.95, 0.0);
        draw_crossing_targets();
        start_chain(5.0f);
        fly_frames(0, 12, 6.0);
        for (unsigned i = 0; i < 2; i++) {
            track[i] = track_nearest_to(&scene.target[i], 66.0);
            track_id[i] = track[i] ? track[i]->track_id : 0;
        }
        fly_frames(12, 24, 6.0);
        for (unsigned i = 0; i < 2; i++) {
            track[i] = track_nearest_to(&scene.target[i], 138.0);
        }
        kept += tracker.counters.tracks_started == 2 && track[0] && track[1] &&
                track[0]->track_id == track_id[0] && track[1]->track_id == track_id[1];
    }
    print_message("identities kept: %u of 30 runs\n", kept);
    assert_true(kept >= 29);
}

/* ---- misses ---------------------------------------------------------------------------------- */

/* Both sensors look and see nothing. */
static void step_frame_without_targets(unsigned k)
{
    scene.targets = 0;
    fly_frame(k, 10.0);
}

/*
 * A scan whose bearings fill their room may have lost those of targets: it counts as one that sees
 * half as much, and teaches no P_D.
 */
static void full_scans_are_half_a_miss(void **state)
{
    static struct rho_bearing bearings[RHO_MAX_BEARINGS];
    double lost_nat[2];
    (void)state;
    for (int is_full = 0; is_full < 2; is_full++) {
        track_random_target_for_twelve_frames(3);
        const double score_nat = (double)report.tracks[0].score_nat;
        const struct rho_tracker_sensor *row = &tracker.sensors[0];
        const float looks = row->looks;
        see_frame(12, 120.0);
        const double y_m = target_y_m(&scene.target[0], 120.0) - scene.sensor_y_m[0];
        const double x_m = target_x_m(&scene.target[0], 120.0) - scene.sensor_x_m[0];
        for (int k = 0; k < RHO_MAX_BEARINGS; k++) { /* on the other side of the sensor */
            bearings[k] = (struct rho_bearing){.bearing_rad = (float)atan2(-y_m, -x_m) * 0.99f,
                                               .sigma_rad = 0.004f};
        }
        full.frame.num_scans = 1;
        full.scans[0].num_bearings = is_full ? RHO_MAX_BEARINGS : RHO_MAX_BEARINGS - 1;
        full.scans[0].bearings = bearings;
        const double pd = (row->hits + 0.9f) / (looks + (is_full ? 1.0f : 2.0f));
        step_frame(&full.frame);
        assert_float_equal(row->looks - looks, is_full ? 0.0f : 1.0f, 0.02f);
        lost_nat[is_full] = score_nat - (double)report.tracks[0].score_nat;
        assert_float_equal(lost_nat[is_full], -log(1.0 - fmin(pd, 0.98) * (is_full ? 0.5 : 1.0)),
                           0.05);
    }
    assert_true(lost_nat[0] > 2.0 * lost_nat[1]);
}

/* Each look that misses leaves less of the visible targets, and takes less from the score. */
static void looks_without_its_bearings_end_a_track(void **state)
{
    (void)state;
    track_random_target_for_twelve_frames(3);
    tracker.config.learn_pd_min = 1.0f; /* the P_D is the stated one */
    const uint32_t track_id = report.tracks[0].track_id;
    struct life_chain chain = {.visible = (double)tracker.tracks[0].visible,
                               .hidden = (double)tracker.tracks[0].hidden,
                               .is_established = 1};
    double score_nat = (double)report.tracks[0].score_nat;
    unsigned misses = 0;
    while (report.num_tracks > 0 && misses < 40) {
        const enum rho_track_status before = report.tracks[0].status;
        const struct rho_tracker_life rates = rho_tracker_life(&tracker);
        step_frame_without_targets(12 + misses++);
        chain_pass(&chain, 1.0, &rates, 0.0);
        for (int sensor = 0; sensor < 2; sensor++) {
            const double seen = chain.visible / chain_exists(&chain);
            double blind = 0.0;
            chain.share = seen < 0.95 ? seen : 1.0;
            const double gain_nat = log(1.0 - 0.9 * chain.share);
            chain_weigh(&chain, &gain_nat, 1, &blind, 2 * (int)misses + sensor <= 6);
            score_nat += gain_nat;
        }
        assert_int_equal(report.num_tracks > 0 ? report.tracks[0].status : RHO_TRACK_FREE,
                         chain_status(&chain, before, 1));
        if (report.num_tracks > 0) {
            assert_float_equal(tracker.tracks[0].visible, chain.visible, 1e-3);
            assert_float_equal(tracker.tracks[0].hidden, chain.hidden, 1e-3);
            assert_int_equal(report.tracks[0].misses, 2 * misses);
            assert_int_equal(report.tracks[0].hits, 24);
            assert_int_equal(report.tracks[0].plot, -1);
            assert_int_equal(report.tracks[0].update_age_us, 10000000 * (int)misses);
            assert_float_equal(report.tracks[0].score_nat, score_nat, 0.02);
        }
    }
    print_message("ended after %u frames\n", misses);
    assert_int_equal(report.num_ended, 1);
    assert_int_equal(report.ended[0], track_id);
    assert_int_equal(tracker.counters.tracks_ended, 1);
}

static void a_bearing_restarts_the_misses_in_a_row_of_a_track(void **state)
{
    (void)state;
    track_random_target_for_twelve_frames(3);
    for (unsigned k = 12; k < 16; k++) {
        step_frame_without_targets(k);
    }
    scene.targets = 1;
    fly_frame(16, 10.0);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
    assert_int_equal(report.tracks[0].hits, 26);
    assert_int_equal(report.tracks[0].misses, 8);
    step_frame_without_targets(17);
    assert_int_equal(report.num_tracks, 1);
    assert_int_equal(report.tracks[0].status, RHO_TRACK_COASTING);
    assert_int_equal(report.tracks[0].misses, 10);
}

/* Sensor 1 is blind in one frame and absent in another, otherwise the same. */
static void a_miss_of_one_sensor_leaves_the_estimate(void **state)
{
    (void)state;
    static struct rho_tracker tracker_then;
    static struct rho_passive passive_then;
    track_random_target_for_twelve_frames(3);
    tracker.config.learn_pd_min = 1.0f; /* the P_D is the stated one */
    see_frame(12, 120.0);
    tracker_then = tracker;
    passive_then = passive;
    full.scans[1].num_bearings = 0;
    step_frame(&full.frame);
    struct rho_track_report blind = report.tracks[0];
    tracker = tracker_then;
    passive = passive_then;
    full.frame.num_scans = 1;
    step_frame(&full.frame);
    const struct rho_track_report *absent = &report.tracks[0];
    assert_float_equal(absent->score_nat - blind.score_nat, MISS_NAT, 0.002);
    assert_memory_equal(absent->state, blind.state, sizeof blind.state);
    assert_memory_equal(absent->covariance, blind.covariance, sizeof blind.covariance);
    for (int i = 0; i < 2; i++) {
        const struct rho_track_report *track = i ? &blind : absent;
        assert_int_equal(track->status, i ? RHO_TRACK_COASTING : RHO_TRACK_CONFIRMED);
        assert_int_equal(track->hits, 25);
        assert_int_equal(track->misses, i);
        assert_int_equal(track->plot, i ? -1 : 0);
        assert_int_equal(track->sensor_id, 10);
    }
}

/* ---- absent sensors -------------------------------------------------------------------------- */

/* Each frame has only one of two sensors, alternately or at random, or none. */
static void sensors_missing_from_frames_do_no_harm(void **state)
{
    (void)state;
    double error2 = 0.0;
    for (unsigned seed = 1; seed <= 20; seed++) {
        track_random_target_for_twelve_frames(seed);
        for (unsigned k = 12; k < 24; k++) {
            for (unsigned s = 0; s < 2; s++) {
                scene.look[scene_slot_of(k)][s].is_absent = uniform(0.0, 1.0) < 0.6;
            }
            fly_frame(k, 10.0);
            assert_int_equal(report.num_tracks, 1);
            assert_int_equal(report.tracks[0].misses, 0);
        }
        scene.look[scene_slot_of(24)][0].is_absent = scene.look[scene_slot_of(24)][1].is_absent = 0;
        fly_frame(24, 10.0);
        assert_int_equal(report.tracks[0].track_id, 1);
        assert_int_equal(tracker.counters.tracks_started, 1);
        error2 += pow(track_error_m(&report.tracks[0], &scene.target[0], 240.0), 2.0);
    }
    print_message("frames that miss a sensor: rms %.0f m after them\n", sqrt(error2 / 20.0));
    assert_true(sqrt(error2 / 20.0) < 400.0);
}

/*
 * 100 s with sensor 0 alone, then both again: the track goes on, and its covariance covers its
 * error.
 */
static void bearings_of_one_sensor_keep_a_track(void **state)
{
    (void)state;
    double share2 = 0.0, growth = 0.0;
    for (unsigned seed = 1; seed <= 20; seed++) {
        track_random_target_for_twelve_frames(seed);
        double sigma_m = (double)report.tracks[0].sigma_m;
        for (unsigned k = 12; k < 22; k++) {
            scene.look[scene_slot_of(k)][1].is_absent = 1;
            fly_frame(k, 10.0);
            assert_int_equal(report.num_tracks, 1);
            assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
        }
        assert_true((double)report.tracks[0].sigma_m > 1.2 * sigma_m);
        growth += (double)report.tracks[0].sigma_m / sigma_m / 20.0;
        share2 += pow(track_error_m(&report.tracks[0], &scene.target[0], 210.0) /
                          (double)report.tracks[0].sigma_m,
                      2.0);
        for (unsigned k = 22; k < 24; k++) {
            scene.look[scene_slot_of(k)][1].is_absent = 0;
            fly_frame(k, 10.0);
        }
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.tracks[0].track_id, 1);
        assert_int_equal(report.tracks[0].hits, 2 * 24 - 10);
        assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 2);
        assert_true(track_error_m(&report.tracks[0], &scene.target[0], 230.0) <
                    5.0 * (double)report.tracks[0].sigma_m);
    }
    print_message("one sensor alone: sigma grows to %.1f, squared error %.2f of the variance\n",
                  growth, share2 / 20.0);
    assert_true(growth > 2.0);
    assert_true(share2 / 20.0 < 4.0); /* NEES over two axes */
}

/* ---- coverage of sensors --------------------------------------------------------------------- */

/* Sixteen frames without bearings; is_seen: the sensors looked at the target. */
static void expect_misses_if_seen(int is_seen)
{
    const float score_nat = report.tracks[0].score_nat;
    for (unsigned k = 12; k < 28; k++) {
        scene.targets = 0;
        see_frame(k, 10.0 * k);
        /* the sectors look west, the target is in the east */
        for (unsigned s = 0; s < 2 && !is_seen; s++) {
            full.scans[s].sector_from_rad = 2.5f;
            full.scans[s].sector_to_rad = -2.5f;
        }
        step_frame(&full.frame);
    }
    assert_int_equal(report.num_tracks, is_seen ? 0 : 1);
    if (!is_seen) {
        assert_int_equal(report.tracks[0].misses, 0);
        assert_int_equal(report.tracks[0].status, RHO_TRACK_CONFIRMED);
        assert_float_equal(report.tracks[0].score_nat, score_nat, 0.0);
    }
}

static void no_miss_is_counted_where_no_sensor_looked(void **state)
{
    (void)state;
    track_random_target_for_twelve_frames(5);
    expect_misses_if_seen(1);
    track_random_target_for_twelve_frames(5);
    expect_misses_if_seen(0);
}

/* Describes a sensor in the tracker's table; its place is still taken from the scan. */
static void describe_sensor(int32_t sensor_id, float range_max_m, float sector_from_rad,
                            float sector_to_rad)
{
    const struct rho_sensor sensor = {.sensor_id = sensor_id,
                                      .x_m = 9e5f,
                                      .pd = 0.9f,
                                      .range_max_m = range_max_m,
                                      .sector_from_rad = sector_from_rad,
                                      .sector_to_rad = sector_to_rad};
    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

static void miss_frames_and_expect(unsigned first, unsigned count, unsigned num_tracks)
{
    for (unsigned k = first; k < first + count; k++) {
        step_frame_without_targets(k);
    }
    assert_int_equal(report.num_tracks, num_tracks);
    if (num_tracks) {
        assert_int_equal(report.tracks[0].misses, 0);
    }
}

/* A target that no sensor can see is not missed; it coasts for the time of five frames. */
static void misses_count_within_a_sensors_coverage_only(void **state)
{
    (void)state;
    for (int32_t sensor_id = 10; sensor_id <= 11; sensor_id++) {
        track_random_target_for_twelve_frames(5);
        describe_sensor(10, 1000.0f, 0.0f, 0.0f);
        describe_sensor(11, 1000.0f, 0.0f, 0.0f);
        miss_frames_and_expect(12, 4, 1);
        miss_frames_and_expect(16, 8, 0);
        track_random_target_for_twelve_frames(5);
        describe_sensor(10, 2e5f, 2.5f, -2.5f);
        describe_sensor(11, 2e5f, 2.5f, -2.5f);
        miss_frames_and_expect(12, 4, 1);
        describe_sensor(sensor_id, 2e5f, 0.0f,
                        0.0f); /* one sensor that covers the target is enough */
        const float score_nat = report.tracks[0].score_nat;
        step_frame_without_targets(16);
        assert_int_equal(report.tracks[0].misses, 1);
        assert_true(report.tracks[0].score_nat < score_nat);
    }
}

/* A sensor that is not in the table has the range of the passive initiation. */
static void undescribed_sensors_have_the_range_of_the_initiation(void **state)
{
    (void)state;
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    config.range_max_m = 1500.0f;
    track_random_target_for_twelve_frames(5);
    assert_int_equal(rho_passive_init(&passive, sizeof passive, &config), RHO_OK);
    miss_frames_and_expect(12, 12, 1);
}

/* ---- bearings that are mixed ----------------------------------------------------------------- */

/* Probabilistic data association of these bearings of sensor 0; returns ln of the weights' sum. */
static double ekf_mix(struct ekf *ekf, const struct rho_bearing *bearings, int count, double pd,
                      double false_per_rad)
{
    const double x_m = ekf->x[0] - scene.sensor_x_m[0], y_m = ekf->x[1] - scene.sensor_y_m[0];
    const double range2 = x_m * x_m + y_m * y_m, row[2] = {-y_m / range2, x_m / range2};
    const double noise = pow((double)bearings[0].sigma_rad, 2.0);
    double ph[4], variance = noise, sum = 1.0 - pd, mean = 0.0, square = 0.0;
    for (int i = 0; i < 4; i++) {
        ph[i] = ekf->p[i][0] * row[0] + ekf->p[i][1] * row[1];
    }
    variance += row[0] * ph[0] + row[1] * ph[1];
    for (int i = 0; i < count; i++) {
        const double off = remainder((double)bearings[i].bearing_rad - atan2(y_m, x_m), 2.0 * PI);
        const double weight =
            pd * exp(-0.5 * off * off / variance) / sqrt(2.0 * PI * variance) / false_per_rad;
        sum += weight;
        mean += weight * off;
        square += weight * off * off;
    }
    const double hit = 1.0 - (1.0 - pd) / sum;
    mean /= sum;
    square /= sum;
    for (int i = 0; i < 4; i++) {
        ekf->x[i] += ph[i] / variance * mean;
        for (int j = 0; j < 4; j++) {
            ekf->p[i][j] += ph[i] * ph[j] / variance * ((square - mean * mean) / variance - hit);
        }
    }
    return log(sum);
}

/*
 * Two bearings in the gate, and the case that both are false: the estimate takes the mean of all
 * three, and the covariance is wider by how far they are apart.
 */
static void mixed_bearings_update_as_pda_does(void **state)
{
    static const int at[4] = {0, 1, 3, 4};
    static const double off_sigmas[3][2] = {{0.4, -1.6}, {1.6, 1.2}, {-0.2, 2.1}};
    (void)state;
    gate_of_tracks = RHO_TRACKER_NEAREST; /* its filter is the EKF's */
    for (int i = 0; i < 3; i++) {
        static struct rho_bearing bearings[2];
        track_random_target_for_twelve_frames(3);
        tracker.config.learn_pd_min = 1.0f;
        tracker.sensors[0].unclaimed_bearings = 500.0f; /* over the field of view */
        struct ekf ekf = ekf_from_track(&report.tracks[0]);
        const double score_nat = (double)report.tracks[0].score_nat;
        ekf_predict(&ekf, 10.0, 6.25);
        see_frame(12, 120.0);
        const double x_m = ekf.x[0] - scene.sensor_x_m[0], y_m = ekf.x[1] - scene.sensor_y_m[0];
        for (int k = 0; k < 2; k++) {
            bearings[k] = (struct rho_bearing){
                .bearing_rad = (float)(atan2(y_m, x_m) + 0.004 * off_sigmas[i][k]),
                .sigma_rad = 0.004f};
        }
        full.frame.num_scans = 1;
        full.scans[0].num_bearings = 2;
        full.scans[0].bearings = bearings;
        step_frame(&full.frame);
        const struct ekf before = ekf;
        const double view_rad = (double)passive.config.field_of_view_rad;
        const double gain_nat = ekf_mix(&ekf, bearings, 2, 0.9, 500.0 / view_rad);
        assert_int_equal(report.num_tracks, 1);
        assert_float_equal(report.tracks[0].score_nat - score_nat, gain_nat, 0.01);
        for (int row = 0; row < 4; row++) {
            const double sigma = sqrt(before.p[row][row]);
            assert_float_equal(report.tracks[0].state[at[row]], ekf.x[row], 0.01 * sigma);
            for (int column = 0; column <= row; column++) {
                assert_float_equal(report.tracks[0].covariance[RHO_AT(at[row], at[column])],
                                   ekf.p[row][column],
                                   0.01 * sigma * sqrt(before.p[column][column]));
            }
        }
        /* the update is no small one beside these bounds */
        assert_true(fabs(ekf.x[1] - before.x[1]) > 0.05 * sqrt(before.p[1][1]));
        assert_true(fabs(ekf.p[1][1] / before.p[1][1] - 1.0) > 0.05);
        print_message("moved by %.3f sigmas, variance %.3f\n",
                      (ekf.x[1] - before.x[1]) / sqrt(before.p[1][1]),
                      ekf.p[1][1] / before.p[1][1]);
    }
    gate_of_tracks = RHO_TRACKER_BEST;
}

/* ---- bearings' own times --------------------------------------------------------------------- */

/* The bearing of the target from the scan's sensor at the scan's time + offset_s. */
static struct rho_bearing bearing_of_target_at(const struct rho_bearing_scan *scan, double offset_s)
{
    double time_s = (double)scan->time_us * 1e-6 + offset_s;
    double dx_m = target_x_m(&scene.target[0], time_s) - (double)scan->x_m;
    double dy_m = target_y_m(&scene.target[0], time_s) - (double)scan->y_m;
    double bearing_rad = remainder(atan2(dy_m, dx_m) + 0.1 * DEG_RAD * normal(), 2.0 * PI);
    return (struct rho_bearing){.offset_us = (int32_t)lrint(offset_s * 1e6),
                                .bearing_rad = (float)bearing_rad,
                                .sigma_rad = (float)(0.1 * DEG_RAD)};
}

/*
 * Steps a frame whose scans are off the frame's time and whose bearings are off their scan's time.
 */
static void step_bearings_of_own_times(unsigned k, const double scan_s[2], const double offset_s[2],
                                       struct ekf *ekf)
{
    static struct rho_bearing bearings[2];
    double at_s = 10.0 * k - 10.0 + (k > 12 ? scan_s[1] : 0.0); /* of the last step's report */
    see_frame(k, 10.0 * k);
    for (unsigned s = 0; s < 2; s++) {
        full.scans[s].time_us += (int64_t)llround(scan_s[s] * 1e6);
        bearings[s] = bearing_of_target_at(&full.scans[s], offset_s[s]);
        full.scans[s].num_bearings = 1;
        full.scans[s].bearings = &bearings[s];
    }
    step_frame(&full.frame);
    for (unsigned s = 0; s < 2; s++) {
        double own_s = 10.0 * k + scan_s[s] + offset_s[s];
        ekf_predict(ekf, own_s - at_s, 6.25);
        ekf_update(ekf, (double)full.scans[s].x_m, (double)full.scans[s].y_m, &bearings[s]);
        at_s = own_s;
    }
    ekf_predict(ekf, 1e-6 * (double)report.time_us - at_s, 6.25);
}

/* Sums of the error along the course, and of squared errors. */
struct bias {
    double along_m, error2, ekf_error2;
    unsigned rows;
};

static void follow_with_time_offsets(const double scan_s[2], const double offset_s[2],
                                     struct bias *bias)
{
    const struct target *target = &scene.target[0];
    track_random_target_for_twelve_frames(1 + bias->rows);
    struct ekf ekf = ekf_from_track(&report.tracks[0]);
    for (unsigned k = 12; k < 24; k++) {
        step_bearings_of_own_times(k, scan_s, offset_s, &ekf);
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 2);
        const struct rho_track_report *track = &report.tracks[0];
        const double at_s = 1e-6 * (double)report.time_us;
        double speed_mps = hypot(target->vx_mps, target->vy_mps);
        bias->along_m += (((double)track->state[0] - target_x_m(target, at_s)) * target->vx_mps +
                          ((double)track->state[1] - target_y_m(target, at_s)) * target->vy_mps) /
                         speed_mps;
        bias->error2 += pow(track_error_m(track, target, at_s), 2.0);
        bias->ekf_error2 += pow(ekf_error_m(&ekf, target, at_s), 2.0);
        bias->rows++;
    }
}

static void expect_no_bias(double scan_0_s, double scan_1_s, double offset_0_s, double offset_1_s)
{
    const double scan_s[2] = {scan_0_s, scan_1_s}, offset_s[2] = {offset_0_s, offset_1_s};
    struct bias bias = {0};
    for (unsigned run = 0; run < 15; run++) {
        follow_with_time_offsets(scan_s, offset_s, &bias);
    }
    double along_m = bias.along_m / bias.rows, ratio = sqrt(bias.error2 / bias.ekf_error2);
    print_message("scans %.1f and %.1f s, bearings %.1f and %.1f s late: %.0f m along the way, rms "
                  "%.0f m, %.4f of the filter's\n",
                  scan_0_s, scan_1_s, offset_0_s, offset_1_s, along_m,
                  sqrt(bias.error2 / bias.rows), ratio);
    assert_true(fabs(along_m) < 60.0); /* of 1000 m that the target flies in 4 s */
    assert_true(ratio > 0.97 && ratio < 1.05);
}

static void bearings_update_at_their_own_times(void **state)
{
    (void)state;
    gate_of_tracks = RHO_TRACKER_NEAREST; /* the EKF beside it has the same model */
    expect_no_bias(0.0, 0.0, 4.0, 4.0);
    expect_no_bias(0.0, 0.0, -3.0, -4.0);
    expect_no_bias(0.0, 0.0, 3.0, -4.0);
    expect_no_bias(2.0, 3.0, 1.5, 1.0);
    gate_of_tracks = RHO_TRACKER_BEST;
}

/* ---- start thresholds ------------------------------------------------------------------------ */

/*
 * One target whose bearings of eight degrees are hardly better than chance, until a track starts,
 * for `frames` at most; returns the number of frames stepped.
 */
static unsigned fly_until_start_at_false_track_rate(float false_tracks_per_hour, unsigned frames)
{
    unsigned k = 0;
    struct rho_passive_config config;
    random_state = 5;
    scene = scene_of(2, 1, 8.0, 1.0, 0.0);
    start_chain(5.0f);
    rho_passive_config_default(&config);
    config.false_tracks_per_hour = false_tracks_per_hour;
    assert_int_equal(rho_passive_init(&passive, sizeof passive, &config), RHO_OK);
    scene.target[0] = (struct target){.x_m = 20e3, .y_m = 2e3, .vx_mps = -20.0, .vy_mps = 150.0};
    while (k < frames && tracker.counters.tracks_started == 0) {
        fly_frame(k++, 10.0);
    }
    return k;
}

static void the_start_threshold_follows_the_false_track_rate(void **state)
{
    (void)state;
    const unsigned frames = fly_until_start_at_false_track_rate(1e5f, BATCH);
    assert_int_equal(tracker.counters.tracks_started, 1);
    int32_t often_mnat = passive.start_mnat, score_mnat = passive.tracks[0].score_mnat;
    assert_int_equal(fly_until_start_at_false_track_rate(1e-5f, frames), frames);
    assert_int_equal(tracker.counters.tracks_started, 0);
    assert_int_equal(passive.num_tracks, 1); /* a candidate was found, but it started no track */
    assert_int_equal(passive.tracks[0].score_mnat, score_mnat);
    /* the threshold grows by ln(1 / rate) */
    assert_in_range(passive.start_mnat - often_mnat, 23026 - 3, 23026 + 3);
    assert_true(often_mnat <= score_mnat && score_mnat < passive.start_mnat);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targets_that_cross_at_one_sensor_keep_their_identities),
        cmocka_unit_test(full_scans_are_half_a_miss),
        cmocka_unit_test(looks_without_its_bearings_end_a_track),
        cmocka_unit_test(a_bearing_restarts_the_misses_in_a_row_of_a_track),
        cmocka_unit_test(a_miss_of_one_sensor_leaves_the_estimate),
        cmocka_unit_test(sensors_missing_from_frames_do_no_harm),
        cmocka_unit_test(bearings_of_one_sensor_keep_a_track),
        cmocka_unit_test(no_miss_is_counted_where_no_sensor_looked),
        cmocka_unit_test(misses_count_within_a_sensors_coverage_only),
        cmocka_unit_test(undescribed_sensors_have_the_range_of_the_initiation),
        cmocka_unit_test(mixed_bearings_update_as_pda_does),
        cmocka_unit_test(bearings_update_at_their_own_times),
        cmocka_unit_test(the_start_threshold_follows_the_false_track_rate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
