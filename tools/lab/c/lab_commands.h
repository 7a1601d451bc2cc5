/* SPDX-License-Identifier: MIT */
/* lab_commands: the commands of rhotrack-lab. */
#ifndef RHOTRACK_LAB_COMMANDS_H
#define RHOTRACK_LAB_COMMANDS_H

#include "commands.h"

/* Each returns the program's exit code. */
int command_experiment(struct command_line *line);
int command_bench(struct command_line *line);

#endif
