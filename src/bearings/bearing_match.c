/* SPDX-License-Identifier: MIT */
/*
 * bearing_match: the bearing of a look that is nearest to a state, and how well all
 * bearings agree with the state. Most of a search's time is spent here.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"

#define N RHO_PASSIVE_STATES

static inline float floored_sigma_rad(const struct rho_passive_search *search,
                                      const struct rho_batch_bearing *bearing)
{
    return bearing->sigma_rad > search->sigma_min_rad ? bearing->sigma_rad : search->sigma_min_rad;
}

static inline float floored_sigma_slope(const struct rho_passive_search *search,
                                        const struct rho_batch_bearing *bearing)
{
    return rho_larger(bearing->sigma_slope, search->sigma_min_rad);
}

/* Bin of a direction, counted along the diamond |x| + |y| = 1, which needs no arctangent. */
static unsigned direction_bin(float x, float y)
{
    float size_x = rho_magnitude(x), size_y = rho_magnitude(y);
    /* direction along the diamond: -1 .. 1 .. 3 from south, counter-clockwise */
    float round = y / (size_x + size_y);
    round = x < 0.0f ? 3.0f - round : 1.0f + round;
    return (unsigned)(round * (0.25f * (float)RHO_PASSIVE_BINS)) % RHO_PASSIVE_BINS;
}

void rho_passive_mark_directions(struct rho_passive_search *search)
{
    const float rounding_rad = 1.0e-5f; /* bound of the rounding error of a direction */
    struct rho_passive *passive = search->passive;
    memset(passive->nearby, 0, sizeof passive->nearby);
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            rho_bearing_set *bins = passive->nearby[k][s];
            for (unsigned i = 0; i < passive->batch.num_bearings[k][s]; i++) {
                const struct rho_batch_bearing *at = &passive->batch.bearings[k][s][i];
                float sine = MATCH_SIGMAS * floored_sigma_rad(search, at) + rounding_rad;
                float cosine = sine < 1.0f ? rho_sqrt(1.0f - sine * sine) : -rounding_rad;
                /* at most a right angle: positions behind the sensor never match */
                sine = sine < 1.0f ? sine : 1.0f;
                unsigned bin = direction_bin(at->cosine * cosine + at->sine * sine,
                                             at->sine * cosine - at->cosine * sine);
                unsigned last = direction_bin(at->cosine * cosine - at->sine * sine,
                                              at->sine * cosine + at->cosine * sine);
                const rho_bearing_set bit = (rho_bearing_set)((rho_bearing_set)1 << i);
                for (; bin != last; bin = (bin + 1u) % RHO_PASSIVE_BINS) {
                    bins[bin] = (rho_bearing_set)(bins[bin] | bit);
                }
                bins[last] = (rho_bearing_set)(bins[last] | bit);
            }
        }
    }
}

/* Height that the slope of a bearing tells at the state's range, above the state's. */
static inline float height_above_m(const struct rho_batch_bearing *bearing,
                                   struct rho_passive_offset offset)
{
    return bearing->slope * rho_sqrt(rho_passive_squared_range_m2(offset)) - offset.z_m;
}

/* A state compared with a bearing of a look, index from 0. */
static inline struct rho_passive_match match_with(const struct rho_passive_search *search,
                                                  const struct rho_batch_bearing *bearings,
                                                  int index, struct rho_passive_offset offset)
{
    const struct rho_batch_bearing *bearing = &bearings[index];
    struct rho_passive_match match = {.bearing = index,
                                      .offset = offset,
                                      .cross_range_m =
                                          bearing->sine * offset.x_m - bearing->cosine * offset.y_m,
                                      .sigma_rad = floored_sigma_rad(search, bearing)};
    if (bearing->sigma_slope > 0.0f) {
        match.above_m = height_above_m(bearing, offset);
        match.sigma_slope = floored_sigma_slope(search, bearing);
    }
    return match;
}

/* The bearing of a look that is nearest to an offset. */
struct nearest {
    int bearing; /* -1: none within MATCH_SIGMAS */
    float share; /* its squared residual, 1 at MATCH_SIGMAS */
};

/*
 * Of the bearings that may match. The sine of the residual (cross range / range) stands for the
 * angle: this needs neither arctangent nor square root. A slope's residual is scaled to count as
 * one of the bearing.
 */
static inline struct nearest find_nearest(const struct rho_passive_search *search, unsigned scan,
                                          unsigned sensor, struct rho_passive_offset offset,
                                          int matching)
{
    const struct rho_passive *passive = search->passive;
    const unsigned most_claimed = (unsigned)matching & RHO_PASSIVE_ALSO_CLAIMED;
    const int by_slope = search->has_slopes && ((unsigned)matching & RHO_PASSIVE_BY_SLOPE);
    const struct rho_batch_bearing *bearing = passive->batch.bearings[scan][sensor];
    const uint8_t *is_claimed = passive->is_claimed[scan][sensor];
    const float range2_m2 = rho_passive_squared_range_m2(offset);
    const float reach_m2 = rho_square(MATCH_SIGMAS) * range2_m2;
    const rho_bearing_set *nearby = passive->nearby[scan][sensor]; /* within MATCH_SIGMAS, by bin */
    rho_bearing_set left =
        range2_m2 > 1.0f && range2_m2 < 1.0e24f ? nearby[direction_bin(offset.x_m, offset.y_m)] : 0;
    struct nearest nearest = {.bearing = -1, .share = 1.0f};
    uint32_t compared = 1;
    for (int i = 0; left > 0; i++, left = (rho_bearing_set)(left >> 1)) {
        if (!(left & 1u)) {
            continue;
        }
        compared++;
        const float sigma2 = rho_square(floored_sigma_rad(search, &bearing[i]));
        float off_m2 = rho_square(bearing[i].sine * offset.x_m - bearing[i].cosine * offset.y_m);
        if (by_slope && bearing[i].sigma_slope > 0.0f) {
            off_m2 += sigma2 * rho_square(height_above_m(&bearing[i], offset) /
                                          floored_sigma_slope(search, &bearing[i]));
        }
        if (off_m2 < nearest.share * reach_m2 * sigma2 && is_claimed[i] <= most_claimed &&
            bearing[i].cosine * offset.x_m + bearing[i].sine * offset.y_m > 0.0f) {
            nearest = (struct nearest){i, off_m2 / (reach_m2 * sigma2)};
        }
    }
    rho_passive_spend(search, compared);
    return nearest;
}

struct rho_passive_match rho_passive_match_nearest(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[N], int matching)
{
    const struct rho_passive_offset offset =
        rho_passive_offset_from_sensor(search, scan, sensor, state_m);
    const int bearing = find_nearest(search, scan, sensor, offset, matching).bearing;
    if (bearing < 0) {
        return (struct rho_passive_match){.bearing = -1};
    }
    return match_with(search, search->passive->batch.bearings[scan][sensor], bearing, offset);
}

struct rho_passive_match rho_passive_match_claimed(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[N], unsigned claim)
{
    struct rho_passive_offset offset =
        rho_passive_offset_from_sensor(search, scan, sensor, state_m);
    if (claim == 0 || !(rho_passive_squared_range_m2(offset) > 1.0f)) {
        return (struct rho_passive_match){.bearing = -1};
    }
    return match_with(search, search->passive->batch.bearings[scan][sensor], (int)claim - 1,
                      offset);
}

float rho_passive_agreement(const struct rho_passive_search *search, const float state_m[N],
                            float least)
{
    const struct rho_batch *batch = &search->passive->batch;
    /* upper bound of the agreement: each look counts 1 until its bearings are compared */
    float most = (float)(batch->num_scans * batch->num_sensors);
    for (unsigned k = 0; k < batch->num_scans && most > least; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            const struct rho_passive_offset offset =
                rho_passive_offset_from_sensor(search, k, s, state_m);
            most -= find_nearest(search, k, s, offset, !search->is_second).share;
        }
    }
    return most;
}
