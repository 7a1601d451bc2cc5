/* SPDX-License-Identifier: MIT */
/*
 * csv_table: rows with named columns, and the line that each comes from: of a CSV
 * file with a header, read by libcsv; or of an ASTERIX recording, where it is the line in the CSV
 * file that `convert` makes of it (asterix_plot_rows.h).
 *
 * `#` lines and blank lines are skipped and counted as lines. Every error is `rhotrack: FILE:LINE:
 * what is wrong`, exit 2.
 */
#ifndef RHOTRACK_TOOL_CSV_TABLE_H
#define RHOTRACK_TOOL_CSV_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* A column of a table of numbers, and how its numbers are written as text. */
#define TABLE_SHORTEST (-1) /* value of decimals: the fewest digits that keep float32 */
struct table_column {
    const char *name;
    int decimals;
    /* The word for a number, never NULL. NULL function: numbers are written as numbers. */
    const char *(*word)(int number);
};

struct table {
    char *path;
    size_t num_columns, num_rows;
    const char **names; /* num_columns names */
    /* num_rows x num_columns texts, "" where empty; NULL: a table of numbers */
    char **cells;
    int64_t *times_us;            /* table of numbers: column 0, t_s, of the rows */
    double *numbers;              /* table of numbers: num_rows x num_columns, NaN where empty */
    struct table_column *columns; /* table of numbers: descriptions of the num_columns columns */
    /* units of the columns: value = number * factor + offset; factor 0, or NULL: none */
    double *factors, *offsets;
    /*
     * above 0: times are numbers of frames over it, where the table has no times (columns.h); 0: it
     * is not set; below 0: frames are no times in this table
     */
    double frame_rate_hz;
    size_t capacity; /* rows that the arrays have room for */
    uint32_t *lines; /* num_rows: the line in the file on which a row begins */
    uint32_t header_line;
    uint64_t rows_skipped;
    char *text; /* memory that names and cells point into */
};

#define TABLE_HEADER SIZE_MAX /* row argument of table_fail_at_row for the header */

/*
 * Reads a whole file; lines end with LF, CR LF or CR, a byte order mark is skipped. Refused: a
 * missing, empty or headerless file, a folder, a column name twice, NUL bytes, a row with fewer or
 * more cells than the header, bad quotes (bad rows are skipped and counted with keep_going).
 */
struct table *table_read(const char *path, bool keep_going);

/*
 * Reads a whole file like table_read; the parameters are used for ASTERIX recordings
 * (asterix_plot_rows.h).
 */
struct parameters;
struct table *table_read_csv_or_asterix(const char *path, const struct parameters *parameters,
                                        bool keep_going);

/* Reads the columns' names alone, without rows. */
struct table *table_read_header(const char *path);
void table_free(struct table *table);

/* Exit 2 where the table has a header and no rows. */
void table_need_rows(const struct table *table);

/* Index of a column, or -1. */
static inline int table_find_column(const struct table *table, const char *name)
{
    for (size_t i = 0; i < table->num_columns; i++) {
        if (!strcmp(table->names[i], name)) {
            return (int)i;
        }
    }
    return -1;
}

/*
 * Reading cells. The functions that return a text return NULL and set the value, or return the
 * reason why the cell is bad as a constant text (parse.h). table_read_float gives
 * the float32 nearest to the text, as the program that wrote it had it. table_read_time_us divides
 * the number of a frame by the table's frame rate.
 */
bool table_is_cell_empty(const struct table *table, size_t row, int column);
const char *table_read_number(const struct table *table, size_t row, int column, double *value);
const char *table_read_float(const struct table *table, size_t row, int column, float *value);
const char *table_read_time_us(const struct table *table, size_t row, int column, int64_t *time_us);
bool table_is_frame_number(const struct table *table, int column);
const char *table_read_int32(const struct table *table, size_t row, int column, int32_t *value);

/* The cell's text as in the file, or, in the buffer, as a CSV file would have it. */
#define TABLE_TEXT_BYTES 340
const char *table_cell_text(const struct table *table, size_t row, int column,
                            char buffer[TABLE_TEXT_BYTES]);

/* Whether the cell's text is this word. */
bool table_is_word(const struct table *table, size_t row, int column, const char *word);

/* The cell as a number; exit 2 with file, line and column where it is not one. */
double table_number_at(const struct table *table, size_t row, int column);

/* The cell as a number, or `otherwise` where there is no such column (-1) or the cell is empty. */
double table_number_or(const struct table *table, size_t row, int column, double otherwise);

/*
 * Makes a table of numbers, for a source that is not text. Its first column is t_s. Adding a row
 * returns its cells, all empty (NaN); the cell of t_s is not used.
 */
struct table *table_make_empty_of_numbers(const char *path, const struct table_column *columns,
                                          size_t num_columns);
double *table_add_row_of_numbers(struct table *table, int64_t time_us, uint32_t line);

/* Writing the header and a row as lines of a CSV file. */
void table_write_header(FILE *file, const struct table *table);
void table_write_row(FILE *file, const struct table *table, size_t row);

/* Prints `rhotrack: FILE:LINE: ` and the message; exit 2. */
_Noreturn void table_fail_at_row(const struct table *table, size_t row, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
