/* SPDX-License-Identifier: MIT */
/* grid: a small table of texts, for the terminal and for pages. */
#ifndef RHOTRACK_TOOL_GRID_H
#define RHOTRACK_TOOL_GRID_H

#include <stddef.h>
#include <stdio.h>

struct grid {
    size_t num_columns, num_rows; /* row 0 is the head */
    size_t left_columns;          /* so many are set flush left, the others flush right */
    char **cells;                 /* num_rows x num_columns */
};

/* Head "name|name|..."; cells hold no bar. */
struct grid grid_start(size_t left_columns, const char *head);

/* One more row, printf of "cell|cell|..."; missing cells are empty, too many are dropped. */
void grid_row(struct grid *grid, const char *format, ...) __attribute__((format(printf, 2, 3)));

const char *grid_cell(const struct grid *grid, size_t row, size_t column);

/* In columns, with a rule under the head. */
void grid_print(const struct grid *grid, FILE *out);

/* A number for a cell, "-" where it is NAN. */
#define GRID_NUMBER 48
const char *grid_number(char text[GRID_NUMBER], int digits, double value);

void grid_free(struct grid *grid);

#endif
