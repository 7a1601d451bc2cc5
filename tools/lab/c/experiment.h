/* SPDX-License-Identifier: MIT */
/* experiment: the experiments that `rhotrack experiment NAME` knows. */
#ifndef RHOTRACK_TOOL_EXPERIMENT_H
#define RHOTRACK_TOOL_EXPERIMENT_H

#include "commands.h"

/* Each returns the program's exit code. */
int experiment_passive(const struct command_line *line);
int experiment_maneuver(const struct command_line *line);

#endif
