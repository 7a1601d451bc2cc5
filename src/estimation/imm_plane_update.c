/* SPDX-License-Identifier: MIT */
/*
 * imm_plane_update: range rates, projections and updates of estimates without a height, in a third
 * of the instructions that three axes need. Written out: loops would take twice the time.
 */
#include "imm_plane_update.h"

#include <float.h>

#include "rhotrack/detail/approx.h"

/* Indices of the first elements of rows in the packed triangle. */
#define ROW_VX RHO_TRIANGLE(RHO_VX)
#define ROW_VY RHO_TRIANGLE(RHO_VY)
#define ROW_AX RHO_TRIANGLE(RHO_AX)
#define ROW_AY RHO_TRIANGLE(RHO_AY)

/* Indices of x y vx vy ax ay in `row` and `spread`. */
enum { PLANE_X, PLANE_Y, PLANE_VX, PLANE_VY, PLANE_AX, PLANE_AY };

int rho_imm_plane_rate(const float *state, const float *covariance, const struct rho_sensor *sensor,
                       struct plane_rate *rate)
{
    const float dx_m = state[RHO_X] - (sensor ? sensor->x_m : 0.0f);
    const float dy_m = state[RHO_Y] - (sensor ? sensor->y_m : 0.0f);
    const float vx_mps = state[RHO_VX], vy_mps = state[RHO_VY];
    const float range_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    if (!(range_m >= RHO_RANGE_LEAST_M)) {
        return 0;
    }
    const float per_m = 1.0f / range_m, along_x = dx_m * per_m, along_y = dy_m * per_m;
    const float rate_mps = along_x * vx_mps + along_y * vy_mps;
    const float share = (covariance[RHO_XX] + covariance[RHO_YY]) * per_m * per_m;
    *rate = (struct plane_rate){
        .row = {(vx_mps - rate_mps * along_x) * per_m, (vy_mps - rate_mps * along_y) * per_m,
                along_x, along_y},
        .expected_mps = rate_mps,
        .nonlinearity = 0.5f * (vx_mps * vx_mps + vy_mps * vy_mps) * share * share,
    };
    return 1;
}

float rho_imm_plane_project_place(int num_states, const float *restrict p, float x, float y,
                                  float *restrict spread)
{
    spread[PLANE_X] = p[RHO_XX] * x + p[RHO_YX] * y;
    spread[PLANE_Y] = p[RHO_YX] * x + p[RHO_YY] * y;
    spread[PLANE_VX] = p[ROW_VX + RHO_X] * x + p[ROW_VX + RHO_Y] * y;
    spread[PLANE_VY] = p[ROW_VY + RHO_X] * x + p[ROW_VY + RHO_Y] * y;
    if (num_states > RHO_PLANE_STEADY) {
        spread[PLANE_AX] = p[ROW_AX + RHO_X] * x + p[ROW_AX + RHO_Y] * y;
        spread[PLANE_AY] = p[ROW_AY + RHO_X] * x + p[ROW_AY + RHO_Y] * y;
    }
    return spread[PLANE_X] * x + spread[PLANE_Y] * y;
}

float rho_imm_plane_project_rate(int num_states, const float *restrict p, const float *restrict row,
                                 float *restrict spread)
{
    const float x = row[PLANE_X], y = row[PLANE_Y], vx = row[PLANE_VX], vy = row[PLANE_VY];
    spread[PLANE_X] =
        p[RHO_XX] * x + p[RHO_YX] * y + p[ROW_VX + RHO_X] * vx + p[ROW_VY + RHO_X] * vy;
    spread[PLANE_Y] =
        p[RHO_YX] * x + p[RHO_YY] * y + p[ROW_VX + RHO_Y] * vx + p[ROW_VY + RHO_Y] * vy;
    spread[PLANE_VX] = p[ROW_VX + RHO_X] * x + p[ROW_VX + RHO_Y] * y + p[ROW_VX + RHO_VX] * vx +
                       p[ROW_VY + RHO_VX] * vy;
    spread[PLANE_VY] = p[ROW_VY + RHO_X] * x + p[ROW_VY + RHO_Y] * y + p[ROW_VY + RHO_VX] * vx +
                       p[ROW_VY + RHO_VY] * vy;
    if (num_states > RHO_PLANE_STEADY) {
        spread[PLANE_AX] = p[ROW_AX + RHO_X] * x + p[ROW_AX + RHO_Y] * y + p[ROW_AX + RHO_VX] * vx +
                           p[ROW_AX + RHO_VY] * vy;
        spread[PLANE_AY] = p[ROW_AY + RHO_X] * x + p[ROW_AY + RHO_Y] * y + p[ROW_AY + RHO_VX] * vx +
                           p[ROW_AY + RHO_VY] * vy;
    }
    return spread[PLANE_X] * x + spread[PLANE_Y] * y + spread[PLANE_VX] * vx +
           spread[PLANE_VY] * vy;
}

static inline float reduced_variance(float variance, float taken)
{
    return variance * RHO_ROUNDING_ALLOWANCE - taken;
}

enum rho_status rho_imm_plane_update(int num_states, float *restrict state,
                                     float *restrict covariance, const float *restrict spread,
                                     float predicted, float innovation, float variance)
{
    const float sum = predicted + variance, inverse = 1.0f / sum, step = innovation * inverse;
    if (!(predicted >= 0.0f && sum <= FLT_MAX)) {
        return RHO_ERROR_SINGULAR;
    }
    state[RHO_X] += spread[PLANE_X] * step;
    state[RHO_Y] += spread[PLANE_Y] * step;
    state[RHO_VX] += spread[PLANE_VX] * step;
    state[RHO_VY] += spread[PLANE_VY] * step;
    float *restrict p = covariance;
    const float *restrict s = spread;
    const float x = s[PLANE_X] * inverse, y = s[PLANE_Y] * inverse, vx = s[PLANE_VX] * inverse,
                vy = s[PLANE_VY] * inverse;
    p[RHO_XX] = reduced_variance(p[RHO_XX], x * s[PLANE_X]);
    p[RHO_YX] -= y * s[PLANE_X];
    p[RHO_YY] = reduced_variance(p[RHO_YY], y * s[PLANE_Y]);
    p[ROW_VX + RHO_X] -= vx * s[PLANE_X];
    p[ROW_VX + RHO_Y] -= vx * s[PLANE_Y];
    p[ROW_VX + RHO_VX] = reduced_variance(p[ROW_VX + RHO_VX], vx * s[PLANE_VX]);
    p[ROW_VY + RHO_X] -= vy * s[PLANE_X];
    p[ROW_VY + RHO_Y] -= vy * s[PLANE_Y];
    p[ROW_VY + RHO_VX] -= vy * s[PLANE_VX];
    p[ROW_VY + RHO_VY] = reduced_variance(p[ROW_VY + RHO_VY], vy * s[PLANE_VY]);
    if (num_states > RHO_PLANE_STEADY) {
        const float ax = s[PLANE_AX] * inverse, ay = s[PLANE_AY] * inverse;
        state[RHO_AX] += s[PLANE_AX] * step;
        state[RHO_AY] += s[PLANE_AY] * step;
        p[ROW_AX + RHO_X] -= ax * s[PLANE_X];
        p[ROW_AX + RHO_Y] -= ax * s[PLANE_Y];
        p[ROW_AX + RHO_VX] -= ax * s[PLANE_VX];
        p[ROW_AX + RHO_VY] -= ax * s[PLANE_VY];
        p[ROW_AX + RHO_AX] = reduced_variance(p[ROW_AX + RHO_AX], ax * s[PLANE_AX]);
        p[ROW_AY + RHO_X] -= ay * s[PLANE_X];
        p[ROW_AY + RHO_Y] -= ay * s[PLANE_Y];
        p[ROW_AY + RHO_VX] -= ay * s[PLANE_VX];
        p[ROW_AY + RHO_VY] -= ay * s[PLANE_VY];
        p[ROW_AY + RHO_AX] -= ay * s[PLANE_AX];
        p[ROW_AY + RHO_AY] = reduced_variance(p[ROW_AY + RHO_AY], ay * s[PLANE_AY]);
    }
    /* checks all results at once: a sum is finite unless a term is not */
    return rho_is_finite(innovation * step + state[RHO_X] + state[RHO_Y] + state[RHO_VX] +
                         state[RHO_VY])
               ? RHO_OK
               : RHO_ERROR_VALUE;
}

static inline void raise_to_floor(float *variance)
{
    if (*variance < RHO_VARIANCE_MIN) {
        *variance = RHO_VARIANCE_MIN;
    }
}

void rho_imm_plane_floor_variances(int num_states, float *covariance)
{
    raise_to_floor(&covariance[RHO_XX]);
    raise_to_floor(&covariance[RHO_YY]);
    raise_to_floor(&covariance[ROW_VX + RHO_VX]);
    raise_to_floor(&covariance[ROW_VY + RHO_VY]);
    if (num_states > RHO_PLANE_STEADY) {
        raise_to_floor(&covariance[ROW_AX + RHO_AX]);
        raise_to_floor(&covariance[ROW_AY + RHO_AY]);
    }
}
