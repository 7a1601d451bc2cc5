/* SPDX-License-Identifier: MIT */
/*
 * sensor_learning: estimates the noise, the detection probability and the Doppler notch of a sensor
 * from established tracks, where they differ from the stated ones.
 *
 * Noise: when a steady track claims a plot, its innovation v on an axis, along the line of sight or
 * across it, has the variance p + f r: p of the steady filter's prediction, r of the plot's stated
 * noise, f the learned factor. The normalised innovations u = v / sqrt(p + f r) are white, so that
 * half of the squared difference of two successive ones is 1 on average. The difference removes
 * errors of the prediction that last for some scans, as in a turn. With e = (u - u_before)^2 / 2,
 * cut at c^2 because of plots of clutter, and b the mean of min(e, c^2),
 *
 *      ln f += g (min(e, c^2) / b - 1),        g = 3 / (n + 40) of the n-th innovation
 *
 * Tracks that two sensors have seen are left out: a bias of one sensor would look like noise of the
 * other. Where the noise is more than about 2.5 times the stated one, tracks seem to manoeuvre all
 * the time and teach little: `rhotrack calibrate` finds such noise.
 *
 * P_D: of all looks at a track that follow a look with a plot, the share with a plot. A look
 * without a plot is counted when the track is seen again, so that targets that have gone count no
 * misses. Of several misses in a row the first alone is counted, so that the learned pd is rather
 * too high; it is never above the stated one.
 */
#include "clutter.h"
#include "plots.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "rhotrack/detail/measurement.h"
#include "sensors.h"
#include "step.h"

/* Largest probability of the manoeuvring model at which a track teaches the sensor's noise. */
#define MANEUVER_MAX 0.2f
enum { HAS_INNOVATION = 1, IS_MISSED = 2 }; /* bits of has_shown */
/* Units of track->shown for an innovation of one sigma, and the largest that an int8_t holds. */
#define SHOWN_PER_SIGMA 16.0f
#define SIGMAS_MAX (127.0f / SHOWN_PER_SIGMA)

/* c^2, at which e is cut, and b, the mean of min(e, c^2) with normal noise. */
#define CUT2 2.25f
#define MEAN_CUT 0.7785f
/* The gain g of the n-th innovation is GAIN / (n + INNOVATIONS_PRIOR). */
#define GAIN 3.0f
#define INNOVATIONS_PRIOR 40.0f
#define LOG_NOISE_MAX 4.6f /* limit of ln f, either way: 10 times the sigma */
/* Fewest innovations for learned noise to be used; the count stops at the second. */
#define INNOVATIONS_MIN 100
#define INNOVATIONS_MAX 1000
/* Least share of the plot's noise in an innovation's variance; the rest is of the prediction. */
#define NOISE_SHARE_MIN 0.4f
/*
 * Largest ln f, either way, at which the noise counts as stated: AS_STATED, plus CHANCE over the
 * root of the number of innovations for chance.
 */
#define AS_STATED 0.25f
#define CHANCE 4.0f

/* Prior weights in looks: of the stated pd for all rings; of the pd of all rings for one ring. */
#define PRIOR_OF_ALL 30.0f
#define PRIOR_OF_RING 20.0f
/* Looks at a ring of range at which its looks and hits are halved. */
#define LOOKS_MAX 1000
/* Largest share of blind looks, per cent, at which a look teaches the pd of a ring. */
#define BLIND_PERCENT_MAX 2
/*
 * Standard deviations by which the learned pd must be below the stated one to be used, and by which
 * it is then raised.
 */
#define SURELY 2.5f
#define CAUTION 1.0f

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

/* Sensors are learned with hypotheses alone: one Kalman filter takes manoeuvres for noise. */
static int is_sensor_learning_on(const struct rho_tracker_config *config)
{
    return RHO_HAS_FILTER(RHO_TRACK_HYPOTHESES) && config->gate == RHO_TRACKER_BEST;
}

static int is_noise_learning_on(const struct rho_tracker_config *config)
{
    return is_sensor_learning_on(config) &&
           (config->learn_noise_min < 1.0f || config->learn_noise_max > 1.0f);
}

static int is_pd_learning_on(const struct rho_tracker_config *config)
{
    return config->learn_pd_min < 1.0f;
}

/* ---- use of noise ---------------------------------------------------------------------------- */

static float usable_sigma_factor(const struct rho_tracker *tracker,
                                 const struct rho_tracker_learned *learned, int axis)
{
    const float log_noise = learned->log_noise[axis];
    const float most = AS_STATED + CHANCE / rho_sqrt(1.0f + (float)learned->innovations);
    if (!is_noise_learning_on(&tracker->config) || learned->innovations < INNOVATIONS_MIN ||
        (log_noise <= most && log_noise >= -most)) {
        return 1.0f;
    }
    const float factor = rho_exp(0.5f * log_noise);
    const float least =
        factor > tracker->config.learn_noise_min ? factor : tracker->config.learn_noise_min;
    return least < tracker->config.learn_noise_max ? least : tracker->config.learn_noise_max;
}

static uint16_t percent_of_factor(float factor)
{
    return (uint16_t)(100.0f * factor + 0.5f);
}

void rho_learning_write_noise(const struct rho_look *look, float suspicion,
                              struct rho_sensor *sensor)
{
    if (look->learned) {
        sensor->sigma_range_percent =
            percent_of_factor(suspicion * usable_sigma_factor(look->tracker, look->learned, 0));
        sensor->sigma_cross_percent =
            percent_of_factor(suspicion * usable_sigma_factor(look->tracker, look->learned, 1));
    }
}

/* ---- noise learned --------------------------------------------------------------------------- */

static const struct rho_kalman *steady_filter_if_not_turning(const struct rho_look *look,
                                                             const struct rho_track *track)
{
    const struct rho_hypotheses *pool = &look->tracker->hypotheses;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, track->slot); i++) {
        const struct rho_hypothesis *at = rho_hypotheses_at(pool, track->slot, i);
        if (at->weight_nat >= 0.0f) {
            return at->time_us == look->time_us && at->imm.probability < MANEUVER_MAX
                       ? &at->imm.steady
                       : 0;
        }
    }
    return 0;
}

/* Innovation along a direction, over its sigma; true where enough of its variance is plot noise. */
struct innovation {
    float sigmas;
    int is_clear;
};

/*
 * Innovation of a plot along a direction (x, y), over its sigma. noise_m2 is the variance of the
 * noise that is learned, up_m2 that of the height's noise, which is not.
 */
static struct innovation innovation_along(const struct rho_kalman *steady,
                                          const struct rho_plot *plot, float x, float y,
                                          float noise_m2, float up_m2)
{
    const float after_s = (float)plot->offset_us * 1e-6f, *state = steady->state;
    const float *p = steady->covariance, vx = x * after_s, vy = y * after_s;
    const float predicted_m2 =
        x * (x * p[RHO_AT(0, 0)] +
             2.0f * (y * p[RHO_AT(1, 0)] + vx * p[RHO_AT(3, 0)] + vy * p[RHO_AT(4, 0)])) +
        y * (y * p[RHO_AT(1, 1)] + 2.0f * (vx * p[RHO_AT(3, 1)] + vy * p[RHO_AT(4, 1)])) +
        vx * (vx * p[RHO_AT(3, 3)] + 2.0f * vy * p[RHO_AT(4, 3)]) + vy * vy * p[RHO_AT(4, 4)];
    const float variance_m2 = predicted_m2 + noise_m2 + up_m2;
    const float off_m = x * (plot->x_m - state[0] - after_s * state[3]) +
                        y * (plot->y_m - state[1] - after_s * state[4]);
    const float sigmas = off_m / rho_sqrt(variance_m2);
    return (struct innovation){sigmas > SIGMAS_MAX    ? SIGMAS_MAX
                               : sigmas > -SIGMAS_MAX ? sigmas
                                                      : -SIGMAS_MAX,
                               noise_m2 >= NOISE_SHARE_MIN * variance_m2};
}

/*
 * Half of the squared difference from the track's last innovation on an axis, cut at CUT2; below 0
 * where it is not to be used. Stores the new innovation in the track.
 */
static float half_squared_change_store_innovation(struct rho_track *track, int axis,
                                                  const struct innovation *now)
{
    const float off = now->sigmas - (float)track->shown[axis] * (1.0f / SHOWN_PER_SIGMA);
    const float square = 0.5f * off * off;
    track->shown[axis] = (int8_t)(now->sigmas * SHOWN_PER_SIGMA);
    return !(track->has_shown & HAS_INNOVATION) || !now->is_clear ? -1.0f
           : square < CUT2                                        ? square
                                                                  : CUT2;
}

static int update_log_noise(float *log_noise, float excess, float gain)
{
    if (excess < 0.0f) {
        return 0;
    }
    const float sum = *log_noise + gain * (excess / MEAN_CUT - 1.0f);
    *log_noise = sum > LOG_NOISE_MAX ? LOG_NOISE_MAX : sum < -LOG_NOISE_MAX ? -LOG_NOISE_MAX : sum;
    return 1;
}

/*
 * Learns a sensor's noise from a plot of a steady track. factors are those learned so far, on the
 * variances along the line of sight and across it.
 */
static void learn_noise_from_plot(const struct rho_look *look, struct rho_track *track,
                                  const struct rho_plot *plot, const float factors[2])
{
    struct rho_tracker_learned *learned = look->learned;
    const struct rho_kalman *steady = steady_filter_if_not_turning(look, track);
    const float dx_m = plot->x_m - look->sensor->x_m, dy_m = plot->y_m - look->sensor->y_m;
    const float range_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    if (!steady || !(range_m > 1.0f)) {
        track->has_shown &= IS_MISSED;
        return;
    }
    const float x = dx_m / range_m, y = dy_m / range_m;
    /* the noises along a rising line of sight and of the height, projected into the plane */
    const int has_z = (look->scan->measures & RHO_MEASURES_Z) != 0;
    const float dz_m = has_z ? plot->z_m - look->sensor->z_m : 0.0f;
    const float rise2 = dz_m * dz_m / (dz_m * dz_m + range_m * range_m);
    const float up_m2 = has_z ? rise2 * plot->sigma_up_m * plot->sigma_up_m : 0.0f;
    const float along_m2 = plot->sigma_range_m * plot->sigma_range_m;
    const float across_m2 = plot->sigma_cross_m * plot->sigma_cross_m;
    const struct innovation along =
        innovation_along(steady, plot, x, y, (1.0f - rise2) * along_m2 * factors[0], up_m2);
    const struct innovation across =
        innovation_along(steady, plot, -y, x, across_m2 * factors[1], 0.0f);
    const float along_excess = half_squared_change_store_innovation(track, 0, &along);
    const float across_excess = half_squared_change_store_innovation(track, 1, &across);
    const float gain = GAIN / (INNOVATIONS_PRIOR + (float)learned->innovations);
    const int is_round = along_m2 <= across_m2 && along_m2 >= across_m2;
    int is_used = update_log_noise(&learned->log_noise[0], along_excess, gain);
    if (is_round) {
        /* the noise of isotropic plots is learned as one value for both axes */
        is_used |= update_log_noise(&learned->log_noise[0], across_excess, gain);
        learned->log_noise[1] = learned->log_noise[0];
    } else {
        is_used |= update_log_noise(&learned->log_noise[1], across_excess, gain);
    }
    track->has_shown |= HAS_INNOVATION;
    learned->innovations =
        (uint16_t)(learned->innovations + (is_used && learned->innovations < INNOVATIONS_MAX));
}

/* ---- pd -------------------------------------------------------------------------------------- */

static unsigned range_ring_of_track(const struct rho_sensor *sensor, const struct rho_track *track)
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

static struct pd_estimate estimate_pd_over_all_rings(const struct rho_tracker_learned *learned,
                                                     float pd)
{
    float looks = 0.0f, hits = 0.0f;
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        looks += (float)learned->looks[ring];
        hits += (float)learned->hits[ring];
    }
    return estimate_pd(hits, looks, PRIOR_OF_ALL, pd);
}

static float lowered_or_stated_pd(const struct rho_tracker_config *config,
                                  const struct pd_estimate *seen, float stated)
{
    const float pd = seen->pd + CAUTION * seen->sigma;
    const float least = config->learn_pd_min * stated;
    return !(seen->pd + SURELY * seen->sigma < stated) ? stated : pd > least ? pd : least;
}

static float usable_pd_in_ring(const struct rho_tracker_config *config,
                               const struct rho_tracker_learned *learned, float stated,
                               unsigned ring)
{
    const struct pd_estimate all = estimate_pd_over_all_rings(learned, stated);
    const struct pd_estimate seen =
        estimate_pd((float)learned->hits[ring], (float)learned->looks[ring], PRIOR_OF_RING, all.pd);
    return lowered_or_stated_pd(config, &seen, stated);
}

/* ---- pd by range rate ------------------------------------------------------------------------ */

/* Upper limit of the first num_rates intervals of range rates, m/s. */
static float upper_range_rate_of_intervals_mps(unsigned num_rates)
{
    float end2 = RATE_MIN2;
    for (unsigned i = 1; i < num_rates; i++) {
        end2 *= 2.0f;
    }
    return rho_sqrt(end2);
}

/* True where the sensor's description states no notch: it has none, or the learned one. */
static int is_notch_unstated_or_learned(const struct rho_sensor *sensor,
                                        const struct rho_tracker_learned *learned)
{
    const float learned_mps =
        learned->used_rates > 0 ? upper_range_rate_of_intervals_mps(learned->used_rates) : 0.0f;
    return !(sensor->notch_mps > 0.0f) ||
           (sensor->notch_mps >= learned_mps && sensor->notch_mps <= learned_mps);
}

static int is_notch_learning_on(const struct rho_look *look)
{
    return RHO_DOPPLER_NOTCH && is_pd_learning_on(&look->tracker->config) &&
           is_notch_unstated_or_learned(look->sensor, look->learned);
}

void rho_learning_apply_notch(const struct rho_look *look)
{
    struct rho_tracker_learned *learned = look->learned;
    if (learned && is_sensor_learning_on(&look->tracker->config) && is_notch_learning_on(look)) {
        learned->used_rates = learned->blind_rates;
        look->row->sensor.notch_mps =
            learned->used_rates > 0 ? upper_range_rate_of_intervals_mps(learned->used_rates) : 0.0f;
    }
}

/* Index of the interval of a track's range rate; the last one where the rate is not defined. */
static unsigned notch_learning_interval_of_range_rate(const struct rho_sensor *sensor,
                                                      const struct rho_track *track)
{
    float row[6], rate_mps;
    if (!rho_measurement_predict_range_rate(track->kalman.state, sensor,
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
static unsigned keep_shrink_or_drop_notch(unsigned used, float last_looks, float last_hits,
                                          float looks, float hits, float faster_pd)
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
static unsigned count_blind_rate_intervals(const struct rho_tracker_learned *learned)
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
            return keep_shrink_or_drop_notch(used, here, seen, looks, hits, pd);
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
        learned->notches_forgotten < FORGOTTEN_MAX ? count_blind_rate_intervals(learned) : 0u;
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
static int count_look_by_rate_and_test_outside_notch(const struct rho_look *look,
                                                     const struct rho_track *track,
                                                     unsigned is_seen)
{
    struct rho_tracker_learned *learned = look->learned;
    const unsigned rate = notch_learning_interval_of_range_rate(look->sensor, track);
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

/* ---- pd of a look ---------------------------------------------------------------------------- */

static int is_pd_lowered_in_any_ring(const struct rho_look *look)
{
    return is_sensor_learning_on(&look->tracker->config) && look->learned &&
           look->learned->is_lowered;
}

struct detection rho_learning_detection(const struct rho_look *look, const struct rho_track *track,
                                        struct detection stated)
{
    if (!is_pd_lowered_in_any_ring(look)) {
        return stated;
    }
    const unsigned ring = range_ring_of_track(look->sensor, track);
    if (!(look->learned->is_lowered >> ring & 1u)) {
        return stated;
    }
    const float pd =
        usable_pd_in_ring(&look->tracker->config, look->learned, look->sensor->pd, ring);
    return (struct detection){rho_log(pd), rho_log(1.0f - pd)};
}

float rho_learning_mean_pd(const struct rho_look *look)
{
    const float stated = look->sensor->pd;
    if (!is_pd_lowered_in_any_ring(look)) {
        return stated;
    }
    const struct pd_estimate all = estimate_pd_over_all_rings(look->learned, stated);
    return lowered_or_stated_pd(&look->tracker->config, &all, stated);
}

static void count_look_by_range_and_rate(const struct rho_look *look, const struct rho_track *track,
                                         unsigned is_seen)
{
    struct rho_tracker_learned *learned = look->learned;
    const unsigned ring = range_ring_of_track(look->sensor, track);
    if (is_notch_learning_on(look) &&
        !count_look_by_rate_and_test_outside_notch(look, track, is_seen)) {
        return;
    }
    learned->looks[ring] = (uint16_t)(learned->looks[ring] + 1u);
    learned->hits[ring] = (uint16_t)(learned->hits[ring] + is_seen);
    if (learned->looks[ring] >= LOOKS_MAX) {
        learned->looks[ring] = (uint16_t)(learned->looks[ring] / 2u);
        learned->hits[ring] = (uint16_t)(learned->hits[ring] / 2u);
    }
}

/*
 * Counts the look that followed a hit when the same sensor next sees the track: as a miss where it
 * missed the track meanwhile, as a hit otherwise.
 */
static void learn_pd_from_look(const struct rho_look *look, struct rho_track *track, int is_seen)
{
    const int is_own = track->sensor_id == look->scan->sensor_id;
    if (!is_pd_learning_on(&look->tracker->config)) {
        return;
    }
    if (RHO_DOPPLER_NOTCH && track->blind_percent > BLIND_PERCENT_MAX) {
        if (is_own && is_notch_learning_on(look)) {
            (void)count_look_by_rate_and_test_outside_notch(look, track, is_seen != 0);
        }
        return;
    }
    if (is_seen && is_own) {
        count_look_by_range_and_rate(look, track, track->has_shown & IS_MISSED ? 0u : 1u);
    }
    track->has_shown &= (uint8_t)~IS_MISSED;
    track->has_shown |= (uint8_t)(!is_seen && is_own ? IS_MISSED : 0u);
}

/* Tests in one ring of range, another one each scan, whether the learned pd is below the stated. */
static void update_lowered_pd_of_next_ring(const struct rho_look *look)
{
    struct rho_tracker_learned *learned = look->learned;
    const float pd =
        usable_pd_in_ring(&look->tracker->config, learned, look->sensor->pd, learned->ring);
    const unsigned bit = 1u << learned->ring, others = learned->is_lowered & ~bit;
    learned->is_lowered = (uint8_t)(others | (pd < look->sensor->pd ? bit : 0u));
    learned->ring = (uint8_t)((learned->ring + 1u) % RHO_LEARN_RINGS);
}

/* ---- a scan ---------------------------------------------------------------------------------- */

static int can_teach_sensor(const struct rho_look *look, unsigned row)
{
    const struct rho_track *track = &look->tracker->tracks[row];
    return track->status != RHO_TRACK_FREE && track->was_confirmed &&
           rho_life_is_established(track) && rho_look_has_in_view(look, row);
}

static int can_teach_noise(const struct rho_track *track)
{
    return !track->is_shared && RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES) &&
           track->maneuver_probability < MANEUVER_MAX;
}

static int can_learn_from_scan(const struct rho_look *look)
{
    return !look->is_suspect && look->teaches && look->learned &&
           is_sensor_learning_on(&look->tracker->config);
}

void rho_learning_take_look(struct rho_tracker *tracker, const struct rho_look *look)
{
    /* with bodies no noise is learned: most of a group's noise is the extent of the body */
    const int has_noise = is_noise_learning_on(&tracker->config) && !rho_bodies_are_used(tracker);
    if (!can_learn_from_scan(look)) {
        return;
    }
    const float factors[2] = {rho_exp(look->learned->log_noise[0]),
                              rho_exp(look->learned->log_noise[1])};
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (!can_teach_sensor(look, row)) {
            continue;
        }
        const int plot = rho_assignment_column(&tracker->assignment, row);
        if (has_noise && plot != RHO_ASSIGNMENT_NONE && can_teach_noise(track)) {
            learn_noise_from_plot(look, track, &look->scan->plots[plot], factors);
        }
        if (plot != RHO_ASSIGNMENT_NONE ||
            (!look->has_more_parts && rho_look_may_miss(look, track))) {
            learn_pd_from_look(look, track, plot != RHO_ASSIGNMENT_NONE);
        }
    }
    if (is_pd_learning_on(&tracker->config) && !look->has_more_parts) {
        update_lowered_pd_of_next_ring(look);
    }
}

/* ---- what is known --------------------------------------------------------------------------- */

int rho_learning_is_sound(const struct rho_tracker_learned *learned)
{
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        if (learned->hits[ring] > learned->looks[ring] || learned->looks[ring] > LOOKS_MAX) {
            return 0;
        }
    }
    for (unsigned i = 0; RHO_DOPPLER_NOTCH && i < RHO_LEARN_RATES; i++) {
        if (learned->rate_hits[i] > learned->rate_looks[i] ||
            learned->rate_looks[i] > RATE_LOOKS_MAX) {
            return 0;
        }
    }
    return (!RHO_DOPPLER_NOTCH ||
            (learned->blind_rates <= RHO_LEARN_RATES && learned->used_rates <= RHO_LEARN_RATES)) &&
           (!RHO_SHARES_PLOTS || rho_cell_is_sound(learned)) &&
           rho_is_within(learned->log_noise[0], -LOG_NOISE_MAX, LOG_NOISE_MAX) &&
           rho_is_within(learned->log_noise[1], -LOG_NOISE_MAX, LOG_NOISE_MAX) &&
           learned->innovations <= INNOVATIONS_MAX && learned->is_lowered < 1u << RHO_LEARN_RINGS &&
           learned->ring < RHO_LEARN_RINGS;
}

enum rho_status rho_tracker_known_of(const struct rho_tracker *tracker, int32_t sensor_id,
                                     struct rho_tracker_known *known)
{
    if (!tracker || !known) {
        return RHO_ERROR_NULL;
    }
    const unsigned row =
        rho_tracker_is_ready(tracker) ? rho_sensors_row(tracker, sensor_id) : RHO_MAX_SENSORS;
    if (row >= tracker->num_sensors) {
        return RHO_ERROR_STATE;
    }
    const struct rho_sensor *sensor = &tracker->sensors[row].sensor;
    const struct rho_tracker_learned *learned = &tracker->sensors[row].learned;
    const int is_blind = RHO_DOPPLER_NOTCH && learned->blind_rates > 0 &&
                         is_notch_unstated_or_learned(sensor, learned);
    *known = (struct rho_tracker_known){
        .notch_mps = is_blind ? upper_range_rate_of_intervals_mps(learned->blind_rates) : 0.0f,
        .range_factor = usable_sigma_factor(tracker, learned, 0),
        .cross_factor = usable_sigma_factor(tracker, learned, 1),
        .innovations = learned->innovations,
        .resolution_range_sigmas = RHO_SHARES_PLOTS ? rho_cell_learned_sigmas(learned, 0) : 0.0f,
        .resolution_cross_sigmas = RHO_SHARES_PLOTS ? rho_cell_learned_sigmas(learned, 1) : 0.0f,
    };
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        known->pd[ring] = learned->is_lowered >> ring & 1u
                              ? usable_pd_in_ring(&tracker->config, learned, sensor->pd, ring)
                              : sensor->pd;
        known->looks += learned->looks[ring];
    }
    return RHO_OK;
}
