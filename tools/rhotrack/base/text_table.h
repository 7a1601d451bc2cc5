/* SPDX-License-Identifier: MIT */
/*
 * text_table: formats rows of texts as a table with aligned columns, for the terminal and for
 * pages.
 */
#ifndef RHOTRACK_TOOL_TEXT_TABLE_H
#define RHOTRACK_TOOL_TEXT_TABLE_H

#include <stddef.h>
#include <stdio.h>

struct text_table {
    size_t num_columns, num_rows; /* row 0 is the table's head */
    /* the first left_columns columns are flush left, the others flush right */
    size_t left_columns;
    char **cells; /* texts of the cells, num_rows x num_columns */
};

/* Starts a table with the head "name|name|..."; cells cannot contain a bar. */
struct text_table text_table_start(size_t left_columns, const char *head);

/* Adds a row, printf of "cell|cell|..."; missing cells are empty, surplus cells are dropped. */
void text_table_add_row(struct text_table *table, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

const char *text_table_cell(const struct text_table *table, size_t row, size_t column);

/* Prints the table in aligned columns, with a rule under the head. */
void text_table_print(const struct text_table *table, FILE *out);

/* Formats a number for a cell; "-" for NAN. */
#define TEXT_TABLE_NUMBER 48
const char *text_table_number_or_dash(char text[TEXT_TABLE_NUMBER], int digits, double value);

void text_table_free(struct text_table *table);

#endif
