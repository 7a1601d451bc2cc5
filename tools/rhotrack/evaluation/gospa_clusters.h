/* SPDX-License-Identifier: MIT */
/*
 * gospa_clusters: splits targets and tracks into clusters that can be paired independently. A
 * target and a track nearer than the cutoff are in one cluster, and so is everything connected by
 * such pairs: the optimal pairing of the whole is that of each cluster.
 */
#ifndef RHOTRACK_TOOL_GOSPA_CLUSTERS_H
#define RHOTRACK_TOOL_GOSPA_CLUSTERS_H

#include <stddef.h>

#include "evaluation/gospa.h"

/* Indices of the cluster's targets and tracks in ascending order; at least one of each. */
struct gospa_cluster {
    const size_t *targets, *tracks;
    size_t num_targets, num_tracks;
};

struct gospa_clusters {
    struct gospa_cluster *list;
    size_t count;
    size_t *members; /* storage of the clusters' index arrays */
};

/*
 * Finds the clusters; targets and tracks without a partner within the cutoff are in none. Time:
 * sorting, and the pairs whose x differ by less than the cutoff.
 */
struct gospa_clusters gospa_clusters_find(const struct gospa_place *targets, size_t num_targets,
                                          const struct gospa_place *tracks, size_t num_tracks,
                                          double cutoff_m);
void gospa_clusters_free(struct gospa_clusters *clusters);

/* Squared distance of two places, m^2. */
double gospa_distance2(const struct gospa_place *a, const struct gospa_place *b);

#endif
