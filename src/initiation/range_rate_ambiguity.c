/* SPDX-License-Identifier: MIT */
/*
 * range_rate_ambiguity: the aliases of an ambiguous range rate, that is, its possible values a span
 * apart. The velocity between the plots of a kernel excludes most aliases. Each of the others is
 * tried, and sharpens the velocity along the line of sight as an unambiguous range rate would.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/*
 * Factor below 1 that keeps a variance positive when float32 rounds the sums of products in its
 * update.
 */
#define LESS_THAN_ALL (1.0f - 4.0e-6f)

/* Whole ambiguity spans that fit into `spans`, at most ALIASES_MAX. */
static int limited_whole_spans(float spans)
{
    return spans < (float)ALIASES_MAX ? (int)spans : ALIASES_MAX;
}

int rho_initiator_find_aliases_if_ambiguous(const struct rho_window_scan *scan,
                                            const struct rho_window_plot *plot,
                                            const struct rho_window_place *place,
                                            struct aliases *aliases)
{
    if (!(scan->measures & RHO_MEASURES_RANGE_RATE) ||
        !rho_measurement_has_ambiguous_range_rates(&scan->sensor) ||
        !rho_window_compare_range_rate(scan, plot, place, &aliases->seen)) {
        return 0;
    }
    aliases->span_mps = scan->sensor.range_rate_span_mps;
    float reach_mps = rho_sqrt(RHO_GATE_CHI2_1D * aliases->seen.variance);
    /* the nearest alias is in the gate, or nearly: at least that one is listed */
    float error_mps = aliases->seen.error_mps;
    aliases->last =
        limited_whole_spans(rho_larger(reach_mps - error_mps, 0.0f) / aliases->span_mps);
    aliases->first =
        -limited_whole_spans(rho_larger(reach_mps + error_mps, 0.0f) / aliases->span_mps);
    return 1;
}

/* Kalman update of the velocity by alias i of the range rate: V - V u u^T V / s^2. */
void rho_initiator_update_kernel_velocity_by_alias(const struct aliases *aliases, int i,
                                                   const struct rho_window_place *place,
                                                   struct rho_window_place *known)
{
    const struct rho_window_plot_noise_covariance *noise = &place->velocity_noise;
    const float *u = aliases->seen.along;
    const float toward[3] = {noise->xx_m2 * u[0] + noise->xy_m2 * u[1],
                             noise->xy_m2 * u[0] + noise->yy_m2 * u[1], noise->zz_m2 * u[2]};
    float per_variance = 1.0f / aliases->seen.variance;
    float share = (aliases->seen.error_mps + (float)i * aliases->span_mps) * per_variance;
    *known = *place;
    for (int k = 0; k < 3; k++) {
        known->more_mps[k] = toward[k] * share;
    }
    /* rounding must not make a variance negative */
    per_variance *= LESS_THAN_ALL;
    known->velocity_noise.xx_m2 -= toward[0] * toward[0] * per_variance;
    known->velocity_noise.xy_m2 -= toward[0] * toward[1] * per_variance;
    known->velocity_noise.yy_m2 -= toward[1] * toward[1] * per_variance;
    known->velocity_noise.zz_m2 -= toward[2] * toward[2] * per_variance;
}
