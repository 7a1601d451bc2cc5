/* SPDX-License-Identifier: MIT */
/*
 * rows_from_csv: reads the rows of a CSV file, and checks that messages can hold each.
 *
 * Columns scan and epoch number scans and lists. Times of scans must not go back, except within a
 * numbered scan. Where plots have a column received_s, its times must not go back instead.
 */
#ifndef RHOTRACK_TOOL_ROWS_FROM_CSV_H
#define RHOTRACK_TOOL_ROWS_FROM_CSV_H

#include <stdbool.h>

#include "io/rows/rows_in_memory.h"
#include "settings/parameters.h"

/* A file's rows. */
struct rows_file {
    char *path;
    bool keep_going;
    struct rows rows;
    bool has_scan, has_epoch; /* the file has these columns */
    bool has_frames;          /* times are numbers of frames */
    uint64_t rows_skipped;
};

/*
 * Reads a file. Errors: exit 2, with file and line; with keep_going bad rows are skipped and
 * counted instead. Positions of radars that the file lacks come from the parameters.
 */
void rows_read_csv_or_asterix(struct rows_file *file, const char *path,
                              const struct parameters *parameters, bool keep_going);

/*
 * Reads rows from a table, which stays the caller's; path is for error messages. Returns false
 * where there is no good row.
 */
struct table;
bool rows_read_table_and_has_any(struct rows_file *file, const char *path,
                                 const struct table *table, const struct parameters *parameters,
                                 bool keep_going);

/* Handles a bad row: exit 2 with its line, or with keep_going counts it. */
void rows_refuse_row(struct rows_file *file, const struct row *row, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void rows_file_free(struct rows_file *file);

#endif
