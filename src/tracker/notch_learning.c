/* SPDX-License-Identifier: MIT */
/*
 * notch_learning: the Doppler notch of a sensor of which none was stated, from looks and hits by
 * interval of range rate.
 */
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "sensors.h"

/*
 * A learned notch: the pd in its intervals of range rates is below BLIND_SHARE of the pd at faster
 * ones, by BLIND_SURELY standard deviations, and in its fastest interval below BLIND_LAST_SHARE;
 * with at least BLIND_LOOKS looks in it and FASTER_LOOKS above. A notch in use loses its fastest
 * interval where the pd there is above BLIND_USED_SHARE, after BLIND_USED_LOOKS looks: all misses
 * count then, as tracks coast in the notch instead of ending.
 */
#define BLIND_SHARE 0.65f
#define BLIND_LAST_SHARE 0.85f
#define BLIND_USED_SHARE 0.6f
#define BLIND_USED_LOOKS 40.0f
#define BLIND_SURELY 4.0f
#define BLIND_LOOKS 20.0f
#define FASTER_LOOKS 60.0f
#define RATE_MIN2 0.0625f   /* square of the upper limit of the first interval, m^2/s^2 */
#define FLOAT_EXPONENT 127u /* biased exponent in the bits of 1.0f */
#define RATE_LOOKS_MAX 250  /* looks in an interval at which its looks and hits are halved */
#define LOOKS_A_NOTCH 8u    /* looks in an interval from one search for a notch to the next */
#define RATES_LEAST 4u      /* fewest intervals of a notch: targets that stop look like fewer */
#define FORGOTTEN_MAX 3u    /* false notches after which no notch is learned any more */

/* Upper limit of the first num_rates intervals of range rates, m/s. */
static float intervals_end_mps(unsigned num_rates)
{
    float end2 = RATE_MIN2;
    for (unsigned i = 1; i < num_rates; i++) {
        end2 *= 2.0f;
    }
    return rho_sqrt(end2);
}

/* True where the sensor's description states no notch: it has none, or the learned one. */
static int is_notch_free(const struct rho_sensor *sensor, const struct rho_tracker_learned *learned)
{
    const float learned_mps =
        learned->used_rates > 0 ? intervals_end_mps(learned->used_rates) : 0.0f;
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
        look->row->sensor.notch_mps =
            learned->used_rates > 0 ? intervals_end_mps(learned->used_rates) : 0.0f;
    }
}

/* Index of the interval of a track's range rate; the last one where the rate is not defined. */
static unsigned interval_of_rate(const struct rho_sensor *sensor, const struct rho_track *track)
{
    float row[6], rate_mps;
    if (!rho_measurement_predict_rate(track->kalman.state, sensor,
                                      track->kalman.covariance[RHO_AT(2, 2)] > 0.0f, row,
                                      &rate_mps)) {
        return RHO_LEARN_RATES - 1u;
    }
    /* the squares of the intervals' limits double, so that the float's exponent is the index */
    const uint32_t exponent = rho_float_bits(rate_mps * rate_mps / RATE_MIN2) >> 23;
    if (exponent < FLOAT_EXPONENT) {
        return 0;
    }
    return exponent - FLOAT_EXPONENT + 1u < RHO_LEARN_RATES ? exponent - FLOAT_EXPONENT + 1u
                                                            : RHO_LEARN_RATES - 1u;
}

/*
 * New number of intervals of a notch in use: as before, one less, or 0. last_looks and last_hits
 * are of its fastest interval, looks and hits of all, faster_pd of the intervals above.
 */
static unsigned keep_notch(unsigned used, float last_looks, float last_hits, float looks,
                           float hits, float faster_pd)
{
    if (hits > BLIND_SHARE * faster_pd * looks) {
        return 0;
    }
    return used > RATES_LEAST && last_looks >= BLIND_USED_LOOKS &&
                   last_hits > BLIND_USED_SHARE * faster_pd * last_looks
               ? used - 1u
               : used;
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
        if (i == used) {
            return keep_notch(used, here, seen, looks, hits, pd);
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

static void update_learned_notch(struct rho_tracker_learned *learned)
{
    const unsigned found =
        learned->notches_forgotten < FORGOTTEN_MAX ? count_blind_intervals(learned) : 0u;
    if (found == 0 && learned->blind_rates > 0) {
        learned->notches_forgotten = (learned->notches_forgotten + 1u) & FORGOTTEN_MAX;
    }
    if (found > learned->blind_rates) {
        /* the pd of the rings was learned with targets in the notch: it begins anew */
        learned->is_lowered = 0;
        for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
            learned->looks[ring] = learned->hits[ring] = 0;
        }
    }
    learned->blind_rates = found & 31u;
}

/*
 * Counts a look in the interval of the track's range rate, and looks for a notch now and then.
 * Returns 1 where the interval is outside of the notch.
 */
int rho_learning_count_rate(const struct rho_look *look, const struct rho_track *track,
                            unsigned is_seen)
{
    struct rho_tracker_learned *learned = look->learned;
    const unsigned rate = interval_of_rate(look->sensor, track);
    learned->rate_looks[rate] = (uint8_t)(learned->rate_looks[rate] + 1u);
    learned->rate_hits[rate] = (uint8_t)(learned->rate_hits[rate] + is_seen);
    if (learned->rate_looks[rate] >= RATE_LOOKS_MAX) {
        learned->rate_looks[rate] = (uint8_t)(learned->rate_looks[rate] / 2u);
        learned->rate_hits[rate] = (uint8_t)(learned->rate_hits[rate] / 2u);
    }
    if (learned->rate_looks[rate] % LOOKS_A_NOTCH == 0) {
        update_learned_notch(learned);
    }
    return rate >= learned->blind_rates;
}

float rho_learning_notch_mps(const struct rho_sensor *sensor,
                             const struct rho_tracker_learned *learned)
{
    return RHO_DOPPLER_NOTCH && learned->blind_rates > 0 && is_notch_free(sensor, learned)
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
