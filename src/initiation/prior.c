/* SPDX-License-Identifier: MIT */
/*
 * prior: what is assumed of targets before any plot is seen: detection probabilities, and the
 * density of births over area and velocity.
 */
#include "rhotrack/detail/approx.h"
#include "search.h"

/*
 * ln of the expected number of targets in the area and window before any plot is seen: a half, so
 * that one target and none are equally likely.
 */
#define LOG_TARGETS_EXPECTED LOG_HALF

/*
 * ln of the volume of heights and range rates over which clutter and births are spread, apart from
 * positions and velocities in the plane.
 */
float rho_initiator_log_height_and_range_rate_volume(const struct search *search, int has_z,
                                                     unsigned heights, unsigned range_rates)
{
    float v_max_mps = search->initiator->config.v_max_mps;
    float room = (float)range_rates * rho_log(2.0f * v_max_mps);
    if (has_z) {
        room += ((float)heights - 1.0f) * rho_log(RHO_CLUTTER_HEIGHT_M) -
                rho_log(2.0f * CLIMB_SHARE * v_max_mps);
    }
    return room;
}

void rho_initiator_set_pd_and_birth_prior(struct search *search)
{
    struct rho_initiator *initiator = search->initiator;
    const struct rho_initiator_config *config = &initiator->config;
    for (unsigned m = 0; m < search->num_scans; m++) {
        float sensor_pd = rho_window_scan_at(&initiator->window, m)->sensor.pd;
        float pd = sensor_pd > 0.0f ? sensor_pd : config->pd;
        search->log_pd[m] = rho_log(pd);
        search->log_miss[m] = rho_log(1.0f - pd);
    }
    /* births are uniform over the area and over the ring of allowed velocities */
    search->log_prior =
        LOG_TARGETS_EXPECTED - rho_log(rho_initiator_area_m2(initiator)) - LOG_PI -
        rho_log(config->v_max_mps * config->v_max_mps - config->v_min_mps * config->v_min_mps);
}
