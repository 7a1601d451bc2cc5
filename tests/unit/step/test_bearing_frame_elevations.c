/* SPDX-License-Identifier: MIT */
/*
 * Frames of bearings with elevations: heights of tracks that they start and of a radar's, climbing
 * targets, bearings of other heights, hostile elevations; snapshots.
 */
#include "bearing_frame_chain.h"
#include "rhotrack/snapshot.h"

#define RADAR_X_M (-5000.0)

static struct rho_initiator initiator;
static struct rho_tracker tracker_then;
static struct rho_passive passive_then;
static struct rho_report report_then;

/* A filter that new tracks get. */
static const struct kind {
    const char *name;
    uint8_t gate, has_inputs;
} kinds[3] = {{"nearest", RHO_TRACKER_NEAREST, 0},
              {"best", RHO_TRACKER_BEST, 0},
              {"inputs", RHO_TRACKER_NEAREST, 1}};

static void start_with(const struct kind *kind)
{
    start_chain(5.0f);
    struct rho_tracker_config config = tracker.config;
    config.gate = kind->gate;
    config.input.is_estimated = kind->has_inputs;
    config.input.model = RHO_INPUT_PHYSICAL;
    config.input.sigma_mps2 = 5.0f;
    config.input.noise_density = 1.0f;
    config.input.noise_m = config.input.noise_mps = 0.0f;
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
}

static void measure_elevations(double sigma_deg)
{
    for (unsigned s = 0; s < scene.sensors; s++) {
        scene.sigma_elevation_rad[s] = sigma_deg * DEG_RAD;
    }
}

static int has_height(const struct rho_track_report *track)
{
    return track->covariance[RHO_AT(2, 2)] > 0.0f;
}

/* Errors of height and climb of a track, and their normalised square. */
static double nees_of_height(const struct rho_track_report *track, double time_s, double off[2])
{
    const double zz = (double)track->covariance[RHO_AT(2, 2)],
                 vz = (double)track->covariance[RHO_AT(5, 2)],
                 vv = (double)track->covariance[RHO_AT(5, 5)];
    off[0] = (double)track->state[2] - height_z_m(&scene.height[0], time_s);
    off[1] = (double)track->state[5] - scene.height[0].vz_mps;
    return (off[0] * off[0] * vv - 2.0 * off[0] * off[1] * vz + off[1] * off[1] * zz) /
           (zz * vv - vz * vz);
}

/* ---- tracks that bearings start -------------------------------------------------------------- */

static void draw_climbing_target(unsigned seed, unsigned sensors, double climb_mps)
{
    random_state = seed;
    scene = scene_of(sensors, 1, 0.1, 1.0, 0.0);
    measure_elevations(0.1);
    scene.sensor_z_m[0] = 700.0;
    scene.target[0] = random_target(200.0);
    scene.height[0] = (struct height){5000.0, climb_mps};
}

static void fly_climbing_targets(const struct kind *kind, double climb_mps)
{
    double nees = 0.0, z2 = 0.0, climb = 0.0, variance = 0.0;
    const unsigned runs = 60;
    for (unsigned seed = 1; seed <= runs; seed++) {
        double off[2];
        draw_climbing_target(seed, 2, climb_mps);
        start_with(kind);
        for (unsigned k = 0; k < 20; k++) {
            fly_frame(k, 10.0);
            if (report.num_tracks > 0) {
                assert_int_equal(report.num_tracks, 1);
                assert_true(has_height(&report.tracks[0]));
                assert_true(nees_of_height(&report.tracks[0], 10.0 * k, off) < 25.0);
            }
        }
        assert_int_equal(report.num_tracks, 1);
        assert_int_equal(tracker.counters.tracks_started, 1);
        assert_true(report.tracks[0].hits >= 19);
        nees += nees_of_height(&report.tracks[0], 190.0, off) / runs;
        z2 += off[0] * off[0] / runs;
        climb += (double)report.tracks[0].state[5] / runs;
        variance += (double)report.tracks[0].covariance[RHO_AT(2, 2)] / runs;
    }
    print_message("%s, climb %.0f m/s: height rms %.0f m, sigma %.0f m, climb %.1f m/s, "
                  "NEES %.2f\n",
                  kind->name, climb_mps, sqrt(z2), sqrt(variance), climb, nees);
    assert_true(nees > 0.5 && nees < 2.0);
    assert_true(z2 < 1.4 * variance);
    assert_true(fabs(climb - climb_mps) < 1.5);
}

static void tracks_report_heights_within_their_sigmas(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        fly_climbing_targets(&kinds[i], 0.0);
        fly_climbing_targets(&kinds[i], 20.0);
        fly_climbing_targets(&kinds[i], -20.0);
    }
}

static void without_elevations_tracks_have_no_height(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        draw_climbing_target(3, 2, 5.0);
        measure_elevations(0.0);
        start_with(&kinds[i]);
        fly_frames(0, 15, 10.0);
        assert_int_equal(report.num_tracks, 1);
        assert_false(has_height(&report.tracks[0]));
        assert_true(report.tracks[0].state[2] == 0.0f && report.tracks[0].state[5] == 0.0f);
    }
}

/* The elevations begin when the track is old: its first one opens the height. */
static void a_level_track_gains_a_height(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned seed = 1; seed <= 20; seed++) {
            double off[2];
            draw_climbing_target(seed, 3, 0.0);
            measure_elevations(0.0);
            start_with(&kinds[i]);
            fly_frames(0, 12, 10.0);
            assert_int_equal(report.num_tracks, 1);
            const uint32_t track_id = report.tracks[0].track_id;
            measure_elevations(0.1);
            fly_frame(12, 10.0);
            assert_true(has_height(&report.tracks[0]));
            fly_frames(13, 20, 10.0);
            assert_int_equal(report.num_tracks, 1);
            assert_int_equal(report.tracks[0].track_id, track_id);
            assert_true(nees_of_height(&report.tracks[0], 190.0, off) < 25.0);
            assert_true(fabs(off[0]) < 400.0);
        }
    }
}

/* ---- a radar and a camera -------------------------------------------------------------------- */

/* The radar's plot has no height. */
static void step_radar_scan(double time_s)
{
    const double x_m = target_x_m(&scene.target[0], time_s),
                 y_m = target_y_m(&scene.target[0], time_s);
    const struct rho_plot plot = {.x_m = (float)(x_m + 60.0 * normal()),
                                  .y_m = (float)(y_m + 60.0 * normal()),
                                  .sigma_range_m = 60.0f,
                                  .sigma_cross_m = 60.0f};
    const struct rho_scan scan = {
        .time_us = llround(time_s * 1e6), .sensor_id = 1, .num_plots = 1, .plots = &plot};
    memset(&report, 0xee, sizeof report);
    assert_int_equal(rho_tracker_step(&tracker, &initiator, &scan, &report), RHO_OK);
    check_report();
}

static void start_radar(const struct kind *kind)
{
    struct rho_initiator_config config;
    const struct rho_sensor radar = {
        .sensor_id = 1, .x_m = (float)RADAR_X_M, .pd = 0.9f, .range_max_m = 150e3f};
    rho_initiator_config_default(&config);
    config.v_max_mps = 450.0f;
    start_with(kind);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &config), RHO_OK);
    assert_int_equal(rho_tracker_set_sensor(&tracker, &radar), RHO_OK);
}

/* A track of the radar after ten scans. */
static void start_track_of_radar(const struct kind *kind, unsigned seed, double climb_mps)
{
    draw_climbing_target(seed, 1, climb_mps);
    start_radar(kind);
    for (unsigned k = 0; k < 10; k++) {
        step_radar_scan(10.0 * k);
    }
    assert_int_equal(report.num_tracks, 1);
    assert_false(has_height(&report.tracks[0]));
}

static void a_radars_track_gains_a_height_from_a_camera(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        double nees = 0.0, z2 = 0.0, variance = 0.0;
        const unsigned runs = 40;
        unsigned claimed = 0;
        for (unsigned seed = 1; seed <= runs; seed++) {
            const double climb_mps = seed % 3 * 10.0 - 10.0;
            double off[2];
            start_track_of_radar(&kinds[i], seed, climb_mps);
            const uint32_t track_id = report.tracks[0].track_id;
            for (unsigned k = 10; k < 22; k++) {
                step_radar_scan(10.0 * k);
                see_frame(k, 10.0 * k + 4.0);
                step_frame(&full.frame);
                assert_int_equal(report.num_tracks, 1);
                claimed += report.fates_total[RHO_FATE_CLAIMED];
                assert_true(has_height(&report.tracks[0]));
                assert_true(nees_of_height(&report.tracks[0], 10.0 * k + 4.0, off) < 25.0);
            }
            assert_int_equal(report.tracks[0].track_id, track_id);
            nees += nees_of_height(&report.tracks[0], 214.0, off) / runs;
            z2 += off[0] * off[0] / runs;
            variance += (double)report.tracks[0].covariance[RHO_AT(2, 2)] / runs;
        }
        print_message("%s: a radar's track: height rms %.0f m, sigma %.0f m, NEES %.2f\n",
                      kinds[i].name, sqrt(z2), sqrt(variance), nees);
        assert_true(nees < 3.0 && z2 < 1.5 * variance);
        assert_in_range(claimed, 12 * runs - 3, 12 * runs); /* a few are outside the gate */
    }
}

/* ---- bearings of other heights --------------------------------------------------------------- */

/*
 * Steps with one bearing of the camera: the right one, or one of a wrong elevation, and with the
 * right azimuth. Returns its fate.
 */
static uint8_t fate_of_bearing(unsigned k, double time_s, double elevation_off_rad)
{
    see_frame(k, time_s);
    struct look *look = &scene.look[scene_slot_of(k)][0];
    assert_int_equal(look->count, 1);
    look->bearings[0].elevation_rad += (float)elevation_off_rad;
    fill_frame(&scene, scene_slot_of(k), &full);
    step_frame(&full.frame);
    return report.fates[0];
}

static void a_bearing_of_another_height_is_not_claimed(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        for (unsigned seed = 1; seed <= 10; seed++) {
            start_track_of_radar(&kinds[i], seed, 0.0);
            for (unsigned k = 10; k < 20; k++) {
                step_radar_scan(10.0 * k);
                assert_int_equal(fate_of_bearing(k, 10.0 * k + 4.0, 0.0), RHO_FATE_CLAIMED);
            }
            const float z_m = report.tracks[0].state[2];
            assert_int_not_equal(fate_of_bearing(20, 198.0, 0.15), RHO_FATE_CLAIMED);
            assert_float_equal(report.tracks[0].state[2], z_m, 100.0);
            assert_int_not_equal(fate_of_bearing(21, 199.0, -0.15), RHO_FATE_CLAIMED);
            assert_float_equal(report.tracks[0].state[2], z_m, 100.0);
            assert_int_equal(fate_of_bearing(22, 200.0, 0.0), RHO_FATE_CLAIMED);
        }
    }
}

/* A false bearing of the same azimuth beside the right one: the right one is claimed. */
static void of_two_bearings_that_of_the_right_height_is_claimed(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        unsigned right = 0, looks = 0;
        for (unsigned seed = 1; seed <= 10; seed++) {
            start_track_of_radar(&kinds[i], seed, 0.0);
            for (unsigned k = 10; k < 24; k++) {
                const double time_s = 10.0 * k + 4.0;
                step_radar_scan(10.0 * k);
                see_frame(k, time_s);
                struct look *look = &scene.look[scene_slot_of(k)][0];
                if (k >= 18) {
                    const struct rho_bearing real = look->bearings[0];
                    const unsigned at = k % 2;
                    look->count = 2;
                    look->bearings[0] = look->bearings[1] = real;
                    look->bearings[1 - at].elevation_rad += seed % 2 ? 0.1f : -0.1f;
                    fill_frame(&scene, scene_slot_of(k), &full);
                    step_frame(&full.frame);
                    assert_int_not_equal(report.fates[1 - at], RHO_FATE_CLAIMED);
                    right += report.fates[at] == RHO_FATE_CLAIMED;
                    looks++;
                } else {
                    step_frame(&full.frame);
                }
            }
        }
        print_message("%s: %u of %u right bearings claimed\n", kinds[i].name, right, looks);
        assert_true(right >= looks - 1);
    }
}

/* Both bearings are in the gate: the elevations alone tell which one is nearer. */
static void of_two_bearings_in_the_gate_that_of_the_likelier_height_is_claimed(void **state)
{
    (void)state;
    unsigned right = 0, looks = 0;
    for (unsigned seed = 1; seed <= 20; seed++) {
        start_track_of_radar(&kinds[0], seed, 0.0);
        for (unsigned k = 10; k < 24; k++) {
            step_radar_scan(10.0 * k);
            see_frame(k, 10.0 * k + 4.0);
            struct look *look = &scene.look[scene_slot_of(k)][0];
            const unsigned at = k % 2;
            if (k >= 18) {
                const double range_m = hypot(target_x_m(&scene.target[0], 10.0 * k + 4.0),
                                             target_y_m(&scene.target[0], 10.0 * k + 4.0) + 10e3);
                look->count = 2;
                look->bearings[1] = look->bearings[0];
                look->bearings[at].elevation_rad = (float)atan2(5000.0 - 700.0, range_m);
                look->bearings[1 - at].elevation_rad =
                    look->bearings[at].elevation_rad + 2.5f * (float)scene.sigma_elevation_rad[0];
                fill_frame(&scene, scene_slot_of(k), &full);
            }
            step_frame(&full.frame);
            right += k >= 18 && report.fates[at] == RHO_FATE_CLAIMED;
            looks += k >= 18;
        }
    }
    print_message("%u of %u likelier bearings claimed\n", right, looks);
    assert_true(right >= looks * 7 / 10);
}

/* Two targets at one place of the plane, three kilometres apart in height, each with its track. */
static void bearings_go_to_the_track_of_their_height(void **state)
{
    (void)state;
    for (unsigned seed = 1; seed <= 10; seed++) {
        random_state = seed;
        scene = scene_of(3, 2, 0.1, 1.0, 0.0);
        measure_elevations(0.1);
        /* apart when they start, and above one another at 150 s */
        scene.target[0] = (struct target){50e3, -8e3, -150.0, 80.0};
        scene.target[1] = (struct target){50e3, 16e3, -150.0, -80.0};
        scene.height[0] = (struct height){3000.0, 0.0};
        scene.height[1] = (struct height){6000.0, 0.0};
        start_chain(5.0f);
        fly_frames(0, 25, 10.0);
        assert_int_equal(report.num_tracks, 2);
        assert_int_equal(tracker.counters.tracks_started, 2);
        for (unsigned i = 0; i < 2; i++) {
            const struct rho_track_report *track = track_nearest_to(&scene.target[i], 240.0);
            assert_non_null(track);
            assert_float_equal(track->state[2], scene.height[i].z_m, 500.0);
        }
    }
}

/* ---- snapshots, hostile elevations ----------------------------------------------------------- */

static void copy_objects(void)
{
    tracker_then = tracker;
    passive_then = passive;
    report_then = report;
}

static void a_snapshot_continues_with_the_same_heights(void **state)
{
    static uint8_t image[sizeof tracker + sizeof passive + 4096];
    const struct rho_snapshot_part parts[2] = {{RHO_SNAPSHOT_TRACKER, 0, &tracker, sizeof tracker},
                                               {RHO_SNAPSHOT_PASSIVE, 0, &passive, sizeof passive}};
    size_t size = 0;
    (void)state;
    for (unsigned i = 0; i < 3; i++) {
        draw_climbing_target(5, 3, 10.0);
        start_with(&kinds[i]);
        fly_frames(0, 12, 10.0);
        assert_int_equal(rho_snapshot_save(parts, 2, 0, image, sizeof image, &size), RHO_OK);
        const struct scene scene_then = scene;
        const uint64_t random_then = random_state;
        fly_frames(12, 20, 10.0);
        assert_true(has_height(&report.tracks[0]));
        copy_objects();
        memset(&tracker, 0, sizeof tracker);
        memset(&passive, 0, sizeof passive);
        assert_int_equal(rho_snapshot_load(parts, 2, image, size), RHO_OK);
        scene = scene_then;
        random_state = random_then;
        fly_frames(12, 20, 10.0);
        assert_memory_equal(&report, &report_then, sizeof report);
        assert_memory_equal(&tracker, &tracker_then, sizeof tracker);
        assert_memory_equal(&passive, &passive_then, sizeof passive);
    }
}

/* Bearings whose elevation is invalid get no track, and the others are taken. */
static void bearings_with_invalid_elevations_are_refused(void **state)
{
    const float bad[][2] = {{NAN, 0.01f},  {0.1f, NAN},       {0.1f, -0.01f}, {1.6f, 0.01f},
                            {0.1f, 1e30f}, {INFINITY, 0.01f}, {0.1f, 1e-7f}};
    (void)state;
    draw_climbing_target(6, 2, 0.0);
    start_with(&kinds[0]);
    fly_frames(0, 10, 10.0);
    assert_int_equal(report.num_tracks, 1);
    for (unsigned k = 10; k < 17; k++) {
        see_frame(k, 10.0 * k);
        struct look *look = &scene.look[scene_slot_of(k)][0];
        look->bearings[0].elevation_rad = bad[k - 10][0];
        look->bearings[0].sigma_elevation_rad = bad[k - 10][1];
        fill_frame(&scene, scene_slot_of(k), &full);
        step_frame(&full.frame);
        assert_int_equal(report.fates[0], RHO_FATE_INVALID);
        assert_int_equal(report.fates[1], RHO_FATE_CLAIMED);
    }
}

static void hostile_elevations_keep_the_tracker_sound(void **state)
{
    (void)state;
    for (unsigned run = 0; run < 12; run++) {
        unsigned claimed = 0;
        draw_climbing_target(40 + run, 3, 10.0);
        scene.false_bearings = 1.0;
        start_with(&kinds[run % 3]);
        for (unsigned k = 0; k < 60; k++) {
            see_frame(k, 3.0 * k);
            for (unsigned s = 0; s < 3; s++) {
                struct look *look = &scene.look[scene_slot_of(k)][s];
                for (unsigned i = 0; i < look->count; i++) {
                    if (uniform(0.0, 1.0) < 0.2) {
                        look->bearings[i].elevation_rad = float_or_any(-1.6, 1.6, 0.3);
                        look->bearings[i].sigma_elevation_rad = float_or_any(0.0, 0.6, 0.3);
                    }
                }
                full.scans[s].z_m =
                    uniform(0.0, 1.0) < 0.9 ? full.scans[s].z_m : (float)uniform(-3e3, 3e3);
            }
            step_frame(&full.frame);
            claimed += report.fates_total[RHO_FATE_CLAIMED];
            assert_true(rho_passive_is_sound(&passive));
        }
        assert_true(claimed > 100); /* of 180 of the target */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tracks_report_heights_within_their_sigmas),
        cmocka_unit_test(without_elevations_tracks_have_no_height),
        cmocka_unit_test(a_level_track_gains_a_height),
        cmocka_unit_test(a_radars_track_gains_a_height_from_a_camera),
        cmocka_unit_test(a_bearing_of_another_height_is_not_claimed),
        cmocka_unit_test(of_two_bearings_that_of_the_right_height_is_claimed),
        cmocka_unit_test(of_two_bearings_in_the_gate_that_of_the_likelier_height_is_claimed),
        cmocka_unit_test(bearings_go_to_the_track_of_their_height),
        cmocka_unit_test(a_snapshot_continues_with_the_same_heights),
        cmocka_unit_test(bearings_with_invalid_elevations_are_refused),
        cmocka_unit_test(hostile_elevations_keep_the_tracker_sound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
