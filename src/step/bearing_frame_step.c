/* SPDX-License-Identifier: MIT */
/*
 * bearing_frame_step: one frame of bearings goes through the six phases.
 *
 * The frame's scans are claimed and updated one after the other: tracks are updated with the
 * bearings of a sensor before those of the next sensor are gated, which then meet a narrower gate.
 * The bearings that no track claimed go to bearing_initiation.
 */
#include "bearing_frame_copied_into_batch.h"

#include <string.h>

#include "phases.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

/* Standard deviations by which a bearing may lie outside of its sensor's sector. */
#define BEARING_SIGMAS 4.0f

/* One sensor's scan in its frame. */
struct look {
    const struct rho_bearing_scan *scan;
    struct rho_sensor sensor; /* its description, at the position that the scan states */
    uint8_t *fates;
    uint32_t num;      /* bearings that have a fate in the report, and may be claimed */
    float log_density; /* of false bearings a radian */
};

/* ---- looks ----------------------------------------------------------------------------------- */

static struct rho_sensor sensor_of_bearing_scan(const struct step *step,
                                                const struct rho_bearing_scan *scan)
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

/*
 * ln of the density of false bearings a radian: mean number of unclaimed bearings of a scan, at
 * least 1, over the angle of its sector or field of view.
 */
static float log_false_bearing_density(const struct step *step, const struct rho_bearing_scan *scan)
{
    float unclaimed = step->tracker->unclaimed_bearings;
    float view_rad = scan->sector_to_rad - scan->sector_from_rad;
    view_rad = view_rad < 0.0f ? view_rad + RHO_TWO_PI : view_rad;
    if (!(view_rad > 0.0f)) {
        view_rad = step->passive ? step->passive->config.field_of_view_rad : RHO_TWO_PI;
    }
    return rho_log((unclaimed > 1.0f ? unclaimed : 1.0f) / view_rad);
}

/* 1 where a bearing is in its sensor's sector; others are counted in plots_outside. */
static int is_bearing_covered_else_count_outside(struct step *step, const struct look *look,
                                                 uint32_t i)
{
    struct rho_tracker_counters *counters = &step->tracker->counters;
    const struct rho_bearing *bearing = &look->scan->bearings[i];
    if (rho_tracker_coverage_holds_bearing(&look->sensor, bearing->bearing_rad,
                                           BEARING_SIGMAS * bearing->sigma_rad)) {
        return 1;
    }
    counters->plots_outside = rho_count(counters->plots_outside, 1);
    return 0;
}

static void validate_bearings(struct step *step, uint32_t first, struct look *look)
{
    look->fates = step->report->fates + (first < RHO_MAX_PLOTS ? first : 0);
    look->num = num_bearings_with_room_in_fates(&step->look, look->scan, first);
    for (uint32_t i = 0; i < look->num; i++) {
        look->fates[i] = (uint8_t)(is_usable_bearing(&look->scan->bearings[i]) &&
                                           is_bearing_covered_else_count_outside(step, look, i)
                                       ? RHO_FATE_HELD
                                       : RHO_FATE_INVALID);
    }
}

static struct look validate_bearings_and_make_look(struct step *step,
                                                   const struct rho_bearing_scan *scan,
                                                   uint32_t first)
{
    struct look look = {.scan = scan, .sensor = sensor_of_bearing_scan(step, scan)};
    look.log_density = log_false_bearing_density(step, scan);
    validate_bearings(step, first, &look);
    return look;
}

/* 1 for a live track; 0 for a frozen one, which bearings do not change. */
static int is_live_and_not_frozen(const struct rho_track *track)
{
    return track->status != RHO_TRACK_FREE && !rho_tracker_is_track_frozen(track);
}

/* ---- claim and update ------------------------------------------------------------------------ */

static int64_t bearing_time_us(const struct look *look, uint32_t i)
{
    return look->scan->time_us + look->scan->bearings[i].offset_us;
}

/*
 * *gain_nat: ln of pd times the density of the bearing as one of the track, over the density of
 * false bearings. Returns 0 where the bearing is outside of the track's gate.
 */
static int gate_and_score_bearing(const struct step *step, const struct look *look,
                                  const struct rho_track *track, uint32_t i, float *gain_nat)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_bearing bearing = look->scan->bearings[i];
    /* the update by an earlier look of the frame may have moved the track from the frame's time */
    bearing.offset_us = (int32_t)(bearing_time_us(look, i) - track->time_us);
    rho_tracker_open_track_gate(&step->look, track, 0, &gate);
    if (!rho_gate_test_bearing(&gate, &bearing, look->scan->x_m, look->scan->y_m, &result)) {
        return 0;
    }
    *gain_nat = step->look.log_pd - 0.5f * (LOG_TWO_PI + result.log_det + result.distance2) -
                look->log_density;
    return 1;
}

static void offer_gated_bearings(struct step *step, const struct look *look, unsigned row)
{
    struct rho_tracker *tracker = step->tracker;
    float gain_nat;
    for (uint32_t i = 0; i < look->num; i++) {
        if (look->fates[i] == RHO_FATE_HELD &&
            gate_and_score_bearing(step, look, &tracker->tracks[row], i, &gain_nat)) {
            rho_tracker_add_assignment_pair(tracker, row, i, gain_nat - step->look.log_miss);
        }
    }
}

static void assign_bearings_of_look(struct step *step, const struct look *look)
{
    struct rho_tracker *tracker = step->tracker;
    /* both counts are within the capacities: nothing to refuse */
    (void)!rho_assignment_begin(&tracker->assignment, tracker->num_tracks, look->num);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (is_live_and_not_frozen(&tracker->tracks[row])) {
            offer_gated_bearings(step, look, row);
        }
    }
    rho_tracker_solve_assignment(tracker);
}

static int update_track_by_bearing(struct step *step, const struct look *look,
                                   struct rho_track *track, uint32_t i)
{
    const struct rho_bearing *bearing = &look->scan->bearings[i];
    float gain_nat = 0.0f;
    struct rho_track_bearing seen = {
        .time_us = bearing_time_us(look, i),
        .sensor_id = look->scan->sensor_id,
        .x_m = look->scan->x_m,
        .y_m = look->scan->y_m,
        .bearing_rad = bearing->bearing_rad,
        .sigma_rad = bearing->sigma_rad,
        .row = (int16_t)i,
    };
    if (!gate_and_score_bearing(step, look, track, i, &gain_nat) ||
        rho_track_update_bearing(track, &seen, &step->look.model,
                                 rho_tracker_nat_to_mnat(gain_nat)) != RHO_OK) {
        step->tracker->counters.updates_refused =
            rho_count(step->tracker->counters.updates_refused, 1);
        return 0;
    }
    look->fates[i] = RHO_FATE_CLAIMED;
    return 1;
}

/*
 * Updates tracks by their assigned bearings; the score of a track that the sensor covers but missed
 * falls, even where other sensors of the frame saw it.
 */
static void update_or_penalise_tracks(struct step *step, const struct look *look)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        int bearing = rho_assignment_column(&tracker->assignment, row);
        if (!is_live_and_not_frozen(track) ||
            (bearing != RHO_ASSIGNMENT_NONE &&
             update_track_by_bearing(step, look, track, (uint32_t)bearing))) {
            continue;
        }
        if (rho_tracker_sector_covers_track_place(&step->look, look->scan->sector_from_rad,
                                                  look->scan->sector_to_rad, track)) {
            rho_track_lower_score(track, rho_tracker_nat_to_mnat(-step->look.log_miss));
        }
    }
}

static void learn_unclaimed_bearing_count(struct step *step, const struct look *look)
{
    float unclaimed = 0.0f;
    for (uint32_t i = 0; i < look->num; i++) {
        unclaimed += look->fates[i] == RHO_FATE_HELD ? 1.0f : 0.0f;
    }
    rho_tracker_smooth_mean(&step->tracker->unclaimed_bearings, unclaimed);
}

/* ---- the phases ------------------------------------------------------------------------------ */

/* Bearings are gated by one estimate of each track, at the frame's time. */
static void merge_estimates_per_track(struct step *step)
{
    for (unsigned i = 0; i < step->tracker->num_tracks; i++) {
        if (!rho_tracker_is_track_frozen(&step->tracker->tracks[i])) {
            rho_track_merge_estimates(&step->tracker->tracks[i], step->look.time_us,
                                      &step->look.model);
        }
    }
}

static void predict_unfrozen_tracks_to_frame_time(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        tracker->tracks[i].plot = -1;
        if (RHO_SECTORS) {
            rho_tracker_store_track_time_before_late_scan(&tracker->tracks[i]);
        }
        if (!rho_tracker_is_track_frozen(&tracker->tracks[i])) {
            rho_tracker_predict_or_end_track(step, &tracker->tracks[i]);
        }
    }
    merge_estimates_per_track(step);
}

static void claim_and_update_look_by_look(struct step *step)
{
    const struct rho_frame *frame = step->frame;
    uint32_t first = 0;
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &frame->scans[i];
        struct look look = validate_bearings_and_make_look(step, scan, first);
        struct rho_tracker_sensor *row = rho_tracker_hear_sensor(step->tracker, scan->sensor_id);
        if (row) {
            rho_tracker_update_scan_interval(&row->pace, &look.sensor, step->look.time_us,
                                             scan->sector_from_rad, scan->sector_to_rad);
        }
        step->look.sensor = &look.sensor;
        rho_tracker_set_log_pd_of_step(&step->look);
        assign_bearings_of_look(step, &look);
        update_or_penalise_tracks(step, &look);
        learn_unclaimed_bearing_count(step, &look);
        step->look.sensor = 0;
        first = rho_count(first, scan->num_bearings);
    }
}

static int is_looked_at_by_any_sensor(struct step *step, const struct rho_track *track)
{
    int is_seen = 0;
    for (uint32_t i = 0; i < step->frame->num_scans && !is_seen; i++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[i];
        struct rho_sensor sensor = sensor_of_bearing_scan(step, scan);
        step->look.sensor = &sensor;
        is_seen = rho_tracker_sector_covers_track_place(&step->look, scan->sector_from_rad,
                                                        scan->sector_to_rad, track);
    }
    step->look.sensor = 0;
    return is_seen;
}

/*
 * A frame without a bearing of a track is one miss, however many sensors looked. The score is
 * left alone: update_or_penalise_tracks has lowered it for each sensor.
 */
static void count_misses_and_end_tracks(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (is_live_and_not_frozen(track) && track->plot < 0 &&
            is_looked_at_by_any_sensor(step, track)) {
            rho_track_count_miss(track, 0);
        }
    }
    const struct rho_track_limits limits = rho_tracker_track_limits(&step->look);
    rho_tracker_fade_track_counts_set_evidence_need(step);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (is_live_and_not_frozen(track)) {
            rho_tracker_confirm_or_end_track(step, track,
                                             track->plot < 0 && track->misses_in_row > 0, &limits);
        }
    }
    rho_tracker_remove_ended_tracks(tracker);
}

/* ---- the step -------------------------------------------------------------------------------- */

static int is_usable_bearing_scan(const struct rho_frame *frame,
                                  const struct rho_bearing_scan *scan)
{
    return rho_is_coordinate(scan->x_m) && rho_is_coordinate(scan->y_m) &&
           rho_angle_are_sector_ends_valid(scan->sector_from_rad, scan->sector_to_rad) &&
           rho_tracker_is_usable_time(scan->time_us) &&
           scan->time_us - frame->time_us <= RHO_LIMIT_OFFSET_US &&
           scan->time_us - frame->time_us >= -RHO_LIMIT_OFFSET_US;
}

static enum rho_status check_frame_values(const struct rho_frame *frame)
{
    if (frame->num_scans > 0 && !frame->scans) {
        return RHO_ERROR_NULL;
    }
    if (!rho_tracker_is_usable_time(frame->time_us)) {
        return RHO_ERROR_VALUE;
    }
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        if (frame->scans[i].num_bearings > 0 && !frame->scans[i].bearings) {
            return RHO_ERROR_NULL;
        }
        if (!is_usable_bearing_scan(frame, &frame->scans[i])) {
            return RHO_ERROR_VALUE;
        }
    }
    return RHO_OK;
}

static uint32_t count_bearings_of_frame(const struct rho_frame *frame)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        count = rho_count(count, frame->scans[i].num_bearings);
    }
    return count;
}

static void init_bearing_fates_and_default_pd(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const uint32_t looks =
        step->frame->num_scans < UINT16_MAX ? step->frame->num_scans : UINT16_MAX;
    if (looks > tracker->looks_max) {
        tracker->looks_max = (uint16_t)looks;
    }
    rho_tracker_set_log_pd_of_step(&step->look); /* default pd: the step has no sensor yet */
    memset(step->report->fates, RHO_FATE_NO_ROOM, step->look.num_gated);
}

enum rho_status rho_tracker_step_frame(struct rho_tracker *tracker, struct rho_passive *passive,
                                       const struct rho_frame *frame, struct rho_report *report)
{
    if (!tracker || !frame || !report) {
        return RHO_ERROR_NULL;
    }
    if (!rho_tracker_is_ready(tracker)) {
        return RHO_ERROR_STATE;
    }
    if (!RHO_SEARCHES && passive) {
        return RHO_ERROR_CONFIG;
    }
    enum rho_status status = check_frame_values(frame);
    if (status == RHO_OK && passive && !rho_tracker_is_late(tracker, frame->time_us)) {
        status = rho_passive_accepts(passive, frame);
    }
    if (status != RHO_OK) {
        return status;
    }
    struct step step = {
        .tracker = tracker,
        .passive = passive,
        .frame = frame,
        .report = report,
        .look = {.tracker = tracker,
                 .fates = report->fates,
                 .time_us = frame->time_us,
                 .num_inputs = count_bearings_of_frame(frame)},
    };
    if (rho_tracker_begin_step_unless_late(&step)) {
        init_bearing_fates_and_default_pd(&step);
        predict_unfrozen_tracks_to_frame_time(&step);
        claim_and_update_look_by_look(&step);
        count_misses_and_end_tracks(&step);
        rho_tracker_initiate_passive(&step);
        merge_estimates_per_track(&step);
        rho_tracker_record_work(&step);
    }
    rho_tracker_report(&step);
    return RHO_OK;
}
