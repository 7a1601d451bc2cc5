/* SPDX-License-Identifier: MIT */
#include "rhotrack/detail/bearing_mix.h"

#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

void rho_bearing_mix_add(struct rho_bearing_mix *mix, float weight, float off_rad,
                         float variance_rad2, float noise_rad2)
{
    const float distance2 = off_rad * off_rad / variance_rad2;
    const float share =
        weight * rho_exp(-0.5f * (distance2 + RHO_LOG_TWO_PI)) * rho_inverse_sqrt(variance_rad2);
    mix->hit += share;
    mix->off_rad += share * off_rad;
    mix->square_rad2 += share * off_rad * off_rad;
    mix->noise_rad2 += share * noise_rad2;
    mix->variance_rad2 += share * variance_rad2;
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
