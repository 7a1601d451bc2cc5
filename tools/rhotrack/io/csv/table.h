/* SPDX-License-Identifier: MIT */
/*
 * table: records with named columns, and the lines that they come from: of a CSV file with a header
 * row, read by libcsv, the file's own; of a recording in ASTERIX those of the CSV file that
 * `convert` makes of it (asterix_records.h), though it is never text here.
 *
 * `#` lines and blank lines are skipped and counted as lines. Every error is `rhotrack: FILE:LINE:
 * what is wrong`, exit 2.
 */
#ifndef RHOTRACK_TOOL_TABLE_H
#define RHOTRACK_TOOL_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* A column of a table of numbers: how its numbers are told as text. */
#define TABLE_SHORTEST (-1) /* decimals: the fewest digits that keep float32 */
struct table_column {
    const char *name;
    int decimals;
    /* The word for a number, never NULL. No function: the column is plain numbers. */
    const char *(*word)(int number);
};

struct table {
    char *path;
    size_t num_columns, num_rows;
    const char **names;           /* num_columns */
    char **cells;                 /* num_rows x num_columns; "" where a cell is empty; NULL: */
    int64_t *times_us;            /* of a table of numbers: t_s of the rows, */
    double *numbers;              /* num_rows x num_columns; NaN where a cell is empty */
    struct table_column *columns; /* num_columns */
    double *factors, *offsets;    /* of the columns, factor 0: none; NULL: none has one
                                   * (table_dialect.h): number * factor + offset */
    size_t capacity;              /* of its rows */
    uint32_t *lines;              /* num_rows: the first line of the row in the file */
    uint32_t header_line;
    uint64_t rows_skipped;
    char *text; /* what names and cells point into */
};

#define TABLE_HEADER SIZE_MAX /* the header as a row for table_fail_at_row */

/*
 * Reads a whole file; lines end with LF, CR LF or CR, a byte order mark is skipped. Refused: no
 * such file, a folder, empty, no header, a name twice, NUL bytes, a row with fewer or more
 * cells than the header, bad quotes (bad rows are skipped and counted with keep_going).
 */
struct table *table_read(const char *path, bool keep_going);

/* The same; of the parameters counts what asterix_records.h has of recordings. */
struct parameters;
struct table *table_read_with_parameters(const char *path, const struct parameters *parameters,
                                         bool keep_going);

/* The columns alone, without rows. */
struct table *table_read_header(const char *path);
void table_free(struct table *table);

/* A header without rows is refused here: exit 2. */
void table_need_rows(const struct table *table);

/*
 * Index of a column, or -1; table_need_column exits with 2 where it is missing, and names what is
 * there.
 */
static inline int table_find_column(const struct table *table, const char *name)
{
    for (size_t i = 0; i < table->num_columns; i++) {
        if (!strcmp(table->names[i], name)) {
            return (int)i;
        }
    }
    return -1;
}

int table_need_column(const struct table *table, const char *name);

/*
 * Cells. The functions that return a text return NULL and set the value, or return the reason as a
 * constant text (number_text.h). table_read_float: of all numbers that a text may mean the nearest
 * float32, as the program that wrote it had it.
 */
bool table_is_cell_empty(const struct table *table, size_t row, int column);
const char *table_read_number(const struct table *table, size_t row, int column, double *value);
const char *table_read_float(const struct table *table, size_t row, int column, float *value);
const char *table_read_time_us(const struct table *table, size_t row, int column, int64_t *time_us);
const char *table_read_int32(const struct table *table, size_t row, int column, int32_t *value);

/* The cell as a CSV file has it, or would have it: then in the buffer. */
#define TABLE_TEXT_BYTES 340
const char *table_cell_text(const struct table *table, size_t row, int column,
                            char buffer[TABLE_TEXT_BYTES]);

/* The cell holds this word. */
bool table_is_word(const struct table *table, size_t row, int column, const char *word);

/* The cell as a number; exit 2 naming file, line and column where it is none. */
double table_number_at(const struct table *table, size_t row, int column);

/* The same, `otherwise` where there is no such column (-1) or the cell is empty. */
double table_number_or(const struct table *table, size_t row, int column, double otherwise);

/*
 * A table of numbers, of a source that is no text. Its first column is t_s. Adding a row returns
 * its cells, all empty (NaN); that of t_s is not used.
 */
struct table *table_of_numbers(const char *path, const struct table_column *columns,
                               size_t num_columns);
double *table_add_row_of_numbers(struct table *table, int64_t time_us, uint32_t line);

/* As lines of a CSV file. */
void table_write_header(FILE *file, const struct table *table);
void table_write_row(FILE *file, const struct table *table, size_t row);

/* `rhotrack: FILE:LINE: ` and the message; exit 2. */
_Noreturn void table_fail_at_row(const struct table *table, size_t row, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
