/* SPDX-License-Identifier: MIT */
/*
 * step: rho_tracker_step, which takes one scan of plots through the six phases.
 */
#include "phases.h"
#include "rhotrack/detail/angle.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

static enum rho_status check_step_inputs(const struct rho_tracker *tracker,
                                         const struct rho_initiator *initiator,
                                         const struct rho_scan *scan,
                                         const struct rho_report *report)
{
    if (!tracker || !scan || !report || (scan->num_plots && !scan->plots)) {
        return RHO_ERROR_NULL;
    }
    if (!rho_tracker_is_ready(tracker)) {
        return RHO_ERROR_STATE;
    }
    if (!RHO_SEARCHES && initiator) {
        return RHO_ERROR_CONFIG;
    }
    if (!rho_angle_are_sector_ends_valid(scan->sector_from_rad, scan->sector_to_rad) ||
        !rho_tracker_is_usable_time(scan->time_us)) {
        return RHO_ERROR_VALUE;
    }
    /* the time of a late scan need not fit: the largest time tests that the initiator is ready */
    return !initiator ||
                   rho_initiator_accepts(initiator, rho_tracker_is_late(tracker, scan->time_us)
                                                        ? RHO_LIMIT_TIME_US
                                                        : scan->time_us)
               ? RHO_OK
               : RHO_ERROR_STATE;
}

/* Sets the step's sensor with its pd, notch and noise, and notes the scan in its history. */
static void apply_sensor_to_step(struct rho_tracker *tracker, struct rho_look *look)
{
    look->row = rho_tracker_hear_sensor(tracker, look->scan->sensor_id);
    if (look->row && look->row < &tracker->sensors[tracker->num_sensors]) {
        look->sensor = &look->row->sensor;
        look->learned = &look->row->learned;
    }
    rho_tracker_set_log_pd_of_step(look);
    if (RHO_SECTORS) {
        rho_tracker_record_look_and_antenna_turning(tracker, look);
    }
    if (!look->is_late && look->row) {
        rho_tracker_update_scan_interval(&look->row->pace, look->sensor, look->time_us,
                                         look->scan->sector_from_rad, look->scan->sector_to_rad);
    }
    if (RHO_DOPPLER_NOTCH) {
        rho_tracker_apply_learned_notch(look);
    }
    rho_tracker_apply_learned_noise(
        look, RHO_SECTORS ? rho_tracker_update_suspect_and_sigma_factor(tracker, look) : 1.0f);
    look->log_range_rates -=
        rho_measurement_log_num_aliases(look->sensor, tracker->config.v_max_mps);
    look->range_rates_mps = rho_exp(look->log_range_rates);
}

/*
 * An out-of-sequence scan may start tracks where it is the newest one of its initiator: a radar
 * that is always late has an initiator of its own.
 */
static int may_start_tracks(const struct rho_look *look)
{
    return !look->is_late ||
           (look->initiator && rho_initiator_accepts(look->initiator, look->time_us));
}

enum rho_status rho_tracker_step(struct rho_tracker *tracker, struct rho_initiator *initiator,
                                 const struct rho_scan *scan, struct rho_report *report)
{
    enum rho_status status = check_step_inputs(tracker, initiator, scan, report);
    if (status != RHO_OK) {
        return status;
    }
    struct step step = {.tracker = tracker,
                        .report = report,
                        .look = {.tracker = tracker,
                                 .initiator = initiator,
                                 .scan = scan,
                                 .fates = report->fates,
                                 .time_us = scan->time_us,
                                 .num_inputs = scan->num_plots}};
    if (rho_tracker_begin_step_unless_late(&step)) {
        apply_sensor_to_step(tracker, &step.look);
        rho_tracker_predict(&step);
        if (rho_notch_sensor_has_notch(step.look.sensor)) {
            rho_tracker_set_notch_blind_percents(&step);
        }
        struct rho_scan grouped;
        if (rho_tracker_has_bodies(tracker)) {
            rho_tracker_group_plots(&step, &grouped);
        }
        if (RHO_CLAIMS_BEYOND && step.look.num_inputs > RHO_MAX_PLOTS) {
            rho_tracker_claim_and_update_in_plot_parts(
                &step); /* claims and updates, part by part */
        } else {
            rho_tracker_claim(tracker, &step.look, &step.work);
            rho_tracker_update(tracker, &step.look, &step.work);
        }
        rho_tracker_age(&step);
        if (rho_notch_sensor_has_notch(step.look.sensor)) {
            rho_tracker_clear_blind_percents(tracker);
        }
        const int has_images = RHO_MAX_REFLECTORS > 0 && tracker->num_reflectors > 0;
        if (has_images) {
            rho_tracker_mark_image_plots_as_ghosts(&step.look, &step.work);
        }
        if (RHO_MAX_EXCLUDED_AREAS > 0 && tracker->num_excluded > 0) {
            rho_tracker_mark_excluded_plots_as_ghosts(tracker, &step.look, &step.work);
        }
        if (may_start_tracks(&step.look)) {
            rho_tracker_initiate(&step);
        } else if (RHO_SECTORS) {
            rho_tracker_mark_unused_late_plots_stale(&step.look);
        }
        if (has_images && !step.look.is_late) {
            rho_tracker_end_image_tracks(&step);
        }
        if (RHO_SECTORS && step.look.is_late) {
            rho_tracker_return_tracks_to_newest_time(&step);
        } else {
            rho_tracker_merge_estimates_per_track(tracker, &step.look);
        }
        if (rho_tracker_has_bodies(tracker)) {
            rho_tracker_update_bodies(tracker, &step.look, scan);
            rho_tracker_split_tracks_of_two_targets(&step, scan);
            rho_tracker_ungroup_plots(tracker, &step.look, scan);
        }
        rho_tracker_record_work(&step);
    }
    rho_tracker_report(&step);
    return RHO_OK;
}
