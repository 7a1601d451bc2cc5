/* SPDX-License-Identifier: MIT */
/*
 * scene_body: targets that are more than a point: scatterers on a body, each of which is seen by
 * itself.
 */
#ifndef RHOTRACK_TOOL_SCENE_BODY_H
#define RHOTRACK_TOOL_SCENE_BODY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/random.h"
#include "scene/scene_json.h"

#define SCENE_SCATTERERS_MAX 64

/* A rectangle about the target's place, its length along the velocity. */
struct scene_body {
    double length_m, width_m;
    size_t scatterers; /* 0: the target is a point */
    double seen;       /* probability of each scatterer at each look */
    bool is_anew;      /* they are elsewhere at each look; else they stay where they are */
};

/* The key "body" of a target. */
struct scene_body scene_body_read(struct json_object *object);

/*
 * Where its scatterers are, along and across the body, metres. Its length and its width are cut
 * into as many parts as there are scatterers; each part has one, anywhere in it.
 */
void scene_body_draw(const struct scene_body *body, struct random *random,
                     double places_m[SCENE_SCATTERERS_MAX][2]);

#endif
