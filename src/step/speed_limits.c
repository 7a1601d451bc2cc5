/* SPDX-License-Identifier: MIT */
/* speed_limits: tracks that move as no target does. */
#include "phases.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

static float speed2_of(const struct rho_track *track)
{
    const float *v_mps = &track->kalman.state[3];
    return rho_square(v_mps[0]) + rho_square(v_mps[1]) + rho_square(v_mps[2]);
}

int rho_speed_is_slow(const struct rho_tracker_config *config, const struct rho_track *track)
{
    const float least_mps = config->v_min_mps - SLOW_SIGMAS * rho_track_sigma_mps(track);
    return least_mps > 0.0f && !track->is_operators && speed2_of(track) < least_mps * least_mps;
}

int rho_speed_count_fast(const struct rho_tracker_config *config, struct rho_track *track)
{
    const float limit_mps =
        rho_larger(FAST_SHARE * config->v_max_mps,
                   config->v_max_mps + SURE_SIGMAS * rho_track_sigma_mps(track));
    if (track->plot >= 0) {
        track->fast_in_row =
            (uint8_t)(speed2_of(track) > limit_mps * limit_mps
                          ? track->fast_in_row + (track->fast_in_row < FAST_UPDATES ? 1 : 0)
                          : 0);
    }
    return track->fast_in_row >= FAST_UPDATES;
}
