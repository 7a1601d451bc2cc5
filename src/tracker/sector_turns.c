/* SPDX-License-Identifier: MIT */
/*
 * sector_turns: a radar that is stepped sector by sector sees each target once
 * a turn, also one at the edge of two sectors.
 *
 *      previous sector  |  this sector          the antenna turns this way ->
 *            .--------. |
 *           (   gate   )|      passed as a whole: a track without a plot is missed here
 *            '--------' |
 *                  .----|---.
 *                 (   gate   )  its plot may come in either sector. A track that took one in the
 *                  '----|---'   previous sector takes none here. One without a plot is missed
 *                               in the sector in which the antenna passes the end of its gate
 */
#include "policy.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "sight.h"

void rho_turn_note_look(struct rho_tracker *tracker, struct rho_look *look)
{
    const struct rho_scan *scan = look->scan;
    struct rho_tracker_look *health = look->row ? &look->row->look : 0;
    if (!health || !look->teaches) {
        return;
    }
    if (health->count == 0) {
        /* the count of its scans begins anew: no track was seen by this sensor */
        for (unsigned i = 0; i < tracker->num_tracks; i++) {
            struct rho_track *track = &tracker->tracks[i];
            for (int k = 0; k < 2; k++) {
                track->look[k] = track->look_sensor_id[k] == scan->sensor_id ? 0 : track->look[k];
            }
        }
    } else {
        const unsigned ends =
            rho_angle_continued_ends(health->sector_from_rad, health->sector_to_rad,
                                     scan->sector_from_rad, scan->sector_to_rad, 0.0f);
        /* sectors that meet at both ends, as two halves of a turn do, do not tell the direction */
        look->turning = ends == RHO_ANGLE_CONTINUES_LEFT    ? 1.0f
                        : ends == RHO_ANGLE_CONTINUES_RIGHT ? -1.0f
                                                            : 0.0f;
    }
    health->time_us = scan->time_us;
    health->count = (uint16_t)(health->count == UINT16_MAX ? 1 : health->count + 1);
    health->sector_from_rad = scan->sector_from_rad;
    health->sector_to_rad = scan->sector_to_rad;
    look->count = health->count;
}

/* Lowest start and highest confirm threshold of all radars: each tests the others' tracks, too. */
void rho_turn_merge_thresholds(struct rho_tracker *tracker, const struct rho_look *look)
{
    struct rho_tracker_look *record = rho_look_record(look);
    if (record) {
        record->start_mnat = look->initiator->start_mnat;
        record->confirm_mnat = look->initiator->confirm_mnat;
    }
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        const struct rho_tracker_look *health = &tracker->sensors[i].look;
        if (look->time_us - health->time_us > RHO_TRACKER_SILENT_US ||
            (health->start_mnat == 0 && health->confirm_mnat == 0)) {
            continue;
        }
        tracker->start_mnat =
            health->start_mnat < tracker->start_mnat ? health->start_mnat : tracker->start_mnat;
        tracker->confirm_mnat = health->confirm_mnat > tracker->confirm_mnat
                                    ? health->confirm_mnat
                                    : tracker->confirm_mnat;
    }
}

static int is_turning_direction_known(const struct rho_look *look)
{
    return look->turning > 0.0f || look->turning < 0.0f;
}

int rho_turn_saw_before(const struct rho_look *look, const struct rho_track *track)
{
    if (!is_turning_direction_known(look)) {
        return 0;
    }
    const uint16_t before = (uint16_t)(look->count == 1 ? UINT16_MAX : look->count - 1);
    const int32_t sensor_id = look->scan->sensor_id;
    return ((track->look_sensor_id[0] == sensor_id && track->look[0] == before) ||
            (track->look_sensor_id[1] == sensor_id && track->look[1] == before));
}

void rho_turn_note_seen(const struct rho_look *look, struct rho_track *track)
{
    if (track->plot < 0 || !look->teaches) {
        return;
    }
    if (track->look_sensor_id[0] != look->scan->sensor_id) {
        track->look_sensor_id[1] = track->look_sensor_id[0];
        track->look[1] = track->look[0];
        track->look_sensor_id[0] = look->scan->sensor_id;
    }
    track->look[0] = look->count;
}

/* True where the scan's sector holds the gate's counter-clockwise (+1) or clockwise (-1) end. */
static int sector_holds_gate_end(const struct rho_look *look, const struct rho_track *track,
                                 float turn_sign)
{
    const struct rho_scan *scan = look->scan;
    const float width_rad = rho_angle_sector_width(scan->sector_from_rad, scan->sector_to_rad);
    const float dx_m = track->kalman.state[0] - (look->sensor ? look->sensor->x_m : 0.0f);
    const float dy_m = track->kalman.state[1] - (look->sensor ? look->sensor->y_m : 0.0f);
    const float range_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    const float margin_rad =
        rho_smaller(GATE_CIRCLE_SIGMAS * rho_track_sigma_m(track) / rho_larger(range_m, 1.0f),
                    0.5f * width_rad);
    /* the track's place, rotated about the sensor by a small angle */
    const float turn = turn_sign * margin_rad;
    return rho_measurement_covers(look->sensor, scan->sector_from_rad, scan->sector_to_rad,
                                  track->kalman.state[0] - turn * dy_m,
                                  track->kalman.state[1] + turn * dx_m);
}

int rho_turn_has_passed(const struct rho_look *look, const struct rho_track *track)
{
    const struct rho_scan *scan = look->scan;
    if (is_turning_direction_known(look)) {
        return sector_holds_gate_end(look, track, look->turning); /* the end that is passed last */
    }
    if (!look->teaches &&
        rho_angle_sector_width(scan->sector_from_rad, scan->sector_to_rad) < RHO_TWO_PI) {
        /* where the sector does not hold the whole gate, a neighbouring sector may have the plot */
        return sector_holds_gate_end(look, track, 1.0f) &&
               sector_holds_gate_end(look, track, -1.0f);
    }
    return rho_coverage_holds_track(look, scan->sector_from_rad, scan->sector_to_rad, track);
}

float rho_turn_num_scans(const struct rho_look *look)
{
    return is_turning_direction_known(look)
               ? RHO_TWO_PI /
                     rho_angle_sector_width(look->scan->sector_from_rad, look->scan->sector_to_rad)
               : 1.0f;
}

int rho_turn_was_seen_by(const struct rho_track *track, int32_t sensor_id)
{
    return (track->look[0] > 0 && track->look_sensor_id[0] == sensor_id) ||
           (track->look[1] > 0 && track->look_sensor_id[1] == sensor_id);
}

int rho_turn_is_sound(const struct rho_tracker_look *health)
{
    return rho_angle_is_valid_sector(health->sector_from_rad, health->sector_to_rad) &&
           rho_is_stored_time(health->time_us) &&
           rho_tracker_is_score_in_range(health->start_mnat) &&
           rho_tracker_is_score_in_range(health->confirm_mnat) &&
           rho_is_within(health->seen_share, 0.0f, 1e9f) &&
           rho_is_within(health->distance2, 0.0f, 1e30f) &&
           rho_is_within(health->sigma_m, 0.0f, 1e9f);
}
