/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "common.h"
#include "hint.h"
#include "scenario.h"
#include "scene/scene.h"
#include "simulation_output.h"

/* Of a scene where there is one, else of a scenario. */
static void write_run(const struct command_line *line, const struct scene *scene,
                      const char *folder, uint64_t run)
{
    const char *name = line->arguments[0];

    if (scene) {
        scene_simulate(scene, name, folder, line->seed, run);
        return;
    }
    struct simulation *simulation = scenario_simulate(name, &line->parameters, line->seed, run);
    simulation_write(name, simulation, &line->parameters, folder);
    simulation_free(simulation);
}

static void write_runs(const struct command_line *line, const struct scene *scene)
{
    struct progress progress = progress_start("runs", (uint64_t)line->runs);
    for (long run = 0; run < line->runs; run++) {
        char name[32];
        snprintf(name, sizeof name, "run-%04ld", run);
        char *folder = path_join(line->output, name);
        write_run(line, scene, folder, (uint64_t)run);
        free(folder);
        progress_show(&progress, (uint64_t)run + 1);
    }
    progress_end(&progress);
}

static _Noreturn void fail_with_list(void)
{
    fprintf(stderr, "rhotrack: simulate: give one scenario or scene and -o DIR; the scenarios:\n");
    for (size_t i = 0; scenario_name(i) != NULL; i++) {
        fprintf(stderr, "  %-15s %s\n", scenario_name(i), scenario_text(i));
    }
    fprintf(stderr, "the scenes, besides files NAME.json:\n");
    for (size_t i = 0; scene_shipped_name(i) != NULL; i++) {
        fprintf(stderr, "  %s\n", scene_shipped_name(i));
    }
    exit(EXIT_USAGE);
}

/* Of scenarios, then of scenes. */
static const char *any_name(size_t index)
{
    size_t num_scenarios = 0;

    while (scenario_name(num_scenarios) != NULL) {
        num_scenarios++;
    }
    return index < num_scenarios ? scenario_name(index) : scene_shipped_name(index - num_scenarios);
}

static _Noreturn void fail_unknown(const char *name)
{
    const char *hint = hint_nearest(name, any_name);
    char list[2048];
    size_t used = 0;

    for (size_t i = 0; any_name(i) != NULL && used < sizeof list; i++) {
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i > 0 ? ", " : "",
                                 any_name(i));
    }
    fail(EXIT_USAGE, "no scenario or scene `%s`%s%s%s; there are: %s, and files NAME.json", name,
         hint ? ", did you mean `" : "", hint ? hint : "", hint ? "`?" : "", list);
}

/* A scene says all that there is to say; --set changes what stands in it. */
static void refuse_config(const struct command_line *line)
{
    bool has_any = line->parameters.num_sensors > 0;

    for (int i = 0; i < NUM_PARAMETERS; i++) {
        has_any = has_any || line->parameters.source[i] > SOURCE_METHOD;
    }
    if (has_any) {
        fail(EXIT_USAGE,
             "simulate: a scene takes no --config; what it tells stands in its settings");
    }
}

int command_simulate(struct command_line *line)
{
    struct scene *scene = NULL;

    if (line->num_arguments != 1 || line->output == NULL) {
        fail_with_list();
    }
    if (!scenario_is_known(line->arguments[0])) {
        scene = scene_find(line->arguments[0], line->scene_sets, line->num_scene_sets);
    }
    if (!scene && !scenario_is_known(line->arguments[0])) {
        fail_unknown(line->arguments[0]);
    }
    if (scene) {
        refuse_config(line);
    } else {
        scenario_suggest(line->arguments[0], &line->parameters);
        parameters_check(&line->parameters);
        scenario_check_uses(line->arguments[0], &line->parameters);
    }
    if (line->runs > 1) {
        write_runs(line, scene);
    } else {
        write_run(line, scene, line->output, 0);
    }
    if (scene) {
        scene_free(scene);
    }
    return 0;
}
