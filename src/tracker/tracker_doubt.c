/* SPDX-License-Identifier: MIT */
/*
 * tracker_doubt: a sensor that fails or lies. Each is watched by the tracks that another one saw before it: does it see
 * them where it looks, and where they are expected? One that does not, while another does, is doubted: it starts no
 * tracks, its misses say nothing, and its plots count with the noise that they show. It is watched on, and believed
 * again when it agrees.
 */
#include "rhotrack/approx.h"
#include "tracker_step.h"

#if RHO_SECTORS

/* Looks and hits that the means go back, and how many there must be before they say anything. */
#define WATCH_MAX 16u
#define WATCH_MIN 12u
/* Of pd: sees too few; sees as many as it should. */
#define SHARE_LOW 0.3f
#define SHARE_GOOD 0.6f
/* Squared distances a dimension. Manoeuvres, and tracks that are surer than they should be, make 2 of 1. */
#define DISTANCE2_HIGH 4.0f
#define DISTANCE2_GOOD 2.5f
/* Of what a manoeuvre model claims beyond the plain gate. */
#define DISTANCE2_OUTSIDE 9.0f
/* Of the squared distances of one that is off: these are less off. One that lies pulls the tracks, so that the others
 * look off to them as well: but less than it is itself. */
#define RIGHTER 0.7f
/* Of one's sigma: beyond that the other one's distances in sigmas are too small to compare. */
#define COARSER 1.9f
#define FACTOR_MAX 20.0f

static void average(float *mean, float value, uint16_t *count)
{
    *count = (uint16_t)(*count < WATCH_MAX ? *count + 1u : WATCH_MAX);
    *mean += (value - *mean) / (float)*count;
}

static float distance2_of(const struct step *step, const struct rho_track *track, int plot)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_sensor sensor;
    rho_tracker_open_gate(step, track, &gate);
    if (gate.sensor && step->is_doubted) {
        /* as is known of the sensor; not as its plots count while it is doubted */
        sensor = *gate.sensor;
        rho_tracker_use_noise(step, 1.0f, &sensor);
        gate.sensor = &sensor;
    }
    if (!rho_gate_test(&gate, &step->scan->plots[plot], &result)) {
        return DISTANCE2_OUTSIDE;
    }
    return result.distance2 /
           (2.0f + (result.has_z ? 1.0f : 0.0f) + (result.has_range_rate ? 1.0f : 0.0f));
}

static void watch(const struct step *step, struct rho_tracker_look *look, unsigned row)
{
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_track *track = &tracker->tracks[row];
    const int plot = rho_assignment_column(&tracker->assignment, row);
    if (plot != RHO_ASSIGNMENT_NONE) {
        average(&look->seen_share, 1.0f, &look->watched);
        look->sigma_m = rho_plot_sigma_m(&step->scan->plots[plot]);
        average(&look->distance2, distance2_of(step, track, plot), &look->watched_hits);
    } else if (!step->has_more_parts && rho_tracker_has_passed(step, track)) {
        average(&look->seen_share, 0.0f, &look->watched);
    }
}

static float pd_of(const struct rho_tracker *tracker, int32_t sensor_id)
{
    const struct rho_sensor *sensor = rho_tracker_find_sensor(tracker, sensor_id);
    return sensor ? sensor->pd : tracker->config.pd;
}

/* It does not see what others see. */
static int is_blind(const struct rho_tracker *tracker, const struct rho_tracker_look *look)
{
    return look->watched >= WATCH_MIN &&
           look->seen_share < SHARE_LOW * pd_of(tracker, look->sensor_id);
}

/* It sees it elsewhere. */
static int is_off(const struct rho_tracker_look *look)
{
    return look->watched_hits >= WATCH_MIN && look->distance2 > DISTANCE2_HIGH;
}

static int sees_enough(const struct rho_tracker *tracker, const struct rho_tracker_look *look)
{
    return look->watched >= WATCH_MIN &&
           look->seen_share > SHARE_GOOD * pd_of(tracker, look->sensor_id);
}

static int agrees(const struct rho_tracker *tracker, const struct rho_tracker_look *look)
{
    return sees_enough(tracker, look) && look->distance2 < DISTANCE2_GOOD;
}

/* Distances are in each one's own sigmas: a coarse one agrees with anything, a fine one that lies pulls the tracks
 * until it does. */
static int is_coarser(const struct rho_tracker_look *look, const struct rho_tracker_look *than)
{
    return look->sigma_m > COARSER * than->sigma_m;
}

/* Others that are heard, and have nothing against them. */
struct witnesses {
    unsigned num;
    /* against one that is off: that agree, and are no coarser; less off, too, and as fine as it is; and coarser */
    unsigned agreeing, equal, coarser;
};

static void hear(struct witnesses *witnesses, const struct rho_tracker_look *other,
                 const struct rho_tracker_look *look, int does_agree)
{
    if (is_coarser(other, look)) {
        witnesses->coarser++;
    } else {
        witnesses->agreeing += does_agree ? 1u : 0u;
        witnesses->equal += !is_coarser(look, other) ? 1u : 0u;
    }
}

static struct witnesses find_witnesses(const struct step *step, const struct rho_tracker_look *look)
{
    const struct rho_tracker *tracker = step->tracker;
    struct witnesses witnesses = {0, 0, 0, 0};
    for (unsigned i = 0; i < tracker->num_looks; i++) {
        const struct rho_tracker_look *other = &tracker->looks[i];
        if (other == look || other->is_doubted || !sees_enough(tracker, other) ||
            step->time_us - other->time_us > RHO_TRACKER_SILENT_US) {
            continue;
        }
        const int does_agree = other->distance2 < DISTANCE2_GOOD;
        witnesses.num += does_agree ? 1u : 0u;
        if (does_agree || other->distance2 < RIGHTER * look->distance2) {
            hear(&witnesses, other, look, does_agree);
        }
    }
    return witnesses;
}

/* One finer and one coarser are no two: the one may have pulled the tracks, and the other cannot tell. */
static int are_enough(const struct witnesses *witnesses)
{
    return witnesses->agreeing >= 2 || witnesses->equal >= 2 || witnesses->coarser >= 2;
}

/* Of two that see the same things in other places nobody can tell who is wrong: that takes a third one. */
static void judge(struct step *step, struct rho_tracker_look *look)
{
    struct rho_tracker *tracker = step->tracker;
    const struct witnesses witnesses = find_witnesses(step, look);
    if (look->is_doubted && (agrees(tracker, look) || witnesses.num == 0)) {
        look->is_doubted = 0;
    } else if (!look->is_doubted && ((is_blind(tracker, look) && witnesses.num >= 1) ||
                                     (is_off(look) && are_enough(&witnesses)))) {
        look->is_doubted = 1;
        tracker->counters.sensors_doubted = rho_count(tracker->counters.sensors_doubted, 1);
    }
}

/* What says something of the sensor: what one alone has seen does not, nor what a doubted one saw last. */
static int is_telling(const struct step *step, unsigned row)
{
    const struct rho_track *track = &step->tracker->tracks[row];
    const struct rho_tracker_look *last = rho_tracker_look_of(step->tracker, track->sensor_id);
    return track->status != RHO_TRACK_FREE && track->is_believed && track->is_shared &&
           track->sensor_id != step->scan->sensor_id && !(last && last->is_doubted) &&
           rho_tracker_is_reached(step, row);
}

void rho_tracker_watch(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_tracker_look *look = rho_tracker_own_look(step);
    if (!look) {
        return;
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (is_telling(step, row)) {
            watch(step, look, row);
        }
    }
    if (!step->has_more_parts) {
        judge(step, look);
        step->is_doubted = look->is_doubted;
    }
}

float rho_tracker_weigh_sensor(struct step *step)
{
    struct rho_tracker_look *look = rho_tracker_own_look(step);
    if (look) {
        judge(step, look); /* whoever was its witness may have gone */
    }
    step->is_doubted = look && look->is_doubted;
    /*
     * a bias is no noise: that its plots pull a track off takes more than the variance that they
     * show
     */
    const float shown = step->is_doubted ? look->distance2 : 1.0f;
    return shown < 1.0f ? 1.0f : shown < FACTOR_MAX ? shown : FACTOR_MAX;
}

#else

typedef int rho_tracker_doubts_nobody; /* a file must not be empty */

#endif
