/* SPDX-License-Identifier: MIT */
/* experiment_air_traffic_measure: all runs of all parts on all cores, and their means. */
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment_air_traffic.h"
#include "poisson.h"
#include "workers.h"

#define PAIR_RUNS 25 /* for each of the experiment's */

/* ---- jobs ------------------------------------------------------------------------------------ */

/* A run of a case. */
struct job {
    size_t of, run;
};

struct jobs {
    uint64_t seed;
    size_t count;
    struct job *list;
    struct air_result *traffic;
    struct air_pair_result *pairs;
    struct air_alarm_result *alarms;
    struct pipeline chains[WORKERS_MAX];
};

static struct pipeline *chain_of(struct jobs *jobs, size_t worker)
{
    struct pipeline *chain = &jobs->chains[worker];

    if (chain->tracker == NULL) {
        *chain = pipeline_start();
    }
    return chain;
}

static void run_traffic(void *context, size_t worker, size_t index)
{
    struct jobs *jobs = context;
    const struct job *job = &jobs->list[index];

    jobs->traffic[index] =
        air_run(&air_cases[job->of], jobs->seed, job->run, chain_of(jobs, worker));
}

static void run_pair(void *context, size_t worker, size_t index)
{
    struct jobs *jobs = context;

    jobs->pairs[index] = air_pair_run(&air_pairs[index % AIR_PAIRS], jobs->seed, index / AIR_PAIRS,
                                      chain_of(jobs, worker));
}

/* The densest take longest, and go first. */
static void run_alarm(void *context, size_t worker, size_t index)
{
    struct jobs *jobs = context;
    size_t runs = jobs->count / AIR_ALARMS, of = AIR_ALARMS - 1 - index / runs;

    jobs->alarms[of * runs + index % runs] =
        air_alarm_run(&air_alarms[of], jobs->seed, index % runs, chain_of(jobs, worker));
}

static void free_chains(struct jobs *jobs)
{
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        pipeline_free(&jobs->chains[i]);
    }
}

/* ---- means ----------------------------------------------------------------------------------- */

static void add_result(struct air_result *sum, const struct air_result *of)
{
    for (size_t i = 0; i < AIR_CUTOFFS; i++) {
        air_figures_add(&sum->tracks[i], &of->tracks[i]);
        air_figures_add(&sum->limit[i], &of->limit[i]);
    }
    if (sum->us <= 0.0 || of->us < sum->us) {
        sum->us = of->us;
        sum->max_us = of->max_us;
    }
    sum->plots += of->plots;
    sum->min_scans += of->min_scans;
    sum->false_tracks += of->false_tracks;
    sum->hours += of->hours;
    sum->alarms += of->alarms;
    sum->alarm_hours += of->alarm_hours;
    for (size_t i = 0; i < AIR_FOUND_SCANS; i++) {
        sum->alive[i] += of->alive[i];
        sum->found[i] += of->found[i];
    }
}

static struct air_result mean_of(const struct jobs *jobs, size_t of)
{
    struct air_result mean = {.us = 0.0};
    double runs = 0.0;

    for (size_t i = 0; i < jobs->count; i++) {
        if (jobs->list[i].of == of) {
            add_result(&mean, &jobs->traffic[i]);
            runs += 1.0;
        }
    }
    if (runs > 0.0) {
        for (size_t i = 0; i < AIR_CUTOFFS; i++) {
            air_figures_divide(&mean.tracks[i], runs);
            air_figures_divide(&mean.limit[i], runs);
        }
        mean.plots /= runs;
        mean.min_scans /= runs;
    }
    return mean;
}

/* ---- the parts ------------------------------------------------------------------------------- */

static bool is_wanted(const struct air_case *of, unsigned parts)
{
    static const unsigned part_of[] = {[AIR_GRID] = AIR_PART_GRID,
                                       [AIR_STRESS] = AIR_PART_STRESS,
                                       [AIR_OPERATION] = AIR_PART_OPERATION};

    return (parts & part_of[of->group]) != 0;
}

static size_t runs_of(const struct air_case *of, size_t num_runs)
{
    return num_runs / of->share > 0 ? num_runs / of->share : 1;
}

/* The last cases of the grid are the largest, and go first. */
static void list_jobs(struct jobs *jobs, unsigned parts, size_t num_runs)
{
    jobs->list = must_calloc(air_num_cases() * num_runs + 1, sizeof *jobs->list);
    for (size_t i = air_num_cases(); i-- > 0;) {
        for (size_t run = 0;
             is_wanted(&air_cases[i], parts) && run < runs_of(&air_cases[i], num_runs); run++) {
            jobs->list[jobs->count++] = (struct job){i, run};
        }
    }
}

static void measure_traffic(struct air_report *report)
{
    struct jobs jobs = {.seed = report->seed};

    list_jobs(&jobs, report->parts, report->num_runs);
    report->results = must_calloc(air_num_cases(), sizeof *report->results);
    jobs.traffic = must_calloc(jobs.count + 1, sizeof *jobs.traffic);
    workers_run(jobs.count, "runs of traffic", run_traffic, &jobs);
    for (size_t i = 0; i < air_num_cases(); i++) {
        report->results[i] = mean_of(&jobs, i);
    }
    free_chains(&jobs);
    free(jobs.traffic);
    free(jobs.list);
}

static void measure_pairs(struct air_report *report)
{
    struct jobs jobs = {.seed = report->seed};
    double runs = (double)(report->num_runs * PAIR_RUNS);

    report->pair_runs = report->num_runs * PAIR_RUNS;
    jobs.pairs = must_calloc(report->pair_runs * AIR_PAIRS, sizeof *jobs.pairs);
    workers_run(report->pair_runs * AIR_PAIRS, "runs of pairs", run_pair, &jobs);
    for (size_t i = 0; i < report->pair_runs * AIR_PAIRS; i++) {
        struct air_pair_result *mean = &report->pairs[i % AIR_PAIRS];
        mean->kept += jobs.pairs[i].kept / runs;
        mean->lost += jobs.pairs[i].lost / runs;
        mean->switches += jobs.pairs[i].switches / runs;
        mean->completeness += jobs.pairs[i].completeness / runs;
    }
    free_chains(&jobs);
    free(jobs.pairs);
}

static struct air_alarm_result sum_alarms(const struct air_alarm_result *runs, size_t num_runs)
{
    struct air_alarm_result sum = {0};

    for (size_t i = 0; i < num_runs; i++) {
        sum.scans += runs[i].scans;
        sum.hours += runs[i].hours;
        sum.confirmed += runs[i].confirmed;
        sum.us = i == 0 ? runs[i].us : fmin(sum.us, runs[i].us);
        sum.min_scans += runs[i].min_scans / (double)num_runs;
    }
    sum.low_per_hour = poisson_low(sum.confirmed) / sum.hours;
    sum.high_per_hour = poisson_high(sum.confirmed) / sum.hours;
    return sum;
}

static void measure_alarms(struct air_report *report)
{
    struct jobs jobs = {.seed = report->seed, .count = report->num_runs * AIR_ALARMS};

    jobs.alarms = must_calloc(jobs.count, sizeof *jobs.alarms);
    workers_run(jobs.count, "runs of clutter", run_alarm, &jobs);
    for (size_t i = 0; i < AIR_ALARMS; i++) {
        report->alarms[i] = sum_alarms(&jobs.alarms[i * report->num_runs], report->num_runs);
    }
    free_chains(&jobs);
    free(jobs.alarms);
}

static void measure_rivals(struct air_report *report, const char *folder)
{
    struct pipeline chain = pipeline_start();

    report->rivals = air_rivals_run(report->seed, report->num_runs, folder, &chain);
    pipeline_free(&chain);
}

struct air_report air_measure(uint64_t seed, size_t num_runs, unsigned parts, const char *folder)
{
    struct air_report report = {.seed = seed, .num_runs = num_runs, .parts = parts};

    if ((parts & (AIR_PART_GRID | AIR_PART_STRESS | AIR_PART_OPERATION)) != 0) {
        measure_traffic(&report);
    }
    if ((parts & AIR_PART_PAIRS) != 0) {
        measure_pairs(&report);
    }
    if ((parts & AIR_PART_CLUTTER) != 0) {
        measure_alarms(&report);
    }
    if ((parts & AIR_PART_RIVALS) != 0) {
        measure_rivals(&report, folder);
    }
    return report;
}

void air_report_free(struct air_report *report)
{
    free(report->results);
    verdicts_free(&report->verdicts);
}
