/* SPDX-License-Identifier: MIT */
/*
 * scenario_rotating: a radar in the origin that turns clockwise, by sectors, and targets at 20 to 60 km, every second of which
 * turns gently for a while.
 */
#ifndef RHOTRACK_TOOL_SCENARIO_ROTATING_H
#define RHOTRACK_TOOL_SCENARIO_ROTATING_H

#include "scenario_antenna.h"

/* Straight, a turn from one time until another, straight again; turn_radps 0: straight all the way. */
struct rotating_flight {
    double x_m, y_m, speed_mps, heading_rad; /* at 0 s */
    double turn_from_s, turn_until_s, turn_radps;
};

struct rotating_scene {
    struct scenario_antenna antenna;
    size_t num_turns, num_flights;
    struct rotating_flight *flights;
};

/* What is to be seen: flights that stay between 20 and 60 km. */
struct rotating_scene rotating_draw(const struct parameters *parameters, struct random *random);
void rotating_free(struct rotating_scene *scene);

/* The scene's flights, as an antenna watches them; the scene stays the caller's. */
struct antenna_targets rotating_targets(const struct rotating_scene *scene);

/* Where a flight is, and how fast. */
struct truth_point rotating_truth(const struct rotating_scene *scene, size_t flight, double t_s);

#endif
