/* SPDX-License-Identifier: MIT */
/*
 * scene_notch: range rates at which a radar of a scene is blind: near zero, where its filter takes
 * off what stands, and near the multiples of its blind speed.
 */
#ifndef RHOTRACK_TOOL_SCENE_NOTCH_H
#define RHOTRACK_TOOL_SCENE_NOTCH_H

#include <stdio.h>

#include "scene/scene_json.h"

struct scene_notch {
    double mps;       /* blind so far from each of them; 0: nowhere */
    double pd;        /* there, at most */
    double blind_mps; /* blind speed; 0: zero alone */
};

/* notch_mps, notch_pd and blind_speed_mps of a radar. */
struct scene_notch scene_notch_read(struct json_object *object);

/* The same keys of its "told", but for notch_pd: the radar's own where they are not there. */
struct scene_notch scene_notch_read_told(struct json_object *object, struct scene_notch own);

/* The probability of detection of a target whose range rate is so much. */
double scene_notch_pd(const struct scene_notch *notch, double range_rate_mps, double pd);

/* Lines of a sensor in an INI file; none where there is no notch. */
void scene_notch_write_settings(const struct scene_notch *notch, FILE *file);

#endif
