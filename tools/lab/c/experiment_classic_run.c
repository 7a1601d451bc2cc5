/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "experiment_classic.h"
#include "pipeline/pipeline.h"

#define PI 3.14159265358979323846
#define WINDOW_RHO_M 40.0
#define WINDOW_THETA_RAD 0.008
#define PEAKS_MAX 4096u /* that are judged */
#define TOP 3u

/* ---- the data of a run ----------------------------------------------------------------------- */

struct classic_tools classic_tools_start(uint32_t max_peaks)
{
    return (struct classic_tools){.classic = must_alloc(sizeof(struct rho_hough)),
                                  .rows = must_alloc(sizeof(struct rho_accumulator)),
                                  .peaks =
                                      must_calloc(max_peaks, sizeof(struct rho_accumulator_peak)),
                                  .max_peaks = max_peaks,
                                  .initiator = must_alloc(sizeof(struct rho_initiator))};
}

static void free_plots(struct classic_plots *plots)
{
    free(plots->x_m);
    free(plots->y_m);
    free(plots->t_s);
}

void classic_tools_free(struct classic_tools *tools)
{
    free(tools->classic);
    free(tools->rows);
    free(tools->peaks);
    free(tools->initiator);
    free_plots(&tools->plots);
    free_plots(&tools->chosen);
    *tools = (struct classic_tools){0};
}

struct classic_data classic_simulate(const struct classic_situation *situation, uint64_t seed,
                                     uint64_t stream, uint64_t run)
{
    struct random random = random_start(seed, stream, run);
    struct classic_data data = {.situation = situation,
                                .plan = initiation_plan(&situation->of, &random)};
    data.plan.noise_m = situation->noise_m;
    data.simulation = plan_simulate(&data.plan, &random);
    return data;
}

void classic_data_free(struct classic_data *data)
{
    simulation_free(data->simulation);
    plan_free(&data->plan);
}

static size_t count_plots(const struct simulation *simulation)
{
    size_t count = 0;
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        count += simulation->scans[scan].num_plots;
    }
    return count;
}

static void make_room(struct classic_plots *plots, size_t count)
{
    plots->x_m = must_realloc(plots->x_m, (count + 1) * sizeof *plots->x_m);
    plots->y_m = must_realloc(plots->y_m, (count + 1) * sizeof *plots->y_m);
    plots->t_s = must_realloc(plots->t_s, (count + 1) * sizeof *plots->t_s);
}

void classic_load(struct classic_tools *tools, const struct classic_data *data)
{
    const struct simulation *simulation = data->simulation;
    struct classic_plots *plots = &tools->plots;
    size_t count = 0;
    make_room(plots, count_plots(simulation));
    make_room(&tools->chosen, count_plots(simulation));
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        for (size_t i = 0; i < simulation->scans[scan].num_plots; i++, count++) {
            plots->x_m[count] = (float)simulation->scans[scan].plots[i].x_m;
            plots->y_m[count] = (float)simulation->scans[scan].plots[i].y_m;
            plots->t_s[count] = (float)simulation->scans[scan].t_s;
        }
        plots->scan_end[scan] = (uint32_t)count;
    }
    tools->points = (struct rho_hough_points){
        {plots->x_m, plots->y_m, (unsigned)simulation->num_scans, plots->scan_end}, plots->t_s};
}

struct rho_hough_config classic_config(const struct classic_situation *situation, size_t method)
{
    struct rho_hough_config config;
    rho_hough_config_default(&config, (enum rho_hough_method)method);
    config.rho_max_m = situation->rho_max_m;
    return config;
}

struct rho_hough_result classic_find(struct classic_tools *tools,
                                     const struct rho_hough_config *config,
                                     const struct rho_hough_points *points)
{
    struct rho_hough_result result;
    must_succeed(rho_hough_init(tools->classic, sizeof *tools->classic, config), "rho_hough_init");
    must_succeed(rho_hough_find(tools->classic, points, tools->peaks, tools->max_peaks, &result),
                 "rho_hough_find");
    return result;
}

/* ---- lines ----------------------------------------------------------------------------------- */

/* The line with this normal through this place. */
static struct classic_line line_of(double normal_rad, double x_m, double y_m)
{
    double theta_rad = fmod(normal_rad, PI);
    theta_rad = theta_rad < 0.0 ? theta_rad + PI : theta_rad;
    return (struct classic_line){x_m * cos(theta_rad) + y_m * sin(theta_rad), theta_rad};
}

/* Total least squares through the true positions. */
struct classic_line classic_true_line(const struct scenario_plan *plan, size_t target)
{
    double n = (double)plan->num_scans, x_m = 0.0, y_m = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (size_t scan = 0; scan < plan->num_scans; scan++) {
        x_m += plan_truth(plan, scan, target)->x_m / n;
        y_m += plan_truth(plan, scan, target)->y_m / n;
    }
    for (size_t scan = 0; scan < plan->num_scans; scan++) {
        double dx_m = plan_truth(plan, scan, target)->x_m - x_m;
        double dy_m = plan_truth(plan, scan, target)->y_m - y_m;
        xx += dx_m * dx_m;
        xy += dx_m * dy_m;
        yy += dy_m * dy_m;
    }
    return line_of(0.5 * atan2(2.0 * xy, xx - yy) + PI / 2.0, x_m, y_m);
}

/* a - b, with a's twin (-rho, theta +- pi) where that is nearer. */
static struct classic_line difference(struct classic_line a, struct classic_line b)
{
    double theta_rad = a.theta_rad - b.theta_rad;
    if (theta_rad > PI / 2.0) {
        return (struct classic_line){-a.rho_m - b.rho_m, theta_rad - PI};
    }
    if (theta_rad < -PI / 2.0) {
        return (struct classic_line){-a.rho_m - b.rho_m, theta_rad + PI};
    }
    return (struct classic_line){a.rho_m - b.rho_m, theta_rad};
}

static bool is_within_window(struct classic_line distance)
{
    return fabs(distance.rho_m) <= WINDOW_RHO_M && fabs(distance.theta_rad) <= WINDOW_THETA_RAD;
}

/* Mean distance of a target's true positions from a line. */
static double mean_distance_m(const struct scenario_plan *plan, size_t target,
                              struct classic_line line)
{
    double sum_m = 0.0, nx = cos(line.theta_rad), ny = sin(line.theta_rad);
    for (size_t scan = 0; scan < plan->num_scans; scan++) {
        const struct truth_point *truth = plan_truth(plan, scan, target);
        sum_m += fabs(truth->x_m * nx + truth->y_m * ny - line.rho_m);
    }
    return sum_m / (double)plan->num_scans;
}

/* ---- peaks against targets ------------------------------------------------------------------- */

/* Peaks, best first. */
struct peaks {
    uint32_t count;
    struct classic_line *lines;
    double *votes;
};

struct match {
    bool is_detected[INITIATION_TARGETS_MAX], is_met[INITIATION_TARGETS_MAX],
        is_top[INITIATION_TARGETS_MAX];
    struct classic_line error[INITIATION_TARGETS_MAX]; /* of the best peak in the window */
    uint32_t num_false;
    double false_votes; /* the highest */
};

static void match_peak(struct match *match, const struct classic_data *data,
                       const struct classic_line *truth, const struct peaks *peaks, uint32_t i)
{
    bool is_false = true;
    for (size_t target = 0; target < data->plan.num_targets; target++) {
        struct classic_line error = difference(peaks->lines[i], truth[target]);
        bool is_detected = is_within_window(error);
        bool is_met =
            mean_distance_m(&data->plan, target, peaks->lines[i]) <= data->situation->near_m;
        if (is_detected && !match->is_detected[target]) {
            match->is_detected[target] = true;
            match->is_top[target] = i < TOP;
            match->error[target] = error;
        }
        match->is_met[target] |= is_met;
        is_false &= !is_detected && !is_met;
    }
    if (is_false) {
        match->num_false++;
        match->false_votes = fmax(match->false_votes, peaks->votes[i]);
    }
}

static void match_peaks(const struct classic_data *data, const struct peaks *peaks,
                        struct match *match)
{
    struct classic_line truth[INITIATION_TARGETS_MAX];
    memset(match, 0, sizeof *match);
    for (size_t target = 0; target < data->plan.num_targets; target++) {
        truth[target] = classic_true_line(&data->plan, target);
    }
    for (uint32_t i = 0; i < peaks->count; i++) {
        match_peak(match, data, truth, peaks, i);
    }
}

static void set_figures(struct classic_run *run, const struct classic_data *data,
                        const struct match *match)
{
    size_t num_targets = data->plan.num_targets, detected = 0, met = 0, top = 0;
    run->value[CLASSIC_RHO] = run->value[CLASSIC_THETA] = 0.0;
    for (size_t i = 0; i < num_targets; i++) {
        double rho_m = fabs(match->error[i].rho_m),
               theta_mrad = 1e3 * fabs(match->error[i].theta_rad);
        detected += match->is_detected[i];
        met += match->is_met[i];
        top += match->is_top[i];
        if (match->is_detected[i]) {
            run->value[CLASSIC_RHO] += rho_m;
            run->value[CLASSIC_THETA] += theta_mrad;
            run->rho2 += rho_m * rho_m;
            run->theta2 += theta_mrad * theta_mrad;
        }
    }
    run->matched = (int)detected;
    run->value[CLASSIC_DETECTED] = (double)detected / (double)num_targets;
    run->value[CLASSIC_MET] = (double)met / (double)num_targets;
    run->value[CLASSIC_TOP3] = (double)top / (double)num_targets;
    run->value[CLASSIC_FALSE] = match->num_false;
}

/* ---- the paper's methods --------------------------------------------------------------------- */

static struct peaks peaks_of(const struct classic_tools *tools, uint32_t num_peaks)
{
    uint32_t count = num_peaks < PEAKS_MAX ? num_peaks : PEAKS_MAX;
    struct peaks peaks = {count, must_calloc(count + 1u, sizeof *peaks.lines),
                          must_calloc(count + 1u, sizeof *peaks.votes)};
    for (uint32_t i = 0; i < count; i++) {
        const struct rho_accumulator_peak *peak = &tools->peaks[i];
        peaks.lines[i] =
            (struct classic_line){(double)rho_hough_rho_m(tools->classic, peak->rho_cell),
                                  (double)rho_hough_theta_rad(tools->classic, peak->theta_cell)};
        peaks.votes[i] = (double)peak->votes / RHO_HOUGH_VOTE;
    }
    return peaks;
}

static void set_heights(struct classic_run *run, struct classic_tools *tools,
                        const struct classic_data *data, double highest_false, double ideal_votes)
{
    struct rho_hough_config config = tools->classic->config;
    double n = (double)data->plan.num_targets, sum = 0.0;
    for (size_t target = 0; target < data->plan.num_targets; target++) {
        struct classic_line line = classic_true_line(&data->plan, target);
        sum += classic_near_votes(tools, &config, line) / n;
    }
    run->value[CLASSIC_DISCRIMINATION] = highest_false > 0.0 ? sum / highest_false : 0.0;
    run->value[CLASSIC_DECLINE] = 1.0 - sum / ideal_votes;
}

static struct classic_run run_paper(struct classic_tools *tools, const struct classic_data *data,
                                    size_t method, double ideal_votes)
{
    struct rho_hough_config config = classic_config(data->situation, method);
    struct classic_run run = {.matched = 0};
    int64_t start_us = clock_us();
    struct rho_hough_result result = classic_find(tools, &config, &tools->points);
    run.time_us = (double)(clock_us() - start_us);
    struct peaks peaks = peaks_of(tools, result.num_peaks);
    struct match match;
    match_peaks(data, &peaks, &match);
    double listed = (double)config.tau * result.votes_max / RHO_HOUGH_VOTE;
    set_figures(&run, data, &match);
    set_heights(&run, tools, data, fmax(match.false_votes, listed), ideal_votes);
    run.value[CLASSIC_VOTES] = result.votes;
    free(peaks.lines);
    free(peaks.votes);
    return run;
}

/* ---- the default ----------------------------------------------------------------------------- */

static struct classic_run run_kernel(struct classic_tools *tools, const struct classic_data *data)
{
    struct classic_run run = {.matched = 0};
    struct initiation_run judged =
        initiation_judge(&data->situation->of, &data->plan, data->simulation, tools->initiator);
    uint32_t count = tools->initiator->num_candidates;
    struct peaks peaks = {count, must_calloc(count + 1u, sizeof *peaks.lines),
                          must_calloc(count + 1u, sizeof *peaks.votes)};
    for (uint32_t i = 0; i < count; i++) {
        const struct rho_candidate *track = &tools->initiator->candidates[i];
        peaks.lines[i] = line_of(atan2((double)track->vx_mps, -(double)track->vy_mps),
                                 (double)track->x_m, (double)track->y_m);
    }
    struct match match;
    match_peaks(data, &peaks, &match);
    set_figures(&run, data, &match);
    run.value[CLASSIC_DISCRIMINATION] = run.value[CLASSIC_DECLINE] = run.value[CLASSIC_VOTES] = NAN;
    run.time_us = judged.time_us;
    run.found = judged.found;
    run.false_tracks = judged.false_tracks;
    free(peaks.lines);
    free(peaks.votes);
    return run;
}

struct classic_run classic_run(struct classic_tools *tools, const struct classic_data *data,
                               size_t method, double ideal_votes)
{
    return method == CLASSIC_KERNEL ? run_kernel(tools, data)
                                    : run_paper(tools, data, method, ideal_votes);
}

void classic_ideal_votes(struct classic_tools *tools, double ideal_votes[CLASSIC_KERNEL])
{
    struct classic_situation ideal = classic_situations[SITUATION_I];
    ideal.of.true_pd = 1.0;
    struct classic_data data = classic_simulate(&ideal, 1, 0, 0);
    classic_load(tools, &data);
    for (size_t method = 0; method < CLASSIC_KERNEL; method++) {
        struct classic_run run = classic_run(tools, &data, method, 1.0);
        ideal_votes[method] = 1.0 - run.value[CLASSIC_DECLINE];
    }
    classic_data_free(&data);
}
