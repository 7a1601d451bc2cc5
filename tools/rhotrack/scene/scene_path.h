/* SPDX-License-Identifier: MIT */
/*
 * scene_path: paths of simulated targets, made of legs with constant along-track acceleration and
 * turn rate, or with a constant acceleration in x, y, z; and the descriptions from which paths are
 * made or drawn at random.
 */
#ifndef RHOTRACK_TOOL_SCENE_PATH_H
#define RHOTRACK_TOOL_SCENE_PATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scene/json_value_reader.h"
#include "scene/scene_body.h"
#include "scene/scene_random_streams.h"

struct motion {
    double x_m, y_m, vx_mps, vy_mps, z_m, vz_mps;
};

/* A leg of a path, from t_s until the next leg begins: state at t_s and accelerations. */
struct path_leg {
    double t_s, x_m, y_m, speed_mps, heading_rad;
    double along_mps2, turn_radps;
    /* acceleration in x and y, instead of along_mps2 and turn_radps, and in z */
    double accel_mps2[3];
    double z_m, vz_mps;
};

struct scene_path {
    double from_s, until_s; /* the target exists from from_s to before until_s */
    size_t item;            /* index of the path's element of targets[] */
    size_t num_legs, room;
    struct path_leg *legs;
    size_t num_shakes; /* number of random deviations from the legs, shake_s apart; 0: none */
    double shake_s;
    struct motion *shakes;
};

/* The growing list of paths of a run; a target's id is its index. */
struct scene_paths {
    size_t count, room;
    struct scene_path *paths;
};

struct motion path_motion_at(const struct scene_path *path, double t_s);
void path_free(struct scene_path *path);
void paths_add(struct scene_paths *paths, struct scene_path path);

/*
 * path_begin_first_leg starts the path at from_s. path_begin_next_leg continues from t_s with the
 * speed and heading of the last leg then; it replaces a last leg that begins at the same time.
 */
void path_begin_first_leg(struct scene_path *path, double x_m, double y_m, double speed_mps,
                          double heading_rad);
void path_begin_next_leg(struct scene_path *path, double t_s, double along_mps2, double turn_radps);
/* speed at t_s by the path's last leg */
double path_last_leg_speed_mps(const struct scene_path *path, double t_s);
void path_add_leg(struct scene_path *path, struct path_leg leg);

/*
 * The leg at a time, and its speed and heading at a time. A target slower than PATH_STANDS_MPS is
 * standing and cannot turn.
 */
#define PATH_STANDS_MPS 1e-3
const struct path_leg *path_leg_at(const struct scene_path *path, double t_s);
double path_leg_speed_mps(const struct path_leg *leg, double t_s);
double path_leg_heading_rad(const struct path_leg *leg, double t_s);

/* One leg as described in a scene file. */
struct path_step {
    double for_s; /* duration; 0: until to_speed_mps or turn_rad is reached */
    double along_mps2, across_mps2, turn_radps;
    double accel_mps2[3]; /* acceleration in x, y, z */
    bool has_speed;
    double to_speed_mps;
    double turn_rad; /* angle of the turn; 0: the turn lasts for_s */
};

#define KEEP_DISCS_MAX 8

/* An element of targets[]: one path, a group of random ones, or flights. */
struct target_item {
    /* number of random targets of a group; 0: one described path, or flights */
    size_t count;
    size_t flights;       /* number of aircraft always in the air over box_m; 0: none */
    double flights_least; /* shortest duration of a flight, seconds */
    double crossing_share;
    double from_s, until_s;
    double x_m, y_m, speed_mps, heading_rad;
    bool has_parent;
    size_t parent;
    /* change from the parent's heading and speed at from_s */
    double heading_change_rad, speed_change_mps;
    size_t num_steps;
    struct path_step *steps;
    bool has_height;
    double z_m, vz_mps;
    size_t num_points; /* number of points (t_s, x_m, y_m), instead of a start and legs */
    double (*points)[3];
    double shake_s, shake_mps2; /* interval and sigma of random accelerations; 0: none */
    struct scene_body body;

    struct json_span from, life; /* of a group: start time and life time of each target */
    bool has_life, is_replaced;
    struct json_span pause;
    double about_x_m, about_y_m;
    /* range and azimuth of the start position about (about_x_m, about_y_m) */
    struct json_span range, azimuth;
    bool has_box;
    double box_m[4];
    struct json_span speed, heading;
    bool is_relative; /* heading is relative to the direction to the centre */
    bool is_either;   /* heading is to the left or right, with equal probability */
    bool has_keep;
    struct json_span keep;
    bool has_keep_box;
    double keep_box_m[4];
    size_t num_keep_discs;
    /* rings x, y, least and most radius: the target is always in at least one */
    double keep_discs_m[KEEP_DISCS_MAX][4];
    double keep_all_share; /* share of its life that the target is in all rings */
    double spacing_m;      /* least distance to the targets drawn before */
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

/* What a random path is drawn from: the element of targets[] and the scene's duration. */
struct target_draft {
    const char *file;
    const struct target_item *item;
    size_t index; /* index of item in targets[] */
    double duration_s;
};

/*
 * Draws the flights of an item from before the start until the end of the scene. Exits with 2 where
 * no flight of least_s fits into box_m. In scene_random_flights.c.
 */
void flights_draw_random(const struct target_draft *draft, struct scene_paths *paths,
                         struct random *random);

/*
 * Reads the list of targets at the key. In scene_targets.c, like the functions
 * below.
 */
struct scene_targets targets_read(struct json_object *object, const char *key);
void targets_free(struct scene_targets *targets);

/*
 * Draws all paths of a run, in new memory. Exits with 2 where no random path keeps within its
 * limits (keep_range_m, keep_box_m, keep_discs_m, spacing_m).
 */
struct scene_path *targets_draw_paths(const struct scene_targets *targets, const char *file,
                                      double duration_s, uint64_t seed, uint64_t run,
                                      uint64_t source, size_t *count);

#endif
