/* SPDX-License-Identifier: MIT */
/*
 * initiated_output: writes the tracks that `initiate` finds to a file: CSV, or where its
 * name ends with .lcm an LCM log of as many RHO_PEAKS messages as are needed.
 */
#ifndef RHOTRACK_TOOL_INITIATED_OUTPUT_H
#define RHOTRACK_TOOL_INITIATED_OUTPUT_H

#include "io/csv/tracks_writer.h"

struct initiated_output;

/* Opens the output. path NULL: CSV to standard output. Errors: exit 1; 2 for other formats. */
struct initiated_output *initiated_output_open(const char *path);
void initiated_output_add_row(struct initiated_output *found, const struct initiated *row);

/* Closes the output; the file then appears under its name. */
void initiated_output_close(struct initiated_output *found);

#endif
