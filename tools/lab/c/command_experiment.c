/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "base/common.h"
#include "experiment.h"
#include "lab_commands.h"

static bool is_passive_method(const char *name)
{
    return strcmp(name, "passive") == 0 || strcmp(name, "passive-paper") == 0;
}

static bool knows_no_method(const char *name)
{
    (void)name;
    return false;
}

static const struct {
    const char *name;
    int (*run)(const struct command_line *line);
    bool (*knows)(const char *method);
    const char *methods;
} experiments[] = {
    {"passive", experiment_passive, is_passive_method, "methods passive, passive-paper"},
    {"maneuver", experiment_maneuver, knows_no_method, "gates of `maintain`, all of them"},
};

#define NAMES "passive, maneuver"

int command_experiment(struct command_line *line)
{
    if (line->num_arguments != 1) {
        fail(EXIT_USAGE, "experiment: give one name; there are: " NAMES);
    }
    for (size_t i = 0; i < sizeof experiments / sizeof experiments[0]; i++) {
        if (strcmp(experiments[i].name, line->arguments[0]) == 0) {
            if (line->method != NULL && !experiments[i].knows(line->method)) {
                fail(EXIT_USAGE, "experiment %s knows the %s, not `%s`", experiments[i].name,
                     experiments[i].methods, line->method);
            }
            return experiments[i].run(line);
        }
    }
    if (strcmp(line->arguments[0], "real-skies") == 0) {
        fail(EXIT_USAGE,
             "experiment real-skies is one of the lab's, in Python: `make experiments`, "
             "or tools/lab/real_skies.py");
    }
    fail(EXIT_USAGE, "no experiment `%s`; there are: " NAMES, line->arguments[0]);
}
