/* SPDX-License-Identifier: MIT */
#include "experiment_initiation.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "clairvoyant.h"

#define V_MIN_MPS 100.0
#define V_MAX_MPS 400.0
#define PD_ASSUMED_MAX 0.99

/* ---- the initiator on simulated scans -------------------------------------------------------- */

/* The bars take P_D as known; where there is no target, 0.9 is assumed as by default. */
static double assumed_pd(const struct initiation_case *of)
{
    if (of->paths == PATHS_NONE) {
        return 0.9;
    }
    return of->true_pd < PD_ASSUMED_MAX ? of->true_pd : PD_ASSUMED_MAX;
}

static struct rho_initiator_config config_of(const struct initiation_case *of)
{
    struct rho_initiator_config config;
    rho_initiator_config_default(&config);
    config.scans = INITIATION_SCANS;
    config.min_scans = of->min_scans;
    config.v_min_mps = (float)V_MIN_MPS;
    config.v_max_mps = (float)V_MAX_MPS;
    config.pd = (float)assumed_pd(of);
    config.score_min_nat = (float)of->score_min_nat;
    config.process_noise_mps2 = (float)of->process_noise_mps2;
    config.area_is_fixed = 1;
    config.area = (struct rho_extent){.x_min_m = (float)of->box.x_min_m,
                                      .x_max_m = (float)of->box.x_max_m,
                                      .y_min_m = (float)of->box.y_min_m,
                                      .y_max_m = (float)of->box.y_max_m};
    return config;
}

static void push(struct rho_initiator *initiator, const struct simulated_scan *from, double sigma_m)
{
    struct rho_plot *plots = must_calloc(from->num_plots + 1, sizeof *plots);
    uint8_t *fates = must_calloc(from->num_plots + 1, 1);
    uint32_t left_unused = 0;
    for (size_t i = 0; i < from->num_plots; i++) {
        plots[i].x_m = (float)from->plots[i].x_m;
        plots[i].y_m = (float)from->plots[i].y_m;
        plots[i].sigma_range_m = plots[i].sigma_cross_m = plots[i].sigma_up_m = (float)sigma_m;
        fates[i] = RHO_FATE_HELD;
    }
    struct rho_scan scan = {.time_us = llround(from->t_s * 1e6),
                            .num_plots = (uint32_t)from->num_plots,
                            .plots = plots};
    enum rho_status status = rho_initiator_push(initiator, &scan, NULL, fates, &left_unused);
    free(fates);
    free(plots);
    if (status != RHO_OK) {
        fail(EXIT_RUNTIME, "rho_initiator_push: %s", rho_status_name(status));
    }
}

static double search(const struct initiation_case *of, const struct simulation *simulation,
                     struct rho_initiator *initiator)
{
    struct rho_initiator_config config = config_of(of);
    enum rho_status status = rho_initiator_init(initiator, sizeof *initiator, &config);
    if (status != RHO_OK) {
        fail(EXIT_RUNTIME, "rho_initiator_init: %s", rho_status_name(status));
    }
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        push(initiator, &simulation->scans[scan], simulation->sigma_m);
    }
    int64_t start_us = clock_us();
    status = rho_initiator_search(initiator, RHO_SEARCH_BATCH);
    double time_us = (double)(clock_us() - start_us);
    if (status != RHO_OK) {
        fail(EXIT_RUNTIME, "rho_initiator_search: %s", rho_status_name(status));
    }
    return time_us;
}

/* ---- who was found --------------------------------------------------------------------------- */

/* Mean distance over the scans between a candidate's straight path and a target. */
static double path_error_m(const struct scenario_plan *plan, size_t target,
                           const struct rho_candidate *candidate)
{
    double last_s = plan->interval_s * ((double)plan->num_scans - 1.0);
    double sum_m = 0.0;
    for (size_t scan = 0; scan < plan->num_scans; scan++) {
        const struct truth_point *truth = plan_truth(plan, scan, target);
        double dt_s = truth->t_s - last_s;
        sum_m += hypot(candidate->x_m + candidate->vx_mps * dt_s - truth->x_m,
                       candidate->y_m + candidate->vy_mps * dt_s - truth->y_m);
    }
    return sum_m / (double)plan->num_scans;
}

/* Pairs targets and candidates one to one, the closest first, up to the tolerance. */
static void match(const struct initiation_case *of, const struct scenario_plan *plan,
                  const struct rho_initiator *initiator, struct initiation_run *run)
{
    bool is_taken[RHO_MAX_CANDIDATES] = {false};
    bool is_found[INITIATION_TARGETS_MAX] = {false};
    for (;;) {
        double best_m = of->tolerance_m;
        size_t best_target = 0, best_candidate = RHO_MAX_CANDIDATES;
        for (size_t target = 0; target < plan->num_targets; target++) {
            for (size_t i = 0; i < initiator->num_candidates && !is_found[target]; i++) {
                double error_m = path_error_m(plan, target, &initiator->candidates[i]);
                if (!is_taken[i] && error_m <= best_m) {
                    best_m = error_m;
                    best_target = target;
                    best_candidate = i;
                }
            }
        }
        if (best_candidate == RHO_MAX_CANDIDATES) {
            return;
        }
        is_taken[best_candidate] = is_found[best_target] = true;
        run->found++;
        run->error_m += best_m;
    }
}

/* ---- the clairvoyant fit --------------------------------------------------------------------- */

static double mean_density(const struct simulation *simulation, double area_m2)
{
    size_t plots = 0;
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        plots += simulation->scans[scan].num_plots;
    }
    return fmax((double)plots / (double)simulation->num_scans, 1.0) / area_m2;
}

/* Density where it is known to be uneven, else the window's mean, as the initiator estimates it. */
static double density_at(const struct initiation_case *of, double mean_per_m2, double x_m,
                         double y_m)
{
    if (of->spot_per_km2 <= 0.0) {
        return mean_per_m2;
    }
    bool is_inside = x_m >= of->spot.x_min_m && x_m <= of->spot.x_max_m &&
                     y_m >= of->spot.y_min_m && y_m <= of->spot.y_max_m;
    return 1e-6 * (of->clutter_per_km2 + (is_inside ? of->spot_per_km2 : 0.0));
}

static size_t plots_of(const struct initiation_case *of, const struct simulation *simulation,
                       int target, double mean_per_m2,
                       struct clairvoyant_plot plots[CLAIRVOYANT_PLOTS_MAX])
{
    size_t count = 0;
    for (size_t scan = 0; scan < simulation->num_scans; scan++) {
        for (size_t i = 0; i < simulation->scans[scan].num_plots; i++) {
            const struct simulated_plot *plot = &simulation->scans[scan].plots[i];
            if (plot->target_id == target) {
                plots[count++] = (struct clairvoyant_plot){
                    .t_s = simulation->scans[scan].t_s,
                    .x_m = plot->x_m,
                    .y_m = plot->y_m,
                    .density_per_m2 = density_at(of, mean_per_m2, plot->x_m, plot->y_m)};
            }
        }
    }
    return count;
}

/* How many targets the fit through their own plots would accept. */
static int clairvoyant_found(const struct initiation_case *of, const struct scenario_plan *plan,
                             const struct simulation *simulation)
{
    double area_m2 = (of->box.x_max_m - of->box.x_min_m) * (of->box.y_max_m - of->box.y_min_m);
    double mean_per_m2 = mean_density(simulation, area_m2);
    struct clairvoyant_model model = {.num_scans = plan->num_scans,
                                      .interval_s = plan->interval_s,
                                      .sigma_m = plan->sigma_m,
                                      .process_noise_mps2 = of->process_noise_mps2,
                                      .pd = assumed_pd(of),
                                      .area_m2 = area_m2,
                                      .v_min_mps = V_MIN_MPS,
                                      .v_max_mps = V_MAX_MPS};
    int found = 0;
    for (size_t target = 0; target < plan->num_targets; target++) {
        struct clairvoyant_plot plots[CLAIRVOYANT_PLOTS_MAX];
        size_t count = plots_of(of, simulation, (int)target, mean_per_m2, plots);
        if (count < of->min_scans) {
            continue;
        }
        struct clairvoyant_fit fit = clairvoyant_fit(&model, plots, count);
        double speed_mps = hypot(fit.vx_mps, fit.vy_mps);
        found +=
            fit.score_nat >= of->score_min_nat && speed_mps >= V_MIN_MPS && speed_mps <= V_MAX_MPS;
    }
    return found;
}

/* ---- runs and their summary ------------------------------------------------------------------ */

struct initiation_run initiation_judge(const struct initiation_case *of,
                                       const struct scenario_plan *plan,
                                       const struct simulation *simulation,
                                       struct rho_initiator *initiator)
{
    struct initiation_run run = {.targets = (int)plan->num_targets};
    run.time_us = search(of, simulation, initiator);
    match(of, plan, initiator, &run);
    run.clairvoyant = clairvoyant_found(of, plan, simulation);
    run.tracks = initiator->num_candidates;
    run.false_tracks = run.tracks - run.found;
    run.work = initiator->work;
    return run;
}

struct initiation_run initiation_run(const struct initiation_case *of,
                                     struct rho_initiator *initiator, struct random *random)
{
    struct scenario_plan plan = initiation_plan(of, random);
    struct simulation *simulation = plan_simulate(&plan, random);
    struct initiation_run run = initiation_judge(of, &plan, simulation, initiator);
    simulation_free(simulation);
    plan_free(&plan);
    return run;
}

static int compare_doubles(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static double median_time_us(const struct initiation_run *runs, size_t num_runs)
{
    double *times = must_calloc(num_runs, sizeof *times);
    for (size_t i = 0; i < num_runs; i++) {
        times[i] = runs[i].time_us;
    }
    qsort(times, num_runs, sizeof *times, compare_doubles);
    double median = times[num_runs / 2];
    free(times);
    return median;
}

static void add_work(struct initiation_summary *summary, const struct rho_initiator_work *work)
{
    double share = 1.0 / (double)summary->runs;
    summary->seeds += work->seeds * share;
    summary->lookups += work->window.lookups * share;
    summary->distances += work->window.distances * share;
    summary->fits += work->fits * share;
    summary->seeds_max = fmax(summary->seeds_max, work->seeds);
    summary->lookups_max = fmax(summary->lookups_max, work->window.lookups);
    summary->distances_max = fmax(summary->distances_max, work->window.distances);
}

struct initiation_summary initiation_summarise(const struct initiation_case *of,
                                               const struct initiation_run *runs, size_t num_runs)
{
    struct initiation_summary summary = {.of = of, .runs = num_runs};
    double targets = 0.0, found = 0.0, clairvoyant = 0.0, all_found = 0.0;
    for (size_t i = 0; i < num_runs; i++) {
        targets += runs[i].targets;
        found += runs[i].found;
        clairvoyant += runs[i].clairvoyant;
        all_found += runs[i].found == runs[i].targets;
        summary.false_a_run += runs[i].false_tracks / (double)num_runs;
        summary.error_m += runs[i].error_m;
        add_work(&summary, &runs[i].work);
    }
    summary.pd = targets > 0.0 ? found / targets : NAN;
    summary.all_found = targets > 0.0 ? all_found / (double)num_runs : NAN;
    summary.clairvoyant = targets > 0.0 ? clairvoyant / targets : NAN;
    summary.error_m = found > 0.0 ? summary.error_m / found : NAN;
    summary.time_us = median_time_us(runs, num_runs);
    return summary;
}

size_t initiation_verdicts(const struct initiation_summary *summary,
                           struct initiation_verdict verdicts[3])
{
    const struct initiation_bars *bars = &summary->of->bars;
    double found = summary->of->all_count ? summary->all_found : summary->pd;
    double behind = summary->clairvoyant - summary->pd;
    const double rounding = 1e-9;
    size_t count = 0;
    if (!isnan(bars->found_min)) {
        verdicts[count++] =
            (struct initiation_verdict){summary->of->all_count ? "all found" : "found", found,
                                        bars->found_min, found >= bars->found_min - rounding};
    }
    if (!isnan(bars->false_max)) {
        verdicts[count++] =
            (struct initiation_verdict){"false a run", summary->false_a_run, bars->false_max,
                                        summary->false_a_run <= bars->false_max + rounding};
    }
    if (!isnan(bars->behind_max)) {
        verdicts[count++] =
            (struct initiation_verdict){"behind the clairvoyant fit", behind, bars->behind_max,
                                        behind <= bars->behind_max + rounding};
    }
    return count;
}
