/* SPDX-License-Identifier: MIT */
#include "rhotrack/publish.h"

#include <string.h>

#include "message_clamps.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

#define PART_TRACKS RHO_MESSAGE_TRACK_LIST_MAX_TRACKS
#define NAT(mnat) ((float)(mnat) / 1000.0f)

/* Tracks: the live ones but those in doubt, and then the ended ones */

static unsigned num_entries(const struct rho_report *report)
{
    unsigned num = report->num_ended;
    for (unsigned i = 0; i < report->num_tracks; i++) {
        num += !report->tracks[i].is_in_doubt;
    }
    return num;
}

uint16_t rho_publish_num_parts(const struct rho_report *report)
{
    return (uint16_t)rho_num_parts(report ? num_entries(report) : 0, PART_TRACKS);
}

static void fill_live_track(const struct rho_track_report *track, struct rho_message_track *message)
{
    *message = (struct rho_message_track){
        .track_id = (int32_t)(track->track_id & INT32_MAX),
        .status = track->status == RHO_TRACK_CONFIRMED  ? RHO_MESSAGE_TRACK_CONFIRMED
                  : track->status == RHO_TRACK_COASTING ? RHO_MESSAGE_TRACK_COASTING
                                                        : RHO_MESSAGE_TRACK_TENTATIVE,
        .hits = rho_clamp_to_int16(track->hits),
        .misses = rho_clamp_to_int16(track->misses),
        .sensor_id = rho_clamp_sensor_id(track->sensor_id),
        .plot = (int16_t)(track->plot <= INT16_MAX ? track->plot : INT16_MAX),
        .update_age_us = track->update_age_us,
        .x_m = track->state[0],
        .y_m = track->state[1],
        .z_m = track->state[2],
        .vx_mps = track->state[3],
        .vy_mps = track->state[4],
        .vz_mps = track->state[5],
        .ax_mps2 = track->accel_mps2[0],
        .ay_mps2 = track->accel_mps2[1],
        .az_mps2 = track->accel_mps2[2],
        .score_nat = track->score_nat,
        .maneuver_probability = track->maneuver_probability,
    };
    memcpy(message->covariance, track->covariance, sizeof message->covariance);
}

enum rho_status rho_publish_tracks(const struct rho_report *report, int32_t step, int32_t epoch,
                                   uint16_t part, uint8_t *buffer, size_t capacity, size_t *size)
{
    if (!report || !buffer || !size) {
        return RHO_ERROR_NULL;
    }
    if (part >= rho_publish_num_parts(report)) {
        return RHO_ERROR_VALUE;
    }
    const struct rho_message_track_list_head head = {
        .utime = report->time_us,
        .scan = step,
        .epoch = epoch,
        .num_tracks_total = rho_clamp_to_int16(num_entries(report)),
        .part = (int16_t)part,
        .num_parts = (int16_t)rho_publish_num_parts(report)};
    struct rho_message_writer writer;
    struct rho_message_track track;
    enum rho_status status = rho_message_track_list_begin(&writer, buffer, capacity, &head);
    unsigned place = 0;
    for (unsigned i = 0; i < (unsigned)report->num_tracks + report->num_ended && status == RHO_OK;
         i++) {
        const struct rho_track_report *live = i < report->num_tracks ? &report->tracks[i] : NULL;
        if ((live && live->is_in_doubt) || place++ / PART_TRACKS != part) {
            continue;
        }
        if (live) {
            fill_live_track(live, &track);
        } else {
            track = (struct rho_message_track){
                .track_id = (int32_t)(report->ended[i - report->num_tracks] & INT32_MAX),
                .status = RHO_MESSAGE_TRACK_DELETED,
                .plot = -1};
        }
        status = rho_message_track_list_add(&writer, &track);
    }
    return status == RHO_OK ? rho_message_end(&writer, size) : status;
}

/* Peaks */

static struct rho_message_peak peak_of_motion(float x_m, float y_m, float vx_mps, float vy_mps)
{
    const float speed_mps = rho_sqrt(vx_mps * vx_mps + vy_mps * vy_mps);
    /* A standing target has no direction: the line through it is parallel to the y axis. */
    const struct rho_line line = speed_mps > 0.0f
                                     ? rho_angle_line(x_m, y_m, vx_mps, vy_mps)
                                     : (struct rho_line){.rho_m = x_m, .theta_rad = 0.0f};
    return (struct rho_message_peak){
        .rho_m = line.rho_m, .theta_rad = line.theta_rad, .speed_mps = speed_mps};
}

enum rho_status rho_publish_peaks(const struct rho_initiator *initiator,
                                  const struct rho_passive *passive, int64_t time_us, int32_t step,
                                  uint8_t *buffer, size_t capacity, size_t *size)
{
    const struct rho_message_peak_list_head head = {.utime = time_us, .scan = step};
    const unsigned num_candidates = initiator ? initiator->num_candidates : 0;
    const unsigned num_tracks = passive ? passive->num_tracks : 0;
    struct rho_message_writer writer;
    if (!buffer || !size) {
        return RHO_ERROR_NULL;
    }
    enum rho_status status = rho_message_peak_list_begin(&writer, buffer, capacity, &head);
    for (unsigned i = 0;
         i < num_candidates && status == RHO_OK && writer.count < RHO_MESSAGE_PEAK_LIST_MAX_PEAKS;
         i++) {
        const struct rho_candidate *at = &initiator->candidates[i];
        struct rho_message_peak peak = peak_of_motion(at->x_m, at->y_m, at->vx_mps, at->vy_mps);
        peak.score_nat = NAT(at->score_mnat);
        peak.scans_hit = rho_clamp_to_int16(at->hits);
        status = rho_message_peak_list_add(&writer, &peak);
    }
    for (unsigned i = 0;
         i < num_tracks && status == RHO_OK && writer.count < RHO_MESSAGE_PEAK_LIST_MAX_PEAKS;
         i++) {
        const struct rho_passive_track *at = &passive->tracks[i];
        struct rho_message_peak peak = peak_of_motion(at->x_m, at->y_m, at->vx_mps, at->vy_mps);
        peak.score_nat = NAT(at->score_mnat);
        peak.scans_hit = (int16_t)rho_count_bits(at->scans);
        peak.sensor_pairs = (int16_t)rho_passive_sensor_pairs(at);
        status = rho_message_peak_list_add(&writer, &peak);
    }
    return status == RHO_OK ? rho_message_end(&writer, size) : status;
}

/* Status */

static void set_scan_counters(const struct rho_scan_assembler_counters *counters,
                              struct rho_message_status *status)
{
    status->scans_accepted = rho_clamp_to_int32(counters->scans_accepted);
    status->scans_late = rho_clamp_to_int32(counters->scans_late);
    status->scans_duplicate =
        rho_clamp_to_int32(rho_count(counters->scans_duplicate, counters->scans_other));
    status->scans_lost = rho_clamp_to_int32(counters->scans_lost);
    status->scans_bad =
        rho_clamp_to_int32(rho_count(counters->scans_bad, counters->sensors_no_room));
    status->messages_bad = rho_clamp_to_int32(counters->messages_bad);
    status->messages_wrong_type = rho_clamp_to_int32(counters->messages_wrong_type);
    status->messages_flooded =
        rho_clamp_to_int32(rho_count(counters->messages_flooded, counters->messages_not_allowed));
    status->scans_incomplete = rho_clamp_to_int32(counters->scans_incomplete);
    status->clock_jumps = rho_clamp_to_int32(counters->clock_jumps);
    status->sensor_restarts = rho_clamp_to_int32(counters->sensor_restarts);
    status->bearings_in = rho_clamp_to_int32(counters->bearings_in);
    status->plots_in = rho_clamp_to_int32(counters->plots_no_room);
    status->inputs_no_room = rho_clamp_to_int32(counters->plots_no_room);
}

static void add_tracker_counters(const struct rho_tracker *tracker,
                                 struct rho_message_status *status)
{
    const struct rho_tracker_counters *counters = &tracker->counters;
    uint32_t count[RHO_NUM_TRACK_STATUS] = {0};
    status->utime = tracker->time_us;
    status->scans_late = rho_clamp_sum_to_int32(status->scans_late, counters->scans_late);
    status->plots_in = rho_clamp_sum_to_int32(status->plots_in, counters->plots_in);
    status->plots_claimed = rho_clamp_to_int32(counters->fates[RHO_FATE_CLAIMED]);
    status->plots_held = rho_clamp_to_int32(counters->fates[RHO_FATE_HELD]);
    status->plots_initiated = rho_clamp_to_int32(counters->plots_initiated);
    status->plots_clutter = rho_clamp_to_int32(counters->plots_clutter);
    status->inputs_stale = rho_clamp_to_int32(counters->fates[RHO_FATE_STALE]);
    status->inputs_invalid = rho_clamp_to_int32(counters->fates[RHO_FATE_INVALID]);
    status->inputs_no_room =
        rho_clamp_sum_to_int32(status->inputs_no_room, counters->fates[RHO_FATE_NO_ROOM]);
    status->ghosts_pruned = rho_clamp_to_int32(counters->fates[RHO_FATE_GHOST]);
    /* Only num_tracks entries are live: the array holds ended tracks behind them. */
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        if (tracker->tracks[i].status < RHO_NUM_TRACK_STATUS) {
            count[tracker->tracks[i].status]++;
        }
    }
    status->tracks_tentative = rho_clamp_to_int16(count[RHO_TRACK_TENTATIVE]);
    status->tracks_confirmed = rho_clamp_to_int16(count[RHO_TRACK_CONFIRMED]);
    status->tracks_coasting = rho_clamp_to_int16(count[RHO_TRACK_COASTING]);
}

void rho_publish_status(const struct rho_scan_assembler *assembler,
                        const struct rho_tracker *tracker, const struct rho_initiator *initiator,
                        struct rho_message_status *status)
{
    if (!status) {
        return;
    }
    *status = (struct rho_message_status){.utime = 0};
    if (assembler) {
        set_scan_counters(&assembler->counters, status);
    }
    if (tracker) {
        add_tracker_counters(tracker, status);
    }
    if (initiator) {
        status->clutter_per_km2 = initiator->density_per_m2 * 1.0e6f; /* m2 of a km2 */
    }
}

/* Work */

void rho_publish_work(const struct rho_tracker *tracker, struct rho_message_work *work)
{
    if (!work) {
        return;
    }
    *work = (struct rho_message_work){.utime = 0};
    if (tracker) {
        work->utime = tracker->time_us;
        work->work_max = tracker->config.work_max;
        work->work = tracker->work.work;
        work->work_worst = tracker->work.work_worst;
        work->partial_steps = tracker->work.partial_steps;
        work->plots_not_tried = tracker->work.plots_not_tried;
    }
}
