/* SPDX-License-Identifier: MIT */
/*
 * bearing_looks: one sensor's bearings of a frame as a look: opened, claimed and updated.
 */
#include <string.h>

#include "batch_frame.h"
#include "phases.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

/* Standard deviations by which a bearing may lie outside of its sensor's sector. */
#define BEARING_SIGMAS 4.0f

void rho_step_begin_frame(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    const uint32_t looks =
        step->frame->num_scans < UINT16_MAX ? step->frame->num_scans : UINT16_MAX;
    if (looks > tracker->looks_max) {
        tracker->looks_max = (uint16_t)looks;
    }
    rho_look_set_pd(&step->look); /* default pd: no sensor's look is open yet */
    memset(step->look.fates, RHO_FATE_NO_ROOM, step->look.num_gated);
}

/* A sensor's description, at the position that its scan of bearings states. */
static struct rho_sensor sensor_of_bearing_scan(const struct step *step,
                                                const struct rho_bearing_scan *scan)
{
    const struct rho_sensor *known = rho_sensors_find(step->tracker, scan->sensor_id);
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

int rho_step_does_frame_cover(const struct step *step, const struct rho_track *track)
{
    for (uint32_t i = 0; i < step->frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &step->frame->scans[i];
        const struct rho_sensor sensor = sensor_of_bearing_scan(step, scan);
        if (rho_measurement_covers(&sensor, scan->sector_from_rad, scan->sector_to_rad,
                                   track->kalman.state[0], track->kalman.state[1])) {
            return 1;
        }
    }
    return 0;
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

void rho_step_open_bearings(struct step *step, const struct rho_bearing_scan *scan, uint32_t first,
                            struct rho_sensor *sensor)
{
    struct rho_look *look = &step->look;
    struct rho_tracker_sensor *row = rho_sensors_hear(step->tracker, scan->sensor_id);
    *sensor = sensor_of_bearing_scan(step, scan);
    if (row) {
        rho_pace_update(&row->pace, sensor, look->time_us, scan->sector_from_rad,
                        scan->sector_to_rad);
    }
    look->bearings = scan;
    look->sensor = sensor;
    look->log_false_bearings = log_false_bearing_density(step, scan);
    look->num_gated = num_bearings_with_room_in_fates(look, scan, first);
    look->fates = step->report->fates + (first < RHO_MAX_PLOTS ? first : 0);
    rho_look_set_pd(look);
}

void rho_step_validate_bearings(struct rho_tracker *tracker, const struct rho_look *look)
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

/*
 * *gain_nat: ln of pd times the density of the bearing as one of the track, over the density of
 * false bearings. Returns 0 where the bearing is outside of the track's gate.
 */
static int score_bearing(const struct rho_look *look, const struct rho_track *track, uint32_t i,
                         float *gain_nat)
{
    const struct rho_bearing_scan *scan = look->bearings;
    struct rho_gate gate;
    struct rho_gate_result result;
    struct rho_bearing bearing = scan->bearings[i];
    /* the update by an earlier look of the frame may have moved the track from the frame's time */
    bearing.offset_us = (int32_t)(scan->time_us + bearing.offset_us - track->time_us);
    rho_score_open_gate(look, track, 0, &gate);
    if (!rho_gate_test_bearing(&gate, &bearing, scan->x_m, scan->y_m, &result)) {
        return 0;
    }
    *gain_nat = look->log_pd - 0.5f * (RHO_LOG_TWO_PI + result.log_det + result.distance2) -
                look->log_false_bearings;
    return 1;
}

void rho_step_offer_bearings(struct rho_tracker *tracker, const struct rho_look *look, unsigned row)
{
    float gain_nat;
    for (uint32_t i = 0; i < look->num_gated; i++) {
        if (look->fates[i] == RHO_FATE_HELD &&
            score_bearing(look, &tracker->tracks[row], i, &gain_nat)) {
            rho_score_add_pair(tracker, row, i, gain_nat - look->log_miss);
        }
    }
}

static int update_by_bearing(struct rho_tracker *tracker, const struct rho_look *look,
                             struct rho_track *track, uint32_t i)
{
    const struct rho_bearing_scan *scan = look->bearings;
    float gain_nat = 0.0f;
    const struct rho_track_bearing seen = {
        .time_us = scan->time_us + scan->bearings[i].offset_us,
        .sensor_id = scan->sensor_id,
        .x_m = scan->x_m,
        .y_m = scan->y_m,
        .bearing_rad = scan->bearings[i].bearing_rad,
        .sigma_rad = scan->bearings[i].sigma_rad,
        .row = (int16_t)i,
    };
    if (!score_bearing(look, track, i, &gain_nat) ||
        rho_track_update_bearing(track, &seen, &look->model, rho_score_to_mnat(gain_nat)) !=
            RHO_OK) {
        tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
        return 0;
    }
    look->fates[i] = RHO_FATE_CLAIMED;
    return 1;
}

/*
 * The score of a track that the sensor covers but missed falls, even where other sensors of the
 * frame saw it.
 */
void rho_step_update_by_bearings(struct rho_tracker *tracker, const struct rho_look *look)
{
    float unclaimed = 0.0f;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        const int bearing = rho_assignment_column(&tracker->assignment, row);
        if (track->status == RHO_TRACK_FREE || !rho_look_has_in_view(look, row) ||
            (bearing != RHO_ASSIGNMENT_NONE &&
             update_by_bearing(tracker, look, track, (uint32_t)bearing))) {
            continue;
        }
        if (rho_coverage_holds_track(look, look->bearings->sector_from_rad,
                                     look->bearings->sector_to_rad, track)) {
            rho_track_lower_score(track, rho_score_to_mnat(-look->log_miss));
        }
    }
    for (uint32_t i = 0; i < look->num_gated; i++) {
        unclaimed += look->fates[i] == RHO_FATE_HELD ? 1.0f : 0.0f;
    }
    rho_clutter_smooth_mean(&tracker->unclaimed_bearings, unclaimed);
}
