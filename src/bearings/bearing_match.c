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

static inline float squared_range_m2(struct rho_passive_offset offset)
{
    return rho_square(offset.x_m) + rho_square(offset.y_m);
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
    memset(passive->near, 0, sizeof passive->near);
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            rho_bearing_set *bins = passive->near[k][s];
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

/*
 * The bearings of a look that may be within MATCH_SIGMAS of the direction; none where the range is 0
 * or far too large.
 */
static rho_bearing_set bearings_near(const rho_bearing_set *bins, struct rho_passive_offset offset)
{
    float size_m2 = squared_range_m2(offset);
    return size_m2 > 1.0f && size_m2 < 1.0e24f ? bins[direction_bin(offset.x_m, offset.y_m)] : 0;
}

/* Height that the slope of a bearing tells at the state's range, above the state's. */
static inline float height_above_m(const struct rho_batch_bearing *bearing,
                                   struct rho_passive_offset offset)
{
    return bearing->slope * rho_sqrt(squared_range_m2(offset)) - offset.z_m;
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

/*
 * The bearing of a look with the smallest normalised residual, within MATCH_SIGMAS. The sine of the
 * residual (cross range / range) stands for the angle, and squares are compared: this needs neither
 * arctangent nor square root. A slope's residual is scaled to count as one of the bearing.
 */
static struct rho_passive_match find_nearest_bearing(const struct rho_passive_search *search,
                                                     unsigned scan, unsigned sensor,
                                                     struct rho_passive_offset offset, int matching)
{
    rho_bearing_set near = bearings_near(search->passive->near[scan][sensor], offset);
    const unsigned most_claimed = (unsigned)matching & RHO_PASSIVE_ALSO_CLAIMED;
    const int by_slope = search->has_slopes && ((unsigned)matching & RHO_PASSIVE_BY_SLOPE);
    const struct rho_passive *passive = search->passive;
    const struct rho_batch_bearing *bearings = passive->batch.bearings[scan][sensor];
    /* squared cross range that is MATCH_SIGMAS for the initial sigma of 1 / MATCH_SIGMAS rad */
    float least_m2 = squared_range_m2(offset), least_sigma_rad = 1.0f / MATCH_SIGMAS;
    int nearest = -1;
    for (unsigned i = 0; near > 0; i++, near = (rho_bearing_set)(near >> 1)) {
        if (!(near & 1u)) {
            continue;
        }
        float off_m2 = rho_square(bearings[i].sine * offset.x_m - bearings[i].cosine * offset.y_m);
        float sigma_rad = floored_sigma_rad(search, &bearings[i]);
        if (by_slope && bearings[i].sigma_slope > 0.0f) {
            off_m2 += rho_square(height_above_m(&bearings[i], offset) * sigma_rad /
                                 floored_sigma_slope(search, &bearings[i]));
        }
        if (off_m2 * rho_square(least_sigma_rad) < least_m2 * rho_square(sigma_rad) &&
            bearings[i].cosine * offset.x_m + bearings[i].sine * offset.y_m > 0.0f &&
            passive->is_claimed[scan][sensor][i] <= most_claimed) {
            least_m2 = off_m2;
            least_sigma_rad = sigma_rad;
            nearest = (int)i;
        }
    }
    return nearest < 0
               ? (struct rho_passive_match){.bearing = -1, .offset = offset, .sigma_rad = 1.0f}
               : match_with(search, bearings, nearest, offset);
}

struct rho_passive_match rho_passive_match_nearest(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[N], int matching)
{
    struct rho_passive_offset offset =
        rho_passive_offset_from_sensor(search, scan, sensor, state_m);
    return find_nearest_bearing(search, scan, sensor, offset, matching);
}

struct rho_passive_match rho_passive_match_claimed(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[N], unsigned claim)
{
    struct rho_passive_offset offset =
        rho_passive_offset_from_sensor(search, scan, sensor, state_m);
    if (claim == 0 || !(squared_range_m2(offset) > 1.0f)) {
        return (struct rho_passive_match){.bearing = -1};
    }
    return match_with(search, search->passive->batch.bearings[scan][sensor], (int)claim - 1,
                      offset);
}

float rho_passive_residual(const struct rho_passive_match *match)
{
    return match->cross_range_m / (rho_sqrt(squared_range_m2(match->offset)) * match->sigma_rad);
}

float rho_passive_slope_residual(const struct rho_passive_match *match)
{
    return match->sigma_slope > 0.0f
               ? match->above_m / (rho_sqrt(squared_range_m2(match->offset)) * match->sigma_slope)
               : 0.0f;
}

float rho_passive_agreement(const struct rho_passive_search *search, const float state_m[N],
                            float least)
{
    const struct rho_passive *passive = search->passive;
    unsigned num_scans = passive->batch.num_scans, num_sensors = passive->batch.num_sensors;
    uint8_t is_near[RHO_MAX_PASSIVE_SCANS] = {0}; /* bit s of look k: sensor s may see the state */
    unsigned left = num_scans * num_sensors;
    for (unsigned k = 0; k < num_scans && (float)left > least; k++) {
        unsigned seen = 0;
        for (unsigned s = 0; s < num_sensors; s++) {
            const unsigned is_seen =
                bearings_near(passive->near[k][s],
                              rho_passive_offset_from_sensor(search, k, s, state_m)) > 0;
            seen |= is_seen << s;
            left -= 1u - is_seen;
        }
        is_near[k] = (uint8_t)seen;
    }
    /* upper bound of the agreement: each marked look counts 1 until its bearings are compared */
    float most = (float)left;
    for (unsigned k = 0; k < num_scans && most > least; k++) {
        for (unsigned s = 0; s < num_sensors; s++) {
            if (!(is_near[k] >> s & 1u)) {
                continue;
            }
            struct rho_passive_match nearest = find_nearest_bearing(
                search, k, s, rho_passive_offset_from_sensor(search, k, s, state_m),
                !search->is_second);
            float reach_m2 =
                squared_range_m2(nearest.offset) * rho_square(MATCH_SIGMAS * nearest.sigma_rad);
            float share = rho_square(nearest.cross_range_m) / reach_m2;
            most -= 1.0f - (nearest.bearing >= 0 && share < 1.0f ? 1.0f - share : 0.0f);
        }
    }
    return most;
}
