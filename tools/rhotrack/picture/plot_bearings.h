/* SPDX-License-Identifier: MIT */
/*
 * plot_bearings: draws a map of passive sensors with their bearings as rays, plots and the
 * targets' true paths.
 */
#ifndef RHOTRACK_TOOL_PLOT_BEARINGS_H
#define RHOTRACK_TOOL_PLOT_BEARINGS_H

#include "picture/gnuplot_picture_file.h"
#include "picture/picture_data.h"
#include "picture/plan_view_map.h"

/*
 * Draws the map. With truth or plots it shows these and the sensors, and cuts the rays at its edge;
 * otherwise it shows the rays in full.
 */
void plot_bearings(struct picture *picture, const struct picture_data *data);

/*
 * Rays and sensors for another map: first the data blocks, then the clauses of the command plot
 * that draw them.
 */
void plot_bearings_write_data(const struct map *map, const struct plot_rays *rays);
void plot_bearings_draw_rays(const struct map *map, const struct plot_rays *rays);
void plot_bearings_draw_sensors(const struct map *map, const struct plot_rays *rays);

#endif
