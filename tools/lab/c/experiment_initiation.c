/* SPDX-License-Identifier: MIT */
#include "experiment_initiation.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/grid.h"
#include "experiment.h"
#include "experiment_classic.h"
#include "experiment_initiation_page.h"
#include "workers.h"

#define DEFAULT_RUNS 200
#define WORK_SEEDS_MAX 60000.0
#define WORK_LOOKUPS_MAX 110000.0
#define WORK_DISTANCES_MAX 50000.0

/* ---- the runs -------------------------------------------------------------------------------- */

struct experiment {
    uint64_t seed;
    size_t num_runs; /* of each case */
    struct initiation_run *runs;
    struct rho_initiator *initiators[WORKERS_MAX];
};

static void run_one(void *context, size_t worker, size_t index)
{
    struct experiment *experiment = context;
    size_t number = index / experiment->num_runs;
    struct random random = random_start(experiment->seed, number, index % experiment->num_runs);
    if (experiment->initiators[worker] == NULL) {
        experiment->initiators[worker] = must_alloc(sizeof **experiment->initiators);
    }
    experiment->runs[index] =
        initiation_run(initiation_case_at(number), experiment->initiators[worker], &random);
}

struct initiation_summary *initiation_summaries(uint64_t seed, size_t num_runs)
{
    size_t num_cases = initiation_num_cases();
    struct initiation_summary *summaries = must_calloc(num_cases, sizeof *summaries);
    struct experiment experiment = {.seed = seed, .num_runs = num_runs};
    experiment.runs = must_calloc(num_cases * num_runs, sizeof *experiment.runs);
    workers_run(num_cases * num_runs, "runs", run_one, &experiment);
    for (size_t i = 0; i < num_cases; i++) {
        summaries[i] =
            initiation_summarise(initiation_case_at(i), &experiment.runs[i * num_runs], num_runs);
    }
    for (size_t i = 0; i < WORKERS_MAX; i++) {
        free(experiment.initiators[i]);
    }
    free(experiment.runs);
    return summaries;
}

/* ---- tables ---------------------------------------------------------------------------------- */

/* "0.995", or "" where there is none. */
static const char *number(char text[32], int digits, double value)
{
    snprintf(text, 32, "%.*f", digits, value);
    return isnan(value) ? "" : text;
}

static const char *bars_text(char text[64], const struct initiation_case *of)
{
    text[0] = '\0';
    if (!isnan(of->bars.found_min)) {
        snprintf(text, 64, "%s >= %g", of->all_count ? "all" : "Pd", of->bars.found_min);
    }
    return text;
}

static const char *verdict_text(const struct initiation_summary *summary)
{
    struct initiation_verdict verdicts[3];
    size_t count = initiation_verdicts(summary, verdicts);
    for (size_t i = 0; i < count; i++) {
        if (!verdicts[i].is_held) {
            return "MISSED";
        }
    }
    return count == 0 ? "-" : "ok";
}

struct grid initiation_grid(const struct initiation_summary *summaries, size_t count)
{
    struct grid grid = grid_start(
        2, "bar|case|Pd|all found|must be|clairvoyant Pd|false a run|at most|error m|ms|verdict");
    for (size_t i = 0; i < count; i++) {
        const struct initiation_summary *of = &summaries[i];
        char pd[32], all[32], clairvoyant[32], at_most[32], error[32], bars[64];
        at_most[0] = '\0';
        if (!isnan(of->of->bars.false_max)) {
            snprintf(at_most, sizeof at_most, "%g", of->of->bars.false_max);
        }
        grid_row(&grid, "%s|%s|%s|%s|%s|%s|%.3f|%s|%s|%.2f|%s", of->of->group, of->of->name,
                 number(pd, 3, of->pd), number(all, 3, of->all_found), bars_text(bars, of->of),
                 number(clairvoyant, 3, of->clairvoyant), of->false_a_run, at_most,
                 number(error, 1, of->error_m), of->time_us / 1e3, verdict_text(of));
    }
    return grid;
}

/*
 * The work figures are judged at 100 clutter plots a scan in 10 km^2: Table 1, 10/km^2, P_D 0.99.
 */
static const struct initiation_summary *work_case(const struct initiation_summary *summaries)
{
    for (size_t i = 0; i < initiation_num_cases(); i++) {
        const struct initiation_case *of = summaries[i].of;
        if (of->paths == PATHS_CROSSING && of->clutter_per_km2 == 10.0 && of->true_pd == 0.99) {
            return &summaries[i];
        }
    }
    return &summaries[0];
}

size_t initiation_work(const struct initiation_summary *summaries,
                       struct initiation_verdict verdicts[3])
{
    const struct initiation_summary *of = work_case(summaries);
    verdicts[0] = (struct initiation_verdict){"seeds", of->seeds, WORK_SEEDS_MAX,
                                              of->seeds <= WORK_SEEDS_MAX};
    verdicts[1] = (struct initiation_verdict){"look-ups", of->lookups, WORK_LOOKUPS_MAX,
                                              of->lookups <= WORK_LOOKUPS_MAX};
    verdicts[2] = (struct initiation_verdict){"distances", of->distances, WORK_DISTANCES_MAX,
                                              of->distances <= WORK_DISTANCES_MAX};
    return 3;
}

struct grid initiation_work_grid(const struct initiation_summary *summaries)
{
    const struct initiation_summary *of = work_case(summaries);
    const double most[3] = {of->seeds_max, of->lookups_max, of->distances_max};
    struct initiation_verdict verdicts[3];
    struct grid grid =
        grid_start(1, "work a window, 100 clutter plots a scan|mean|most|mean at most|verdict");
    size_t count = initiation_work(summaries, verdicts);
    for (size_t i = 0; i < count; i++) {
        grid_row(&grid, "%s|%.0f|%.0f|%.0f|%s", verdicts[i].what, verdicts[i].value, most[i],
                 verdicts[i].bar, verdicts[i].is_held ? "ok" : "MISSED");
    }
    grid_row(&grid, "least-squares fits|%.0f|||", of->fits);
    return grid;
}

struct initiation_score initiation_score(const struct initiation_summary *summaries)
{
    struct initiation_score score = {0};
    for (size_t i = 0; i <= initiation_num_cases(); i++) {
        struct initiation_verdict verdicts[3];
        size_t count = i < initiation_num_cases() ? initiation_verdicts(&summaries[i], verdicts)
                                                  : initiation_work(summaries, verdicts);
        for (size_t j = 0; j < count; j++) {
            score.held += verdicts[j].is_held;
            score.missed += !verdicts[j].is_held;
        }
    }
    return score;
}

/* ---- output ---------------------------------------------------------------------------------- */

static void add_number(cJSON *object, const char *name, double value)
{
    if (isnan(value)) {
        cJSON_AddNullToObject(object, name);
    } else {
        cJSON_AddNumberToObject(object, name, value);
    }
}

static cJSON *case_json(const struct initiation_summary *summary)
{
    const struct initiation_case *of = summary->of;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "bar", of->group);
    cJSON_AddStringToObject(object, "case", of->name);
    add_number(object, "pd", summary->pd);
    add_number(object, "all_found", summary->all_found);
    cJSON_AddStringToObject(object, "found_min_counts", of->all_count ? "all_found" : "pd");
    add_number(object, "found_min", of->bars.found_min);
    add_number(object, "clairvoyant_pd", summary->clairvoyant);
    add_number(object, "behind_max", of->bars.behind_max);
    add_number(object, "false_per_run", summary->false_a_run);
    add_number(object, "false_max", of->bars.false_max);
    add_number(object, "error_m", summary->error_m);
    add_number(object, "time_us", summary->time_us);
    cJSON_AddStringToObject(object, "verdict", verdict_text(summary));
    return object;
}

static void add_bars(cJSON *root, const struct initiation_summary *summaries)
{
    struct initiation_verdict work[3];
    cJSON *list = cJSON_AddArrayToObject(root, "cases");
    cJSON *work_json = cJSON_AddObjectToObject(root, "work");
    size_t num_work = initiation_work(summaries, work);
    for (size_t i = 0; i < initiation_num_cases(); i++) {
        cJSON_AddItemToArray(list, case_json(&summaries[i]));
    }
    for (size_t i = 0; i < num_work; i++) {
        cJSON_AddNumberToObject(work_json, work[i].what, work[i].value);
    }
}

/* Both parts together; either may be NULL. */
static struct initiation_score score_of(const struct initiation_summary *summaries,
                                        const struct classic_report *paper)
{
    struct initiation_score score = {0, 0};
    if (summaries != NULL) {
        score = initiation_score(summaries);
    }
    if (paper != NULL) {
        score.held += paper->held;
        score.missed += paper->missed;
    }
    return score;
}

static void print_json(const struct initiation_summary *summaries,
                       const struct classic_report *paper, const struct command_line *line,
                       size_t num_runs)
{
    struct initiation_score score = score_of(summaries, paper);
    cJSON *root = cJSON_CreateObject();
    if (summaries != NULL) {
        add_bars(root, summaries);
    }
    if (paper != NULL) {
        classic_json(paper, root);
    }
    cJSON_AddStringToObject(root, "experiment", "initiation");
    cJSON_AddStringToObject(root, "method", line->method != NULL ? line->method : "all");
    cJSON_AddNumberToObject(root, "runs", (double)num_runs);
    cJSON_AddNumberToObject(root, "seed", (double)line->seed);
    cJSON_AddNumberToObject(root, "bars_held", score.held);
    cJSON_AddNumberToObject(root, "bars_missed", score.missed);
    json_print(root);
}

static void print_bars(const struct initiation_summary *summaries, const struct command_line *line,
                       size_t num_runs)
{
    struct grid grid = initiation_grid(summaries, initiation_num_cases());
    struct grid work = initiation_work_grid(summaries);
    printf("Track initiation, method kernel: %zu runs a case, seed %llu\n\n", num_runs,
           (unsigned long long)line->seed);
    grid_print(&grid, stdout);
    printf("\n");
    grid_print(&work, stdout);
    printf("\n");
    grid_free(&work);
    grid_free(&grid);
}

static void print_tables(const struct initiation_summary *summaries,
                         const struct classic_report *paper, const struct command_line *line,
                         size_t num_runs)
{
    struct initiation_score score = score_of(summaries, paper);
    if (paper != NULL) {
        classic_print(paper);
    }
    if (summaries != NULL) {
        print_bars(summaries, line, num_runs);
    }
    printf("%d bars held, %d missed\n", score.held, score.missed);
}

/*
 * The kernel's bars, the paper's experiments with one method, or, where no method is named, all of
 * it.
 */
int experiment_initiation(const struct command_line *line)
{
    size_t num_runs = line->runs > 0 ? (size_t)line->runs : DEFAULT_RUNS;
    unsigned methods = classic_methods_named(line->method);
    bool has_bars = (methods >> CLASSIC_KERNEL & 1u) != 0;
    struct initiation_summary *summaries =
        has_bars ? initiation_summaries(line->seed, num_runs) : NULL;
    struct classic_report *paper =
        methods == 1u << CLASSIC_KERNEL ? NULL : classic_report_make(methods, line->seed, num_runs);
    initiation_page(summaries, paper, num_runs, line->seed,
                    line->output != NULL ? line->output : "build/experiment/initiation");
    if (line->json) {
        print_json(summaries, paper, line, num_runs);
    } else {
        print_tables(summaries, paper, line, num_runs);
    }
    classic_report_free(paper);
    free(summaries);
    return 0;
}
