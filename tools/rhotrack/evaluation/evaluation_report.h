/* SPDX-License-Identifier: MIT */
/* evaluation_report: an evaluation as text, JSON, a CSV file or a picture. */
#ifndef RHOTRACK_TOOL_EVALUATION_REPORT_H
#define RHOTRACK_TOOL_EVALUATION_REPORT_H

#include <stdbool.h>

#include "evaluation/evaluation.h"

/* A line a figure on standard output; by_target: then a table with a row a target. */
void evaluation_print(const struct evaluation *e, bool by_target);

/* One object on standard output: the figures, and by_target and over_time as lists of objects. */
void evaluation_print_json(const struct evaluation *e);

/* A row a time. */
void evaluation_write_csv(const struct evaluation *e, const char *path);

/* GOSPA and its parts, and the numbers of targets and tracks, over time; an SVG. */
void evaluation_draw(const struct evaluation *e, const char *path);

#endif
