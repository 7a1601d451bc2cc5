/* SPDX-License-Identifier: MIT */
/*
 * evaluation_output: writes the results of an evaluation as text, JSON, CSV or a
 * picture.
 */
#ifndef RHOTRACK_TOOL_EVALUATION_OUTPUT_H
#define RHOTRACK_TOOL_EVALUATION_OUTPUT_H

#include <stdbool.h>

#include "evaluation/evaluation.h"

/*
 * Prints a line for each overall figure to standard output, then a table of errors by motion; with
 * by_target also a table with a row for each target.
 */
void evaluation_print(const struct evaluation *e, bool by_target);

/*
 * Prints one JSON object to standard output: the overall figures, by_motion as an object, by_target
 * and over_time as lists of objects.
 */
void evaluation_print_json(const struct evaluation *e);

/* Writes a CSV file with a row of figures for each evaluated time. */
void evaluation_write_csv_over_time(const struct evaluation *e, const char *path);

/* Draws GOSPA, its parts, and the numbers of targets and tracks over time as an SVG file. */
void evaluation_draw_gospa(const struct evaluation *e, const char *path);

#endif
