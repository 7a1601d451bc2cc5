/* SPDX-License-Identifier: MIT */
#include "evaluation/gospa.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/common.h"
#include "evaluation/gospa_clusters.h"
#include "evaluation/hungarian.h"

/* The two sets that are compared, the pairing and the metric found so far. */
struct comparison {
    const struct gospa_place *targets, *tracks;
    double cutoff2_m2;
    int *track_of; /* index of the track paired with each target, -1 for none; may be NULL */
    struct gospa result;
};

static void record_assigned_pair(struct comparison *c, size_t target, size_t track)
{
    double squared_m2 = gospa_distance2(&c->targets[target], &c->tracks[track]);
    if (squared_m2 >= c->cutoff2_m2) {
        return;
    }
    c->result.pairs++;
    c->result.localisation_m2 += squared_m2;
    if (c->track_of != NULL) {
        c->track_of[target] = (int)track;
    }
}

/*
 * Matrix of squared distances, at most the cutoff squared, of all target-track pairs of the
 * cluster; the smaller side has the rows.
 */
static double *cluster_costs(const struct comparison *c, const struct gospa_cluster *cluster,
                             bool rows_are_targets)
{
    double *cost = must_calloc(cluster->num_targets * cluster->num_tracks, sizeof *cost);
    for (size_t i = 0; i < cluster->num_targets; i++) {
        for (size_t j = 0; j < cluster->num_tracks; j++) {
            size_t at =
                rows_are_targets ? i * cluster->num_tracks + j : j * cluster->num_targets + i;
            cost[at] = fmin(
                gospa_distance2(&c->targets[cluster->targets[i]], &c->tracks[cluster->tracks[j]]),
                c->cutoff2_m2);
        }
    }
    return cost;
}

/*
 * Pairs the cluster's targets and tracks at least total cost, and records the pairs within the
 * cutoff.
 */
static void pair_within_cluster(struct comparison *c, const struct gospa_cluster *cluster)
{
    bool rows_are_targets = cluster->num_targets <= cluster->num_tracks;
    size_t rows = rows_are_targets ? cluster->num_targets : cluster->num_tracks;
    size_t columns = rows_are_targets ? cluster->num_tracks : cluster->num_targets;
    double *cost = cluster_costs(c, cluster, rows_are_targets);
    size_t *column_of = must_calloc(rows, sizeof *column_of);
    hungarian_assign(rows, columns, cost, column_of);
    for (size_t row = 0; row < rows; row++) {
        record_assigned_pair(c, cluster->targets[rows_are_targets ? row : column_of[row]],
                             cluster->tracks[rows_are_targets ? column_of[row] : row]);
    }
    free(cost);
    free(column_of);
}

static double ospa_of(const struct gospa *result, size_t num_targets, size_t num_tracks,
                      double cutoff2_m2)
{
    size_t larger = num_targets > num_tracks ? num_targets : num_tracks;
    double unpaired = (double)(larger - result->pairs) * cutoff2_m2;
    return larger == 0 ? 0.0 : sqrt((result->localisation_m2 + unpaired) / (double)larger);
}

struct gospa gospa_compare(const struct gospa_place *targets, size_t num_targets,
                           const struct gospa_place *tracks, size_t num_tracks, double cutoff_m,
                           int *track_of)
{
    struct comparison c = {.targets = targets,
                           .tracks = tracks,
                           .cutoff2_m2 = cutoff_m * cutoff_m,
                           .track_of = track_of};
    struct gospa_clusters clusters =
        gospa_clusters_find(targets, num_targets, tracks, num_tracks, cutoff_m);

    for (size_t i = 0; track_of != NULL && i < num_targets; i++) {
        track_of[i] = -1;
    }
    for (size_t i = 0; i < clusters.count; i++) {
        pair_within_cluster(&c, &clusters.list[i]);
    }
    gospa_clusters_free(&clusters);
    c.result.missed = num_targets - c.result.pairs;
    c.result.false_tracks = num_tracks - c.result.pairs;
    c.result.squared_m2 = c.result.localisation_m2 +
                          0.5 * c.cutoff2_m2 * (double)(c.result.missed + c.result.false_tracks);
    c.result.ospa_m = ospa_of(&c.result, num_targets, num_tracks, c.cutoff2_m2);
    return c.result;
}
