/* SPDX-License-Identifier: MIT */
/*
 * hidden_turns: says where targets may turn between two looks so far that nobody knows their paths.
 */
#ifndef RHOTRACK_TOOL_HIDDEN_TURNS_H
#define RHOTRACK_TOOL_HIDDEN_TURNS_H

#include <stdint.h>
#include <stdio.h>

#include "settings/parameters.h"

/*
 * Prints one line where so many looks in a time hide the turns of an accel_max_mps2 that was told.
 */
void hidden_turns_print(int64_t span_us, uint64_t looks, const struct parameters *parameters,
                        FILE *file);

#endif
