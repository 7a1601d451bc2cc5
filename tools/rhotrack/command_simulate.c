/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "common.h"
#include "scenario.h"
#include "simulation_output.h"

static void write_run(const struct command_line *line, const char *folder, uint64_t run)
{
    const char *name = line->arguments[0];
    struct simulation *simulation = scenario_simulate(name, &line->parameters, line->seed, run);
    simulation_write(name, simulation, &line->parameters, folder);
    simulation_free(simulation);
}

static void write_runs(const struct command_line *line)
{
    struct progress progress = progress_start("runs", (uint64_t)line->runs);
    for (long run = 0; run < line->runs; run++) {
        char name[32];
        snprintf(name, sizeof name, "run-%04ld", run);
        char *folder = path_join(line->output, name);
        write_run(line, folder, (uint64_t)run);
        free(folder);
        progress_show(&progress, (uint64_t)run + 1);
    }
    progress_end(&progress);
}

static _Noreturn void fail_with_list(void)
{
    fprintf(stderr, "rhotrack: simulate: give one scenario and -o DIR; the scenarios:\n");
    for (size_t i = 0; scenario_name(i) != NULL; i++) {
        fprintf(stderr, "  %-15s %s\n", scenario_name(i), scenario_text(i));
    }
    exit(EXIT_USAGE);
}

int command_simulate(struct command_line *line)
{
    if (line->num_arguments != 1 || line->output == NULL) {
        fail_with_list();
    }
    scenario_suggest(line->arguments[0], &line->parameters);
    parameters_check(&line->parameters);
    scenario_check_uses(line->arguments[0], &line->parameters);
    if (line->runs > 1) {
        write_runs(line);
    } else {
        write_run(line, line->output, 0);
    }
    return 0;
}
