/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/name_hint.h"
#include "commands.h"
#include "next_command.h"
#include "scene/scene.h"

static void simulate_runs(const struct command_line *line, const struct scene *scene)
{
    struct progress progress = progress_start("runs", (uint64_t)line->runs);
    for (long run = 0; run < line->runs; run++) {
        char name[32];
        snprintf(name, sizeof name, "run-%04ld", run);
        char *folder = path_join(line->output, name);
        scene_simulate(scene, line->arguments[0], folder, line->seed, (uint64_t)run);
        free(folder);
        progress_show(&progress, (uint64_t)run + 1);
    }
    progress_end(&progress);
}

static _Noreturn void fail_with_scene_list(void)
{
    fprintf(stderr, "rhotrack: simulate: give one scene and -o DIR; the scenes, besides files "
                    "NAME.json:\n");
    for (size_t i = 0; scene_shipped_name(i) != NULL; i++) {
        fprintf(stderr, "  %s\n", scene_shipped_name(i));
    }
    exit(EXIT_USAGE);
}

static _Noreturn void fail_with_scene_hint(const char *name)
{
    const char *hint = name_hint_nearest(name, scene_shipped_name);
    char list[2048];
    size_t used = 0;

    for (size_t i = 0; scene_shipped_name(i) != NULL && used < sizeof list; i++) {
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i > 0 ? ", " : "",
                                 scene_shipped_name(i));
    }
    fail(EXIT_USAGE, "no scene `%s`%s%s%s; there are: %s, and files NAME.json", name,
         hint ? ", did you mean `" : "", hint ? hint : "", hint ? "`?" : "", list);
}

/* Suggests tracking the simulated plots and bearings with the scenario.ini of the scene. */
static void suggest_track_command(const struct command_line *line)
{
    char *folder =
        line->runs > 1 ? path_join(line->output, "run-0000") : must_copy_text(line->output);
    char *files[] = {path_join(folder, "plots.csv"), path_join(folder, "bearings.csv")};
    char *config = path_join(folder, "scenario.ini"), *tracks = path_join(folder, "tracks.csv");
    const char *words[8] = {"track"};
    size_t count = 1;

    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        if (regular_file_size_or_zero(files[i]) > 0) {
            words[count++] = files[i];
        }
    }
    if (count > 1 && regular_file_size_or_zero(config) > 0) {
        words[count++] = "--config";
        words[count++] = config;
        words[count++] = "-o";
        words[count++] = tracks;
        next_command_print(line, words);
    }
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        free(files[i]);
    }
    free(folder);
    free(config);
    free(tracks);
}

int command_simulate(struct command_line *line)
{
    struct scene *scene;

    if (line->num_arguments != 1 || line->output == NULL) {
        fail_with_scene_list();
    }
    scene = scene_load_by_name(line->arguments[0], line->scene_sets, line->num_scene_sets);
    if (!scene) {
        fail_with_scene_hint(line->arguments[0]);
    }
    /* Exit 2 for --config: a scene holds all its settings itself, and --set changes them. */
    bool has_any = line->parameters.num_sensors > 0;

    for (int i = 0; i < NUM_PARAMETERS; i++) {
        has_any = has_any || line->parameters.source[i] > SOURCE_METHOD;
    }
    if (has_any) {
        fail(EXIT_USAGE, "simulate: a scene takes no --config; its parameters are in its settings");
    }
    if (line->runs > 1) {
        simulate_runs(line, scene);
    } else {
        scene_simulate(scene, line->arguments[0], line->output, line->seed, 0);
    }
    scene_free(scene);
    suggest_track_command(line);
    return 0;
}
