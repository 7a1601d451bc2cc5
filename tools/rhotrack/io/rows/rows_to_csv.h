/* SPDX-License-Identifier: MIT */
/*
 * rows_to_csv: writes rows as a CSV file. Times have microseconds, numbers the fewest digits that
 * keep float32; optional columns are written where a row needs them, scan and epoch always.
 */
#ifndef RHOTRACK_TOOL_ROWS_TO_CSV_H
#define RHOTRACK_TOOL_ROWS_TO_CSV_H

#include <stdio.h>

#include "io/csv/csv_table.h"
#include "io/rows/rows_in_memory.h"

void rows_write_csv(FILE *file, const struct rows *rows, bool with_covariance);

/*
 * Converts rows to a table, with covariances, without reception times; a row's line is that in the
 * CSV file that rows_write_csv would write.
 */
struct table *rows_to_table(const char *path, const struct rows *rows);

#endif
