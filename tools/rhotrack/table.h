/* SPDX-License-Identifier: MIT */
/*
 * table: a CSV file with a header row, read by libcsv, columns found by name, the file's own line
 * numbers kept.
 *
 * A recording in ASTERIX is read as the CSV file that says the same (asterix_text.h).
 *
 * `#` lines and blank lines are skipped and counted as lines. Every error is `rhotrack: FILE:LINE:
 * what is wrong`, exit 2.
 */
#ifndef RHOTRACK_TOOL_TABLE_H
#define RHOTRACK_TOOL_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct table {
    char *path;
    size_t num_columns, num_rows;
    char **names;    /* num_columns */
    char **cells;    /* num_rows x num_columns; "" where a cell is empty */
    uint32_t *lines; /* num_rows: the first line of the row in the file */
    uint32_t header_line;
    uint64_t rows_skipped;
    char *text; /* what names and cells point into */
};

#define TABLE_HEADER SIZE_MAX /* the header as a row for table_fail */

/*
 * Reads a whole file; lines end with LF, CR LF or CR, a byte order mark is skipped. Refused: no
 * such file, a folder, empty, no header, a name twice, NUL bytes, a row with fewer or more
 * cells than the header, bad quotes (bad rows are skipped and counted with keep_going).
 */
struct table *table_read(const char *path, bool keep_going);

/* The same; of the parameters counts what asterix_text.h has of recordings. */
struct parameters;
struct table *table_read_as(const char *path, const struct parameters *parameters, bool keep_going);

/* The same from text in memory; the path is for messages. */
struct table *table_from_text(const char *path, const char *text, size_t bytes, bool keep_going);

/* The columns alone, without rows. */
struct table *table_read_header(const char *path);
void table_free(struct table *table);

/* A header without rows is refused here: exit 2. */
void table_need_rows(const struct table *table);

/* Index of a column, or -1; table_need exits with 2 where it is missing. */
int table_find(const struct table *table, const char *name);
int table_need(const struct table *table, const char *name);

const char *table_cell(const struct table *table, size_t row, int column);

/*
 * A cell as a number: plain decimal, within float range; NaN, Inf, hexadecimal and trailing text
 * are refused. Returns NULL and sets *value, or the reason as a constant text.
 */
const char *table_number(const char *cell, double *value);

/* The cell as a number; exit 2 naming file, line and column where it is none. */
double table_number_at(const struct table *table, size_t row, int column);

/* The same, `otherwise` where there is no such column (-1) or the cell is empty. */
double table_number_or(const struct table *table, size_t row, int column, double otherwise);

/*
 * A decimal number of seconds in microseconds, rounded to nearest without detour over floating
 * point where it has no exponent; |t| <= 4e12 s. Returns NULL and sets *time_us, or the reason as a
 * constant text.
 */
const char *table_time_us(const char *cell, int64_t *time_us);

/*
 * A cell as a whole number within int32_t. Returns NULL and sets *value, or the reason as a
 * constant text.
 */
const char *table_int32(const char *cell, int32_t *value);

/* `rhotrack: FILE:LINE: ` and the message; exit 2. */
_Noreturn void table_fail(const struct table *table, size_t row, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
