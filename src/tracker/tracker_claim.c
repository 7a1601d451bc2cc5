/* SPDX-License-Identifier: MIT */
/*
 * tracker_claim: existing tracks are predicted, gate the scan's plots, and are updated by those assigned to them.
 */
#include "rhotrack/approx.h"
#include "tracker_step.h"

/* The least area that clutter is spread over while few plots were seen. */
#define CLUTTER_SIDE_MIN_M 1000.0f

int32_t rho_tracker_mnat(float nat)
{
    float mnat = nat * 1000.0f;
    if (!(mnat > -(float)RHO_ASSIGNMENT_COST_MAX)) {
        return -RHO_ASSIGNMENT_COST_MAX;
    }
    return mnat < (float)RHO_ASSIGNMENT_COST_MAX ? (int32_t)mnat : RHO_ASSIGNMENT_COST_MAX;
}

/* ---- predict ---------------------------------------------------------------------------------- */

void rho_tracker_predict(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned i = 0; i < tracker->num_tracks; i++) {
        struct rho_track *track = &tracker->tracks[i];
        track->plot = -1;
        /* an estimate that time has made worthless cannot be carried on */
        if (rho_track_predict(track, step->time_us, &step->model) != RHO_OK) {
            rho_tracker_end_track(step, track, (enum rho_track_status)track->status);
        }
    }
}

/* ---- claim ------------------------------------------------------------------------------------ */

static float clutter_density(const struct step *step, float x_m, float y_m)
{
    const struct rho_tracker *tracker = step->tracker;
    if (step->initiator) {
        float density = rho_initiator_density(step->initiator, step->scan->sensor_id, x_m, y_m);
        if (density > 0.0f) {
            return density;
        }
    }
    float area_m2 = rho_extent_area_m2(&tracker->extent, CLUTTER_SIDE_MIN_M);
    return (tracker->unclaimed_plots > 1.0f ? tracker->unclaimed_plots : 1.0f) / area_m2;
}

/* ln of the plot's density as the track's, over its density as clutter, whose range rates are any that a target may
 * have. */
static float log_ratio(const struct step *step, const struct rho_gate_result *result,
                       float log_density)
{
    float dimensions = 2.0f;
    if (result->has_z) {
        log_density -= rho_log(RHO_CLUTTER_HEIGHT_M);
        dimensions += 1.0f;
    }
    if (result->has_range_rate) {
        log_density -= rho_log(2.0f * step->tracker->config.v_max_mps);
        dimensions += 1.0f;
    }
    return -0.5f * (dimensions * LOG_TWO_PI + result->log_det + result->distance2) - log_density;
}

void rho_tracker_offer(struct step *step, unsigned row, uint32_t column, float gain_nat)
{
    int32_t gain = rho_tracker_mnat(gain_nat);
    (void)!rho_assignment_add(&step->tracker->assignment, row, column, gain > 1 ? -gain : -1);
}

void rho_tracker_assign(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    rho_assignment_solve(&tracker->assignment);
    tracker->counters.gate_plots_dropped =
        rho_count(tracker->counters.gate_plots_dropped, tracker->assignment.pairs_dropped);
}

static void gate_plots(struct step *step, unsigned row)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_track *track = &tracker->tracks[row];
    struct rho_gate gate;
    struct rho_gate_result result;
    float log_density =
        rho_log(clutter_density(step, track->kalman.state[0], track->kalman.state[1]));
    rho_gate_open(&gate, &track->kalman, step->model.noise_density, step->sensor);
    for (uint32_t i = 0; i < step->num_gated; i++) {
        if (step->report->fates[i] == RHO_FATE_HELD &&
            rho_gate_test(&gate, &step->scan->plots[i], step->scan->measures, &result)) {
            rho_tracker_offer(step, row, i,
                              step->log_pd + log_ratio(step, &result, log_density) -
                                  step->log_miss);
        }
    }
}

void rho_tracker_claim(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    /* both counts are within the capacities: nothing to refuse */
    (void)!rho_assignment_begin(&tracker->assignment, tracker->num_tracks, step->num_gated);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        if (tracker->tracks[row].status != RHO_TRACK_FREE) {
            gate_plots(step, row);
        }
    }
    rho_tracker_assign(step);
}

/* ---- update ----------------------------------------------------------------------------------- */

static int32_t gain_of(const struct step *step, const struct rho_track *track, uint32_t plot)
{
    struct rho_gate gate;
    struct rho_gate_result result;
    rho_gate_open(&gate, &track->kalman, step->model.noise_density, step->sensor);
    if (!rho_gate_test(&gate, &step->scan->plots[plot], step->scan->measures, &result)) {
        return 0;
    }
    float density = clutter_density(step, track->kalman.state[0], track->kalman.state[1]);
    return rho_tracker_mnat(step->log_pd + log_ratio(step, &result, rho_log(density)));
}

static struct rho_track_plot plot_of(const struct step *step, int row)
{
    const struct rho_plot *plot = &step->scan->plots[row];
    return (struct rho_track_plot){
        .time_us = step->scan->time_us + plot->offset_us,
        .measures = step->scan->measures,
        .sensor_id = step->scan->sensor_id,
        .sensor = step->sensor,
        .plot = *plot,
        .row = (int16_t)row,
    };
}

void rho_tracker_update(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        struct rho_track *track = &tracker->tracks[row];
        int plot = rho_assignment_column(&tracker->assignment, row);
        if (plot == RHO_ASSIGNMENT_NONE) {
            continue;
        }
        int32_t gain = gain_of(step, track, (uint32_t)plot);
        struct rho_track_plot seen = plot_of(step, plot);
        if (rho_track_update(track, &seen, &step->model, gain) == RHO_OK) {
            step->report->fates[plot] = RHO_FATE_CLAIMED;
        } else {
            tracker->counters.updates_refused = rho_count(tracker->counters.updates_refused, 1);
        }
    }
}
