/* SPDX-License-Identifier: MIT */
#include "experiment_maneuver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "experiment.h"
#include "experiment_maneuver_report.h"
#include "workers.h"

/* ---- the runs -------------------------------------------------------------------------------- */

/* One run of a case: an outcome a method. */
struct job {
    const struct maneuver_case *of;
    uint64_t stream, run;
    struct maneuver_outcome *outcomes;
};

struct batch {
    uint64_t seed;
    size_t num_jobs, capacity;
    struct job *jobs;
};

static void follow_one(void *context, size_t worker, size_t index)
{
    const struct batch *batch = context;
    const struct job *job = &batch->jobs[index];
    struct maneuver_scene scene;
    (void)worker;
    maneuver_scene_draw(&scene, &job->of->setting, batch->seed, job->stream, job->run);
    for (size_t method = 0; method < job->of->num_methods; method++) {
        struct maneuver_trace trace;
        maneuver_follow(&trace, &scene, &job->of->methods[method]);
        job->outcomes[method] = maneuver_outcome_of(&trace, &scene);
    }
}

static void add_jobs(struct batch *batch, const struct maneuver_table *table)
{
    for (size_t i = 0; i < table->num_cases; i++) {
        const struct maneuver_case *of = &table->cases[i];
        struct maneuver_outcome *outcomes =
            must_calloc(table->runs[i] * of->num_methods, sizeof *outcomes);
        for (size_t run = 0; run < table->runs[i]; run++) {
            batch->jobs =
                must_grow(batch->jobs, batch->num_jobs, &batch->capacity, sizeof *batch->jobs);
            batch->jobs[batch->num_jobs++] =
                (struct job){of, table->stream + i, run, outcomes + run * of->num_methods};
        }
    }
}

/* A case's first run has the memory of all. */
static void batch_free(struct batch *batch)
{
    for (size_t i = 0; i < batch->num_jobs; i++) {
        if (batch->jobs[i].run == 0) {
            free(batch->jobs[i].outcomes);
        }
    }
    free(batch->jobs);
}

/* ---- figures --------------------------------------------------------------------------------- */

static int compare_doubles(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return (values[(count - 1) / 2] + values[count / 2]) / 2.0;
}

static void summarise_extremes(struct maneuver_summary *summary,
                               const struct maneuver_outcome *outcomes, size_t runs, size_t stride)
{
    double *least = must_calloc(runs, sizeof *least), *most = must_calloc(runs, sizeof *most);
    for (size_t i = 0; i < runs; i++) {
        least[i] = outcomes[i * stride].least_mps;
        most[i] = outcomes[i * stride].most_mps;
        summary->most_off_m = fmax(summary->most_off_m, outcomes[i * stride].most_off_m);
    }
    summary->least_mps = median(least, runs);
    summary->most_mps = median(most, runs);
    free(least);
    free(most);
}

static void summarise_all(struct maneuver_summary *summary, const struct maneuver_outcome *outcomes,
                          size_t runs, size_t stride)
{
    size_t inside = 0, first_inside = 0, lost = 0, wrong = 0, scans = 0;
    size_t first = runs < MANEUVER_FIRST_RUNS ? runs : MANEUVER_FIRST_RUNS;
    for (size_t i = 0; i < runs; i++) {
        const struct maneuver_outcome *is = &outcomes[i * stride];
        inside += is->is_inside;
        first_inside += is->is_inside && i < first;
        lost += is->is_lost;
        wrong += is->wrong;
        scans += is->scans;
        summary->rms_m += is->square_m2;
        summary->rms_mps += is->square_mps2;
        summary->hypotheses += is->hypotheses / (double)runs;
        summary->refused += is->refused;
    }
    summary->inside = (double)inside / (double)runs;
    summary->first_inside = (double)first_inside / (double)first;
    summary->lost = (double)lost / (double)runs;
    summary->wrong = (double)wrong / (double)scans;
    summary->rms_m = sqrt(summary->rms_m / (double)runs);
    summary->rms_mps = sqrt(summary->rms_mps / (double)runs);
}

static void summarise_kept(struct maneuver_summary *summary,
                           const struct maneuver_outcome *outcomes,
                           const struct maneuver_outcome *imm, size_t runs, size_t stride)
{
    double square_m2 = 0.0, square_mps2 = 0.0, imm_m2 = 0.0, imm_mps2 = 0.0, nis = 0.0;
    size_t kept = 0, nis_count = 0;
    for (size_t i = 0; i < runs; i++) {
        const struct maneuver_outcome *is = &outcomes[i * stride];
        if (!is->is_lost) {
            kept++;
            square_m2 += is->square_m2;
            square_mps2 += is->square_mps2;
            imm_m2 += imm != NULL ? imm[i * stride].square_m2 : NAN;
            imm_mps2 += imm != NULL ? imm[i * stride].square_mps2 : NAN;
            nis += is->nis_sum;
            nis_count += is->nis_count;
        }
    }
    summary->kept_rms_m = sqrt(square_m2 / (double)kept);
    summary->kept_rms_mps = sqrt(square_mps2 / (double)kept);
    summary->imm_ratio = sqrt(square_m2 / imm_m2);
    summary->imm_speed_ratio = sqrt(square_mps2 / imm_mps2);
    summary->nis = nis / (double)nis_count;
}

struct maneuver_summary maneuver_summarise(const struct maneuver_outcome *outcomes,
                                           const struct maneuver_outcome *imm, size_t runs,
                                           size_t stride)
{
    struct maneuver_summary summary = {.inside = 0.0};
    summarise_all(&summary, outcomes, runs, stride);
    summarise_extremes(&summary, outcomes, runs, stride);
    summarise_kept(&summary, outcomes, imm, runs, stride);
    return summary;
}

/* ---- tables ---------------------------------------------------------------------------------- */

static struct maneuver_table table_start(const struct maneuver_case *cases, size_t num_cases,
                                         uint64_t stream, size_t num_runs)
{
    struct maneuver_table table = {.cases = cases, .num_cases = num_cases, .stream = stream};
    table.runs = must_calloc(num_cases, sizeof *table.runs);
    table.by_method = must_calloc(num_cases, sizeof *table.by_method);
    for (size_t i = 0; i < num_cases; i++) {
        table.runs[i] = num_runs > 0 ? num_runs : cases[i].runs;
    }
    return table;
}

static const struct maneuver_outcome *imm_of(const struct maneuver_case *of,
                                             const struct maneuver_outcome *outcomes)
{
    for (size_t method = 0; method < of->num_methods; method++) {
        if (of->methods[method].kind == MANEUVER_TRUE_IMM) {
            return outcomes + method;
        }
    }
    return NULL;
}

/* jobs: the table's own, as they were added. Returns those behind. */
static struct job *table_fill(struct maneuver_table *table, struct job *jobs)
{
    for (size_t i = 0; i < table->num_cases; i++) {
        const struct maneuver_case *of = &table->cases[i];
        struct maneuver_outcome *outcomes = jobs->outcomes;
        for (size_t method = 0; method < of->num_methods; method++) {
            table->by_method[i][method] = maneuver_summarise(
                outcomes + method, imm_of(of, outcomes), table->runs[i], of->num_methods);
        }
        jobs += table->runs[i];
    }
    return jobs;
}

static void table_free(struct maneuver_table *table)
{
    free(table->runs);
    free(table->by_method);
}

/* ---- the report ------------------------------------------------------------------------------ */

struct maneuver_report *maneuver_report_make(uint64_t seed, size_t num_runs)
{
    struct maneuver_report *report = must_calloc(1, sizeof *report);
    struct batch batch = {.seed = seed};
    report->seed = seed;
    report->paper = table_start(maneuver_paper_cases, maneuver_num_paper_cases,
                                MANEUVER_PAPER_STREAM, num_runs);
    report->noise = table_start(&maneuver_noise_case, 1, MANEUVER_NOISE_STREAM, num_runs);
    report->closed = table_start(maneuver_closed_cases, maneuver_num_closed_cases,
                                 MANEUVER_CLOSED_STREAM, num_runs);
    report->pd = table_start(&maneuver_pd_case, 1, MANEUVER_PD_STREAM, num_runs);
    struct maneuver_table *tables[] = {&report->paper, &report->noise, &report->closed,
                                       &report->pd};
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
        add_jobs(&batch, tables[i]);
    }
    workers_run(batch.num_jobs, "runs", follow_one, &batch);
    struct job *jobs = batch.jobs;
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
        jobs = table_fill(tables[i], jobs);
    }
    batch_free(&batch);
    maneuver_judge(report);
    return report;
}

void maneuver_report_free(struct maneuver_report *report)
{
    verdicts_free(&report->verdicts);
    table_free(&report->paper);
    table_free(&report->noise);
    table_free(&report->closed);
    table_free(&report->pd);
    free(report);
}

int experiment_maneuver(const struct command_line *line)
{
    struct maneuver_report *report =
        maneuver_report_make(line->seed, line->runs > 0 ? (size_t)line->runs : 0);
    maneuver_page(report, line->output != NULL ? line->output : "build/experiment/maneuver");
    if (line->json) {
        json_print(maneuver_report_json(report));
    } else {
        maneuver_report_print(report);
    }
    maneuver_report_free(report);
    return 0;
}
