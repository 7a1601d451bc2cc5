/* SPDX-License-Identifier: MIT */
/*
 * tracker_frame: a frame of bearings. Its scans are taken one after the other: tracks gate and claim the bearings of a
 * sensor, and are updated before the next sensor's are looked at, which then meet a narrower gate. What nobody claimed
 * goes to the passive initiation.
 */
#include <string.h>

#include "rhotrack/angle.h"
#include "rhotrack/approx.h"
#include "rhotrack/crossing.h"
#include "rhotrack/measurement.h"
#include "tracker_step.h"

#define LOG_TWO_PI 1.83787707f
#define CLUTTER_SMOOTHING 0.1f

/* One sensor's scan in its frame. */
struct look {
    const struct rho_bearing_scan *scan;
    struct rho_sensor sensor; /* where the scan says */
    uint8_t *fates;
    uint32_t num; /* bearings that have a fate of their own, and may be claimed */
    float log_density;
};

/* ---- looks ------------------------------------------------------------------------------------ */

static struct rho_sensor sensor_of(const struct step *step, const struct rho_bearing_scan *scan)
{
    const struct rho_sensor *known = rho_tracker_find_sensor(step->tracker, scan->sensor_id);
    struct rho_sensor sensor = {.sensor_id = scan->sensor_id,
                                .pd = step->tracker->config.pd,
                                .range_max_m = 2.0f * RHO_LIMIT_POSITION_M};
    if (known) {
        sensor = *known;
    } else if (step->passive) {
        sensor.range_max_m = step->passive->config.range_max_m;
    }
    sensor.x_m = scan->x_m;
    sensor.y_m = scan->y_m;
    return sensor;
}

/* Of false bearings, by radian: what nobody claims of a scan, over the sector or the field of view. */
static float log_density(const struct step *step, const struct rho_bearing_scan *scan)
{
    float unclaimed = step->tracker->unclaimed_bearings;
    float view_rad = scan->sector_to_rad - scan->sector_from_rad;
    view_rad = view_rad < 0.0f ? view_rad + RHO_TWO_PI : view_rad;
    if (!(view_rad > 0.0f)) {
        view_rad = step->passive ? step->passive->config.field_of_view_rad : RHO_TWO_PI;
    }
    return rho_log((unclaimed > 1.0f ? unclaimed : 1.0f) / view_rad);
}

static int is_valid(const struct rho_bearing *bearing)
{
    return rho_measurement_is_bearing(bearing) && bearing->offset_us <= RHO_LIMIT_OFFSET_US &&
           bearing->offset_us >= -RHO_LIMIT_OFFSET_US;
}

/* How many bearings of a scan have a fate of their own and room to be held. */
static uint32_t gated_of(const struct step *step, const struct rho_bearing_scan *scan,
                         uint32_t first)
{
    uint32_t room = first < step->num_gated ? step->num_gated - first : 0;
    uint32_t num = scan->num_bearings < room ? scan->num_bearings : room;
    return num < RHO_MAX_BEARINGS ? num : RHO_MAX_BEARINGS;
}

static void judge_bearings(const struct step *step, uint32_t first, struct look *look)
{
    look->fates = step->report->fates + (first < RHO_MAX_PLOTS ? first : 0);
    look->num = gated_of(step, look->scan, first);
    for (uint32_t i = 0; i < look->num; i++) {
        look->fates[i] =
            (uint8_t)(is_valid(&look->scan->bearings[i]) ? RHO_FATE_HELD : RHO_FATE_INVALID);
    }
}

static struct look open_look(struct step *step, const struct rho_bearing_scan *scan, uint32_t first)
{
    struct look look = {.scan = scan, .sensor = sensor_of(step, scan)};
    look.log_density = log_density(step, scan);
    judge_bearings(step, first, &look);
    return look;
}

/* ---- claim and update ------------------------------------------------------------------------- */

static int64_t time_of(const struct look *look, uint32_t i)
{
    return look->scan->time_us + look->scan->bearings[i].offset_us;
}

/* ln of pd times the bearing's density as the track's, over its density as a false one. 0: not in the gate. */
static int gain_of(const struct step *step, const struct look *look, const struct rho_track *track,
                   uint32_t i, float *gain_nat)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_bearing bearing = look->scan->bearings[i];
    /* an earlier look of the frame may have moved the track on a little */
    bearing.offset_us = (int32_t)(time_of(look, i) - track->time_us);
    rho_gate_open(&gate, &track->kalman, step->model.noise_density, step->sensor);
    if (!rho_gate_test_bearing(&gate, &bearing, look->scan->x_m, look->scan->y_m, &result)) {
        return 0;
    }
    *gain_nat =
        step->log_pd - 0.5f * (LOG_TWO_PI + result.log_det + result.distance2) - look->log_density;
    return 1;
}

/* A bearing in the gate is always better than none. */
static void gate_bearings(struct step *step, const struct look *look, unsigned row)
{
    struct rho_tracker *tracker = step->tracker;
    float gain_nat;
    for (uint32_t i = 0; i < look->num; i++) {
        if (look->fates[i] == RHO_FATE_HELD &&
            gain_of(step, look, &tracker->tracks[row], i, &gain_nat)) {
            int32_t gain = rho_tracker_mnat(gain_nat - step->log_miss);
            (void)!rho_assignment_add(&tracker->assignment, row, i, gain > 1 ? -gain : -1);
        }
    }
}

static void claim(struct step *step, const struct look *look)
{
    struct rho_tracker *tracker = step->tracker;
    /* both counts are within the capacities: nothing to refuse */
    (void)!rho_assignment_begin(&tracker->assignment, tracker->num_tracks, look->num);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (tracker->tracks[row].status != RHO_TRACK_FREE) {
            gate_bearings(step, look, row);
        }
    }
    rho_assignment_solve(&tracker->assignment);
    tracker->counters.gate_plots_dropped =
        rho_count(tracker->counters.gate_plots_dropped, tracker->assignment.pairs_dropped);
}

static int update_track(struct step *step, const struct look *look, struct rho_track *track,
                        uint32_t i)
{
    const struct rho_bearing *bearing = &look->scan->bearings[i];
    float gain_nat = 0.0f;
    struct rho_track_bearing seen = {
        .time_us = time_of(look, i),
        .sensor_id = look->scan->sensor_id,
        .x_m = look->scan->x_m,
        .y_m = look->scan->y_m,
        .bearing_rad = bearing->bearing_rad,
        .sigma_rad = bearing->sigma_rad,
        .row = (int16_t)i,
    };
    if (!gain_of(step, look, track, i, &gain_nat) ||
        rho_track_update_bearing(track, &seen, &step->model, rho_tracker_mnat(gain_nat)) !=
            RHO_OK) {
        step->tracker->counters.updates_refused =
            rho_count(step->tracker->counters.updates_refused, 1);
        return 0;
    }
    look->fates[i] = RHO_FATE_CLAIMED;
    return 1;
}

/* A sensor that looked where the track is and saw nothing is evidence against it, whatever the others saw. */
static void update(struct step *step, const struct look *look)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        int bearing = rho_assignment_column(&tracker->assignment, row);
        if (track->status == RHO_TRACK_FREE ||
            (bearing != RHO_ASSIGNMENT_NONE &&
             update_track(step, look, track, (uint32_t)bearing))) {
            continue;
        }
        if (rho_tracker_looked_at(step, look->scan->sector_from_rad, look->scan->sector_to_rad,
                                  track)) {
            rho_track_lose(track, rho_tracker_mnat(-step->log_miss));
        }
    }
}

static void note_unclaimed(struct step *step, const struct look *look)
{
    float unclaimed = 0.0f;
    for (uint32_t i = 0; i < look->num; i++) {
        unclaimed += look->fates[i] == RHO_FATE_HELD ? 1.0f : 0.0f;
    }
    step->tracker->unclaimed_bearings +=
        CLUTTER_SMOOTHING * (unclaimed - step->tracker->unclaimed_bearings);
}

static void take_look(struct step *step, const struct rho_bearing_scan *scan, uint32_t first)
{
    struct look look = open_look(step, scan, first);
    step->sensor = &look.sensor;
    rho_tracker_set_pd(step);
    claim(step, &look);
    update(step, &look);
    note_unclaimed(step, &look);
    step->sensor = 0;
}

/* ---- age -------------------------------------------------------------------------------------- */

static int is_looked_at(struct step *step, const struct rho_track *track)
{
    int is_seen = 0;
    for (uint32_t i = 0; i < step->frame->num_scans && !is_seen; i++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[i];
        struct rho_sensor sensor = sensor_of(step, scan);
        step->sensor = &sensor;
        is_seen = rho_tracker_looked_at(step, scan->sector_from_rad, scan->sector_to_rad, track);
    }
    step->sensor = 0;
    return is_seen;
}

/* A frame that has no bearing of a track is one miss, however many sensors looked; the score has had its losses. */
static void count_misses(struct step *step)
{
    for (unsigned row = 0; row < step->tracker->num_tracks; row++) {
        struct rho_track *track = &step->tracker->tracks[row];
        if (track->status != RHO_TRACK_FREE && track->plot < 0 && is_looked_at(step, track)) {
            rho_track_miss(track, 0);
        }
    }
}

/* ---- ghosts ----------------------------------------------------------------------------------- */

/* Can this bearing and one of the other scan's be a target? *num counts the crossings asked for. */
static int meets_any(const struct step *step, const struct rho_crossing_base *base,
                     float bearing_rad, const struct rho_bearing_scan *other, uint32_t *num)
{
    struct rho_crossing crossing;
    for (uint32_t j = 0; j < other->num_bearings && j < RHO_MAX_BEARINGS; j++) {
        if (is_valid(&other->bearings[j])) {
            *num += 1;
            if (rho_crossing_find(base, bearing_rad, other->bearings[j].bearing_rad,
                                  step->passive->config.range_max_m,
                                  &crossing) == RHO_CROSSING_MEETS) {
                return 1;
            }
        }
    }
    return 0;
}

/* It has crossings, and none of them can be a target. */
static int is_ghost(const struct step *step, const struct rho_bearing_scan *scan, uint32_t i)
{
    uint32_t num = 0;
    for (uint32_t k = 0; k < step->frame->num_scans; k++) {
        const struct rho_bearing_scan *other = &step->frame->scans[k];
        struct rho_crossing_base base;
        if (other != scan &&
            rho_crossing_set_base(&base, scan->x_m, scan->y_m, other->x_m, other->y_m) == RHO_OK &&
            meets_any(step, &base, scan->bearings[i].bearing_rad, other, &num)) {
            return 0;
        }
    }
    return num > 0;
}

static void tell_ghosts(struct step *step)
{
    uint32_t first = 0;
    for (uint32_t k = 0; k < step->frame->num_scans; k++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[k];
        uint32_t num = gated_of(step, scan, first);
        for (uint32_t i = 0; i < num; i++) {
            uint8_t *fate = &step->report->fates[first + i];
            if (*fate == RHO_FATE_HELD && is_ghost(step, scan, i)) {
                *fate = RHO_FATE_GHOST;
            }
        }
        first = rho_count(first, scan->num_bearings);
    }
}

/* ---- initiate --------------------------------------------------------------------------------- */

/* The frame as the batch takes it: what has a fate of its own, and these in a row. */
struct held {
    struct rho_frame frame;
    struct rho_bearing_scan scans[RHO_MAX_PASSIVE_SENSORS];
    uint8_t fates[RHO_MAX_PASSIVE_SENSORS * RHO_MAX_BEARINGS];
};

/* Copies fates to the held frame's, or back. */
static void move_fates(const struct step *step, struct held *held, int is_back)
{
    uint8_t *packed = held->fates;
    uint32_t first = 0;
    for (uint32_t i = 0; i < step->frame->num_scans; i++) {
        uint32_t num = held->scans[i].num_bearings;
        uint8_t *fates = step->report->fates + (num > 0 ? first : 0);
        memcpy(is_back ? fates : packed, is_back ? packed : fates, num);
        packed += num;
        first = rho_count(first, step->frame->scans[i].num_bearings);
    }
}

static void push(struct step *step)
{
    struct held held;
    uint32_t first = 0;
    held.frame = *step->frame;
    held.frame.scans = held.scans;
    for (uint32_t i = 0; i < held.frame.num_scans; i++) {
        held.scans[i] = step->frame->scans[i];
        held.scans[i].num_bearings = gated_of(step, &held.scans[i], first);
        first = rho_count(first, step->frame->scans[i].num_bearings);
    }
    move_fates(step, &held, 0);
    /* the frame was accepted before the step began */
    (void)!rho_passive_push(step->passive, &held.frame, held.fates);
    move_fates(step, &held, 1);
}

static void refuse_unclaimed(struct step *step)
{
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD) {
            step->report->fates[i] = RHO_FATE_NO_ROOM;
        }
    }
}

/* The batch's estimate is of x, y, vx and vy. */
static void fill_estimate(const struct rho_passive_track *found, struct rho_kalman *estimate)
{
    static const uint8_t place[4] = {0, 1, 3, 4};
    const float state[4] = {found->x_m, found->y_m, found->vx_mps, found->vy_mps};
    rho_kalman_init(estimate);
    for (int i = 0; i < 4; i++) {
        estimate->state[place[i]] = state[i];
        for (int j = 0; j <= i; j++) {
            estimate->covariance[RHO_AT(place[i], place[j])] = found->covariance[RHO_AT(i, j)];
        }
    }
}

static uint16_t count_bits(unsigned mask)
{
    uint16_t count = 0;
    for (; mask; mask &= mask - 1u) {
        count++;
    }
    return count;
}

/* One of the sensors that saw it last. */
static int32_t last_sensor(const struct rho_passive *passive, const struct rho_passive_track *found)
{
    int32_t sensor_id = passive->batch.sensors[0].sensor_id;
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            sensor_id = found->claim[k][s] ? passive->batch.sensors[s].sensor_id : sensor_id;
        }
    }
    return sensor_id;
}

static void start_track(struct step *step, const struct rho_passive_track *found,
                        const struct rho_track_limits *limits)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_kalman estimate;
    struct rho_track track;
    fill_estimate(found, &estimate);
    if (rho_track_start_estimate(&track, tracker->next_track_id, &estimate, step->time_us,
                                 last_sensor(step->passive, found), count_bits(found->scans),
                                 found->score_mnat) == RHO_OK &&
        rho_tracker_admit(step, &track, limits)) {
        tracker->counters.plots_initiated =
            rho_count(tracker->counters.plots_initiated, rho_passive_consume(step->passive, found));
    }
}

/* Seen in one of the last two scans: what is left over from a track that claims its bearings now is none. */
static int is_fresh(const struct rho_passive *passive, const struct rho_passive_track *found)
{
    return (unsigned)found->scans >> (passive->batch.num_scans - 2u) != 0;
}

/*
 * A batch that is not full may hold ghosts that still look straight. What it starts has the evidence of a whole batch,
 * and is believed at once.
 */
static void initiate(struct step *step)
{
    struct rho_passive *passive = step->passive;
    if (!passive) {
        refuse_unclaimed(step);
        return;
    }
    tell_ghosts(step);
    push(step);
    step->tracker->counters.plots_clutter =
        rho_count(step->tracker->counters.plots_clutter, passive->batch.num_left);
    if (passive->batch.num_scans < passive->batch.scans_max) {
        return;
    }
    (void)!rho_passive_search(passive);
    step->tracker->counters.candidates_dropped =
        rho_count(step->tracker->counters.candidates_dropped, passive->work.candidates_dropped);
    struct rho_track_limits limits = rho_tracker_limits(step);
    limits.confirm_mnat = passive->start_mnat;
    for (unsigned i = 0; i < passive->num_tracks; i++) {
        const struct rho_passive_track *found = &passive->tracks[i];
        if (found->score_mnat >= passive->start_mnat && is_fresh(passive, found)) {
            start_track(step, found, &limits);
        }
    }
}

void rho_tracker_take_frame(struct step *step)
{
    const struct rho_frame *frame = step->frame;
    uint32_t first = 0;
    if (frame->num_scans > step->tracker->looks_max) {
        step->tracker->looks_max =
            (uint16_t)(frame->num_scans < UINT16_MAX ? frame->num_scans : UINT16_MAX);
    }
    rho_tracker_set_pd(step); /* before any sensor is looked at */
    memset(step->report->fates, RHO_FATE_NO_ROOM, step->num_gated);
    rho_tracker_predict(step);
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        take_look(step, &frame->scans[i], first);
        first = rho_count(first, frame->scans[i].num_bearings);
    }
    count_misses(step);
    rho_tracker_age(step);
    initiate(step);
}
