/* SPDX-License-Identifier: MIT */
/*
 * table_dialect_and_column_names: the forms in which CSV files come: separators of cells, decimal
 * commas, and other names and units of columns.
 */
#ifndef RHOTRACK_TOOL_TABLE_DIALECT_AND_COLUMN_NAMES_H
#define RHOTRACK_TOOL_TABLE_DIALECT_AND_COLUMN_NAMES_H

#include "io/csv/table_columns_and_cells.h"

/*
 * Finds the separator of a header line's cells: a comma where there is one outside quotes, else a
 * semicolon, else a tab, else one or more blanks.
 */
char table_dialect_find_delimiter(const char *line, size_t length);

/*
 * Copies a line whose cells are separated by blanks, with one comma between them. Returns the
 * length of `copy`, which has room for `length` bytes.
 */
size_t table_dialect_join_blanks(const char *line, size_t length, char *copy);

/* Replaces the decimal comma of a number by a point; other texts stay. */
void table_dialect_point_for_comma(char *cell);

/*
 * Renames the columns of a header to the names that the readers use, from any case and with the
 * units that tools/README.md lists. Known names stay, and so does a header that already names its
 * time and a place. Sets the table's factors and offsets where units differ.
 */
void table_dialect_name_columns(struct table *table);

/*
 * Sets NAME=COLUMN[,NAME=COLUMN...] of the option --columns: in files that have such a COLUMN it is
 * read as if its name were NAME. Exit 2 where a NAME is not one that is read.
 */
void table_dialect_set_columns_option(const char *text);

/* Exit 2 where no file so far has the columns of --columns. */
void table_dialect_fail_if_columns_option_unused(void);

/* Writes the names of a table's columns, separated by commas. */
void table_dialect_list_columns_of_file(const struct table *table, char *text, size_t bytes);

/*
 * Writes advice on a missing column: the column of the file that it may be, and the option to say
 * so.
 */
void table_dialect_hint_column(const struct table *table, const char *column, char *text,
                               size_t bytes);

/* Writes other accepted names of a column, like "time, timestamp"; "" where there are none. */
void table_dialect_other_names(const char *column, char *text, size_t bytes);

#endif
