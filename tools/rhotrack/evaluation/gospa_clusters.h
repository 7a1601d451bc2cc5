/* SPDX-License-Identifier: MIT */
/*
 * gospa_clusters: parts of two sets that have nothing to do with each other. A target and a track
 * nearer than the cutoff are of one cluster, and so is all that hangs together by such pairs: the
 * best pairing of all is that of each cluster.
 */
#ifndef RHOTRACK_TOOL_GOSPA_CLUSTERS_H
#define RHOTRACK_TOOL_GOSPA_CLUSTERS_H

#include <stddef.h>

#include "evaluation/gospa.h"

/* Indices of its members, in their order; at least one of each. */
struct gospa_cluster {
    const size_t *targets, *tracks;
    size_t num_targets, num_tracks;
};

struct gospa_clusters {
    struct gospa_cluster *list;
    size_t count;
    size_t *members; /* what the list points into */
};

/*
 * The clusters, without what is near nothing. Time: sorting, and the pairs whose x differ by less
 * than the cutoff.
 */
struct gospa_clusters gospa_clusters_find(const struct gospa_place *targets, size_t num_targets,
                                          const struct gospa_place *tracks, size_t num_tracks,
                                          double cutoff_m);
void gospa_clusters_free(struct gospa_clusters *clusters);

/* Squared distance. */
double gospa_distance2(const struct gospa_place *a, const struct gospa_place *b);

#endif
