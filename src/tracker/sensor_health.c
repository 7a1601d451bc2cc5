/* SPDX-License-Identifier: MIT */
/*
 * sensor_health: finds sensors that fail or are biased.
 *
 * Each sensor is compared with the tracks that another sensor saw before: does it detect them where
 * it looks, and are its plots where they are expected? A sensor that does not, while others
 * (witnesses) do, is suspect: it starts no tracks, its misses do not count, and its plots have the
 * noise that they show. It is compared on, and trusted again when it agrees.
 */
#include "rhotrack/detail/approx.h"
#include "step.h"

/* Memory of the means in looks and hits, and the least number of them that is used. */
#define COMPARED_MAX 16u
#define COMPARED_MIN 12u
/* Shares of pd: the sensor sees too few tracks; it sees enough. */
#define SHARE_LOW 0.3f
#define SHARE_GOOD 0.6f
/* Normalised innovation squared, a dimension. Manoeuvres and too optimistic tracks make 2 of 1. */
#define CHI2_HIGH 4.0f
#define CHI2_GOOD 2.5f
/* Counted for plots that a manoeuvre model takes outside of the plain gate. */
#define CHI2_OUTSIDE 9.0f
/*
 * Witnesses may have up to this share of the suspect's innovations: a biased sensor pulls the
 * tracks, so that the others look biased to them as well, but less than it does itself.
 */
#define RIGHTER 0.7f
/* Largest sigma ratio at which two sensors' normalised distances are comparable. */
#define COARSER 1.9f
#define FACTOR_MAX 20.0f

static void average_in(float *mean, float value, uint16_t *count)
{
    *count = (uint16_t)(*count < COMPARED_MAX ? *count + 1u : COMPARED_MAX);
    *mean += (value - *mean) / (float)*count;
}

static float chi2_of(const struct step *step, const struct rho_track *track, int plot)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_sensor sensor;
    rho_tracker_open_gate(step, track, step->scan->measures, &gate);
    if (gate.sensor && step->is_suspect) {
        /* with its learned noise, not the noise that its plots have while it is suspect */
        sensor = *gate.sensor;
        rho_tracker_use_noise(step, 1.0f, &sensor);
        gate.sensor = &sensor;
    }
    if (!rho_gate_test(&gate, &step->scan->plots[plot], &result)) {
        return CHI2_OUTSIDE;
    }
    return result.distance2 /
           (2.0f + (result.has_z ? 1.0f : 0.0f) + (result.has_range_rate ? 1.0f : 0.0f));
}

static void average_look(const struct step *step, struct rho_tracker_look *look, unsigned row)
{
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_track *track = &tracker->tracks[row];
    const int plot = rho_assignment_column(&tracker->assignment, row);
    if (plot != RHO_ASSIGNMENT_NONE) {
        average_in(&look->seen_share, 1.0f, &look->watched);
        look->sigma_m = rho_plot_sigma_m(&step->scan->plots[plot]);
        average_in(&look->distance2, chi2_of(step, track, plot), &look->watched_hits);
    } else if (!step->has_more_parts && !rho_tracker_is_blind(track) &&
               rho_tracker_has_passed_gate(step, track)) {
        average_in(&look->seen_share, 0.0f, &look->watched);
    }
}

static float pd_of(const struct rho_tracker *tracker, int32_t sensor_id)
{
    const struct rho_sensor *sensor = rho_tracker_find_sensor(tracker, sensor_id);
    return sensor ? sensor->pd : tracker->config.pd;
}

/* The sensor sees too few of the tracks that others see. */
static int sees_too_few(const struct rho_tracker *tracker, const struct rho_tracker_look *look)
{
    return look->watched >= COMPARED_MIN &&
           look->seen_share < SHARE_LOW * pd_of(tracker, look->sensor_id);
}

/* The sensor's plots are elsewhere than the tracks. */
static int is_biased(const struct rho_tracker_look *look)
{
    return look->watched_hits >= COMPARED_MIN && look->distance2 > CHI2_HIGH;
}

static int sees_enough(const struct rho_tracker *tracker, const struct rho_tracker_look *look)
{
    return look->watched >= COMPARED_MIN &&
           look->seen_share > SHARE_GOOD * pd_of(tracker, look->sensor_id);
}

static int agrees(const struct rho_tracker *tracker, const struct rho_tracker_look *look)
{
    return sees_enough(tracker, look) && look->distance2 < CHI2_GOOD;
}

/*
 * Distances are in each sensor's own sigmas: a coarse one agrees with anything, a fine biased one
 * pulls the tracks until it does.
 */
static int is_coarser(const struct rho_tracker_look *look, const struct rho_tracker_look *than)
{
    return look->sigma_m > COARSER * than->sigma_m;
}

/* Sensors that are heard and not suspect. */
struct witnesses {
    unsigned num;
    /*
     * against a biased sensor: agree and are no coarser; are less biased and as fine; are coarser
     */
    unsigned agreeing, equal, coarser;
};

static void add_witness(struct witnesses *witnesses, const struct rho_tracker_look *other,
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
        if (other == look || other->is_suspect || !sees_enough(tracker, other) ||
            step->time_us - other->time_us > RHO_TRACKER_SILENT_US) {
            continue;
        }
        const int does_agree = other->distance2 < CHI2_GOOD;
        witnesses.num += does_agree ? 1u : 0u;
        if (does_agree || other->distance2 < RIGHTER * look->distance2) {
            add_witness(&witnesses, other, look, does_agree);
        }
    }
    return witnesses;
}

/*
 * One finer and one coarser are not enough: the finer may have pulled the tracks, and the coarser
 * cannot tell.
 */
static int are_enough_witnesses(const struct witnesses *witnesses)
{
    return witnesses->agreeing >= 2 || witnesses->equal >= 2 || witnesses->coarser >= 2;
}

/*
 * Where two sensors see the same targets in different places, it takes a third one to tell which is
 * biased.
 */
static void suspect_or_trust(struct step *step, struct rho_tracker_look *look)
{
    struct rho_tracker *tracker = step->tracker;
    const struct witnesses witnesses = find_witnesses(step, look);
    if (look->is_suspect && (agrees(tracker, look) || witnesses.num == 0)) {
        look->is_suspect = 0;
    } else if (!look->is_suspect && ((sees_too_few(tracker, look) && witnesses.num >= 1) ||
                                     (is_biased(look) && are_enough_witnesses(&witnesses)))) {
        look->is_suspect = 1;
        tracker->counters.sensors_suspected = rho_count(tracker->counters.sensors_suspected, 1);
    }
}

/* Tracks that can show bias: seen by two sensors, last by another one that is not suspect. */
static int is_evidence(const struct step *step, unsigned row)
{
    const struct rho_track *track = &step->tracker->tracks[row];
    const struct rho_tracker_look *last = rho_tracker_look_of(step->tracker, track->sensor_id);
    return track->status != RHO_TRACK_FREE && track->was_confirmed && track->is_shared &&
           track->sensor_id != step->scan->sensor_id && !(last && last->is_suspect) &&
           rho_tracker_is_in_view(step, row);
}

void rho_tracker_update_sensor_health(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_tracker_look *look = rho_tracker_own_look(step);
    if (!look) {
        return;
    }
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (is_evidence(step, row)) {
            average_look(step, look, row);
        }
    }
    if (!step->has_more_parts) {
        suspect_or_trust(step, look);
        step->is_suspect = look->is_suspect;
    }
}

float rho_tracker_find_suspect(struct step *step)
{
    struct rho_tracker_look *look = rho_tracker_own_look(step);
    if (look) {
        suspect_or_trust(step, look); /* its witnesses may be silent by now */
    }
    step->is_suspect = look && look->is_suspect;
    /* a bias is no noise: its plots pull a track off by more than their variance shows */
    const float shown = step->is_suspect ? look->distance2 : 1.0f;
    return shown < 1.0f ? 1.0f : shown < FACTOR_MAX ? shown : FACTOR_MAX;
}
