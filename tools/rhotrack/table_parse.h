/* SPDX-License-Identifier: MIT */
/* Private to table_read and table_parse: a table while it is read. */
#ifndef RHOTRACK_TOOL_TABLE_PARSE_H
#define RHOTRACK_TOOL_TABLE_PARSE_H

#include <csv.h>

#include "asterix_text.h"
#include "table_stream.h"

/*
 * libcsv knows no lines, so the file is given to it line by line, and each row keeps the line that
 * it began on. Of a stream there are in memory: the row under way from its second line on (refuse_row may go back to it),
 * and what was read ahead; and the newest whole row.
 */
struct table_stream {
    struct table *table;
    bool keep_going, is_whole, follow, is_plain;
    int file;                     /* -1: all is in memory, or comes from */
    struct asterix_text *asterix; /* a recording; or NULL */
    const char *own;              /* the path to look at again; NULL: standard input */
    struct csv_parser parser;
    char *content;
    size_t bytes, capacity, position;
    uint64_t offset; /* of the content in the file */
    bool is_end;     /* nothing comes behind the content */
    uint32_t line;   /* the current one, 1-based */
    size_t text_used, text_header, text_capacity;
    char **row; /* cells of the row under way */
    size_t row_cells, row_capacity, row_text, row_bytes;
    uint32_t row_line;
    size_t row_next; /* place of the line after the row's first */
    bool row_is_open, row_is_complete, has_row;
    size_t rows_capacity;
};

/* Ready for a first row. */
void table_parse_start(struct table_stream *stream);

/* Goes on up to the next row, or to the header. */
enum table_stream_found table_parse(struct table_stream *stream, bool to_header);

/* Reads more of the file. Returns false where nothing is there yet; at the end is_end is set. */
bool table_stream_fill(struct table_stream *stream);

/* `rhotrack: FILE:LINE: ` and what; exit 2. */
_Noreturn void table_parse_fail(const struct table_stream *stream, uint32_t line, const char *what);

#endif
