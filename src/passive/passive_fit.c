/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/approx.h"
#include "rhotrack/linalg.h"
#include "rhotrack/types.h"

#define N RHO_PASSIVE_STATES
#define GATE_SIGMAS 3.5f
#define NEAR_SIGMAS 9.0f     /* no gate is wider */
#define ROUNDING_RAD 1.0e-5f /* more than rounding can turn a direction */
#define FAR_M2 1.0e24f
/* Weak beliefs that keep a fit from running away: a place within the range, and 500 m/s. */
#define SPEED_PRIOR_MPS 500.0f
#define STEP_SHARE 0.1f   /* of the range, in one step */
#define PLACE_SHARE 2.0f  /* of the range, at most */
#define CHI2_SIGMAS 3.09f /* 99.9 % */

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

/* From a sensor to a state's place at a scan. */
struct way {
    float x_m, y_m;
};

static struct way way_to(const struct rho_passive_search *search, unsigned scan, unsigned sensor,
                         const float state_m[N])
{
    float step = search->step[scan];
    return (struct way){.x_m = state_m[0] + step * state_m[2] - search->x_m[sensor],
                        .y_m = state_m[1] + step * state_m[3] - search->y_m[sensor]};
}

static float length2_m2(struct way way)
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
static int may_be_seen(const uint32_t *bins, struct way way)
{
    float size_m2 = length2_m2(way);
    if (!(size_m2 > 1.0f && size_m2 < FAR_M2)) {
        return 0;
    }
    unsigned bin = bin_of(way.x_m, way.y_m);
    return (int)(bins[bin / 32u] >> bin % 32u & 1u);
}

struct nearest {
    int which; /* -1: none within NEAR_SIGMAS */
    struct way way;
    float off_m; /* from the place to the bearing's ray */
    float sigma_rad;
};

/*
 * Angles are small beside 1 wherever they matter: sines, the distance of the place from a bearing's ray over the range,
 * stand for them, so that no arctangent is needed; and their squares are compared, which needs no root.
 */
static struct nearest compare_bearings(const struct rho_passive_search *search, unsigned scan,
                                       unsigned sensor, struct way way, int claimed_too)
{
    const struct rho_passive *passive = search->passive;
    const struct rho_batch_bearing *bearings = passive->batch.bearings[scan][sensor];
    float least_m2 =
        length2_m2(way); /* off_m^2; as far as this is, NEAR_SIGMAS of 1 / NEAR_SIGMAS rad */
    struct nearest nearest = {.which = -1, .way = way, .sigma_rad = 1.0f / NEAR_SIGMAS};
    for (unsigned i = 0; i < passive->batch.num_bearings[scan][sensor]; i++) {
        float off_m = bearings[i].sine * way.x_m - bearings[i].cosine * way.y_m;
        float sigma_rad = sigma_of(search, &bearings[i]);
        if (square(off_m * nearest.sigma_rad) < least_m2 * square(sigma_rad) &&
            bearings[i].cosine * way.x_m + bearings[i].sine * way.y_m > 0.0f &&
            (claimed_too || !passive->is_claimed[scan][sensor][i])) {
            least_m2 = square(off_m);
            nearest = (struct nearest){(int)i, way, off_m, sigma_rad};
        }
    }
    return nearest;
}

static struct nearest nearest_bearing(const struct rho_passive_search *search, unsigned scan,
                                      unsigned sensor, const float state_m[N], int claimed_too)
{
    struct way way = way_to(search, scan, sensor, state_m);
    if (!may_be_seen(search->passive->directions[scan][sensor], way)) {
        return (struct nearest){.which = -1};
    }
    return compare_bearings(search, scan, sensor, way, claimed_too);
}

/* The claimed bearing, however far off; without a claim, none. */
static struct nearest claimed_bearing(const struct rho_passive_search *search, unsigned scan,
                                      unsigned sensor, const float state_m[N], unsigned claim)
{
    struct way way = way_to(search, scan, sensor, state_m);
    if (claim == 0 || !(length2_m2(way) > 1.0f)) {
        return (struct nearest){.which = -1};
    }
    const struct rho_batch_bearing *bearing =
        &search->passive->batch.bearings[scan][sensor][claim - 1u];
    return (struct nearest){(int)claim - 1, way,
                            bearing->sine * way.x_m - bearing->cosine * way.y_m,
                            sigma_of(search, bearing)};
}

/* Of the nearest one's error: measured less expected. */
static float sigmas_off(const struct nearest *nearest)
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
            unsigned is_seen =
                (unsigned)may_be_seen(passive->directions[k][s], way_to(search, k, s, state_m));
            seen |= is_seen << s;
            left -= 1u - is_seen;
        }
        is_near[k] = (uint8_t)seen;
    }
    return left;
}

/* Of one look, 0 .. 1. */
static float agreement_of(const struct nearest *nearest)
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
                struct nearest nearest = compare_bearings(
                    search, k, s, way_to(search, k, s, state_m), !search->is_second);
                most -= 1.0f - agreement_of(&nearest);
            }
        }
    }
    return most;
}

/* ---- the fit ---------------------------------------------------------------------------------- */

/* Normal equations a x = b. */
struct equations {
    float a[RHO_TRIANGLE(N)], b[N];
};

static void add_row(struct equations *equations, const float row[N], float weight, float residual)
{
    for (int i = 0; i < N; i++) {
        for (int j = 0; j <= i; j++) {
            equations->a[RHO_AT(i, j)] += weight * row[i] * row[j];
        }
        equations->b[i] += weight * row[i] * residual;
    }
}

static void add_beliefs(const struct rho_passive_search *search, const float state_m[N],
                        struct equations *equations)
{
    float way_m = SPEED_PRIOR_MPS * search->half_s, range_m = search->passive->config.range_max_m;
    for (int i = 0; i < N; i++) {
        float weight = i < 2 ? 1.0f / square(range_m) : 1.0f / square(way_m);
        equations->a[RHO_AT(i, i)] += weight;
        equations->b[i] -= i < 2 ? 0.0f : weight * state_m[i];
    }
}

static void add_bearing(const struct rho_passive_search *search, unsigned scan,
                        const struct nearest *nearest, struct equations *equations)
{
    /* the derivative of the bearing by the place, rad a metre */
    float range2_m2 = length2_m2(nearest->way), step = search->step[scan];
    float row_x = -nearest->way.y_m / range2_m2, row_y = nearest->way.x_m / range2_m2;
    const float row[N] = {row_x, row_y, step * row_x, step * row_y};
    add_row(equations, row, 1.0f / square(nearest->sigma_rad),
            sigmas_off(nearest) * nearest->sigma_rad);
}

/* Of the nearest bearings within the gate. */
static struct equations equations_near(const struct rho_passive_search *search,
                                       const float state_m[N], float gate, int claimed_too)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct equations equations = {.b = {0}};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct nearest nearest = nearest_bearing(search, k, s, state_m, claimed_too);
            if (nearest.which >= 0 && square(sigmas_off(&nearest)) < square(gate)) {
                add_bearing(search, k, &nearest, &equations);
            }
        }
    }
    add_beliefs(search, state_m, &equations);
    return equations;
}

static struct equations equations_claimed(const struct rho_passive_search *search,
                                          const float state_m[N], rho_passive_const_claim *claim)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct equations equations = {.b = {0}};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct nearest nearest = claimed_bearing(search, k, s, state_m, claim[k][s]);
            if (nearest.which >= 0) {
                add_bearing(search, k, &nearest, &equations);
            }
        }
    }
    add_beliefs(search, state_m, &equations);
    return equations;
}

static float clipped(float v, float most)
{
    return v < most ? (v > -most ? v : -most) : most;
}

/* A Gauss-Newton step. 0: it stays as it is, and will be judged by its bearings. */
static int take_step(const struct rho_passive_search *search, struct equations *equations,
                     float state_m[N])
{
    float range_m = search->passive->config.range_max_m, factor[RHO_TRIANGLE(N)];
    if (rho_linalg_cholesky(N, equations->a, factor) != RHO_OK) {
        return 0;
    }
    rho_linalg_forward(N, factor, equations->b);
    rho_linalg_backward(N, factor, equations->b);
    for (int i = 0; i < N; i++) {
        state_m[i] = clipped(state_m[i] + clipped(equations->b[i], STEP_SHARE * range_m),
                             PLACE_SHARE * range_m);
    }
    return 1;
}

void rho_passive_fit(const struct rho_passive_search *search, float state_m[N], int claimed_too)
{
    static const float gates[4] = {8.0f, 5.0f, GATE_SIGMAS, GATE_SIGMAS};
    int goes_on = 1;
    for (unsigned step = 0; step < 4 && goes_on; step++) {
        struct equations equations = equations_near(search, state_m, gates[step], claimed_too);
        goes_on = take_step(search, &equations, state_m);
    }
    search->passive->work.fits = rho_count(search->passive->work.fits, 1);
}

void rho_passive_fit_claimed(const struct rho_passive_search *search, float state_m[N],
                             rho_passive_const_claim *claim)
{
    struct equations equations = equations_claimed(search, state_m, claim);
    (void)take_step(search, &equations, state_m);
}

/* ---- judgement -------------------------------------------------------------------------------- */

/* 99.9 % of chi-square with so many degrees of freedom (Wilson and Hilferty). */
static float chi2_limit(unsigned freedom)
{
    float n = freedom > 0 ? (float)freedom : 1.0f, part = 2.0f / (9.0f * n);
    float root = 1.0f - part + CHI2_SIGMAS * rho_sqrt(part);
    return n * root * root * root;
}

/* Two sensors with two bearings each: one alone tells neither range nor speed. */
static int is_observable(const struct rho_passive_search *search, rho_passive_const_claim *claim)
{
    unsigned sensors = 0;
    for (unsigned s = 0; s < search->passive->batch.num_sensors; s++) {
        unsigned hits = 0;
        for (unsigned k = 0; k < search->passive->batch.num_scans; k++) {
            hits += claim[k][s] > 0;
        }
        sensors += hits >= 2;
    }
    return sensors >= 2;
}

static int is_fast(const struct rho_passive_search *search, const float state_m[N])
{
    float most_m = search->passive->config.v_max_mps * search->half_s;
    return square(state_m[2]) + square(state_m[3]) >= square(most_m);
}

static int is_track(const struct rho_passive_search *search, const float state_m[N],
                    const struct rho_passive_judgement *judgement, rho_passive_const_claim *claim)
{
    unsigned freedom = judgement->hits > N ? judgement->hits - (unsigned)N : 1u;
    return judgement->hits >= search->hits_min && judgement->score_nat > 0.0f &&
           judgement->chi2 < chi2_limit(freedom) && !is_fast(search, state_m) &&
           is_observable(search, claim);
}

static void count_bearing(const struct rho_passive_search *search, const struct nearest *nearest,
                          struct rho_passive_judgement *judgement)
{
    float chi2 = square(sigmas_off(nearest));
    judgement->hits++;
    judgement->chi2 += chi2;
    judgement->score_nat += search->hit_nat - rho_log(nearest->sigma_rad) - 0.5f * chi2;
}

struct rho_passive_judgement rho_passive_judge(const struct rho_passive_search *search,
                                               const float state_m[N], int claimed_too,
                                               rho_passive_claim *claim)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct rho_passive_judgement judgement = {.hits = 0};
    memset(claim, 0, sizeof(uint8_t[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS]));
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct nearest nearest = nearest_bearing(search, k, s, state_m, claimed_too);
            if (nearest.which >= 0 && square(sigmas_off(&nearest)) < square(GATE_SIGMAS)) {
                claim[k][s] = (uint8_t)(nearest.which + 1);
                count_bearing(search, &nearest, &judgement);
            } else if (batch->was_seen[k][s]) {
                judgement.score_nat += search->miss_nat;
            }
        }
    }
    judgement.is_track = is_track(search, state_m, &judgement, (rho_passive_const_claim *)claim);
    return judgement;
}

struct rho_passive_judgement rho_passive_judge_claimed(const struct rho_passive_search *search,
                                                       const float state_m[N],
                                                       rho_passive_const_claim *claim)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct rho_passive_judgement judgement = {.hits = 0};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct nearest nearest = claimed_bearing(search, k, s, state_m, claim[k][s]);
            if (nearest.which >= 0) {
                count_bearing(search, &nearest, &judgement);
            } else if (batch->was_seen[k][s]) {
                judgement.score_nat += search->miss_nat;
            }
        }
    }
    judgement.is_track = is_track(search, state_m, &judgement, claim);
    return judgement;
}

float rho_passive_gain(const struct rho_passive_search *search, const float state_m[N],
                       unsigned scan, unsigned sensor, unsigned claim)
{
    struct nearest nearest = claimed_bearing(search, scan, sensor, state_m, claim);
    if (nearest.which < 0) {
        return 0.0f;
    }
    const struct rho_batch_bearing *bearing =
        &search->passive->batch.bearings[scan][sensor][claim - 1u];
    float chi2 = square(sigmas_off(&nearest));
    if (bearing->cosine * nearest.way.x_m + bearing->sine * nearest.way.y_m <= 0.0f ||
        chi2 >= square(GATE_SIGMAS)) {
        return 0.0f;
    }
    return search->hit_nat - rho_log(nearest.sigma_rad) - 0.5f * chi2 - search->miss_nat;
}

/* ---- report ----------------------------------------------------------------------------------- */

/* Column `column` of the inverse of a factored matrix. */
static void inverse_column(const float factor[RHO_TRIANGLE(N)], int column, float out[N])
{
    for (int i = 0; i < N; i++) {
        out[i] = i == column ? 1.0f : 0.0f;
    }
    rho_linalg_forward(N, factor, out);
    rho_linalg_backward(N, factor, out);
}

/* From place at mid-batch and way to place and velocity at the newest scan: p + d, d / half. */
static void carry(float half_s, const float from[N][N], float covariance[RHO_TRIANGLE(N)])
{
    for (int i = 0; i < N; i++) {
        for (int j = 0; j <= i; j++) {
            float sum = from[i][j];
            if (i < 2) {
                sum += from[i][j + 2] + from[i + 2][j] + from[i + 2][j + 2];
            } else if (j < 2) {
                sum = (sum + from[i][j + 2]) / half_s;
            } else {
                sum /= half_s * half_s;
            }
            covariance[RHO_AT(i, j)] = sum;
        }
    }
}

int rho_passive_report(const struct rho_passive_search *search, const float state_m[N],
                       struct rho_passive_track *track)
{
    struct equations equations =
        equations_claimed(search, state_m, (rho_passive_const_claim *)track->claim);
    float factor[RHO_TRIANGLE(N)], columns[N][N] = {{0}};
    if (rho_linalg_cholesky(N, equations.a, factor) != RHO_OK) {
        return 0;
    }
    for (int i = 0; i < N; i++) {
        inverse_column(factor, i, columns[i]);
    }
    carry(search->half_s, (const float(*)[N])columns, track->covariance);
    track->x_m = search->middle_x_m + state_m[0] + state_m[2];
    track->y_m = search->middle_y_m + state_m[1] + state_m[3];
    track->vx_mps = state_m[2] / search->half_s;
    track->vy_mps = state_m[3] / search->half_s;
    return 1;
}
