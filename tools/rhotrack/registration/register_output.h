/* SPDX-License-Identifier: MIT */
/*
 * register_output: writes the estimated biases as a table, as JSON, and as an INI file for
 * --config.
 */
#ifndef RHOTRACK_TOOL_REGISTER_OUTPUT_H
#define RHOTRACK_TOOL_REGISTER_OUTPUT_H

#include <stdint.h>
#include <stdio.h>

#include "registration/register.h"

void register_print(const struct register_result *result, FILE *out);
void register_print_json(const struct register_result *result, uint64_t rows_skipped);

/* Writes the known biases as INI sections; path as for output_open. */
void register_write_ini(const struct register_result *result, const char *path);

/* Whether any bias of any radar, other than the reference's time, is known. */
bool register_knows_any_bias(const struct register_result *result);

#endif
