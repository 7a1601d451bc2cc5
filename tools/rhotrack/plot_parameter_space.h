/* SPDX-License-Identifier: MIT */
/* plot_parameter_space: the lines of the last scans' plots, as votes in the plane of rho and theta, and the tracks' own lines. */
#ifndef RHOTRACK_TOOL_PLOT_PARAMETER_SPACE_H
#define RHOTRACK_TOOL_PLOT_PARAMETER_SPACE_H

#include "parameters.h"
#include "picture.h"
#include "plot_data.h"

/*
 * Draws it: the last RHO_MAX_SCANS scans vote, as many as an initiation window can hold, the sectors of a turn being one. The files
 * with plots are read once more, for their scans; exit 2 where these have no plots.
 */
void plot_parameter_space(struct picture *picture, const struct plot_data *data,
                          const struct parameters *parameters);

#endif
