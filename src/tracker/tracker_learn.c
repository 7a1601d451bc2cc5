/* SPDX-License-Identifier: MIT */
/*
 * tracker_learn: sensors that are not as stated. Tracks that are surely targets' show what a sensor's noise is, and how
 * often it sees them.
 *
 * Noise: of a plot that the assignment gives to a steady track the innovation v on an axis, along the line of sight or
 * across it, has the variance p + f r: p of the steady filter's prediction, r of the plot's noise as stated, f what is
 * learned. With e = v^2 / (p + f r), cut at c^2 (plots of others are among them), and b the mean of that where f is right,
 *
 *      ln f += g (min(e, c^2) / b - 1),        g = 2 / (n + 60) of the n-th innovation
 *
 * of those that are on the other side than the one before: errors of the prediction, a target that turns, leave plots on
 * one side for some scans; of noise sides are by chance.
 *
 * Tracks that two sensors have seen say nothing here: one that is off would look noisy to the other.
 *
 * P_D: of the looks that follow one that saw the track, how many see it; one that does not counts when the track is seen
 * again, so that targets that are gone have no misses. Tracks that end early for being seen seldom are counted for as long
 * as they are there. Of a target that fades the first miss counts alone: the pd that is learned is rather too high, and it
 * is never above the one stated.
 */
#include "rhotrack/approx.h"
#include "rhotrack/linalg.h"
#include "rhotrack/measurement.h"
#include "tracker_step.h"

/* A track of so many hits is a target's; one that began to manoeuvre is none that innovations are learned from. */
#define HITS_MIN 16
#define MANEUVER_MAX 0.1f
#define HAS_SIGNS 4u
#define IS_MISSED 8u

/* Squared innovations count so far; their mean then, of a normal distribution. */
#define CUT2 2.25f
#define MEAN_CUT 0.7785f
#define GAIN 2.0f
#define INNOVATIONS_PRIOR 60.0f
#define INNOVATIONS_MAX 1000
/* Where the prediction is worse known than this its own errors would count as noise. */
#define NOISE_SHARE_MIN 0.4f
/* ln of variances: what differs by less is as stated; and what chance makes of the n-th. */
#define AS_STATED 0.25f
#define CHANCE 2.5f

/* Looks that count beside those at all rings, as stated; beside a ring's, as at all rings. */
#define PRIOR_OF_ALL 50.0f
#define PRIOR_OF_RING 20.0f
#define LOOKS_MAX 1000
/* Standard deviations: what differs by less is as stated; and above what was seen, to be rather too high. */
#define SURELY 2.5f
#define CAUTION 1.0f

/* Misses in a row that end a track are at most so many times coast_scans_max. */
#define COAST_MAX 2.0f

static unsigned place_of(const struct step *step)
{
    return (unsigned)(step->learned - step->tracker->learned);
}

static int learns_noise(const struct rho_tracker_config *config)
{
    return config->gate == RHO_TRACKER_BEST &&
           (config->learn_noise_min < 1.0f || config->learn_noise_max > 1.0f);
}

/* ---- use of noise ------------------------------------------------------------------------------- */

static float factor_of(const struct rho_tracker *tracker, const struct rho_tracker_learned *learned,
                       int axis)
{
    const float log_noise = learned->log_noise[axis];
    const float most = AS_STATED + CHANCE / rho_sqrt(1.0f + (float)learned->innovations);
    if (!learns_noise(&tracker->config) || (log_noise <= most && log_noise >= -most)) {
        return 1.0f;
    }
    const float factor = rho_exp(0.5f * log_noise);
    const float least = factor > tracker->config.learn_noise_min ? factor : tracker->config.learn_noise_min;
    return least < tracker->config.learn_noise_max ? least : tracker->config.learn_noise_max;
}

static uint16_t percent_of(float factor)
{
    return (uint16_t)(100.0f * factor + 0.5f);
}

void rho_tracker_set_noise(struct step *step)
{
    const float doubt = rho_tracker_weigh_sensor(step);
    if (step->learned) {
        struct rho_sensor *sensor = &step->tracker->sensors[place_of(step)];
        sensor->sigma_range_percent = percent_of(doubt * factor_of(step->tracker, step->learned, 0));
        sensor->sigma_cross_percent = percent_of(doubt * factor_of(step->tracker, step->learned, 1));
    }
}

/* ---- noise learned ------------------------------------------------------------------------------ */

static const struct rho_kalman *steady_of(const struct step *step, const struct rho_track *track)
{
    const struct rho_hypotheses *pool = &step->tracker->hypotheses;
    for (unsigned i = 0; i < rho_hypotheses_count(pool, track->slot); i++) {
        const struct rho_hypothesis *at = rho_hypotheses_at(pool, track->slot, i);
        if (at->weight_nat >= 0.0f) {
            return at->time_us == step->time_us && at->imm.probability < MANEUVER_MAX
                       ? &at->imm.steady
                       : 0;
        }
    }
    return 0;
}

/* An innovation along a direction, where the filter leads by then: its square over what is expected of it, cut; below 0
 * where the noise is too small a part of that. */
struct innovation {
    float excess;
    int is_negative;
};

static struct innovation innovation_along(const struct rho_kalman *steady,
                                          const struct rho_plot *plot, float x, float y,
                                          float noise_m2)
{
    const float after_s = (float)plot->offset_us * 1e-6f, *state = steady->state;
    const float row[RHO_KALMAN_STATES] = {x, y, 0.0f, x * after_s, y * after_s, 0.0f};
    float projected[RHO_KALMAN_STATES];
    const float variance_m2 = rho_linalg_project6(steady->covariance, row, projected) + noise_m2;
    const float off_m = x * (plot->x_m - state[0] - after_s * state[3]) +
                        y * (plot->y_m - state[1] - after_s * state[4]);
    const float square = off_m * off_m / variance_m2;
    const int is_clear = noise_m2 >= NOISE_SHARE_MIN * variance_m2;
    return (struct innovation){!is_clear ? -1.0f : square < CUT2 ? square : CUT2, off_m < 0.0f};
}

static int add(float *log_noise, float excess, float gain)
{
    const float most = 2.0f * rho_log(10.0f);
    if (excess < 0.0f) {
        return 0;
    }
    const float sum = *log_noise + gain * (excess / MEAN_CUT - 1.0f);
    *log_noise = sum > most ? most : sum < -most ? -most : sum;
    return 1;
}

/* Which of the axes changed sides; the sides are kept. */
static unsigned note_signs(struct rho_track *track, const struct innovation *along,
                           const struct innovation *across)
{
    const unsigned signs =
        (along->is_negative ? 1u : 0u) | (across->is_negative ? 2u : 0u) | HAS_SIGNS;
    const unsigned before = track->shown;
    track->shown = (uint8_t)((before & IS_MISSED) | signs);
    return before & HAS_SIGNS ? (before ^ signs) & 3u : 0u;
}

static void learn_noise(struct step *step, struct rho_track *track, const struct rho_plot *plot)
{
    struct rho_tracker_learned *learned = step->learned;
    const struct rho_kalman *steady = steady_of(step, track);
    const float dx_m = plot->x_m - step->sensor->x_m, dy_m = plot->y_m - step->sensor->y_m;
    const float range_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    if (!steady || !(range_m > 1.0f)) {
        track->shown &= IS_MISSED;
        return;
    }
    const float x = dx_m / range_m, y = dy_m / range_m;
    const float along_m2 = plot->sigma_range_m * plot->sigma_range_m;
    const float across_m2 = plot->sigma_cross_m * plot->sigma_cross_m;
    const struct innovation along =
        innovation_along(steady, plot, x, y, along_m2 * rho_exp(learned->log_noise[0]));
    const struct innovation across =
        innovation_along(steady, plot, -y, x, across_m2 * rho_exp(learned->log_noise[1]));
    const unsigned changed = note_signs(track, &along, &across);
    const float gain = GAIN / (INNOVATIONS_PRIOR + (float)learned->innovations);
    const int is_round = along_m2 <= across_m2 && along_m2 >= across_m2;
    int is_used = changed & 1u ? add(&learned->log_noise[0], along.excess, gain) : 0;
    if (is_round) {
        /* such plots have one noise: what is learned of them has, too */
        is_used |= changed & 2u ? add(&learned->log_noise[0], across.excess, gain) : 0;
        learned->log_noise[1] = learned->log_noise[0];
    } else {
        is_used |= changed & 2u ? add(&learned->log_noise[1], across.excess, gain) : 0;
    }
    learned->innovations =
        (uint16_t)(learned->innovations + (is_used && learned->innovations < INNOVATIONS_MAX));
}

/* ---- pd ----------------------------------------------------------------------------------------- */

static unsigned ring_of(const struct rho_sensor *sensor, const struct rho_track *track)
{
    const float dx_m = track->kalman.state[0] - sensor->x_m;
    const float dy_m = track->kalman.state[1] - sensor->y_m;
    const float share = rho_sqrt(dx_m * dx_m + dy_m * dy_m) / sensor->range_max_m;
    return share < 1.0f ? (unsigned)(share * (float)RHO_LEARN_RINGS) : RHO_LEARN_RINGS - 1u;
}

/* pd as seen, and how well that is known. */
struct seen {
    float pd, sigma;
};

static struct seen seen_of(float hits, float looks, float prior, float prior_pd)
{
    const float pd = (hits + prior * prior_pd) / (looks + prior);
    return (struct seen){pd, rho_sqrt(pd * (1.0f - pd) / (looks + prior))};
}

static struct seen seen_at_all(const struct rho_tracker_learned *learned, float pd)
{
    float looks = 0.0f, hits = 0.0f;
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        looks += (float)learned->looks[ring];
        hits += (float)learned->hits[ring];
    }
    return seen_of(hits, looks, PRIOR_OF_ALL, pd);
}

static float usable_pd(const struct rho_tracker *tracker, const struct seen *seen, float stated)
{
    const float pd = seen->pd + CAUTION * seen->sigma;
    const float least = tracker->config.learn_pd_min * stated;
    return !(seen->pd + SURELY * seen->sigma < stated) ? stated : pd > least ? pd : least;
}

static float pd_at(const struct rho_tracker *tracker, unsigned place, unsigned ring)
{
    const struct rho_tracker_learned *learned = &tracker->learned[place];
    const float stated = tracker->sensors[place].pd;
    const struct seen all = seen_at_all(learned, stated);
    const struct seen seen = seen_of((float)learned->hits[ring], (float)learned->looks[ring],
                                     PRIOR_OF_RING, all.pd);
    return usable_pd(tracker, &seen, stated);
}

struct odds rho_tracker_odds(const struct step *step, const struct rho_track *track)
{
    const struct odds stated = {step->log_pd, step->log_miss};
    if (!step->learned || !step->learned->is_lowered) {
        return stated;
    }
    const unsigned ring = ring_of(step->sensor, track);
    if (!(step->learned->is_lowered >> ring & 1u)) {
        return stated;
    }
    const float pd = pd_at(step->tracker, place_of(step), ring);
    return (struct odds){rho_log(pd), rho_log(1.0f - pd)};
}

float rho_tracker_mean_pd(const struct step *step)
{
    const float stated = step->sensor->pd;
    if (!step->learned || !step->learned->is_lowered) {
        return stated;
    }
    const struct seen all = seen_at_all(step->learned, stated);
    return usable_pd(step->tracker, &all, stated);
}

unsigned rho_tracker_misses_max(const struct step *step, const struct rho_track *track)
{
    const struct rho_tracker *tracker = step->tracker;
    const float coast = (float)tracker->config.coast_scans_max;
    float most = 1.0f;
    for (unsigned i = 0; i < tracker->num_sensors; i++) {
        const struct rho_sensor *sensor = &tracker->sensors[i];
        const unsigned lowered = tracker->learned[i].is_lowered;
        const unsigned ring = lowered ? ring_of(sensor, track) : 0;
        if (lowered >> ring & 1u) {
            const float times =
                rho_log(1.0f - sensor->pd) / rho_log(1.0f - pd_at(tracker, i, ring));
            most = times > most ? times : most;
        }
    }
    const float misses = coast * (most < COAST_MAX ? most : COAST_MAX) + 0.5f;
    return misses < (float)UINT8_MAX ? (unsigned)misses : UINT8_MAX;
}

static void note_look(struct step *step, const struct rho_track *track, unsigned is_seen)
{
    struct rho_tracker_learned *learned = step->learned;
    const unsigned ring = ring_of(step->sensor, track);
    learned->looks[ring] = (uint16_t)(learned->looks[ring] + 1u);
    learned->hits[ring] = (uint16_t)(learned->hits[ring] + is_seen);
    if (learned->looks[ring] >= LOOKS_MAX) {
        learned->looks[ring] = (uint16_t)(learned->looks[ring] / 2u);
        learned->hits[ring] = (uint16_t)(learned->hits[ring] / 2u);
    }
}

/* The look after one that saw it: it counts once it is known that the target is still there. */
static void learn_pd(struct step *step, struct rho_track *track, int is_seen)
{
    const int is_own = track->sensor_id == step->scan->sensor_id;
    if (is_seen && is_own) {
        note_look(step, track, track->shown & IS_MISSED ? 0u : 1u);
    }
    track->shown &= (uint8_t)~IS_MISSED;
    track->shown |= (uint8_t)(!is_seen && is_own ? IS_MISSED : 0u);
}

static void find_lowered(struct step *step)
{
    unsigned lowered = 0;
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        const float pd = pd_at(step->tracker, place_of(step), ring);
        lowered |= pd < step->sensor->pd ? 1u << ring : 0u;
    }
    step->learned->is_lowered = (uint16_t)lowered;
}

/* ---- a scan ------------------------------------------------------------------------------------- */

static int is_telling(const struct step *step, unsigned row)
{
    const struct rho_track *track = &step->tracker->tracks[row];
    return track->status != RHO_TRACK_FREE && track->is_believed && track->hits >= HITS_MIN &&
           rho_tracker_is_reached(step, row);
}

static int is_steady(const struct rho_track *track)
{
#if RHO_SECTORS
    if (track->is_shared) {
        return 0;
    }
#endif
    return RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES) &&
           track->maneuver_probability < MANEUVER_MAX;
}

static int can_learn(const struct step *step)
{
#if RHO_SECTORS
    if (step->is_doubted) {
        return 0;
    }
#endif
    return step->learned && !step->is_late;
}

void rho_tracker_learn(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const int has_noise = learns_noise(&tracker->config);
    const int has_pd = tracker->config.learn_pd_min < 1.0f;
    if (!can_learn(step)) {
        return;
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (!is_telling(step, row)) {
            continue;
        }
        const int plot = rho_assignment_column(&tracker->assignment, row);
        if (has_noise && plot != RHO_ASSIGNMENT_NONE && is_steady(track)) {
            learn_noise(step, track, &step->scan->plots[plot]);
        }
        if (plot != RHO_ASSIGNMENT_NONE ||
            (!step->has_more_parts && rho_tracker_scan_looked_at(step, track))) {
            learn_pd(step, track, plot != RHO_ASSIGNMENT_NONE);
        }
    }
    if (has_pd && !step->has_more_parts) {
        find_lowered(step);
    }
}

enum rho_status rho_tracker_known_of(const struct rho_tracker *tracker, int32_t sensor_id,
                                     struct rho_tracker_known *known)
{
    if (!tracker || !known) {
        return RHO_ERROR_NULL;
    }
    const struct rho_sensor *sensor =
        rho_tracker_is_ready(tracker) ? rho_tracker_find_sensor(tracker, sensor_id) : 0;
    if (!sensor) {
        return RHO_ERROR_STATE;
    }
    const unsigned place = (unsigned)(sensor - tracker->sensors);
    const struct rho_tracker_learned *learned = &tracker->learned[place];
    *known = (struct rho_tracker_known){
        .range_factor = factor_of(tracker, learned, 0),
        .cross_factor = factor_of(tracker, learned, 1),
        .innovations = learned->innovations,
    };
    for (unsigned ring = 0; ring < RHO_LEARN_RINGS; ring++) {
        known->pd[ring] = learned->is_lowered >> ring & 1u ? pd_at(tracker, place, ring) : sensor->pd;
        known->looks += learned->looks[ring];
    }
    return RHO_OK;
}
