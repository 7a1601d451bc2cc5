/* SPDX-License-Identifier: MIT */
/* begin: begins a step: report, motion model and order of time. */
#include <string.h>

#include "phases.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"

int rho_step_is_newest(const struct rho_tracker *tracker, int64_t time_us)
{
    return !tracker->has_time || time_us >= tracker->time_us;
}

int rho_step_is_usable_time(int64_t time_us)
{
    return time_us <= RHO_LIMIT_TIME_US && time_us >= -RHO_LIMIT_TIME_US;
}

void rho_step_set_model(struct rho_tracker *tracker, struct rho_look *look)
{
    const float accel_mps2 = STEADY_SHARE * tracker->config.accel_max_mps2;
    look->log_height = rho_log(RHO_CLUTTER_HEIGHT_M);
    look->log_rates = rho_log(2.0f * tracker->config.v_max_mps);
    look->log_range_rates = look->log_rates;
    look->model.speed_sigma_mps = tracker->config.v_max_mps;
    look->model.noise_density = accel_mps2 * accel_mps2;
    if (rho_tracker_filter(&tracker->config) == RHO_TRACK_HYPOTHESES) {
        look->model.hypotheses = &tracker->hypotheses;
    } else if (tracker->config.input.is_estimated) {
        look->model.input = &tracker->config.input;
    }
}

int rho_step_begin(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    struct rho_report *report = step->report;
    struct rho_look *look = &step->look;
    look->num_gated = look->num_inputs < RHO_MAX_PLOTS ? look->num_inputs : RHO_MAX_PLOTS;
    memset(report, 0, sizeof *report);
    report->time_us = look->time_us;
    report->num_plots = look->num_inputs;
    rho_step_set_model(tracker, look);
    /*
     * An out-of-sequence scan teaches nothing, and may start tracks where it is the newest one of
     * its initiator: a radar that is always late has an initiator of its own.
     */
    look->teaches = (uint8_t)rho_step_is_newest(tracker, look->time_us);
    look->starts = look->teaches || (RHO_SECTORS && look->initiator &&
                                     rho_initiator_accepts(look->initiator, look->time_us));
    if (!look->teaches && !(RHO_SECTORS && rho_retrodiction_accepts(look))) {
        memset(look->fates, RHO_FATE_STALE, look->num_gated);
        tracker->counters.scans_late = rho_count(tracker->counters.scans_late, 1);
        return 0;
    }
    tracker->counters.scans_accepted = rho_count(tracker->counters.scans_accepted, 1);
    if (RHO_SECTORS && !look->teaches) {
        tracker->counters.scans_retrodicted = rho_count(tracker->counters.scans_retrodicted, 1);
    } else {
        rho_manoeuvres_reset(tracker, look->time_us);
        tracker->time_us = look->time_us;
        tracker->has_time = 1;
    }
    return 1;
}
