/* SPDX-License-Identifier: MIT */
/* calibrate_output: what radars are like, as a table, as JSON, and as an INI file. */
#ifndef RHOTRACK_TOOL_CALIBRATE_OUTPUT_H
#define RHOTRACK_TOOL_CALIBRATE_OUTPUT_H

#include <stdio.h>

#include "registration/calibrate.h"

/* True where the noise of a radar is known, or its pd. */
bool calibrate_knows_any_figure(const struct calibrate_result *result);

/* With a line for each figure that is not known: why. */
void calibrate_print(const struct calibrate_result *result, FILE *out);
void calibrate_print_json(const struct calibrate_result *result, uint64_t rows_skipped);
void calibrate_write_ini(const struct calibrate_result *result, const char *path);

#endif
