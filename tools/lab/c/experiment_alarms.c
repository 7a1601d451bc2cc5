/* SPDX-License-Identifier: MIT */
#include "experiment_alarms.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "experiment.h"
#include "experiment_alarms_page.h"
#include "poisson.h"
#include "workers.h"

#define DEFAULT_RUNS 8
#define DELAYS_A_RUN 20 /* runs of targets for each of clutter alone: they are short */

/* ---- the runs -------------------------------------------------------------------------------- */

struct experiment {
    uint64_t seed;
    size_t num_runs;
    struct alarm_result *alarms; /* by run, level and rate */
    struct delay_result *delays; /* by run, level */
    struct pipeline chains[WORKERS_MAX];
};

#define ALARM_CASES (ALARM_LEVELS * ALARM_RATES)

/* The dense cases take longest, and go first. */
static void run_one(void *context, size_t worker, size_t index)
{
    struct experiment *experiment = context;
    struct pipeline *chain = &experiment->chains[worker];
    size_t number = ALARM_CASES - 1 - index / experiment->num_runs;
    size_t run = index % experiment->num_runs;
    if (chain->tracker == NULL) {
        *chain = pipeline_start();
    }
    experiment->alarms[run * ALARM_CASES + number] =
        alarm_run(alarm_per_km2[number / ALARM_RATES], alarm_wanted_per_hour[number % ALARM_RATES],
                  experiment->seed, run, chain);
}

static void run_delays(void *context, size_t worker, size_t index)
{
    struct experiment *experiment = context;
    struct pipeline *chain = &experiment->chains[worker];
    if (chain->tracker == NULL) {
        *chain = pipeline_start();
    }
    experiment->delays[index] = delay_run(delay_per_km2[index % DELAY_LEVELS], experiment->seed,
                                          index / DELAY_LEVELS, chain);
}

static struct alarm_summary summarise_alarms(const struct experiment *experiment, size_t number)
{
    struct alarm_result sum = {0};
    for (size_t run = 0; run < experiment->num_runs; run++) {
        const struct alarm_result *result = &experiment->alarms[run * ALARM_CASES + number];
        sum.scans += result->scans;
        sum.hours += result->hours;
        sum.started += result->started;
        sum.confirmed += result->confirmed;
        sum.min_scans += result->min_scans;
        sum.confirm_nat += result->confirm_nat;
        sum.time_us += result->time_us;
    }
    return (struct alarm_summary){.per_km2 = alarm_per_km2[number / ALARM_RATES],
                                  .wanted_per_hour = alarm_wanted_per_hour[number % ALARM_RATES],
                                  .confirmed = sum.confirmed,
                                  .hours = sum.hours,
                                  .per_hour = sum.confirmed / sum.hours,
                                  .low_per_hour = poisson_low(sum.confirmed) / sum.hours,
                                  .high_per_hour = poisson_high(sum.confirmed) / sum.hours,
                                  .started_a_scan = sum.started / sum.scans,
                                  .min_scans = sum.min_scans / sum.scans,
                                  .confirm_nat = sum.confirm_nat / sum.scans,
                                  .time_us = sum.time_us / sum.scans};
}

static void add_target(struct delay_summary *summary, const struct delay_result *result,
                       size_t target)
{
    int confirmed_at = result->confirmed_at[target], possible_at = result->possible_at[target];
    summary->targets += 1.0;
    summary->third_plot += result->plots[target] <= 3;
    summary->in_time += confirmed_at <= possible_at + 1;
    summary->confirmed_at += confirmed_at;
    summary->possible_at += possible_at;
    for (int scan = 0; scan < DELAY_SCANS; scan++) {
        summary->share_at[scan] += confirmed_at <= scan + 1;
    }
}

static struct delay_summary summarise_delays(const struct experiment *experiment, size_t level)
{
    struct delay_summary summary = {.per_km2 = delay_per_km2[level]};
    for (size_t run = 0; run < experiment->num_runs * DELAYS_A_RUN; run++) {
        for (size_t target = 0; target < DELAY_TARGETS; target++) {
            add_target(&summary, &experiment->delays[run * DELAY_LEVELS + level], target);
        }
    }
    summary.third_plot /= summary.targets;
    summary.in_time /= summary.targets;
    summary.confirmed_at /= summary.targets;
    summary.possible_at /= summary.targets;
    for (size_t scan = 0; scan < DELAY_SCANS; scan++) {
        summary.share_at[scan] /= summary.targets;
    }
    return summary;
}

static struct alarm_figures measure(uint64_t seed, size_t num_runs)
{
    struct experiment experiment = {.seed = seed, .num_runs = num_runs};
    struct alarm_figures figures;
    size_t num_delays = num_runs * DELAYS_A_RUN * DELAY_LEVELS;
    experiment.alarms = must_calloc(num_runs * ALARM_CASES, sizeof *experiment.alarms);
    experiment.delays = must_calloc(num_delays, sizeof *experiment.delays);
    workers_run(num_delays, "runs with targets", run_delays, &experiment);
    workers_run(num_runs * ALARM_CASES, "runs of clutter", run_one, &experiment);
    for (size_t i = 0; i < ALARM_CASES; i++) {
        figures.alarms[i] = summarise_alarms(&experiment, i);
    }
    for (size_t i = 0; i < DELAY_LEVELS; i++) {
        figures.delays[i] = summarise_delays(&experiment, i);
    }
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        pipeline_free(&experiment.chains[i]);
    }
    free(experiment.alarms);
    free(experiment.delays);
    return figures;
}

/* ---- tables ---------------------------------------------------------------------------------- */

struct grid alarm_grid(const struct alarm_figures *figures)
{
    struct grid grid = grid_start(0, "clutter a km^2|wanted an hour|false tracks|hours|an hour|"
                                     "95 % limits|tentative a scan|M|threshold nat|us a scan");
    for (size_t i = 0; i < ALARM_CASES; i++) {
        const struct alarm_summary *of = &figures->alarms[i];
        grid_row(&grid, "%g|%g|%.0f|%.1f|%.2f|%.2f .. %.2f|%.4f|%.2f|%.2f|%.0f", of->per_km2,
                 of->wanted_per_hour, of->confirmed, of->hours, of->per_hour, of->low_per_hour,
                 of->high_per_hour, of->started_a_scan, of->min_scans, of->confirm_nat,
                 of->time_us);
    }
    return grid;
}

struct grid delay_grid(const struct alarm_figures *figures)
{
    struct grid grid =
        grid_start(0, "clutter a km^2|targets|confirmed at scan|first possible at|on the 3rd plot|"
                      "at most a scan later|by scan 12");
    for (size_t i = 0; i < DELAY_LEVELS; i++) {
        const struct delay_summary *of = &figures->delays[i];
        grid_row(&grid, "%g|%.0f|%.2f|%.2f|%.3f|%.3f|%.3f", of->per_km2, of->targets,
                 of->confirmed_at, of->possible_at, of->third_plot, of->in_time,
                 of->share_at[DELAY_SCANS - 1]);
    }
    return grid;
}

static struct verdicts judge(const struct alarm_figures *figures)
{
    struct verdicts verdicts = verdicts_start();
    for (size_t i = 0; i < ALARM_CASES; i++) {
        const struct alarm_summary *of = &figures->alarms[i];
        double ratio = of->per_hour / of->wanted_per_hour;
        if (of->wanted_per_hour < 50.0) {
            verdicts_at_most(&verdicts, ratio, 2.0,
                             "%g a km^2, %g an hour wanted: measured over it", of->per_km2,
                             of->wanted_per_hour);
            verdicts_at_least(&verdicts, ratio, 0.5,
                              "%g a km^2, %g an hour wanted: measured over it", of->per_km2,
                              of->wanted_per_hour);
        }
    }
    for (size_t i = 0; i < DELAY_LEVELS; i++) {
        const struct delay_summary *of = &figures->delays[i];
        if (of->per_km2 <= 0.0) {
            verdicts_at_least(&verdicts, of->third_plot, 0.98,
                              "clear sky: targets confirmed on their 3rd plot");
        } else if (of->per_km2 == 1.0 || of->per_km2 == 10.0) {
            verdicts_at_most(&verdicts, of->confirmed_at - of->possible_at, 1.0,
                             "%g a km^2: scans from the first possible one, mean", of->per_km2);
            verdicts_at_least(&verdicts, of->in_time, 0.95,
                              "%g a km^2: targets at most a scan after the first possible one",
                              of->per_km2);
        }
    }
    return verdicts;
}

/* ---- output ---------------------------------------------------------------------------------- */

static cJSON *alarms_json(const struct alarm_figures *figures)
{
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < ALARM_CASES; i++) {
        const struct alarm_summary *of = &figures->alarms[i];
        cJSON *object = cJSON_CreateObject();
        cJSON_AddNumberToObject(object, "clutter_per_km2", of->per_km2);
        cJSON_AddNumberToObject(object, "wanted_per_hour", of->wanted_per_hour);
        cJSON_AddNumberToObject(object, "false_tracks", of->confirmed);
        cJSON_AddNumberToObject(object, "hours", of->hours);
        cJSON_AddNumberToObject(object, "per_hour", of->per_hour);
        cJSON_AddNumberToObject(object, "started_per_scan", of->started_a_scan);
        cJSON_AddNumberToObject(object, "min_scans", of->min_scans);
        cJSON_AddNumberToObject(object, "confirm_nat", of->confirm_nat);
        cJSON_AddNumberToObject(object, "time_us", of->time_us);
        cJSON_AddItemToArray(list, object);
    }
    return list;
}

static cJSON *delays_json(const struct alarm_figures *figures)
{
    cJSON *list = cJSON_CreateArray();
    for (size_t i = 0; i < DELAY_LEVELS; i++) {
        const struct delay_summary *of = &figures->delays[i];
        cJSON *object = cJSON_CreateObject();
        cJSON_AddNumberToObject(object, "clutter_per_km2", of->per_km2);
        cJSON_AddNumberToObject(object, "targets", of->targets);
        cJSON_AddNumberToObject(object, "confirmed_at_scan", of->confirmed_at);
        cJSON_AddNumberToObject(object, "possible_at_scan", of->possible_at);
        cJSON_AddNumberToObject(object, "on_third_plot", of->third_plot);
        cJSON_AddNumberToObject(object, "at_most_one_scan_late", of->in_time);
        cJSON_AddItemToArray(list, object);
    }
    return list;
}

static void print_as_json(const struct alarm_figures *figures, struct verdicts *verdicts,
                          uint64_t seed, size_t num_runs)
{
    cJSON *root = json_experiment("false-alarms", num_runs, seed);
    cJSON_AddItemToObject(root, "clutter_alone", alarms_json(figures));
    cJSON_AddItemToObject(root, "targets", delays_json(figures));
    verdicts_to_json(verdicts, root);
    json_print(root);
}

static void print_tables(const struct alarm_figures *figures, const struct verdicts *verdicts,
                         uint64_t seed, size_t num_runs)
{
    struct grid alarms = alarm_grid(figures), delays = delay_grid(figures);
    printf("False tracks an hour, and time to confirm: %zu runs of %d scans, seed %llu\n\n",
           num_runs, ALARM_SCANS, (unsigned long long)seed);
    grid_print(&alarms, stdout);
    printf("\n");
    grid_print(&delays, stdout);
    printf("\n");
    verdicts_print(verdicts, stdout);
    grid_free(&alarms);
    grid_free(&delays);
}

int experiment_false_alarms(const struct command_line *line)
{
    size_t num_runs = line->runs > 0 ? (size_t)line->runs : DEFAULT_RUNS;
    struct alarm_figures figures = measure(line->seed, num_runs);
    struct verdicts verdicts = judge(&figures);
    alarm_page(&figures, &verdicts, num_runs, line->seed,
               line->output != NULL ? line->output : "build/experiment/false-alarms");
    if (line->json) {
        print_as_json(&figures, &verdicts, line->seed, num_runs);
    } else {
        print_tables(&figures, &verdicts, line->seed, num_runs);
    }
    verdicts_free(&verdicts);
    return 0;
}
