/* SPDX-License-Identifier: MIT */
/*
 * A rotating radar that reports sectors, and eight targets at their edges, shared by tests of
 * sectors.
 */
#ifndef RHOTRACK_TESTS_SECTORS_SCENE_H
#define RHOTRACK_TESTS_SECTORS_SCENE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "rhotrack/tracker.h"

#define SECTORS 32
#define TURN_US INT64_C(4000000)
#define SECTOR_US (TURN_US / SECTORS)
#define TARGETS 8
#define PI 3.14159265358979323846

static struct rho_tracker tracker;
static struct rho_initiator initiator;
static struct rho_report report;

/*
 * Sense of the antenna's rotation (+1: counter-clockwise), direction where its first sector begins,
 * and a target that hides.
 */
struct scene {
    int turning;
    double first_rad;
    double speed_mps; /* of targets along their circles, counter-clockwise */
    int hidden;       /* a target without plots from `hidden_turn` on; -1: none */
    int hidden_turn;
    int sectors; /* sectors a turn */
    /* sums over all scans */
    int plots[TARGETS];
    uint32_t fates[RHO_NUM_FATES];
};

static inline void describe_sensor(int32_t sensor_id, float x_m, float pd)
{
    const struct rho_sensor sensor = {
        .sensor_id = sensor_id, .x_m = x_m, .pd = pd, .range_max_m = 80000.0f};

    assert_int_equal(rho_tracker_set_sensor(&tracker, &sensor), RHO_OK);
}

static inline void start_tracker(void)
{
    struct rho_tracker_config config;
    struct rho_initiator_config start_config;

    memset(&report, 0, sizeof report);
    rho_tracker_config_default(&config);
    rho_initiator_config_default(&start_config);
    assert_int_equal(rho_tracker_init(&tracker, sizeof tracker, &config), RHO_OK);
    assert_int_equal(rho_initiator_init(&initiator, sizeof initiator, &start_config), RHO_OK);
    describe_sensor(1, 0.0f, 0.9f);
}

static inline double target_range(int target)
{
    return 20000.0 + 4000.0 * target;
}

/* Target i starts at the edge of sectors 4 i and 4 i + 1 and flies on a circle about the radar. */
static inline double target_azimuth(const struct scene *scene, int target, double t_s)
{
    return scene->first_rad + 4.0 * target * 2.0 * PI / SECTORS +
           scene->speed_mps / target_range(target) * t_s;
}

static inline double wrapped(double angle_rad)
{
    return remainder(angle_rad, 2.0 * PI);
}

/* Time at which the antenna passes the target in a turn. */
static inline double time_of_pass(const struct scene *scene, int target, int turn)
{
    double turn_s = (double)TURN_US * 1e-6, t_s = turn * turn_s;

    for (int i = 0; i < 6; i++) {
        double way = scene->turning * (target_azimuth(scene, target, t_s) - scene->first_rad);

        way -= 2.0 * PI * floor(way / (2.0 * PI));
        t_s = (turn + way / (2.0 * PI)) * turn_s;
    }
    return t_s;
}

static inline struct rho_plot target_plot(const struct scene *scene, int target, double t_s,
                                          int64_t scan_us)
{
    double azimuth_rad = target_azimuth(scene, target, t_s), range_m = target_range(target);
    float noise = 10.0f * sinf(7.3f * (float)target + 1.9f * (float)t_s);

    return (struct rho_plot){.offset_us = (int32_t)(llround(t_s * 1e6) - scan_us),
                             .x_m = (float)((range_m + noise) * cos(azimuth_rad)),
                             .y_m = (float)((range_m + noise) * sin(azimuth_rad)),
                             .sigma_range_m = 15.0f,
                             .sigma_cross_m = (float)(0.003 * range_m)};
}

static inline int is_hidden(const struct scene *scene, int target, int turn)
{
    return target == scene->hidden && turn >= scene->hidden_turn;
}

/* A sector's scan, timed at the sector's end, with the plots of targets that the antenna passed. */
static inline struct rho_scan sector_scan(struct scene *scene, int turn, int sector,
                                          struct rho_plot plots[TARGETS])
{
    double width_rad = 2.0 * PI / scene->sectors;
    double edge_rad = scene->first_rad + scene->turning * sector * width_rad;
    int64_t sector_us = TURN_US / scene->sectors;
    int64_t from_us = turn * TURN_US + sector * sector_us, to_us = from_us + sector_us;
    struct rho_scan scan = {
        .time_us = to_us,
        .sensor_id = 1,
        .sector_from_rad = (float)wrapped(scene->turning > 0 ? edge_rad : edge_rad - width_rad),
        .sector_to_rad = (float)wrapped(scene->turning > 0 ? edge_rad + width_rad : edge_rad),
        .plots = plots};

    for (int i = 0; i < TARGETS; i++) {
        for (int of = turn - 1; of <= turn + 1; of++) {
            double t_s = time_of_pass(scene, i, of);
            int64_t time_us = llround(t_s * 1e6);

            if (time_us >= from_us && time_us < to_us && !is_hidden(scene, i, turn)) {
                plots[scan.num_plots++] = target_plot(scene, i, t_s, to_us);
                scene->plots[i]++;
                break; /* the antenna passes a target once in a sector */
            }
        }
    }
    return scan;
}

static inline void step_scan(struct scene *scene, const struct rho_scan *scan)
{
    assert_int_equal(rho_tracker_step(&tracker, &initiator, scan, &report), RHO_OK);
    for (int fate = 0; fate < RHO_NUM_FATES; fate++) {
        scene->fates[fate] += report.fates_total[fate];
    }
}

static inline void step_sector(struct scene *scene, int turn, int sector)
{
    struct rho_plot plots[TARGETS];
    const struct rho_scan scan = sector_scan(scene, turn, sector, plots);

    step_scan(scene, &scan);
}

static inline void fly_turns(struct scene *scene, int turns)
{
    if (scene->sectors == 0) {
        scene->sectors = SECTORS;
    }
    start_tracker();
    for (int turn = 0; turn < turns; turn++) {
        for (int sector = 0; sector < scene->sectors; sector++) {
            step_sector(scene, turn, sector);
        }
    }
}

/* The track within 600 m of a target at the report's time; NULL: none. */
static inline const struct rho_track_report *track_of_target(const struct scene *scene, int target)
{
    double t_s = (double)report.time_us * 1e-6, azimuth_rad = target_azimuth(scene, target, t_s);
    double x_m = target_range(target) * cos(azimuth_rad),
           y_m = target_range(target) * sin(azimuth_rad);

    for (uint32_t i = 0; i < report.num_tracks; i++) {
        const struct rho_track_report *track = &report.tracks[i];

        if (hypot((double)track->state[0] - x_m, (double)track->state[1] - y_m) < 600.0) {
            return track;
        }
    }
    return NULL;
}

#endif
