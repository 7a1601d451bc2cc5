/* SPDX-License-Identifier: MIT */
/* initiate_hough: the command initiate by the papers' Hough methods ht, mht, iht and nht. */
#ifndef RHOTRACK_TOOL_INITIATE_HOUGH_H
#define RHOTRACK_TOOL_INITIATE_HOUGH_H

#include "commands.h"
#include "settings/initiation_methods.h"

void initiate_hough(const struct command_line *line, enum method method);

#endif
