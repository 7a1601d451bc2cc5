/* SPDX-License-Identifier: MIT */
/* doppler_notch: an estimate's probability in the notch, and its update by a miss. */
#include "rhotrack/detail/doppler_notch.h"

#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/detail/measurement.h"

int rho_notch_is_valid(const struct rho_sensor *sensor)
{
    const float notch_mps = sensor->notch_mps, blind_mps = sensor->blind_speed_mps;
    const float speed_max_mps = 2.0f * RHO_LIMIT_SPEED_MPS;
    return rho_is_within(notch_mps, 0.0f, speed_max_mps) &&
           rho_is_within(blind_mps, 0.0f, speed_max_mps) &&
           (!(blind_mps > 0.0f) || blind_mps > 2.0f * notch_mps);
}

static float normal_density(float sigmas)
{
    return rho_exp(-0.5f * sigmas * sigmas) * (1.0f / RHO_ROOT_TWO_PI);
}

/*
 * Cumulative normal distribution at a number of sigmas; density: the normal density there. M.
 * Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, 26.2.17: within 1e-7.
 */
static float normal_cdf(float sigmas, float density)
{
    const float k = 1.0f / (1.0f + 0.2316419f * rho_magnitude(sigmas));
    const float beyond =
        density * k *
        (0.31938153f +
         k * (-0.356563782f + k * (1.781477937f + k * (-1.821255978f + k * 1.330274429f))));
    return sigmas < 0.0f ? beyond : 1.0f - beyond;
}

/* Integrals of 1, x, x^2 over the blind zones, for a normal x: the range rate's sigmas off. */
struct blind_moments_sum {
    float share, first, second;
};

static struct blind_moments_sum blind_moments(float notch_mps, float blind_mps, float mean_mps,
                                              float sigma_mps)
{
    struct blind_moments_sum sum = {0.0f, 0.0f, 0.0f};
    const float per_sigma = 1.0f / sigma_mps;
    const float reach_mps = ZONE_SIGMAS * sigma_mps + notch_mps;
    /* multiples of the blind speed whose zones are tested */
    int32_t first = 0, last = 0;
    if (blind_mps > 0.0f) {
        if (2.0f * reach_mps > (float)ZONES_MAX * blind_mps) {
            const float share = 2.0f * notch_mps / blind_mps;
            return (struct blind_moments_sum){share, 0.0f, share};
        }
        const float before = (mean_mps - reach_mps) / blind_mps;
        if (!rho_is_within(before, -1.0e6f, 1.0e6f)) {
            return sum; /* the mean is beyond any target's range rate */
        }
        first = (int32_t)before;
        last = first + ZONES_MAX + 1;
    }
    for (int32_t number = first; number <= last; number++) {
        const float off_mps = (float)number * blind_mps - mean_mps;
        if (off_mps <= reach_mps && off_mps >= -reach_mps) {
            const float from = (off_mps - notch_mps) * per_sigma;
            const float to = (off_mps + notch_mps) * per_sigma;
            const float at_from = normal_density(from), at_to = normal_density(to);
            const float share = normal_cdf(to, at_to) - normal_cdf(from, at_from);
            sum.share += share;
            sum.first += at_from - at_to;
            sum.second += share + from * at_from - to * at_to;
        }
    }
    sum.share = sum.share < 0.0f ? 0.0f : sum.share < 1.0f ? sum.share : 1.0f;
    return sum;
}

/* A linear function of the state, such as the range rate, with its mean and variance. */
struct component {
    float row[6];
    float mean, variance;
};

/* Returns 0 where no range rate can be predicted. */
static int predict_range_rate(const struct rho_sensor *sensor, const float *state,
                              const float *covariance, struct component *view)
{
    float projected[6];
    if (!rho_measurement_predict_rate(state, sensor, covariance[RHO_AT(2, 2)] > 0.0f, view->row,
                                      &view->mean)) {
        return 0;
    }
    view->variance = rho_linalg_project6(covariance, view->row, projected);
    return rho_is_within(view->variance, RHO_VARIANCE_MIN, RHO_VARIANCE_MAX);
}

float rho_notch_blind_probability(const struct rho_sensor *sensor, const float *state,
                                  const float *covariance)
{
    struct component view;
    return rho_notch_sensor_has_notch(sensor) &&
                   predict_range_rate(sensor, state, covariance, &view)
               ? blind_moments(sensor->notch_mps, sensor->blind_speed_mps, view.mean,
                               rho_sqrt(view.variance))
                     .share
               : 0.0f;
}

/* Gives a linear function of the state another mean and variance; the rest follows. */
static void impose_component_moments(const struct component *view, float mean_shift,
                                     float new_variance, int num_states, float *state,
                                     float *covariance)
{
    const float per_variance = 1.0f / view->variance;
    const float taken = (view->variance - new_variance) * per_variance * per_variance;
    float projected[9];
    for (int i = 0; i < num_states; i++) {
        projected[i] = 0.0f;
        for (int j = 0; j < 6; j++) {
            projected[i] += view->row[j] * covariance[i > j ? RHO_AT(i, j) : RHO_AT(j, i)];
        }
    }
    for (int i = 0; i < num_states; i++) {
        state[i] += projected[i] * mean_shift * per_variance;
        for (int j = 0; j < i; j++) {
            covariance[RHO_AT(i, j)] -= projected[i] * projected[j] * taken;
        }
        float *own = &covariance[RHO_AT(i, i)];
        if (*own > 0.0f) {
            *own = *own * RHO_ROUNDING_ALLOWANCE - projected[i] * projected[i] * taken;
            *own = *own > RHO_VARIANCE_MIN ? *own : RHO_VARIANCE_MIN;
        }
    }
}

/*
 * Measures the speed across the line of sight as 0, with the notch's width as its sigma, if it is
 * within two sigmas of 0: a standing target has no speed across, either.
 */
static void impose_standing(const struct component *rate, float notch_mps, int num_states,
                            float *state, float *covariance)
{
    struct component across = {.row = {0.0f, 0.0f, 0.0f, -rate->row[4], rate->row[3], 0.0f}};
    float projected[6];
    across.mean = across.row[3] * state[3] + across.row[4] * state[4];
    across.variance = rho_linalg_project6(covariance, across.row, projected);
    const float most_mps = RHO_NOTCH_STAND_WIDTHS * notch_mps;
    if (across.variance > RHO_VARIANCE_MIN &&
        across.mean * across.mean <
            RHO_NOTCH_STAND_WIDTHS * RHO_NOTCH_STAND_WIDTHS * across.variance +
                most_mps * most_mps) {
        const float kept = notch_mps * notch_mps / (across.variance + notch_mps * notch_mps);
        impose_component_moments(&across, across.mean * (kept - 1.0f), across.variance * kept,
                                 num_states, state, covariance);
    }
}

float rho_notch_update_by_miss(const struct rho_sensor *sensor, const struct rho_notch_look *look,
                               int num_states, float *state, float *covariance)
{
    struct component rate;
    const int rests = look->rest_mps > 0.0f;
    if (!(rests || rho_notch_sensor_has_notch(sensor)) ||
        !predict_range_rate(sensor, state, covariance, &rate)) {
        return 1.0f - look->pd;
    }
    const float sigma = rho_sqrt(rate.variance), seen = 1.0f - look->pd;
    const float notch_mps = rests ? look->rest_mps : sensor->notch_mps;
    const struct blind_moments_sum blind =
        blind_moments(notch_mps, rests ? 0.0f : sensor->blind_speed_mps, rate.mean, sigma);
    const float missed = seen + look->pd * blind.share;
    const float off = look->pd * blind.first / missed;
    float kept = (seen + look->pd * blind.second) / missed - off * off;
    kept = kept > KEPT_MIN ? kept < KEPT_MAX ? kept : KEPT_MAX : KEPT_MIN;
    if (blind.share > 0.0f) {
        impose_component_moments(&rate, off * sigma, rate.variance * kept, num_states, state,
                                 covariance);
    }
    if (look->may_stand && blind.share > STAND_SHARE * missed) {
        impose_standing(&rate, notch_mps, num_states, state, covariance);
    }
    return missed;
}
