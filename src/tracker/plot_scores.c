/* SPDX-License-Identifier: MIT */
/* plot_scores: likelihood ratios of plots against clutter, and the pairs of the assignment. */
#include "clutter.h"
#include "plots.h"
#include "rhotrack/detail/approx.h"
#include "rhotrack/detail/measurement.h"

void rho_score_open_gate(const struct rho_look *look, const struct rho_track *track,
                         uint32_t measures, struct rho_gate *gate)
{
    struct rho_kalman expected;
    rho_track_estimate_for_gate(track, &expected);
    rho_gate_open(gate, &expected, rho_track_noise_density(track, &look->model), look->sensor,
                  measures);
}

void rho_score_add_pair(struct rho_tracker *tracker, unsigned row, uint32_t column, float gain_nat)
{
    int32_t gain = rho_score_to_mnat(gain_nat);
    (void)!rho_assignment_offer_pair(&tracker->assignment, row, column, gain > 1 ? -gain : -1);
}

int rho_score_pair_gain(const struct rho_look *look, unsigned row, int column, float *gain_nat)
{
    const struct rho_assignment *assignment = &look->tracker->assignment;
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        if (assignment->pairs[row][i].column == column) {
            *gain_nat = rho_look_detection(look, &look->tracker->tracks[row]).log_miss -
                        0.001f * (float)assignment->pairs[row][i].cost;
            return 1;
        }
    }
    return 0;
}

void rho_score_remove_row(struct rho_tracker *tracker, unsigned row)
{
    struct rho_assignment *assignment = &tracker->assignment;
    for (unsigned from = row + 1u; from < assignment->num_rows; from++) {
        rho_assignment_move_pairs(assignment, from, from - 1u);
    }
    if (row < assignment->num_rows) {
        assignment->num_rows--;
    }
}

void rho_score_solve(struct rho_tracker *tracker)
{
    rho_assignment_solve(&tracker->assignment);
    tracker->counters.gate_plots_dropped =
        rho_count(tracker->counters.gate_plots_dropped, tracker->assignment.pairs_dropped);
}

float rho_score_plot(const struct rho_look *look, const struct rho_track *track,
                     const struct rho_gate_result *result, float log_density, uint32_t row)
{
    /* clutter is uniform in height and in all range rates that a target may have */
    float log_clutter = rho_clutter_log_at_plot(look, log_density, row), dimensions = 2.0f;
    if (result->has_z) {
        log_clutter -= look->log_height;
        dimensions += 1.0f;
    }
    if (result->has_range_rate) {
        log_clutter -= look->log_range_rates;
        dimensions += 1.0f;
    }
    const float log_ratio =
        -0.5f * (dimensions * RHO_LOG_TWO_PI + result->log_det + result->distance2) - log_clutter;
    return rho_look_detection(look, track).log_pd + log_ratio;
}

float rho_score_log_miss(const struct rho_look *look, const struct rho_track *track)
{
    return rho_look_may_miss(look, track) ? rho_look_detection(look, track).log_miss : 0.0f;
}

struct rho_track_plot rho_score_track_plot(const struct rho_look *look, int plot_row)
{
    const struct rho_plot *plot = &look->scan->plots[plot_row];
    return (struct rho_track_plot){
        .time_us = look->scan->time_us + plot->offset_us,
        .measures = look->scan->measures,
        .sensor_id = look->scan->sensor_id,
        .sensor = look->sensor,
        .plot = *plot,
        .row = (int16_t)plot_row,
    };
}

/*
 * True where a plot is in the gate box of the track's hypotheses for its own noise, and is not
 * assigned to another track. The limits for any noise are tested first, as most plots fail
 * there, unless each box of the plot index holds one plot, so that the box has decided on it.
 */
static int is_unassigned_and_near(const struct rho_look *look, struct plot_scores *scores,
                                  uint32_t i)
{
    const struct rho_tracker *tracker = look->tracker;
    const struct rho_plot *plot = &look->scan->plots[i];
    const int owner = tracker->assignment.column_row[i];
    return ((RHO_PLOT_STRIPS <= 1 && look->plots_of_box == 1u) ||
            rho_plots_is_within(&scores->near, plot)) &&
           look->fates[i] == RHO_FATE_HELD && !(owner >= 0 && owner != (int)scores->track_row) &&
           rho_hypotheses_is_in_box(&tracker->hypotheses, tracker->tracks[scores->track_row].slot,
                                    &scores->box, plot, look->scan->measures);
}

void rho_score_begin(struct rho_tracker *tracker, const struct rho_look *look,
                     struct rho_work *work, unsigned row, struct plot_scores *scores)
{
    const struct rho_track *track = &tracker->tracks[row];
    scores->track_row = row;
    scores->log_pd = rho_look_detection(look, track).log_pd;
    scores->clutter = (struct rho_hypotheses_clutter){
        .log_per_m2 = rho_clutter_log_at_track(look, track),
        .log_per_m = -look->log_height,
        .log_per_mps = -look->log_rates,
        .log_per_range_rate = -look->log_range_rates,
    };
    rho_hypotheses_gate_box(&tracker->hypotheses, track->slot, &scores->box);
    scores->box.sigma_factor = rho_measurement_factor_max(look->sensor);
    /* widened by the largest noise and time offset, so that it holds every gate of a hypothesis */
    const float slack_m = rho_hypotheses_box_margin_m(
        &tracker->hypotheses, track->slot, &scores->box, look->sigma_max_m, look->offset_max_s);
    scores->near =
        rho_plots_near(tracker, scores->box.x_min_m - slack_m, scores->box.x_max_m + slack_m,
                       scores->box.y_min_m - slack_m, scores->box.y_max_m + slack_m);
    struct plots_near counted = scores->near;
    scores->choice = rho_work_begin_choice(look, work, track);
    for (uint32_t i; scores->choice.most < rho_plots_max_near(look, &scores->near) &&
                     rho_plots_next(look, &counted, &i);) {
        if (is_unassigned_and_near(look, scores, i)) {
            rho_work_count_plot(&scores->choice, track, &look->scan->plots[i]);
        }
    }
    rho_work_limit_choice(work, &scores->choice);
}

int rho_score_next(struct rho_tracker *tracker, const struct rho_look *look, struct rho_work *work,
                   struct plot_scores *scores, uint32_t *plot, float *gain_nat)
{
    const struct rho_track *track = &tracker->tracks[scores->track_row];
    struct rho_imm_plot seen;
    while (rho_plots_next(look, &scores->near, plot)) {
        const struct rho_plot *at = &look->scan->plots[*plot];
        if (!is_unassigned_and_near(look, scores, *plot) ||
            !rho_work_take_plot(work, &scores->choice, track, at)) {
            continue;
        }
        rho_imm_prepare_plot(&seen, at, look->scan->measures, look->sensor);
        struct rho_hypotheses_clutter clutter = scores->clutter;
        clutter.log_per_m2 = rho_clutter_log_at_plot(look, clutter.log_per_m2, *plot);
        if (rho_hypotheses_score_plot(&tracker->hypotheses, track->slot, &seen,
                                      look->time_us + at->offset_us, (int16_t)*plot, scores->log_pd,
                                      &clutter, gain_nat)) {
            return 1;
        }
    }
    return 0;
}
