/* SPDX-License-Identifier: MIT */
/*
 * passive_crossings: phase 1 of the search. Bearings of two sensors in one scan cross; of three
 * sensors or more another one must support a crossing.
 */
#include "passive_search.h"
#include "policy.h"

/* Two sensors in one scan. */
struct sensor_pair {
    unsigned scan, a, b;
    struct rho_crossing_base base;
};

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

static int is_at_place_of(const struct rho_passive_look *look, const struct rho_passive_look *other)
{
    return rho_square(look->x_m - other->x_m) + rho_square(look->y_m - other->y_m) <
           rho_square(RHO_CROSSING_BASE_MIN_M);
}

/*
 * In the first pass, with three sensors or more: all but one of those besides the pair that looked,
 * and at least one, must have a bearing towards the crossing, from places of their own.
 */
static int is_supported(const struct rho_passive_search *search, const struct sensor_pair *pair,
                        const struct rho_passive_point *point)
{
    const struct rho_batch *batch = &search->passive->batch;
    const struct rho_passive_look *at = search->at[point->scan];
    unsigned others = 0, support = 0;
    for (unsigned s = 0; s < batch->num_sensors && !search->is_second; s++) {
        if (batch->was_seen[point->scan][s] && !is_at_place_of(&at[s], &at[pair->a]) &&
            !is_at_place_of(&at[s], &at[pair->b])) {
            others++;
            support += (unsigned)has_bearing_towards(search, s, point);
        }
    }
    return batch->num_sensors < 3 || search->is_second ||
           support >= (others > 2 ? others - 1u : 1u);
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

/* Crosses two bearings, and stores a crossing that tells a range and has support. */
static int cross_bearings(struct rho_passive_search *search, const struct sensor_pair *pair,
                          unsigned index_a, unsigned index_b)
{
    const struct rho_passive_look *at = search->at[pair->scan];
    const struct rho_batch *batch = &search->passive->batch;
    const struct rho_batch_bearing *a = &batch->bearings[pair->scan][pair->a][index_a];
    const struct rho_batch_bearing *b = &batch->bearings[pair->scan][pair->b][index_b];
    const float way_m = 0.5f * sigma_of_way_m(search, at[pair->a].step - at[pair->b].step);
    struct rho_crossing crossing;
    float covariance_m2[3];
    if (rho_crossing_find(&pair->base, a->bearing_rad, b->bearing_rad,
                          search->passive->config.range_max_m, &crossing) != RHO_CROSSING_MEETS) {
        return 0;
    }
    rho_crossing_covariance(&crossing, a->bearing_rad, b->bearing_rad,
                            sigma_with_way_rad(a->sigma_rad, way_m, crossing.range_a_m),
                            sigma_with_way_rad(b->sigma_rad, way_m, crossing.range_b_m),
                            covariance_m2);
    const struct rho_passive_point point = {.x_m = crossing.x_m,
                                            .y_m = crossing.y_m,
                                            .xx_m2 = covariance_m2[0],
                                            .xy_m2 = covariance_m2[1],
                                            .yy_m2 = covariance_m2[2],
                                            .scan = (uint8_t)pair->scan,
                                            .sensors = (uint8_t)(8u * pair->a + pair->b),
                                            .bearing = {(uint8_t)index_a, (uint8_t)index_b}};
    const float tells_m = RANGE_SHARE * rho_larger(crossing.range_a_m, crossing.range_b_m);
    if (!(rho_passive_uncertainty_m2(&point) < tells_m * tells_m) ||
        !is_supported(search, pair, &point)) {
        return 0;
    }
    store_crossing(search, &point);
    return 1;
}

static void cross_pair(struct rho_passive_search *search, struct sensor_pair *pair)
{
    struct rho_passive *passive = search->passive;
    struct rho_passive_work *work = &passive->work;
    const uint8_t *claimed_a = passive->is_claimed[pair->scan][pair->a];
    const uint8_t *claimed_b = passive->is_claimed[pair->scan][pair->b];
    const uint8_t *num = passive->batch.num_bearings[pair->scan];
    const unsigned most = !search->is_second; /* later unclaimed bearings alone are crossed */
    for (unsigned i = 0; i < num[pair->a]; i++) {
        for (unsigned j = 0; j < num[pair->b]; j++) {
            if (claimed_a[i] <= most && claimed_b[j] <= most) {
                const unsigned is_ghost = !cross_bearings(search, pair, i, j);
                work->crossings = rho_count(work->crossings, !search->is_second);
                work->ghosts = rho_count(work->ghosts, !search->is_second && is_ghost);
            }
        }
    }
}

void rho_passive_find_crossings(struct rho_passive_search *search)
{
    const struct rho_batch *batch = &search->passive->batch;
    search->passive->num_points = 0;
    for (unsigned scan = 0; scan < batch->num_scans; scan++) {
        const struct rho_passive_look *at = search->at[scan];
        for (unsigned a = 0; a + 1u < batch->num_sensors; a++) {
            for (unsigned b = a + 1u; b < batch->num_sensors; b++) {
                struct sensor_pair pair = {.scan = scan, .a = a, .b = b};
                /* sensors at one place have no base */
                if (batch->num_bearings[scan][a] > 0 && batch->num_bearings[scan][b] > 0 &&
                    rho_crossing_set_base(&pair.base, at[a].x_m, at[a].y_m, at[b].x_m, at[b].y_m) ==
                        RHO_OK) {
                    cross_pair(search, &pair);
                }
            }
        }
    }
}
