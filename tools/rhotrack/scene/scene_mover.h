/* SPDX-License-Identifier: MIT */
/*
 * scene_mover: what moves or stands in a scene and is seen again and again: targets, towers, birds,
 * spikes, echoes.
 */
#ifndef RHOTRACK_TOOL_SCENE_MOVER_H
#define RHOTRACK_TOOL_SCENE_MOVER_H

#include "scene/scene.h"

struct scene_mover {
    const struct scene_path *path; /* or NULL: straight, and round a circle about that */
    double from_s, until_s;
    double x_m, y_m, vx_mps, vy_mps; /* at time 0 */
    double circle_m, circle_rad, circle_radps;
    double unambiguous_m; /* beyond it from the sensor, it is seen nearer by so much; 0: a target */
    double pd;            /* below 0: the sensor's, over range */
    int target_id;        /* -1: clutter */
};

/*
 * Where the sensor sees it, were it to see it. False: it is not there, or no echo of the second
 * time.
 */
bool mover_seen_at(const struct scene_mover *mover, const struct scene_sensor *sensor, double t_s,
                   struct motion *at);

/*
 * Everything of a source of clutter that lasts, in new memory: places and lives are drawn. Kinds
 * that are drawn anew each scan have none. Paths of second-time-around echoes go to *paths, to be
 * freed after the movers.
 */
struct scene_mover *draw_clutter_movers(const struct scene *scene, size_t source, uint64_t seed,
                                        uint64_t run, size_t *count, struct scene_path **paths,
                                        size_t *num_paths);

#endif
