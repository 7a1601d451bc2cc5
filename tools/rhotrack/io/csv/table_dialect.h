/* SPDX-License-Identifier: MIT */
/*
 * table_dialect: the forms in which CSV files come: what separates their cells, decimal commas, and
 * other names and units of the columns.
 */
#ifndef RHOTRACK_TOOL_TABLE_DIALECT_H
#define RHOTRACK_TOOL_TABLE_DIALECT_H

#include "io/csv/table.h"

/*
 * What separates the cells of a header line: a comma where there is one outside quotes, else a
 * semicolon, else a tab, else a blank (one or more of them).
 */
char table_dialect_find_delimiter(const char *line, size_t length);

/* Copies a line whose cells are separated by blanks with one comma between them; returns its length
 * in `copy`, which has room for `length` bytes. */
size_t table_dialect_join_blanks(const char *line, size_t length, char *copy);

/* A number with a decimal comma gets a point; other texts stay. */
void table_dialect_point_for_comma(char *cell);

/*
 * Names the columns of a header as the readers do, in any case and with the units that
 * tools/README.md has. A header that already names its time and a place, and a name that is known,
 * stay as they are. Sets factors, by which numbers are to be multiplied, where one is not 1.
 */
void table_dialect_name_columns(struct table *table);

/*
 * NAME=COLUMN[,NAME=COLUMN...] of --columns: in files that have such a column it is read as if its
 * header were that name. Exit 2 where a name is none that is read. The text must outlive the
 * reading.
 */
void table_dialect_set_columns_option(const char *text);

/* Exit 2 where none of the files so far has a column of --columns. */
void table_dialect_check_columns_option(void);

/* The names that a file has. */
void table_dialect_list_names(const struct table *table, char *text, size_t bytes);

/* What to do about a column that is missing: the one that it may be, and how to say so. */
void table_dialect_hint_column(const struct table *table, const char *column, char *text,
                               size_t bytes);

/* Other names of a column ("time, timestamp"); "" where there are none. */
void table_dialect_other_names(const char *column, char *text, size_t bytes);

#endif
