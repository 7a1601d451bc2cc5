/* SPDX-License-Identifier: MIT */
/* initiate_classic: command initiate by one of the papers' methods. */
#ifndef RHOTRACK_TOOL_INITIATE_CLASSIC_H
#define RHOTRACK_TOOL_INITIATE_CLASSIC_H

#include "commands.h"
#include "settings/method.h"

void initiate_classic(const struct command_line *line, enum method method);

#endif
