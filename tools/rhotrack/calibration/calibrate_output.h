/* SPDX-License-Identifier: MIT */
/* calibrate_output: writes the calibration of radars as a table, as JSON and as an INI file. */
#ifndef RHOTRACK_TOOL_CALIBRATE_OUTPUT_H
#define RHOTRACK_TOOL_CALIBRATE_OUTPUT_H

#include <stdio.h>

#include "calibration/calibrate_noise.h"

/* Whether the range noise or the pd of any radar is known. */
bool calibrate_knows_noise_or_pd(const struct calibrate_result *result);

/* Prints a table of the known figures, and a line for each unknown one with the reason. */
void calibrate_print(const struct calibrate_result *result, FILE *out);
void calibrate_print_json(const struct calibrate_result *result, uint64_t rows_skipped);
void calibrate_write_ini(const struct calibrate_result *result, const char *path);

#endif
