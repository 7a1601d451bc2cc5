/* SPDX-License-Identifier: MIT */
/* claim: gates the scan's plots and assigns them to tracks: at most one plot to each track. */
#include <string.h>

#include "phases.h"
#include "policy.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

/*
 * A plot's gain falls with the log of its Hough residual: ratios compare plots of several tracks.
 * By differences, a plot that fits no track could displace one that fits.
 */
static float gain_by_hough_residual(const struct rho_look *look, const struct rho_track *track,
                                    const struct rho_gate_hough *hough, const struct rho_plot *plot)
{
    const float measured_mps[3] = {plot->vx_mps, plot->vy_mps, plot->vz_mps};
    const float place_m[3] = {plot->x_m, plot->y_m, plot->z_m};
    const float dt_s = rho_seconds_between(track->updated_us, look->time_us + plot->offset_us);
    const int num_axes = look->scan->measures & RHO_MEASURES_Z ? 3 : 2;
    float velocity_mps[3];
    memcpy(velocity_mps, track->newest_mps, sizeof velocity_mps);
    /* the measured velocity, or the one that leads from the last update to the plot */
    for (int axis = 0; axis < num_axes; axis++) {
        if (look->scan->measures & RHO_MEASURES_VELOCITY) {
            velocity_mps[axis] = measured_mps[axis];
        } else if (dt_s > 0.0f) {
            /* the newest velocity leads to the prediction; add the plot's offset from there */
            velocity_mps[axis] += (place_m[axis] - track->kalman.state[axis]) / dt_s;
        }
    }
    /* the offset 16 makes any plot better than a miss; 1 mm/s keeps the logarithm finite */
    return (track->status == RHO_TRACK_TENTATIVE ? 1.0f : HOUGH_CONFIRMED_NAT) *
           (16.0f - rho_log(0.001f + rho_gate_hough_distance_mps(hough, velocity_mps)));
}

static int is_held_plot_in_box(const struct rho_look *look, const struct rho_gate *gate,
                               const float half_m[2], uint32_t i)
{
    const float dx_m = look->scan->plots[i].x_m - gate->predicted.state[0];
    const float dy_m = look->scan->plots[i].y_m - gate->predicted.state[1];
    return dx_m <= half_m[0] && dx_m >= -half_m[0] && dy_m <= half_m[1] && dy_m >= -half_m[1] &&
           look->fates[i] == RHO_FATE_HELD;
}

static void offer_gated_plots(struct rho_tracker *tracker, const struct rho_look *look,
                              struct rho_work *work, unsigned row)
{
    const struct rho_tracker_config *config = &tracker->config;
    const struct rho_track *track = &tracker->tracks[row];
    struct rho_gate gate;
    struct rho_gate_hough hough;
    struct rho_gate_result result;
    float half_m[2];
    const float log_miss = rho_look_detection(look, track).log_miss;
    const float log_density = rho_clutter_log_at_track(look, track);
    /* the Hough gate is of the last two estimates' velocities, from the fourth plot on (paper) */
    const int by_hough =
        RHO_HAS_FILTER(RHO_TRACK_INPUT) && config->gate == RHO_TRACKER_HOUGH &&
        track->num_velocities >= 3 &&
        rho_gate_hough_init(
            &hough, rho_kalman_has_axis(&track->kalman, 2) ? config->planes : RHO_GATE_PLANE_XY,
            config->theta_cell_rad, track->before_mps, track->newest_mps) == RHO_OK;
    const int has_window = by_hough && (look->scan->measures & RHO_MEASURES_VELOCITY);
    rho_score_open_gate(look, track, look->scan->measures, &gate);
    rho_gate_box(&gate, look->sigma_max_m, look->offset_max_s, half_m);
    /*
     * Where a manoeuvre begins, the target's plot lies outside the chi-square gate, as input
     * estimation notices an input at the second plot only: the box widens to the Hough gate's
     * window. By positions alone a far plot would fit as well as a near one.
     */
    const float dt_s = rho_seconds_between(track->updated_us, look->time_us);
    for (int axis = 0; axis < 2 && has_window; axis++) {
        half_m[axis] = config->hough_window_m > 0.0f
                           ? rho_larger(half_m[axis], config->hough_window_m)
                           : half_m[axis] + 2.0f * config->accel_max_mps2 * dt_s * dt_s;
    }
    struct plots_near near = rho_plots_near(
        tracker, gate.predicted.state[0] - half_m[0], gate.predicted.state[0] + half_m[0],
        gate.predicted.state[1] - half_m[1], gate.predicted.state[1] + half_m[1]);
    struct plots_near counted = near;
    struct plot_choice choice = rho_work_begin_choice(look, work, track);
    for (uint32_t i;
         choice.most < rho_plots_max_near(look, &near) && rho_plots_next(look, &counted, &i);) {
        if (is_held_plot_in_box(look, &gate, half_m, i)) {
            rho_work_count_plot(&choice, track, &look->scan->plots[i]);
        }
    }
    rho_work_limit_choice(work, &choice);
    for (uint32_t i; rho_plots_next(look, &near, &i);) {
        const struct rho_plot *plot = &look->scan->plots[i];
        if (is_held_plot_in_box(look, &gate, half_m, i) &&
            rho_work_take_plot(work, &choice, track, plot) &&
            (has_window || rho_gate_test(&gate, plot, &result))) {
            rho_score_add_pair(tracker, row, i,
                               by_hough ? gain_by_hough_residual(look, track, &hough, plot)
                                        : rho_score_plot(look, track, &result, log_density, i) -
                                              log_miss);
        }
    }
}

/* Sets each plot's fate: INVALID where it is malformed or outside of the coverage, else HELD. */
static void validate_plots(struct rho_tracker *tracker, struct rho_look *look)
{
    const uint32_t measures = look->scan->measures;
    const float factor = rho_measurement_factor_max(look->sensor);
    for (uint32_t i = 0; i < look->num_gated; i++) {
        const struct rho_plot *plot = &look->scan->plots[i];
        const float offset_s = (float)plot->offset_us * 1e-6f;
        look->fates[i] = RHO_FATE_INVALID;
        if (!rho_measurement_is_valid_plot(plot, measures)) {
            continue;
        }
        if (!rho_coverage_holds_plot(look->sensor, plot, measures)) {
            tracker->counters.plots_outside = rho_count(tracker->counters.plots_outside, 1);
            continue;
        }
        look->fates[i] = RHO_FATE_HELD;
        rho_extent_add(&tracker->extent, plot->x_m, plot->y_m);
        /* bounds by which gates size their search boxes */
        look->sigma_max_m = rho_larger(look->sigma_max_m, factor * rho_plot_sigma_m(plot));
        look->offset_max_s = rho_larger(look->offset_max_s, rho_magnitude(offset_s));
        if (measures & RHO_MEASURES_Z) {
            look->sigma_max_m = rho_larger(look->sigma_max_m, factor * plot->sigma_up_m);
        }
    }
}

void rho_step_claim(struct rho_tracker *tracker, struct rho_look *look, struct rho_work *work)
{
    validate_plots(tracker, look);
    rho_plots_index(tracker, look);
    rho_clutter_open(tracker, look, work);
    /* both counts are within the capacities: nothing to refuse */
    (void)!rho_assignment_begin(&tracker->assignment, tracker->num_tracks, look->num_gated);
    rho_work_begin_shares(look, work);
    for (unsigned row = 0; row < tracker->num_tracks; row++) {
        const struct rho_track *track = &tracker->tracks[row];
        if (track->status == RHO_TRACK_FREE || !rho_look_has_in_view(look, row)) {
            continue;
        }
        if (RHO_TRACK_IS_BY(track, RHO_TRACK_HYPOTHESES)) {
            const float log_miss = rho_score_log_miss(look, track);
            struct plot_scores scores;
            uint32_t plot;
            float gain_nat;
            rho_score_begin(tracker, look, work, row, &scores);
            while (rho_score_next(tracker, look, work, &scores, &plot, &gain_nat)) {
                if (gain_nat > log_miss) {
                    rho_score_add_pair(tracker, row, plot, gain_nat - log_miss);
                }
            }
        } else {
            offer_gated_plots(tracker, look, work, row);
        }
    }
    rho_score_solve(tracker);
}
