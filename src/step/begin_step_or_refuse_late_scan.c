/* SPDX-License-Identifier: MIT */
/*
 * begin_step_or_refuse_late_scan: begins a step of plots or of bearings: report, motion model,
 * out-of-sequence scans.
 */
#include <string.h>

#include "phases.h"
#include "rhotrack/detail/approx.h"

/* The white acceleration noise of tracks: half of accel_max_mps2, kept up for a second. */
#define ACCEL_SHARE 0.5f
#define ACCEL_TIME_S 1.0f

int rho_tracker_is_late(const struct rho_tracker *tracker, int64_t time_us)
{
    return tracker->has_time && time_us < tracker->time_us;
}

int rho_tracker_is_usable_time(int64_t time_us)
{
    return time_us <= RHO_LIMIT_TIME_US && time_us >= -RHO_LIMIT_TIME_US;
}

void rho_tracker_set_log_pd_of_step(struct step *step)
{
    float pd = step->sensor ? step->sensor->pd : step->tracker->config.pd;
    step->log_pd = rho_log(pd);
    step->log_miss = rho_log(1.0f - pd);
}

void rho_tracker_set_motion_model(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    float accel_mps2 = ACCEL_SHARE * tracker->config.accel_max_mps2;
    step->log_height = rho_log(RHO_CLUTTER_HEIGHT_M);
    step->log_rates = rho_log(2.0f * tracker->config.v_max_mps);
    step->log_range_rates = step->log_rates;
    step->model.speed_sigma_mps = tracker->config.v_max_mps;
    step->model.noise_density = accel_mps2 * accel_mps2 * ACCEL_TIME_S;
    if (rho_tracker_filter_of_config(&tracker->config) == RHO_TRACK_HYPOTHESES) {
        step->model.hypotheses = &tracker->hypotheses;
    } else if (tracker->config.input.is_estimated) {
        step->model.input = &tracker->config.input;
    }
}

/* Counts a scan that is too old for the tracker, and marks its inputs STALE. */
static void refuse_late_scan(struct step *step)
{
    memset(step->report->fates, RHO_FATE_STALE, step->num_gated);
    step->tracker->counters.scans_late = rho_count(step->tracker->counters.scans_late, 1);
}

int rho_tracker_begin_step_unless_late(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_report *report = step->report;
    step->num_gated = step->num_inputs < RHO_MAX_PLOTS ? step->num_inputs : RHO_MAX_PLOTS;
    memset(report, 0, sizeof *report);
    report->time_us = step->time_us;
    report->num_plots = step->num_inputs;
    rho_tracker_set_motion_model(step);
    step->is_late = rho_tracker_is_late(tracker, step->time_us);
    if (step->is_late && !(RHO_SECTORS && rho_tracker_accepts_late_scan(step))) {
        refuse_late_scan(step);
        return 0;
    }
    tracker->counters.scans_accepted = rho_count(tracker->counters.scans_accepted, 1);
    if (RHO_SECTORS && step->is_late) {
        rho_tracker_count_late_scan(step);
        return 1;
    }
    rho_tracker_reset_manoeuvre_interval_after_silence(tracker, step->time_us);
    tracker->time_us = step->time_us;
    tracker->has_time = 1;
    return 1;
}
