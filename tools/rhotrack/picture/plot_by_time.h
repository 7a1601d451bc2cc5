/* SPDX-License-Identifier: MIT */
/*
 * plot_by_time: draws a map of plots coloured by time, or of tracks over plots,
 * bearings and truth.
 */
#ifndef RHOTRACK_TOOL_PLOT_BY_TIME_H
#define RHOTRACK_TOOL_PLOT_BY_TIME_H

#include "picture/gnuplot_picture_file.h"
#include "picture/picture_data.h"

/* Draws a map of plots coloured by time. */
void plot_scans_coloured_by_time(struct picture *picture, const struct picture_data *data);

/*
 * Draws tracks with ids, arrows of the last velocity, two-sigma ellipses about the last position
 * and the lines that started them, over truth, plots and bearings.
 */
void plot_tracks(struct picture *picture, const struct picture_data *data);

#endif
