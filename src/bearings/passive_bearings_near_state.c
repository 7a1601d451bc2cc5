/* SPDX-License-Identifier: MIT */
/*
 * passive_bearings_near_state: the bearing of a look that is nearest to a state, and how well all
 * bearings agree with the state. Most of a search's time is spent here.
 */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/types.h"

#define N RHO_PASSIVE_STATES
#define NEAR_SIGMAS 9.0f     /* bearings farther than this from the predicted bearing never match */
#define ROUNDING_RAD 1.0e-5f /* bound of the rounding error of a direction in rad */
#define FAR_M2 1.0e24f

/* ---- the nearest bearing --------------------------------------------------------------------- */

static float square(float v)
{
    return v * v;
}

static float floored_sigma_rad(const struct rho_passive_search *search,
                               const struct rho_batch_bearing *bearing)
{
    return bearing->sigma_rad > search->sigma_min_rad ? bearing->sigma_rad : search->sigma_min_rad;
}

struct rho_passive_offset rho_passive_offset_from_sensor(const struct rho_passive_search *search,
                                                         unsigned scan, unsigned sensor,
                                                         const float state_m[N])
{
    float step = search->step[scan];
    return (struct rho_passive_offset){
        .x_m = state_m[RHO_PASSIVE_X] + step * state_m[RHO_PASSIVE_DX] - search->x_m[sensor],
        .y_m = state_m[RHO_PASSIVE_Y] + step * state_m[RHO_PASSIVE_DY] - search->y_m[sensor]};
}

static float squared_range_m2(struct rho_passive_offset offset)
{
    return square(offset.x_m) + square(offset.y_m);
}

/* Bin of a direction, counted along the diamond |x| + |y| = 1, which needs no arctangent. */
static unsigned direction_bin(float x, float y)
{
    float size_x = x < 0.0f ? -x : x, size_y = y < 0.0f ? -y : y;
    /* direction along the diamond: -1 .. 1 .. 3 from south, counter-clockwise */
    float round = y / (size_x + size_y);
    round = x < 0.0f ? 3.0f - round : 1.0f + round;
    return (unsigned)(round * (0.25f * (float)RHO_PASSIVE_BINS)) % RHO_PASSIVE_BINS;
}

/* Marks the bins of all directions within NEAR_SIGMAS of a bearing. */
static void mark_bearing_directions(const struct rho_batch_bearing *bearing, float sigma_rad,
                                    uint32_t *bins)
{
    float sine = NEAR_SIGMAS * sigma_rad + ROUNDING_RAD;
    float cosine = sine < 1.0f ? rho_sqrt(1.0f - sine * sine) : -ROUNDING_RAD;
    /* at most a right angle: positions behind the sensor never match */
    sine = sine < 1.0f ? sine : 1.0f;
    unsigned bin = direction_bin(bearing->cosine * cosine + bearing->sine * sine,
                                 bearing->sine * cosine - bearing->cosine * sine);
    unsigned last = direction_bin(bearing->cosine * cosine - bearing->sine * sine,
                                  bearing->sine * cosine + bearing->cosine * sine);
    for (; bin != last; bin = (bin + 1u) % RHO_PASSIVE_BINS) {
        bins[bin / 32u] |= 1u << bin % 32u;
    }
    bins[last / 32u] |= 1u << last % 32u;
}

void rho_passive_mark_bearing_directions(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    memset(passive->directions, 0, sizeof passive->directions);
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            for (unsigned i = 0; i < passive->batch.num_bearings[k][s]; i++) {
                const struct rho_batch_bearing *bearing = &passive->batch.bearings[k][s][i];
                mark_bearing_directions(bearing, floored_sigma_rad(search, bearing),
                                        passive->directions[k][s]);
            }
        }
    }
}

/*
 * Tests the marked bins: 0 means that no bearing of the look is within NEAR_SIGMAS of the
 * direction, or that the range is 0 or far too large.
 */
static int may_have_bearing_near(const uint32_t *bins, struct rho_passive_offset offset)
{
    float size_m2 = squared_range_m2(offset);
    if (!(size_m2 > 1.0f && size_m2 < FAR_M2)) {
        return 0;
    }
    unsigned bin = direction_bin(offset.x_m, offset.y_m);
    return (int)(bins[bin / 32u] >> bin % 32u & 1u);
}

/*
 * The bearing of a look with the smallest normalised residual, within NEAR_SIGMAS. The sine of the
 * residual (cross range / range) stands for the angle, and squares are compared: this needs neither
 * arctangent nor square root.
 */
static struct rho_passive_match find_nearest_bearing(const struct rho_passive_search *search,
                                                     unsigned scan, unsigned sensor,
                                                     struct rho_passive_offset offset,
                                                     int include_claimed)
{
    const struct rho_passive *passive = search->passive;
    const struct rho_batch_bearing *bearings = passive->batch.bearings[scan][sensor];
    float least_m2 = squared_range_m2(
        /* squared cross range that is NEAR_SIGMAS for the initial sigma of 1 / NEAR_SIGMAS rad */
        offset);
    struct rho_passive_match nearest = {
        .bearing = -1, .offset = offset, .sigma_rad = 1.0f / NEAR_SIGMAS};
    for (unsigned i = 0; i < passive->batch.num_bearings[scan][sensor]; i++) {
        float cross_range_m = bearings[i].sine * offset.x_m - bearings[i].cosine * offset.y_m;
        float sigma_rad = floored_sigma_rad(search, &bearings[i]);
        if (square(cross_range_m * nearest.sigma_rad) < least_m2 * square(sigma_rad) &&
            bearings[i].cosine * offset.x_m + bearings[i].sine * offset.y_m > 0.0f &&
            (include_claimed || !passive->is_claimed[scan][sensor][i])) {
            least_m2 = square(cross_range_m);
            nearest = (struct rho_passive_match){(int)i, offset, cross_range_m, sigma_rad};
        }
    }
    return nearest;
}

struct rho_passive_match rho_passive_match_nearest(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[N], int include_claimed)
{
    struct rho_passive_offset offset =
        rho_passive_offset_from_sensor(search, scan, sensor, state_m);
    if (!may_have_bearing_near(search->passive->directions[scan][sensor], offset)) {
        return (struct rho_passive_match){.bearing = -1};
    }
    return find_nearest_bearing(search, scan, sensor, offset, include_claimed);
}

struct rho_passive_match rho_passive_match_claimed(const struct rho_passive_search *search,
                                                   unsigned scan, unsigned sensor,
                                                   const float state_m[N],
                                                   unsigned claimed_bearing_number)
{
    struct rho_passive_offset offset =
        rho_passive_offset_from_sensor(search, scan, sensor, state_m);
    if (claimed_bearing_number == 0 || !(squared_range_m2(offset) > 1.0f)) {
        return (struct rho_passive_match){.bearing = -1};
    }
    const struct rho_batch_bearing *bearing =
        &search->passive->batch.bearings[scan][sensor][claimed_bearing_number - 1u];
    return (struct rho_passive_match){(int)claimed_bearing_number - 1, offset,
                                      bearing->sine * offset.x_m - bearing->cosine * offset.y_m,
                                      floored_sigma_rad(search, bearing)};
}

float rho_passive_normalised_residual(const struct rho_passive_match *match)
{
    return match->cross_range_m / (rho_sqrt(squared_range_m2(match->offset)) * match->sigma_rad);
}

/* ---- agreement ------------------------------------------------------------------------------- */

/*
 * Marks the looks that may have a bearing near the state: bit s of is_near[k] for sensor s in scan
 * k. Returns their number; stops early once it cannot exceed `least`.
 */
static unsigned mark_looks_with_bearing_near(const struct rho_passive_search *search,
                                             const float state_m[N], float least,
                                             uint8_t is_near[RHO_MAX_PASSIVE_SCANS])
{
    const struct rho_passive *passive = search->passive;
    unsigned num_sensors = passive->batch.num_sensors;
    unsigned left = (unsigned)passive->batch.num_scans * num_sensors;
    for (unsigned k = 0; k < passive->batch.num_scans && (float)left > least; k++) {
        unsigned seen = 0;
        for (unsigned s = 0; s < num_sensors; s++) {
            unsigned is_seen = (unsigned)may_have_bearing_near(
                passive->directions[k][s], rho_passive_offset_from_sensor(search, k, s, state_m));
            seen |= is_seen << s;
            left -= 1u - is_seen;
        }
        is_near[k] = (uint8_t)seen;
    }
    return left;
}

/*
 * Agreement of the nearest bearing of one look with the state: 1 at residual 0, 0 from NEAR_SIGMAS.
 */
static float nearest_bearing_agreement_with_state(const struct rho_passive_match *nearest)
{
    float reach_m2 = squared_range_m2(nearest->offset) * square(NEAR_SIGMAS * nearest->sigma_rad);
    float share = square(nearest->cross_range_m) / reach_m2;
    return nearest->bearing >= 0 && share < 1.0f ? 1.0f - share : 0.0f;
}

float rho_passive_agreement_if_above(const struct rho_passive_search *search,
                                     const float state_m[N], float least)
{
    const struct rho_passive *passive = search->passive;
    uint8_t is_near[RHO_MAX_PASSIVE_SCANS] = {0};
    /* upper bound of the agreement: each marked look counts 1 until its bearings are compared */
    float most = (float)mark_looks_with_bearing_near(search, state_m, least, is_near);
    for (unsigned k = 0; k < passive->batch.num_scans && most > least; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            if (is_near[k] >> s & 1u) {
                struct rho_passive_match nearest = find_nearest_bearing(
                    search, k, s, rho_passive_offset_from_sensor(search, k, s, state_m),
                    !search->is_second);
                most -= 1.0f - nearest_bearing_agreement_with_state(&nearest);
            }
        }
    }
    return most;
}
