/* SPDX-License-Identifier: MIT */
/* lab_commands: the command of rhotrack-lab. */
#ifndef RHOTRACK_LAB_COMMANDS_H
#define RHOTRACK_LAB_COMMANDS_H

#include "commands.h"

/* Returns the program's exit code. */
int command_bench(struct command_line *line);

#endif
