/* SPDX-License-Identifier: MIT */
/*
 * plot_tracks: maps of plots by time, and of tracks over plots, bearings and truth.
 */
#ifndef RHOTRACK_TOOL_PLOT_TRACKS_H
#define RHOTRACK_TOOL_PLOT_TRACKS_H

#include "picture/picture.h"
#include "picture/plot_data.h"

/* Plots, coloured by time. */
void plot_scans(struct picture *picture, const struct plot_data *data);

/*
 * Tracks with their numbers, the arrow of their last velocity and the ellipse of two sigmas about
 * their last place, the lines that they were started by, and truth, plots and bearings beneath.
 */
void plot_tracks(struct picture *picture, const struct plot_data *data);

#endif
