/* SPDX-License-Identifier: MIT */
/* experiment: the experiments that `rhotrack experiment NAME` knows. */
#ifndef RHOTRACK_TOOL_EXPERIMENT_H
#define RHOTRACK_TOOL_EXPERIMENT_H

#include "commands.h"

/* Each returns the program's exit code. */
int experiment_polar(const struct command_line *line);
int experiment_doppler(const struct command_line *line);
int experiment_rotating(const struct command_line *line);
int experiment_air_traffic(const struct command_line *line);
int experiment_two_radars(const struct command_line *line);

#endif
