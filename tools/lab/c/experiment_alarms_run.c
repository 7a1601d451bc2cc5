/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "base/random.h"
#include "clairvoyant.h"
#include "experiment_alarms.h"
#include "lab_input.h"

#define DELAY_WANTED_PER_HOUR 1.0
#define TARGET_NEAR_M 100.0 /* a confirmed track within is the target's: ten sigmas */

const double alarm_per_km2[ALARM_LEVELS] = {0.1, 1.0, 10.0};
const double alarm_wanted_per_hour[ALARM_RATES] = {1.0, 10.0, 100.0};
const double delay_per_km2[DELAY_LEVELS] = {0.0, 0.1, 1.0, 3.0, 10.0, 30.0};

/* Table 1's box, speeds and noise; everything else as it is by default. */
static struct parameters parameters_of(double wanted_per_hour)
{
    struct parameters parameters;
    parameters_default(&parameters);
    scenario_suggest("crossing", &parameters);
    parameters_suggest(&parameters, PARAMETER_FALSE_TRACKS_PER_HOUR, wanted_per_hour);
    return parameters;
}

static void step(struct pipeline *chain, double t_s, size_t num_plots)
{
    struct rho_scan scan = {
        .time_us = llround(t_s * 1e6), .num_plots = (uint32_t)num_plots, .plots = chain->plots};
    pipeline_step(chain, &scan);
}

/* ---- clutter alone --------------------------------------------------------------------------- */

static double mean_of(const struct parameters *parameters, double per_km2)
{
    double width_m =
        parameters->value[PARAMETER_AREA_X_MAX_M] - parameters->value[PARAMETER_AREA_X_MIN_M];
    double height_m =
        parameters->value[PARAMETER_AREA_Y_MAX_M] - parameters->value[PARAMETER_AREA_Y_MIN_M];

    return per_km2 * 1e-6 * width_m * height_m;
}

struct alarm_result alarm_run(double per_km2, double wanted_per_hour, uint64_t seed, uint64_t run,
                              struct pipeline *chain)
{
    struct parameters parameters = parameters_of(wanted_per_hour);
    double mean = mean_of(&parameters, per_km2);
    struct random random = random_start(seed, (uint64_t)llround(per_km2 * 1e3), run);
    double interval_s = parameters.value[PARAMETER_INTERVAL_S];
    struct alarm_result result = {.scans = ALARM_SCANS, .hours = ALARM_SCANS * interval_s / 3600.0};
    pipeline_open(chain, &parameters);
    for (size_t scan = 0; scan < ALARM_SCANS; scan++) {
        size_t num_plots = lab_fill_clutter(chain, &parameters, mean, &random);
        int64_t start_us = clock_us();
        step(chain, (double)scan * interval_s, num_plots);
        result.time_us += (double)(clock_us() - start_us);
        result.min_scans += chain->initiator->min_scans;
        result.confirm_nat += 1e-3 * chain->initiator->confirm_mnat;
    }
    result.started = chain->tracker->counters.tracks_started;
    result.confirmed = chain->tracker->counters.tracks_confirmed;
    return result;
}

/* ---- targets --------------------------------------------------------------------------------- */

/* A target's plots so far. */
struct history {
    size_t count;
    struct clairvoyant_plot plots[DELAY_SCANS];
};

/*
 * Does the fit through all of the target's own plots reach the threshold? Only its newest plot can
 * make it so.
 */
static bool is_possible(const struct parameters *parameters, const struct history *history,
                        double per_km2, double t_s, double confirm_nat)
{
    double interval_s = parameters->value[PARAMETER_INTERVAL_S];
    double area_m2 =
        (parameters->value[PARAMETER_AREA_X_MAX_M] - parameters->value[PARAMETER_AREA_X_MIN_M]) *
        (parameters->value[PARAMETER_AREA_Y_MAX_M] - parameters->value[PARAMETER_AREA_Y_MIN_M]);
    if (history->count < 3 || history->plots[history->count - 1].t_s < t_s) {
        return false;
    }
    double since_s = t_s - history->plots[0].t_s;
    struct clairvoyant_model model = {.num_scans = (size_t)llround(since_s / interval_s) + 1,
                                      .interval_s = interval_s,
                                      .sigma_m = parameters->value[PARAMETER_SIGMA_M],
                                      .pd = parameters->value[PARAMETER_PD],
                                      .area_m2 = area_m2,
                                      .v_min_mps = parameters->value[PARAMETER_V_MIN_MPS],
                                      .v_max_mps = parameters->value[PARAMETER_V_MAX_MPS]};
    /* where there is no clutter: half a plot in the area and window, as the initiator takes it */
    double least = 0.5 / (area_m2 * parameters->value[PARAMETER_SCANS]);
    struct clairvoyant_plot plots[DELAY_SCANS];
    for (size_t i = 0; i < history->count; i++) {
        plots[i] = history->plots[i];
        plots[i].density_per_m2 = fmax(per_km2 * 1e-6, least);
    }
    return clairvoyant_fit(&model, plots, history->count).score_nat >= confirm_nat;
}

static void note_plots(const struct simulated_scan *scan, struct history histories[DELAY_TARGETS],
                       struct rho_plot *plots, double sigma_m)
{
    for (size_t i = 0; i < scan->num_plots; i++) {
        const struct simulated_plot *plot = &scan->plots[i];
        plots[i] = lab_plot(plot->x_m, plot->y_m, sigma_m);
        if (plot->target_id >= 0) {
            struct history *history = &histories[plot->target_id];
            history->plots[history->count++] =
                (struct clairvoyant_plot){.t_s = scan->t_s, .x_m = plot->x_m, .y_m = plot->y_m};
        }
    }
}

static bool has_confirmed(const struct rho_report *report, const struct truth_point *truth)
{
    for (unsigned i = 0; i < report->num_tracks; i++) {
        const struct rho_track_report *track = &report->tracks[i];
        if (track->status != RHO_TRACK_TENTATIVE &&
            hypot(track->state[0] - truth->x_m, track->state[1] - truth->y_m) <= TARGET_NEAR_M) {
            return true;
        }
    }
    return false;
}

static void judge(struct delay_result *result, size_t target, size_t scan, bool is_confirmed,
                  bool is_possible_now, size_t plots)
{
    int at = (int)scan + 1;
    if (is_possible_now && result->possible_at[target] > at) {
        result->possible_at[target] = at;
    }
    if (is_confirmed && result->confirmed_at[target] > at) {
        result->confirmed_at[target] = at;
        result->plots[target] = (int)plots;
    }
}

/* The scenario's area grows with the targets' paths. */
static void take_area(struct parameters *parameters, const struct scenario_box *area)
{
    parameters_suggest(parameters, PARAMETER_AREA_X_MIN_M, area->x_min_m);
    parameters_suggest(parameters, PARAMETER_AREA_X_MAX_M, area->x_max_m);
    parameters_suggest(parameters, PARAMETER_AREA_Y_MIN_M, area->y_min_m);
    parameters_suggest(parameters, PARAMETER_AREA_Y_MAX_M, area->y_max_m);
}

struct delay_result delay_run(double per_km2, uint64_t seed, uint64_t run, struct pipeline *chain)
{
    struct parameters parameters = parameters_of(DELAY_WANTED_PER_HOUR);
    struct history histories[DELAY_TARGETS] = {{.count = 0}};
    struct delay_result result;
    parameters_suggest(&parameters, PARAMETER_CLUTTER_PER_KM2, per_km2);
    parameters_suggest(&parameters, PARAMETER_NUM_SCANS, DELAY_SCANS);
    struct simulation *simulation = scenario_simulate("crossing", &parameters, seed, run);
    take_area(&parameters, &simulation->area);
    for (size_t target = 0; target < DELAY_TARGETS; target++) {
        result.confirmed_at[target] = result.possible_at[target] = DELAY_SCANS + 1;
        result.plots[target] = DELAY_SCANS + 1;
    }
    pipeline_open(chain, &parameters);
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        const struct simulated_scan *from = &simulation->scans[scan];
        note_plots(from, histories, chain->plots, simulation->sigma_m);
        step(chain, from->t_s, from->num_plots);
        double confirm_nat = 1e-3 * chain->initiator->confirm_mnat;
        for (size_t target = 0; target < DELAY_TARGETS; target++) {
            const struct truth_point *truth = &simulation->truth[scan * DELAY_TARGETS + target];
            judge(&result, target, scan, has_confirmed(chain->report, truth),
                  is_possible(&parameters, &histories[target], per_km2, from->t_s, confirm_nat),
                  histories[target].count);
        }
    }
    simulation_free(simulation);
    return result;
}
