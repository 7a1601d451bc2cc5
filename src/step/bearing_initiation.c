/* SPDX-License-Identifier: MIT */
/*
 * bearing_initiation: initiation from a frame of bearings. Unclaimed bearings go into the batch of
 * passive initiation, ghosts among them are marked, and a full batch starts tracks.
 */
#include <string.h>

#include "batch_frame.h"
#include "rhotrack/detail/bearing_crossing.h"

/* Least margin of a found track over rival tracks of its bearings: ln of odds of 100 to 1. */
#define MARGIN_MIN_MNAT 4605

/* ---- ghosts ---------------------------------------------------------------------------------- */

/*
 * 1 where a bearing crosses one of another sensor's scan at a place that may be a target. *num
 * counts the crossings tried.
 */
static int has_possible_crossing(const struct step *step, const struct rho_crossing_base *base,
                                 float bearing_rad, const struct rho_bearing_scan *other,
                                 uint32_t *num)
{
    struct rho_crossing crossing;
    for (uint32_t j = 0; j < other->num_bearings && j < RHO_MAX_BEARINGS; j++) {
        if (is_usable_bearing(&other->bearings[j])) {
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

/* 1 where a bearing has crossings with those of other sensors, and none can be a target. */
static int is_ghost_bearing(const struct step *step, const struct rho_bearing_scan *scan,
                            uint32_t i)
{
    uint32_t num = 0;
    for (uint32_t k = 0; k < step->frame->num_scans; k++) {
        const struct rho_bearing_scan *other = &step->frame->scans[k];
        struct rho_crossing_base base;
        if (other != scan &&
            rho_crossing_set_base(&base, scan->x_m, scan->y_m, other->x_m, other->y_m) == RHO_OK &&
            has_possible_crossing(step, &base, scan->bearings[i].bearing_rad, other, &num)) {
            return 0;
        }
    }
    return num > 0;
}

/* Ghosts stay in the batch: the other sensors may have missed the target of such a bearing. */
static void mark_ghost_bearings(struct step *step)
{
    uint32_t first = 0;
    for (uint32_t k = 0; k < step->frame->num_scans; k++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[k];
        uint32_t num = num_bearings_with_room_in_fates(&step->look, scan, first);
        for (uint32_t i = 0; i < num; i++) {
            uint8_t *fate = &step->report->fates[first + i];
            if (*fate == RHO_FATE_HELD && is_ghost_bearing(step, scan, i)) {
                *fate = RHO_FATE_GHOST;
            }
        }
        first = rho_count(first, scan->num_bearings);
    }
}

/* ---- initiate -------------------------------------------------------------------------------- */

/* Copies fates from the report to the batch's frame; to_report: from the frame to the report. */
static void copy_fates_between_report_and_batch(const struct step *step, struct batch_frame *held,
                                                int to_report)
{
    uint8_t *packed = held->fates;
    uint32_t first = 0;
    for (uint32_t i = 0; i < step->frame->num_scans; i++) {
        uint32_t num = held->scans[i].num_bearings;
        uint8_t *fates = step->report->fates + (num > 0 ? first : 0);
        memcpy(to_report ? fates : packed, to_report ? packed : fates, num);
        packed += num;
        first = rho_count(first, step->frame->scans[i].num_bearings);
    }
}

void rho_step_frame_to_batch(const struct step *step, struct batch_frame *held)
{
    uint32_t first = 0;
    held->frame = *step->frame;
    held->frame.scans = held->scans;
    for (uint32_t i = 0; i < held->frame.num_scans; i++) {
        held->scans[i] = step->frame->scans[i];
        held->scans[i].num_bearings =
            num_bearings_with_room_in_fates(&step->look, &held->scans[i], first);
        first = rho_count(first, step->frame->scans[i].num_bearings);
    }
    copy_fates_between_report_and_batch(step, held, 0);
}

void rho_step_batch_to_report(const struct step *step, struct batch_frame *held)
{
    copy_fates_between_report_and_batch(step, held, 1);
}

static void push_frame_into_batch(struct step *step)
{
    struct batch_frame held;
    rho_step_frame_to_batch(step, &held);
    /* cannot fail: rho_tracker_step_frame has asked whether the batch accepts the frame */
    (void)!rho_passive_push(step->passive, &held.frame, held.fates);
    rho_step_batch_to_report(step, &held);
}

/* Copies a found track's x, y, vx and vy, and their covariance, into an estimate of three axes. */
static void set_estimate_from_found_track(const struct rho_passive_track *found,
                                          struct rho_kalman *estimate)
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

/* Identity of a sensor with a bearing in the newest scan of the found track. */
static int32_t last_sensor_of_found_track(const struct rho_passive *passive,
                                          const struct rho_passive_track *found)
{
    int32_t sensor_id = passive->batch.sensors[0].sensor_id;
    for (unsigned k = 0; k < passive->batch.num_scans; k++) {
        for (unsigned s = 0; s < passive->batch.num_sensors; s++) {
            sensor_id = found->claim[k][s] ? passive->batch.sensors[s].sensor_id : sensor_id;
        }
    }
    return sensor_id;
}

static void start_found_track(struct step *step, const struct rho_passive_track *found,
                              const struct rho_track_limits *limits)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_kalman estimate;
    struct rho_track track;
    set_estimate_from_found_track(found, &estimate);
    if (rho_track_start_estimate(&track, tracker->next_track_id, &estimate, step->look.time_us,
                                 last_sensor_of_found_track(step->passive, found),
                                 (uint16_t)rho_count_bits(found->scans), &step->look.model,
                                 found->score_mnat) == RHO_OK &&
        rho_step_admit(step, &track, limits)) {
        tracker->counters.plots_initiated =
            rho_count(tracker->counters.plots_initiated, rho_passive_consume(step->passive, found));
    }
}

/*
 * True where a found track has a bearing of the last two scans: others may be of a target whose
 * newer bearings a started track claims.
 */
static int is_seen_in_last_two_scans(const struct rho_passive *passive,
                                     const struct rho_passive_track *found)
{
    return (unsigned)found->scans >> (passive->batch.num_scans - 2u) != 0;
}

/*
 * Only a full batch is searched: in a shorter one ghosts may still move on straight lines. A
 * started track has the evidence of a whole batch, and is confirmed at once.
 */
void rho_step_initiate_bearings(struct step *step)
{
    struct rho_passive *passive = step->passive;
    if (!RHO_SEARCHES || !passive) {
        rho_step_replace_fates(&step->look, RHO_FATE_HELD, RHO_FATE_NO_ROOM);
        return;
    }
    push_frame_into_batch(step);
    mark_ghost_bearings(step);
    step->tracker->counters.plots_clutter =
        rho_count(step->tracker->counters.plots_clutter, passive->batch.num_left);
    if (passive->batch.num_scans < passive->batch.scans_max) {
        return;
    }
    (void)!rho_passive_search(passive);
    step->tracker->counters.candidates_dropped =
        rho_count(step->tracker->counters.candidates_dropped, passive->work.candidates_dropped);
    struct rho_track_limits limits = rho_life_limits(&step->look);
    limits.confirm_mnat = passive->start_mnat;
    for (unsigned i = 0; i < passive->num_tracks; i++) {
        const struct rho_passive_track *found = &passive->tracks[i];
        if (found->score_mnat >= passive->start_mnat && found->margin_mnat >= MARGIN_MIN_MNAT &&
            is_seen_in_last_two_scans(passive, found)) {
            start_found_track(step, found, &limits);
        }
    }
}
