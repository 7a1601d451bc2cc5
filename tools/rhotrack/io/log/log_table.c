/* SPDX-License-Identifier: MIT */
#include "io/log/log_table.h"

#include <inttypes.h>
#include <stdio.h>

#include "base/common.h"
#include "io/asterix/asterix_file.h"
#include "io/asterix/asterix_track_table.h"
#include "io/log/lcm_log.h"
#include "io/rows/rows_from_messages.h"
#include "io/rows/rows_to_csv.h"

struct table *log_table_read(const char *path, const struct rows_kind *kind, bool keep_going,
                             bool reports_damage)
{
    struct rows_collection collection;
    struct lcm_log_reader *log = lcm_log_open(path);
    struct table *table = NULL;

    rows_from_messages_start(&collection, kind);
    struct lcm_log_event event;

    while (lcm_log_next(log, &event)) {
        rows_from_messages_add_event(&collection, path, &event, keep_going);
    }
    rows_from_messages_sort(&collection);
    if (reports_damage) {
        lcm_log_report_skipped(log);
    }
    if (collection.messages_bad > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " bad messages skipped\n", path,
                collection.messages_bad);
    }
    if (collection.rows.count > 0) {
        table = rows_to_table(path, &collection.rows);
    }
    rows_from_messages_free(&collection);
    lcm_log_close(log);
    return table;
}

struct table *log_table_or_csv(const char *path, const struct rows_kind *kind, bool keep_going)
{
    struct table *table;

    if (!lcm_log_is_log(path)) {
        return kind == &rows_kind_tracks && asterix_file_is_asterix(path)
                   ? asterix_track_table_read(path, NULL, keep_going)
                   : table_read(path, keep_going);
    }
    table = log_table_read(path, kind, keep_going, true);
    if (!table) {
        fail(EXIT_USAGE, "%s: contains no messages of %s (channel %s)", path, kind->name,
             kind->channel);
    }
    return table;
}
