/* SPDX-License-Identifier: MIT */
/*
 * frame_step: a frame of bearings goes through the phases of a step, each sensor's bearings as a
 * look.
 */
#include "batch_frame.h"
#include "rhotrack/detail/angle.h"

static enum rho_status check_frame(const struct rho_tracker *tracker,
                                   const struct rho_passive *passive, const struct rho_frame *frame,
                                   const struct rho_report *report)
{
    const enum rho_status status = rho_tracker_check(tracker, frame && report);
    if (status != RHO_OK) {
        return status;
    }
    if (!RHO_SEARCHES && passive) {
        return RHO_ERROR_CONFIG;
    }
    if (frame->num_scans > 0 && !frame->scans) {
        return RHO_ERROR_NULL;
    }
    if (!rho_step_is_usable_time(frame->time_us)) {
        return RHO_ERROR_VALUE;
    }
    for (uint32_t i = 0; i < frame->num_scans; i++) {
        const struct rho_bearing_scan *scan = &frame->scans[i];
        if (scan->num_bearings > 0 && !scan->bearings) {
            return RHO_ERROR_NULL;
        }
        if (!rho_is_coordinate(scan->x_m) || !rho_is_coordinate(scan->y_m) ||
            !rho_is_coordinate(scan->z_m) ||
            !rho_angle_is_valid_sector(scan->sector_from_rad, scan->sector_to_rad) ||
            !rho_step_is_usable_time(scan->time_us) ||
            scan->time_us - frame->time_us > RHO_LIMIT_OFFSET_US ||
            scan->time_us - frame->time_us < -RHO_LIMIT_OFFSET_US) {
            return RHO_ERROR_VALUE;
        }
    }
    return passive && rho_step_is_newest(tracker, frame->time_us)
               ? rho_passive_accepts(passive, frame)
               : RHO_OK;
}

enum rho_status rho_tracker_step_frame(struct rho_tracker *tracker, struct rho_passive *passive,
                                       const struct rho_frame *frame, struct rho_report *report)
{
    const enum rho_status status = check_frame(tracker, passive, frame, report);
    if (status == RHO_OK) {
        struct step step = {
            .tracker = tracker,
            .report = report,
            .passive = passive,
            .frame = frame,
            .look = {.tracker = tracker, .fates = report->fates, .time_us = frame->time_us}};
        for (uint32_t i = 0; i < frame->num_scans; i++) {
            step.look.num_inputs = rho_count(step.look.num_inputs, frame->scans[i].num_bearings);
        }
        struct frame_owners owners = {.of = {{{.track_id = 0}}}};
        if (rho_step_begin(&step)) {
            rho_step_open_frame(&step.look);
            rho_step_predict(&step);
            rho_step_take_frame(&step, &owners);
            rho_step_age(&step);
            rho_step_initiate_bearings(&step, &owners);
            rho_step_merge_estimates(&step);
            rho_work_record(tracker, &step.work, report);
        }
        rho_step_report(&step);
    }
    return status;
}
