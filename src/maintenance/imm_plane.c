/* SPDX-License-Identifier: MIT */
/*
 * imm_plane: range rates, projections and updates of estimates without a height, in a third of the
 * instructions that three axes take. Written out: loops would take twice the time.
 */
#include "imm_plane.h"

#include <float.h>

#include "rhotrack/approx.h"

/* As in linalg.c. */
#define ROUNDING_ALLOWANCE (1.0f + 1.0f / 1048576.0f)

/* As in measurement.c. */
#define RANGE_LEAST_M 1.0f

/* Where rows of the triangle begin: of both velocities, of both accelerations. */
#define VX RHO_TRIANGLE(3)
#define VY RHO_TRIANGLE(4)
#define AX RHO_TRIANGLE(6)
#define AY RHO_TRIANGLE(7)

int rho_imm_plane_see_rate(const float *state, const float *covariance,
                           const struct rho_sensor *sensor, struct plane_rate *rate)
{
    const float dx_m = state[0] - (sensor ? sensor->x_m : 0.0f);
    const float dy_m = state[1] - (sensor ? sensor->y_m : 0.0f);
    const float vx_mps = state[3], vy_mps = state[4];
    const float range_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    if (!(range_m >= RANGE_LEAST_M)) {
        return 0;
    }
    const float per_m = 1.0f / range_m, along_x = dx_m * per_m, along_y = dy_m * per_m;
    const float rate_mps = along_x * vx_mps + along_y * vy_mps;
    const float share = (covariance[RHO_AT(0, 0)] + covariance[RHO_AT(1, 1)]) * per_m * per_m;
    *rate = (struct plane_rate){
        .row = {(vx_mps - rate_mps * along_x) * per_m, (vy_mps - rate_mps * along_y) * per_m,
                along_x, along_y},
        .expected_mps = rate_mps,
        .bend = 0.5f * (vx_mps * vx_mps + vy_mps * vy_mps) * share * share,
    };
    return 1;
}

float rho_imm_plane_project(int num_states, const float *restrict p, float x, float y,
                            float *restrict spread)
{
    spread[0] = p[0] * x + p[1] * y;
    spread[1] = p[1] * x + p[2] * y;
    spread[2] = p[VX] * x + p[VX + 1] * y;
    spread[3] = p[VY] * x + p[VY + 1] * y;
    if (num_states > RHO_PLANE_STEADY) {
        spread[4] = p[AX] * x + p[AX + 1] * y;
        spread[5] = p[AY] * x + p[AY + 1] * y;
    }
    return spread[0] * x + spread[1] * y;
}

float rho_imm_plane_project_rate(int num_states, const float *restrict p, const float *restrict row,
                                 float *restrict spread)
{
    const float x = row[0], y = row[1], vx = row[2], vy = row[3];
    spread[0] = p[0] * x + p[1] * y + p[VX] * vx + p[VY] * vy;
    spread[1] = p[1] * x + p[2] * y + p[VX + 1] * vx + p[VY + 1] * vy;
    spread[2] = p[VX] * x + p[VX + 1] * y + p[VX + 3] * vx + p[VY + 3] * vy;
    spread[3] = p[VY] * x + p[VY + 1] * y + p[VY + 3] * vx + p[VY + 4] * vy;
    if (num_states > RHO_PLANE_STEADY) {
        spread[4] = p[AX] * x + p[AX + 1] * y + p[AX + 3] * vx + p[AX + 4] * vy;
        spread[5] = p[AY] * x + p[AY + 1] * y + p[AY + 3] * vx + p[AY + 4] * vy;
    }
    return spread[0] * x + spread[1] * y + spread[2] * vx + spread[3] * vy;
}

static inline float lowered(float variance, float taken)
{
    return variance * ROUNDING_ALLOWANCE - taken;
}

static inline void lower_steady(float *restrict p, const float *restrict s, float inverse)
{
    const float x = s[0] * inverse, y = s[1] * inverse, vx = s[2] * inverse, vy = s[3] * inverse;
    p[0] = lowered(p[0], x * s[0]);
    p[1] -= y * s[0];
    p[2] = lowered(p[2], y * s[1]);
    p[VX] -= vx * s[0];
    p[VX + 1] -= vx * s[1];
    p[VX + 3] = lowered(p[VX + 3], vx * s[2]);
    p[VY] -= vy * s[0];
    p[VY + 1] -= vy * s[1];
    p[VY + 3] -= vy * s[2];
    p[VY + 4] = lowered(p[VY + 4], vy * s[3]);
}

static inline void lower_manoeuvre(float *restrict p, const float *restrict s, float inverse)
{
    const float ax = s[4] * inverse, ay = s[5] * inverse;
    p[AX] -= ax * s[0];
    p[AX + 1] -= ax * s[1];
    p[AX + 3] -= ax * s[2];
    p[AX + 4] -= ax * s[3];
    p[AX + 6] = lowered(p[AX + 6], ax * s[4]);
    p[AY] -= ay * s[0];
    p[AY + 1] -= ay * s[1];
    p[AY + 3] -= ay * s[2];
    p[AY + 4] -= ay * s[3];
    p[AY + 6] -= ay * s[4];
    p[AY + 7] = lowered(p[AY + 7], ay * s[5]);
}

static int is_finite(float v)
{
    return v >= -FLT_MAX && v <= FLT_MAX;
}

enum rho_status rho_imm_plane_update(int num_states, float *restrict state,
                                     float *restrict covariance, const float *restrict spread,
                                     float predicted, float innovation, float variance)
{
    const float sum = predicted + variance, inverse = 1.0f / sum, step = innovation * inverse;
    if (!(predicted >= 0.0f && sum <= FLT_MAX)) {
        return RHO_ERROR_SINGULAR;
    }
    state[0] += spread[0] * step;
    state[1] += spread[1] * step;
    state[3] += spread[2] * step;
    state[4] += spread[3] * step;
    lower_steady(covariance, spread, inverse);
    if (num_states > RHO_PLANE_STEADY) {
        state[6] += spread[4] * step;
        state[7] += spread[5] * step;
        lower_manoeuvre(covariance, spread, inverse);
    }
    /* all are far below FLT_MAX, but for what is no number */
    return is_finite(innovation * step + state[0] + state[1] + state[3] + state[4])
               ? RHO_OK
               : RHO_ERROR_VALUE;
}

static inline void keep_floor(float *variance)
{
    if (*variance < RHO_KALMAN_VARIANCE_MIN) {
        *variance = RHO_KALMAN_VARIANCE_MIN;
    }
}

void rho_imm_plane_keep_floors(int num_states, float *covariance)
{
    keep_floor(&covariance[0]);
    keep_floor(&covariance[2]);
    keep_floor(&covariance[VX + 3]);
    keep_floor(&covariance[VY + 4]);
    if (num_states > RHO_PLANE_STEADY) {
        keep_floor(&covariance[AX + 6]);
        keep_floor(&covariance[AY + 7]);
    }
}
