/* SPDX-License-Identifier: MIT */
/* initiate_passive_paper: the command initiate on bearings, by the method of the paper. */
#ifndef RHOTRACK_TOOL_INITIATE_PASSIVE_PAPER_H
#define RHOTRACK_TOOL_INITIATE_PASSIVE_PAPER_H

#include "commands.h"

void initiate_passive_paper(const struct command_line *line);

#endif
