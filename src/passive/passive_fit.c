/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/angle.h"
#include "rhotrack/approx.h"
#include "rhotrack/linalg.h"
#include "rhotrack/types.h"

#define N RHO_PASSIVE_STATES
#define GATE_SIGMAS 3.5f
/* Weak beliefs that keep a fit from running away: a place within the range, and 500 m/s. */
#define SPEED_PRIOR_MPS 500.0f
#define EXACT_M 1.0f      /* places and straight lines are no better: near a sensor a bearing is */
#define STEP_SHARE 0.1f   /* of the range, in one step */
#define PLACE_SHARE 2.0f  /* of the range, at most */
#define CHI2_SIGMAS 3.09f /* 99.9 % */

static float square(float v)
{
    return v * v;
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
                        const struct rho_passive_near *nearest, struct equations *equations)
{
    /* the derivative of the bearing by the place, rad a metre */
    float range2_m2 = square(nearest->way.x_m) + square(nearest->way.y_m);
    float step = search->step[scan];
    float row_x = -nearest->way.y_m / range2_m2, row_y = nearest->way.x_m / range2_m2;
    const float row[N] = {row_x, row_y, step * row_x, step * row_y};
    add_row(equations, row, 1.0f / (square(nearest->sigma_rad) + square(EXACT_M) / range2_m2),
            rho_passive_sigmas_off(nearest) * nearest->sigma_rad);
}

static int is_in_gate(const struct rho_passive_near *nearest, float gate_sigmas)
{
    return square(rho_passive_sigmas_off(nearest)) < square(gate_sigmas);
}

/* Of the nearest bearings within the gate. */
static struct equations equations_near(const struct rho_passive_search *search,
                                       const float state_m[N], float gate, int claimed_too)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct equations equations = {.b = {0}};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct rho_passive_near nearest =
                rho_passive_nearest(search, k, s, state_m, claimed_too);
            if (nearest.which >= 0 && is_in_gate(&nearest, gate)) {
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
            struct rho_passive_near nearest =
                rho_passive_claimed(search, k, s, state_m, claim[k][s]);
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

/* Could the sensor have seen it at that look: within its sector? */
static int is_in_view(const struct rho_passive_search *search, unsigned scan, unsigned sensor,
                      const float state_m[N])
{
    const struct rho_batch *batch = &search->passive->batch;
    float from_rad = batch->sector_from_rad[scan][sensor];
    float to_rad = batch->sector_to_rad[scan][sensor];
    if (!(from_rad < to_rad || from_rad > to_rad)) {
        return 1; /* the whole circle, without an arctangent */
    }
    struct rho_passive_way way = rho_passive_way_to(search, scan, sensor, state_m);
    return rho_angle_in_sector(rho_atan2(way.y_m, way.x_m), from_rad, to_rad);
}

static void count_miss(const struct rho_passive_search *search, unsigned scan, unsigned sensor,
                       const float state_m[N], struct rho_passive_judgement *judgement)
{
    if (!search->passive->batch.was_seen[scan][sensor]) {
        return;
    }
    if (is_in_view(search, scan, sensor, state_m)) {
        judgement->score_nat += search->miss_nat;
    } else {
        judgement->looks_away++;
    }
}

/* Of the looks that could have seen it; and a half as many as of all, lest what hardly anybody looks at is easily found. */
static int has_enough_hits(const struct rho_passive_search *search,
                           const struct rho_passive_judgement *judgement)
{
    float share = search->passive->config.hits_min, hits = (float)judgement->hits;
    return hits >= share * (float)(search->looks - judgement->looks_away) &&
           hits >= 0.5f * share * (float)search->looks;
}

static int is_track(const struct rho_passive_search *search, const float state_m[N],
                    const struct rho_passive_judgement *judgement, rho_passive_const_claim *claim)
{
    unsigned freedom = judgement->hits > N ? judgement->hits - (unsigned)N : 1u;
    return has_enough_hits(search, judgement) && judgement->score_nat > 0.0f &&
           judgement->chi2 < chi2_limit(freedom) && !is_fast(search, state_m) &&
           is_observable(search, claim);
}

/* What a bearing adds to the score. */
static float hit_nat(const struct rho_passive_search *search, const struct rho_passive_near *seen,
                     float chi2)
{
    return search->hit_nat - rho_log(seen->sigma_rad) - 0.5f * chi2;
}

struct rho_passive_judgement rho_passive_judge_claimed(const struct rho_passive_search *search,
                                                       const float state_m[N],
                                                       rho_passive_const_claim *claim)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct rho_passive_judgement judgement = {.hits = 0};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct rho_passive_near seen = rho_passive_claimed(search, k, s, state_m, claim[k][s]);
            if (seen.which < 0) {
                count_miss(search, k, s, state_m, &judgement);
                continue;
            }
            float chi2 = square(rho_passive_sigmas_off(&seen));
            judgement.hits++;
            judgement.chi2 += chi2;
            judgement.score_nat += hit_nat(search, &seen, chi2);
        }
    }
    judgement.is_track = is_track(search, state_m, &judgement, claim);
    return judgement;
}

struct rho_passive_judgement rho_passive_judge(const struct rho_passive_search *search,
                                               const float state_m[N], int claimed_too,
                                               rho_passive_claim *claim)
{
    const struct rho_batch *batch = &search->passive->batch;
    memset(claim, 0, sizeof(uint8_t[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS]));
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct rho_passive_near nearest =
                rho_passive_nearest(search, k, s, state_m, claimed_too);
            if (nearest.which >= 0 && is_in_gate(&nearest, GATE_SIGMAS)) {
                claim[k][s] = (uint8_t)(nearest.which + 1);
            }
        }
    }
    return rho_passive_judge_claimed(search, state_m, (rho_passive_const_claim *)claim);
}

float rho_passive_gain(const struct rho_passive_search *search, const float state_m[N],
                       unsigned scan, unsigned sensor, unsigned claim)
{
    struct rho_passive_near seen = rho_passive_claimed(search, scan, sensor, state_m, claim);
    if (seen.which < 0) {
        return 0.0f;
    }
    const struct rho_batch_bearing *bearing =
        &search->passive->batch.bearings[scan][sensor][claim - 1u];
    float chi2 = square(rho_passive_sigmas_off(&seen));
    if (bearing->cosine * seen.way.x_m + bearing->sine * seen.way.y_m <= 0.0f ||
        chi2 >= square(GATE_SIGMAS)) {
        return 0.0f;
    }
    return hit_nat(search, &seen, chi2) - search->miss_nat;
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
