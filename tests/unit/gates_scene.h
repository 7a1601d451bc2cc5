/* SPDX-License-Identifier: MIT */
/*
 * Scenes for the tracker's gates: targets that fly straight or turn, clutter, misses; the tracker
 * with its initiator, and checks after every step. The truth is in double precision.
 */
#ifndef GATES_SCENE_H
#define GATES_SCENE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "rhotrack/tracker.h"

#define SCENE_TARGETS_MAX 40
#define SCENE_PLOTS_MAX 256

/*
 * A target's place, speed and course at time 0; between from_s and to_s it turns with pull_mps2, to
 * the left if positive.
 */
struct target {
    double x_m, y_m, z_m, speed_mps, course_rad, pull_mps2, from_s, to_s;
};

/* Targets, the sensor's noise and scans, and clutter. */
struct scene {
    struct target target[SCENE_TARGETS_MAX];
    unsigned num_targets;
    double interval_s, pd, sigma_m;
    double sigma_cross_m; /* 0: as sigma_m */
    /* of the antenna, whose azimuth gives plots their own times; 0: all plots at the scan's time */
    double turn_s;
    double clutter;     /* mean number of plots a scan, uniform in the area */
    double half_area_m; /* half the side of the area about the origin */
    uint32_t measures;
    int clean_scans; /* first scans, which have neither clutter nor misses */
    int num_sectors; /* each scan looks at the next of this many sectors; 0: all round */
};

static struct scene scene;
static struct rho_tracker_config config;
static struct rho_initiator_config initiation;
static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;
static struct rho_plot plots[SCENE_PLOTS_MAX];
static int targets_of[SCENE_PLOTS_MAX]; /* target of each plot; -1: clutter */
static uint32_t num_plots;
static uint64_t random_state;
static uint32_t ids_before[RHO_MAX_TRACKS]; /* tracks before the last step */
static unsigned num_before;

/* ---- random ---------------------------------------------------------------------------------- */

static inline double uniform(double from, double to)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return from + (to - from) * (double)(random_state >> 11) / 9007199254740992.0;
}

static inline double normal(void)
{
    double radius = sqrt(-2.0 * log(1.0 - uniform(0.0, 1.0)));
    return radius * cos(uniform(0.0, 6.283185307179586));
}

static inline unsigned poisson(double mean)
{
    double left = exp(-mean), product = uniform(0.0, 1.0);
    unsigned n = 0;
    for (; product > left; n++) {
        product *= uniform(0.0, 1.0);
    }
    return n;
}

/* ---- targets --------------------------------------------------------------------------------- */

/* The target's place and course at t_s: exact, on a circle while it turns. */
static inline struct target target_on_its_turning_path_at(const struct target *target, double t_s)
{
    struct target at = *target;
    double turn = target->pull_mps2 / target->speed_mps;
    double pulls_s = fmin(fmax(t_s - target->from_s, 0.0), target->to_s - target->from_s);
    double before_s = t_s < target->from_s ? t_s : target->from_s;
    double after_s = t_s > target->to_s ? t_s - target->to_s : 0.0;
    if (fabs(turn) < 1e-12) {
        before_s = t_s;
        pulls_s = after_s = 0.0;
    }
    at.x_m += target->speed_mps * cos(at.course_rad) * before_s;
    at.y_m += target->speed_mps * sin(at.course_rad) * before_s;
    if (pulls_s > 0.0) {
        double radius_m = target->speed_mps / turn;
        at.x_m += radius_m * (sin(at.course_rad + turn * pulls_s) - sin(at.course_rad));
        at.y_m -= radius_m * (cos(at.course_rad + turn * pulls_s) - cos(at.course_rad));
        at.course_rad += turn * pulls_s;
    }
    at.x_m += target->speed_mps * cos(at.course_rad) * after_s;
    at.y_m += target->speed_mps * sin(at.course_rad) * after_s;
    return at;
}

/* ---- plots ---------------------------------------------------------------------------------- */

static inline double own_time_s(const struct target *target, double t_s)
{
    double offset_s = 0.0;
    for (int i = 0; i < 8 && scene.turn_s > 0.0; i++) {
        struct target at = target_on_its_turning_path_at(target, t_s + offset_s);
        double turned = atan2(at.y_m, at.x_m) / 6.283185307179586;
        offset_s = scene.turn_s * (turned - floor(turned));
    }
    return nearbyint(offset_s * 1e6) * 1e-6;
}

/* Unit vectors along the line of sight to a place, across it and upwards; horizontal for z_m 0. */
static inline void line_of_sight(double x_m, double y_m, double z_m, double frame[3][3])
{
    double ground_m = fmax(hypot(x_m, y_m), 1e-6);
    double range_m = hypot(ground_m, z_m);
    double u[3][3] = {
        {x_m / range_m, y_m / range_m, z_m / range_m},
        {-y_m / ground_m, x_m / ground_m, 0.0},
        {-z_m * x_m / ground_m / range_m, -z_m * y_m / ground_m / range_m, ground_m / range_m}};
    memcpy(frame, u, sizeof u);
}

/* Adds a plot of a target, or of clutter (target -1), with noise. */
static inline void add_target_plot(const struct target *at, double offset_s, int target)
{
    double u[3][3], place_m[3] = {at->x_m, at->y_m, at->z_m};
    double velocity_mps[2] = {at->speed_mps * cos(at->course_rad),
                              at->speed_mps * sin(at->course_rad)};
    double sigma_m[3] = {scene.sigma_m,
                         scene.sigma_cross_m > 0.0 ? scene.sigma_cross_m : scene.sigma_m,
                         scene.sigma_m};
    if (num_plots == SCENE_PLOTS_MAX) {
        return;
    }
    line_of_sight(at->x_m, at->y_m, scene.measures & RHO_MEASURES_Z ? at->z_m : 0.0, u);
    for (int i = 0; i < 3; i++) {
        double error_m = sigma_m[i] * normal();
        for (int axis = 0; axis < 3; axis++) {
            place_m[axis] += u[i][axis] * error_m;
        }
    }
    double vx_mps = velocity_mps[0] + 5.0 * normal();
    double vy_mps = velocity_mps[1] + 5.0 * normal();
    double vz_mps = 5.0 * normal();
    double rate_mps = u[0][0] * velocity_mps[0] + u[0][1] * velocity_mps[1] + normal();
    targets_of[num_plots] = target;
    plots[num_plots++] = (struct rho_plot){
        .offset_us = (int32_t)lround(offset_s * 1e6),
        .x_m = (float)place_m[0],
        .y_m = (float)place_m[1],
        .z_m = (float)place_m[2],
        .vx_mps = (float)vx_mps,
        .vy_mps = (float)vy_mps,
        .vz_mps = (float)vz_mps,
        .range_rate_mps = (float)rate_mps,
        .sigma_range_m = (float)sigma_m[0],
        .sigma_cross_m = (float)sigma_m[1],
        .sigma_up_m = (float)sigma_m[2],
        .sigma_mps = 5.0f,
        .sigma_range_rate_mps = 1.0f,
    };
}

static inline void add_one_clutter_plot(void)
{
    struct target at = {0};
    at.x_m = uniform(-scene.half_area_m, scene.half_area_m);
    at.y_m = uniform(-scene.half_area_m, scene.half_area_m);
    at.z_m = uniform(0.0, 10000.0);
    at.speed_mps = uniform(0.0, 300.0);
    at.course_rad = uniform(-3.14159, 3.14159);
    add_target_plot(&at, uniform(0.0, scene.turn_s), -1);
}

/* Draws the plots of a scan: targets in their order, clutter at random among them. */
static inline void see_scan(int k, double t_s)
{
    num_plots = 0;
    unsigned clutter = k < scene.clean_scans ? 0 : poisson(scene.clutter);
    for (unsigned i = 0; i < scene.num_targets || clutter > 0;) {
        if (clutter > 0 && (i == scene.num_targets || uniform(0.0, 1.0) < 0.7)) {
            add_one_clutter_plot();
            clutter--;
            continue;
        }
        double offset_s = own_time_s(&scene.target[i], t_s);
        struct target at = target_on_its_turning_path_at(&scene.target[i], t_s + offset_s);
        if (uniform(0.0, 1.0) < scene.pd || k < scene.clean_scans) {
            add_target_plot(&at, offset_s, (int)i);
        }
        i++;
    }
}

/* Makes the scan one of sector k and removes the plots outside of it. */
static inline void keep_sector_plots(int k, struct rho_scan *scan)
{
    const double width_rad = 6.283185307179586 / scene.num_sectors;
    double from_rad = -3.141592653589793 + width_rad * (k % scene.num_sectors);
    uint32_t kept = 0;
    scan->sector_from_rad = (float)from_rad;
    scan->sector_to_rad = (float)(from_rad + width_rad);
    for (uint32_t i = 0; i < num_plots; i++) {
        double azimuth_rad = atan2(plots[i].y_m, plots[i].x_m);
        if (azimuth_rad >= from_rad && azimuth_rad < from_rad + width_rad) {
            targets_of[kept] = targets_of[i];
            plots[kept++] = plots[i];
        }
    }
    num_plots = kept;
}

/* ---- checks --------------------------------------------------------------------------------- */

static inline int track_was_there(const struct rho_track_report *track)
{
    for (unsigned i = 0; i < num_before; i++) {
        if (ids_before[i] == track->track_id) {
            return 1;
        }
    }
    return 0;
}

/*
 * Each plot belongs to one old track, or to two that share it, and is claimed; a claimed plot
 * without a track belonged to one that ended in this step. Newest plots of new tracks are held.
 */
static inline void check_plots_claimed_by_at_most_two_tracks(void)
{
    int owner[SCENE_PLOTS_MAX];
    unsigned there = 0, claimed = 0, owned = 0;
    for (uint32_t i = 0; i < num_plots; i++) {
        owner[i] = -1;
        claimed += report.fates[i] == RHO_FATE_CLAIMED;
    }
    for (unsigned i = 0; i < report.num_tracks; i++) {
        int32_t plot = report.tracks[i].plot;
        int is_old = track_was_there(&report.tracks[i]);
        there += is_old ? 1 : 0;
        if (plot >= 0) {
            assert_true((uint32_t)plot < num_plots);
            assert_int_equal(report.fates[plot], is_old ? RHO_FATE_CLAIMED : RHO_FATE_HELD);
        }
        if (plot >= 0 && is_old) {
            /* merged plots: the tracks are old, and two at most */
            assert_true(owner[plot] == -1 ||
                        (RHO_SHARES_PLOTS && owner[plot] >= 0 && report.tracks[i].hits > 10));
            owned += owner[plot] == -1;
            owner[plot] = owner[plot] == -1 ? (int)i : -2;
        }
    }
    assert_in_range(claimed, owned, owned + num_before - there);
}

static inline void check_fate_counts_add_up(void)
{
    uint32_t counts[RHO_NUM_FATES] = {0}, sum = 0, counted = 0;
    for (uint32_t i = 0; i < num_plots; i++) {
        counts[report.fates[i]]++;
    }
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        assert_int_equal(counts[fate], report.fates_total[fate]);
        sum += report.fates_total[fate];
        counted += tracker.counters.fates[fate];
    }
    assert_int_equal(sum, num_plots);
    assert_int_equal(counted, tracker.counters.plots_in);
}

/*
 * Each track with hypotheses has its own slot with 1 to 8 of them; no other slot is open, and no
 * node is lost.
 */
static inline void check_pool(void)
{
    const struct rho_hypotheses *pool = &tracker.hypotheses;
    unsigned open = 0, nodes = 0, of_tracks = 0;
    for (unsigned slot = 0; slot < RHO_HYPOTHESES_SLOTS; slot++) {
        unsigned count = rho_hypotheses_count(pool, (uint16_t)slot);
        assert_true(count <= RHO_HYPOTHESES_OF_TRACK);
        open += count > 0;
        nodes += count;
    }
    assert_int_equal(nodes + pool->num_free, RHO_MAX_HYPOTHESES);
    for (unsigned i = 0; i < tracker.num_tracks; i++) {
        const struct rho_track *track = &tracker.tracks[i];
        unsigned count = 1;
        if (track->filter == RHO_TRACK_HYPOTHESES) {
            of_tracks++;
            count = rho_hypotheses_count(pool, track->slot);
            for (unsigned other = 0; other < i; other++) {
                assert_true(tracker.tracks[other].filter != RHO_TRACK_HYPOTHESES ||
                            tracker.tracks[other].slot != track->slot);
            }
        }
        assert_true(count >= 1);
        assert_int_equal(report.tracks[i].num_hypotheses, count);
    }
    assert_int_equal(open, of_tracks);
    assert_true(config.gate == RHO_TRACKER_BEST || open == 0);
}

static inline void check_tracks(void)
{
    for (unsigned i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];
        assert_true(i == 0 || report.tracks[i - 1].track_id < track->track_id);
        assert_true(track->maneuver_probability >= 0.0f && track->maneuver_probability <= 1.0f);
        for (int axis = 0; axis < 3; axis++) {
            assert_true(fabsf(track->accel_mps2[axis]) < 10.0f * config.accel_max_mps2 + 1.0f);
        }
        /* single filter: a manoeuvre is an estimated input, which has an acceleration */
        float pull =
            fabsf(track->accel_mps2[0]) + fabsf(track->accel_mps2[1]) + fabsf(track->accel_mps2[2]);
        assert_true(config.gate == RHO_TRACKER_BEST ||
                    (pull > 0.0f) == (track->maneuver_probability > 0.0f));
        for (int e = 0; e < RHO_KALMAN_STATES; e++) {
            assert_true(isfinite(track->state[e]));
            assert_true(track->covariance[RHO_AT(e, e)] >= 0.0f);
        }
        assert_true(isfinite(track->sigma_m) && isfinite(track->score_nat));
    }
}

/* ---- steps ----------------------------------------------------------------------------------- */

/*
 * Prepares a scene without targets or clutter and configurations with this gate, to be changed
 * before begin_tracker().
 */
static inline void set_up_scene(uint8_t gate, uint64_t seed)
{
    random_state = seed;
    memset(&config, 0, sizeof config);
    memset(&initiation, 0, sizeof initiation);
    rho_tracker_config_default(&config);
    config.late_max_s = 0.0f;
    rho_initiator_config_default(&initiation);
    config.gate = gate;
    config.v_max_mps = initiation.v_max_mps = 400.0f;
    scene = (struct scene){
        .interval_s = 1.0, .pd = 1.0, .sigma_m = 10.0, .half_area_m = 10000.0, .clean_scans = 8};
}

/*
 * Configures input estimation as recommended for plots without velocities: the physical model, with
 * a noise density that follows the largest acceleration.
 */
static inline void estimate_inputs(void)
{
    config.input.is_estimated = 1;
    config.input.model = RHO_INPUT_PHYSICAL;
    config.input.sigma_mps2 = config.accel_max_mps2;
    config.input.gamma = 0.7f;
    config.input.noise_m = config.input.noise_mps = 0.0f;
    config.input.noise_density = 25.0f;
}

static inline void begin_tracker(void)
{
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &initiation), RHO_OK);
}

/* Steps with the plots in plots[]; starter is NULL for a step without initiator. */
static inline void step_with_scan(struct rho_scan *scan, struct rho_initiator *starter)
{
    scan->num_plots = num_plots;
    scan->plots = plots;
    num_before = tracker.num_tracks;
    for (unsigned i = 0; i < num_before; i++) {
        ids_before[i] = tracker.tracks[i].track_id;
    }
    memset(&report, 0xee, sizeof report);
    assert_int_equal(rho_tracker_step(&tracker, starter, scan, &report), RHO_OK);
    check_plots_claimed_by_at_most_two_tracks();
    check_fate_counts_add_up();
    check_pool();
    check_tracks();
}

static inline struct rho_scan scan_without_plots_of_step(int k)
{
    return (struct rho_scan){.time_us = llround(scene.interval_s * k * 1e6),
                             .measures = scene.measures};
}

static inline void step_tracker(int k)
{
    struct rho_scan scan = scan_without_plots_of_step(k);
    see_scan(k, scene.interval_s * k);
    if (scene.num_sectors > 0) {
        keep_sector_plots(k, &scan);
    }
    step_with_scan(&scan, &initiator);
}

/* ---- tracks of targets ---------------------------------------------------------------------- */

static inline double distance_m(const struct rho_track_report *track, unsigned target, double t_s)
{
    struct target at = target_on_its_turning_path_at(&scene.target[target], t_s);
    return hypot((double)track->state[0] - at.x_m, (double)track->state[1] - at.y_m);
}

/* The confirmed track nearest to a target, within limit_m; NULL: none. */
static inline const struct rho_track_report *
confirmed_track_nearest_to_target(unsigned target, double t_s, double limit_m)
{
    const struct rho_track_report *found = NULL;
    for (unsigned i = 0; i < report.num_tracks; i++) {
        double d_m = distance_m(&report.tracks[i], target, t_s);
        /* a track with many hits counts though misses made it tentative again */
        int follows = report.tracks[i].status != RHO_TRACK_TENTATIVE || report.tracks[i].hits > 12;
        if (follows && d_m < limit_m) {
            limit_m = d_m;
            found = &report.tracks[i];
        }
    }
    return found;
}

#endif
