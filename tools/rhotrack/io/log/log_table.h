/* SPDX-License-Identifier: MIT */
/*
 * log_table: messages of one kind in an LCM log as a table with the columns that
 * `convert` writes.
 */
#ifndef RHOTRACK_TOOL_LOG_TABLE_H
#define RHOTRACK_TOOL_LOG_TABLE_H

#include <stdbool.h>

#include "io/csv/csv_table.h"
#include "io/rows/rows_in_memory.h"

/*
 * Reads the table, or returns NULL where the log has no message of the kind. Bad messages: exit 2,
 * or with keep_going skipped and counted on standard error. reports_damage: damaged places of the
 * log are reported too; callers that read several kinds from one log set it once.
 */
struct table *log_table_read(const char *path, const struct rows_kind *kind, bool keep_going,
                             bool reports_damage);

/*
 * The table of a CSV file, of an ASTERIX recording of tracks, or of a log's messages of one kind;
 * exit 2 where the log has none.
 */
struct table *log_table_or_csv(const char *path, const struct rows_kind *kind, bool keep_going);

#endif
