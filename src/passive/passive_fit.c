/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/approx.h"
#include "rhotrack/linalg.h"
#include "rhotrack/types.h"

#define N RHO_PASSIVE_STATES
#define GATE_SIGMAS 3.5f
#define AGREEMENT_SIGMAS 9.0f
/* Weak beliefs that keep a fit from running away: a place within the range, and 500 m/s. */
#define SPEED_PRIOR_MPS 500.0f
#define STEP_SHARE 0.1f   /* of the range, in one step */
#define PLACE_SHARE 2.0f  /* of the range, at most */
#define CHI2_SIGMAS 3.09f /* 99.9 % */

/* ---- the nearest bearing ---------------------------------------------------------------------- */

struct nearest {
    int which;    /* -1: none */
    float sigmas; /* of its error: measured less expected */
    float sigma_rad;
    float row_x, row_y; /* derivative of the bearing by the place, rad a metre */
};

/*
 * Angles are small beside 1 wherever they matter: sines, the distance of the place from a bearing's ray over the range,
 * stand for them, so that no arctangent is needed.
 */
static struct nearest nearest_bearing(const struct rho_passive_search *search, unsigned scan,
                                      unsigned sensor, const float state_m[N], int claimed_too)
{
    const struct rho_passive *passive = search->passive;
    float step = search->step[scan];
    float dx_m = state_m[0] + step * state_m[2] - search->x_m[sensor];
    float dy_m = state_m[1] + step * state_m[3] - search->y_m[sensor];
    float range2 = dx_m * dx_m + dy_m * dy_m;
    struct nearest nearest = {.which = -1};
    if (!(range2 > 1.0f)) {
        return nearest;
    }
    float range_m = rho_sqrt(range2), least = 1.0e9f;
    for (unsigned i = 0; i < passive->batch.num_bearings[scan][sensor]; i++) {
        const struct rho_batch_bearing *seen = &passive->batch.bearings[scan][sensor][i];
        float sigma_rad =
            seen->sigma_rad > search->sigma_min_rad ? seen->sigma_rad : search->sigma_min_rad;
        float off = (seen->sine * dx_m - seen->cosine * dy_m) / (range_m * sigma_rad);
        float size = off < 0.0f ? -off : off;
        if (size < least && seen->cosine * dx_m + seen->sine * dy_m > 0.0f &&
            (claimed_too || !passive->is_claimed[scan][sensor][i])) {
            least = size;
            nearest = (struct nearest){.which = (int)i, .sigmas = off, .sigma_rad = sigma_rad};
        }
    }
    nearest.row_x = -dy_m / range2;
    nearest.row_y = dx_m / range2;
    return nearest;
}

static float square(float v)
{
    return v * v;
}

float rho_passive_agreement(const struct rho_passive_search *search, const float state_m[N])
{
    const struct rho_passive *passive = search->passive;
    float sum = 0.0f;
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            struct nearest nearest = nearest_bearing(search, k, s, state_m, !search->is_second);
            float part = square(nearest.sigmas / AGREEMENT_SIGMAS);
            sum += nearest.which >= 0 && part < 1.0f ? 1.0f - part : 0.0f;
        }
    }
    return sum;
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

static struct equations equations_of(const struct rho_passive_search *search,
                                     const float state_m[N], float gate, int claimed_too)
{
    const struct rho_passive *passive = search->passive;
    struct equations equations = {.b = {0}};
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            struct nearest nearest = nearest_bearing(search, k, s, state_m, claimed_too);
            if (nearest.which >= 0 && square(nearest.sigmas) < square(gate)) {
                float step = search->step[k];
                const float row[N] = {nearest.row_x, nearest.row_y, step * nearest.row_x,
                                      step * nearest.row_y};
                add_row(&equations, row, 1.0f / square(nearest.sigma_rad),
                        nearest.sigmas * nearest.sigma_rad);
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

void rho_passive_fit(const struct rho_passive_search *search, float state_m[N], const float *gates,
                     unsigned num_steps, int claimed_too)
{
    float range_m = search->passive->config.range_max_m;
    for (unsigned step = 0; step < num_steps; step++) {
        struct equations equations = equations_of(search, state_m, gates[step], claimed_too);
        float factor[RHO_TRIANGLE(N)];
        if (rho_linalg_cholesky(N, equations.a, factor) != RHO_OK) {
            return; /* as it is, it will be judged by its bearings */
        }
        rho_linalg_forward(N, factor, equations.b);
        rho_linalg_backward(N, factor, equations.b);
        for (int i = 0; i < N; i++) {
            state_m[i] = clipped(state_m[i] + clipped(equations.b[i], STEP_SHARE * range_m),
                                 PLACE_SHARE * range_m);
        }
    }
    search->passive->work.fits = rho_count(search->passive->work.fits, 1);
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
static int is_observable(const struct rho_passive_search *search,
                         uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS])
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

struct rho_passive_judgement
rho_passive_judge(const struct rho_passive_search *search, const float state_m[N], int claimed_too,
                  uint8_t claim[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS])
{
    const struct rho_passive *passive = search->passive;
    struct rho_passive_judgement judgement = {.hits = 0};
    memset(claim, 0, sizeof(uint8_t[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS]));
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            struct nearest nearest = nearest_bearing(search, k, s, state_m, claimed_too);
            if (nearest.which >= 0 && square(nearest.sigmas) < square(GATE_SIGMAS)) {
                claim[k][s] = (uint8_t)(nearest.which + 1);
                judgement.hits++;
                judgement.chi2 += square(nearest.sigmas);
                judgement.score_nat += search->hit_nat - rho_log(nearest.sigma_rad);
            } else if (passive->batch.was_seen[k][s]) {
                judgement.score_nat += search->miss_nat;
            }
        }
    }
    judgement.score_nat -= 0.5f * judgement.chi2;
    unsigned freedom = judgement.hits > N ? judgement.hits - (unsigned)N : 1u;
    judgement.is_track = judgement.hits >= search->hits_min && judgement.score_nat > 0.0f &&
                         judgement.chi2 < chi2_limit(freedom) && !is_fast(search, state_m) &&
                         is_observable(search, claim);
    return judgement;
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
    struct equations equations = equations_of(search, state_m, GATE_SIGMAS, 0);
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
