/* SPDX-License-Identifier: MIT */
/*
 * plot_clutter_map: draws a clutter map: its echoes, larger where they were seen more often, over
 * range rings.
 */
#ifndef RHOTRACK_TOOL_PLOT_CLUTTER_MAP_H
#define RHOTRACK_TOOL_PLOT_CLUTTER_MAP_H

#include "io/output/clutter_map_file.h"
#include "picture/gnuplot_picture_file.h"
#include "picture/picture_data.h"

/*
 * Draws the echoes over the plots of data. Range rings are about the sensors' places in the
 * parameters, or the origin where these give none.
 */
void plot_clutter(struct picture *picture, const struct clutter_echo *echoes, size_t count,
                  const struct picture_data *data, const struct parameters *parameters);

#endif
