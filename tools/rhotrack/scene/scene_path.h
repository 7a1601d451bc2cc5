/* SPDX-License-Identifier: MIT */
/*
 * scene_path: where targets are: legs of constant acceleration along and constant rate of turn, or
 * of one acceleration whatever the heading, and groups of random ones.
 */
#ifndef RHOTRACK_TOOL_SCENE_PATH_H
#define RHOTRACK_TOOL_SCENE_PATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/scene_body.h"
#include "scene/scene_json.h"
#include "scene/scene_random.h"

struct motion {
    double x_m, y_m, vx_mps, vy_mps, z_m, vz_mps;
};

/* From t_s on, until the next leg. */
struct path_leg {
    double t_s, x_m, y_m, speed_mps, heading_rad;
    double along_mps2, turn_radps;
    double accel_mps2[3]; /* x and y: in place of along and turn */
    double z_m, vz_mps;
};

struct scene_path {
    double from_s, until_s; /* from .. below until it is there */
    size_t item;            /* of targets[] */
    size_t num_legs, room;
    struct path_leg *legs;
    size_t num_shakes; /* of the way and velocity beside the legs, shake_s apart; 0: none */
    double shake_s;
    struct motion *shakes;
};

/* The paths of a run, in memory that grows; a target's identity is its index. */
struct scene_paths {
    size_t count, room;
    struct scene_path *paths;
};

struct motion path_motion_at(const struct scene_path *path, double t_s);
void path_free(struct scene_path *path);
void paths_add(struct scene_paths *paths, struct scene_path path);

/*
 * The first leg, from from_s on; and another one from t_s on, as fast and in the direction as the
 * last one is then. A leg that would begin where the last one does takes its place.
 */
void path_begin_first_leg(struct scene_path *path, double x_m, double y_m, double speed_mps,
                          double heading_rad);
void path_begin_next_leg(struct scene_path *path, double t_s, double along_mps2, double turn_radps);
double path_speed_mps(const struct scene_path *path, double t_s); /* in the last leg */
void path_add_leg(struct scene_path *path, struct path_leg leg);

/*
 * The leg that a time is in; its speed and heading then. Below PATH_STANDS_MPS a target has no
 * heading to turn.
 */
#define PATH_STANDS_MPS 1e-3
const struct path_leg *path_leg_at(const struct scene_path *path, double t_s);
double path_leg_speed_mps(const struct path_leg *leg, double t_s);
double path_leg_heading_rad(const struct path_leg *leg, double t_s);

/* One leg of a described path. */
struct path_step {
    double for_s; /* 0: until the speed or the turn is there */
    double along_mps2, across_mps2, turn_radps;
    double accel_mps2[3]; /* x, y, z */
    bool has_speed;
    double to_speed_mps;
    double turn_rad; /* 0: for_s */
};

#define KEEP_DISCS_MAX 8

/* An element of targets[]: one path, a group of random ones, or flights. */
struct target_item {
    size_t count;         /* 0: one path, or flights */
    size_t flights;       /* always so many in the air, in box_m; 0: none */
    double flights_least; /* seconds that each lasts */
    double crossing_share;
    double from_s, until_s;
    double x_m, y_m, speed_mps, heading_rad;
    bool has_parent;
    size_t parent;
    double heading_change_rad, speed_change_mps; /* against the parent's */
    size_t num_steps;
    struct path_step *steps;
    bool has_height;
    double z_m, vz_mps;
    size_t num_points; /* in place of a beginning and legs: t_s, x_m, y_m */
    double (*points)[3];
    double shake_s, shake_mps2; /* a random acceleration so often; 0: none */
    struct scene_body body;

    struct json_span from, life; /* of a group; life 0: to the end */
    bool has_life, is_replaced;
    struct json_span pause;
    double about_x_m, about_y_m;
    struct json_span range, azimuth; /* of the place where it begins */
    bool has_box;
    double box_m[4];
    struct json_span speed, heading;
    bool is_relative; /* heading: against the way to the centre */
    bool is_either;   /* heading: to the left or the right */
    bool has_keep;
    struct json_span keep;
    bool has_keep_box;
    double keep_box_m[4];
    size_t num_keep_discs;
    double keep_discs_m[KEEP_DISCS_MAX][4]; /* x, y, from, to: always in one of these rings, */
    double keep_all_share;                  /* and this share of its life in all of them */
    double spacing_m;                       /* to those before it */
    bool has_turns, has_turn_for;
    struct json_span turn_every, turn_across, turn_rad, turn_for;
    bool has_changes;
    struct json_span change_every, change_speed, change_along;
    bool has_stops;
    struct json_span stop_every, stop_for, stop_along;
};

struct scene_targets {
    size_t count;
    struct target_item *items;
};

/* The distributions from which paths are drawn. */
struct target_draft {
    const char *file;
    const struct target_item *item;
    size_t index; /* in targets[] */
    double duration_s;
};

/* Flights from before 0 s until the end. Exit 2 where none fits into box_m. scene_flights.c */
void flights_draw(const struct target_draft *draft, struct scene_paths *paths,
                  struct random *random);

/* scene_targets.c */
struct scene_targets targets_read(struct json_object *object, const char *key);
void targets_free(struct scene_targets *targets);

/*
 * All paths of a run, in new memory. Exit 2 where no random path keeps within keep_range_m and
 * keep_box_m.
 */
struct scene_path *targets_draw(const struct scene_targets *targets, const char *file,
                                double duration_s, uint64_t seed, uint64_t run, uint64_t source,
                                size_t *count);

#endif
