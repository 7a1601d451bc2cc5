/* SPDX-License-Identifier: MIT */
#include "experiment_passive.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "experiment.h"
#include "experiment_passive_report.h"
#include "workers.h"

#define PRUNING_RUNS 300
#define PAPER_RUNS 200
#define DEFAULT_RUNS 400
#define PRUNING_STREAM 5000 /* of the first case */
#define PAPER_STREAM 6000
#define DEFAULT_STREAM 7000

/* ---- the runs -------------------------------------------------------------------------------- */

/* All runs of one table's cases. */
struct batch {
    uint64_t seed;
    size_t num_runs; /* of each case */
    struct passive_pruning_run *pruning;
    struct passive_paper_run *paper;
    struct passive_default_run *defaults;
    struct rho_passive_paper *paper_objects[WORKERS_MAX];
    struct rho_passive *default_objects[WORKERS_MAX];
};

static void prune_one(void *context, size_t worker, size_t index)
{
    struct batch *batch = context;
    size_t number = index / batch->num_runs;
    struct random random =
        random_start(batch->seed, PRUNING_STREAM + number, index % batch->num_runs);
    (void)worker;
    batch->pruning[index] = passive_pruning_run(&passive_pruning_cases[number], &random);
}

static void run_paper(void *context, size_t worker, size_t index)
{
    struct batch *batch = context;
    size_t number = index / batch->num_runs;
    struct random random =
        random_start(batch->seed, PAPER_STREAM + number, index % batch->num_runs);
    if (batch->paper_objects[worker] == NULL) {
        batch->paper_objects[worker] = must_alloc(sizeof *batch->paper_objects[worker]);
    }
    batch->paper[index] =
        passive_paper_run(&passive_paper_cases[number], batch->paper_objects[worker], &random);
}

static void run_default(void *context, size_t worker, size_t index)
{
    struct batch *batch = context;
    size_t number = index / batch->num_runs;
    struct random random =
        random_start(batch->seed, DEFAULT_STREAM + number, index % batch->num_runs);
    if (batch->default_objects[worker] == NULL) {
        batch->default_objects[worker] = must_alloc(sizeof *batch->default_objects[worker]);
    }
    batch->defaults[index] = passive_default_run(&passive_default_cases[number],
                                                 batch->default_objects[worker], &random);
}

static void batch_free(struct batch *batch)
{
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        free(batch->paper_objects[i]);
        free(batch->default_objects[i]);
    }
    free(batch->pruning);
    free(batch->paper);
    free(batch->defaults);
}

/* ---- pruning and the paper's method ---------------------------------------------------------- */

static struct passive_pruning_summary summarise_pruning(const struct passive_pruning_run *runs,
                                                        size_t num_runs)
{
    struct passive_pruning_summary summary;
    for (int rule = 0; rule < PASSIVE_RULES; rule++) {
        size_t ghosts = 0, removed = 0, targets = 0, lost = 0;
        for (size_t i = 0; i < num_runs; i++) {
            ghosts += runs[i].ghosts;
            removed += runs[i].ghosts_removed[rule];
            targets += runs[i].targets;
            lost += runs[i].targets_lost[rule];
        }
        summary.by_rule[rule] = (struct passive_pruned){(double)removed / (double)ghosts,
                                                        (double)lost / (double)targets};
    }
    return summary;
}

static void make_pruning(struct passive_report *report)
{
    struct batch batch = {.seed = report->seed, .num_runs = report->pruning_runs};
    batch.pruning = must_calloc(passive_num_pruning_cases * batch.num_runs, sizeof *batch.pruning);
    report->pruning = must_calloc(passive_num_pruning_cases, sizeof *report->pruning);
    workers_run(passive_num_pruning_cases * batch.num_runs, "runs", prune_one, &batch);
    for (size_t i = 0; i < passive_num_pruning_cases; i++) {
        report->pruning[i] = summarise_pruning(&batch.pruning[i * batch.num_runs], batch.num_runs);
    }
    batch_free(&batch);
}

/* 0 targets: the share is NAN. */
static struct passive_found share_found(size_t found, size_t targets, size_t ghosts, size_t exact,
                                        size_t num_runs)
{
    return (struct passive_found){.share = (double)found / (double)targets,
                                  .ghosts_a_run = (double)ghosts / (double)num_runs,
                                  .exact = (double)exact / (double)num_runs};
}

static struct passive_paper_summary summarise_paper(const struct passive_paper_run *runs,
                                                    size_t num_runs)
{
    struct passive_paper_summary summary;
    for (int rule = 0; rule < PASSIVE_RULES; rule++) {
        size_t found = 0, ghosts = 0, exact = 0;
        for (size_t i = 0; i < num_runs; i++) {
            found += runs[i].by_rule[rule].found;
            ghosts += runs[i].by_rule[rule].ghosts;
            exact +=
                runs[i].by_rule[rule].found == runs[i].targets && runs[i].by_rule[rule].ghosts == 0;
        }
        summary.by_rule[rule] =
            share_found(found, runs[0].targets * num_runs, ghosts, exact, num_runs);
    }
    return summary;
}

static void make_paper(struct passive_report *report)
{
    struct batch batch = {.seed = report->seed, .num_runs = report->paper_runs};
    batch.paper = must_calloc(passive_num_paper_cases * batch.num_runs, sizeof *batch.paper);
    report->paper = must_calloc(passive_num_paper_cases, sizeof *report->paper);
    workers_run(passive_num_paper_cases * batch.num_runs, "runs", run_paper, &batch);
    for (size_t i = 0; i < passive_num_paper_cases; i++) {
        report->paper[i] = summarise_paper(&batch.paper[i * batch.num_runs], batch.num_runs);
    }
    batch_free(&batch);
}

/* ---- the default ----------------------------------------------------------------------------- */

static int compare_doubles(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return count == 0      ? NAN
           : count % 2 > 0 ? values[count / 2]
                           : (values[count / 2 - 1] + values[count / 2]) / 2.0;
}

/* All found targets of a case. */
struct hits {
    struct passive_hit *list;
    size_t count;
};

static struct hits hits_of(const struct passive_default_run *runs, size_t num_runs)
{
    struct hits hits = {must_calloc(num_runs * PASSIVE_TARGETS_MAX, sizeof *hits.list), 0};
    for (size_t i = 0; i < num_runs; i++) {
        memcpy(&hits.list[hits.count], runs[i].hits, runs[i].found * sizeof *hits.list);
        hits.count += runs[i].found;
    }
    return hits;
}

/* Median of the double that is so many bytes into a hit. */
static double median_of(const struct hits *hits, size_t offset)
{
    double *values = must_calloc(hits->count + 1, sizeof *values);
    for (size_t i = 0; i < hits->count; i++) {
        memcpy(&values[i], (const char *)&hits->list[i] + offset, sizeof values[i]);
    }
    double middle = median(values, hits->count);
    free(values);
    return middle;
}

#define MEDIAN(hits, field) median_of(hits, offsetof(struct passive_hit, field))

static struct passive_nees nees_of(const struct hits *hits, bool only_own)
{
    struct passive_nees nees = {0.0, 0};
    for (size_t i = 0; i < hits->count; i++) {
        if (hits->list[i].is_own || !only_own) {
            nees.mean += hits->list[i].nees;
            nees.count++;
        }
    }
    nees.mean /= (double)nees.count;
    return nees;
}

static void summarise_hits(struct passive_default_summary *summary, const struct hits *hits)
{
    double off_m2 = 0.0, fit_off_m2 = 0.0, count = (double)hits->count;
    for (size_t i = 0; i < hits->count; i++) {
        off_m2 += hits->list[i].off_m * hits->list[i].off_m;
        fit_off_m2 += hits->list[i].fit_off_m * hits->list[i].fit_off_m;
    }
    summary->nees = nees_of(hits, false);
    summary->own_nees = nees_of(hits, true);
    summary->rms_m = sqrt(off_m2 / count);
    summary->fit_rms_m = sqrt(fit_off_m2 / count);
    summary->line_off =
        (struct passive_line){MEDIAN(hits, line_off.rho_m), MEDIAN(hits, line_off.theta_rad)};
    summary->fit_line_off = (struct passive_line){MEDIAN(hits, fit_line_off.rho_m),
                                                  MEDIAN(hits, fit_line_off.theta_rad)};
}

static struct passive_default_summary summarise_default(const struct passive_default_case *of,
                                                        const struct passive_default_run *runs,
                                                        size_t num_runs)
{
    struct passive_default_summary summary = {.search_ms = 0.0};
    size_t targets = of->setting.targets, found = 0, ghosts = 0, exact = 0;
    double *times_us = must_calloc(num_runs, sizeof *times_us);
    for (size_t i = 0; i < num_runs; i++) {
        found += runs[i].found;
        ghosts += runs[i].ghosts;
        exact += runs[i].found == targets && runs[i].ghosts == 0;
        times_us[i] = runs[i].search_us;
    }
    struct hits hits = hits_of(runs, num_runs);
    summarise_hits(&summary, &hits);
    summary.found = share_found(found, targets * num_runs, ghosts, exact, num_runs);
    summary.search_ms = median(times_us, num_runs) / 1e3;
    free(times_us);
    free(hits.list);
    return summary;
}

static void add_nees(struct passive_nees *sum, const struct passive_nees *nees)
{
    if (nees->count > 0) {
        double count = (double)sum->count, more = (double)nees->count;
        sum->mean = (sum->mean * count + nees->mean * more) / (count + more);
        sum->count += nees->count;
    }
}

static void pool_nees(struct passive_report *report)
{
    for (size_t i = 0; i < passive_num_default_cases; i++) {
        const struct passive_setting *setting = &passive_default_cases[i].setting;
        const struct passive_default_summary *summary = &report->defaults[i];
        if (setting->region != PASSIVE_EXTENSION) {
            add_nees(&report->nees, &summary->nees);
            add_nees(&report->own_nees, &summary->own_nees);
            if (setting->pd >= 1.0 && setting->false_mean <= 0.0) {
                add_nees(&report->clean_nees, &summary->nees);
            }
        }
    }
}

static void make_default(struct passive_report *report)
{
    struct batch batch = {.seed = report->seed, .num_runs = report->default_runs};
    batch.defaults =
        must_calloc(passive_num_default_cases * batch.num_runs, sizeof *batch.defaults);
    report->defaults = must_calloc(passive_num_default_cases, sizeof *report->defaults);
    workers_run(passive_num_default_cases * batch.num_runs, "runs", run_default, &batch);
    for (size_t i = 0; i < passive_num_default_cases; i++) {
        report->defaults[i] = summarise_default(
            &passive_default_cases[i], &batch.defaults[i * batch.num_runs], batch.num_runs);
    }
    pool_nees(report);
    batch_free(&batch);
}

/* ---- the report ------------------------------------------------------------------------------ */

struct passive_report *passive_report_make(const char *method, uint64_t seed, size_t num_runs)
{
    struct passive_report *report = must_calloc(1, sizeof *report);
    bool has_paper = method == NULL || strcmp(method, "passive-paper") == 0;
    bool has_default = method == NULL || strcmp(method, "passive") == 0;
    report->method = method;
    report->seed = seed;
    report->pruning_runs = num_runs > 0 ? num_runs : PRUNING_RUNS;
    make_pruning(report);
    if (has_paper) {
        report->paper_runs = num_runs > 0 ? num_runs : PAPER_RUNS;
        make_paper(report);
        passive_figures_make(report->figures);
    }
    if (has_default) {
        report->default_runs = num_runs > 0 ? num_runs : DEFAULT_RUNS;
        make_default(report);
        report->chain_runs = num_runs > 0 ? num_runs : PASSIVE_CHAIN_RUNS;
        report->chain = passive_chain_make(seed, report->chain_runs);
    }
    passive_judge(report);
    return report;
}

void passive_report_free(struct passive_report *report)
{
    verdicts_free(&report->verdicts);
    free(report->pruning);
    free(report->paper);
    free(report->defaults);
    free(report->chain);
    free(report);
}

int experiment_passive(const struct command_line *line)
{
    struct passive_report *report =
        passive_report_make(line->method, line->seed, line->runs > 0 ? (size_t)line->runs : 0);
    passive_page(report, line->output != NULL ? line->output : "build/experiment/passive");
    if (line->json) {
        json_print(passive_report_json(report));
    } else {
        passive_report_print(report);
    }
    passive_report_free(report);
    return 0;
}
