/* SPDX-License-Identifier: MIT */
#include "scene/scene_path.h"

#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/portable_math.h"

#define STRAIGHT_RADPS 1e-6

static bool has_xy_acceleration(const struct path_leg *leg)
{
    return fabs(leg->accel_mps2[0]) + fabs(leg->accel_mps2[1]) > 0.0;
}

/* Velocity after dt_s on a leg with constant acceleration in x and y. */
static void xy_accelerated_velocity(const struct path_leg *leg, double dt_s, double *vx_mps,
                                    double *vy_mps)
{
    *vx_mps = leg->speed_mps * portable_cos(leg->heading_rad) + leg->accel_mps2[0] * dt_s;
    *vy_mps = leg->speed_mps * portable_sin(leg->heading_rad) + leg->accel_mps2[1] * dt_s;
}

double path_leg_speed_mps(const struct path_leg *leg, double t_s)
{
    double vx_mps, vy_mps;

    xy_accelerated_velocity(leg, t_s - leg->t_s, &vx_mps, &vy_mps);
    return has_xy_acceleration(leg) ? portable_hypot(vx_mps, vy_mps)
                                    : leg->speed_mps + leg->along_mps2 * (t_s - leg->t_s);
}

double path_leg_heading_rad(const struct path_leg *leg, double t_s)
{
    double vx_mps, vy_mps;

    xy_accelerated_velocity(leg, t_s - leg->t_s, &vx_mps, &vy_mps);
    return has_xy_acceleration(leg) ? portable_atan2(vy_mps, vx_mps)
                                    : leg->heading_rad + leg->turn_radps * (t_s - leg->t_s);
}

static struct motion leg_motion_at(const struct path_leg *leg, double t_s)
{
    double dt_s = t_s - leg->t_s, turn = leg->turn_radps, along = leg->along_mps2;
    double speed_mps = path_leg_speed_mps(leg, t_s), heading_rad = path_leg_heading_rad(leg, t_s);
    double c = portable_cos(heading_rad), s = portable_sin(heading_rad);
    const double *accel_mps2 = leg->accel_mps2;
    struct motion at = {.x_m = leg->x_m,
                        .y_m = leg->y_m,
                        .vx_mps = speed_mps * c,
                        .vy_mps = speed_mps * s,
                        .z_m = leg->z_m + (leg->vz_mps + 0.5 * accel_mps2[2] * dt_s) * dt_s,
                        .vz_mps = leg->vz_mps + accel_mps2[2] * dt_s};

    if (has_xy_acceleration(leg)) {
        xy_accelerated_velocity(leg, dt_s, &at.vx_mps, &at.vy_mps);
        at.x_m += (at.vx_mps - 0.5 * accel_mps2[0] * dt_s) * dt_s;
        at.y_m += (at.vy_mps - 0.5 * accel_mps2[1] * dt_s) * dt_s;
    } else if (fabs(turn) < STRAIGHT_RADPS) {
        double way_m = (leg->speed_mps + 0.5 * along * dt_s) * dt_s;
        double middle_rad = leg->heading_rad + 0.5 * turn * dt_s;

        at.x_m += way_m * portable_cos(middle_rad);
        at.y_m += way_m * portable_sin(middle_rad);
    } else {
        double c0 = portable_cos(leg->heading_rad), s0 = portable_sin(leg->heading_rad);

        at.x_m += (speed_mps * s - leg->speed_mps * s0) / turn + along * (c - c0) / (turn * turn);
        at.y_m += (leg->speed_mps * c0 - speed_mps * c) / turn + along * (s - s0) / (turn * turn);
    }
    return at;
}

const struct path_leg *path_leg_at(const struct scene_path *path, double t_s)
{
    size_t first = 0, last = path->num_legs;

    while (last - first > 1) {
        size_t middle = first + (last - first) / 2;

        if (path->legs[middle].t_s <= t_s) {
            first = middle;
        } else {
            last = middle;
        }
    }
    return &path->legs[first];
}

/*
 * Adds the deviation from the legs that random accelerations, redrawn every shake_s, have caused by
 * t_s.
 */
static void add_random_deviation(const struct scene_path *path, double t_s, struct motion *at)
{
    double steps = fmax(0.0, floor((t_s - path->from_s) / path->shake_s));
    size_t last = path->num_shakes - 1, i = steps < (double)last ? (size_t)steps : last;
    const struct motion *shake = &path->shakes[i], *next = &path->shakes[i < last ? i + 1 : i];
    double dt_s = fmax(0.0, t_s - path->from_s - (double)i * path->shake_s);
    double share = dt_s / path->shake_s;

    at->x_m += shake->x_m + (shake->vx_mps + 0.5 * share * (next->vx_mps - shake->vx_mps)) * dt_s;
    at->y_m += shake->y_m + (shake->vy_mps + 0.5 * share * (next->vy_mps - shake->vy_mps)) * dt_s;
    at->z_m += shake->z_m + (shake->vz_mps + 0.5 * share * (next->vz_mps - shake->vz_mps)) * dt_s;
    at->vx_mps += shake->vx_mps + share * (next->vx_mps - shake->vx_mps);
    at->vy_mps += shake->vy_mps + share * (next->vy_mps - shake->vy_mps);
    at->vz_mps += shake->vz_mps + share * (next->vz_mps - shake->vz_mps);
}

struct motion path_motion_at(const struct scene_path *path, double t_s)
{
    struct motion at = leg_motion_at(path_leg_at(path, t_s), t_s);

    if (path->num_shakes > 0) {
        add_random_deviation(path, t_s, &at);
    }
    return at;
}

void path_free(struct scene_path *path)
{
    free(path->legs);
    free(path->shakes);
    path->legs = NULL;
    path->shakes = NULL;
}

void path_add_leg(struct scene_path *path, struct path_leg leg)
{
    path->legs =
        must_make_room_for_one(path->legs, path->num_legs, &path->room, sizeof *path->legs);
    path->legs[path->num_legs++] = leg;
}

void path_begin_first_leg(struct scene_path *path, double x_m, double y_m, double speed_mps,
                          double heading_rad)
{
    path_add_leg(path, (struct path_leg){.t_s = path->from_s,
                                         .x_m = x_m,
                                         .y_m = y_m,
                                         .speed_mps = speed_mps,
                                         .heading_rad = heading_rad});
}

void path_begin_next_leg(struct scene_path *path, double t_s, double along_mps2, double turn_radps)
{
    struct path_leg *last = &path->legs[path->num_legs - 1];
    struct motion at = leg_motion_at(last, t_s);
    struct path_leg next = {.t_s = t_s,
                            .x_m = at.x_m,
                            .y_m = at.y_m,
                            .speed_mps = path_leg_speed_mps(last, t_s),
                            .heading_rad = path_leg_heading_rad(last, t_s),
                            .along_mps2 = along_mps2,
                            .turn_radps = turn_radps,
                            .z_m = at.z_m,
                            .vz_mps = at.vz_mps};

    if (fabs(next.speed_mps) < PATH_STANDS_MPS * 1e-3) {
        next.speed_mps = 0.0;
    }
    if (t_s > last->t_s) {
        path_add_leg(path, next);
    } else {
        *last = next;
    }
}

double path_last_leg_speed_mps(const struct scene_path *path, double t_s)
{
    return path_leg_speed_mps(&path->legs[path->num_legs - 1], t_s);
}

void paths_add(struct scene_paths *paths, struct scene_path path)
{
    paths->paths =
        must_make_room_for_one(paths->paths, paths->count, &paths->room, sizeof *paths->paths);
    paths->paths[paths->count++] = path;
}
