/* SPDX-License-Identifier: MIT */
/* bearing_looks: one sensor's bearings of a frame as a look: opened, claimed and updated. */
#include <string.h>

#include "batch_frame.h"
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

void rho_step_open_frame(struct rho_tracker *tracker, const struct rho_frame *frame,
                         struct rho_look *look)
{
    const uint32_t looks = frame->num_scans < UINT16_MAX ? frame->num_scans : UINT16_MAX;
    if (looks > tracker->looks_max) {
        tracker->looks_max = (uint16_t)looks;
    }
    rho_look_set_pd(look); /* default pd: no sensor's look is open yet */
    memset(look->fates, RHO_FATE_NO_ROOM, look->num_gated);
}

/* A sensor's description, at the position that its scan of bearings states. */
static struct rho_sensor sensor_of_scan(const struct rho_tracker *tracker,
                                        const struct rho_passive *passive,
                                        const struct rho_bearing_scan *scan)
{
    const struct rho_sensor *known = rho_sensors_find(tracker, scan->sensor_id);
    struct rho_sensor sensor = {.sensor_id = scan->sensor_id,
                                .pd = tracker->config.pd,
                                .range_max_m = 2.0f * RHO_LIMIT_POSITION_M};
    if (known) {
        sensor = *known;
    } else if (passive) {
        sensor.range_max_m = passive->config.range_max_m;
    }
    sensor.x_m = scan->x_m;
    sensor.y_m = scan->y_m;
    return sensor;
}

static int does_frame_cover(const struct step *step, const struct rho_track *track)
{
    for (uint32_t i = 0; i < step->frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[i];
        const struct rho_sensor sensor = sensor_of_scan(step->tracker, step->passive, scan);
        if (rho_measurement_covers(&sensor, scan->sector_from_rad, scan->sector_to_rad,
                                   track->kalman.state[0], track->kalman.state[1])) {
            return 1;
        }
    }
    return 0;
}

static void open_look(struct rho_tracker *tracker, const struct rho_passive *passive,
                      struct rho_look *look, const struct rho_bearing_scan *scan, uint32_t first,
                      struct rho_sensor *sensor)
{
    struct rho_tracker_sensor *row = rho_sensors_hear(tracker, scan->sensor_id);
    *sensor = sensor_of_scan(tracker, passive, scan);
    if (row) {
        rho_pace_update(&row->pace, sensor, look->time_us, scan->sector_from_rad,
                        scan->sector_to_rad);
    }
    look->bearings = scan;
    look->sensor = sensor;
    /* false bearings: the mean number of unclaimed ones, over the sector or field of view */
    const float unclaimed = tracker->unclaimed_bearings;
    float view_rad = scan->sector_to_rad - scan->sector_from_rad;
    view_rad = view_rad < 0.0f ? view_rad + RHO_TWO_PI : view_rad;
    if (!(view_rad > 0.0f)) {
        view_rad = passive ? passive->config.field_of_view_rad : RHO_TWO_PI;
    }
    look->log_false_bearings = rho_log((unclaimed > 1.0f ? unclaimed : 1.0f) / view_rad);
    look->num_gated = num_bearings_with_fates(look, scan, first);
    look->fates += first < RHO_MAX_PLOTS ? first : 0;
    rho_look_set_pd(look);
}

static void validate_bearings(struct rho_tracker *tracker, const struct rho_look *look)
{
    for (uint32_t i = 0; i < look->num_gated; i++) {
        const struct rho_bearing *bearing = &look->bearings->bearings[i];
        int is_valid = is_usable_bearing(bearing);
        if (is_valid && !rho_coverage_holds_bearing(look->sensor, bearing->bearing_rad,
                                                    BEARING_SIGMAS * bearing->sigma_rad)) {
            is_valid = 0;
            tracker->counters.plots_outside = rho_count(tracker->counters.plots_outside, 1);
        }
        look->fates[i] = (uint8_t)(is_valid ? RHO_FATE_HELD : RHO_FATE_INVALID);
    }
}

/* *gain_nat: ln of pd times the bearing's density, over that of false ones. 0: outside the gate. */
static int score_bearing(const struct rho_look *look, const struct rho_gate *gate,
                         const struct rho_track *track, uint32_t i, float *gain_nat)
{
    const struct rho_bearing_scan *scan = look->bearings;
    struct rho_gate_result result;
    struct rho_bearing bearing = scan->bearings[i];
    /* the update by an earlier look of the frame may have moved the track from the frame's time */
    bearing.offset_us = (int32_t)(scan->time_us + bearing.offset_us - track->time_us);
    if (!rho_gate_test_bearing(gate, &bearing, scan->x_m, scan->y_m, &result)) {
        return 0;
    }
    *gain_nat = look->log_pd - 0.5f * (RHO_LOG_TWO_PI + result.log_det + result.distance2) -
                look->log_false_bearings;
    return 1;
}

static void offer_bearings(struct rho_tracker *tracker, const struct rho_look *look, unsigned row)
{
    const struct rho_track *track = &tracker->tracks[row];
    struct rho_gate gate;
    float gain_nat;
    rho_score_open_gate(look, track, 0, &gate);
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD && score_bearing(look, &gate, track, i, &gain_nat)) {
            rho_score_add_pair(tracker, row, i, gain_nat - look->log_miss);
        }
    }
}

/* The score of a track that this sensor covers and missed falls, whatever other sensors saw. */
static void update_by_bearings(struct rho_tracker *tracker, const struct rho_look *look)
{
    const struct rho_bearing_scan *scan = look->bearings;
    float unclaimed = 0.0f, gain_nat = 0.0f;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        const int column = rho_assignment_column(&tracker->assignment, row);
        if (track->status == RHO_TRACK_FREE || !rho_look_has_in_view(look, row)) {
            continue;
        }
        if (column != RHO_ASSIGNMENT_NONE) {
            const struct rho_bearing *bearing = &scan->bearings[column];
            const struct rho_track_bearing seen = {
                .time_us = scan->time_us + bearing->offset_us,
                .sensor_id = scan->sensor_id,
                .x_m = scan->x_m,
                .y_m = scan->y_m,
                .bearing_rad = bearing->bearing_rad,
                .sigma_rad = bearing->sigma_rad,
                .row = (int16_t)column,
            };
            struct rho_gate gate;
            rho_score_open_gate(look, track, 0, &gate);
            if (score_bearing(look, &gate, track, (uint32_t)column, &gain_nat) &&
                rho_track_update_bearing(track, &seen, &look->model, rho_score_to_mnat(gain_nat)) ==
                    RHO_OK) {
                look->fates[column] = RHO_FATE_CLAIMED;
                continue;
            }
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
        }
        if (rho_coverage_holds_track(look, scan->sector_from_rad, scan->sector_to_rad, track)) {
            rho_track_lower_score(track, rho_score_to_mnat(-look->log_miss));
        }
    }
    for (uint32_t i = 0; i < look->num_gated; i++) {
        unclaimed += look->fates[i] == RHO_FATE_HELD ? 1.0f : 0.0f;
    }
    rho_clutter_smooth_mean(&tracker->unclaimed_bearings, unclaimed);
}

/* Claims and updates look by look: each sensor meets the gates that those before it left. */
void rho_step_take_frame(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_look *look = &step->look;
    const uint32_t num_gated = look->num_gated;
    uint8_t *fates = look->fates;
    struct rho_sensor sensor;
    uint32_t first = 0;
    for (uint32_t i = 0; i < step->frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[i];
        open_look(tracker, step->passive, look, scan, first, &sensor);
        validate_bearings(tracker, look);
        /* both counts are within the capacities: nothing to refuse */
        (void)!rho_assignment_begin(&tracker->assignment, tracker->num_tracks, look->num_gated);
        for (unsigned row = 0; row < tracker->num_tracks; row++) {
            if (tracker->tracks[row].status != RHO_TRACK_FREE && rho_look_has_in_view(look, row)) {
                offer_bearings(tracker, look, row);
            }
        }
        rho_score_solve(tracker);
        update_by_bearings(tracker, look);
        first = rho_count(first, scan->num_bearings);
        look->num_gated = num_gated;
        look->fates = fates;
    }
    /* the look is again the whole frame, of no sensor */
    look->bearings = 0;
    look->sensor = 0;
    /*
     * A frame without a bearing of a track is one miss, however many sensors looked. The score is
     * left alone: the update has lowered it for each sensor.
     */
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        if (track->status != RHO_TRACK_FREE && !rho_track_is_frozen(track) && track->plot < 0 &&
            does_frame_cover(step, track)) {
            rho_track_count_miss(track, 0);
        }
    }
}
