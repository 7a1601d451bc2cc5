/* SPDX-License-Identifier: MIT */
/* learned_pd: the pd that is used, by the looks and hits that sensor_learning.c counts. */
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "sensors.h"

int rho_learning_is_on(const struct rho_tracker_config *config)
{
    return RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) && config->gate == RHO_TRACKER_BEST;
}

unsigned rho_learning_ring(const struct rho_sensor *sensor, const struct rho_track *track)
{
    const float dx_m = track->kalman.state[0] - sensor->x_m;
    const float dy_m = track->kalman.state[1] - sensor->y_m;
    const float share = rho_sqrt(dx_m * dx_m + dy_m * dy_m) / sensor->range_max_m;
    return share < 1.0f ? (unsigned)(share * (float)RHO_LEARN_RINGS) : RHO_LEARN_RINGS - 1u;
}

/* Estimate of a detection probability, and its standard deviation. */
struct pd_estimate {
    float pd, sigma;
};

static struct pd_estimate estimate_pd(float hits, float looks, float prior, float prior_pd)
{
    const float pd = (hits + prior * prior_pd) / (looks + prior);
    return (struct pd_estimate){pd, rho_sqrt(pd * (1.0f - pd) / (looks + prior))};
}

static struct pd_estimate estimate_over_rings(const struct rho_tracker_learned *learned, float pd)
{
    float looks = 0.0f, hits = 0.0f;
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        looks += (float)learned->looks[ring];
        hits += (float)learned->hits[ring];
    }
    return estimate_pd(hits, looks, PRIOR_OF_ALL, pd);
}

static float lowered_pd(const struct rho_tracker_config *config, const struct pd_estimate *seen,
                        float stated)
{
    const float pd = seen->pd + seen->sigma; /* with caution: raised by a sigma */
    const float least = config->learn_pd_min * stated;
    return !(seen->pd + PD_SURELY * seen->sigma < stated) ? stated : pd > least ? pd : least;
}

float rho_learning_pd_in_ring(const struct rho_tracker_config *config,
                              const struct rho_tracker_learned *learned, float stated,
                              unsigned ring)
{
    const struct pd_estimate all = estimate_over_rings(learned, stated);
    const struct pd_estimate seen =
        estimate_pd((float)learned->hits[ring], (float)learned->looks[ring], PRIOR_OF_RING, all.pd);
    return lowered_pd(config, &seen, stated);
}

static int is_lowered(const struct rho_look *look)
{
    return rho_learning_is_on(&look->tracker->config) && look->learned && look->learned->is_lowered;
}

struct detection rho_learning_detection(const struct rho_look *look, const struct rho_track *track,
                                        struct detection stated)
{
    if (!is_lowered(look)) {
        return stated;
    }
    const unsigned ring = rho_learning_ring(look->sensor, track);
    if (!(look->learned->is_lowered >> ring & 1u)) {
        return stated;
    }
    const float pd =
        rho_learning_pd_in_ring(&look->tracker->config, look->learned, look->sensor->pd, ring);
    return (struct detection){rho_log(pd), rho_log(1.0f - pd)};
}

float rho_learning_mean_pd(const struct rho_look *look)
{
    const float stated = look->sensor->pd;
    if (!is_lowered(look)) {
        return stated;
    }
    const struct pd_estimate all = estimate_over_rings(look->learned, stated);
    return lowered_pd(&look->tracker->config, &all, stated);
}
