/* SPDX-License-Identifier: MIT */
/*
 * sensor_learning: estimates the noise and the Doppler notch of a sensor from established tracks,
 * where they differ from the stated ones.
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
 */
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/linalg.h"
#include "sensors.h"
#include "step.h"

enum { HAS_INNOVATION = 1, IS_MISSED = 2 }; /* bits of has_shown */
enum { SHOWN_PER_SIGMA = 16 };              /* units of track->shown for one sigma */
#define SIGMAS_MAX ((float)INT8_MAX / SHOWN_PER_SIGMA)

static int is_noise_learning_on(const struct rho_tracker_config *config)
{
    return rho_learning_is_on(config) &&
           (config->learn_noise_min < 1.0f || config->learn_noise_max > 1.0f);
}

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
    return rho_smaller(rho_larger(factor, tracker->config.learn_noise_min),
                       tracker->config.learn_noise_max);
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

/* The steady filter of the best hypothesis at the look's time; NULL: the target may turn. */
static const struct rho_kalman *steady_filter(const struct rho_look *look,
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

struct innovation {
    float sigmas; /* along a direction, over its sigma */
    int is_clear; /* enough of its variance is plot noise */
};

/* Innovation along (x, y) over its sigma; noise_m2: variance that is learned; up_m2: height's. */
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

/* Stores an innovation. Half of its squared step on the axis, cut at CUT2; below 0: not usable. */
static float store_innovation(struct rho_track *track, int axis, const struct innovation *now)
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
    /* the mean of min(e, CUT2) with normal noise */
    const float sum = *log_noise + gain * (excess / 0.7785f - 1.0f);
    *log_noise = sum > LOG_NOISE_MAX ? LOG_NOISE_MAX : sum < -LOG_NOISE_MAX ? -LOG_NOISE_MAX : sum;
    return 1;
}

/* Learns a sensor's noise from a steady track's plot; factors: so far, along and across. */
static void learn_noise_from_plot(const struct rho_look *look, struct rho_track *track,
                                  const struct rho_plot *plot, const float factors[2])
{
    struct rho_tracker_learned *learned = look->learned;
    const struct rho_kalman *steady = steady_filter(look, track);
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
    const float along_excess = store_innovation(track, 0, &along);
    const float across_excess = store_innovation(track, 1, &across);
    const float gain = GAIN / (INNOVATIONS_PRIOR + (float)learned->innovations);
    const int is_round = along_m2 <= across_m2 && along_m2 >= across_m2;
    int is_used = update_log_noise(&learned->log_noise[0], along_excess, gain);
    is_used |= update_log_noise(&learned->log_noise[is_round ? 0 : 1], across_excess, gain);
    if (is_round) {
        /* the noise of isotropic plots is learned as one value for both axes */
        learned->log_noise[1] = learned->log_noise[0];
    }
    track->has_shown |= HAS_INNOVATION;
    learned->innovations =
        (uint16_t)(learned->innovations + (is_used && learned->innovations < LEARNED_MAX));
}

/* Counts the look after a hit when the sensor next sees the track, by whether it had missed it. */
static void learn_rate_from_look(const struct rho_look *look, struct rho_track *track, int is_seen)
{
    const int is_own = track->sensor_id == look->scan->sensor_id;
    const int is_blind = track->blind_percent > BLIND_PERCENT_MAX;
    const unsigned was_seen = track->has_shown & IS_MISSED ? 0u : 1u;
    if (is_own && (is_seen || is_blind)) {
        rho_learning_count_rate(look, track, is_blind ? is_seen != 0 : was_seen);
    }
    if (!is_blind) {
        track->has_shown &= (uint8_t)~IS_MISSED;
        track->has_shown |= (uint8_t)(!is_seen && is_own ? IS_MISSED : 0u);
    }
}

void rho_learning_take_look(struct rho_tracker *tracker, const struct rho_look *look)
{
    /* with bodies no noise is learned: most of a group's noise is the extent of the body */
    const int has_noise = is_noise_learning_on(&tracker->config) && !rho_bodies_are_used(tracker);
    struct rho_tracker_learned *learned = look->learned;
    if (look->is_suspect || !look->teaches || !learned || !rho_learning_is_on(&tracker->config)) {
        return;
    }
    const int seeks_notch = rho_learning_seeks_notch(look);
    const float factors[2] = {rho_exp(learned->log_noise[0]), rho_exp(learned->log_noise[1])};
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status == RHO_TRACK_FREE || !track->was_confirmed ||
            !rho_life_is_established(track) || !rho_look_has_in_view(look, row)) {
            continue;
        }
        const int plot = rho_assignment_column(&tracker->assignment, row);
        if (has_noise && plot != RHO_ASSIGNMENT_NONE && !track->is_shared &&
            RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES) &&
            track->maneuver_probability < MANEUVER_MAX) {
            learn_noise_from_plot(look, track, &look->scan->plots[plot], factors);
        }
        if (seeks_notch && (plot != RHO_ASSIGNMENT_NONE ||
                            (!look->has_more_parts && rho_look_may_miss(look, track)))) {
            learn_rate_from_look(look, track, plot != RHO_ASSIGNMENT_NONE);
        }
    }
}

int rho_learning_is_sound(const struct rho_tracker_learned *learned)
{
    return (!RHO_DOPPLER_NOTCH || rho_learning_is_sound_notch(learned)) &&
           (!RHO_SHARES_PLOTS || rho_cell_is_sound(learned)) &&
           rho_is_within(learned->log_noise[0], -LOG_NOISE_MAX, LOG_NOISE_MAX) &&
           rho_is_within(learned->log_noise[1], -LOG_NOISE_MAX, LOG_NOISE_MAX) &&
           learned->innovations <= LEARNED_MAX;
}

enum rho_status rho_tracker_known_of(const struct rho_tracker *tracker, int32_t sensor_id,
                                     struct rho_tracker_known *known)
{
    const enum rho_status status = rho_tracker_check(tracker, known != 0);
    if (status != RHO_OK) {
        return status;
    }
    const unsigned row = rho_sensors_row(tracker, sensor_id);
    if (row >= tracker->num_sensors) {
        return RHO_ERROR_STATE;
    }
    const struct rho_sensor *sensor = &tracker->sensors[row].sensor;
    const struct rho_tracker_learned *learned = &tracker->sensors[row].learned;
    *known = (struct rho_tracker_known){
        .notch_mps = rho_learning_notch_mps(sensor, learned),
        .range_factor = usable_sigma_factor(tracker, learned, 0),
        .cross_factor = usable_sigma_factor(tracker, learned, 1),
        .innovations = learned->innovations,
        .looks = (uint32_t)tracker->sensors[row].looks,
        .lasting_rad = rho_sqrt(rho_bearing_errors_rad2(&tracker->sensors[row].bearing_errors)),
        .resolution_range_sigmas = RHO_SHARES_PLOTS ? rho_cell_learned_sigmas(learned, 0) : 0.0f,
        .resolution_cross_sigmas = RHO_SHARES_PLOTS ? rho_cell_learned_sigmas(learned, 1) : 0.0f,
    };
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        known->pd[ring] = rho_pd_in_ring(tracker, &tracker->sensors[row], ring);
    }
    return RHO_OK;
}
