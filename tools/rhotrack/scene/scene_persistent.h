/* SPDX-License-Identifier: MIT */
/*
 * scene_persistent: objects of a scene that sensors detect repeatedly:
 * targets, towers, birds, sea spikes and second-time-around echoes.
 */
#ifndef RHOTRACK_TOOL_SCENE_PERSISTENT_H
#define RHOTRACK_TOOL_SCENE_PERSISTENT_H

#include "scene/scene.h"

struct scene_mover {
    const struct scene_path *path; /* NULL: straight motion, with a circle about it */
    double from_s, until_s;
    double x_m, y_m, vx_mps, vy_mps; /* position and velocity at time 0, without a path */
    double circle_m, circle_rad, circle_radps;
    /* unambiguous range of a second-time-around echo, which is seen nearer by this much; 0: none */
    double unambiguous_m;
    double pd;     /* probability of detection; below 0: the sensor's curve over range */
    int target_id; /* id of the target; -1: clutter */
};

/*
 * Apparent motion of the object for the sensor at time t_s. False: the object does not exist then,
 * or is outside the ranges of a second-time-around echo.
 */
bool folded_motion_at(const struct scene_mover *mover, const struct scene_sensor *sensor,
                      double t_s, struct motion *at);

/*
 * Draws the persistent objects of a clutter source, in new memory; kinds that are drawn anew each
 * scan have none. *paths gets the paths of second-time-around echoes, to be freed after the movers.
 */
struct scene_mover *draw_persistent_clutter(const struct scene *scene, size_t source, uint64_t seed,
                                            uint64_t run, size_t *count, struct scene_path **paths,
                                            size_t *num_paths);

#endif
