/* SPDX-License-Identifier: MIT */
/*
 * sensor_health: finds sensors that fail or are biased.
 *
 * Each sensor is compared with the tracks that another sensor has seen before: does it detect them
 * where it looks, and are its plots near the predictions? A sensor for which this is not so, while
 * it is so for others (witnesses), is suspect: it starts no tracks, its misses do not count, and
 * its plots' sigmas are multiplied by their mean NIS. It is still compared, and is trusted again
 * when it agrees with the tracks.
 */
#include "plots.h"
#include "policy.h"
#include "sensors.h"

static void add_to_running_mean(float *mean, float value, uint16_t *count)
{
    *count = (uint16_t)(*count < COMPARED_MAX ? *count + 1u : COMPARED_MAX);
    *mean += (value - *mean) / (float)*count;
}

static float nis_per_dimension(const struct rho_look *look, const struct rho_track *track, int plot)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_sensor sensor;
    rho_score_open_gate(look, track, look->scan->measures, &gate);
    if (gate.sensor && look->is_suspect) {
        /* the NIS with the learned noise, without the factor for a suspect sensor */
        sensor = *gate.sensor;
        rho_learning_write_noise(look, 1.0f, &sensor);
        gate.sensor = &sensor;
    }
    if (!rho_gate_test(&gate, &look->scan->plots[plot], &result)) {
        return 3.0f * 3.0f; /* outside of the plain Kalman filter's gate: as at three sigmas */
    }
    return result.distance2 /
           (2.0f + (result.has_z ? 1.0f : 0.0f) + (result.has_range_rate ? 1.0f : 0.0f));
}

static float stated_pd(const struct rho_tracker *tracker, const struct rho_tracker_sensor *row)
{
    return row < &tracker->sensors[tracker->num_sensors] ? row->sensor.pd : tracker->config.pd;
}

/* True where a sensor sees enough of the tracks that other sensors have seen. */
static int sees_enough_tracks(const struct rho_tracker *tracker,
                              const struct rho_tracker_sensor *row)
{
    return row->look.watched >= COMPARED_MIN &&
           row->look.seen_share > SHARE_GOOD * stated_pd(tracker, row);
}

/*
 * True where one sensor's noise is much larger. The NIS is in each sensor's own sigmas: plots of a
 * coarse sensor agree with any track, and a precise, biased sensor pulls the tracks to its plots.
 */
static int is_coarser(const struct rho_tracker_look *health, const struct rho_tracker_look *than)
{
    return health->sigma_m > COARSER * than->sigma_m;
}

/* Numbers of sensors that are heard, not suspect, and see enough tracks. */
struct witnesses {
    unsigned num; /* that agree with the tracks */
    /* agreeing, no coarser; less biased, of about the same noise; either, but coarser */
    unsigned agreeing, equal, coarser;
};

static struct witnesses count_witnesses(const struct rho_look *look,
                                        const struct rho_tracker_sensor *row)
{
    const struct rho_tracker *tracker = look->tracker;
    struct witnesses witnesses = {0, 0, 0, 0};
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        const struct rho_tracker_look *other = &tracker->sensors[i].look;
        if (other == &row->look || other->is_suspect ||
            !sees_enough_tracks(tracker, &tracker->sensors[i]) ||
            look->time_us - other->time_us > RHO_TRACKER_SILENT_US) {
            continue;
        }
        const int does_agree = other->distance2 < CHI2_GOOD;
        witnesses.num += does_agree ? 1u : 0u;
        if (!does_agree && !(other->distance2 < RIGHTER * row->look.distance2)) {
            continue;
        }
        if (is_coarser(other, &row->look)) {
            witnesses.coarser++;
        } else {
            witnesses.agreeing += does_agree ? 1u : 0u;
            witnesses.equal += !is_coarser(&row->look, other) ? 1u : 0u;
        }
    }
    return witnesses;
}

/*
 * Makes the scan's sensor suspect, or trusts it again. Where two sensors see the same targets in
 * different places, a third one has to tell which of both is biased: two witnesses of one kind
 * speak against it. One finer and one coarser sensor are not enough, as the finer may have pulled
 * the tracks, and the coarser cannot tell.
 */
static void judge_sensor(struct rho_tracker *tracker, struct rho_look *look)
{
    const struct rho_tracker_sensor *row = look->row;
    struct rho_tracker_look *health = &look->row->look;
    const struct witnesses witnesses = count_witnesses(look, row);
    const int agrees = sees_enough_tracks(tracker, row) && health->distance2 < CHI2_GOOD;
    const int sees_too_few =
        health->watched >= COMPARED_MIN && health->seen_share < SHARE_LOW * stated_pd(tracker, row);
    const int is_biased =
        health->watched_hits >= COMPARED_MIN && health->distance2 > CHI2_HIGH &&
        (witnesses.agreeing >= 2 || witnesses.equal >= 2 || witnesses.coarser >= 2);
    if (health->is_suspect && (agrees || witnesses.num == 0)) {
        health->is_suspect = 0;
    } else if (!health->is_suspect && ((sees_too_few && witnesses.num >= 1) || is_biased)) {
        health->is_suspect = 1;
        tracker->counters.sensors_suspected = rho_count(tracker->counters.sensors_suspected, 1);
    }
    look->is_suspect = (uint8_t)health->is_suspect;
}

void rho_health_compare(struct rho_tracker *tracker, struct rho_look *look)
{
    struct rho_tracker_look *health = rho_look_record(look);
    for (unsigned row = 0; row < tracker->num_tracks && health; row++) {
        /* confirmed tracks in view, seen by two sensors, last by another one that is not suspect */
        const struct rho_track *track = &tracker->tracks[row];
        const struct rho_tracker_look *last = rho_tracker_look_of(tracker, track->sensor_id);
        if (track->status == RHO_TRACK_FREE || !track->was_confirmed || !track->is_shared ||
            track->sensor_id == look->scan->sensor_id || (last && last->is_suspect) ||
            !rho_look_has_in_view(look, row)) {
            continue;
        }
        const int plot = rho_assignment_column(&tracker->assignment, row);
        if (plot != RHO_ASSIGNMENT_NONE) {
            add_to_running_mean(&health->seen_share, 1.0f, &health->watched);
            health->sigma_m = rho_plot_sigma_m(&look->scan->plots[plot]);
            add_to_running_mean(&health->distance2, nis_per_dimension(look, track, plot),
                                &health->watched_hits);
        } else if (!look->has_more_parts && !rho_notch_is_mostly_blind(track) &&
                   rho_turn_has_passed(look, track)) {
            add_to_running_mean(&health->seen_share, 0.0f, &health->watched);
        }
    }
    if (health && !look->has_more_parts) {
        judge_sensor(tracker, look);
    }
}

float rho_health_sigma_factor(struct rho_tracker *tracker, struct rho_look *look)
{
    const struct rho_tracker_look *health = rho_look_record(look);
    if (health) {
        judge_sensor(tracker, look); /* the witnesses may be silent by now */
    }
    /* the NIS, a ratio of variances, multiplies sigmas: a bias pulls tracks more than noise does */
    const float shown = health && look->is_suspect ? health->distance2 : 1.0f;
    return shown < 1.0f ? 1.0f : shown < FACTOR_MAX ? shown : FACTOR_MAX;
}
