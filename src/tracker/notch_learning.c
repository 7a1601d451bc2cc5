/* SPDX-License-Identifier: MIT */
/* notch_learning: the Doppler notch of a sensor that states none, from hits by range rate. */
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "sensors.h"

enum {
    RATE_LOOKS_MAX = 250, /* looks at which those of an interval are halved: they fit uint8_t */
    FORGOTTEN_MAX = 3     /* false notches after which none is learned any more: two bits */
};

/* Upper limit of the first num_rates intervals of range rates, m/s; 0: no interval. */
static float intervals_end_mps(unsigned num_rates)
{
    float end2 = RATE_MIN2;
    for (unsigned i = 1; i < num_rates; i++) {
        end2 *= 2.0f;
    }
    return num_rates > 0 ? rho_sqrt(end2) : 0.0f;
}

/* True where the sensor's description states no notch: it has none, or the learned one. */
static int is_notch_free(const struct rho_sensor *sensor, const struct rho_tracker_learned *learned)
{
    const float learned_mps = intervals_end_mps(learned->used_rates);
    return !(sensor->notch_mps > 0.0f) ||
           (sensor->notch_mps >= learned_mps && sensor->notch_mps <= learned_mps);
}

int rho_learning_seeks_notch(const struct rho_look *look)
{
    return RHO_DOPPLER_NOTCH && look->tracker->config.learn_pd_min < 1.0f &&
           is_notch_free(look->sensor, look->learned);
}

void rho_learning_apply_notch(const struct rho_look *look)
{
    struct rho_tracker_learned *learned = look->learned;
    if (learned && rho_learning_is_on(&look->tracker->config) && rho_learning_seeks_notch(look)) {
        learned->used_rates = learned->blind_rates;
        look->row->sensor.notch_mps = intervals_end_mps(learned->used_rates);
    }
}

/* Number of intervals, from range rate 0 on, that make up a notch (BLIND_SHARE); 0: no notch. */
static unsigned count_blind_intervals(const struct rho_tracker_learned *learned)
{
    const unsigned used = learned->blind_rates;
    const float last = used > 0 ? BLIND_USED_SHARE : BLIND_LAST_SHARE;
    float looks = 0.0f, hits = 0.0f, faster = 0.0f, faster_hits = 0.0f;
    for (unsigned i = 0; i < RHO_LEARN_RATES; i++) {
        looks += (float)learned->rate_looks[i];
        hits += (float)learned->rate_hits[i];
    }
    for (unsigned i = RHO_LEARN_RATES; i >= RATES_LEAST; i--) {
        const float pd = faster > 0.0f ? faster_hits / faster : 0.0f;
        const float here = (float)learned->rate_looks[i - 1u],
                    seen = (float)learned->rate_hits[i - 1u];
        if (i == used) { /* kept, or without its fastest interval, or no notch at all */
            return hits > BLIND_SHARE * pd * looks ? 0u
                   : used > RATES_LEAST && here >= BLIND_USED_LOOKS && seen > last * pd * here
                       ? used - 1u
                       : used;
        }
        if (faster >= FASTER_LOOKS && looks >= BLIND_LOOKS && seen < last * pd * here &&
            hits < BLIND_SHARE * pd * looks &&
            hits + BLIND_SURELY * rho_sqrt(pd * (1.0f - pd) * looks) < pd * looks) {
            return i;
        }
        faster += here;
        faster_hits += seen;
        looks -= here;
        hits -= seen;
    }
    return 0;
}

void rho_learning_count_rate(const struct rho_look *look, const struct rho_track *track,
                             unsigned is_seen)
{
    struct rho_tracker_learned *learned = look->learned;
    unsigned rate = RHO_LEARN_RATES - 1u; /* where the range rate is not defined */
    float row[6], rate_mps;
    if (rho_measurement_predict_rate(track->kalman.state, look->sensor,
                                     track->kalman.covariance[RHO_AT(2, 2)] > 0.0f, row,
                                     &rate_mps)) {
        /* the squares of the intervals' limits double, so that the float's exponent is the index */
        const uint32_t exponent = rho_float_bits(rate_mps * rate_mps / RATE_MIN2) >> 23;
        const uint32_t of_one = rho_float_bits(1.0f) >> 23;
        rate = exponent < of_one               ? 0u
               : exponent - of_one + 1u < rate ? exponent - of_one + 1u
                                               : rate;
    }
    uint8_t *looks = &learned->rate_looks[rate], *hits = &learned->rate_hits[rate];
    *looks = (uint8_t)(*looks + 1u);
    *hits = (uint8_t)(*hits + is_seen);
    if (*looks >= RATE_LOOKS_MAX) {
        *looks = (uint8_t)(*looks / 2u);
        *hits = (uint8_t)(*hits / 2u);
    }
    if (*looks % LOOKS_A_NOTCH != 0) {
        return;
    }
    const unsigned found =
        learned->notches_forgotten < FORGOTTEN_MAX ? count_blind_intervals(learned) : 0u;
    if (found == 0 && learned->blind_rates > 0) {
        learned->notches_forgotten = (learned->notches_forgotten + 1u) & FORGOTTEN_MAX;
    }
    if (found > learned->blind_rates) {
        rho_pd_forget(look->row); /* it was learned with targets in the notch */
    }
    learned->blind_rates = found & 31u;
}

float rho_learning_notch_mps(const struct rho_sensor *sensor,
                             const struct rho_tracker_learned *learned)
{
    return RHO_DOPPLER_NOTCH && is_notch_free(sensor, learned)
               ? intervals_end_mps(learned->blind_rates)
               : 0.0f;
}

int rho_learning_is_sound_notch(const struct rho_tracker_learned *learned)
{
    for (unsigned i = 0; i < RHO_LEARN_RATES; i++) {
        if (learned->rate_hits[i] > learned->rate_looks[i] ||
            learned->rate_looks[i] > RATE_LOOKS_MAX) {
            return 0;
        }
    }
    return learned->blind_rates <= RHO_LEARN_RATES && learned->used_rates <= RHO_LEARN_RATES;
}
