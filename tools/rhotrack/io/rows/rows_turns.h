/* SPDX-License-Identifier: MIT */
/* rows_turns: a file's rows of plots that are gathered into turns (antenna_turns.h). */
#ifndef RHOTRACK_TOOL_ROWS_TURNS_H
#define RHOTRACK_TOOL_ROWS_TURNS_H

#include "io/rows/rows_read.h"

/*
 * Sets the rows' turns, where they are plots that have neither numbers nor sectors of scans nor
 * times of reception, and nobody said how they become scans.
 */
void rows_turns_find(struct rows_file *file, const struct parameters *parameters);

#endif
