/* SPDX-License-Identifier: MIT */
#include "evaluation/gospa_clusters.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/common.h"

double gospa_distance2(const struct gospa_place *a, const struct gospa_place *b)
{
    double dx = a->x_m - b->x_m, dy = a->y_m - b->y_m, dz = a->z_m - b->z_m;
    return dx * dx + dy * dy + dz * dz;
}

/* Root of the tree that the node belongs to; shortens the path to it (union-find). */
static size_t root_of(size_t *parent, size_t node)
{
    while (parent[node] != node) {
        parent[node] = parent[parent[node]];
        node = parent[node];
    }
    return node;
}

static void join_trees(size_t *parent, size_t a, size_t b)
{
    size_t root_a = root_of(parent, a), root_b = root_of(parent, b);
    if (root_a < root_b) {
        parent[root_b] = root_a;
    } else {
        parent[root_a] = root_b;
    }
}

struct sorted {
    double x_m;
    size_t index;
};

static int by_x(const void *a, const void *b)
{
    const struct sorted *one = a, *other = b;
    return one->x_m < other->x_m ? -1 : one->x_m > other->x_m;
}

static struct sorted *sort_places_by_x(const struct gospa_place *places, size_t count)
{
    struct sorted *sorted = must_calloc(count, sizeof *sorted);
    for (size_t i = 0; i < count; i++) {
        sorted[i] = (struct sorted){places[i].x_m, i};
    }
    qsort(sorted, count, sizeof *sorted, by_x);
    return sorted;
}

/* Joins the trees of every target and track nearer than the cutoff, by a sweep along x. */
static void join_near_pairs(size_t *parent, const struct gospa_place *targets, size_t num_targets,
                            const struct gospa_place *tracks, size_t num_tracks, double cutoff_m)
{
    struct sorted *target = sort_places_by_x(targets, num_targets);
    struct sorted *track = sort_places_by_x(tracks, num_tracks);
    size_t first = 0;
    for (size_t i = 0; i < num_targets; i++) {
        while (first < num_tracks && target[i].x_m - track[first].x_m >= cutoff_m) {
            first++;
        }
        for (size_t j = first; j < num_tracks && track[j].x_m - target[i].x_m < cutoff_m; j++) {
            if (gospa_distance2(&targets[target[i].index], &tracks[track[j].index]) <
                cutoff_m * cutoff_m) {
                join_trees(parent, target[i].index, num_targets + track[j].index);
            }
        }
    }
    free(target);
    free(track);
}

/*
 * Offset at which the members of each root's cluster begin in one list of all nodes; the last entry
 * is the list's length.
 */
static size_t *offsets_by_root(size_t *parent, size_t nodes)
{
    size_t *begin = must_calloc(nodes + 1, sizeof *begin);
    for (size_t node = 0; node < nodes; node++) {
        begin[root_of(parent, node) + 1]++;
    }
    for (size_t node = 0; node < nodes; node++) {
        begin[node + 1] += begin[node];
    }
    return begin;
}

static struct gospa_clusters list_clusters(size_t *parent, size_t num_targets, size_t num_tracks)
{
    size_t nodes = num_targets + num_tracks;
    struct gospa_clusters clusters = {
        .list = must_calloc(num_targets, sizeof *clusters.list),
        .members = must_calloc(nodes, sizeof *clusters.members),
    };
    size_t *begin = offsets_by_root(parent, nodes), *filled = must_calloc(nodes, sizeof *filled);
    size_t *targets_of = must_calloc(nodes, sizeof *targets_of);
    for (size_t node = 0; node < nodes; node++) {
        size_t root = root_of(parent, node);
        bool is_target = node < num_targets;
        clusters.members[begin[root] + filled[root]++] = is_target ? node : node - num_targets;
        targets_of[root] += is_target;
    }
    /*
     * join_trees makes the smallest node the root: a cluster with both kinds has a target as root
     */
    for (size_t root = 0; root < num_targets; root++) {
        if (filled[root] > targets_of[root]) {
            clusters.list[clusters.count++] = (struct gospa_cluster){
                .targets = &clusters.members[begin[root]],
                .tracks = &clusters.members[begin[root] + targets_of[root]],
                .num_targets = targets_of[root],
                .num_tracks = filled[root] - targets_of[root],
            };
        }
    }
    free(begin);
    free(filled);
    free(targets_of);
    return clusters;
}

struct gospa_clusters gospa_clusters_find(const struct gospa_place *targets, size_t num_targets,
                                          const struct gospa_place *tracks, size_t num_tracks,
                                          double cutoff_m)
{
    size_t *parent = must_calloc(num_targets + num_tracks, sizeof *parent);
    for (size_t node = 0; node < num_targets + num_tracks; node++) {
        parent[node] = node;
    }
    join_near_pairs(parent, targets, num_targets, tracks, num_tracks, cutoff_m);
    struct gospa_clusters clusters = list_clusters(parent, num_targets, num_tracks);
    free(parent);
    return clusters;
}

void gospa_clusters_free(struct gospa_clusters *clusters)
{
    free(clusters->list);
    free(clusters->members);
    *clusters = (struct gospa_clusters){0};
}
