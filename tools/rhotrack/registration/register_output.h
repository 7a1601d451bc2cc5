/* SPDX-License-Identifier: MIT */
/*
 * register_output: the biases found, as a table, as JSON, and as an INI file that --config takes.
 */
#ifndef RHOTRACK_TOOL_REGISTER_OUTPUT_H
#define RHOTRACK_TOOL_REGISTER_OUTPUT_H

#include <stdint.h>
#include <stdio.h>

#include "registration/register.h"

void register_print(const struct register_result *result, FILE *out);
void register_print_json(const struct register_result *result, uint64_t rows_skipped);

/* Writes the biases that are known; path as of output_open. */
void register_write_ini(const struct register_result *result, const char *path);

/* Is any bias of any radar known? */
bool register_knows_any_bias(const struct register_result *result);

#endif
