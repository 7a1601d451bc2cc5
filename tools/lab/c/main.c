/* SPDX-License-Identifier: MIT */
/* rhotrack-lab: the program with the benches; `rhotrack bench` runs it. */
#include <cjson/cJSON.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "command_line.h"
#include "lab_commands.h"

static const struct command commands[] = {
    {"bench", command_bench, "[NAME...]", 0, INT_MAX, "jrSsC", "speed, memory, cost a scan",
     "Measures speed and memory; without a name everything there is.\n"},
};

static const struct command *must_find_lab_command(const char *name)
{
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        if (strcmp(commands[i].name, name) == 0) {
            return &commands[i];
        }
    }
    fail(EXIT_USAGE, "rhotrack-lab has the command bench, not `%s`", name);
}

int main(int argc, char **argv)
{
    static struct command_line line;
    cJSON_Hooks hooks = {must_alloc, free};
    const struct command *command;

    cJSON_InitHooks(&hooks);
    command = must_find_lab_command(argc > 1 ? argv[1] : "");
    command_line_read(&line, command, argc - 1, argv + 1);
    command_line_set_places(&line);
    return command->run(&line);
}
