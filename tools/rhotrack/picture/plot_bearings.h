/* SPDX-License-Identifier: MIT */
/*
 * plot_bearings: a map of passive sensors: their bearings as rays, beside plots and the truth's
 * paths.
 */
#ifndef RHOTRACK_TOOL_PLOT_BEARINGS_H
#define RHOTRACK_TOOL_PLOT_BEARINGS_H

#include "picture/map.h"
#include "picture/picture.h"
#include "picture/plot_data.h"

/*
 * Draws it. With truth or plots the picture shows these and the sensors, and rays end at its edge;
 * else it shows the rays whole.
 */
void plot_bearings(struct picture *picture, const struct plot_data *data);

/* Rays and sensors for a map of other things: data blocks, then what draws them. */
void plot_bearings_put_data(const struct map *map, const struct plot_rays *rays);
void plot_bearings_draw(const struct map *map, const struct plot_rays *rays);
void plot_bearings_draw_sensors(const struct map *map, const struct plot_rays *rays);

#endif
