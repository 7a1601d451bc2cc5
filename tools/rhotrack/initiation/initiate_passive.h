/* SPDX-License-Identifier: MIT */
/*
 * initiate_passive: the command initiate on bearings of passive sensors, by the library's method.
 */
#ifndef RHOTRACK_TOOL_INITIATE_PASSIVE_H
#define RHOTRACK_TOOL_INITIATE_PASSIVE_H

#include "commands.h"

void initiate_passive(const struct command_line *line);

#endif
