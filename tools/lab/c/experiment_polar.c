/* SPDX-License-Identifier: MIT */
#include "experiment_polar.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "experiment.h"
#include "experiment_polar_page.h"
#include "verdicts.h"
#include "workers.h"

#define DEFAULT_RUNS 200

/* ---- the runs -------------------------------------------------------------------------------- */

struct experiment {
    uint64_t seed;
    size_t num_runs;
    struct polar_result *results; /* by level, run, case */
    struct pipeline chains[WORKERS_MAX];
};

/* One run's data go through all cases. */
static void run_one(void *context, size_t worker, size_t index)
{
    struct experiment *experiment = context;
    size_t level = index / experiment->num_runs, run = index % experiment->num_runs;
    struct parameters parameters;
    struct simulation *simulation =
        polar_simulation(polar_clutter[level], 0.0, experiment->seed, run, &parameters);
    if (experiment->chains[worker].tracker == NULL) {
        experiment->chains[worker] = pipeline_start();
    }
    for (size_t i = 0; i < POLAR_CASES; i++) {
        experiment->results[index * POLAR_CASES + i] =
            polar_run(&polar_cases[i], &parameters, simulation, &experiment->chains[worker]);
    }
    simulation_free(simulation);
}

static void add_errors(struct polar_errors *sum, const struct polar_errors *errors)
{
    for (size_t turn = 0; turn < POLAR_TURNS_MAX; turn++) {
        sum->sum_m2[turn] += errors->sum_m2[turn];
        sum->along_m2[turn] += errors->along_m2[turn];
        sum->reference_m2[turn] += errors->reference_m2[turn];
        sum->sum_m2ps2[turn] += errors->sum_m2ps2[turn];
        sum->count[turn] += errors->count[turn];
    }
}

static void add(struct polar_result *sum, const struct polar_result *result)
{
    sum->targets += result->targets;
    sum->found += result->found;
    sum->clairvoyant += result->clairvoyant;
    sum->false_candidates += result->false_candidates;
    sum->found_m += result->found_m;
    sum->search_us += result->search_us;
    sum->tracked += result->tracked;
    sum->false_tracks += result->false_tracks;
    sum->confirm_at += result->confirm_at;
    sum->confirmed += result->confirmed;
    add_errors(&sum->errors, &result->errors);
}

static double rms(const double *sums_m2, const size_t *counts)
{
    double sum_m2 = 0.0, count = 0.0;
    for (size_t turn = 0; turn < POLAR_TURNS_MAX; turn++) {
        sum_m2 += sums_m2[turn];
        count += (double)counts[turn];
    }
    return sqrt(sum_m2 / count);
}

static struct polar_summary summarise(const struct experiment *experiment, size_t level,
                                      size_t number)
{
    struct polar_result sum = {0};
    double runs = (double)experiment->num_runs;
    for (size_t run = 0; run < experiment->num_runs; run++) {
        size_t index = level * experiment->num_runs + run;
        add(&sum, &experiment->results[index * POLAR_CASES + number]);
    }
    return (struct polar_summary){
        .of = &polar_cases[number],
        .clutter = polar_clutter[level],
        .found = sum.found / (double)sum.targets,
        .clairvoyant = sum.clairvoyant / (double)sum.targets,
        .false_a_run = sum.false_candidates / runs,
        .found_m = sum.found_m / sum.found,
        .search_ms = sum.search_us / runs / 1e3,
        .tracked = sum.tracked / (double)sum.targets,
        .false_tracks_a_run = sum.false_tracks / runs,
        .confirm_at = sum.confirm_at / sum.confirmed,
        .rmse_m = rms(sum.errors.sum_m2, sum.errors.count),
        .along_m = rms(sum.errors.along_m2, sum.errors.count),
        .reference_m = rms(sum.errors.reference_m2, sum.errors.count),
        .errors = sum.errors,
    };
}

struct polar_summary *polar_summaries(uint64_t seed, size_t num_runs)
{
    struct polar_summary *summaries = must_calloc(POLAR_SUMMARIES, sizeof *summaries);
    struct experiment experiment = {.seed = seed, .num_runs = num_runs};
    experiment.results =
        must_calloc(POLAR_LEVELS * num_runs * POLAR_CASES, sizeof *experiment.results);
    workers_run(POLAR_LEVELS * num_runs, "runs", run_one, &experiment);
    for (size_t i = 0; i < POLAR_SUMMARIES; i++) {
        summaries[i] = summarise(&experiment, i / POLAR_CASES, i % POLAR_CASES);
    }
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        pipeline_free(&experiment.chains[i]);
    }
    free(experiment.results);
    return summaries;
}

/* ---- tables ---------------------------------------------------------------------------------- */

struct grid polar_initiation_grid(const struct polar_summary *summaries)
{
    struct grid grid = grid_start(
        1, "initiation from 7 turns|clutter a turn|Pd|clairvoyant Pd|false a run|error m|ms");
    for (size_t i = 0; i < POLAR_SUMMARIES; i++) {
        const struct polar_summary *of = &summaries[i];
        grid_row(&grid, "%s|%g|%.3f|%.3f|%.3f|%.0f|%.2f", of->of->name, of->clutter, of->found,
                 of->clairvoyant, of->false_a_run, of->found_m, of->search_ms);
    }
    return grid;
}

struct grid polar_tracks_grid(const struct polar_summary *summaries)
{
    struct grid grid =
        grid_start(1, "tracks over 15 turns|clutter a turn|tracked at the end|"
                      "confirmed at turn|false a run|along m|rmse m|in double m|ratio");
    for (size_t i = 0; i < POLAR_SUMMARIES; i++) {
        const struct polar_summary *of = &summaries[i];
        grid_row(&grid, "%s|%g|%.3f|%.2f|%.3f|%.1f|%.1f|%.1f|%.3f", of->of->name, of->clutter,
                 of->tracked, of->confirm_at, of->false_tracks_a_run, of->along_m, of->rmse_m,
                 of->reference_m, of->rmse_m / of->reference_m);
    }
    return grid;
}

static void judge_own(struct verdicts *verdicts, const struct polar_summary *of)
{
    const char *name = of->of->name;
    verdicts_at_most(verdicts, of->rmse_m / of->reference_m, 1.03,
                     "%s, %g a turn: rmse over the double filter's", name, of->clutter);
    if (of->clutter < 500.0) {
        verdicts_at_most(verdicts, of->clairvoyant - of->found, 0.02,
                         "%s, %g a turn: Pd behind the clairvoyant fit", name, of->clutter);
        verdicts_at_most(verdicts, of->false_a_run, 0.05, "%s, %g a turn: false candidates a run",
                         name, of->clutter);
        verdicts_at_most(verdicts, of->false_tracks_a_run, 0.05,
                         "%s, %g a turn: false tracks a run", name, of->clutter);
    } else if (of->of->has_range_rate) {
        verdicts_at_least(verdicts, of->found, 0.95, "%s, %g a turn: Pd", name, of->clutter);
        verdicts_at_least(verdicts, of->tracked, 0.95, "%s, %g a turn: tracked at the end", name,
                          of->clutter);
        verdicts_at_most(verdicts, of->false_a_run, 0.1, "%s, %g a turn: false candidates a run",
                         name, of->clutter);
        verdicts_at_most(verdicts, of->false_tracks_a_run, 0.1, "%s, %g a turn: false tracks a run",
                         name, of->clutter);
    }
}

struct verdicts polar_verdicts(const struct polar_summary *summaries)
{
    struct verdicts verdicts = verdicts_start();
    for (size_t i = 0; i < POLAR_SUMMARIES; i++) {
        if (!summaries[i].of->is_isotropic) {
            judge_own(&verdicts, &summaries[i]);
        }
    }
    return verdicts;
}

/* ---- output ---------------------------------------------------------------------------------- */

static cJSON *summary_json(const struct polar_summary *of)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "case", of->of->name);
    cJSON_AddNumberToObject(object, "clutter_per_scan", of->clutter);
    cJSON_AddNumberToObject(object, "pd", of->found);
    cJSON_AddNumberToObject(object, "clairvoyant_pd", of->clairvoyant);
    cJSON_AddNumberToObject(object, "false_candidates_per_run", of->false_a_run);
    cJSON_AddNumberToObject(object, "candidate_error_m", of->found_m);
    cJSON_AddNumberToObject(object, "search_ms", of->search_ms);
    cJSON_AddNumberToObject(object, "tracked_at_end", of->tracked);
    cJSON_AddNumberToObject(object, "confirmed_at_turn", of->confirm_at);
    cJSON_AddNumberToObject(object, "false_tracks_per_run", of->false_tracks_a_run);
    cJSON_AddNumberToObject(object, "rmse_m", of->rmse_m);
    cJSON_AddNumberToObject(object, "along_rmse_m", of->along_m);
    cJSON_AddNumberToObject(object, "double_filter_rmse_m", of->reference_m);
    return object;
}

static void print_as_json(const struct polar_summary *summaries, struct verdicts *verdicts,
                          uint64_t seed, size_t num_runs)
{
    cJSON *root = json_experiment("polar", num_runs, seed);
    cJSON *list = cJSON_AddArrayToObject(root, "cases");
    for (size_t i = 0; i < POLAR_SUMMARIES; i++) {
        cJSON_AddItemToArray(list, summary_json(&summaries[i]));
    }
    verdicts_to_json(verdicts, root);
    json_print(root);
}

static void print_tables(const struct polar_summary *summaries, const struct verdicts *verdicts,
                         uint64_t seed, size_t num_runs)
{
    struct grid initiation = polar_initiation_grid(summaries);
    struct grid tracks = polar_tracks_grid(summaries);
    printf("A turning radar, 15 m and 3 mrad, 4 s a turn: %zu runs, seed %llu\n\n", num_runs,
           (unsigned long long)seed);
    grid_print(&initiation, stdout);
    printf("\n");
    grid_print(&tracks, stdout);
    printf("\n");
    verdicts_print(verdicts, stdout);
    grid_free(&initiation);
    grid_free(&tracks);
}

int experiment_polar(const struct command_line *line)
{
    size_t num_runs = line->runs > 0 ? (size_t)line->runs : DEFAULT_RUNS;
    struct polar_summary *summaries = polar_summaries(line->seed, num_runs);
    struct verdicts verdicts = polar_verdicts(summaries);
    polar_page(summaries, &verdicts, num_runs, line->seed,
               line->output != NULL ? line->output : "build/experiment/polar");
    if (line->json) {
        print_as_json(summaries, &verdicts, line->seed, num_runs);
    } else {
        print_tables(summaries, &verdicts, line->seed, num_runs);
    }
    verdicts_free(&verdicts);
    free(summaries);
    return 0;
}
