/* SPDX-License-Identifier: MIT */
/*
 * passive_fit: Gauss-Newton fit of a constant-velocity state to bearings, its log-likelihood score,
 * the tests of a track, and the covariance.
 */
#include <string.h>

#include "passive_search.h"
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/linalg.h"

#define N RHO_PASSIVE_STATES

/* In metres across the ray. Two by two, the rows of position and displacement are alike. */
static inline void add_bearing_equation(float step, const struct rho_passive_match *nearest,
                                        struct rho_passive_equations *equations)
{
    const float x_m = nearest->offset.x_m, y_m = nearest->offset.y_m;
    const float range2_m2 = rho_passive_squared_range_m2(nearest->offset);
    const float weight =
        1.0f / (range2_m2 * (rho_square(nearest->sigma_rad) * range2_m2 + rho_square(EXACT_M)));
    const float residual = weight * nearest->cross_range_m * rho_sqrt(range2_m2);
    const float xx = weight * y_m * y_m, xy = -weight * x_m * y_m, yy = weight * x_m * x_m;
    const float step2 = step * step;
    float *a = equations->a, *b = equations->b;
    a[RHO_AT(0, 0)] += xx;
    a[RHO_AT(1, 0)] += xy;
    a[RHO_AT(1, 1)] += yy;
    a[RHO_AT(2, 0)] += step * xx;
    a[RHO_AT(2, 1)] += step * xy;
    a[RHO_AT(2, 2)] += step2 * xx;
    a[RHO_AT(3, 0)] += step * xy;
    a[RHO_AT(3, 1)] += step * yy;
    a[RHO_AT(3, 2)] += step2 * xy;
    a[RHO_AT(3, 3)] += step2 * yy;
    b[0] -= y_m * residual;
    b[1] += x_m * residual;
    b[2] -= step * y_m * residual;
    b[3] += step * x_m * residual;
}

/* In metres of height: a slope is linear in height and ground range. */
static void add_slope_equation(float step, const struct rho_passive_match *nearest,
                               struct rho_passive_equations *equations)
{
    const struct rho_passive_offset *offset = &nearest->offset;
    const float range_m = rho_sqrt(rho_passive_squared_range_m2(*offset));
    const float slope = (nearest->above_m + offset->z_m) / range_m;
    const float row_x = -slope * offset->x_m / range_m, row_y = -slope * offset->y_m / range_m;
    const float row[N] = {row_x, row_y, step * row_x, step * row_y, 1.0f, step};
    const float weight = 1.0f / (rho_square(nearest->sigma_slope * range_m) + rho_square(EXACT_M));
    for (int i = 0; i < N; i++) {
        for (int j = 0; j <= i; j++) {
            equations->a[RHO_AT(i, j)] += weight * row[i] * row[j];
        }
        equations->b[i] += weight * row[i] * nearest->above_m;
    }
    equations->num_slopes++;
}

/* Squared residual of a bearing, in sigmas; the sine stands for the angle. */
static inline float squared_residual(const struct rho_passive_match *match)
{
    return rho_square(match->cross_range_m / match->sigma_rad) /
           rho_passive_squared_range_m2(match->offset);
}

/* With that of its slope. */
static inline float squared_residuals(const struct rho_passive_match *match)
{
    const float slope = match->sigma_slope > 0.0f ? match->above_m / match->sigma_slope : 0.0f;
    return squared_residual(match) +
           rho_square(slope) / rho_passive_squared_range_m2(match->offset);
}

/*
 * Sigma of an element of a state before a bearing is seen, about the centroid and rest: half the
 * largest range, or the way in half the batch at half the largest speed.
 */
static float prior_sigma_m(const struct rho_passive_search *search, int element)
{
    const struct rho_passive_config *config = &search->passive->config;
    return 0.5f * (element < RHO_PASSIVE_DX || element == RHO_PASSIVE_Z
                       ? config->range_max_m
                       : config->v_max_mps * search->half_s);
}

static inline void add_match(const struct rho_passive_search *search, unsigned scan,
                             unsigned sensor, const struct rho_passive_match *match,
                             struct rho_passive_equations *equations)
{
    const float step = search->at[scan][sensor].step;
    rho_passive_spend(search, match->sigma_slope > 0.0f ? 3u : 1u);
    add_bearing_equation(step, match, equations);
    if (match->sigma_slope > 0.0f) {
        add_slope_equation(step, match, equations);
    }
}

static void add_prior(const struct rho_passive_search *search, const float state_m[N],
                      struct rho_passive_equations *equations)
{
    for (int i = 0; i < rho_passive_num_states(search); i++) {
        const float weight = 1.0f / rho_square(prior_sigma_m(search, i));
        equations->a[RHO_AT(i, i)] += weight;
        equations->b[i] -= weight * state_m[i];
    }
}

struct rho_passive_equations rho_passive_equate_claims(const struct rho_passive_search *search,
                                                       const struct rho_passive_candidate *track)
{
    const struct rho_batch *batch = &search->passive->batch;
    struct rho_passive_equations equations = {.b = {0}};
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            const struct rho_passive_match seen =
                rho_passive_match_claimed(search, k, s, track->state_m, track->claim[k][s]);
            if (seen.bearing >= 0) {
                add_match(search, k, s, &seen, &equations);
            }
        }
    }
    add_prior(search, track->state_m, &equations);
    return equations;
}

static float clipped(float v, float most)
{
    return v < most ? (v > -most ? v : -most) : most;
}

/* A Gauss-Newton step of limited size. Returns 0 where the equations are singular. */
static int step_towards(const struct rho_passive_search *search,
                        struct rho_passive_equations *equations, float state_m[N])
{
    float range_m = search->passive->config.range_max_m, factor[RHO_TRIANGLE(N)];
    const int n = rho_passive_num_states(search);
    if (rho_linalg_cholesky(n, equations->a, factor) != RHO_OK) {
        return 0;
    }
    rho_linalg_forward(n, factor, equations->b);
    rho_linalg_backward(n, factor, equations->b);
    for (int i = 0; i < n; i++) {
        /* slopes are linear in the height: it needs no small steps */
        const float step_m = i < RHO_PASSIVE_Z ? clipped(equations->b[i], STEP_MAX_RANGES * range_m)
                                               : equations->b[i];
        state_m[i] = clipped(state_m[i] + step_m, POSITION_MAX_RANGES * range_m);
    }
    return 1;
}

int rho_passive_step_to_claims(const struct rho_passive_search *search,
                               struct rho_passive_candidate *track)
{
    struct rho_passive_equations equations = rho_passive_equate_claims(search, track);
    return step_towards(search, &equations, track->state_m);
}

/* The nearest bearing of a look within a gate, of those that may match; bearing -1: none. */
static inline struct rho_passive_match match_within(const struct rho_passive_search *search,
                                                    float gate, int matching, unsigned scan,
                                                    unsigned sensor, const float state_m[N])
{
    struct rho_passive_match nearest =
        rho_passive_match_nearest(search, scan, sensor, state_m, matching);
    if (nearest.bearing >= 0) {
        const float chi2 = matching & RHO_PASSIVE_BY_SLOPE ? squared_residuals(&nearest)
                                                           : squared_residual(&nearest);
        nearest.bearing = chi2 < rho_square(gate) ? nearest.bearing : -1;
    }
    return nearest;
}

void rho_passive_claim_nearest(const struct rho_passive_search *search, int matching,
                               struct rho_passive_candidate *track)
{
    const struct rho_batch *batch = &search->passive->batch;
    memset(track->claim, 0, sizeof track->claim);
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            track->claim[k][s] =
                (uint8_t)(match_within(search, BEARING_GATE_SIGMAS, matching, k, s, track->state_m)
                              .bearing +
                          1);
        }
    }
}

void rho_passive_fit_nearest(const struct rho_passive_search *search, int has_height,
                             float state_m[N])
{
    static const float gates[4] = {8.0f, 5.0f, BEARING_GATE_SIGMAS, BEARING_GATE_SIGMAS};
    const struct rho_batch *batch = &search->passive->batch;
    int goes_on = 1;
    for (unsigned step = 0; step < 4 && goes_on; step++) {
        const int matching = step > 0 || has_height ? RHO_PASSIVE_BY_SLOPE : RHO_PASSIVE_UNCLAIMED;
        struct rho_passive_equations equations = {.b = {0}};
        for (unsigned k = 0; k < batch->num_scans; k++) {
            for (unsigned s = 0; s < batch->num_sensors; s++) {
                const struct rho_passive_match nearest =
                    match_within(search, gates[step], matching, k, s, state_m);
                if (nearest.bearing >= 0) {
                    add_match(search, k, s, &nearest, &equations);
                }
            }
        }
        add_prior(search, state_m, &equations);
        goes_on = step_towards(search, &equations, state_m);
    }
    search->passive->work.fits = rho_count(search->passive->work.fits, 1);
}

int rho_passive_is_in_view(const struct rho_passive_search *search, unsigned scan, unsigned sensor,
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

/*
 * True where score, chi-square, speed and sensors are those of a track; scalars: the residuals in
 * chi2. States take no degrees of freedom: the prior is a residual of each.
 */
static int is_track(const struct rho_passive_search *search,
                    const struct rho_passive_candidate *track, float chi2, int scalars)
{
    const struct rho_passive *passive = search->passive;
    /* 99.9 % quantile of chi-square, 3.09 sigmas (approximation of Wilson and Hilferty) */
    const float n = (float)scalars, part = 2.0f / (9.0f * n);
    float root = 1.0f - part + 3.09f * rho_sqrt(part);
    float most_m = passive->config.v_max_mps * search->half_s;
    float way2_m2 =
        rho_square(track->state_m[RHO_PASSIVE_DX]) + rho_square(track->state_m[RHO_PASSIVE_DY]);
    /* two sensors with two bearings each: one sensor measures neither range nor speed */
    unsigned sensors = 0;
    for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
        unsigned bearings = 0;
        for (unsigned k = 0; k < passive->batch.num_scans; k++) {
            bearings += track->claim[k][s] > 0;
        }
        sensors += bearings >= 2;
    }
    return track->score_nat > 0.0f && chi2 < n * root * root * root &&
           !(way2_m2 >= rho_square(most_m)) && sensors >= 2;
}

/*
 * Log-likelihood ratio of a look in which the state has a bearing with these squared residuals. The
 * slopes of false bearings have the density 1.
 */
static float score_of_hit(const struct rho_passive_search *search,
                          const struct rho_passive_match *seen, float chi2)
{
    const float slope_nat =
        seen->sigma_slope > 0.0f ? -rho_log(seen->sigma_slope) - 0.5f * RHO_LOG_TWO_PI : 0.0f;
    return search->hit_nat - rho_log(seen->sigma_rad) - 0.5f * (RHO_LOG_TWO_PI + chi2) + slope_nat;
}

float rho_passive_distance2(const struct rho_passive_search *search,
                            const struct rho_passive_equations *equations, const float a_m[N],
                            const float b_m[N])
{
    float sum = 0.0f;
    for (int i = 0; i < rho_passive_num_states(search); i++) {
        const float off_m = a_m[i] - b_m[i];
        for (int j = 0; j <= i; j++) {
            const float twice = i == j ? 1.0f : 2.0f;
            sum += twice * equations->a[RHO_AT(i, j)] * off_m * (a_m[j] - b_m[j]);
        }
    }
    return sum;
}

float rho_passive_prior_nat(const struct rho_passive_search *search,
                            const struct rho_passive_candidate *track)
{
    const struct rho_passive_equations equations = rho_passive_equate_claims(search, track);
    const int n = equations.num_slopes > 0 ? N : RHO_PASSIVE_Z;
    float factor[RHO_TRIANGLE(N)], score_nat = 0.0f;
    if (rho_linalg_cholesky(n, equations.a, factor) != RHO_OK) {
        return -1.0e6f; /* no covariance, no track */
    }
    for (int i = 0; i < n; i++) {
        const float sigma_m = prior_sigma_m(search, i);
        score_nat -= rho_log(factor[RHO_AT(i, i)] * sigma_m) +
                     0.5f * rho_square(track->state_m[i] / sigma_m);
    }
    return score_nat;
}

int rho_passive_score_claimed(const struct rho_passive_search *search,
                              struct rho_passive_candidate *track, float *chi2)
{
    const struct rho_batch *batch = &search->passive->batch;
    int scalars = 0;
    track->score_nat = *chi2 = 0.0f;
    track->hits = 0;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            struct rho_passive_match seen =
                rho_passive_match_claimed(search, k, s, track->state_m, track->claim[k][s]);
            if (seen.bearing >= 0) {
                float seen_chi2 = squared_residuals(&seen);
                track->hits++;
                scalars += seen.sigma_slope > 0.0f ? 2 : 1;
                *chi2 += seen_chi2;
                track->score_nat += score_of_hit(search, &seen, seen_chi2);
            } else if (batch->was_seen[k][s] &&
                       rho_passive_is_in_view(search, k, s, track->state_m)) {
                track->score_nat += search->miss_nat;
            }
        }
    }
    track->score_nat += rho_passive_prior_nat(search, track);
    return is_track(search, track, *chi2, scalars);
}

float rho_passive_gain_nat(const struct rho_passive_search *search, const float state_m[N],
                           unsigned scan, unsigned sensor, unsigned claim)
{
    struct rho_passive_match seen = rho_passive_match_claimed(search, scan, sensor, state_m, claim);
    if (seen.bearing < 0) {
        return 0.0f;
    }
    const struct rho_batch_bearing *bearing =
        &search->passive->batch.bearings[scan][sensor][claim - 1u];
    float chi2 = squared_residuals(&seen);
    if (bearing->cosine * seen.offset.x_m + bearing->sine * seen.offset.y_m <= 0.0f ||
        chi2 >= rho_square(BEARING_GATE_SIGMAS)) {
        return 0.0f;
    }
    return score_of_hit(search, &seen, chi2) - search->miss_nat;
}

/*
 * Covariance of two elements of position p + d and velocity d / half_s at the newest scan, from
 * that of the state (p, d): position at mid-batch, displacement in half the batch.
 */
static float moved_covariance(const float inverse[N * N], int i, int j, float half_s)
{
    const int more_i = i < 2 ? i + 2 : i == RHO_PASSIVE_Z ? RHO_PASSIVE_DZ : -1;
    const int more_j = j < 2 ? j + 2 : j == RHO_PASSIVE_Z ? RHO_PASSIVE_DZ : -1;
    float sum = inverse[N * i + j];
    sum += more_i >= 0 ? inverse[N * more_i + j] : 0.0f;
    sum += more_j >= 0 ? inverse[N * i + more_j] : 0.0f;
    sum += more_i >= 0 && more_j >= 0 ? inverse[N * more_i + more_j] : 0.0f;
    return sum / ((more_i < 0 ? half_s : 1.0f) * (more_j < 0 ? half_s : 1.0f));
}

int rho_passive_estimate_track(const struct rho_passive_search *search,
                               const struct rho_passive_candidate *from,
                               struct rho_passive_track *track)
{
    const float *state_m = from->state_m;
    const int n = rho_passive_num_states(search);
    struct rho_passive_equations equations = rho_passive_equate_claims(search, from);
    float factor[RHO_TRIANGLE(N)], inverse[N * N] = {0};
    if (rho_linalg_cholesky(n, equations.a, factor) != RHO_OK) {
        return 0;
    }
    for (int i = 0; i < n; i++) { /* the inverse, column by column */
        inverse[N * i + i] = 1.0f;
        rho_linalg_forward(n, factor, &inverse[N * i]);
        rho_linalg_backward(n, factor, &inverse[N * i]);
    }
    for (int i = 0; i < N; i++) {
        for (int j = 0; j <= i; j++) {
            track->covariance[RHO_AT(i, j)] = moved_covariance(inverse, i, j, search->half_s);
        }
    }
    track->x_m = search->middle_x_m + state_m[RHO_PASSIVE_X] + state_m[RHO_PASSIVE_DX];
    track->y_m = search->middle_y_m + state_m[RHO_PASSIVE_Y] + state_m[RHO_PASSIVE_DY];
    track->z_m = state_m[RHO_PASSIVE_Z] + state_m[RHO_PASSIVE_DZ];
    track->vx_mps = state_m[RHO_PASSIVE_DX] / search->half_s;
    track->vy_mps = state_m[RHO_PASSIVE_DY] / search->half_s;
    track->vz_mps = state_m[RHO_PASSIVE_DZ] / search->half_s;
    track->is_level = equations.num_slopes == 0;
    return 1;
}
