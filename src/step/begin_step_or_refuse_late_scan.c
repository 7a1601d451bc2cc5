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

void rho_tracker_set_log_pd_of_step(struct rho_look *look)
{
    float pd = look->sensor ? look->sensor->pd : look->tracker->config.pd;
    look->log_pd = rho_log(pd);
    look->log_miss = rho_log(1.0f - pd);
}

void rho_tracker_set_motion_model(struct rho_tracker *tracker, struct rho_look *look)
{
    float accel_mps2 = ACCEL_SHARE * tracker->config.accel_max_mps2;
    look->log_height = rho_log(RHO_CLUTTER_HEIGHT_M);
    look->log_rates = rho_log(2.0f * tracker->config.v_max_mps);
    look->log_range_rates = look->log_rates;
    look->model.speed_sigma_mps = tracker->config.v_max_mps;
    look->model.noise_density = accel_mps2 * accel_mps2 * ACCEL_TIME_S;
    if (rho_tracker_filter_of_config(&tracker->config) == RHO_TRACK_HYPOTHESES) {
        look->model.hypotheses = &tracker->hypotheses;
    } else if (tracker->config.input.is_estimated) {
        look->model.input = &tracker->config.input;
    }
}

/* Counts a scan that is too old for the tracker, and marks its inputs STALE. */
static void refuse_late_scan(struct rho_tracker *tracker, const struct rho_look *look)
{
    memset(look->fates, RHO_FATE_STALE, look->num_gated);
    tracker->counters.scans_late = rho_count(tracker->counters.scans_late, 1);
}

int rho_tracker_begin_step_unless_late(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_report *report = step->report;
    step->look.num_gated =
        step->look.num_inputs < RHO_MAX_PLOTS ? step->look.num_inputs : RHO_MAX_PLOTS;
    memset(report, 0, sizeof *report);
    report->time_us = step->look.time_us;
    report->num_plots = step->look.num_inputs;
    rho_tracker_set_motion_model(tracker, &step->look);
    step->look.is_late = rho_tracker_is_late(tracker, step->look.time_us);
    if (step->look.is_late && !(RHO_SECTORS && rho_tracker_accepts_late_scan(&step->look))) {
        refuse_late_scan(tracker, &step->look);
        return 0;
    }
    tracker->counters.scans_accepted = rho_count(tracker->counters.scans_accepted, 1);
    if (RHO_SECTORS && step->look.is_late) {
        rho_tracker_count_late_scan(tracker);
        return 1;
    }
    rho_tracker_reset_manoeuvre_interval_after_silence(tracker, step->look.time_us);
    tracker->time_us = step->look.time_us;
    tracker->has_time = 1;
    return 1;
}
