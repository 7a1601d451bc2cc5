/* SPDX-License-Identifier: MIT */
/* bearing_step: a scan of bearings goes through the phases of a step, as one look. */
#include "phases.h"
#include "rhotrack/detail/angle.h"

static enum rho_status check_bearings(const struct rho_tracker *tracker,
                                      const struct rho_passive *passive,
                                      const struct rho_bearing_scan *scan,
                                      const struct rho_report *report)
{
    const enum rho_status status =
        rho_tracker_check(tracker, scan && report && (scan->num_bearings == 0 || scan->bearings));
    if (status != RHO_OK) {
        return status;
    }
    if (!RHO_SEARCHES && passive) {
        return RHO_ERROR_CONFIG;
    }
    if (!rho_is_coordinate(scan->x_m) || !rho_is_coordinate(scan->y_m) ||
        !rho_is_coordinate(scan->z_m) ||
        !rho_angle_is_valid_sector(scan->sector_from_rad, scan->sector_to_rad) ||
        !rho_step_is_usable_time(scan->time_us)) {
        return RHO_ERROR_VALUE;
    }
    const struct rho_frame frame = {.time_us = scan->time_us, .scans = scan, .num_scans = 1};
    return passive && rho_step_is_newest(tracker, scan->time_us)
               ? rho_passive_accepts(passive, &frame)
               : RHO_OK;
}

enum rho_status rho_tracker_step_bearings(struct rho_tracker *tracker, struct rho_passive *passive,
                                          const struct rho_bearing_scan *scan,
                                          struct rho_report *report)
{
    const enum rho_status status = check_bearings(tracker, passive, scan, report);
    if (status == RHO_OK) {
        struct rho_batch_owner owners[RHO_MAX_BEARINGS] = {{.track_id = 0}};
        struct rho_sensor sensor;
        struct step step = {.tracker = tracker,
                            .report = report,
                            .passive = passive,
                            .look = {.tracker = tracker,
                                     .bearings = scan,
                                     .fates = report->fates,
                                     .time_us = scan->time_us,
                                     .num_inputs = scan->num_bearings}};
        if (rho_step_begin(&step)) {
            rho_step_predict(&step);
            rho_step_take_bearings(&step, &sensor, owners);
            rho_step_age(&step);
            rho_step_initiate_bearings(&step, owners);
            rho_step_merge_estimates(&step);
            rho_work_record(tracker, &step.work, report);
        }
        rho_step_report(&step);
    }
    return status;
}
