/* SPDX-License-Identifier: MIT */
/*
 * table_stream: reads a CSV file row by row, in memory that does not grow with the file. Refusals
 * and messages are those of csv_table.h; a row of more than TABLE_STREAM_ROW_BYTES is
 * refused too.
 */
#ifndef RHOTRACK_TOOL_TABLE_STREAM_H
#define RHOTRACK_TOOL_TABLE_STREAM_H

#include "io/csv/csv_table.h"

#define TABLE_STREAM_ROW_BYTES                                                                     \
    (1u << 20) /* longest row; it limits how much an unclosed quotation mark takes */

struct table_stream;

enum table_stream_found {
    TABLE_STREAM_ROW,
    TABLE_STREAM_END,
    TABLE_STREAM_WAITS /* with follow: no further whole row yet */
};

/*
 * Opens a file or a pipe; path "-" is standard input. The header is then read. With follow the end
 * of a plain file is not final (an ASTERIX recording is refused, exit 2): rows may still be added,
 * and a last line without a line end waits for its rest; the header may be missing yet as well.
 */
struct table_stream *table_stream_open(const char *path, const struct parameters *parameters,
                                       bool keep_going, bool follow);

/* Reads the next row, as row 0 of the table. A pipe is waited for without follow, never with it. */
enum table_stream_found table_stream_next(struct table_stream *stream);

/* Suppresses the report of left-out content at the end, for a stream that only previews a file. */
void table_stream_set_quiet(struct table_stream *stream);

/* The stream's table: column names, once there is a header, and the newest row. */
const struct table *table_stream_table(const struct table_stream *stream);

/* Why a followed file cannot get more rows ("has become shorter"), or NULL. */
const char *table_stream_why_not_followed(const struct table_stream *stream);

/* Whether the bytes read end in the middle of a row. */
bool table_stream_is_mid_row(const struct table_stream *stream);

/* Bytes of the file that were read. */
uint64_t table_stream_position(const struct table_stream *stream);

void table_stream_close(struct table_stream *stream);

#endif
