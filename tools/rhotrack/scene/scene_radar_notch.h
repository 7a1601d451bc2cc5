/* SPDX-License-Identifier: MIT */
/*
 * scene_radar_notch: the Doppler notch of a simulated radar: it is blind at range rates near
 * zero, which its clutter filter removes, and near multiples of its blind speed.
 */
#ifndef RHOTRACK_TOOL_SCENE_RADAR_NOTCH_H
#define RHOTRACK_TOOL_SCENE_RADAR_NOTCH_H

#include <stdio.h>

#include "scene/json_value_reader.h"

struct scene_notch {
    double mps;       /* half width of the notch; 0: no notch */
    double pd;        /* largest probability of detection within the notch */
    double blind_mps; /* blind speed; 0: the only notch is at zero */
};

/* Reads notch_mps, notch_pd and blind_speed_mps of a radar. */
struct scene_notch scene_notch_read(struct json_object *object);

/* Reads notch_mps and blind_speed_mps as told to the tracker; those missing are the radar's own. */
struct scene_notch scene_notch_read_told(struct json_object *object, struct scene_notch own);

/* Probability of detection at a range rate: pd, reduced within the notch. */
double scene_notch_pd(const struct scene_notch *notch, double range_rate_mps, double pd);

/* Writes the notch as lines of a sensor's INI section; none without a notch. */
void scene_notch_write_settings(const struct scene_notch *notch, FILE *file);

#endif
