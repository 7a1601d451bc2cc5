/* SPDX-License-Identifier: MIT */
/*
 * bearing_initiation: initiation from a frame of bearings. Unclaimed bearings go into the batch of
 * passive initiation, ghosts among them are marked, and a full batch starts tracks.
 */
#include <string.h>

#include "batch_frame.h"
#include "policy.h"
#include "rhotrack/detail/bearing_crossing.h"

/* 1 where a bearing has crossings with those of other sensors, and none can be a target. */
static int is_ghost_bearing(const struct step *step, const struct rho_bearing_scan *scan,
                            float bearing_rad)
{
    struct rho_crossing_base base;
    struct rho_crossing crossing;
    int has_crossings = 0;
    for (uint32_t k = 0; k < step->frame->num_scans; k++) {
        const struct rho_bearing_scan *other = &step->frame->scans[k];
        if (other == scan ||
            rho_crossing_set_base(&base, scan->x_m, scan->y_m, other->x_m, other->y_m) != RHO_OK) {
            continue;
        }
        for (uint32_t j = 0; j < other->num_bearings && j < RHO_MAX_BEARINGS; j++) {
            const struct rho_bearing *crossed = &other->bearings[j];
            if (is_usable_bearing(crossed)) {
                has_crossings = 1;
                if (rho_crossing_find(&base, bearing_rad, crossed->bearing_rad,
                                      step->passive->config.range_max_m,
                                      &crossing) == RHO_CROSSING_MEETS) {
                    return 0;
                }
            }
        }
    }
    return has_crossings;
}

void rho_step_frame_to_batch(const struct rho_look *look, const struct rho_frame *frame,
                             struct batch_frame *held)
{
    uint8_t *packed = held->fates;
    uint32_t first = 0;
    held->frame = *frame;
    held->frame.scans = held->scans;
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        const uint32_t num = num_bearings_with_fates(look, &frame->scans[i], first);
        held->scans[i] = frame->scans[i];
        held->scans[i].num_bearings = num;
        memcpy(packed, look->fates + (num > 0 ? first : 0), num);
        packed += num;
        first = rho_count(first, frame->scans[i].num_bearings);
    }
}

void rho_step_batch_to_report(const struct rho_look *look, const struct batch_frame *held,
                              const struct rho_frame *frame)
{
    const uint8_t *packed = held->fates;
    uint32_t first = 0;
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        const uint32_t num = held->scans[i].num_bearings;
        memcpy(look->fates + (num > 0 ? first : 0), packed, num);
        packed += num;
        first = rho_count(first, frame->scans[i].num_bearings);
    }
}

/* A function of its own, for its stack: the batch's frame is needed here alone. */
static void push_frame(const struct rho_look *look, const struct rho_frame *frame,
                       struct rho_passive *passive)
{
    struct batch_frame held;
    rho_step_frame_to_batch(look, frame, &held);
    /* cannot fail: rho_tracker_step_frame has asked whether the batch accepts the frame */
    (void)!rho_passive_push(passive, &held.frame, held.fates);
    rho_step_batch_to_report(look, &held, frame);
}

static void start_found_track(struct step *step, const struct rho_passive_track *found)
{
    static const uint8_t place[4] = {0, 1, 3, 4}; /* of x, y, vx and vy in a state of three axes */
    struct rho_tracker *tracker = step->tracker;
    const struct rho_batch *batch = &step->passive->batch;
    const float state[4] = {found->x_m, found->y_m, found->vx_mps, found->vy_mps};
    struct rho_kalman estimate;
    struct rho_track track;
    rho_kalman_init(&estimate);
    for (int i = 0; i < 4; i++) {
        estimate.state[place[i]] = state[i];
        for (int j = 0; j <= i; j++) {
            estimate.covariance[RHO_AT(place[i], place[j])] = found->covariance[RHO_AT(i, j)];
        }
    }
    /* the track is of a sensor with a bearing in its newest scan */
    int32_t sensor_id = batch->sensors[0].sensor_id;
    for (unsigned k = 0; k < batch->num_scans; k++) {
        for (unsigned s = 0; s < batch->num_sensors; s++) {
            sensor_id = found->claim[k][s] ? batch->sensors[s].sensor_id : sensor_id;
        }
    }
    if (rho_track_start_estimate(&track, tracker->next_track_id, &estimate, step->look.time_us,
                                 sensor_id, (uint16_t)rho_count_bits(found->scans),
                                 &step->look.model, found->score_mnat) == RHO_OK &&
        rho_step_admit(step, &track, step->passive->start_mnat)) {
        tracker->counters.plots_initiated =
            rho_count(tracker->counters.plots_initiated, rho_passive_consume(step->passive, found));
    }
}

/*
 * Searches a full batch only, once a row: in a shorter one ghosts may still move on straight lines.
 */
void rho_step_initiate_bearings(struct step *step)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    struct rho_passive *passive = step->passive;
    const struct rho_look *look = &step->look;
    if (!RHO_SEARCHES || !passive) {
        rho_step_replace_fates(look, RHO_FATE_HELD, RHO_FATE_NO_ROOM);
        return;
    }
    push_frame(look, step->frame, passive);
    /* ghosts stay in the batch: the other sensors may have missed the target of such a bearing */
    uint32_t first = 0;
    for (uint32_t k = 0; k < step->frame->num_scans; k++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[k];
        const uint32_t num = num_bearings_with_fates(look, scan, first);
        for (uint32_t i = 0; i < num; i++) {
            uint8_t *fate = &look->fates[first + i];
            if (*fate == RHO_FATE_HELD &&
                is_ghost_bearing(step, scan, scan->bearings[i].bearing_rad)) {
                *fate = RHO_FATE_GHOST;
            }
        }
        first = rho_count(first, scan->num_bearings);
    }
    counters->plots_clutter = rho_count(counters->plots_clutter, passive->batch.num_left);
    if (passive->batch.num_scans < passive->batch.scans_max || !passive->batch.is_due) {
        return;
    }
    (void)!rho_passive_search(passive);
    counters->candidates_dropped =
        rho_count(counters->candidates_dropped, passive->work.candidates_dropped);
    for (unsigned i = 0; i < passive->num_tracks; i++) {
        const struct rho_passive_track *found = &passive->tracks[i];
        /* without a bearing of the last two scans, a started track may claim the newer ones */
        const int is_recent = (unsigned)found->scans >> (passive->batch.num_scans - 2u) != 0;
        if (is_recent && found->score_mnat >= passive->start_mnat &&
            found->margin_mnat >= MARGIN_MIN_MNAT) {
            start_found_track(step, found);
        }
    }
}
