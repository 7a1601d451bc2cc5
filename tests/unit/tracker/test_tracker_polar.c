/* SPDX-License-Identifier: MIT */
/*
 * The tracker on polar plots: a radar that turns counter-clockwise from +x once in four seconds
 * sees targets at plots' own times. Truth is straight and in double precision.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <string.h>

#include "rhotrack/detail/measurement.h"
#include "rhotrack/tracker.h"

#define TURN_S 4.0
#define TURN_RAD 6.283185307179586
#define PLOTS_MAX 64

/* A target's state at time 0. */
struct target {
    double x_m, y_m, z_m, vx_mps, vy_mps;
};

/* The tracker and its initiator, so that a test can restore both. */
struct world {
    struct rho_tracker tracker;
    struct rho_initiator initiator;
};

static struct world world, other_world;
static struct rho_report report, other_report;
static struct rho_plot plots[PLOTS_MAX];
static struct rho_sensor radar; /* the radar as it is described to the tracker */
static uint32_t num_plots, measures, seed;
static uint8_t gate_used;  /* enum rho_tracker_gate; the default unless a test changes it */
static int garbage = 0xee; /* byte that fills reports before a step */
static double sigma_range_m, sigma_azimuth_rad, sigma_rate_mps;
static double noise;        /* 1: errors as the sigmas say; 0: no errors */
static double scan_after_s; /* delay of a scan's time after the beginning of its turn */

/* ---- the simulated radar --------------------------------------------------------------------- */

static double uniform(double from, double to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (double)(seed >> 8) / 16777216.0;
}

/* A random error of variance 1, uniform. */
static double draw_uniform_error_of_variance_1(void)
{
    return noise * uniform(-1.7320508, 1.7320508);
}

static struct target target_moved_straight_to(const struct target *target, double t_s)
{
    struct target moved = *target;
    moved.x_m += target->vx_mps * t_s;
    moved.y_m += target->vy_mps * t_s;
    return moved;
}

/* When the antenna points at the target in the turn that begins at t_s, in whole microseconds. */
static double from_turn_start_to_target_s(const struct target *target, double t_s)
{
    double offset_s = 0.0;
    for (int i = 0; i < 8; i++) {
        struct target then = target_moved_straight_to(target, t_s + offset_s);
        double turned = atan2(then.y_m - radar.y_m, then.x_m - radar.x_m) / TURN_RAD;
        offset_s = TURN_S * (turned - floor(turned));
    }
    return nearbyint(offset_s * 1e6) * 1e-6;
}

/* Adds the plot of a target in turn k. Without heights the target is level with the radar. */
static void add_target_plot(const struct target *target, int k)
{
    double met_s = from_turn_start_to_target_s(target, TURN_S * k);
    struct target then = target_moved_straight_to(target, TURN_S * k + met_s);
    double dx_m = then.x_m - radar.x_m, dy_m = then.y_m - radar.y_m;
    double dz_m = (measures & RHO_MEASURES_Z) ? then.z_m - radar.z_m : 0.0;
    double range_m = sqrt(dx_m * dx_m + dy_m * dy_m + dz_m * dz_m);
    double rate_mps = (dx_m * then.vx_mps + dy_m * then.vy_mps) / range_m;
    struct rho_polar_plot polar = {
        .offset_us = (int32_t)lround((met_s - scan_after_s) * 1e6),
        .range_m = (float)(range_m + sigma_range_m * draw_uniform_error_of_variance_1()),
        .azimuth_rad = (float)remainder(
            atan2(dy_m, dx_m) + sigma_azimuth_rad * draw_uniform_error_of_variance_1(), TURN_RAD),
        .elevation_rad =
            (float)(asin(dz_m / range_m) + sigma_azimuth_rad * draw_uniform_error_of_variance_1()),
        .range_rate_mps = (float)(rate_mps + sigma_rate_mps * draw_uniform_error_of_variance_1()),
        .sigma_range_m = (float)sigma_range_m,
        .sigma_azimuth_rad = (float)sigma_azimuth_rad,
        .sigma_elevation_rad = (float)sigma_azimuth_rad,
        .sigma_range_rate_mps = (float)sigma_rate_mps,
    };
    assert_int_equal(rho_measurement_from_polar(&polar, measures, &radar, &plots[num_plots++]),
                     RHO_OK);
}

/* Moves the last plot along the radar's line of sight and, counter-clockwise, across it. */
static void shift_last_plot(double along_m, double across_m)
{
    struct rho_plot *plot = &plots[num_plots - 1];
    double dx_m = plot->x_m - radar.x_m, dy_m = plot->y_m - radar.y_m, range_m = hypot(dx_m, dy_m);
    plot->x_m += (float)((along_m * dx_m - across_m * dy_m) / range_m);
    plot->y_m += (float)((along_m * dy_m + across_m * dx_m) / range_m);
}

static void check_fate_sums(void)
{
    uint32_t sum = 0, counted = 0;
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        sum += report.fates_total[fate];
        counted += world.tracker.counters.fates[fate];
    }
    assert_int_equal(sum, report.num_plots);
    assert_int_equal(counted, world.tracker.counters.plots_in);
}

static double scan_time_s(int k)
{
    return TURN_S * k + scan_after_s;
}

static void step_sector(int k, float sector_from_rad, float sector_to_rad)
{
    struct rho_scan scan = {.time_us = llround(scan_time_s(k) * 1e6),
                            .sensor_id = radar.sensor_id,
                            .measures = measures,
                            .sector_from_rad = sector_from_rad,
                            .sector_to_rad = sector_to_rad,
                            .num_plots = num_plots,
                            .plots = plots};
    memset(&report, garbage, sizeof report);
    assert_int_equal(rho_tracker_step(&world.tracker, &world.initiator, &scan, &report), RHO_OK);
    assert_int_equal(report.num_plots, num_plots);
    check_fate_sums();
    num_plots = 0;
}

static void step_turn(int k)
{
    step_sector(k, 0.0f, 0.0f);
}

static void describe_radar(void)
{
    assert_int_equal(rho_tracker_set_sensor(&world.tracker, &radar), RHO_OK);
}

static void track_target(const struct target *target, int from, int to)
{
    for (int k = from; k < to; k++) {
        add_target_plot(target, k);
        step_turn(k);
    }
}

/* Sigmas 15 m, 3 mrad, 1 m/s, without errors; tracks start with four plots in five turns. */
static void start_tracker(uint32_t measured)
{
    struct rho_tracker_config maintain;
    struct rho_initiator_config initiate;
    rho_tracker_config_default(&maintain);
    rho_initiator_config_default(&initiate);
    maintain.pd = 0.8f;
    maintain.v_max_mps = initiate.v_max_mps = 400.0f;
    maintain.accel_max_mps2 = 5.0f;
    maintain.gate = gate_used;
    initiate.scans = 5;
    initiate.min_scans = 4;
    initiate.false_tracks_per_hour = 0.0f;
    assert_int_equal(rho_tracker_init(&world.tracker, sizeof world.tracker, &maintain), RHO_OK);
    assert_int_equal(rho_initiator_init(&world.initiator, sizeof world.initiator, &initiate),
                     RHO_OK);
    radar = (struct rho_sensor){.sensor_id = 1, .pd = 0.9f, .range_max_m = 1e5f};
    sigma_range_m = 15.0;
    sigma_azimuth_rad = 0.003;
    sigma_rate_mps = 1.0;
    noise = scan_after_s = 0.0;
    measures = measured;
    num_plots = 0;
    seed = 5;
    describe_radar();
}

static const struct rho_track_report *only_track(void)
{
    assert_int_equal(report.num_tracks, 1);
    return &report.tracks[0];
}

static long track_score_mnat(void)
{
    return lround(1000.0 * (double)only_track()->score_nat);
}

/* ---- estimates ------------------------------------------------------------------------------- */

/* Squared error of the position in the metric of the reported covariance. */
static double nees_of_place(const struct target *target, int k)
{
    const struct rho_track_report *track = only_track();
    struct target truth = target_moved_straight_to(target, scan_time_s(k));
    double dx_m = track->state[0] - truth.x_m, dy_m = track->state[1] - truth.y_m;
    const float *p = track->covariance;
    double xx = p[RHO_AT(0, 0)], xy = p[RHO_AT(1, 0)], yy = p[RHO_AT(1, 1)];
    return (yy * dx_m * dx_m - 2.0 * xy * dx_m * dy_m + xx * dy_m * dy_m) / (xx * yy - xy * xy);
}

/* Unit vector from the radar to the track, in space where heights are measured. */
static void line_of_sight_to_track(double u[3])
{
    const struct rho_track_report *track = only_track();
    double x_m = track->state[0], y_m = track->state[1], z_m = track->state[2];
    double range_m = sqrt(x_m * x_m + y_m * y_m + z_m * z_m);
    u[0] = x_m / range_m;
    u[1] = y_m / range_m;
    u[2] = z_m / range_m;
}

/* Variance of the velocity along the line of sight. */
static double radial_velocity_variance(void)
{
    double u[3], sum = 0.0;
    line_of_sight_to_track(u);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            sum += u[i] * u[j] * only_track()->covariance[RHO_AT(i + 3, j + 3)];
        }
    }
    return sum;
}

static void check_estimate_against_truth(const struct target *target, int k)
{
    const struct rho_track_report *track = only_track();
    double u[3];
    line_of_sight_to_track(u);
    double radial_mps = u[0] * (track->state[3] - target->vx_mps) +
                        u[1] * (track->state[4] - target->vy_mps) + u[2] * track->state[5];
    assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
    assert_int_equal(track->plot, 0);
    assert_int_equal(track->hits, k + 1);
    assert_true(nees_of_place(target, k) < 13.8); /* within 99.9 % */
    assert_true(fabs(radial_mps) < 4.0 * sqrt(radial_velocity_variance()));
    if (measures & RHO_MEASURES_Z) {
        assert_true(fabs(track->state[2] - target->z_m) <
                    4.0 * sqrt(track->covariance[RHO_AT(2, 2)]));
    }
}

/*
 * NEES over two dimensions averages 1; the tracker allows for manoeuvres that do not happen, so it
 * is lower.
 */
static double radial_velocity_variance_after_following(uint32_t measured,
                                                       enum rho_tracker_gate gate)
{
    const struct target target = {20000.0, -9000.0, 6000.0, -120.0, 110.0};
    double sum = 0.0;
    gate_used = (uint8_t)gate;
    start_tracker(measured);
    gate_used = RHO_TRACKER_BEST;
    noise = 1.0;
    for (int k = 0; k < 40; k++) {
        add_target_plot(&target, k);
        step_turn(k);
        if (k >= 5) {
            check_estimate_against_truth(&target, k);
            sum += nees_of_place(&target, k) / 2.0 / 35.0;
        }
    }
    assert_int_equal(world.tracker.counters.tracks_started, 1);
    assert_int_equal(world.tracker.counters.plots_initiated, 4);
    print_message("normalised error^2: %.2f\n", sum);
    assert_true(sum < 1.5);
    return radial_velocity_variance();
}

/*
 * Variances of the radial velocity. A plot's own is 1; the line of sight turns a little from the
 * plot's time to the scan's. White acceleration of half accel_max leaves 22 from places alone and
 * 1.1 m^2/s^2 with range rates. Hypotheses find that the target is calm, so 40 places give nearly
 * as much: 1.2 and 0.34.
 */
static void polar_plots_are_tracked_with_and_without_range_rate(void **state)
{
    const uint32_t heights[] = {0, RHO_MEASURES_Z};
    (void)state;
    for (int i = 0; i < 2; i++) {
        for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
            double without =
                radial_velocity_variance_after_following(heights[i], (enum rho_tracker_gate)gate);
            double with = radial_velocity_variance_after_following(
                heights[i] | RHO_MEASURES_RANGE_RATE, (enum rho_tracker_gate)gate);
            print_message("gate %d: along the line of sight: %.2f, %.2f m/s\n", gate, sqrt(without),
                          sqrt(with));
            assert_true(with < 1.5);
            assert_true(without > (gate == RHO_TRACKER_BEST ? 2.5 : 10.0) * with);
            assert_true(gate != RHO_TRACKER_BEST || without < 1.5);
        }
    }
}

static void check_state(const struct target *target, int k)
{
    const struct rho_track_report *track = only_track();
    struct target truth = target_moved_straight_to(target, scan_time_s(k));
    assert_float_equal(track->state[0], truth.x_m, 1.0);
    assert_float_equal(track->state[1], truth.y_m, 1.0);
    assert_float_equal(track->state[3], truth.vx_mps, 0.5);
    assert_float_equal(track->state[4], truth.vy_mps, 0.5);
}

/* Targets early and late in the turn: plots are 0.2 s and 3.9 s after its beginning. */
static const struct target early = {30000.0, 9000.0, 0.0, 200.0, 150.0},
                           late = {30000.0, -5000.0, 0.0, 250.0, -160.0};

static void states_are_reported_at_the_scans_time(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const struct target *target = i % 2 ? &late : &early;
        start_tracker(0);
        sigma_azimuth_rad = 1e-4; /* makes conversion and filter almost linear */
        scan_after_s = i / 2 ? TURN_S : 0.0;
        for (int k = 0; k < 12; k++) {
            add_target_plot(target, k);
            assert_true(i % 2 ? plots[0].offset_us + 1e6 * scan_after_s > 3.8e6
                              : plots[0].offset_us + 1e6 * scan_after_s < 0.3e6);
            int32_t before_us = -plots[0].offset_us;
            step_turn(k);
            if (k >= 4) {
                check_state(target, k);
                assert_int_equal(only_track()->update_age_us, before_us > 0 ? before_us : 0);
                assert_int_equal(report.time_us, llround(1e6 * scan_time_s(k)));
            }
        }
    }
}

/* Also in the scan that starts the track, and in scans without a plot. */
static void update_age_counts_from_the_plots_own_time(void **state)
{
    (void)state;
    start_tracker(0);
    sigma_azimuth_rad = 1e-4;
    track_target(&late, 0, 4);
    check_state(&late, 3);
    track_target(&late, 4, 8);
    int32_t last_us =
        (int32_t)lround(1e6 * (7.0 * TURN_S + from_turn_start_to_target_s(&late, 7.0 * TURN_S)));
    for (int k = 8; k < 10; k++) {
        step_turn(k);
        check_state(&late, k);
        assert_int_equal(only_track()->misses, k - 7);
        assert_int_equal(only_track()->update_age_us, (int32_t)(4000000 * k) - last_us);
    }
}

/* ---- coverage of the radar ------------------------------------------------------------------- */

/*
 * The target is at azimuth 2.36 rad and 28 km from the origin; at 1.57 rad and 20 km from (-20 km,
 * 0).
 */
static const struct target hovering = {-20000.0, 20000.0, 0.0, 0.0, 10.0};

struct view {
    float scan_from_rad, scan_to_rad, from_rad, to_rad, range_min_m, range_max_m, x_m;
    int is_seen;
};

static const struct view views[] = {
    {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 1},
    /* sectors of the scan, of either orientation */
    {2.2f, 2.5f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 1},
    {2.5f, 2.2f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 0},
    {-3.0f, 2.2f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 0},
    {2.2f, -3.0f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 1},
    /* sectors of the sensor's description */
    {0.0f, 0.0f, 2.2f, 2.5f, 0.0f, 1e5f, 0.0f, 1},
    {0.0f, 0.0f, 2.5f, 2.2f, 0.0f, 1e5f, 0.0f, 0},
    /* the target is outside one of the two sectors */
    {2.2f, 2.5f, 2.5f, 2.2f, 0.0f, 1e5f, 0.0f, 0},
    {2.5f, 2.2f, 2.2f, 2.5f, 0.0f, 1e5f, 0.0f, 0},
    /* limits of range */
    {0.0f, 0.0f, 0.0f, 0.0f, 27e3f, 30e3f, 0.0f, 1},
    {0.0f, 0.0f, 0.0f, 0.0f, 30e3f, 1e5f, 0.0f, 0},
    {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 27e3f, 0.0f, 0},
    /* all limits relative to the sensor's place */
    {1.4f, 1.7f, 1.4f, 1.7f, 0.0f, 27e3f, -20e3f, 1},
    {2.2f, 2.5f, 0.0f, 0.0f, 0.0f, 1e5f, -20e3f, 0},
    {0.0f, 0.0f, 2.2f, 2.5f, 0.0f, 1e5f, -20e3f, 0},
    {0.0f, 0.0f, 0.0f, 0.0f, 27e3f, 1e5f, -20e3f, 0},
};

static void apply_view(const struct view *view)
{
    radar.sector_from_rad = view->from_rad;
    radar.sector_to_rad = view->to_rad;
    radar.range_min_m = view->range_min_m;
    radar.range_max_m = view->range_max_m;
    radar.x_m = view->x_m;
    describe_radar();
}

static void misses_count_only_where_the_radar_looked(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof views / sizeof views[0]; i++) {
        start_tracker(0);
        world.tracker.config.learn_pd_min = 1.0f; /* P_D as told */
        track_target(&hovering, 0, 6);
        long score = track_score_mnat();
        apply_view(&views[i]);
        for (int k = 6; k < 6 + 4; k++) {
            step_sector(k, views[i].scan_from_rad, views[i].scan_to_rad);
            assert_int_equal(only_track()->misses, views[i].is_seen ? k - 5 : 0);
            assert_int_equal(only_track()->status == RHO_TRACK_CONFIRMED, !views[i].is_seen);
            assert_int_equal(track_score_mnat() < score, views[i].is_seen);
        }
        for (int k = 10; k < 26; k++) {
            step_sector(k, views[i].scan_from_rad, views[i].scan_to_rad);
        }
        /* a track that was not looked at is kept only while its place is in the radar's coverage */
        const int is_covered =
            rho_measurement_covers(&radar, 0.0f, 0.0f, (float)hovering.x_m, (float)hovering.y_m);
        assert_int_equal(report.num_tracks, !views[i].is_seen && is_covered);
    }
}

/* ---- evidence -------------------------------------------------------------------------------- */

/* Change of the score when a known or unknown sensor sees turn k; then everything is restored. */
static long score_change_of_scan(int32_t sensor_id, const struct target *target, int k)
{
    long score = track_score_mnat();
    other_world = world;
    other_report = report;
    if (target != NULL) {
        add_target_plot(target, k);
    }
    radar.sensor_id = sensor_id;
    step_turn(k);
    score = track_score_mnat() - score;
    world = other_world;
    report = other_report;
    radar.sensor_id = 1;
    return score;
}

/* Describes sensor 2 at the same place, with a lower P_D. */
static void describe_weak(float pd)
{
    struct rho_sensor weak = radar;
    weak.sensor_id = 2;
    weak.pd = pd;
    assert_int_equal(rho_tracker_set_sensor(&world.tracker, &weak), RHO_OK);
}

/* 1000 ln(1 - pd), truncated to whole thousandths. */
static void the_score_of_a_miss_follows_the_sensors_pd(void **state)
{
    (void)state;
    start_tracker(0);
    world.tracker.config.learn_pd_min = 1.0f; /* P_D as told */
    describe_weak(0.5f);
    track_target(&early, 0, 6);
    assert_int_equal(score_change_of_scan(1, NULL, 6), -2302);
    assert_int_equal(score_change_of_scan(2, NULL, 6), -693);
    /* sensor 3 is not in the table, so the tracker's P_D of 0.8 counts */
    assert_int_equal(score_change_of_scan(3, NULL, 6), -1609);
    /* a hit of the low-P_D sensor adds ln(0.5 / 0.9) less; both are truncated to thousandths */
    assert_in_range(score_change_of_scan(1, &early, 6) - score_change_of_scan(2, &early, 6), 587,
                    589);
}

/*
 * A miss of the good sensor costs more than five of the low-P_D one, whose scans cover another
 * sector.
 */
static void scans_of_a_low_pd_sensor_elsewhere_end_no_track(void **state)
{
    (void)state;
    start_tracker(0);
    describe_weak(0.3f);
    track_target(&early, 0, 6);
    step_turn(6);
    assert_int_equal(only_track()->status, RHO_TRACK_COASTING);
    radar.sensor_id = 2;
    step_sector(7, -2.0f, -1.0f);
    assert_int_equal(report.num_tracks, 1);
    step_turn(8); /* a scan that covers the target does not end it, either */
    assert_int_equal(report.num_tracks, 1);
}

static void add_clutter_plots(int count)
{
    for (int i = 0; i < count; i++) {
        plots[num_plots++] = (struct rho_plot){.x_m = (float)uniform(-4e4, 4e4),
                                               .y_m = (float)uniform(-4e4, 4e4),
                                               .sigma_range_m = 15.0f,
                                               .sigma_cross_m = 90.0f};
    }
}

static void hits_add_less_score_among_more_clutter(void **state)
{
    const struct target *target = &early;
    (void)state;
    start_tracker(0);
    world.tracker.config.learn_pd_min = 1.0f;    /* P_D as told */
    world.initiator.config.score_min_nat = 8.0f; /* prevents tracks of clutter */
    struct rho_sensor noisy = radar;
    noisy.sensor_id = 2;
    assert_int_equal(rho_tracker_set_sensor(&world.tracker, &noisy), RHO_OK);
    for (int k = 0; k < 20; k++) {
        add_target_plot(target, k);
        add_clutter_plots(k % 2 ? 40 : 1);
        radar.sensor_id = k % 2 ? 2 : 1;
        step_turn(k);
    }
    const float *place = only_track()->state;
    double quiet = rho_initiator_density(&world.initiator, 1, place[0], place[1]);
    double loud = rho_initiator_density(&world.initiator, 2, place[0], place[1]);
    /*
     * by formula: five turns hold 3 x 41 and 2 x 2 plots; one turn of the mean, 25.4, is added to
     * the sensor's own
     */
    assert_true(fabs(loud / quiet - ((3.0 * 41.0 + 25.4) / 4.0) / ((2.0 * 2.0 + 25.4) / 3.0)) <
                0.5);
    long gain = score_change_of_scan(1, target, 20) - score_change_of_scan(2, target, 20);
    assert_true(fabs((double)gain - 1000.0 * log(loud / quiet)) <= 2.0);
    /* clutter does not change the score of a miss */
    assert_int_equal(score_change_of_scan(1, NULL, 20), score_change_of_scan(2, NULL, 20));
}

/* ---- gates ----------------------------------------------------------------------------------- */

/* The fate of one plot in turn k; then everything is restored. */
static enum rho_fate fate_of_plot_in_turn(int k)
{
    other_world = world;
    other_report = report;
    step_turn(k);
    enum rho_fate fate = (enum rho_fate)report.fates[0];
    assert_int_equal(fate == RHO_FATE_CLAIMED, report.tracks[0].plot == 0);
    assert_int_equal(report.tracks[0].misses, fate == RHO_FATE_CLAIMED ? 0 : 1);
    world = other_world;
    report = other_report;
    return fate;
}

static enum rho_fate fate_of_plot_off(const struct target *target, int k, double along_m,
                                      double across_m)
{
    add_target_plot(target, k);
    shift_last_plot(along_m, across_m);
    return fate_of_plot_in_turn(k);
}

/* 3 mrad are 94 m across at 31 km. */
static void gates_are_wide_across_and_narrow_along_the_line_of_sight(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const struct target *target = i ? &late : &early;
        start_tracker(0);
        track_target(target, 0, 12);
        for (double off_m = -200.0; off_m <= 200.0; off_m += 400.0) {
            assert_int_equal(fate_of_plot_off(target, 12, 0.0, off_m), RHO_FATE_CLAIMED);
            assert_int_equal(fate_of_plot_off(target, 12, off_m, 0.0), RHO_FATE_HELD);
        }
        assert_int_equal(fate_of_plot_off(target, 12, 25.0, 0.0), RHO_FATE_CLAIMED);
        assert_int_equal(fate_of_plot_off(target, 12, 0.0, 1500.0), RHO_FATE_HELD);
    }
}

/* Seen from the radar's new place, along and across are exchanged. */
static void gates_turn_with_a_radar_that_moved(void **state)
{
    const struct target target = {30000.0, 0.0, 0.0, 0.0, 5.0};
    (void)state;
    start_tracker(0);
    track_target(&target, 0, 12);
    assert_int_equal(fate_of_plot_off(&target, 12, 200.0, 0.0), RHO_FATE_HELD);
    radar.x_m = 30000.0f;
    radar.y_m = -30000.0f;
    describe_radar();
    /* the sensor at +x still has its old line of sight */
    assert_int_equal(fate_of_plot_off(&target, 12, 0.0, -200.0), RHO_FATE_CLAIMED);
    assert_int_equal(fate_of_plot_off(&target, 12, 0.0, 200.0), RHO_FATE_CLAIMED);
    add_target_plot(&target, 12);
    step_turn(12);
    radar.y_m = -29000.0f;
    describe_radar();
    assert_int_equal(fate_of_plot_off(&target, 13, 600.0, 0.0), RHO_FATE_HELD);
}

/* A ship's radar: the window keeps from where each plot was seen. */
static void a_radar_on_a_moving_ship_tracks(void **state)
{
    const struct target target = {15000.0, 12000.0, 0.0, 100.0, -80.0};
    (void)state;
    for (int i = 0; i < 2; i++) {
        start_tracker(i ? RHO_MEASURES_RANGE_RATE : 0u);
        for (int k = 0; k < 20; k++) {
            radar.x_m = 2500.0f * (float)k;
            radar.y_m = -800.0f * (float)k;
            describe_radar();
            add_target_plot(&target, k);
            step_turn(k);
            if (k >= 3) {
                struct target truth = target_moved_straight_to(&target, scan_time_s(k));
                assert_int_equal(only_track()->hits, k + 1);
                assert_float_equal(only_track()->state[0], truth.x_m, 3.0);
                assert_float_equal(only_track()->state[1], truth.y_m, 3.0);
            }
        }
    }
}

static enum rho_fate fate_of_rate(const struct target *target, int k, float off_mps)
{
    add_target_plot(target, k);
    plots[0].range_rate_mps += off_mps;
    return fate_of_plot_in_turn(k);
}

static void plots_of_a_wrong_range_rate_are_not_claimed(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const struct target *target = i ? &late : &early;
        start_tracker(RHO_MEASURES_RANGE_RATE);
        track_target(target, 0, 12);
        assert_int_equal(fate_of_rate(target, 12, 0.0f), RHO_FATE_CLAIMED);
        assert_int_equal(fate_of_rate(target, 12, 3.0f), RHO_FATE_CLAIMED);
        assert_int_equal(fate_of_rate(target, 12, 60.0f), RHO_FATE_HELD);
        assert_int_equal(fate_of_rate(target, 12, -60.0f), RHO_FATE_HELD);
        measures = 0; /* a scan without range rates ignores the field */
        assert_int_equal(fate_of_rate(target, 12, 60.0f), RHO_FATE_CLAIMED);
        assert_int_equal(fate_of_rate(target, 12, NAN), RHO_FATE_CLAIMED);
    }
}

/* ---- bad plots, identical bytes -------------------------------------------------------------- */

/* Fields of a plot, and values that no radar measures. */
static const size_t fields[] = {
    offsetof(struct rho_plot, x_m),
    offsetof(struct rho_plot, y_m),
    offsetof(struct rho_plot, sigma_range_m),
    offsetof(struct rho_plot, sigma_cross_m),
    offsetof(struct rho_plot, z_m),
    offsetof(struct rho_plot, sigma_up_m),
    offsetof(struct rho_plot, range_rate_mps),
    offsetof(struct rho_plot, sigma_range_rate_mps),
};
#define NUM_FIELDS (sizeof fields / sizeof fields[0])
#define FIRST_OF_Z 4 /* from this field on: z_m and its sigma, then the range rate and its sigma */

static int is_field_sigma(size_t field)
{
    return field == 2 || field == 3 || field == 5 || field == 7;
}

static const float bad_values[] = {NAN, INFINITY, -INFINITY, 3.0e6f, -3.0e6f, 0.0f, -1.0f};
#define NUM_NEVER 5 /* the first values are bad for all fields, the others only for sigmas */

static uint32_t add_bad_plots(size_t first, size_t last)
{
    struct rho_plot good = plots[0];
    for (size_t field = first; field <= last; field++) {
        size_t values = is_field_sigma(field) ? NUM_NEVER + 2 : NUM_NEVER;
        for (size_t i = 0; i < values; i++) {
            plots[num_plots] = good;
            memcpy((char *)&plots[num_plots++] + fields[field], &bad_values[i], sizeof(float));
        }
    }
    return num_plots - 1;
}

static void plots_with_bad_numbers_are_invalid_and_counted(void **state)
{
    (void)state;
    start_tracker(RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE);
    track_target(&early, 0, 8);
    add_target_plot(&early, 8);
    uint32_t bad = add_bad_plots(0, NUM_FIELDS - 1);
    assert_int_equal(bad, 48);
    step_turn(8);
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
    for (uint32_t i = 1; i <= bad; i++) {
        assert_int_equal(report.fates[i], RHO_FATE_INVALID);
    }
    assert_int_equal(report.fates_total[RHO_FATE_INVALID], bad);
    assert_int_equal(world.tracker.counters.fates[RHO_FATE_INVALID], bad);
    assert_int_equal(world.tracker.counters.plots_in, 9 + bad);
    assert_int_equal(only_track()->hits, 9);
    /* bad plots change nothing in the tracker */
    assert_true(
        fabs(only_track()->state[0] - target_moved_straight_to(&early, scan_time_s(8)).x_m) < 5.0);
    track_target(&early, 9, 12);
    assert_int_equal(only_track()->hits, 12);
}

static void values_of_unmeasured_fields_do_not_make_a_plot_invalid(void **state)
{
    (void)state;
    start_tracker(0);
    track_target(&early, 0, 8);
    add_target_plot(&early, 8);
    (void)add_bad_plots(FIRST_OF_Z, NUM_FIELDS - 1);
    step_turn(8);
    assert_int_equal(report.fates_total[RHO_FATE_INVALID], 0);
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 1);
}

/*
 * Sectors that look elsewhere, moves, clutter, targets that leave: 40 turns, starting from memory
 * filled with any byte.
 */
static void run_forty_turns(int fill_byte, struct rho_report reports[40])
{
    garbage = fill_byte;
    memset(&world, garbage, sizeof world);
    memset(plots, garbage, sizeof plots);
    start_tracker(RHO_MEASURES_RANGE_RATE);
    noise = 1.0;
    for (int k = 0; k < 40; k++) {
        radar.x_m = 100.0f * (float)k;
        describe_radar();
        add_target_plot(&early, k);
        if (k < 20) {
            add_target_plot(&late, k);
        }
        for (int i = 0; i < 10; i++) {
            struct target clutter = {uniform(-4e4, 4e4), uniform(-4e4, 4e4), 0.0,
                                     uniform(-300.0, 300.0), uniform(-300.0, 300.0)};
            add_target_plot(&clutter, 0);
        }
        step_sector(k, k % 5 == 0 ? 1.0f : 0.0f, k % 5 == 0 ? 2.0f : 0.0f);
        reports[k] = report;
    }
}

static void the_same_scans_give_the_same_bytes(void **state)
{
    static struct rho_report once[40], again[40];
    (void)state;
    run_forty_turns(0x00, once);
    other_world = world;
    run_forty_turns(0x7f, again); /* 0x7f bytes are floats of 3.4e38 */
    assert_memory_equal(once, again, sizeof once);
    const struct rho_tracker *first = &other_world.tracker, *second = &world.tracker;
    assert_memory_equal(&first->counters, &second->counters, sizeof first->counters);
    assert_memory_equal(&first->unclaimed_plots, &second->unclaimed_plots, sizeof(float));
    assert_memory_equal(&first->extent, &second->extent, sizeof first->extent);
    assert_true(world.tracker.counters.tracks_confirmed >= 2);
    assert_true(world.tracker.counters.tracks_ended >= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polar_plots_are_tracked_with_and_without_range_rate),
        cmocka_unit_test(states_are_reported_at_the_scans_time),
        cmocka_unit_test(update_age_counts_from_the_plots_own_time),
        cmocka_unit_test(misses_count_only_where_the_radar_looked),
        cmocka_unit_test(the_score_of_a_miss_follows_the_sensors_pd),
        cmocka_unit_test(scans_of_a_low_pd_sensor_elsewhere_end_no_track),
        cmocka_unit_test(hits_add_less_score_among_more_clutter),
        cmocka_unit_test(gates_are_wide_across_and_narrow_along_the_line_of_sight),
        cmocka_unit_test(gates_turn_with_a_radar_that_moved),
        cmocka_unit_test(a_radar_on_a_moving_ship_tracks),
        cmocka_unit_test(plots_of_a_wrong_range_rate_are_not_claimed),
        cmocka_unit_test(plots_with_bad_numbers_are_invalid_and_counted),
        cmocka_unit_test(values_of_unmeasured_fields_do_not_make_a_plot_invalid),
        cmocka_unit_test(the_same_scans_give_the_same_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
