/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/bearing_mix.h"

#include <float.h>

#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

int rho_bearing_expect(const struct rho_kalman *estimate, const struct rho_weighed_bearings *look,
                       unsigned i, struct rho_expected_bearing *expected)
{
    const struct rho_bearing_scan *scan = look->scan;
    const struct rho_bearing *bearing = &scan->bearings[i];
    const struct rho_slope slope = rho_measurement_slope(scan, bearing);
    struct rho_kalman_bearing seen;
    float projected[RHO_KALMAN_STATES], slope_nis;
    if (!rho_kalman_linearise_bearing(
            estimate, scan->x_m, scan->y_m, bearing->bearing_rad,
            rho_sqrt(bearing->sigma_rad * bearing->sigma_rad + look->lasting_rad2), &seen)) {
        return 0;
    }
    const float variance_m2 =
        rho_linalg_project6(estimate->covariance, seen.row, projected) + seen.variance_m2;
    if (!(variance_m2 <= FLT_MAX)) {
        return 0;
    }
    const float nis = seen.off_m * seen.off_m / variance_m2;
    expected->off_rad = seen.off_m / seen.range_m;
    expected->variance_rad2 = variance_m2 / (seen.range_m * seen.range_m);
    expected->density = rho_kalman_slope_density(estimate, &slope, &slope_nis) *
                        rho_exp(-0.5f * (nis + RHO_LOG_TWO_PI)) *
                        rho_inverse_sqrt(expected->variance_rad2);
    expected->nis = slope_nis > nis ? slope_nis : nis; /* NaN where nis is */
    return 1;
}

void rho_bearing_mix_add(struct rho_bearing_mix *mix, const struct rho_weighed_bearings *look,
                         unsigned i, const struct rho_expected_bearing *expected)
{
    const float sigma_rad = look->scan->bearings[i].sigma_rad, off_rad = expected->off_rad;
    const float share = look->weight[i] * expected->density;
    mix->hit += share;
    mix->off_rad += share * off_rad;
    mix->square_rad2 += share * off_rad * off_rad;
    mix->noise_rad2 += share * (sigma_rad * sigma_rad + look->lasting_in_estimate_rad2);
    mix->variance_rad2 += share * expected->variance_rad2;
}

int rho_bearing_mix_as_one(const struct rho_bearing_mix *mix, float miss, float *off_rad,
                           float *sigma_rad)
{
    if (!(mix->hit > 0.0f)) {
        return 0;
    }
    const float sum = miss + mix->hit;
    const float variance = mix->variance_rad2 / mix->hit, noise = mix->noise_rad2 / mix->hit;
    const float mean_rad = mix->off_rad / sum;
    const float gain = mix->hit / sum - (mix->square_rad2 / sum - mean_rad * mean_rad) / variance;
    if (!(gain > MIX_GAIN_MIN)) {
        return 0;
    }
    *off_rad = mean_rad / gain;
    *sigma_rad = rho_sqrt(variance / gain - (variance - noise));
    return 1;
}
