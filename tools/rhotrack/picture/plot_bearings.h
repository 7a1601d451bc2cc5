/* SPDX-License-Identifier: MIT */
/*
 * plot_bearings: a map of passive sensors: their bearings as rays, beside plots and the truth's
 * paths.
 */
#ifndef RHOTRACK_TOOL_PLOT_BEARINGS_H
#define RHOTRACK_TOOL_PLOT_BEARINGS_H

#include "picture/picture.h"
#include "picture/plot_data.h"

/*
 * Draws it. With truth or plots the picture shows these and the sensors, and rays end at its edge;
 * else it shows the rays whole.
 */
void plot_bearings(struct picture *picture, const struct plot_data *data);

#endif
