/* SPDX-License-Identifier: MIT */
/*
 * passive_crossings: phase 1 of the search. Bearings of two sensors in one scan cross; crossings
 * that must be ghosts are pruned, and of three sensors or more another one must support a crossing.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"
#include "rhotrack/types.h"

/* The unclaimed bearings of two sensors in one scan, with their indices in the batch. */
struct sensor_pair {
    unsigned scan, a, b;
    unsigned num_a, num_b;
    float bearings_a_rad[RHO_MAX_BEARINGS], bearings_b_rad[RHO_MAX_BEARINGS];
    uint8_t index_a[RHO_MAX_BEARINGS], index_b[RHO_MAX_BEARINGS];
};

/* Collects a sensor's bearings in a scan, in the second pass only unclaimed ones. */
static unsigned collect_bearings(const struct rho_passive_search *search, unsigned scan,
                                 unsigned sensor, float *bearings_rad, uint8_t *index)
{
    const struct rho_passive *passive = search->passive;
    unsigned count = 0;
    for (unsigned i = 0; i < passive->batch.num_bearings[scan][sensor]; i++) {
        if (passive->is_claimed[scan][sensor][i] <= !search->is_second) {
            index[count] = (uint8_t)i;
            bearings_rad[count++] = passive->batch.bearings[scan][sensor][i].bearing_rad;
        }
    }
    return count;
}

/* Sigma of a target's way in this time. */
static float sigma_of_way_m(const struct rho_passive_search *search, float steps)
{
    return 0.5f * search->passive->config.v_max_mps * search->half_s * rho_magnitude(steps);
}

/* Whether a sensor has a bearing towards the crossing, within the errors of both. */
static int has_bearing_towards(const struct rho_passive_search *search, unsigned sensor,
                               const struct rho_passive_point *point)
{
    const struct rho_passive *passive = search->passive;
    const struct rho_passive_look *at = &search->at[point->scan][sensor];
    float dx_m = point->x_m - at->x_m, dy_m = point->y_m - at->y_m;
    float range2 = dx_m * dx_m + dy_m * dy_m;
    if (!(range2 > 1.0f)) {
        return 0;
    }
    /* variance of the crossing across the line of sight, times the squared range */
    float across =
        point->xx_m2 * dy_m * dy_m - 2.0f * point->xy_m2 * dx_m * dy_m + point->yy_m2 * dx_m * dx_m;
    const float way_m = sigma_of_way_m(search, at->step - rho_passive_crossing_step(search, point));
    for (unsigned i = 0; i < passive->batch.num_bearings[point->scan][sensor]; i++) {
        const struct rho_batch_bearing *seen = &passive->batch.bearings[point->scan][sensor][i];
        float off_m = seen->cosine * dy_m - seen->sine * dx_m;
        float variance_m2 =
            across / range2 + seen->sigma_rad * seen->sigma_rad * range2 + way_m * way_m;
        if (seen->cosine * dx_m + seen->sine * dy_m > 0.0f &&
            off_m * off_m < SUPPORT_SIGMAS * SUPPORT_SIGMAS * variance_m2) {
            return 1;
        }
    }
    return 0;
}

/*
 * In the first pass, with three sensors or more: all but one of the sensors besides the pair that
 * looked, and at least one, must have a bearing towards the crossing.
 */
static int is_supported(const struct rho_passive_search *search, const struct sensor_pair *pair,
                        const struct rho_passive_point *point)
{
    unsigned num_sensors = search->passive->batch.num_sensors, support = 0;
    if (num_sensors < 3 || search->is_second) {
        return 1;
    }
    for (unsigned s = 0; s < num_sensors; s++) {
        support += s != pair->a && s != pair->b && has_bearing_towards(search, s, point);
    }
    return support >= (num_sensors > 4 ? num_sensors - 3u : 1u);
}

/*
 * Adds a crossing; a full list replaces its least certain crossing if the new one is more certain.
 * The index of the least certain one is kept until the list changes.
 */
static void store_crossing(struct rho_passive_search *search, const struct rho_passive_point *point)
{
    struct rho_passive *passive = search->passive;
    if (passive->num_points < RHO_MAX_PASSIVE_POINTS) {
        passive->points[passive->num_points++] = *point;
        search->worst_point = passive->num_points;
        return;
    }
    if (search->worst_point == passive->num_points) {
        search->worst_point = 0;
        for (uint32_t i = 1; i < passive->num_points; i++) {
            if (rho_passive_uncertainty_m2(&passive->points[i]) >
                rho_passive_uncertainty_m2(&passive->points[search->worst_point])) {
                search->worst_point = i;
            }
        }
    }
    passive->work.points_dropped = rho_count(passive->work.points_dropped, 1);
    if (rho_passive_uncertainty_m2(point) <
        rho_passive_uncertainty_m2(&passive->points[search->worst_point])) {
        passive->points[search->worst_point] = *point;
        search->worst_point = passive->num_points;
    }
}

/* A bearing's sigma at a crossing, with the way of the target between the two looks. */
static float sigma_with_way_rad(float sigma_rad, float way_m, float range_m)
{
    const float way_rad = way_m / rho_larger(range_m, way_m);
    return rho_sqrt(sigma_rad * sigma_rad + way_rad * way_rad);
}

/* Crosses two sensors' bearings in one scan, and stores crossings that have support. */
static void cross_pair_in_scan(struct rho_passive_search *search, const struct sensor_pair *pair,
                               const struct rho_crossing_base *base)
{
    struct rho_passive *passive = search->passive;
    struct rho_ghost_matrix matrix;
    const float steps = search->at[pair->scan][pair->a].step - search->at[pair->scan][pair->b].step;
    const float way_m = 0.5f * sigma_of_way_m(search, steps);
    if (rho_ghost_fill(&matrix, base, pair->bearings_a_rad, pair->num_a, pair->bearings_b_rad,
                       pair->num_b, passive->config.range_max_m) != RHO_OK) {
        return; /* cannot fail: bearings were checked when they were pushed */
    }
    rho_ghost_prune(&matrix, passive->config.rule);
    for (unsigned i = 0; i < pair->num_a; i++) {
        for (unsigned j = 0; j < pair->num_b; j++) {
            int is_ghost = matrix.reason[i][j] != RHO_GHOST_KEPT;
            if (!search->is_second) {
                passive->work.crossings = rho_count(passive->work.crossings, 1);
                passive->work.ghosts = rho_count(passive->work.ghosts, (unsigned)is_ghost);
            }
            const struct rho_batch_bearing *a =
                &passive->batch.bearings[pair->scan][pair->a][pair->index_a[i]];
            const struct rho_batch_bearing *b =
                &passive->batch.bearings[pair->scan][pair->b][pair->index_b[j]];
            struct rho_crossing crossing;
            float covariance_m2[3];
            if (is_ghost ||
                rho_crossing_find(base, a->bearing_rad, b->bearing_rad, passive->config.range_max_m,
                                  &crossing) != RHO_CROSSING_MEETS) {
                continue;
            }
            rho_crossing_covariance(&crossing, a->bearing_rad, b->bearing_rad,
                                    sigma_with_way_rad(a->sigma_rad, way_m, crossing.range_a_m),
                                    sigma_with_way_rad(b->sigma_rad, way_m, crossing.range_b_m),
                                    covariance_m2);
            struct rho_passive_point point = {.x_m = crossing.x_m,
                                              .y_m = crossing.y_m,
                                              .xx_m2 = covariance_m2[0],
                                              .xy_m2 = covariance_m2[1],
                                              .yy_m2 = covariance_m2[2],
                                              .scan = (uint8_t)pair->scan,
                                              .sensors = (uint8_t)(8u * pair->a + pair->b),
                                              .bearing = {pair->index_a[i], pair->index_b[j]}};
            const float tells_m =
                RANGE_SHARE * rho_larger(crossing.range_a_m, crossing.range_b_m);
            if (rho_passive_uncertainty_m2(&point) < tells_m * tells_m &&
                is_supported(search, pair, &point)) {
                store_crossing(search, &point);
            }
        }
    }
}

static void cross_pair(struct rho_passive_search *search, unsigned a, unsigned b)
{
    for (unsigned scan = 0; scan < search->passive->batch.num_scans; scan++) {
        const struct rho_passive_look *at = search->at[scan];
        struct sensor_pair pair = {.scan = scan, .a = a, .b = b};
        struct rho_crossing_base base;
        pair.num_a = collect_bearings(search, scan, a, pair.bearings_a_rad, pair.index_a);
        pair.num_b = collect_bearings(search, scan, b, pair.bearings_b_rad, pair.index_b);
        /* sensors at one place have no base */
        if (rho_crossing_set_base(&base, at[a].x_m, at[a].y_m, at[b].x_m, at[b].y_m) == RHO_OK) {
            cross_pair_in_scan(search, &pair, &base);
        }
    }
}

void rho_passive_find_crossings(struct rho_passive_search *search)
{
    search->passive->num_points = 0;
    for (unsigned a = 0; a + 1u < search->passive->batch.num_sensors; a++) {
        for (unsigned b = a + 1u; b < search->passive->batch.num_sensors; b++) {
            cross_pair(search, a, b);
        }
    }
}
