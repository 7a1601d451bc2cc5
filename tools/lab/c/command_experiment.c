/* SPDX-License-Identifier: MIT */
#include "base/common.h"
#include "lab_commands.h"

int command_experiment(struct command_line *line)
{
    (void)line;
    fail(EXIT_USAGE, "experiments are scripts: tools/lab/NAME.py; tools/lab/README.md lists them");
}
