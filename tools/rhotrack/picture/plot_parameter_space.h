/* SPDX-License-Identifier: MIT */
/*
 * plot_parameter_space: the lines of the last scans' plots, as votes in the plane of rho and theta,
 * and the tracks' own lines.
 */
#ifndef RHOTRACK_TOOL_PLOT_PARAMETER_SPACE_H
#define RHOTRACK_TOOL_PLOT_PARAMETER_SPACE_H

#include "io/turns/revolutions.h"
#include "picture/picture.h"
#include "picture/plot_data.h"
#include "settings/parameters.h"

/*
 * The scans that vote: the last `scans`, at most RHO_MAX_SCANS, which is as many as an initiation
 * window can hold, the sectors of a turn being one. The files with plots are read once more;
 * without a column sensor_id all is sensor 0's. Exit 2 where these have no plots, or are refused:
 * before a picture is begun. To be freed by revolutions_free.
 */
struct revolutions plot_parameter_space_read(const struct plot_data *data,
                                             const struct parameters *parameters, size_t scans);

/* Draws their votes, and the lines of the data's tracks. */
void plot_parameter_space(struct picture *picture, const struct plot_data *data,
                          const struct revolutions *revolutions);

#endif
