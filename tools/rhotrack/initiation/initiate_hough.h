/* SPDX-License-Identifier: MIT */
/* initiate_hough: command initiate by one of the papers' methods. */
#ifndef RHOTRACK_TOOL_INITIATE_HOUGH_H
#define RHOTRACK_TOOL_INITIATE_HOUGH_H

#include "commands.h"
#include "settings/method.h"

void initiate_hough(const struct command_line *line, enum method method);

#endif
