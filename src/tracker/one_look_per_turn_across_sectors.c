/* SPDX-License-Identifier: MIT */
/*
 * one_look_per_turn_across_sectors: a radar that is stepped sector by sector sees each target once
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
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"
#include "step.h"

/* Half width of a track's gate across the line of sight, standard deviations of its place. */
#define GATE_SIGMAS 3.0f

/* Clears in all tracks that this sensor saw them: the count of its scans begins anew. */
static void forget_sensor_in_tracks(struct rho_tracker *tracker, int32_t sensor_id)
{
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        for (int k = 0; k < 2; k++) {
            track->look[k] = track->look_sensor_id[k] == sensor_id ? 0 : track->look[k];
        }
    }
}

void rho_tracker_record_look_and_antenna_turning(struct step *step)
{
    const struct rho_scan *scan = step->scan;
    struct rho_tracker_look *look = step->row ? &step->row->look : 0;
    if (!look || step->is_late) {
        return;
    }
    if (look->count == 0) {
        forget_sensor_in_tracks(step->tracker, scan->sensor_id);
    } else {
        const unsigned ends =
            rho_angle_continued_ends(look->sector_from_rad, look->sector_to_rad,
                                     scan->sector_from_rad, scan->sector_to_rad, 0.0f);
        /* sectors that meet at both ends, as two halves of a turn do, do not tell the direction */
        step->turning = ends == RHO_ANGLE_CONTINUES_LEFT    ? 1.0f
                        : ends == RHO_ANGLE_CONTINUES_RIGHT ? -1.0f
                                                            : 0.0f;
    }
    look->time_us = scan->time_us;
    look->count = (uint16_t)(look->count == UINT16_MAX ? 1 : look->count + 1);
    look->sector_from_rad = scan->sector_from_rad;
    look->sector_to_rad = scan->sector_to_rad;
    step->look = look->count;
}

/*
 * Takes the lowest start threshold and the highest confirm threshold of all sensors' initiators:
 * the tracks of one radar are tested at the scans of another radar, too.
 */
void rho_tracker_merge_sensor_thresholds(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    if (step->row) {
        step->row->look.start_mnat = step->initiator->start_mnat;
        step->row->look.confirm_mnat = step->initiator->confirm_mnat;
    }
    for (unsigned i = 0; i < tracker->num_rows; i++) {
        const struct rho_tracker_look *look = &tracker->sensors[i].look;
        if (step->time_us - look->time_us > RHO_TRACKER_SILENT_US ||
            (look->start_mnat == 0 && look->confirm_mnat == 0)) {
            continue;
        }
        tracker->start_mnat =
            look->start_mnat < tracker->start_mnat ? look->start_mnat : tracker->start_mnat;
        tracker->confirm_mnat =
            look->confirm_mnat > tracker->confirm_mnat ? look->confirm_mnat : tracker->confirm_mnat;
    }
}

static int is_turning_direction_known(const struct step *step)
{
    return step->turning > 0.0f || step->turning < 0.0f;
}

int rho_tracker_was_seen_in_last_sector(const struct step *step, const struct rho_track *track)
{
    if (!is_turning_direction_known(step)) {
        return 0;
    }
    const uint16_t before = (uint16_t)(step->look == 1 ? UINT16_MAX : step->look - 1);
    const int32_t sensor_id = step->scan->sensor_id;
    return ((track->look_sensor_id[0] == sensor_id && track->look[0] == before) ||
            (track->look_sensor_id[1] == sensor_id && track->look[1] == before));
}

void rho_tracker_record_seeing_sensor(const struct step *step, struct rho_track *track)
{
    if (track->plot < 0 || step->is_late) {
        return;
    }
    if (track->look_sensor_id[0] != step->scan->sensor_id) {
        track->look_sensor_id[1] = track->look_sensor_id[0];
        track->look[1] = track->look[0];
        track->look_sensor_id[0] = step->scan->sensor_id;
    }
    track->look[0] = step->look;
}

/* True where the scan's sector holds the gate's counter-clockwise (+1) or clockwise (-1) end. */
static int sector_holds_gate_end(const struct step *step, const struct rho_track *track,
                                 float turn_sign)
{
    const struct rho_scan *scan = step->scan;
    const float width_rad = rho_angle_sector_width(scan->sector_from_rad, scan->sector_to_rad);
    const float dx_m = track->kalman.state[0] - (step->sensor ? step->sensor->x_m : 0.0f);
    const float dy_m = track->kalman.state[1] - (step->sensor ? step->sensor->y_m : 0.0f);
    const float range_m = rho_sqrt(dx_m * dx_m + dy_m * dy_m);
    float margin_rad = GATE_SIGMAS * rho_track_sigma_m(track) / (range_m > 1.0f ? range_m : 1.0f);
    if (!(margin_rad < 0.5f * width_rad)) {
        margin_rad = 0.5f * width_rad;
    }
    /* the track's place, rotated about the sensor by a small angle */
    const float turn = turn_sign * margin_rad;
    return rho_measurement_covers(step->sensor, scan->sector_from_rad, scan->sector_to_rad,
                                  track->kalman.state[0] - turn * dy_m,
                                  track->kalman.state[1] + turn * dx_m);
}

static int is_scan_less_than_full_turn(const struct rho_scan *scan)
{
    return rho_angle_sector_width(scan->sector_from_rad, scan->sector_to_rad) < RHO_TWO_PI;
}

int rho_tracker_has_antenna_passed_gate(const struct step *step, const struct rho_track *track)
{
    const struct rho_scan *scan = step->scan;
    if (is_turning_direction_known(step)) {
        return sector_holds_gate_end(step, track, step->turning); /* the end that is passed last */
    }
    if (step->is_late && is_scan_less_than_full_turn(scan)) {
        /* where the sector does not hold the whole gate, a neighbouring sector may have the plot */
        return sector_holds_gate_end(step, track, 1.0f) &&
               sector_holds_gate_end(step, track, -1.0f);
    }
    return rho_measurement_covers(step->sensor, scan->sector_from_rad, scan->sector_to_rad,
                                  track->kalman.state[0], track->kalman.state[1]);
}

float rho_tracker_scans_per_turn(const struct step *step)
{
    return is_turning_direction_known(step)
               ? RHO_TWO_PI /
                     rho_angle_sector_width(step->scan->sector_from_rad, step->scan->sector_to_rad)
               : 1.0f;
}

int rho_tracker_is_among_last_two_sensors(const struct rho_track *track, int32_t sensor_id)
{
    return (track->look[0] > 0 && track->look_sensor_id[0] == sensor_id) ||
           (track->look[1] > 0 && track->look_sensor_id[1] == sensor_id);
}

/* ---- snapshots ------------------------------------------------------------------------------- */

int rho_tracker_is_sound_look(const struct rho_tracker_look *look)
{
    return rho_angle_are_sector_ends_valid(look->sector_from_rad, look->sector_to_rad) &&
           rho_is_stored_time(look->time_us) && rho_tracker_is_score_in_range(look->start_mnat) &&
           rho_tracker_is_score_in_range(look->confirm_mnat) &&
           rho_is_within(look->seen_share, 0.0f, 1e9f) &&
           rho_is_within(look->distance2, 0.0f, 1e30f) && rho_is_within(look->sigma_m, 0.0f, 1e9f);
}
