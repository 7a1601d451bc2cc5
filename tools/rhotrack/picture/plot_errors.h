/* SPDX-License-Identifier: MIT */
/*
 * plot_errors: draws the position errors of tracks over time: at each truth time, the distance of
 * each target from the track paired with it.
 */
#ifndef RHOTRACK_TOOL_PLOT_ERRORS_H
#define RHOTRACK_TOOL_PLOT_ERRORS_H

#include "picture/gnuplot_picture_file.h"
#include "picture/picture_data.h"
#include "settings/parameters.h"

struct plot_errors {
    double *error_m; /* by index of the truth's points; NAN where the target has no track */
};

/*
 * Computes the errors: moves tracks to the truth's times (alignment.h) and pairs
 * them with targets within gospa_cutoff_m. Exits with 2 where a track time is no truth time, or no
 * target has a track. Time: number of truth times multiplied by the number of rows.
 */
struct plot_errors plot_errors_find(const struct picture_data *data,
                                    const struct parameters *parameters);
void plot_errors_free(struct plot_errors *errors);

void plot_errors(struct picture *picture, const struct picture_data *data,
                 const struct plot_errors *errors);

#endif
