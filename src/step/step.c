/* SPDX-License-Identifier: MIT */
/*
 * step: a scan of plots goes through the phases of a step, as one look; a scan beyond RHO_MAX_PLOTS
 * as several. bearing_step.c does the same with bearings: a build that takes none has nothing of
 * it.
 */
#include "phases.h"
#include "rhotrack/detail/angle.h"

static enum rho_status check_scan(const struct rho_tracker *tracker,
                                  const struct rho_initiator *initiator,
                                  const struct rho_scan *scan, const struct rho_report *report)
{
    const enum rho_status status =
        rho_tracker_check(tracker, scan && report && (scan->num_plots == 0 || scan->plots));
    if (status != RHO_OK) {
        return status;
    }
    if (!RHO_SEARCHES && initiator) {
        return RHO_ERROR_CONFIG;
    }
    if (!rho_angle_is_valid_sector(scan->sector_from_rad, scan->sector_to_rad) ||
        !rho_step_is_usable_time(scan->time_us)) {
        return RHO_ERROR_VALUE;
    }
    /* a time before the newest step need not fit: the largest time tests that it is ready */
    return !initiator || rho_initiator_accepts(initiator, rho_step_is_newest(tracker, scan->time_us)
                                                              ? scan->time_us
                                                              : RHO_LIMIT_TIME_US)
               ? RHO_OK
               : RHO_ERROR_STATE;
}

enum rho_status rho_tracker_step(struct rho_tracker *tracker, struct rho_initiator *initiator,
                                 const struct rho_scan *scan, struct rho_report *report)
{
    const enum rho_status status = check_scan(tracker, initiator, scan, report);
    if (status == RHO_OK) {
        struct rho_scan grouped;
        struct step step = {.tracker = tracker,
                            .report = report,
                            .grouped = RHO_BODIES ? &grouped : 0,
                            .look = {.tracker = tracker,
                                     .initiator = initiator,
                                     .scan = scan,
                                     .fates = report->fates,
                                     .time_us = scan->time_us,
                                     .num_inputs = scan->num_plots}};
        if (rho_step_begin(&step)) {
            rho_step_open_scan(tracker, &step.look);
            rho_step_predict(&step);
            rho_step_take_scan(&step);
            rho_step_age(&step);
            rho_step_initiate(&step);
            rho_step_settle(&step);
            rho_work_record(tracker, &step.work, report);
        }
        rho_step_report(&step);
    }
    return status;
}
