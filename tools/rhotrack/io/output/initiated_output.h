/* SPDX-License-Identifier: MIT */
/*
 * initiated_output: tracks found by `initiate` to a file: CSV, or where its name ends with .lcm an
 * LCM log of RHO_PEAKS messages, as many as they take.
 */
#ifndef RHOTRACK_TOOL_INITIATED_OUTPUT_H
#define RHOTRACK_TOOL_INITIATED_OUTPUT_H

#include "io/csv/tracks_writer.h"

struct initiated_output;

/* path NULL: CSV to standard output. Errors: exit 1. */
struct initiated_output *initiated_output_open(const char *path);
void initiated_output_add_row(struct initiated_output *found, const struct initiated *row);

/* The file appears under its name. */
void initiated_output_close(struct initiated_output *found);

#endif
