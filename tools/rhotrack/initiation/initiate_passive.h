/* SPDX-License-Identifier: MIT */
/* initiate_passive: command initiate on bearings. */
#ifndef RHOTRACK_TOOL_INITIATE_PASSIVE_H
#define RHOTRACK_TOOL_INITIATE_PASSIVE_H

#include "commands.h"

void initiate_passive(const struct command_line *line);

#endif
