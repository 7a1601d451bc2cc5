/* SPDX-License-Identifier: MIT */
/*
 * plot_errors: how far tracks are from targets, over time: at each of the truth's times each target
 * against the track paired with it.
 */
#ifndef RHOTRACK_TOOL_PLOT_ERRORS_H
#define RHOTRACK_TOOL_PLOT_ERRORS_H

#include "picture/picture.h"
#include "picture/plot_data.h"
#include "settings/parameters.h"

struct plot_errors {
    double *error_m; /* by row of the truth; NAN: no track */
};

/*
 * Pairs them, within gospa_cutoff_m, after tracks have been led to the truth's times
 * (time_alignment.h). Exit 2 where the truth has not such a time, and where no target has a track.
 * Cost: the truth's times, times the rows of both.
 */
struct plot_errors plot_errors_find(const struct plot_data *data,
                                    const struct parameters *parameters);
void plot_errors_free(struct plot_errors *errors);

void plot_errors(struct picture *picture, const struct plot_data *data,
                 const struct plot_errors *errors);

#endif
