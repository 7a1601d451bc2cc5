/* SPDX-License-Identifier: MIT */
/* Lines to rows. */
#include "table_parse.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"

_Noreturn void table_parse_fail(const struct table_stream *stream, uint32_t line, const char *what)
{
    fail(EXIT_USAGE, "%s:%u: %s", stream->table->path, (unsigned)line, what);
}

/* Length of the line at the current position with its end; 0: it is not there as a whole, or there is none. */
static size_t line_length(const struct table_stream *stream)
{
    const char *start = stream->content + stream->position, *c = start;
    const char *end = stream->content + stream->bytes;

    while (c < end && *c != '\n' && *c != '\r') {
        c++;
    }
    if (c == end || (c + 1 == end && *c == '\r')) {
        return stream->is_end ? (size_t)(end - start) : 0;
    }
    if (*c++ == '\r' && *c == '\n') {
        c++;
    }
    return (size_t)(c - start);
}

static void check_binary(const struct table_stream *stream, size_t length)
{
    if (memchr(stream->content + stream->position, '\0', length)) {
        table_parse_fail(stream, stream->line, "not a text file: it has a NUL byte");
    }
}

/* True where a line outside a row says nothing: blank, or a comment. */
static bool is_idle(const char *line, size_t length)
{
    size_t i = 0;

    while (i < length && strchr(" \t\r\n", line[i])) {
        i++;
    }
    return i == length || line[i] == '#';
}

/* ---- Rows ---- */

/* Room for a cell. Names and cells that are there keep their places in the text. */
static void grow_text(struct table_stream *stream, size_t bytes)
{
    struct table *table = stream->table;
    char *text;

    if (stream->text_used + bytes + 1 <= stream->text_capacity) {
        return;
    }
    stream->text_capacity = 2 * (stream->text_used + bytes + 1);
    text = must_alloc(stream->text_capacity);
    memcpy(text, table->text, stream->text_used);
    for (size_t i = 0; table->names && i < table->num_columns; i++) {
        table->names[i] = text + (table->names[i] - table->text);
    }
    for (size_t i = 0; i < stream->row_cells; i++) {
        stream->row[i] = text + (stream->row[i] - table->text);
    }
    free(table->text);
    table->text = text;
}

static void on_cell(void *cell, size_t bytes, void *user)
{
    struct table_stream *stream = user;
    char *text;

    if (stream->row_cells == stream->row_capacity) {
        stream->row_capacity = 2 * stream->row_capacity + 16;
        stream->row = must_realloc(stream->row, stream->row_capacity * sizeof *stream->row);
    }
    grow_text(stream, bytes);
    text = stream->table->text + stream->text_used;
    memcpy(text, cell, bytes);
    text[bytes] = '\0';
    stream->text_used += bytes + 1;
    stream->row[stream->row_cells++] = text;
}

static void on_row_end(int end, void *user)
{
    (void)end;
    ((struct table_stream *)user)->row_is_complete = true;
}

void table_parse_start(struct table_stream *stream)
{
    if (csv_init(&stream->parser, CSV_STRICT | CSV_STRICT_FINI)) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    csv_set_blk_size(&stream->parser, 4096);
    stream->row_is_open = stream->row_is_complete = false;
}

static void begin_row(struct table_stream *stream, size_t length)
{
    if (!stream->is_whole) {
        stream->table->num_rows = 0; /* the new one takes its place */
        stream->text_used = stream->text_header;
    }
    stream->row_is_open = true;
    stream->row_line = stream->line;
    stream->row_cells = 0;
    stream->row_bytes = 0;
    stream->row_text = stream->text_used;
    stream->row_next = stream->position + length;
}

/*
 * A bad row is the end, or with keep_going forgotten: reading goes on behind its first line, since
 * the others may belong to it only by a wrong quotation mark. The header must be good.
 */
static void refuse_row(struct table_stream *stream, const char *what)
{
    if (!stream->keep_going || !stream->table->names) {
        table_parse_fail(stream, stream->row_line, what);
    }
    stream->table->rows_skipped++;
    stream->text_used = stream->row_text;
    stream->position = stream->row_next;
    stream->line = stream->row_line + 1;
    csv_free(&stream->parser);
    table_parse_start(stream);
}

static void keep_header(struct table_stream *stream)
{
    struct table *table = stream->table;
    double number;

    table->header_line = stream->row_line;
    table->num_columns = stream->row_cells;
    table->names = must_alloc(stream->row_cells * sizeof *table->names);
    memcpy(table->names, stream->row, stream->row_cells * sizeof *table->names);
    stream->text_header = stream->text_used;
    if (!table_number(table->names[0], &number)) {
        table_fail(table, TABLE_HEADER, "no header row: the first row begins with a number");
    }
    for (size_t i = 0; i < table->num_columns; i++) {
        for (size_t j = 0; j < i && *table->names[i]; j++) {
            if (!strcmp(table->names[i], table->names[j])) {
                table_fail(table, TABLE_HEADER, "column '%.60s' is there twice", table->names[i]);
            }
        }
    }
}

static void keep_row(struct table_stream *stream)
{
    struct table *table = stream->table;

    if (table->num_rows == stream->rows_capacity) {
        stream->rows_capacity = stream->is_whole ? 2 * stream->rows_capacity + 64 : 1;
        table->lines = must_realloc(table->lines, stream->rows_capacity * sizeof *table->lines);
        table->cells = must_realloc(table->cells, stream->rows_capacity * table->num_columns *
                                                      sizeof *table->cells);
    }
    table->lines[table->num_rows] = stream->row_line;
    memcpy(table->cells + table->num_rows * table->num_columns, stream->row,
           table->num_columns * sizeof *table->cells);
    table->num_rows++;
    stream->has_row = true;
}

static void end_row(struct table_stream *stream)
{
    size_t expected = stream->table->num_columns;
    char what[80];

    stream->row_is_open = stream->row_is_complete = false;
    if (!stream->table->names) {
        keep_header(stream);
        return;
    }
    if (stream->row_cells == expected) {
        keep_row(stream);
        return;
    }
    snprintf(what, sizeof what, "%s row: %zu cells, the header has %zu",
             stream->row_cells < expected ? "short" : "long", stream->row_cells, expected);
    refuse_row(stream, what);
}

static const char too_long[] = "a row of more than 1 MiB: a quoted cell has no end";

/* Gives the line at the current position to libcsv. */
static void parse_line(struct table_stream *stream, size_t length)
{
    const char *line = stream->content + stream->position;

    if (!stream->row_is_open) {
        begin_row(stream, length);
    }
    stream->position += length;
    stream->line++;
    stream->row_bytes += length;
    if (!stream->is_whole && stream->row_bytes > TABLE_STREAM_ROW_BYTES) {
        refuse_row(stream, too_long);
        return;
    }
    if (csv_parse(&stream->parser, line, length, on_cell, on_row_end, stream) != length) {
        if (csv_error(&stream->parser) != CSV_EPARSE) {
            fail(EXIT_RUNTIME, "%s: %s", stream->table->path,
                 csv_strerror(csv_error(&stream->parser)));
        }
        refuse_row(stream, "a quotation mark inside a cell");
    } else if (stream->row_is_complete) {
        end_row(stream);
    }
}

/* ---- Lines ---- */

/* Recordings and logs that come as plain files are read by others; block lengths have no text's bytes. */
static const char *name_binary(const uint8_t *start, size_t bytes, bool is_file)
{
    static const uint8_t log_sync[] = {0xED, 0xA1, 0xDA, 0x01};

    if (bytes >= sizeof log_sync && memcmp(start, log_sync, sizeof log_sync) == 0) {
        return "an LCM log on standard input or through a pipe: give it as a file";
    }
    if (bytes < 2 || start[1] > 8) {
        return NULL;
    }
    if (start[0] == ASTERIX_TRACKS) {
        return asterix_text_no_tracks;
    }
    if (start[0] != ASTERIX_PLOTS && start[0] != ASTERIX_SERVICE) {
        return NULL;
    }
    return is_file ? "ASTERIX with a bad first block: named NAME.ast it is read, and says where"
                   : "ASTERIX on standard input or through a pipe; it is looked at twice: give it "
                     "as a file";
}

/* A file of another format says what it is in place of what it is not. */
static void refuse_foreign(const struct table_stream *stream)
{
    const char *start = stream->content + stream->position, *what = NULL;

    if (stream->offset + stream->position == 0) {
        what = name_binary((const uint8_t *)start, stream->bytes - stream->position,
                           stream->own && stream->is_plain);
    }
    if (*start == '{') {
        what = "JSON, and CSV is needed; GeoJSON is written and not read: give the tracks' CSV "
               "file or LCM log";
    }
    if (what) {
        table_parse_fail(stream, stream->line, what);
    }
}

static void check_line(const struct table_stream *stream, size_t length)
{
    if (length > 0 && !stream->table->names && !stream->row_is_open) {
        refuse_foreign(stream);
    }
    check_binary(stream, length);
    if (!stream->is_whole && length > TABLE_STREAM_ROW_BYTES) {
        table_parse_fail(stream, stream->line, "a line of more than 1 MiB");
    }
}

/* What is read ahead has no line end: it, or the row under way with it, may be too long. */
static void check_length(struct table_stream *stream)
{
    size_t from = stream->row_is_open ? stream->row_next : stream->position;

    if (stream->is_whole || stream->bytes - from <= TABLE_STREAM_ROW_BYTES) {
        return;
    }
    check_line(stream, stream->bytes - stream->position);
    refuse_row(stream, too_long);
}

static void skip_byte_order_mark(struct table_stream *stream, size_t *length)
{
    if (stream->offset + stream->position == 0 && *length >= 3 &&
        !memcmp(stream->content, "\xEF\xBB\xBF", 3)) {
        stream->position = 3;
        *length -= 3;
    }
}

/* The line at the current position. Returns WAITS where it is not there yet, END where there is none; else ROW. */
static enum table_stream_found find_line(struct table_stream *stream, size_t *length)
{
    while ((*length = line_length(stream)) == 0) {
        if (stream->is_end) {
            return TABLE_STREAM_END;
        }
        check_length(stream);
        if (line_length(stream) == 0 && !table_stream_fill(stream)) {
            return TABLE_STREAM_WAITS;
        }
    }
    skip_byte_order_mark(stream, length);
    return TABLE_STREAM_ROW;
}

/* The last row may have no line end, or no end of its quotes. Returns false where nothing more was found. */
static bool finish_rows(struct table_stream *stream)
{
    if (csv_fini(&stream->parser, on_cell, on_row_end, stream)) {
        refuse_row(stream, "a quoted cell has no end");
        return true;
    }
    if (stream->row_is_complete) {
        end_row(stream);
        return true;
    }
    return false;
}

static void take_line(struct table_stream *stream, size_t length)
{
    check_line(stream, length);
    if (stream->row_is_open || !is_idle(stream->content + stream->position, length)) {
        parse_line(stream, length);
    } else {
        stream->position += length;
        stream->line++;
    }
}

/* Goes on up to the next row, or to the header. */
enum table_stream_found table_parse(struct table_stream *stream, bool to_header)
{
    stream->has_row = false;
    while (!stream->has_row && !(to_header && stream->table->names)) {
        size_t length;
        enum table_stream_found found = find_line(stream, &length);

        if (found == TABLE_STREAM_WAITS) {
            return found;
        }
        if (found == TABLE_STREAM_ROW) {
            take_line(stream, length);
        } else if (!finish_rows(stream)) {
            return found;
        }
    }
    return TABLE_STREAM_ROW;
}
