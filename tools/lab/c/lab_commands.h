/* SPDX-License-Identifier: MIT */
/* lab_commands: the command of the program rhotrack-lab. */
#ifndef RHOTRACK_LAB_COMMANDS_H
#define RHOTRACK_LAB_COMMANDS_H

#include "commands.h"

/* Runs all benches or the one that is named; exit 2 for an unknown name. Returns 0. */
int command_bench(struct command_line *line);

#endif
