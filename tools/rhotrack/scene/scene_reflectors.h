/* SPDX-License-Identifier: MIT */
/*
 * scene_reflectors: walls of a scene that show a target a second time, as far behind the wall as it
 * is before it.
 */
#ifndef RHOTRACK_TOOL_SCENE_REFLECTORS_H
#define RHOTRACK_TOOL_SCENE_REFLECTORS_H

#include <stdio.h>

#include "scene/scene_json.h"
#include "scene/scene_path.h"

#define SCENE_REFLECTORS_MAX 16

struct scene_reflector {
    double from_m[2], to_m[2];
    double probability; /* that a plot of a target has an image */
    bool is_told;       /* to the tracker */
};

struct scene_reflectors {
    size_t count;
    struct scene_reflector items[SCENE_REFLECTORS_MAX];
};

/* The list "reflectors" of a scene. */
struct scene_reflectors scene_reflectors_read(struct json_object *root);

/* The image that a sensor at a place sees of a target; false where the wall shows none. */
bool scene_reflector_image(const struct scene_reflector *reflector, double sensor_x_m,
                           double sensor_y_m, const struct motion *at, struct motion *image);

/* The line of an INI file; none where none is told. */
void scene_reflectors_write_settings(const struct scene_reflectors *reflectors, FILE *file);

#endif
