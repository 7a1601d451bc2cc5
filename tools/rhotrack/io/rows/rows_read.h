/* SPDX-License-Identifier: MIT */
/*
 * rows_read: rows from a CSV file, each checked by what its message may hold.
 *
 * Columns scan and epoch, of scans and lists both, number these; a file without them has none
 * numbered. Times of scans do not go back, but within a scan that has a number; nor do those of a
 * column received_s, of plots: then all times may go back.
 */
#ifndef RHOTRACK_TOOL_ROWS_READ_H
#define RHOTRACK_TOOL_ROWS_READ_H

#include <stdbool.h>

#include "io/rows/rows.h"
#include "settings/parameters.h"

/* A file and what was read of it. */
struct rows_file {
    char *path;
    bool keep_going;
    struct rows rows;
    bool has_scan, has_epoch; /* the columns */
    uint64_t rows_skipped;
};

/*
 * Reads a file. Errors: exit 2, with file and line; with keep_going bad rows are skipped and
 * counted instead. Places of radars that the file does not say come from the parameters.
 */
void rows_read_csv(struct rows_file *file, const char *path, const struct parameters *parameters,
                   bool keep_going);

/*
 * The same from a table, which stays the caller's; path is for messages. False: there is not one
 * good row.
 */
struct table;
bool rows_read_table(struct rows_file *file, const char *path, const struct table *table,
                     const struct parameters *parameters, bool keep_going);

/* A row that turned out bad: exit 2 with its line, or counted. */
void rows_refuse_row(struct rows_file *file, const struct row *row, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void rows_read_end(struct rows_file *file);

#endif
