/* SPDX-License-Identifier: MIT */
/*
 * The tracker on polar plots: a radar that turns counter-clockwise from +x on, once in four
 * seconds, sees targets at plots' own times. Truth is straight and in double precision.
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

/* At time 0. */
struct target {
    double x_m, y_m, z_m, vx_mps, vy_mps;
};

/* The tracker's whole world, so that a test can go back to it. */
struct world {
    struct rho_tracker tracker;
    struct rho_initiator initiator;
};

static struct world world, other_world;
static struct rho_report report, other_report;
static struct rho_plot plots[PLOTS_MAX];
static struct rho_sensor radar; /* that looks, as it is described to the tracker */
static uint32_t num_plots, measures, seed;
static uint8_t gate_used;  /* enum rho_tracker_gate; the default's unless a test says otherwise */
static int garbage = 0xee; /* what reports hold before */
static double sigma_range_m, sigma_azimuth_rad, sigma_rate_mps;
static double noise;        /* 1: errors as the sigmas say; 0: none */
static double scan_after_s; /* a scan's time after the beginning of its turn */

/* ---- the radar ------------------------------------------------------------------------------- */

static double uniform(double from, double to)
{
    seed = seed * 1664525u + 1013904223u;
    return from + (to - from) * (double)(seed >> 8) / 16777216.0;
}

/* Variance 1. */
static double error(void)
{
    return noise * uniform(-1.7320508, 1.7320508);
}

static struct target at(const struct target *target, double t_s)
{
    struct target moved = *target;
    moved.x_m += target->vx_mps * t_s;
    moved.y_m += target->vy_mps * t_s;
    return moved;
}

/* When the antenna meets the target in the turn that begins at t_s, in whole microseconds. */
static double meeting_s(const struct target *target, double t_s)
{
    double offset_s = 0.0;
    for (int i = 0; i < 8; i++) {
        struct target then = at(target, t_s + offset_s);
        double turned = atan2(then.y_m - radar.y_m, then.x_m - radar.x_m) / TURN_RAD;
        offset_s = TURN_S * (turned - floor(turned));
    }
    return nearbyint(offset_s * 1e6) * 1e-6;
}

/* Adds the plot of a target in turn k. Without heights the target is level with the radar. */
static void see(const struct target *target, int k)
{
    double met_s = meeting_s(target, TURN_S * k);
    struct target then = at(target, TURN_S * k + met_s);
    double dx_m = then.x_m - radar.x_m, dy_m = then.y_m - radar.y_m;
    double dz_m = (measures & RHO_MEASURES_Z) ? then.z_m - radar.z_m : 0.0;
    double range_m = sqrt(dx_m * dx_m + dy_m * dy_m + dz_m * dz_m);
    double rate_mps = (dx_m * then.vx_mps + dy_m * then.vy_mps) / range_m;
    struct rho_polar_plot polar = {
        .offset_us = (int32_t)lround((met_s - scan_after_s) * 1e6),
        .range_m = (float)(range_m + sigma_range_m * error()),
        .azimuth_rad = (float)remainder(atan2(dy_m, dx_m) + sigma_azimuth_rad * error(), TURN_RAD),
        .elevation_rad = (float)(asin(dz_m / range_m) + sigma_azimuth_rad * error()),
        .range_rate_mps = (float)(rate_mps + sigma_rate_mps * error()),
        .sigma_range_m = (float)sigma_range_m,
        .sigma_azimuth_rad = (float)sigma_azimuth_rad,
        .sigma_elevation_rad = (float)sigma_azimuth_rad,
        .sigma_range_rate_mps = (float)sigma_rate_mps,
    };
    assert_int_equal(rho_measurement_from_polar(&polar, measures, &radar, &plots[num_plots++]),
                     RHO_OK);
}

/* Moves the last plot along the radar's line of sight and, counter-clockwise, across it. */
static void shift(double along_m, double across_m)
{
    struct rho_plot *plot = &plots[num_plots - 1];
    double dx_m = plot->x_m - radar.x_m, dy_m = plot->y_m - radar.y_m, range_m = hypot(dx_m, dy_m);
    plot->x_m += (float)((along_m * dx_m - across_m * dy_m) / range_m);
    plot->y_m += (float)((along_m * dy_m + across_m * dx_m) / range_m);
}

static void check_sums(void)
{
    uint32_t sum = 0, counted = 0;
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        sum += report.fates_total[fate];
        counted += world.tracker.counters.fates[fate];
    }
    assert_int_equal(sum, report.num_plots);
    assert_int_equal(counted, world.tracker.counters.plots_in);
}

static double scan_s(int k)
{
    return TURN_S * k + scan_after_s;
}

static void take(int k, float sector_from_rad, float sector_to_rad)
{
    struct rho_scan scan = {.time_us = llround(scan_s(k) * 1e6),
                            .sensor_id = radar.sensor_id,
                            .measures = measures,
                            .sector_from_rad = sector_from_rad,
                            .sector_to_rad = sector_to_rad,
                            .num_plots = num_plots,
                            .plots = plots};
    memset(&report, garbage, sizeof report);
    assert_int_equal(rho_tracker_step(&world.tracker, &world.initiator, &scan, &report), RHO_OK);
    assert_int_equal(report.num_plots, num_plots);
    check_sums();
    num_plots = 0;
}

static void turn(int k)
{
    take(k, 0.0f, 0.0f);
}

static void describe(void)
{
    assert_int_equal(rho_tracker_set_sensor(&world.tracker, &radar), RHO_OK);
}

static void fly(const struct target *target, int from, int to)
{
    for (int k = from; k < to; k++) {
        see(target, k);
        turn(k);
    }
}

/* 15 m, 3 mrad, 1 m/s, without errors; tracks start with four plots of five turns. */
static void start(uint32_t measured)
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
    describe();
}

static const struct rho_track_report *the_track(void)
{
    assert_int_equal(report.num_tracks, 1);
    return &report.tracks[0];
}

static long score_mnat(void)
{
    return lround(1000.0 * (double)the_track()->score_nat);
}

/* ---- estimates ------------------------------------------------------------------------------- */

/* Squared error of the position in the metric of the reported covariance. */
static double normalised_error2(const struct target *target, int k)
{
    const struct rho_track_report *track = the_track();
    struct target truth = at(target, scan_s(k));
    double dx_m = track->state[0] - truth.x_m, dy_m = track->state[1] - truth.y_m;
    const float *p = track->covariance;
    double xx = p[RHO_AT(0, 0)], xy = p[RHO_AT(1, 0)], yy = p[RHO_AT(1, 1)];
    return (yy * dx_m * dx_m - 2.0 * xy * dx_m * dy_m + xx * dy_m * dy_m) / (xx * yy - xy * xy);
}

/* The line of sight to the track, in space where heights are measured. */
static void line_of_sight(double u[3])
{
    const struct rho_track_report *track = the_track();
    double x_m = track->state[0], y_m = track->state[1], z_m = track->state[2];
    double range_m = sqrt(x_m * x_m + y_m * y_m + z_m * z_m);
    u[0] = x_m / range_m;
    u[1] = y_m / range_m;
    u[2] = z_m / range_m;
}

/* Variance of the velocity along the line of sight. */
static double radial_variance(void)
{
    double u[3], sum = 0.0;
    line_of_sight(u);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            sum += u[i] * u[j] * the_track()->covariance[RHO_AT(i + 3, j + 3)];
        }
    }
    return sum;
}

static void check_estimate(const struct target *target, int k)
{
    const struct rho_track_report *track = the_track();
    double u[3];
    line_of_sight(u);
    double radial_mps = u[0] * (track->state[3] - target->vx_mps) +
                        u[1] * (track->state[4] - target->vy_mps) + u[2] * track->state[5];
    assert_int_equal(track->status, RHO_TRACK_CONFIRMED);
    assert_int_equal(track->plot, 0);
    assert_int_equal(track->hits, k + 1);
    assert_true(normalised_error2(target, k) < 13.8); /* 99.9 % */
    assert_true(fabs(radial_mps) < 4.0 * sqrt(radial_variance()));
    if (measures & RHO_MEASURES_Z) {
        assert_true(fabs(track->state[2] - target->z_m) <
                    4.0 * sqrt(track->covariance[RHO_AT(2, 2)]));
    }
}

/*
 * The mean of a chi-square over two is 1; the tracker allows for manoeuvres that do not happen,
 * hence less.
 */
static double follow(uint32_t measured, enum rho_tracker_gate gate)
{
    const struct target target = {20000.0, -9000.0, 6000.0, -120.0, 110.0};
    double sum = 0.0;
    gate_used = (uint8_t)gate;
    start(measured);
    gate_used = RHO_TRACKER_BEST;
    noise = 1.0;
    for (int k = 0; k < 40; k++) {
        see(&target, k);
        turn(k);
        if (k >= 5) {
            check_estimate(&target, k);
            sum += normalised_error2(&target, k) / 2.0 / 35.0;
        }
    }
    assert_int_equal(world.tracker.counters.tracks_started, 1);
    assert_int_equal(world.tracker.counters.plots_initiated, 4);
    print_message("normalised error^2: %.2f\n", sum);
    assert_true(sum < 1.5);
    return radial_variance();
}

/*
 * Variances along the line of sight. A plot's own is 1; the line of sight turns a little from the
 * plot's time to the scan's. White acceleration of half accel_max cannot tell a range's rate from
 * places as well as that, by far: 22 and 1.1 m^2/s^2. Hypotheses find that the target is calm, and
 * 40 places tell nearly as much: 1.2 and 0.34.
 */
static void polar_plots_are_tracked_with_and_without_range_rate(void **state)
{
    const uint32_t heights[] = {0, RHO_MEASURES_Z};
    (void)state;
    for (int i = 0; i < 2; i++) {
        for (int gate = 0; gate < RHO_NUM_TRACKER_GATES; gate++) {
            double without = follow(heights[i], (enum rho_tracker_gate)gate);
            double with = follow(heights[i] | RHO_MEASURES_RANGE_RATE, (enum rho_tracker_gate)gate);
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
    const struct rho_track_report *track = the_track();
    struct target truth = at(target, scan_s(k));
    assert_float_equal(track->state[0], truth.x_m, 1.0);
    assert_float_equal(track->state[1], truth.y_m, 1.0);
    assert_float_equal(track->state[3], truth.vx_mps, 0.5);
    assert_float_equal(track->state[4], truth.vy_mps, 0.5);
}

/* Early and late in the turn: the plots' own times are 0.2 s and 3.9 s after its beginning. */
static const struct target early = {30000.0, 9000.0, 0.0, 200.0, 150.0},
                           late = {30000.0, -5000.0, 0.0, 250.0, -160.0};

static void the_state_is_reported_at_the_scans_time(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        const struct target *target = i % 2 ? &late : &early;
        start(0);
        sigma_azimuth_rad = 1e-4; /* conversion and filter are then as good as linear */
        scan_after_s = i / 2 ? TURN_S : 0.0;
        for (int k = 0; k < 12; k++) {
            see(target, k);
            assert_true(i % 2 ? plots[0].offset_us + 1e6 * scan_after_s > 3.8e6
                              : plots[0].offset_us + 1e6 * scan_after_s < 0.3e6);
            int32_t before_us = -plots[0].offset_us;
            turn(k);
            if (k >= 4) {
                check_state(target, k);
                assert_int_equal(the_track()->update_age_us, before_us > 0 ? before_us : 0);
                assert_int_equal(report.time_us, llround(1e6 * scan_s(k)));
            }
        }
    }
}

/* Also in the scan that starts the track, and in those without a plot. */
static void a_late_plot_counts_its_age_from_its_own_time(void **state)
{
    (void)state;
    start(0);
    sigma_azimuth_rad = 1e-4;
    fly(&late, 0, 4);
    check_state(&late, 3);
    fly(&late, 4, 8);
    int32_t last_us = (int32_t)lround(1e6 * (7.0 * TURN_S + meeting_s(&late, 7.0 * TURN_S)));
    for (int k = 8; k < 10; k++) {
        turn(k);
        check_state(&late, k);
        assert_int_equal(the_track()->misses, k - 7);
        assert_int_equal(the_track()->update_age_us, (int32_t)(4000000 * k) - last_us);
    }
}

/* ---- where the sensor looked ----------------------------------------------------------------- */

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
    /* the scan's sector, both ways round */
    {2.2f, 2.5f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 1},
    {2.5f, 2.2f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 0},
    {-3.0f, 2.2f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 0},
    {2.2f, -3.0f, 0.0f, 0.0f, 0.0f, 1e5f, 0.0f, 1},
    /* the sensor's own */
    {0.0f, 0.0f, 2.2f, 2.5f, 0.0f, 1e5f, 0.0f, 1},
    {0.0f, 0.0f, 2.5f, 2.2f, 0.0f, 1e5f, 0.0f, 0},
    /* one of them is not enough */
    {2.2f, 2.5f, 2.5f, 2.2f, 0.0f, 1e5f, 0.0f, 0},
    {2.5f, 2.2f, 2.2f, 2.5f, 0.0f, 1e5f, 0.0f, 0},
    /* ranges */
    {0.0f, 0.0f, 0.0f, 0.0f, 27e3f, 30e3f, 0.0f, 1},
    {0.0f, 0.0f, 0.0f, 0.0f, 30e3f, 1e5f, 0.0f, 0},
    {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 27e3f, 0.0f, 0},
    /* all of it about the sensor's place */
    {1.4f, 1.7f, 1.4f, 1.7f, 0.0f, 27e3f, -20e3f, 1},
    {2.2f, 2.5f, 0.0f, 0.0f, 0.0f, 1e5f, -20e3f, 0},
    {0.0f, 0.0f, 2.2f, 2.5f, 0.0f, 1e5f, -20e3f, 0},
    {0.0f, 0.0f, 0.0f, 0.0f, 27e3f, 1e5f, -20e3f, 0},
};

static void apply(const struct view *view)
{
    radar.sector_from_rad = view->from_rad;
    radar.sector_to_rad = view->to_rad;
    radar.range_min_m = view->range_min_m;
    radar.range_max_m = view->range_max_m;
    radar.x_m = view->x_m;
    describe();
}

static void misses_count_only_where_the_radar_looked(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof views / sizeof views[0]; i++) {
        start(0);
        fly(&hovering, 0, 6);
        long score = score_mnat();
        apply(&views[i]);
        for (int k = 6; k < 6 + 4; k++) {
            take(k, views[i].scan_from_rad, views[i].scan_to_rad);
            assert_int_equal(the_track()->misses, views[i].is_seen ? k - 5 : 0);
            assert_int_equal(the_track()->status, !views[i].is_seen ? RHO_TRACK_CONFIRMED
                                                  : k < 8           ? RHO_TRACK_COASTING
                                                                    : RHO_TRACK_TENTATIVE);
            assert_int_equal(score_mnat() < score, views[i].is_seen);
        }
        for (int k = 10; k < 20; k++) {
            take(k, views[i].scan_from_rad, views[i].scan_to_rad);
        }
        /* it waits for a scan that looks there while there may be one */
        const int is_covered =
            rho_measurement_covers(&radar, 0.0f, 0.0f, (float)hovering.x_m, (float)hovering.y_m);
        assert_int_equal(report.num_tracks, !views[i].is_seen && is_covered);
    }
}

/* ---- evidence -------------------------------------------------------------------------------- */

/*
 * What the score moves by when a sensor of the table, or a stranger, takes turn k; then everything
 * is as before.
 */
static long score_moves(int32_t sensor_id, const struct target *target, int k)
{
    long score = score_mnat();
    other_world = world;
    other_report = report;
    if (target != NULL) {
        see(target, k);
    }
    radar.sensor_id = sensor_id;
    turn(k);
    score = score_mnat() - score;
    world = other_world;
    report = other_report;
    radar.sensor_id = 1;
    return score;
}

/* Sensor 2, in the same place, sees less often. */
static void describe_weak(float pd)
{
    struct rho_sensor weak = radar;
    weak.sensor_id = 2;
    weak.pd = pd;
    assert_int_equal(rho_tracker_set_sensor(&world.tracker, &weak), RHO_OK);
}

/* 1000 ln(1 - pd), cut to whole thousandths. */
static void a_miss_costs_what_the_sensors_own_pd_says(void **state)
{
    (void)state;
    start(0);
    describe_weak(0.5f);
    fly(&early, 0, 6);
    assert_int_equal(score_moves(1, NULL, 6), -2302);
    assert_int_equal(score_moves(2, NULL, 6), -693);
    assert_int_equal(score_moves(3, NULL, 6), -1609); /* not in the table: the tracker's 0.8 */
    /* a hit of the weak one says less, by ln(0.5 / 0.9); both were cut to thousandths */
    assert_in_range(score_moves(1, &early, 6) - score_moves(2, &early, 6), 587, 589);
}

/*
 * A miss of the good sensor costs more than five of the weak one, whose scan looked at another
 * sector.
 */
static void a_weak_sensor_s_scan_does_not_end_what_a_good_one_missed_once(void **state)
{
    (void)state;
    start(0);
    describe_weak(0.3f);
    fly(&early, 0, 6);
    turn(6);
    assert_int_equal(the_track()->status, RHO_TRACK_COASTING);
    radar.sensor_id = 2;
    take(7, -2.0f, -1.0f);
    assert_int_equal(report.num_tracks, 1);
    turn(8); /* nor does one that looks there */
    assert_int_equal(report.num_tracks, 1);
}

static void add_clutter(int count)
{
    for (int i = 0; i < count; i++) {
        plots[num_plots++] = (struct rho_plot){.x_m = (float)uniform(-4e4, 4e4),
                                               .y_m = (float)uniform(-4e4, 4e4),
                                               .sigma_range_m = 15.0f,
                                               .sigma_cross_m = 90.0f};
    }
}

static void a_hit_says_less_where_the_sensor_has_more_clutter(void **state)
{
    const struct target *target = &early;
    (void)state;
    start(0);
    world.initiator.config.score_min_nat = 8.0f; /* no tracks of clutter */
    struct rho_sensor noisy = radar;
    noisy.sensor_id = 2;
    assert_int_equal(rho_tracker_set_sensor(&world.tracker, &noisy), RHO_OK);
    for (int k = 0; k < 20; k++) {
        see(target, k);
        add_clutter(k % 2 ? 40 : 1);
        radar.sensor_id = k % 2 ? 2 : 1;
        turn(k);
    }
    const float *place = the_track()->state;
    double quiet = rho_initiator_density(&world.initiator, 1, place[0], place[1]);
    double loud = rho_initiator_density(&world.initiator, 2, place[0], place[1]);
    /*
     * by hand: five turns hold 3 x 41 and 2 x 2 plots; with one turn like the mean, 25.4, beside
     * the sensor's own
     */
    assert_true(fabs(loud / quiet - ((3.0 * 41.0 + 25.4) / 4.0) / ((2.0 * 2.0 + 25.4) / 3.0)) <
                0.5);
    long gain = score_moves(1, target, 20) - score_moves(2, target, 20);
    assert_true(fabs((double)gain - 1000.0 * log(loud / quiet)) <= 2.0);
    /* clutter says nothing of misses */
    assert_int_equal(score_moves(1, NULL, 20), score_moves(2, NULL, 20));
}

/* ---- gates ----------------------------------------------------------------------------------- */

/* The fate of one plot in turn k; then everything is as before. */
static enum rho_fate fate_of(int k)
{
    other_world = world;
    other_report = report;
    turn(k);
    enum rho_fate fate = (enum rho_fate)report.fates[0];
    assert_int_equal(fate == RHO_FATE_CLAIMED, report.tracks[0].plot == 0);
    assert_int_equal(report.tracks[0].misses, fate == RHO_FATE_CLAIMED ? 0 : 1);
    world = other_world;
    report = other_report;
    return fate;
}

static enum rho_fate fate_off(const struct target *target, int k, double along_m, double across_m)
{
    see(target, k);
    shift(along_m, across_m);
    return fate_of(k);
}

/* 3 mrad are 94 m at 31 km. */
static void a_plot_off_across_is_claimed_and_off_along_is_not(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const struct target *target = i ? &late : &early;
        start(0);
        fly(target, 0, 12);
        for (double off_m = -200.0; off_m <= 200.0; off_m += 400.0) {
            assert_int_equal(fate_off(target, 12, 0.0, off_m), RHO_FATE_CLAIMED);
            assert_int_equal(fate_off(target, 12, off_m, 0.0), RHO_FATE_HELD);
        }
        assert_int_equal(fate_off(target, 12, 25.0, 0.0), RHO_FATE_CLAIMED);
        assert_int_equal(fate_off(target, 12, 0.0, 1500.0), RHO_FATE_HELD);
    }
}

/* Seen from where it is now: what was along is across. */
static void a_radar_that_moved_sees_along_its_new_line(void **state)
{
    const struct target target = {30000.0, 0.0, 0.0, 0.0, 5.0};
    (void)state;
    start(0);
    fly(&target, 0, 12);
    assert_int_equal(fate_off(&target, 12, 200.0, 0.0), RHO_FATE_HELD);
    radar.x_m = 30000.0f;
    radar.y_m = -30000.0f;
    describe();
    assert_int_equal(fate_off(&target, 12, 0.0, -200.0), RHO_FATE_CLAIMED); /* to +x, as before */
    assert_int_equal(fate_off(&target, 12, 0.0, 200.0), RHO_FATE_CLAIMED);
    see(&target, 12);
    turn(12);
    radar.y_m = -29000.0f;
    describe();
    assert_int_equal(fate_off(&target, 13, 600.0, 0.0), RHO_FATE_HELD);
}

/* A ship's radar: the window keeps from where each plot was seen. */
static void a_radar_that_moves_all_the_time_tracks(void **state)
{
    const struct target target = {15000.0, 12000.0, 0.0, 100.0, -80.0};
    (void)state;
    for (int i = 0; i < 2; i++) {
        start(i ? RHO_MEASURES_RANGE_RATE : 0u);
        for (int k = 0; k < 20; k++) {
            radar.x_m = 2500.0f * (float)k;
            radar.y_m = -800.0f * (float)k;
            describe();
            see(&target, k);
            turn(k);
            if (k >= 3) {
                struct target truth = at(&target, scan_s(k));
                assert_int_equal(the_track()->hits, k + 1);
                assert_float_equal(the_track()->state[0], truth.x_m, 3.0);
                assert_float_equal(the_track()->state[1], truth.y_m, 3.0);
            }
        }
    }
}

static enum rho_fate fate_of_rate(const struct target *target, int k, float off_mps)
{
    see(target, k);
    plots[0].range_rate_mps += off_mps;
    return fate_of(k);
}

static void a_wrong_range_rate_is_not_claimed(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const struct target *target = i ? &late : &early;
        start(RHO_MEASURES_RANGE_RATE);
        fly(target, 0, 12);
        assert_int_equal(fate_of_rate(target, 12, 0.0f), RHO_FATE_CLAIMED);
        assert_int_equal(fate_of_rate(target, 12, 3.0f), RHO_FATE_CLAIMED);
        assert_int_equal(fate_of_rate(target, 12, 60.0f), RHO_FATE_HELD);
        assert_int_equal(fate_of_rate(target, 12, -60.0f), RHO_FATE_HELD);
        measures = 0; /* a scan without range rates: whatever the field holds */
        assert_int_equal(fate_of_rate(target, 12, 60.0f), RHO_FATE_CLAIMED);
        assert_int_equal(fate_of_rate(target, 12, NAN), RHO_FATE_CLAIMED);
    }
}

/* ---- bad plots, same bytes ------------------------------------------------------------------- */

/* Fields of a plot, and what no radar measures. */
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
#define FIRST_OF_Z 4 /* and z_m and its sigma after it, then the range rate's two */

static int is_sigma(size_t field)
{
    return field == 2 || field == 3 || field == 5 || field == 7;
}

static const float bad_values[] = {NAN, INFINITY, -INFINITY, 3.0e6f, -3.0e6f, 0.0f, -1.0f};
#define NUM_NEVER 5 /* the first are bad for all fields, the others for sigmas */

static uint32_t add_bad_plots(size_t first, size_t last)
{
    struct rho_plot good = plots[0];
    for (size_t field = first; field <= last; field++) {
        size_t values = is_sigma(field) ? NUM_NEVER + 2 : NUM_NEVER;
        for (size_t i = 0; i < values; i++) {
            plots[num_plots] = good;
            memcpy((char *)&plots[num_plots++] + fields[field], &bad_values[i], sizeof(float));
        }
    }
    return num_plots - 1;
}

static void bad_plots_are_invalid_and_counted(void **state)
{
    (void)state;
    start(RHO_MEASURES_Z | RHO_MEASURES_RANGE_RATE);
    fly(&early, 0, 8);
    see(&early, 8);
    uint32_t bad = add_bad_plots(0, NUM_FIELDS - 1);
    assert_int_equal(bad, 48);
    turn(8);
    assert_int_equal(report.fates[0], RHO_FATE_CLAIMED);
    for (uint32_t i = 1; i <= bad; i++) {
        assert_int_equal(report.fates[i], RHO_FATE_INVALID);
    }
    assert_int_equal(report.fates_total[RHO_FATE_INVALID], bad);
    assert_int_equal(world.tracker.counters.fates[RHO_FATE_INVALID], bad);
    assert_int_equal(world.tracker.counters.plots_in, 9 + bad);
    assert_int_equal(the_track()->hits, 9);
    /* nor do they leave anything behind */
    assert_true(fabs(the_track()->state[0] - at(&early, scan_s(8)).x_m) < 5.0);
    fly(&early, 9, 12);
    assert_int_equal(the_track()->hits, 12);
}

static void what_is_not_measured_cannot_be_bad(void **state)
{
    (void)state;
    start(0);
    fly(&early, 0, 8);
    see(&early, 8);
    (void)add_bad_plots(FIRST_OF_Z, NUM_FIELDS - 1);
    turn(8);
    assert_int_equal(report.fates_total[RHO_FATE_INVALID], 0);
    assert_int_equal(report.fates_total[RHO_FATE_CLAIMED], 1);
}

/*
 * Sectors that look elsewhere, moves, clutter, targets that leave: 40 turns from whatever the
 * memory held.
 */
static void run_all(int before, struct rho_report reports[40])
{
    garbage = before;
    memset(&world, garbage, sizeof world);
    memset(plots, garbage, sizeof plots);
    start(RHO_MEASURES_RANGE_RATE);
    noise = 1.0;
    for (int k = 0; k < 40; k++) {
        radar.x_m = 100.0f * (float)k;
        describe();
        see(&early, k);
        if (k < 20) {
            see(&late, k);
        }
        for (int i = 0; i < 10; i++) {
            struct target clutter = {uniform(-4e4, 4e4), uniform(-4e4, 4e4), 0.0,
                                     uniform(-300.0, 300.0), uniform(-300.0, 300.0)};
            see(&clutter, 0);
        }
        take(k, k % 5 == 0 ? 1.0f : 0.0f, k % 5 == 0 ? 2.0f : 0.0f);
        reports[k] = report;
    }
}

static void the_same_scans_give_the_same_bytes(void **state)
{
    static struct rho_report once[40], again[40];
    (void)state;
    run_all(0x00, once);
    other_world = world;
    run_all(0x7f, again); /* floats of 3.4e38 */
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
        cmocka_unit_test(the_state_is_reported_at_the_scans_time),
        cmocka_unit_test(a_late_plot_counts_its_age_from_its_own_time),
        cmocka_unit_test(misses_count_only_where_the_radar_looked),
        cmocka_unit_test(a_miss_costs_what_the_sensors_own_pd_says),
        cmocka_unit_test(a_weak_sensor_s_scan_does_not_end_what_a_good_one_missed_once),
        cmocka_unit_test(a_hit_says_less_where_the_sensor_has_more_clutter),
        cmocka_unit_test(a_plot_off_across_is_claimed_and_off_along_is_not),
        cmocka_unit_test(a_radar_that_moved_sees_along_its_new_line),
        cmocka_unit_test(a_radar_that_moves_all_the_time_tracks),
        cmocka_unit_test(a_wrong_range_rate_is_not_claimed),
        cmocka_unit_test(bad_plots_are_invalid_and_counted),
        cmocka_unit_test(what_is_not_measured_cannot_be_bad),
        cmocka_unit_test(the_same_scans_give_the_same_bytes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
