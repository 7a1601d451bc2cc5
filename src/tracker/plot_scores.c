/* SPDX-License-Identifier: MIT */
/*
 * plot_scores: log-likelihood ratio of a plot, a track's against clutter; and the pairs of a track
 * and a plot or bearing that enter the assignment.
 */
#include "rhotrack/detail/measurement.h"
#include "step.h"

/* ---- offers ---------------------------------------------------------------------------------- */

int32_t rho_tracker_nat_to_mnat(float nat)
{
    float mnat = nat * 1000.0f;
    if (!(mnat > -(float)RHO_ASSIGNMENT_COST_MAX)) {
        return -RHO_ASSIGNMENT_COST_MAX;
    }
    return mnat < (float)RHO_ASSIGNMENT_COST_MAX ? (int32_t)mnat : RHO_ASSIGNMENT_COST_MAX;
}

void rho_tracker_open_track_gate(const struct step *step, const struct rho_track *track,
                                 uint32_t measures, struct rho_gate *gate)
{
    struct rho_kalman expected;
    rho_track_estimate_for_gate(track, &expected);
    rho_gate_open(gate, &expected,
                  RHO_TRACK_IS_BY(track, RHO_TRACK_INPUT) ? step->model.input->noise_density
                                                          : step->model.noise_density,
                  step->sensor, measures);
}

void rho_tracker_add_assignment_pair(struct step *step, unsigned row, uint32_t column,
                                     float gain_nat)
{
    int32_t gain = rho_tracker_nat_to_mnat(gain_nat);
    (void)!rho_assignment_offer_pair(&step->tracker->assignment, row, column,
                                     gain > 1 ? -gain : -1);
}

int rho_tracker_find_pair_gain(const struct step *step, unsigned row, int column, float *gain_nat)
{
    const struct rho_assignment *assignment = &step->tracker->assignment;
    for (unsigned i = 0; i < assignment->num_pairs[row]; i++) {
        if (assignment->pairs[row][i].column == column) {
            *gain_nat = rho_tracker_log_pd_and_log_miss_of_track(step, &step->tracker->tracks[row])
                            .log_miss -
                        0.001f * (float)assignment->pairs[row][i].cost;
            return 1;
        }
    }
    return 0;
}

void rho_tracker_solve_assignment(struct step *step)
{
    struct rho_tracker *tracker = step->tracker;
    rho_assignment_solve(&tracker->assignment);
    tracker->counters.gate_plots_dropped =
        rho_count(tracker->counters.gate_plots_dropped, tracker->assignment.pairs_dropped);
}

/* ---- scores ---------------------------------------------------------------------------------- */

/*
 * ln of the density of a gated plot by the track, over that by clutter, which is uniform in height
 * and in all range rates that a target may have.
 */
static float log_likelihood_ratio(const struct step *step, const struct rho_gate_result *result,
                                  float log_density)
{
    float dimensions = 2.0f;
    if (result->has_z) {
        log_density -= step->log_height;
        dimensions += 1.0f;
    }
    if (result->has_range_rate) {
        log_density -= step->log_range_rates;
        dimensions += 1.0f;
    }
    return -0.5f * (dimensions * LOG_TWO_PI + result->log_det + result->distance2) - log_density;
}

static float log_echo_density_ratio(const struct step *step, uint32_t plot_row)
{
    return RHO_MAX_ECHOES > 0 ? rho_tracker_log_echo_over_background_density(step, plot_row) : 0.0f;
}

float rho_tracker_score_plot(const struct step *step, const struct rho_track *track,
                             const struct rho_gate_result *result, float log_density, uint32_t row)
{
    return rho_tracker_log_pd_and_log_miss_of_track(step, track).log_pd +
           log_likelihood_ratio(step, result, log_density + log_echo_density_ratio(step, row));
}

float rho_tracker_log_miss_probability(const struct step *step, const struct rho_track *track)
{
    return rho_tracker_may_count_miss(step, track)
               ? rho_tracker_log_pd_and_log_miss_of_track(step, track).log_miss
               : 0.0f;
}

struct rho_track_plot rho_tracker_make_track_plot(const struct step *step, int plot_row)
{
    const struct rho_plot *plot = &step->scan->plots[plot_row];
    return (struct rho_track_plot){
        .time_us = step->scan->time_us + plot->offset_us,
        .measures = step->scan->measures,
        .sensor_id = step->scan->sensor_id,
        .sensor = step->sensor,
        .plot = *plot,
        .row = (int16_t)plot_row,
    };
}

/* ---- hypotheses ------------------------------------------------------------------------------ */

/*
 * Plots in the box of a track's hypotheses, widened by the largest noise and time offset of the
 * scan's plots, so that it holds every plot in the gate of a hypothesis.
 */
static struct plots_near plots_near_track(const struct step *step, const struct rho_track *track,
                                          struct rho_hypotheses_box *box)
{
    const float slack_m = rho_hypotheses_box_margin_m(&step->tracker->hypotheses, track->slot, box,
                                                      step->sigma_max_m, step->offset_max_s);
    return rho_tracker_plots_near(step, box->x_min_m - slack_m, box->x_max_m + slack_m,
                                  box->y_min_m - slack_m, box->y_max_m + slack_m);
}

/* True where each box of the plot index holds one plot, so that the box decides on the plot. */
static int is_one_plot_per_index_box(const struct step *step)
{
    return RHO_PLOT_STRIPS <= 1 && step->plots_of_box == 1u;
}

/*
 * True where a plot is in the gate box of the track's hypotheses for its own noise, and is not
 * assigned to another track. The limits for any noise are tested first: most plots fail there.
 */
static int is_unassigned_and_near(const struct step *step, struct plot_scores *scores, uint32_t i)
{
    const struct rho_tracker *tracker = step->tracker;
    const struct rho_plot *plot = &step->scan->plots[i];
    const int owner = tracker->assignment.column_row[i];
    return (is_one_plot_per_index_box(step) || rho_tracker_is_plot_within(&scores->near, plot)) &&
           step->report->fates[i] == RHO_FATE_HELD &&
           !(owner >= 0 && owner != (int)scores->track_row) &&
           rho_hypotheses_is_in_box(&tracker->hypotheses, tracker->tracks[scores->track_row].slot,
                                    &scores->box, plot, step->scan->measures);
}

static void choose_plots_to_score(struct step *step, const struct rho_track *track,
                                  struct plot_scores *scores)
{
    struct plots_near counted = scores->near;
    scores->choice = rho_tracker_begin_choice_of_plots_to_score(step, track);
    for (uint32_t i; scores->choice.most < rho_tracker_max_num_plots_near(step, &scores->near) &&
                     rho_tracker_next_plot_near(step, &counted, &i);) {
        if (is_unassigned_and_near(step, scores, i)) {
            rho_tracker_count_plot_in_distance_octave(&scores->choice, track,
                                                      &step->scan->plots[i]);
        }
    }
    rho_tracker_limit_choice_to_nearest_plots(step, &scores->choice);
}

void rho_tracker_begin_plot_scores(struct step *step, unsigned row, struct plot_scores *scores)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_track *track = &tracker->tracks[row];
    scores->track_row = row;
    scores->log_pd = rho_tracker_log_pd_and_log_miss_of_track(step, track).log_pd;
    scores->clutter = (struct rho_hypotheses_clutter){
        .log_per_m2 = rho_tracker_log_clutter_density_at_track(step, track),
        .log_per_m = -step->log_height,
        .log_per_mps = -step->log_rates,
        .log_per_range_rate = -step->log_range_rates,
    };
    rho_hypotheses_clear_candidates_get_gate_box(&tracker->hypotheses, track->slot, &scores->box);
    scores->box.sigma_factor = rho_measurement_sigma_factor_at_least_one(step->sensor);
    scores->near = plots_near_track(step, track, &scores->box);
    choose_plots_to_score(step, track, scores);
}

int rho_tracker_next_plot_score(struct step *step, struct plot_scores *scores, uint32_t *plot,
                                float *gain_nat)
{
    struct rho_tracker *tracker = step->tracker;
    const struct rho_track *track = &tracker->tracks[scores->track_row];
    struct rho_imm_plot seen;
    while (rho_tracker_next_plot_near(step, &scores->near, plot)) {
        const struct rho_plot *at = &step->scan->plots[*plot];
        if (!is_unassigned_and_near(step, scores, *plot) ||
            !rho_tracker_spend_score_work_if_plot_chosen(step, &scores->choice, track, at)) {
            continue;
        }
        rho_imm_prepare_plot(&seen, at, step->scan->measures, step->sensor);
        struct rho_hypotheses_clutter clutter = scores->clutter;
        clutter.log_per_m2 += log_echo_density_ratio(step, *plot);
        if (rho_hypotheses_score_plot(&tracker->hypotheses, track->slot, &seen,
                                      step->time_us + at->offset_us, (int16_t)*plot, scores->log_pd,
                                      &clutter, gain_nat)) {
            return 1;
        }
    }
    return 0;
}
