/* SPDX-License-Identifier: MIT */
/* passive_near: which bearing is nearest to a state, and how well all of them agree with it. */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/approx.h"
#include "rhotrack/types.h"

#define N RHO_PASSIVE_STATES
#define NEAR_SIGMAS 9.0f     /* no gate is wider */
#define ROUNDING_RAD 1.0e-5f /* more than rounding can turn a direction */
#define FAR_M2 1.0e24f

/* ---- the nearest bearing ---------------------------------------------------------------------- */

static float square(float v)
{
    return v * v;
}

static float sigma_of(const struct rho_passive_search *search,
                      const struct rho_batch_bearing *bearing)
{
    return bearing->sigma_rad > search->sigma_min_rad ? bearing->sigma_rad : search->sigma_min_rad;
}

struct rho_passive_way rho_passive_way_to(const struct rho_passive_search *search, unsigned scan,
                                          unsigned sensor, const float state_m[N])
{
    float step = search->step[scan];
    return (struct rho_passive_way){.x_m = state_m[0] + step * state_m[2] - search->x_m[sensor],
                                    .y_m = state_m[1] + step * state_m[3] - search->y_m[sensor]};
}

static float length2_m2(struct rho_passive_way way)
{
    return square(way.x_m) + square(way.y_m);
}

/* The bin of a direction: round the diamond |x| + |y| = 1, which needs no arctangent. */
static unsigned bin_of(float x, float y)
{
    float size_x = x < 0.0f ? -x : x, size_y = y < 0.0f ? -y : y;
    float round = y / (size_x + size_y); /* -1 .. 1 .. 3 from south, counter-clockwise */
    round = x < 0.0f ? 3.0f - round : 1.0f + round;
    return (unsigned)(round * (0.25f * (float)RHO_PASSIVE_BINS)) % RHO_PASSIVE_BINS;
}

/* The bins of all directions within NEAR_SIGMAS of the bearing. */
static void mark_bearing(const struct rho_batch_bearing *bearing, float sigma_rad, uint32_t *bins)
{
    float sine = NEAR_SIGMAS * sigma_rad + ROUNDING_RAD;
    float cosine = sine < 1.0f ? rho_sqrt(1.0f - sine * sine) : -ROUNDING_RAD;
    sine = sine < 1.0f ? sine : 1.0f; /* a right angle: what is behind the sensor never counts */
    unsigned bin = bin_of(bearing->cosine * cosine + bearing->sine * sine,
                          bearing->sine * cosine - bearing->cosine * sine);
    unsigned last = bin_of(bearing->cosine * cosine - bearing->sine * sine,
                           bearing->sine * cosine + bearing->cosine * sine);
    for (; bin != last; bin = (bin + 1u) % RHO_PASSIVE_BINS) {
        bins[bin / 32u] |= 1u << bin % 32u;
    }
    bins[last / 32u] |= 1u << last % 32u;
}

void rho_passive_mark_bearings(struct rho_passive_search *search)
{
    struct rho_passive *passive = search->passive;
    memset(passive->directions, 0, sizeof passive->directions);
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            for (unsigned i = 0; i < passive->batch.num_bearings[k][s]; i++) {
                const struct rho_batch_bearing *bearing = &passive->batch.bearings[k][s][i];
                mark_bearing(bearing, sigma_of(search, bearing), passive->directions[k][s]);
            }
        }
    }
}

/* False where no bearing is within NEAR_SIGMAS of the way, or it has no direction. */
static int may_be_seen(const uint32_t *bins, struct rho_passive_way way)
{
    float size_m2 = length2_m2(way);
    if (!(size_m2 > 1.0f && size_m2 < FAR_M2)) {
        return 0;
    }
    unsigned bin = bin_of(way.x_m, way.y_m);
    return (int)(bins[bin / 32u] >> bin % 32u & 1u);
}

/*
 * Angles are small beside 1 wherever they matter: sines, the distance of the place from a bearing's ray over the range,
 * stand for them, so that no arctangent is needed; and their squares are compared, which needs no root.
 */
static struct rho_passive_near compare_bearings(const struct rho_passive_search *search,
                                                unsigned scan, unsigned sensor,
                                                struct rho_passive_way way, int claimed_too)
{
    const struct rho_passive *passive = search->passive;
    const struct rho_batch_bearing *bearings = passive->batch.bearings[scan][sensor];
    float least_m2 =
        length2_m2(way); /* off_m^2; as far as this is, NEAR_SIGMAS of 1 / NEAR_SIGMAS rad */
    struct rho_passive_near nearest = {.which = -1, .way = way, .sigma_rad = 1.0f / NEAR_SIGMAS};
    for (unsigned i = 0; i < passive->batch.num_bearings[scan][sensor]; i++) {
        float off_m = bearings[i].sine * way.x_m - bearings[i].cosine * way.y_m;
        float sigma_rad = sigma_of(search, &bearings[i]);
        if (square(off_m * nearest.sigma_rad) < least_m2 * square(sigma_rad) &&
            bearings[i].cosine * way.x_m + bearings[i].sine * way.y_m > 0.0f &&
            (claimed_too || !passive->is_claimed[scan][sensor][i])) {
            least_m2 = square(off_m);
            nearest = (struct rho_passive_near){(int)i, way, off_m, sigma_rad};
        }
    }
    return nearest;
}

struct rho_passive_near rho_passive_nearest(const struct rho_passive_search *search, unsigned scan,
                                            unsigned sensor, const float state_m[N],
                                            int claimed_too)
{
    struct rho_passive_way way = rho_passive_way_to(search, scan, sensor, state_m);
    if (!may_be_seen(search->passive->directions[scan][sensor], way)) {
        return (struct rho_passive_near){.which = -1};
    }
    return compare_bearings(search, scan, sensor, way, claimed_too);
}

struct rho_passive_near rho_passive_claimed(const struct rho_passive_search *search, unsigned scan,
                                            unsigned sensor, const float state_m[N], unsigned claim)
{
    struct rho_passive_way way = rho_passive_way_to(search, scan, sensor, state_m);
    if (claim == 0 || !(length2_m2(way) > 1.0f)) {
        return (struct rho_passive_near){.which = -1};
    }
    const struct rho_batch_bearing *bearing =
        &search->passive->batch.bearings[scan][sensor][claim - 1u];
    return (struct rho_passive_near){(int)claim - 1, way,
                                     bearing->sine * way.x_m - bearing->cosine * way.y_m,
                                     sigma_of(search, bearing)};
}

float rho_passive_sigmas_off(const struct rho_passive_near *nearest)
{
    return nearest->off_m / (rho_sqrt(length2_m2(nearest->way)) * nearest->sigma_rad);
}

/* ---- agreement -------------------------------------------------------------------------------- */

/*
 * How many looks may have a bearing that is near, and which: bit s of is_near[k]. It stops where they are `least` or
 * fewer.
 */
static unsigned count_near(const struct rho_passive_search *search, const float state_m[N],
                           float least, uint8_t is_near[RHO_MAX_PASSIVE_SCANS])
{
    const struct rho_passive *passive = search->passive;
    unsigned num_sensors = passive->batch.num_sensors;
    unsigned left = (unsigned)passive->batch.num_scans * num_sensors;
    for (unsigned k = 0; k < passive->batch.num_scans && (float)left > least; k++) {
        unsigned seen = 0;
        for (unsigned s = 0; s < num_sensors; s++) {
            unsigned is_seen = (unsigned)may_be_seen(passive->directions[k][s],
                                                     rho_passive_way_to(search, k, s, state_m));
            seen |= is_seen << s;
            left -= 1u - is_seen;
        }
        is_near[k] = (uint8_t)seen;
    }
    return left;
}

/* Of one look, 0 .. 1. */
static float agreement_of(const struct rho_passive_near *nearest)
{
    float reach_m2 = length2_m2(nearest->way) * square(NEAR_SIGMAS * nearest->sigma_rad);
    float share = square(nearest->off_m) / reach_m2;
    return nearest->which >= 0 && share < 1.0f ? 1.0f - share : 0.0f;
}

float rho_passive_agreement(const struct rho_passive_search *search, const float state_m[N],
                            float least)
{
    const struct rho_passive *passive = search->passive;
    uint8_t is_near[RHO_MAX_PASSIVE_SCANS] = {0};
    /* what it comes to at most: each look that may have a bearing counts fully until that has been looked at */
    float most = (float)count_near(search, state_m, least, is_near);
    for (unsigned k = 0; k < passive->batch.num_scans && most > least; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            if (is_near[k] >> s & 1u) {
                struct rho_passive_near nearest = compare_bearings(
                    search, k, s, rho_passive_way_to(search, k, s, state_m), !search->is_second);
                most -= 1.0f - agreement_of(&nearest);
            }
        }
    }
    return most;
}
