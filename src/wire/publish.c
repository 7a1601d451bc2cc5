/* SPDX-License-Identifier: MIT */
#include "rhotrack/publish.h"

#include <string.h>

#include "message_clamps.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"

#define PART_TRACKS RHO_MESSAGE_TRACK_LIST_MAX_TRACKS
#define NAT(mnat) ((float)(mnat) / 1000.0f)
#define M2_PER_KM2 1.0e6f

/* ---- Tracks ---- */

static unsigned num_live_and_ended_tracks(const struct rho_report *report)
{
    return (unsigned)report->num_tracks + report->num_ended;
}

uint16_t rho_publish_num_parts(const struct rho_report *report)
{
    unsigned entries = report ? num_live_and_ended_tracks(report) : 0;

    return (uint16_t)(entries <= PART_TRACKS ? 1 : (entries + PART_TRACKS - 1) / PART_TRACKS);
}

static int8_t message_status_of(enum rho_track_status status)
{
    return status == RHO_TRACK_CONFIRMED  ? RHO_MESSAGE_TRACK_CONFIRMED
           : status == RHO_TRACK_COASTING ? RHO_MESSAGE_TRACK_COASTING
                                          : RHO_MESSAGE_TRACK_TENTATIVE;
}

static void fill_live_track(const struct rho_track_report *track, struct rho_message_track *message)
{
    *message = (struct rho_message_track){
        .track_id = (int32_t)(track->track_id & INT32_MAX),
        .status = message_status_of(track->status),
        .hits = rho_clamp_to_int16(track->hits),
        .misses = rho_clamp_to_int16(track->misses),
        .sensor_id = rho_int16_sensor_id_or_minus_1(track->sensor_id),
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

static void fill_live_or_ended_track(const struct rho_report *report, unsigned entry,
                                     struct rho_message_track *message)
{
    if (entry < report->num_tracks) {
        fill_live_track(&report->tracks[entry], message);
        return;
    }
    *message = (struct rho_message_track){
        .track_id = (int32_t)(report->ended[entry - report->num_tracks] & INT32_MAX),
        .status = RHO_MESSAGE_TRACK_DELETED,
        .plot = -1};
}

enum rho_status rho_publish_tracks(const struct rho_report *report, int32_t step, int32_t epoch,
                                   uint16_t part, uint8_t *buffer, size_t capacity, size_t *size)
{
    struct rho_message_track_list_head head;
    struct rho_message_writer writer;
    struct rho_message_track track;
    enum rho_status status;
    unsigned last;

    if (!report || !buffer || !size) {
        return RHO_ERROR_NULL;
    }
    if (part >= rho_publish_num_parts(report)) {
        return RHO_ERROR_VALUE;
    }
    head = (struct rho_message_track_list_head){
        .utime = report->time_us,
        .scan = step,
        .epoch = epoch,
        .num_tracks_total = rho_clamp_to_int16(num_live_and_ended_tracks(report)),
        .part = (int16_t)part,
        .num_parts = (int16_t)rho_publish_num_parts(report)};
    status = rho_message_track_list_begin(&writer, buffer, capacity, &head);
    last = (part + 1u) * PART_TRACKS < num_live_and_ended_tracks(report)
               ? (part + 1u) * PART_TRACKS
               : num_live_and_ended_tracks(report);
    for (unsigned i = part * PART_TRACKS; i < last && status == RHO_OK; i++) {
        fill_live_or_ended_track(report, i, &track);
        status = rho_message_track_list_add(&writer, &track);
    }
    return status == RHO_OK ? rho_message_end(&writer, size) : status;
}

/* ---- Peaks ---- */

static struct rho_message_peak peak_of_motion(float x_m, float y_m, float vx_mps, float vy_mps)
{
    float speed_mps = rho_sqrt(vx_mps * vx_mps + vy_mps * vy_mps);
    /* A standing target has no direction: the line through it is parallel to the y axis. */
    struct rho_line line = speed_mps > 0.0f ? rho_angle_line(x_m, y_m, vx_mps, vy_mps)
                                            : (struct rho_line){.rho_m = x_m, .theta_rad = 0.0f};

    return (struct rho_message_peak){
        .rho_m = line.rho_m, .theta_rad = line.theta_rad, .speed_mps = speed_mps};
}

static enum rho_status add_candidate_peaks(const struct rho_initiator *initiator,
                                           struct rho_message_writer *writer)
{
    enum rho_status status = RHO_OK;
    struct rho_message_peak peak;

    for (unsigned i = 0; i < initiator->num_candidates && status == RHO_OK &&
                         writer->count < RHO_MESSAGE_PEAK_LIST_MAX_PEAKS;
         i++) {
        const struct rho_candidate *candidate = &initiator->candidates[i];

        peak = peak_of_motion(candidate->x_m, candidate->y_m, candidate->vx_mps, candidate->vy_mps);
        peak.score_nat = NAT(candidate->score_mnat);
        peak.scans_hit = rho_clamp_to_int16(candidate->hits);
        status = rho_message_peak_list_add(writer, &peak);
    }
    return status;
}

static enum rho_status add_passive_track_peaks(const struct rho_passive *passive,
                                               struct rho_message_writer *writer)
{
    enum rho_status status = RHO_OK;
    struct rho_message_peak peak;

    for (unsigned i = 0; i < passive->num_tracks && status == RHO_OK &&
                         writer->count < RHO_MESSAGE_PEAK_LIST_MAX_PEAKS;
         i++) {
        const struct rho_passive_track *track = &passive->tracks[i];

        peak = peak_of_motion(track->x_m, track->y_m, track->vx_mps, track->vy_mps);
        peak.score_nat = NAT(track->score_mnat);
        peak.scans_hit = (int16_t)rho_count_bits(track->scans);
        peak.sensor_pairs = (int16_t)rho_passive_sensor_pairs(track);
        status = rho_message_peak_list_add(writer, &peak);
    }
    return status;
}

enum rho_status rho_publish_peaks(const struct rho_initiator *initiator,
                                  const struct rho_passive *passive, int64_t time_us, int32_t step,
                                  uint8_t *buffer, size_t capacity, size_t *size)
{
    struct rho_message_peak_list_head head = {.utime = time_us, .scan = step};
    struct rho_message_writer writer;
    enum rho_status status;

    if (!buffer || !size) {
        return RHO_ERROR_NULL;
    }
    status = rho_message_peak_list_begin(&writer, buffer, capacity, &head);
    if (status == RHO_OK && initiator) {
        status = add_candidate_peaks(initiator, &writer);
    }
    if (status == RHO_OK && passive) {
        status = add_passive_track_peaks(passive, &writer);
    }
    return status == RHO_OK ? rho_message_end(&writer, size) : status;
}

/* ---- Status ---- */

static void fill_assembler_counters(const struct rho_scan_assembler_counters *assembler,
                                    struct rho_message_status *status)
{
    status->scans_accepted = rho_clamp_to_int32(assembler->scans_accepted);
    status->scans_late = rho_clamp_to_int32(assembler->scans_late);
    status->scans_duplicate =
        rho_clamp_to_int32(rho_count(assembler->scans_duplicate, assembler->scans_other));
    status->scans_lost = rho_clamp_to_int32(assembler->scans_lost);
    status->scans_bad =
        rho_clamp_to_int32(rho_count(assembler->scans_bad, assembler->sensors_no_room));
    status->messages_bad = rho_clamp_to_int32(assembler->messages_bad);
    status->messages_wrong_type = rho_clamp_to_int32(assembler->messages_wrong_type);
    status->messages_flooded =
        rho_clamp_to_int32(rho_count(assembler->messages_flooded, assembler->messages_not_allowed));
    status->scans_incomplete = rho_clamp_to_int32(assembler->scans_incomplete);
    status->clock_jumps = rho_clamp_to_int32(assembler->clock_jumps);
    status->sensor_restarts = rho_clamp_to_int32(assembler->sensor_restarts);
    status->bearings_in = rho_clamp_to_int32(assembler->bearings_in);
    status->plots_in = rho_clamp_to_int32(assembler->plots_no_room);
    status->inputs_no_room = rho_clamp_to_int32(assembler->plots_no_room);
}

static void add_frame_counters(const struct rho_frames_counters *frames,
                               struct rho_message_status *status)
{
    status->frames_incomplete = rho_clamp_to_int32(frames->frames_incomplete);
    status->scans_late = rho_clamp_sum_to_int32(status->scans_late, frames->scans_late);
    status->clock_jumps = rho_clamp_sum_to_int32(status->clock_jumps, frames->scans_off_clock);
    status->plots_in = rho_clamp_sum_to_int32(status->plots_in, frames->bearings_no_room);
    status->inputs_no_room =
        rho_clamp_sum_to_int32(status->inputs_no_room, frames->bearings_no_room);
}

static void add_tracker_counters_and_tracks(const struct rho_tracker *tracker,
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

void rho_publish_status(const struct rho_scan_assembler *assembler, const struct rho_frames *frames,
                        const struct rho_tracker *tracker, const struct rho_initiator *initiator,
                        struct rho_message_status *status)
{
    if (!status) {
        return;
    }
    *status = (struct rho_message_status){.utime = 0};
    if (assembler) {
        fill_assembler_counters(&assembler->counters, status);
    }
    if (frames) {
        add_frame_counters(&frames->counters, status);
    }
    if (tracker) {
        add_tracker_counters_and_tracks(tracker, status);
    }
    if (initiator) {
        status->clutter_per_km2 = initiator->density_per_m2 * M2_PER_KM2;
    }
}

/* ---- Work ---- */

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
