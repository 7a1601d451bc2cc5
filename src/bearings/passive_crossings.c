/* SPDX-License-Identifier: MIT */
/*
 * passive_crossings: phase 1 of the search. Bearings of two sensors in one scan cross; of three
 * sensors or more another one must support a crossing. Where there is no room for all, the bearings
 * of the other sensors tell which are likely.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"

/* Evidence of a crossing that another one stands for. */
#define REPEATED_NAT (-1.0e6f)

/* Two sensors in one scan. */
struct sensor_pair {
    unsigned scan, a, b;
};

/* Sigma of a target's way in this time. */
static float sigma_of_way_m(const struct rho_passive_search *search, float steps)
{
    return 0.5f * search->passive->config.v_max_mps * search->half_s * rho_magnitude(steps);
}

/*
 * Log-likelihood ratio, over a miss, of a sensor's bearing nearest to the direction of a crossing,
 * within the errors of both; the crossing claims it. Returns whether there is one.
 */
static int claim_bearing_towards(const struct rho_passive_search *search, unsigned sensor,
                                 struct rho_passive_point *point)
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
    const float spread_m2 = across / range2 + way_m * way_m;
    float least = SUPPORT_SIGMAS * SUPPORT_SIGMAS, nearest_m2 = 0.0f;
    rho_passive_spend(search, 1u + passive->batch.num_bearings[point->scan][sensor] / 4u);
    for (unsigned i = 0; i < passive->batch.num_bearings[point->scan][sensor]; i++) {
        const struct rho_batch_bearing *seen = &passive->batch.bearings[point->scan][sensor][i];
        float off_m = seen->cosine * dy_m - seen->sine * dx_m;
        float variance_m2 = spread_m2 + seen->sigma_rad * seen->sigma_rad * range2;
        if (seen->cosine * dx_m + seen->sine * dy_m > 0.0f && off_m * off_m < least * variance_m2) {
            least = off_m * off_m / variance_m2;
            nearest_m2 = variance_m2;
            point->claim[sensor] = (uint8_t)(i + 1u);
        }
    }
    if (point->claim[sensor] == 0) {
        return 0;
    }
    point->evidence_nat += search->hit_nat - search->miss_nat -
                           0.5f * (RHO_LOG_TWO_PI + least + rho_log(nearest_m2 / range2));
    return 1;
}

static int is_at_place_of(const struct rho_passive_look *look, const struct rho_passive_look *other)
{
    return rho_square(look->x_m - other->x_m) + rho_square(look->y_m - other->y_m) <
           rho_square(RHO_CROSSING_BASE_MIN_M);
}

/*
 * Claims the bearings of other sensors towards a crossing. Returns whether they are enough: in the
 * first pass, with three sensors or more, all but one of those besides the pair that looked, and at
 * least one, must have one, from places of their own.
 */
static int find_support(const struct rho_passive_search *search, const struct sensor_pair *pair,
                        struct rho_passive_point *point)
{
    const struct rho_batch *batch = &search->passive->batch;
    const struct rho_passive_look *at = search->at[point->scan];
    unsigned others = 0, support = 0;
    for (unsigned s = 0; s < batch->num_sensors; s++) {
        if (batch->was_seen[point->scan][s] && s != pair->a && s != pair->b) {
            const unsigned is_apart =
                !is_at_place_of(&at[s], &at[pair->a]) && !is_at_place_of(&at[s], &at[pair->b]);
            others += is_apart;
            support += is_apart & (unsigned)claim_bearing_towards(search, s, point);
        }
    }
    return batch->num_sensors < 3 || search->is_second ||
           support >= (others > 2 ? others - 1u : 1u);
}

static int is_less_likely(const struct rho_passive_point *a, const struct rho_passive_point *b)
{
    return a->evidence_nat < b->evidence_nat ||
           (!(a->evidence_nat > b->evidence_nat) &&
            rho_passive_uncertainty_m2(a) > rho_passive_uncertainty_m2(b));
}

/*
 * Adds a crossing. Beyond the room of its row the least likely one goes, and before it a crossing
 * whose bearings are all those of a more certain one: such crossings are one place.
 */
static void store_crossing(struct rho_passive_search *search, struct rho_passive_point *point)
{
    struct rho_passive *passive = search->passive;
    uint32_t least = search->row_begin;
    rho_passive_spend(search, (passive->num_points - search->row_begin) / 16u);
    for (uint32_t i = search->row_begin; i < passive->num_points; i++) {
        struct rho_passive_point *other = &passive->points[i];
        if (memcmp(other->claim, point->claim, sizeof point->claim) == 0) {
            const int is_better =
                rho_passive_uncertainty_m2(point) < rho_passive_uncertainty_m2(other);
            struct rho_passive_point *repeated = is_better ? other : point;
            repeated->evidence_nat = rho_smaller(repeated->evidence_nat, REPEATED_NAT);
        }
        least = is_less_likely(other, &passive->points[least]) ? i : least;
    }
    if (passive->num_points < search->row_limit) {
        passive->points[passive->num_points++] = *point;
        return;
    }
    const int is_repeated = !(point->evidence_nat > REPEATED_NAT) ||
                            !(passive->points[least].evidence_nat > REPEATED_NAT);
    passive->work.points_dropped = rho_count(passive->work.points_dropped, !is_repeated);
    if (is_less_likely(&passive->points[least], point)) {
        passive->points[least] = *point;
    }
}

/* A bearing's sigma at a crossing, with the way of the target between the two looks. */
static float sigma_with_way_rad(float sigma_rad, float way_m, float range_m)
{
    const float way_rad = way_m / rho_larger(range_m, way_m);
    return rho_sqrt(sigma_rad * sigma_rad + way_rad * way_rad);
}

/*
 * Where the rays of two bearings meet, by their cosines and sines: the base's cross product with a
 * ray is the other's range times the sine of the angle between them. Returns 0 where they do not,
 * or where that tells no range.
 */
static int find_crossing(const struct rho_passive_search *search, const struct sensor_pair *pair,
                         struct rho_passive_point *point)
{
    const struct rho_passive_look *from = &search->at[pair->scan][pair->a];
    const struct rho_passive_look *to = &search->at[pair->scan][pair->b];
    const struct rho_batch_bearing *a = rho_passive_bearing_of(search, point, pair->a);
    const struct rho_batch_bearing *b = rho_passive_bearing_of(search, point, pair->b);
    const float most_m = search->passive->config.range_max_m;
    const float dx_m = to->x_m - from->x_m, dy_m = to->y_m - from->y_m;
    const float sine = a->cosine * b->sine - a->sine * b->cosine;
    const float over_a_m = dx_m * b->sine - dy_m * b->cosine;
    const float over_b_m = dx_m * a->sine - dy_m * a->cosine;
    const float side = sine < 0.0f ? -1.0f : 1.0f, reach_m = side * sine * most_m;
    if (!(side * over_a_m > 0.0f && side * over_b_m > 0.0f && side * over_a_m <= reach_m &&
          side * over_b_m <= reach_m)) {
        return 0;
    }
    const float range_a_m = over_a_m / sine, range_b_m = over_b_m / sine;
    const float way_m = 0.5f * sigma_of_way_m(search, from->step - to->step);
    const struct rho_crossing_ray ray_a = {a->cosine, a->sine, range_a_m,
                                           sigma_with_way_rad(a->sigma_rad, way_m, range_a_m)};
    const struct rho_crossing_ray ray_b = {b->cosine, b->sine, range_b_m,
                                           sigma_with_way_rad(b->sigma_rad, way_m, range_b_m)};
    const float tells_m = RANGE_SHARE * rho_larger(range_a_m, range_b_m);
    float covariance_m2[3];
    rho_crossing_covariance(&ray_a, &ray_b, covariance_m2);
    point->x_m = from->x_m + range_a_m * a->cosine;
    point->y_m = from->y_m + range_a_m * a->sine;
    point->xx_m2 = covariance_m2[0];
    point->xy_m2 = covariance_m2[1];
    point->yy_m2 = covariance_m2[2];
    return rho_passive_uncertainty_m2(point) < tells_m * tells_m;
}

/* Crosses two bearings, and stores a crossing that tells a range and has support. */
static int cross_bearings(struct rho_passive_search *search, const struct sensor_pair *pair,
                          unsigned index_a, unsigned index_b)
{
    struct rho_passive_point point = {.scan = (uint8_t)pair->scan,
                                      .sensors = (uint8_t)(8u * pair->a + pair->b)};
    point.claim[pair->a] = (uint8_t)(index_a + 1u);
    point.claim[pair->b] = (uint8_t)(index_b + 1u);
    if (!find_crossing(search, pair, &point) || !find_support(search, pair, &point)) {
        return 0;
    }
    store_crossing(search, &point);
    return 1;
}

static void cross_pair(struct rho_passive_search *search, const struct sensor_pair *pair)
{
    struct rho_passive *passive = search->passive;
    struct rho_passive_work *work = &passive->work;
    const uint8_t *claimed_a = passive->is_claimed[pair->scan][pair->a];
    const uint8_t *claimed_b = passive->is_claimed[pair->scan][pair->b];
    const uint8_t *num = passive->batch.num_bearings[pair->scan];
    const unsigned most = !search->is_second; /* later unclaimed bearings alone are crossed */
    for (unsigned i = 0; i < num[pair->a]; i++) {
        if (!rho_passive_has_work(search)) {
            work->points_dropped = rho_count(work->points_dropped, 1);
            continue;
        }
        rho_passive_spend(search, num[pair->b]);
        for (unsigned j = 0; j < num[pair->b]; j++) {
            if (claimed_a[i] <= most && claimed_b[j] <= most) {
                const unsigned is_ghost = !cross_bearings(search, pair, i, j);
                work->crossings = rho_count(work->crossings, !search->is_second);
                work->ghosts = rho_count(work->ghosts, !search->is_second && is_ghost);
            }
        }
    }
}

/* The most crossings that a row may have. */
static uint32_t count_pairs(const struct rho_batch *batch, unsigned scan)
{
    uint32_t bearings = 0, pairs = 0;
    for (unsigned s = 0; s < batch->num_sensors; s++) {
        pairs += bearings * batch->num_bearings[scan][s];
        bearings += batch->num_bearings[scan][s];
    }
    return pairs;
}

void rho_passive_find_crossings(struct rho_passive_search *search)
{
    const struct rho_batch *batch = &search->passive->batch;
    uint32_t left = 0;
    for (unsigned scan = 0; scan < batch->num_scans; scan++) {
        left += count_pairs(batch, scan);
    }
    search->passive->num_points = 0;
    for (unsigned n = 0; n < batch->num_scans; n++) {
        /* the newest row, the oldest, the next ones: what work lacks is of the middle */
        const unsigned scan = n % 2u == 0 ? batch->num_scans - 1u - n / 2u : n / 2u;
        const struct rho_passive_look *at = search->at[scan];
        search->row_begin = search->passive->num_points;
        /* an even share of the room, and what the rows that follow cannot need */
        const uint32_t room = RHO_MAX_PASSIVE_POINTS - search->row_begin;
        left -= count_pairs(batch, scan);
        const uint32_t even = room / (batch->num_scans - n), spare = room > left ? room - left : 0;
        search->row_limit = search->row_begin + (spare > even ? spare : even);
        for (unsigned a = 0; a + 1u < batch->num_sensors; a++) {
            for (unsigned b = a + 1u; b < batch->num_sensors; b++) {
                const struct sensor_pair pair = {.scan = scan, .a = a, .b = b};
                if (!is_at_place_of(&at[a], &at[b])) { /* sensors at one place have no base */
                    cross_pair(search, &pair);
                }
            }
        }
    }
}
