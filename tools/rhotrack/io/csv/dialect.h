/* SPDX-License-Identifier: MIT */
/*
 * dialect: the forms in which CSV files come: separators of cells and decimal commas.
 */
#ifndef RHOTRACK_TOOL_DIALECT_H
#define RHOTRACK_TOOL_DIALECT_H

#include <stddef.h>

/*
 * Finds the separator of a header line's cells: a comma where there is one outside quotes, else a
 * semicolon, else a tab, else one or more blanks.
 */
char dialect_find_delimiter(const char *line, size_t length);

/*
 * Copies a line whose cells are separated by blanks, with one comma between them. Returns the
 * length of `copy`, which has room for `length` bytes.
 */
size_t dialect_join_blanks(const char *line, size_t length, char *copy);

/* Replaces the decimal comma of a number by a point; other texts stay. */
void dialect_point_for_comma(char *cell);

#endif
