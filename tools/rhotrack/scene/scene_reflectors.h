/* SPDX-License-Identifier: MIT */
/*
 * scene_reflectors: walls of a simulated scene that reflect: a sensor sees a mirror image of a
 * target behind the wall.
 */
#ifndef RHOTRACK_TOOL_SCENE_REFLECTORS_H
#define RHOTRACK_TOOL_SCENE_REFLECTORS_H

#include <stdio.h>

#include "scene/json_value_reader.h"
#include "scene/scene_path.h"

#define SCENE_REFLECTORS_MAX 16

struct scene_reflector {
    double from_m[2], to_m[2];
    double probability; /* probability that a plot of a target has an image */
    bool is_told;       /* the wall is written to the tracker's settings */
};

struct scene_reflectors {
    size_t count;
    struct scene_reflector items[SCENE_REFLECTORS_MAX];
};

/* Reads the list "reflectors" of a scene file. */
struct scene_reflectors scene_reflectors_read(struct json_object *root);

/*
 * Mirror image of a target's motion that a sensor sees; false where the sensor sees none: target
 * and sensor are on different sides, or the path misses the wall.
 */
bool scene_reflector_image(const struct scene_reflector *reflector, double sensor_x_m,
                           double sensor_y_m, const struct motion *at, struct motion *image);

/* Writes the line "reflectors" of an INI file; nothing where no wall is told to the tracker. */
void scene_reflectors_write_told(const struct scene_reflectors *reflectors, FILE *file);

#endif
