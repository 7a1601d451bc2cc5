/* SPDX-License-Identifier: MIT */
/*
 * Scenes of targets that fly towards passive sensors, which may move and look at times of their
 * own: bearings with noise, misses and false ones, and frames of them. The truth is in double
 * precision.
 */
#ifndef PASSIVE_SCENE_H
#define PASSIVE_SCENE_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "rhotrack/passive.h"

#define PI 3.14159265358979323846
#define DEG_RAD (PI / 180.0)
#define SCENE_SCANS 16
#define SCENE_SENSORS 8
#define SCENE_TARGETS 4
#define LOOK_MAX 64u

static uint64_t random_state = 7;

static inline uint64_t random_bits(void)
{
    random_state = random_state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return random_state >> 11;
}

static inline double uniform(double from, double to)
{
    return from + (to - from) * (double)random_bits() / 9007199254740992.0;
}

static inline double normal(void)
{
    double size = sqrt(-2.0 * log(uniform(1e-12, 1.0)));
    return size * cos(uniform(0.0, 2.0 * PI));
}

static inline float any_float(void)
{
    uint32_t bits = (uint32_t)(random_bits() >> 16);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* A value between `from` and `to`, or, with probability `any`, any float. */
static inline float float_or_any(double from, double to, double any)
{
    return uniform(0.0, 1.0) < any ? any_float() : (float)uniform(from, to);
}

/* The bearings of one sensor in one scan. */
struct look {
    int is_absent; /* the sensor is not in the frame */
    double sector_from_rad, sector_to_rad;
    unsigned count;
    struct rho_bearing bearings[LOOK_MAX];
    int target[LOOK_MAX]; /* -1: a false bearing */
};

struct target {
    double x_m, y_m, vx_mps, vy_mps; /* at time 0 */
};

struct height {
    double z_m, vz_mps; /* at time 0 */
};

struct scene {
    unsigned sensors, targets, scans;
    double sigma_from_rad, sigma_to_rad; /* limits of the bearings' sigmas */
    /* probability of detection, and mean number of false bearings a scan */
    double pd, false_bearings;
    double jitter_s; /* largest deviation of intervals from 10 s */
    double time_s[SCENE_SCANS];
    double sensor_x_m[SCENE_SENSORS], sensor_y_m[SCENE_SENSORS]; /* at time 0 */
    double sensor_vx_mps[SCENE_SENSORS], sensor_vy_mps[SCENE_SENSORS];
    double sensor_z_m[SCENE_SENSORS];
    double sigma_elevation_rad[SCENE_SENSORS]; /* 0: the sensor measures no elevations */
    double offset_s[SCENE_SENSORS];            /* of the sensor's looks, after the scans' times */
    int has_single_scans;                      /* each scan is a frame of its own */
    struct target target[SCENE_TARGETS];
    struct height height[SCENE_TARGETS]; /* of the targets, for sensors that measure elevations */
    struct look look[SCENE_SCANS][SCENE_SENSORS];
};

static inline struct scene scene_of(unsigned sensors, unsigned targets, double sigma_deg, double pd,
                                    double false_bearings)
{
    static const double x_m[SCENE_SENSORS] = {0.0, 0.0, 10e3, -10e3, 5e3, -5e3, -5e3, 5e3};
    static const double y_m[SCENE_SENSORS] = {-10e3, 10e3, 0.0, 0.0, -20e3, -20e3, 20e3, 20e3};
    struct scene scene;
    memset(&scene, 0, sizeof scene);
    scene.sensors = sensors;
    scene.targets = targets;
    scene.scans = 8;
    scene.sigma_from_rad = scene.sigma_to_rad = sigma_deg * DEG_RAD;
    scene.pd = pd;
    scene.false_bearings = false_bearings;
    memcpy(scene.sensor_x_m, x_m, sizeof x_m);
    memcpy(scene.sensor_y_m, y_m, sizeof y_m);
    return scene;
}

/* ---- targets --------------------------------------------------------------------------------- */

static inline double scene_span_s(const struct scene *scene)
{
    return scene->time_s[scene->scans - 1] - scene->time_s[0];
}

static inline struct target random_target(double span_s)
{
    struct target target;
    do {
        target.x_m = uniform(20e3, 75e3);
        target.y_m = uniform(-50e3, 50e3);
        double speed_mps = uniform(150.0, 350.0);
        double heading_rad =
            atan2(-target.y_m, -target.x_m) + uniform(-45.0 * DEG_RAD, 45.0 * DEG_RAD);
        target.vx_mps = speed_mps * cos(heading_rad);
        target.vy_mps = speed_mps * sin(heading_rad);
    } while (hypot(target.x_m, target.y_m) > 78e3 || target.x_m + span_s * target.vx_mps < 2e3);
    return target;
}

static inline double target_x_m(const struct target *target, double time_s)
{
    return target->x_m + time_s * target->vx_mps;
}

static inline double target_y_m(const struct target *target, double time_s)
{
    return target->y_m + time_s * target->vy_mps;
}

static inline double height_z_m(const struct height *height, double time_s)
{
    return height->z_m + time_s * height->vz_mps;
}

/* A height, and a climb or descent that keeps the target in the air. */
static inline struct height random_height(void)
{
    const double z_m = uniform(1.5e3, 8.5e3);
    return (struct height){z_m, uniform(-15.0, 15.0)};
}

/* ---- bearings ------------------------------------------------------------------------------- */

static inline void add_bearing(struct look *look, double bearing_rad, double sigma_rad, int target)
{
    if (look->count < LOOK_MAX) {
        look->target[look->count] = target;
        look->bearings[look->count++] = (struct rho_bearing){
            .bearing_rad = (float)remainder(bearing_rad, 2.0 * PI), .sigma_rad = (float)sigma_rad};
    }
}

static inline unsigned poisson(double mean)
{
    unsigned count = 0;
    for (double p = exp(-mean), at = uniform(0.0, 1.0), sum = p; at > sum && p > 0.0; sum += p) {
        count++;
        p *= mean / count;
    }
    return count;
}

static inline void shuffle(struct look *look)
{
    for (unsigned i = look->count; i > 1; i--) {
        unsigned j = (unsigned)uniform(0.0, i);
        struct rho_bearing bearing = look->bearings[i - 1];
        int target = look->target[i - 1];
        look->bearings[i - 1] = look->bearings[j];
        look->target[i - 1] = look->target[j];
        look->bearings[j] = bearing;
        look->target[j] = target;
    }
}

/* When and where sensor s looks in scan k. */
static inline double look_time_s(const struct scene *scene, unsigned k, unsigned s)
{
    return scene->time_s[k] + scene->offset_s[s];
}

static inline double look_x_m(const struct scene *scene, unsigned k, unsigned s)
{
    return scene->sensor_x_m[s] + look_time_s(scene, k, s) * scene->sensor_vx_mps[s];
}

static inline double look_y_m(const struct scene *scene, unsigned k, unsigned s)
{
    return scene->sensor_y_m[s] + look_time_s(scene, k, s) * scene->sensor_vy_mps[s];
}

/* Adds an elevation to the bearing added last, where the sensor measures it. */
static inline void add_elevation(const struct scene *scene, struct look *look, unsigned s,
                                 double elevation_rad)
{
    const double sigma_rad = scene->sigma_elevation_rad[s];
    if (sigma_rad > 0.0 && look->count > 0) {
        struct rho_bearing *bearing = &look->bearings[look->count - 1u];
        bearing->elevation_rad = (float)(elevation_rad + sigma_rad * normal());
        bearing->sigma_elevation_rad = (float)sigma_rad;
    }
}

static inline void see_look(struct scene *scene, unsigned k, unsigned s)
{
    struct look *look = &scene->look[k][s];
    const double time_s = look_time_s(scene, k, s);
    look->count = 0;
    for (unsigned i = 0; i < scene->targets; i++) {
        double sigma_rad = uniform(scene->sigma_from_rad, scene->sigma_to_rad), error = normal();
        if (uniform(0.0, 1.0) < scene->pd) {
            double dx_m = target_x_m(&scene->target[i], time_s) - look_x_m(scene, k, s);
            double dy_m = target_y_m(&scene->target[i], time_s) - look_y_m(scene, k, s);
            double dz_m = height_z_m(&scene->height[i], time_s) - scene->sensor_z_m[s];
            add_bearing(look, atan2(dy_m, dx_m) + sigma_rad * error, sigma_rad, (int)i);
            add_elevation(scene, look, s, atan2(dz_m, hypot(dx_m, dy_m)));
        }
    }
    for (unsigned left = poisson(scene->false_bearings); left > 0; left--) {
        double sigma_rad = uniform(scene->sigma_from_rad, scene->sigma_to_rad);
        add_bearing(look, uniform(-0.5 * PI, 0.5 * PI), sigma_rad, -1);
        if (scene->sigma_elevation_rad[s] > 0.0) {
            add_elevation(scene, look, s, uniform(0.0, 0.5));
        }
    }
    shuffle(look);
}

static inline void see_all_looks(struct scene *scene)
{
    for (unsigned k = 0; k < scene->scans; k++) {
        for (unsigned s = 0; s < scene->sensors; s++) {
            see_look(scene, k, s);
        }
    }
}

static inline void set_scan_times(struct scene *scene)
{
    for (unsigned k = 1; k < scene->scans; k++) {
        scene->time_s[k] = scene->time_s[k - 1] + 10.0 + uniform(-scene->jitter_s, scene->jitter_s);
        scene->time_s[k] = floor(scene->time_s[k] * 1e6) / 1e6;
    }
}

static inline void draw_scene(struct scene *scene)
{
    set_scan_times(scene);
    for (unsigned i = 0; i < scene->targets; i++) {
        scene->target[i] = random_target(scene_span_s(scene));
    }
    see_all_looks(scene);
}

/* Rotates sensors that stand about the origin, then shifts them; bearings rotate, too. */
static inline void move_scene(struct scene *scene, double turn_rad, double x_m, double y_m)
{
    double c = cos(turn_rad), s = sin(turn_rad);
    for (unsigned i = 0; i < scene->sensors; i++) {
        double from_x_m = scene->sensor_x_m[i], from_y_m = scene->sensor_y_m[i];
        scene->sensor_x_m[i] = c * from_x_m - s * from_y_m + x_m;
        scene->sensor_y_m[i] = s * from_x_m + c * from_y_m + y_m;
    }
    for (unsigned k = 0; k < scene->scans; k++) {
        for (unsigned i = 0; i < scene->sensors; i++) {
            struct look *look = &scene->look[k][i];
            for (unsigned j = 0; j < look->count; j++) {
                float *bearing_rad = &look->bearings[j].bearing_rad;
                *bearing_rad = (float)remainder((double)*bearing_rad + turn_rad, 2.0 * PI);
            }
        }
    }
}

/* ---- frames ---------------------------------------------------------------------------------- */

/* A frame with its scans and fates. */
struct full_frame {
    struct rho_frame frame;
    struct rho_bearing_scan scans[SCENE_SENSORS];
    uint8_t fates[SCENE_SENSORS * LOOK_MAX]; /* all RHO_FATE_HELD */
};

static inline void fill_frame(const struct scene *scene, unsigned k, struct full_frame *full)
{
    memset(full, 0, sizeof *full);
    memset(full->fates, RHO_FATE_HELD, sizeof full->fates);
    full->frame.time_us = llround(scene->time_s[k] * 1e6);
    full->frame.scans = full->scans;
    for (unsigned s = 0; s < scene->sensors; s++) {
        const struct look *look = &scene->look[k][s];
        if (!look->is_absent) {
            full->scans[full->frame.num_scans++] =
                (struct rho_bearing_scan){.time_us = llround(look_time_s(scene, k, s) * 1e6),
                                          .sensor_id = (int32_t)(10 + s),
                                          .x_m = (float)look_x_m(scene, k, s),
                                          .y_m = (float)look_y_m(scene, k, s),
                                          .z_m = (float)scene->sensor_z_m[s],
                                          .sector_from_rad = (float)look->sector_from_rad,
                                          .sector_to_rad = (float)look->sector_to_rad,
                                          .num_bearings = look->count,
                                          .bearings = look->bearings};
        }
    }
}

static inline enum rho_status push_scan(struct rho_passive *passive, const struct scene *scene,
                                        unsigned k)
{
    struct full_frame full;
    enum rho_status status = RHO_OK;
    fill_frame(scene, k, &full);
    if (!scene->has_single_scans) {
        return rho_passive_push(passive, &full.frame, full.fates);
    }
    for (unsigned i = 0; i < full.frame.num_scans && status == RHO_OK; i++) {
        const struct rho_frame frame = {
            .time_us = full.scans[i].time_us, .num_scans = 1, .scans = &full.scans[i]};
        status = rho_passive_push(passive, &frame, full.fates);
    }
    return status;
}

/* Pushes the scans from `first` on, until one is refused; returns the last status. */
static inline enum rho_status push_scans_from(struct rho_passive *passive,
                                              const struct scene *scene, unsigned first)
{
    enum rho_status status = RHO_OK;
    for (unsigned k = first; k < scene->scans && status == RHO_OK; k++) {
        status = push_scan(passive, scene, k);
    }
    return status;
}

static inline enum rho_status start_passive(struct rho_passive *passive)
{
    struct rho_passive_config config;
    rho_passive_config_default(&config);
    return rho_passive_init(passive, sizeof *passive, &config);
}

static inline enum rho_status search_scene(struct rho_passive *passive, const struct scene *scene)
{
    enum rho_status status = start_passive(passive);
    status = status == RHO_OK ? push_scans_from(passive, scene, 0) : status;
    return status == RHO_OK ? rho_passive_search(passive) : status;
}

/* ---- checks of tracks ----------------------------------------------------------------------- */

static inline int has_finite_state_and_positive_variances(const struct rho_passive_track *track)
{
    int is_finite = isfinite(track->x_m) && isfinite(track->y_m) && isfinite(track->vx_mps) &&
                    isfinite(track->vy_mps) && isfinite(track->chi2) && track->chi2 >= 0.0f;
    for (int i = 0; i < 10; i++) {
        is_finite = is_finite && isfinite(track->covariance[i]);
    }
    return is_finite && track->covariance[0] > 0.0f && track->covariance[2] > 0.0f &&
           track->covariance[5] > 0.0f && track->covariance[9] > 0.0f;
}

/* Claims name held bearings that no other track has claimed, and agree with hits and scans. */
static inline int are_claims_right(const struct rho_passive *passive,
                                   const struct rho_passive_track *track,
                                   uint64_t claimed[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS])
{
    unsigned hits = 0, scans = 0;
    for (unsigned k = 0; k < RHO_MAX_PASSIVE_SCANS; k++) {
        for (unsigned s = 0; s < RHO_MAX_PASSIVE_SENSORS; s++) {
            unsigned claim = track->claim[k][s];
            if (claim == 0) {
                continue;
            }
            if (k >= passive->batch.num_scans || s >= passive->batch.num_sensors ||
                claim > passive->batch.num_bearings[k][s] || (claimed[k][s] >> (claim - 1u) & 1u)) {
                return 0;
            }
            claimed[k][s] |= UINT64_C(1) << (claim - 1u);
            hits++;
            scans |= 1u << k;
        }
    }
    return hits == track->hits && scans == track->scans;
}

static inline int are_tracks_finite_with_right_claims(const struct rho_passive *passive)
{
    uint64_t claimed[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS] = {{0}};
    if (passive->num_tracks > RHO_MAX_PASSIVE_TRACKS) {
        return 0;
    }
    for (unsigned i = 0; i < passive->num_tracks; i++) {
        if (!has_finite_state_and_positive_variances(&passive->tracks[i]) ||
            !are_claims_right(passive, &passive->tracks[i], claimed)) {
            return 0;
        }
    }
    return 1;
}

#endif
