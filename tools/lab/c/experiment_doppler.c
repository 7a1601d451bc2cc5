/* SPDX-License-Identifier: MIT */
#include "experiment_doppler.h"

#include <cjson/cJSON.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment.h"
#include "page.h"
#include "picture/picture.h"

#define DEFAULT_RUNS 60

/* ---- tables ---------------------------------------------------------------------------------- */

static void add_row(struct grid *grid, const struct doppler_figures *of)
{
    grid_row(grid, "%s%s|%g|%.3f|%.3f|%.1f|%.3f|%.3f|%.3f|%.2f|%.1f|%.2f", of->of->name,
             of->static_clutter > 0.0 ? ", half the clutter stands" : "",
             of->clutter + of->static_clutter, of->found, of->false_a_run, of->search_ms,
             of->prompt, of->tracked, of->false_tracks, of->confirm_at, of->rmse_m, of->rmse_mps);
}

struct grid doppler_grid(const struct doppler_result *result)
{
    struct grid grid = grid_start(
        1, "case|clutter a turn|Pd, batch of 7|false a run|ms|tracked after 5|at the end|"
           "false a run|confirmed at turn|rmse m|rmse m/s");
    for (size_t i = 0; i < result->num_levels; i++) {
        add_row(&grid, &result->levels[i]);
    }
    for (size_t i = 1; i < DOPPLER_CASES; i++) {
        add_row(&grid, &result->at_limit[i]);
    }
    for (size_t i = 0; i < DOPPLER_CASES; i++) {
        add_row(&grid, &result->beyond[i]);
    }
    add_row(&grid, &result->still);
    return grid;
}

static void judge_beyond(struct verdicts *verdicts, const struct doppler_figures *of)
{
    const char *name = of->of->name;
    verdicts_at_least(verdicts, of->found, DOPPLER_PD_MIN, "%s, %g a turn: Pd of a batch", name,
                      of->clutter);
    verdicts_at_most(verdicts, of->false_a_run, DOPPLER_FALSE_MAX,
                     "%s, %g a turn: false candidates a run", name, of->clutter);
    verdicts_at_least(verdicts, of->prompt, DOPPLER_PD_MIN, "%s, %g a turn: tracked after 5 turns",
                      name, of->clutter);
    verdicts_at_most(verdicts, of->false_tracks, DOPPLER_FALSE_MAX,
                     "%s, %g a turn: false tracks a run", name, of->clutter);
}

struct verdicts doppler_verdicts(const struct doppler_result *result)
{
    struct verdicts verdicts = verdicts_start();
    verdicts_at_least(&verdicts, result->limit, doppler_clutter[0],
                      "clutter a turn that is borne without range rates");
    judge_beyond(&verdicts, &result->beyond[1]);
    judge_beyond(&verdicts, &result->beyond[2]);
    verdicts_at_most(&verdicts, result->at_limit[1].rmse_m / result->at_limit[0].rmse_m, 1.0,
                     "range rate, %g a turn: rmse over that without", result->limit);
    return verdicts;
}

/* ---- output ---------------------------------------------------------------------------------- */

static cJSON *figures_json(const struct doppler_figures *of)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "case", of->of->name);
    cJSON_AddNumberToObject(object, "clutter_per_scan", of->clutter);
    cJSON_AddNumberToObject(object, "static_clutter", of->static_clutter);
    cJSON_AddNumberToObject(object, "pd", of->found);
    cJSON_AddNumberToObject(object, "false_candidates_per_run", of->false_a_run);
    cJSON_AddNumberToObject(object, "search_ms", of->search_ms);
    cJSON_AddNumberToObject(object, "tracked_after_5", of->prompt);
    cJSON_AddNumberToObject(object, "tracked_at_end", of->tracked);
    cJSON_AddNumberToObject(object, "false_tracks_per_run", of->false_tracks);
    cJSON_AddNumberToObject(object, "confirmed_at_turn", of->confirm_at);
    cJSON_AddNumberToObject(object, "rmse_m", of->rmse_m);
    cJSON_AddNumberToObject(object, "rmse_mps", of->rmse_mps);
    return object;
}

static void print_as_json(const struct doppler_result *result, struct verdicts *verdicts,
                          uint64_t seed, size_t num_runs)
{
    cJSON *root = json_experiment("doppler", num_runs, seed);
    cJSON_AddNumberToObject(root, "limit_clutter_per_scan", result->limit);
    cJSON *list = cJSON_AddArrayToObject(root, "cases");
    for (size_t i = 0; i < result->num_levels; i++) {
        cJSON_AddItemToArray(list, figures_json(&result->levels[i]));
    }
    for (size_t i = 0; i < DOPPLER_CASES; i++) {
        cJSON_AddItemToArray(list, figures_json(&result->at_limit[i]));
        cJSON_AddItemToArray(list, figures_json(&result->beyond[i]));
    }
    cJSON_AddItemToArray(list, figures_json(&result->still));
    verdicts_to_json(verdicts, root);
    json_print(root);
}

/*
 * Tracked after five turns: without range rates up to the limit, all cases at the limit and beyond.
 */
static void draw(const struct doppler_result *result, const char *path)
{
    struct picture picture = picture_open(path, 1000, 520);
    FILE *file = picture.script;
    for (size_t i = 0; i < DOPPLER_CASES; i++) {
        fprintf(file, "$case%zu << EOD\n", i);
        for (size_t k = 0; i == 0 && k < result->num_levels; k++) {
            fprintf(file, "%g %.4f\n", result->levels[k].clutter, result->levels[k].prompt);
        }
        if (i > 0) {
            fprintf(file, "%g %.4f\n", result->at_limit[i].clutter, result->at_limit[i].prompt);
        }
        fprintf(file, "%g %.4f\nEOD\n", result->beyond[i].clutter, result->beyond[i].prompt);
    }
    fprintf(file, "set logscale x\nset xlabel 'clutter plots a turn'\nset yrange [0:1.02]\n"
                  "set ylabel 'targets tracked after 5 turns'\nset key bottom left\nplot ");
    for (size_t i = 0; i < DOPPLER_CASES; i++) {
        fprintf(file, "%s$case%zu with linespoints lw 2 lt %zu pt %d title '%s'",
                i == 0 ? "" : ", \\\n ", i, i + 1, picture_marker(i), doppler_cases[i].name);
    }
    fprintf(file, "\n");
    picture_close(&picture);
}

void doppler_page(const struct doppler_result *result, const struct verdicts *verdicts,
                  size_t num_runs, uint64_t seed, const char *folder)
{
    make_folder(folder);
    char *picture = path_join(folder, "tracked.svg"), *path = path_join(folder, "index.html");
    struct page page = page_open(path, "What range rates are worth");
    struct grid grid = doppler_grid(result);
    draw(result, picture);
    page_text(&page,
              "Scenario doppler, %zu runs a row, seed %llu: three targets at 20 to 60 km, 40 m and "
              "7 mrad, 4 s a turn, range rates of 1 m/s: %d bars held, %d missed. Without range "
              "rates Pd .95, by a batch of seven turns and by the tracker after five, and .1 false "
              "ones a run are met up to %g clutter plots a turn; with them at ten times as many? "
              "Rows there without bars have a quarter of the runs.",
              num_runs, (unsigned long long)seed, verdicts->held, verdicts->missed, result->limit);
    page_text(&page, "A range rate within 800 m/s tells ln(800 / 4.13) = 5.3 nat a plot (4.13: e "
                     "to the entropy of 1 m/s "
                     "of normal noise), with a span of 100 m/s 3.2, of 30 m/s 2.0; ten times the "
                     "clutter takes 2.3.");
    page_table(&page, &grid);
    page_figure(&page, "tracked.svg", "Targets with a confirmed track after five turns.");
    page_heading(&page, "What must hold");
    page_table(&page, &verdicts->grid);
    page_close(&page);
    grid_free(&grid);
    free(picture);
    free(path);
}

static void print_tables(const struct doppler_result *result, const struct verdicts *verdicts,
                         uint64_t seed, size_t num_runs)
{
    struct grid grid = doppler_grid(result);
    printf("A radar that measures range rates, 40 m, 7 mrad, 1 m/s, 4 s a turn: %zu runs, seed "
           "%llu; without range rates %g clutter plots a turn are borne\n\n",
           num_runs, (unsigned long long)seed, result->limit);
    grid_print(&grid, stdout);
    printf("\n");
    verdicts_print(verdicts, stdout);
    grid_free(&grid);
}

int experiment_doppler(const struct command_line *line)
{
    size_t num_runs = line->runs > 0 ? (size_t)line->runs : DEFAULT_RUNS;
    struct doppler_result result = doppler_run(line->seed, num_runs);
    struct verdicts verdicts = doppler_verdicts(&result);
    doppler_page(&result, &verdicts, num_runs, line->seed,
                 line->output != NULL ? line->output : "build/experiment/doppler");
    if (line->json) {
        print_as_json(&result, &verdicts, line->seed, num_runs);
    } else {
        print_tables(&result, &verdicts, line->seed, num_runs);
    }
    verdicts_free(&verdicts);
    return 0;
}
