/* SPDX-License-Identifier: MIT */
/*
 * plot_clutter: a clutter map as a picture: its echoes, the larger the more often they were seen,
 * over rings of range.
 */
#ifndef RHOTRACK_TOOL_PLOT_CLUTTER_H
#define RHOTRACK_TOOL_PLOT_CLUTTER_H

#include "io/output/clutter_file.h"
#include "picture/picture.h"
#include "picture/plot_data.h"

/*
 * The data's plots are drawn beneath. Rings are about the sensors, where the parameters place them,
 * else the origin.
 */
void plot_clutter(struct picture *picture, const struct clutter_echo *echoes, size_t count,
                  const struct plot_data *data, const struct parameters *parameters);

#endif
