/* SPDX-License-Identifier: MIT */
#include "experiment_rotating.h"

#include <cjson/cJSON.h>
#include <math.h>
#include <stdlib.h>

#include "base/common.h"
#include "experiment.h"
#include "page.h"
#include "picture/picture.h"

#define DEFAULT_RUNS 200

#define LOSS_MAX 0.02 /* of targets, beside all at once */
#define RMSE_MAX 1.1
#define STEP_MAX_MS 1.0 /* beside the sector's own time */

/* ---- tables ---------------------------------------------------------------------------------- */

struct grid rotating_grid(const struct rotating_figures *figures)
{
    struct grid grid = grid_start(1, "steps|found after 7 turns|tracked at the end|false a run|"
                                     "rmse m|rmse m/s|longest step us|latency ms");
    for (size_t i = 0; i < ROTATING_CASES; i++) {
        const struct rotating_figures *of = &figures[i];
        char rmse[GRID_NUMBER], speed[GRID_NUMBER];

        grid_row(&grid, "%s|%.3f|%.3f|%.3f|%s|%s|%.0f|%.2f", rotating_names[i], of->found,
                 of->tracked, of->false_a_run, grid_number(rmse, 1, of->rmse_m),
                 grid_number(speed, 2, of->rmse_mps), of->step_max_us, of->latency_max_ms);
    }
    return grid;
}

struct verdicts rotating_verdicts(const struct rotating_figures *figures)
{
    const struct rotating_figures *sectors = &figures[ROTATING_SECTORS];
    const struct rotating_figures *at_once = &figures[ROTATING_AT_ONCE];
    double sector_ms = 1e3 * sectors->sector_s;
    struct verdicts verdicts = verdicts_start();

    verdicts_at_most(&verdicts, at_once->found - sectors->found, LOSS_MAX,
                     "by sectors: found after 7 turns, behind all at once");
    verdicts_at_most(&verdicts, at_once->tracked - sectors->tracked, LOSS_MAX,
                     "by sectors: tracked at the end, behind all at once");
    verdicts_at_most(&verdicts, sectors->rmse_m / at_once->rmse_m, RMSE_MAX,
                     "by sectors: rmse over that of all at once");
    verdicts_at_most(&verdicts, sectors->latency_max_ms, sector_ms + STEP_MAX_MS,
                     "by sectors: ms from a plot's time to its report, at most");
    return verdicts;
}

/* ---- output ---------------------------------------------------------------------------------- */

static void print_as_json(const struct rotating_figures *figures, struct verdicts *verdicts,
                          uint64_t seed, size_t num_runs)
{
    cJSON *root = json_experiment("rotating", num_runs, seed);
    cJSON *list = cJSON_AddArrayToObject(root, "cases");
    for (size_t i = 0; i < ROTATING_CASES; i++) {
        cJSON *object = cJSON_CreateObject();
        cJSON_AddStringToObject(object, "case", rotating_names[i]);
        cJSON_AddNumberToObject(object, "found", figures[i].found);
        cJSON_AddNumberToObject(object, "tracked_at_end", figures[i].tracked);
        cJSON_AddNumberToObject(object, "false_tracks_per_run", figures[i].false_a_run);
        cJSON_AddNumberToObject(object, "rmse_m", figures[i].rmse_m);
        cJSON_AddNumberToObject(object, "rmse_mps", figures[i].rmse_mps);
        cJSON_AddNumberToObject(object, "step_max_us", figures[i].step_max_us);
        cJSON_AddNumberToObject(object, "latency_max_ms", figures[i].latency_max_ms);
        cJSON_AddItemToArray(list, object);
    }
    verdicts_to_json(verdicts, root);
    json_print(root);
}

/* The time of each step of a run, by the time that has passed in the scenario. */
static void draw_load(const struct rotating_figures *figures, const char *path)
{
    struct picture picture = picture_open(path, 1000, 420);
    FILE *file = picture.script;

    for (size_t i = 0; i < ROTATING_CASES; i++) {
        fprintf(file, "$case%zu << EOD\n", i);
        for (size_t k = 0; k < figures[i].num_sectors; k++) {
            if (isfinite(figures[i].step_us[k])) {
                fprintf(file, "%.3f %.6f\n", (double)k * figures[i].sector_s,
                        figures[i].step_us[k] * 1e-3);
            }
        }
        fprintf(file, "EOD\n");
    }
    fprintf(file, "set logscale y\nset xlabel 'since the start (s)'\nset ylabel 'a step (ms)'\n"
                  "set key outside right top\nplot ");
    for (size_t i = 0; i < ROTATING_CASES; i++) {
        fprintf(file, "%s$case%zu with lines lw 1.5 lt %zu title '%s'", i == 0 ? "" : ", \\\n ", i,
                i + 1, rotating_names[i]);
    }
    fprintf(file, "\n");
    picture_close(&picture);
}

static void write_page(const struct rotating_figures *figures, const struct verdicts *verdicts,
                       size_t num_runs, uint64_t seed, const char *folder)
{
    make_folder(folder);
    char *picture = path_join(folder, "load.svg"), *path = path_join(folder, "index.html");
    struct page page = page_open(path, "A turning antenna, sector by sector");
    struct grid grid = rotating_grid(figures);
    page_text(&page,
              "Scenario rotating, %zu runs, seed %llu: three targets at 20 to 60 km, 15 m and 3 "
              "mrad, a turn in 4 s, 100 clutter plots a turn: %d bars held, %d missed. The same "
              "flights and clutter by sectors, 32 a turn, by whole turns, and as if the antenna "
              "looked everywhere at the turn's end. Errors are those of confirmed tracks at the "
              "reports that have their plots. Times are the least of three rounds.",
              num_runs, (unsigned long long)seed, verdicts->held, verdicts->missed);
    page_table(&page, &grid);
    draw_load(figures, picture);
    page_figure(&page, "load.svg",
                "How long each step of the first run takes: the load spreads over the turn.");
    page_heading(&page, "What must hold");
    page_table(&page, &verdicts->grid);
    page_close(&page);
    grid_free(&grid);
    free(picture);
    free(path);
}

int experiment_rotating(const struct command_line *line)
{
    size_t num_runs = line->runs > 0 ? (size_t)line->runs : DEFAULT_RUNS;
    struct rotating_figures *figures = rotating_measure(line->seed, num_runs);
    struct verdicts verdicts = rotating_verdicts(figures);
    write_page(figures, &verdicts, num_runs, line->seed,
               line->output != NULL ? line->output : "build/experiment/rotating");
    if (line->json) {
        print_as_json(figures, &verdicts, line->seed, num_runs);
    } else {
        struct grid grid = rotating_grid(figures);
        printf("A turning antenna, 15 m and 3 mrad, 4 s and 32 sectors a turn: %zu runs, seed "
               "%llu\n\n",
               num_runs, (unsigned long long)line->seed);
        grid_print(&grid, stdout);
        printf("\n");
        verdicts_print(&verdicts, stdout);
        grid_free(&grid);
    }
    verdicts_free(&verdicts);
    rotating_figures_free(figures);
    return 0;
}
