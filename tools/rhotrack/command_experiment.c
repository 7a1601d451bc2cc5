/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "commands.h"
#include "common.h"
#include "experiment.h"

static const struct {
    const char *name;
    int (*run)(const struct command_line *line);
} experiments[] = {
    {"initiation", experiment_initiation},
    {"polar", experiment_polar},
    {"false-alarms", experiment_false_alarms},
};

#define NAMES "initiation, polar, false-alarms"

static void check_method(const struct command_line *line)
{
    if (line->method != NULL && strcmp(line->method, "kernel") != 0) {
        fail(EXIT_USAGE, "experiment %s knows the method kernel, not `%s`", line->arguments[0],
             line->method);
    }
}

int command_experiment(struct command_line *line)
{
    if (line->num_arguments != 1) {
        fail(EXIT_USAGE, "experiment: give one name; there are: " NAMES);
    }
    for (size_t i = 0; i < sizeof experiments / sizeof experiments[0]; i++) {
        if (strcmp(experiments[i].name, line->arguments[0]) == 0) {
            check_method(line);
            return experiments[i].run(line);
        }
    }
    fail(EXIT_USAGE, "no experiment `%s`; there are: " NAMES, line->arguments[0]);
}
