/* SPDX-License-Identifier: MIT */
#include "experiment_classic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "workers.h"

#define PEAKS_ROOM 1000000u
#define STREAM 1000 /* of the first Situation; the default's own cases have lower numbers */
#define SWEEP_STREAM 2000
#define TIMES_STREAM 3000
#define SWEEP_METHODS                                                                              \
    (1u << RHO_HOUGH_IHT | 1u << RHO_HOUGH_NHT_A | 1u << RHO_HOUGH_NHT_C | 1u << CLASSIC_KERNEL)
#define DENSEST_RUNS_MIN 50 /* from so many runs on, the densest clutter is timed, too */

static const double noises_m[CLASSIC_NOISES] = {0.0, 0.3, 0.6, 1.0, 2.0, 5.0, 10.0};
static const double densities[CLASSIC_DENSITIES] = {0.1, 1.0, 3.0, 10.0, 30.0};

bool classic_has(const struct classic_report *report, size_t method)
{
    return (report->methods >> method & 1u) != 0;
}

/* ---- the runs -------------------------------------------------------------------------------- */

/* So many runs of some Situations with some methods; the methods share each run's data. */
struct batch {
    const struct classic_situation *situations;
    size_t num_runs; /* of each */
    unsigned methods;
    uint64_t seed, stream;
    const double *ideal_votes;
    struct classic_tools *tools;
    struct classic_run *runs; /* by Situation, method, run */
};

static struct classic_run *run_at(const struct batch *batch, size_t situation, size_t method,
                                  size_t run)
{
    return &batch->runs[(situation * CLASSIC_METHODS + method) * batch->num_runs + run];
}

static void run_one(void *context, size_t worker, size_t index)
{
    struct batch *batch = context;
    size_t situation = index / batch->num_runs, run = index % batch->num_runs;
    struct classic_tools *tools = &batch->tools[worker];
    if (tools->classic == NULL) {
        *tools = classic_tools_start(PEAKS_ROOM);
    }
    struct classic_data data = classic_simulate(&batch->situations[situation], batch->seed,
                                                batch->stream + situation, run);
    classic_load(tools, &data);
    for (size_t method = 0; method < CLASSIC_METHODS; method++) {
        if (batch->methods >> method & 1u) {
            *run_at(batch, situation, method, run) = classic_run(
                tools, &data, method, method < CLASSIC_KERNEL ? batch->ideal_votes[method] : NAN);
        }
    }
    classic_data_free(&data);
}

/* ---- summaries ------------------------------------------------------------------------------- */

static int compare_doubles(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return values[count / 2];
}

struct sums {
    double sum, squares, count;
};

static void add_value(struct sums *sums, const struct classic_run *run, enum classic_figure figure)
{
    double value = run->value[figure];
    bool is_error = figure == CLASSIC_RHO || figure == CLASSIC_THETA;
    sums->sum += value;
    sums->squares += figure == CLASSIC_RHO     ? run->rho2
                     : figure == CLASSIC_THETA ? run->theta2
                                               : value * value;
    sums->count += is_error ? run->matched : 1.0;
}

static void summarise_figure(struct classic_summary *summary, const struct classic_run *runs,
                             size_t num_runs, enum classic_figure figure)
{
    struct sums sums = {0.0, 0.0, 0.0};
    for (size_t i = 0; i < num_runs; i++) {
        add_value(&sums, &runs[i], figure);
    }
    double mean = sums.count > 0.0 ? sums.sum / sums.count : NAN;
    double variance =
        fmax(sums.squares / sums.count - mean * mean, 0.0) / fmax(sums.count - 1.0, 1.0);
    summary->mean[figure] = mean;
    summary->error[figure] = isnan(mean) ? NAN : sqrt(variance);
}

static struct classic_summary summarise(const struct batch *batch, size_t situation, size_t method)
{
    struct classic_summary summary = {.situation = &batch->situations[situation], .method = method};
    const struct classic_run *runs = run_at(batch, situation, method, 0);
    double n = (double)batch->num_runs, *times_us = must_calloc(batch->num_runs, sizeof *times_us);
    for (enum classic_figure figure = 0; figure < CLASSIC_FIGURES; figure++) {
        summarise_figure(&summary, runs, batch->num_runs, figure);
    }
    for (size_t i = 0; i < batch->num_runs; i++) {
        times_us[i] = runs[i].time_us;
        summary.found += runs[i].found / (INITIATION_TARGETS_MAX * n);
        summary.false_tracks += runs[i].false_tracks / n;
    }
    summary.time_us = median(times_us, batch->num_runs);
    free(times_us);
    return summary;
}

static void make_summaries(struct batch *batch, size_t num_situations,
                           struct classic_summary (*summaries)[CLASSIC_METHODS])
{
    batch->runs =
        must_calloc(num_situations * CLASSIC_METHODS * batch->num_runs, sizeof *batch->runs);
    workers_run(num_situations * batch->num_runs, "runs", run_one, batch);
    for (size_t i = 0; i < num_situations; i++) {
        for (size_t method = 0; method < CLASSIC_METHODS; method++) {
            if (batch->methods >> method & 1u) {
                summaries[i][method] = summarise(batch, i, method);
            }
        }
    }
    free(batch->runs);
}

/* ---- times ----------------------------------------------------------------------------------- */

/* One at a time, so that nothing of this program disturbs them. */
static void time_density(struct classic_report *report, struct classic_tools *tools, size_t number,
                         size_t num_runs)
{
    struct classic_situation situation = classic_situations[SITUATION_IV];
    struct classic_time *time = &report->times[number];
    double values_us[CLASSIC_METHODS + 1][8];
    situation.of.clutter_per_km2 = time->per_km2 = densities[number];
    for (size_t run = 0; run < num_runs; run++) {
        struct classic_data data =
            classic_simulate(&situation, report->seed, TIMES_STREAM + number, run);
        uint32_t num_peaks;
        struct rho_hough_config config = classic_config(&situation, RHO_HOUGH_HT);
        classic_load(tools, &data);
        values_us[CLASSIC_DENSE][run] = classic_dense_us(tools, &config, &num_peaks);
        for (size_t method = 0; method < CLASSIC_METHODS; method++) {
            if (classic_has(report, method)) {
                struct classic_run result = classic_run(tools, &data, method, 1.0);
                values_us[method][run] = result.time_us;
                time->votes[method] += result.value[CLASSIC_VOTES] / (double)num_runs;
            }
        }
        classic_data_free(&data);
    }
    for (size_t i = 0; i <= CLASSIC_METHODS; i++) {
        bool is_timed = i == CLASSIC_DENSE || classic_has(report, i);
        time->time_us[i] = is_timed ? median(values_us[i], num_runs) : NAN;
        time->votes[i] = is_timed ? time->votes[i] : NAN;
    }
    time->votes[CLASSIC_DENSE] = NAN;
}

static void make_times(struct classic_report *report, struct classic_tools *tools)
{
    bool has_densest = report->num_runs >= DENSEST_RUNS_MIN;
    report->num_times = has_densest ? CLASSIC_DENSITIES : CLASSIC_DENSITIES - 1;
    for (size_t i = 0; i < report->num_times; i++) {
        time_density(report, tools, i, has_densest && i + 1 < CLASSIC_DENSITIES ? 7 : 3);
    }
}

/* ---- the report ------------------------------------------------------------------------------ */

/* Reading A on Table 3 as printed: no clutter, nothing missed. */
static double votes_of_table3(const struct classic_report *report, struct classic_tools *tools)
{
    struct classic_situation alone = classic_situations[SITUATION_REAL];
    if (!classic_has(report, RHO_HOUGH_NHT_A)) {
        return NAN;
    }
    alone.of.clutter_per_scan = 0.0;
    alone.of.true_pd = 1.0;
    struct classic_data data = classic_simulate(&alone, report->seed, 0, 0);
    struct rho_hough_config config = classic_config(&alone, RHO_HOUGH_NHT_A);
    classic_load(tools, &data);
    struct rho_hough_result result = classic_find(tools, &config, &tools->points);
    classic_data_free(&data);
    return result.votes;
}

static void make_sweep(struct classic_report *report, struct batch *batch)
{
    for (size_t i = 0; i < CLASSIC_NOISES; i++) {
        report->sweep_situations[i] = classic_situations[SITUATION_IV];
        report->sweep_situations[i].noise_m = noises_m[i];
    }
    batch->situations = report->sweep_situations;
    batch->num_runs = report->num_sweep_runs;
    batch->methods = report->methods & SWEEP_METHODS;
    batch->stream = SWEEP_STREAM;
    make_summaries(batch, CLASSIC_NOISES, report->sweep);
}

struct classic_report *classic_report_make(unsigned methods, uint64_t seed, size_t num_runs)
{
    struct classic_report *report = must_calloc(1, sizeof *report);
    struct classic_tools tools[WORKERS_MAX] = {{0}};
    report->methods = methods;
    report->seed = seed;
    report->num_runs = num_runs;
    report->num_sweep_runs = num_runs >= 8 ? num_runs / 4 : num_runs < 2 ? num_runs : 2;
    tools[0] = classic_tools_start(PEAKS_ROOM);
    classic_ideal_votes(&tools[0], report->ideal_votes);
    struct batch batch = {.situations = classic_situations,
                          .num_runs = num_runs,
                          .methods = methods,
                          .seed = seed,
                          .stream = STREAM,
                          .ideal_votes = report->ideal_votes,
                          .tools = tools};
    make_summaries(&batch, SITUATIONS, report->summaries);
    make_sweep(report, &batch);
    make_times(report, &tools[0]);
    report->table3_votes = votes_of_table3(report, &tools[0]);
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        classic_tools_free(&tools[i]);
    }
    classic_judge(report);
    return report;
}

void classic_report_free(struct classic_report *report)
{
    if (report != NULL) {
        free(report->verdicts);
        free(report);
    }
}
