/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "commands.h"
#include "common.h"
#include "experiment.h"
#include "experiment_classic.h"
#include "method.h"

static const struct {
    const char *name;
    int (*run)(const struct command_line *line);
    bool has_papers; /* and knows the papers' methods, too */
} experiments[] = {
    {"initiation", experiment_initiation, true},
    {"polar", experiment_polar, false},
    {"false-alarms", experiment_false_alarms, false},
};

#define NAMES "initiation, polar, false-alarms"

static void check_method(const struct command_line *line, bool has_papers)
{
    bool is_known = line->method == NULL || strcmp(line->method, "kernel") == 0 ||
                    (has_papers && classic_methods_named(line->method) != 0);
    if (!is_known) {
        fail(EXIT_USAGE, "experiment %s knows the method%s, not `%s`", line->arguments[0],
             has_papers ? "s " METHOD_PLOT_NAMES : " kernel", line->method);
    }
}

int command_experiment(struct command_line *line)
{
    if (line->num_arguments != 1) {
        fail(EXIT_USAGE, "experiment: give one name; there are: " NAMES);
    }
    for (size_t i = 0; i < sizeof experiments / sizeof experiments[0]; i++) {
        if (strcmp(experiments[i].name, line->arguments[0]) == 0) {
            check_method(line, experiments[i].has_papers);
            return experiments[i].run(line);
        }
    }
    fail(EXIT_USAGE, "no experiment `%s`; there are: " NAMES, line->arguments[0]);
}
