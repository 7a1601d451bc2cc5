/* SPDX-License-Identifier: MIT */
/*
 * passive_fit: Gauss-Newton fit of a constant-velocity state to bearings, its log-likelihood score,
 * the tests of a track, and the covariance.
 */
#include <string.h>

#include "passive_search.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/types.h"

#define N RHO_PASSIVE_STATES
#define GATE_SIGMAS 3.5f
/* sigma of the weak prior of speed; with a prior of position it keeps fits from diverging */
#define SPEED_PRIOR_MPS 500.0f
/* sigma of the motion model in metres: it limits the weight of bearings taken near a sensor */
#define EXACT_M 1.0f
/* largest change of a state component in one step, as a share of range_max_m */
#define STEP_MAX_RANGES 0.1f
/* largest magnitude of a state component, as a multiple of range_max_m */
#define POSITION_MAX_RANGES 2.0f
#define CHI2_QUANTILE_SIGMAS 3.09f /* normal quantile of 99.9 %, for the chi-square limit */

static float square(float v)
{
    return v * v;
}

/* ---- the fit --------------------------------------------------------------------------------- */

/* Normal equations a x = b. */
struct equations {
    float a[RHO_TRIANGLE(N)], b[N];
};

/* Adds one weighted linear equation, row . change = residual, to the normal equations. */
static void add_equation(struct equations *equations, const float row[N], float weight,
                         float residual)
{
    for (int i = 0; i < N; i++) {
        for (int j = 0; j <= i; j++) {
            equations->a[RHO_AT(i, j)] += weight * row[i] * row[j];
        }
        equations->b[i] += weight * row[i] * residual;
    }
}

/* Adds the weak priors of position and speed to the normal equations. */
static void add_prior_equations(const struct rho_passive_search *search, const float state_m[N],
                                struct equations *equations)
{
    float way_m = SPEED_PRIOR_MPS * search->half_s, range_m = search->passive->config.range_max_m;
    for (int i = 0; i < N; i++) {
        float weight = i < RHO_PASSIVE_DX ? 1.0f / square(range_m) : 1.0f / square(way_m);
        equations->a[RHO_AT(i, i)] += weight;
        equations->b[i] -= i < RHO_PASSIVE_DX ? 0.0f : weight * state_m[i];
    }
}

static void add_bearing_equation(const struct rho_passive_search *search, unsigned scan,
                                 const struct rho_passive_match *nearest,
                                 struct equations *equations)
{
    /* derivative of the bearing by the position, rad per metre */
    float range2_m2 = square(nearest->offset.x_m) + square(nearest->offset.y_m);
    float step = search->step[scan];
    float row_x = -nearest->offset.y_m / range2_m2, row_y = nearest->offset.x_m / range2_m2;
    const float row[N] = {row_x, row_y, step * row_x, step * row_y};
    add_equation(equations, row, 1.0f / (square(nearest->sigma_rad) + square(EXACT_M) / range2_m2),
                 rho_passive_normalised_residual(nearest) * nearest->sigma_rad);
}

static int is_in_gate(const struct rho_passive_match *nearest, float gate_sigmas)
{
    return square(rho_passive_normalised_residual(nearest)) < square(gate_sigmas);
}

/* Normal equations of the nearest bearings within the gate, with the priors. */
static struct equations equations_of_nearest_bearings(const struct rho_passive_search *search,
                                                      const float state_m[N], float gate,
                                                      int include_claimed)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct equations equations = {.b = {0}};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct rho_passive_match nearest =
                rho_passive_match_nearest(search, k, s, state_m, include_claimed);
            if (nearest.bearing >= 0 && is_in_gate(&nearest, gate)) {
                add_bearing_equation(search, k, &nearest, &equations);
            }
        }
    }
    add_prior_equations(search, state_m, &equations);
    return equations;
}

/* Normal equations of the claimed bearings at any distance, with the priors. */
static struct equations equations_of_claimed_bearings(const struct rho_passive_search *search,
                                                      const float state_m[N],
                                                      rho_passive_const_claim *claim)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct equations equations = {.b = {0}};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct rho_passive_match nearest =
                rho_passive_match_claimed(search, k, s, state_m, claim[k][s]);
            if (nearest.bearing >= 0) {
                add_bearing_equation(search, k, &nearest, &equations);
            }
        }
    }
    add_prior_equations(search, state_m, &equations);
    return equations;
}

static float clipped(float v, float most)
{
    return v < most ? (v > -most ? v : -most) : most;
}

/*
 * Solves the normal equations and moves the state, each component by a limited step. Returns 0
 * where they are singular, and the state stays.
 */
static int take_gauss_newton_step_unless_singular(const struct rho_passive_search *search,
                                                  struct equations *equations, float state_m[N])
{
    float range_m = search->passive->config.range_max_m, factor[RHO_TRIANGLE(N)];
    if (rho_linalg_cholesky(N, equations->a, factor) != RHO_OK) {
        return 0;
    }
    rho_linalg_forward(N, factor, equations->b);
    rho_linalg_backward(N, factor, equations->b);
    for (int i = 0; i < N; i++) {
        state_m[i] = clipped(state_m[i] + clipped(equations->b[i], STEP_MAX_RANGES * range_m),
                             POSITION_MAX_RANGES * range_m);
    }
    return 1;
}

void rho_passive_fit_nearest(const struct rho_passive_search *search, float state_m[N],
                             int include_claimed)
{
    static const float gates[4] = {8.0f, 5.0f, GATE_SIGMAS, GATE_SIGMAS};
    int goes_on = 1;
    for (unsigned step = 0; step < 4 && goes_on; step++) {
        struct equations equations =
            equations_of_nearest_bearings(search, state_m, gates[step], include_claimed);
        goes_on = take_gauss_newton_step_unless_singular(search, &equations, state_m);
    }
    search->passive->work.fits = rho_count(search->passive->work.fits, 1);
}

void rho_passive_step_to_claimed_bearings(const struct rho_passive_search *search, float state_m[N],
                                          rho_passive_const_claim *claim)
{
    struct equations equations = equations_of_claimed_bearings(search, state_m, claim);
    (void)take_gauss_newton_step_unless_singular(search, &equations, state_m);
}

/* ---- score ----------------------------------------------------------------------------------- */

/* 99.9 % quantile of chi-square (approximation of Wilson and Hilferty). */
static float chi2_limit(unsigned freedom)
{
    float n = freedom > 0 ? (float)freedom : 1.0f, part = 2.0f / (9.0f * n);
    float root = 1.0f - part + CHI2_QUANTILE_SIGMAS * rho_sqrt(part);
    return n * root * root * root;
}

/* A track needs two sensors with two bearings each: one sensor measures neither range nor speed. */
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

static int is_too_fast(const struct rho_passive_search *search, const float state_m[N])
{
    float most_m = search->passive->config.v_max_mps * search->half_s;
    return square(state_m[RHO_PASSIVE_DX]) + square(state_m[RHO_PASSIVE_DY]) >= square(most_m);
}

/* Whether the state's position was within the sensor's sector in the scan. */
static int is_in_view(const struct rho_passive_search *search, unsigned scan, unsigned sensor,
                      const float state_m[N])
{
    const struct rho_batch *batch = &search->passive->batch;
    float from_rad = batch->sector_from_rad[scan][sensor];
    float to_rad = batch->sector_to_rad[scan][sensor];
    if (!(from_rad < to_rad || from_rad > to_rad)) {
        return 1; /* the whole circle needs no arctangent */
    }
    struct rho_passive_offset offset =
        rho_passive_offset_from_sensor(search, scan, sensor, state_m);
    return rho_angle_in_sector(rho_atan2(offset.y_m, offset.x_m), from_rad, to_rad);
}

/* Adds a miss to the score of a look with the state in view, else counts it as out of view. */
static void add_miss_or_out_of_view(const struct rho_passive_search *search, unsigned scan,
                                    unsigned sensor, const float state_m[N],
                                    struct rho_passive_score *score)
{
    if (!search->passive->batch.was_seen[scan][sensor]) {
        return;
    }
    if (is_in_view(search, scan, sensor, state_m)) {
        score->score_nat += search->miss_nat;
    } else {
        score->looks_out_of_view++;
    }
}

/*
 * Hits must be a share hits_min of the looks that had the position in view, and half that share of
 * all looks: otherwise a state that is hardly ever in view would need very few hits.
 */
static int has_enough_hits(const struct rho_passive_search *search,
                           const struct rho_passive_score *score)
{
    float share = search->passive->config.hits_min, hits = (float)score->hits;
    return hits >= share * (float)(search->looks - score->looks_out_of_view) &&
           hits >= 0.5f * share * (float)search->looks;
}

/* True where score, hits, chi-square, speed and sensors are those of a track. */
static int is_track(const struct rho_passive_search *search, const float state_m[N],
                    const struct rho_passive_score *score, rho_passive_const_claim *claim)
{
    unsigned freedom = score->hits > N ? score->hits - (unsigned)N : 1u;
    return has_enough_hits(search, score) && score->score_nat > 0.0f &&
           score->chi2 < chi2_limit(freedom) && !is_too_fast(search, state_m) &&
           is_observable(search, claim);
}

/* Log-likelihood ratio of a look in which the state has a bearing with this squared residual. */
static float score_of_hit(const struct rho_passive_search *search,
                          const struct rho_passive_match *seen, float chi2)
{
    return search->hit_nat - rho_log(seen->sigma_rad) - 0.5f * chi2;
}

struct rho_passive_score rho_passive_score_claimed(const struct rho_passive_search *search,
                                                   const float state_m[N],
                                                   rho_passive_const_claim *claim)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct rho_passive_score score = {.hits = 0};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct rho_passive_match seen =
                rho_passive_match_claimed(search, k, s, state_m, claim[k][s]);
            if (seen.bearing < 0) {
                add_miss_or_out_of_view(search, k, s, state_m, &score);
                continue;
            }
            float chi2 = square(rho_passive_normalised_residual(&seen));
            score.hits++;
            score.chi2 += chi2;
            score.score_nat += score_of_hit(search, &seen, chi2);
        }
    }
    score.is_track = is_track(search, state_m, &score, claim);
    return score;
}

struct rho_passive_score
rho_passive_claim_and_score_nearest(const struct rho_passive_search *search, const float state_m[N],
                                    int include_claimed, rho_passive_claim *claim)
{
    const struct rho_batch *batch = &search->passive->batch;
    memset(claim, 0, sizeof(uint8_t[RHO_MAX_PASSIVE_SCANS][RHO_MAX_PASSIVE_SENSORS]));
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct rho_passive_match nearest =
                rho_passive_match_nearest(search, k, s, state_m, include_claimed);
            if (nearest.bearing >= 0 && is_in_gate(&nearest, GATE_SIGMAS)) {
                claim[k][s] = (uint8_t)(nearest.bearing + 1);
            }
        }
    }
    return rho_passive_score_claimed(search, state_m, (rho_passive_const_claim *)claim);
}

float rho_passive_gain_of_bearing_over_miss_nat(const struct rho_passive_search *search,
                                                const float state_m[N], unsigned scan,
                                                unsigned sensor, unsigned claim)
{
    struct rho_passive_match seen = rho_passive_match_claimed(search, scan, sensor, state_m, claim);
    if (seen.bearing < 0) {
        return 0.0f;
    }
    const struct rho_batch_bearing *bearing =
        &search->passive->batch.bearings[scan][sensor][claim - 1u];
    float chi2 = square(rho_passive_normalised_residual(&seen));
    if (bearing->cosine * seen.offset.x_m + bearing->sine * seen.offset.y_m <= 0.0f ||
        chi2 >= square(GATE_SIGMAS)) {
        return 0.0f;
    }
    return score_of_hit(search, &seen, chi2) - search->miss_nat;
}

/* ---- estimate of a track --------------------------------------------------------------------- */

/* Column `column` of the inverse of a matrix, from the matrix' Cholesky factor. */
static void inverse_column(const float factor[RHO_TRIANGLE(N)], int column, float out[N])
{
    for (int i = 0; i < N; i++) {
        out[i] = i == column ? 1.0f : 0.0f;
    }
    rho_linalg_forward(N, factor, out);
    rho_linalg_backward(N, factor, out);
}

/*
 * Covariance of position p + d and velocity d / half_s at the newest scan, from the covariance of
 * the state (p, d): position at mid-batch, displacement in half the batch.
 */
static void propagate_covariance_to_newest_scan(float half_s, const float from[N][N],
                                                float covariance[RHO_TRIANGLE(N)])
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

int rho_passive_estimate_track(const struct rho_passive_search *search, const float state_m[N],
                               struct rho_passive_track *track)
{
    struct equations equations =
        equations_of_claimed_bearings(search, state_m, (rho_passive_const_claim *)track->claim);
    float factor[RHO_TRIANGLE(N)], columns[N][N] = {{0}};
    if (rho_linalg_cholesky(N, equations.a, factor) != RHO_OK) {
        return 0;
    }
    for (int i = 0; i < N; i++) {
        inverse_column(factor, i, columns[i]);
    }
    propagate_covariance_to_newest_scan(search->half_s, (const float(*)[N])columns,
                                        track->covariance);
    track->x_m = search->middle_x_m + state_m[RHO_PASSIVE_X] + state_m[RHO_PASSIVE_DX];
    track->y_m = search->middle_y_m + state_m[RHO_PASSIVE_Y] + state_m[RHO_PASSIVE_DY];
    track->vx_mps = state_m[RHO_PASSIVE_DX] / search->half_s;
    track->vy_mps = state_m[RHO_PASSIVE_DY] / search->half_s;
    return 1;
}
