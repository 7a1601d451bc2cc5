/* SPDX-License-Identifier: MIT */
/* scene_body: extended targets: scatterers on a body, each of which is detected separately. */
#ifndef RHOTRACK_TOOL_SCENE_BODY_H
#define RHOTRACK_TOOL_SCENE_BODY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/random.h"
#include "scene/json_value_reader.h"

#define SCENE_SCATTERERS_MAX 64

/* An extended target: a rectangle about the target's position, its length along the velocity. */
struct scene_body {
    double length_m, width_m;
    size_t scatterers; /* number of scatterers; 0: a point target */
    double seen;       /* probability of detection of each scatterer at each look */
    bool is_anew;      /* scatterer positions are drawn anew at each look; false: once a run */
    double limbs_mps;  /* sigma of a scatterer's own velocity on each axis, anew at each look */
};

/* Reads the key "body" of a target in a scene file. */
struct scene_body scene_body_read(struct json_object *object);

/*
 * Draws random scatterer positions, in metres along and across the body. Length and width are
 * divided into as many parts as there are scatterers, and each part has one at a uniform position.
 */
void scene_body_draw_scatterers(const struct scene_body *body, struct random *random,
                                double places_m[SCENE_SCATTERERS_MAX][2]);

#endif
