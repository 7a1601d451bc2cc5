/* SPDX-License-Identifier: MIT */
/*
 * table_stream: a CSV file row by row, in memory that does not grow with the file. What is refused,
 * and the messages, are those of table.h; besides a row of more than TABLE_STREAM_ROW_BYTES.
 */
#ifndef RHOTRACK_TOOL_TABLE_STREAM_H
#define RHOTRACK_TOOL_TABLE_STREAM_H

#include "io/csv/table.h"

#define TABLE_STREAM_ROW_BYTES                                                                     \
    (1u << 20) /* a quotation mark without a second one takes no more of the file */

struct table_stream;

enum table_stream_found {
    TABLE_STREAM_ROW,
    TABLE_STREAM_END,
    TABLE_STREAM_WAITS /* with follow: no further whole row yet */
};

/*
 * Opens a file or a pipe; path "-" is standard input. Its header is there then. With follow the end
 * of a plain file is none (not of a recording in ASTERIX: exit 2): rows may still be added, and a
 * last line without an end waits for its rest; so may the header.
 */
struct table_stream *table_stream_open(const char *path, const struct parameters *parameters,
                                       bool keep_going, bool follow);

/*
 * The next row, which is then row 0 of the table. A pipe is waited for without follow, never with
 * it.
 */
enum table_stream_found table_stream_next(struct table_stream *stream);

/* Nothing is said at the end of what was skipped: of a stream that only looks. */
void table_stream_report_nothing(struct table_stream *stream);

/* The stream's own: names, once there is a header, and the newest row. */
const struct table *table_stream_table(const struct table_stream *stream);

/* Why nothing more can come of a file that is followed ("has become shorter"), or NULL. */
const char *table_stream_why_ended(const struct table_stream *stream);

/* The end of what is there is in the middle of a row. */
bool table_stream_is_mid_row(const struct table_stream *stream);

/* How far the file is read, and how long it is; 0 where that is not known. */
uint64_t table_stream_position(const struct table_stream *stream);
uint64_t table_stream_size(const struct table_stream *stream);

void table_stream_close(struct table_stream *stream);

#endif
