/* SPDX-License-Identifier: MIT */
/*
 * plot_parameter_space: draws the Hough parameter space (rho, theta): the votes of the last scans'
 * plots, and the tracks' own lines.
 */
#ifndef RHOTRACK_TOOL_PLOT_PARAMETER_SPACE_H
#define RHOTRACK_TOOL_PLOT_PARAMETER_SPACE_H

#include "io/turns/merged_sectors.h"
#include "picture/gnuplot_picture_file.h"
#include "picture/picture_data.h"
#include "settings/parameters.h"

/*
 * Reads the scans that vote: the last `scans`, at most RHO_MAX_SCANS (the largest initiation
 * window); the sectors of a turn count as one. Reads the files with plots a second time; without a
 * column sensor_id all plots are sensor 0's. Exits with 2, before a picture is begun, where there
 * are no plots or rows are refused. The caller frees the result with revolutions_free.
 */
struct revolutions plot_parameter_space_read(const struct picture_data *data,
                                             const struct parameters *parameters, size_t scans);

/* Draws the votes of the scans' plots, and the lines of the tracks in data. */
void plot_hough_votes(struct picture *picture, const struct picture_data *data,
                      const struct revolutions *revolutions);

#endif
