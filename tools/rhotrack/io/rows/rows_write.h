/* SPDX-License-Identifier: MIT */
/*
 * rows_write: rows as a CSV file. Times to the microsecond, numbers in the fewest digits that keep
 * float32; optional columns are there where a row needs them, scan and epoch always.
 */
#ifndef RHOTRACK_TOOL_ROWS_WRITE_H
#define RHOTRACK_TOOL_ROWS_WRITE_H

#include <stdio.h>

#include "io/csv/table.h"
#include "io/rows/rows.h"

void rows_write_csv(FILE *file, const struct rows *rows, bool with_covariance);

/*
 * The same as a table, covariances too, without the times of reception; a row's line is that of
 * such a file.
 */
struct table *rows_to_table(const char *path, const struct rows *rows);

#endif
