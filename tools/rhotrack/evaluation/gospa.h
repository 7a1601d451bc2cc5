/* SPDX-License-Identifier: MIT */
/*
 * gospa: the metrics GOSPA and OSPA between a set of targets and a set of tracks.
 *
 * A target and a track farther apart than the cutoff are never paired. GOSPA (p 2, alpha 2):
 * squared distances of the pairs, plus cutoff^2 / 2 for every target without a track and every
 * track without a target. OSPA (p 2) pairs the same way. Sources: Rahmathullah, Garcia-Fernandez
 * and Svensson, "Generalized optimal sub-pattern assignment metric", 2017; Schuhmacher, Vo and Vo,
 * "A consistent metric for performance evaluation of multi-object filters", 2008.
 */
#ifndef RHOTRACK_TOOL_GOSPA_H
#define RHOTRACK_TOOL_GOSPA_H

#include <stddef.h>

struct gospa_place {
    double x_m, y_m, z_m;
};

struct gospa {
    double squared_m2;      /* the metric's square: localisation + cutoff^2 / 2 (missed + false) */
    double localisation_m2; /* sum of the pairs' squared distances */
    size_t pairs, missed, false_tracks;
    double ospa_m;
};

/*
 * Returns the metric of the optimal pairing, and fills track_of[target] (unless NULL) with the
 * index of the paired track or -1. Time: that of sorting where targets and tracks are far apart
 * compared with the cutoff; grows with the cube of the largest cluster (targets and tracks
 * connected by distances below the cutoff).
 */
struct gospa gospa_compare(const struct gospa_place *targets, size_t num_targets,
                           const struct gospa_place *tracks, size_t num_tracks, double cutoff_m,
                           int *track_of);

#endif
