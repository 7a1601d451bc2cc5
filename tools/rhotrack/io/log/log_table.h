/* SPDX-License-Identifier: MIT */
/* log_table: messages of one kind in an LCM log as the table that `convert` would make of them. */
#ifndef RHOTRACK_TOOL_LOG_TABLE_H
#define RHOTRACK_TOOL_LOG_TABLE_H

#include <stdbool.h>

#include "io/csv/table.h"
#include "io/rows/rows.h"

/*
 * The table, or NULL where the log has no message of the kind. Bad messages: exit 2, or skipped and
 * counted on standard error with keep_going. is_reported: damaged places of the log are, too; once
 * will do for all kinds.
 */
struct table *log_table_read(const char *path, const struct rows_kind *kind, bool keep_going,
                             bool is_reported);

/* A CSV file's table, or a log's of the kind; exit 2 where it has none. */
struct table *log_table_or_csv(const char *path, const struct rows_kind *kind, bool keep_going);

#endif
