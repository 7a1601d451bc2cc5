/* SPDX-License-Identifier: MIT */
/*
 * Reads tables, as a whole and row by row: bytes of a file to lines, lines to rows.
 */
#include "io/csv/table_stream.h"

#include <csv.h>
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/common.h"
#include "base/parse.h"
#include "io/asterix/asterix_file.h"
#include "io/asterix/asterix_plot_rows.h"
#include "io/asterix/asterix_track_table.h"
#include "io/csv/columns.h"
#include "io/csv/dialect.h"
#include "settings/parameters.h"

#define FIRST_CAPACITY (1u << 16)
#define FIRST_TEXT 1024u

/*
 * State of reading. libcsv does not count lines, so the file is given to it line by line, and each
 * row keeps the line on which it began. In memory are: the newest whole row, the row under way from
 * its second line on (refused rows are read again from there), and bytes read ahead.
 */
struct table_stream {
    struct table *table;
    const struct parameters *parameters; /* NULL: none; used for the header */
    bool keep_going, is_whole, follow, is_plain;
    int file;                          /* file descriptor; -1 for an ASTERIX recording */
    struct asterix_plot_rows *asterix; /* ASTERIX recording; NULL: a CSV file */
    /* path, to see whether the file was replaced; NULL: standard input */
    const char *own;
    struct csv_parser parser;
    char delimiter; /* separator of cells; 0: no header yet */
    char *joined;   /* buffer for a line with commas in place of blanks */
    size_t joined_capacity;
    char *content;
    size_t bytes, capacity, position;
    uint64_t offset; /* offset in the file of content */
    bool is_end;     /* the file has no bytes after the content */
    uint32_t line;   /* number of the current line, from 1 */
    size_t text_used, text_header, text_capacity;
    char **row; /* cells of the row under way */
    size_t row_cells, row_capacity, row_text, row_bytes;
    uint32_t row_line;
    size_t row_next; /* position of the line after the row's first line */
    bool row_is_open, row_is_complete, has_row;
    size_t rows_capacity;
};

_Noreturn static void fail_at_line(const struct table_stream *stream, uint32_t line,
                                   const char *what)
{
    fail(EXIT_USAGE, "%s:%u: %s", stream->table->path, (unsigned)line, what);
}

/* Drops the bytes of rows that were parsed, unless the whole file is kept. */
static void drop_parsed_bytes(struct table_stream *stream)
{
    size_t keep = stream->row_is_open ? stream->row_next : stream->position;

    if (stream->is_whole || keep == 0) {
        return;
    }
    memmove(stream->content, stream->content + keep, stream->bytes - keep);
    stream->bytes -= keep;
    stream->position -= keep;
    stream->row_next -= stream->row_is_open ? keep : 0;
    stream->offset += keep;
}

/* Whether a pipe has no bytes ready, which with follow is not waited for. */
static bool is_followed_pipe_silent(const struct table_stream *stream)
{
    struct pollfd ready = {.fd = stream->file, .events = POLLIN};

    return stream->follow && !stream->is_plain && poll(&ready, 1, 0) <= 0;
}

/* Reads more bytes, or finds that the file ends; false where neither is possible yet. */
static bool read_more(struct table_stream *stream)
{
    ssize_t got;

    if (is_followed_pipe_silent(stream)) {
        return false;
    }
    drop_parsed_bytes(stream);
    if (stream->capacity == stream->bytes) {
        stream->capacity *= 2;
        stream->content = must_realloc(stream->content, stream->capacity);
    }
    do {
        got = read(stream->file, stream->content + stream->bytes, stream->capacity - stream->bytes);
    } while (got < 0 && errno == EINTR);
    if (got < 0) {
        fail(EXIT_USAGE, "%s: %s", stream->table->path, strerror(errno));
    }
    stream->bytes += (size_t)got;
    stream->is_end = got == 0 && !(stream->follow && stream->is_plain);
    return got > 0 || stream->is_end;
}

/*
 * Length of the line at the current position with its line end; 0 where it is not there as a whole,
 * or there is none.
 */
static size_t complete_line_length(const struct table_stream *stream)
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

/* Whether a line outside a row is blank or a comment. */
static bool is_blank_or_comment(const char *line, size_t length)
{
    size_t i = 0;

    while (i < length && strchr(" \t\r\n", line[i])) {
        i++;
    }
    return i == length || line[i] == '#';
}

/*
 * Whether a name points into the file's text; others are constants (columns.h).
 */
static bool is_name_in_text(const struct table_stream *stream, const char *name)
{
    const char *text = stream->table->text;

    return (uintptr_t)name >= (uintptr_t)text &&
           (uintptr_t)name < (uintptr_t)text + stream->text_used;
}

/* Makes room for a cell's text; names and cells that point into the text are moved with it. */
static void grow_cell_text(struct table_stream *stream, size_t bytes)
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
        if (is_name_in_text(stream, table->names[i])) {
            table->names[i] = text + (table->names[i] - table->text);
        }
    }
    for (size_t i = 0; i < stream->row_cells; i++) {
        stream->row[i] = text + (stream->row[i] - table->text);
    }
    free(table->text);
    table->text = text;
}

/* Appends a cell that libcsv has parsed to the row under way. */
static void append_parsed_cell(void *cell, size_t bytes, void *user)
{
    struct table_stream *stream = user;
    char *text;

    if (stream->row_cells == stream->row_capacity) {
        stream->row_capacity = 2 * stream->row_capacity + 16;
        stream->row = must_realloc(stream->row, stream->row_capacity * sizeof *stream->row);
    }
    grow_cell_text(stream, bytes);
    text = stream->table->text + stream->text_used;
    memcpy(text, cell, bytes);
    text[bytes] = '\0';
    if (stream->delimiter != ',') {
        dialect_point_for_comma(text);
    }
    stream->text_used += bytes + 1;
    stream->row[stream->row_cells++] = text;
}

/* Notes that libcsv has come to the end of a row. */
static void mark_row_complete(int end, void *user)
{
    (void)end;
    ((struct table_stream *)user)->row_is_complete = true;
}

/* Starts the parser again, with the file's separator. */
static void restart_csv_parser(struct table_stream *stream)
{
    if (csv_init(&stream->parser, CSV_STRICT | CSV_STRICT_FINI)) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    csv_set_blk_size(&stream->parser, 4096);
    if (stream->delimiter == ';' || stream->delimiter == '\t') {
        csv_set_delim(&stream->parser, (unsigned char)stream->delimiter);
    }
    stream->row_is_open = stream->row_is_complete = false;
}

static void begin_row(struct table_stream *stream, size_t length)
{
    if (!stream->is_whole) {
        stream->table->num_rows = 0; /* the new row replaces the newest one */
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
 * Handles a bad row: exit 2, or with keep_going skips its first line alone, since the further lines
 * may belong to it only by a wrong quotation mark. A bad header is always an error.
 */
static void fail_or_skip_row(struct table_stream *stream, const char *what)
{
    if (!stream->keep_going || !stream->table->names) {
        fail_at_line(stream, stream->row_line, what);
    }
    stream->table->rows_skipped++;
    stream->text_used = stream->row_text;
    stream->position = stream->row_next;
    stream->line = stream->row_line + 1;
    csv_free(&stream->parser);
    restart_csv_parser(stream);
}

static void process_header_row(struct table_stream *stream)
{
    struct table *table = stream->table;
    double number;

    table->header_line = stream->row_line;
    table->num_columns = stream->row_cells;
    table->names = must_alloc(stream->row_cells * sizeof *table->names);
    memcpy(table->names, stream->row, stream->row_cells * sizeof *table->names);
    stream->text_header = stream->text_used;
    if (!parse_number_or_give_reason(table->names[0], &number)) {
        table_fail_at_row(table, TABLE_HEADER, "no header row: the first row begins with a number");
    }
    for (size_t i = 0; i < table->num_columns; i++) {
        for (size_t j = 0; j < i && *table->names[i]; j++) {
            if (!strcmp(table->names[i], table->names[j])) {
                table_fail_at_row(table, TABLE_HEADER, "column '%.60s' occurs twice",
                                  table->names[i]);
            }
        }
    }
    columns_rename(table);
    table->frame_rate_hz =
        stream->parameters ? stream->parameters->value[PARAMETER_FRAME_RATE_HZ] : -1;
}

static void add_row_to_table(struct table_stream *stream)
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

static void process_complete_row(struct table_stream *stream)
{
    size_t expected = stream->table->num_columns;
    char what[80];

    stream->row_is_open = stream->row_is_complete = false;
    if (!stream->table->names) {
        process_header_row(stream);
        return;
    }
    if (stream->row_cells == expected) {
        add_row_to_table(stream);
        return;
    }
    snprintf(what, sizeof what, "%s row: %zu cells, the header has %zu",
             stream->row_cells < expected ? "short" : "long", stream->row_cells, expected);
    fail_or_skip_row(stream, what);
}

static const char *join_blanks(struct table_stream *stream, const char *line, size_t *length)
{
    if (*length > stream->joined_capacity) {
        stream->joined_capacity = 2 * *length;
        stream->joined = must_realloc(stream->joined, stream->joined_capacity);
    }
    *length = dialect_join_blanks(line, *length, stream->joined);
    return stream->joined;
}

static const char too_long[] = "a row of more than 1 MiB: a quoted cell has no end";

/* Gives the line at the current position to libcsv, and completes a row that ends with it. */
static void parse_line(struct table_stream *stream, size_t length)
{
    const char *line = stream->content + stream->position;

    if (!stream->delimiter) {
        stream->delimiter = dialect_find_delimiter(line, length);
        csv_free(&stream->parser);
        restart_csv_parser(stream);
    }
    if (!stream->row_is_open) {
        begin_row(stream, length);
    }
    stream->position += length;
    stream->line++;
    stream->row_bytes += length;
    if (!stream->is_whole && stream->row_bytes > TABLE_STREAM_ROW_BYTES) {
        fail_or_skip_row(stream, too_long);
        return;
    }
    if (stream->delimiter == ' ') {
        line = join_blanks(stream, line, &length);
    }
    if (csv_parse(&stream->parser, line, length, append_parsed_cell, mark_row_complete, stream) !=
        length) {
        if (csv_error(&stream->parser) != CSV_EPARSE) {
            fail(EXIT_RUNTIME, "%s: %s", stream->table->path,
                 csv_strerror(csv_error(&stream->parser)));
        }
        fail_or_skip_row(stream, "a quotation mark inside a cell");
    } else if (stream->row_is_complete) {
        process_complete_row(stream);
    }
}

/*
 * Name of the binary format that a file begins with, as an error message; NULL: it may be text.
 * Recordings and logs that are plain files do not get here.
 */
static const char *message_for_binary_format(const uint8_t *start, size_t bytes, bool is_file)
{
    static const uint8_t log_sync[] = {0xED, 0xA1, 0xDA, 0x01};

    if (bytes >= sizeof log_sync && memcmp(start, log_sync, sizeof log_sync) == 0) {
        return "an LCM log on standard input or through a pipe: give it as a file";
    }
    if (bytes < 2 || start[1] > 8) {
        return NULL;
    }
    if (!asterix_category_is_known((uint8_t)start[0])) {
        return NULL;
    }
    return is_file
               ? "ASTERIX with a bad first block: rename it to NAME.ast to see where"
               : "ASTERIX on standard input or through a pipe; it is read twice: give it as a file";
}

/* Exit 2 with the format's name where the file is not CSV. */
static void refuse_foreign_format(const struct table_stream *stream)
{
    const char *start = stream->content + stream->position, *what = NULL;

    if (stream->offset + stream->position == 0) {
        what = message_for_binary_format((const uint8_t *)start, stream->bytes - stream->position,
                                         stream->own && stream->is_plain);
    }
    if (*start == '{') {
        what = "JSON, but CSV is needed; GeoJSON can only be written: give the tracks' CSV file or "
               "LCM log";
    }
    if (what) {
        fail_at_line(stream, stream->line, what);
    }
}

/* Exit 2 where a line is of another format than CSV, has NUL bytes or is too long. */
static void refuse_bad_line(const struct table_stream *stream, size_t length)
{
    if (length > 0 && !stream->table->names && !stream->row_is_open) {
        refuse_foreign_format(stream);
    }
    if (memchr(stream->content + stream->position, '\0', length)) {
        fail_at_line(stream, stream->line, "not a text file: it has a NUL byte");
    }
    if (!stream->is_whole && length > TABLE_STREAM_ROW_BYTES) {
        fail_at_line(stream, stream->line, "a line of more than 1 MiB");
    }
}

/* Refuses the row where the bytes read ahead have no line end and are too many. */
static void refuse_too_long_row(struct table_stream *stream)
{
    size_t from = stream->row_is_open ? stream->row_next : stream->position;

    if (stream->is_whole || stream->bytes - from <= TABLE_STREAM_ROW_BYTES) {
        return;
    }
    refuse_bad_line(stream, stream->bytes - stream->position);
    fail_or_skip_row(stream, too_long);
}

static void skip_byte_order_mark(struct table_stream *stream, size_t *length)
{
    if (stream->offset + stream->position == 0 && *length >= 3 &&
        !memcmp(stream->content, "\xEF\xBB\xBF", 3)) {
        stream->position = 3;
        *length -= 3;
    }
}

/*
 * Finds the line at the current position, and reads more bytes as needed. Returns WAITS where it is
 * not there yet, END at the end of the file, else ROW.
 */
static enum table_stream_found find_line(struct table_stream *stream, size_t *length)
{
    while ((*length = complete_line_length(stream)) == 0) {
        if (stream->is_end) {
            return TABLE_STREAM_END;
        }
        refuse_too_long_row(stream);
        if (complete_line_length(stream) == 0 && !read_more(stream)) {
            return TABLE_STREAM_WAITS;
        }
    }
    skip_byte_order_mark(stream, length);
    return TABLE_STREAM_ROW;
}

/*
 * Ends a last row without a line end, or refuses it where its quotes are not closed. Returns false
 * where there was no such row.
 */
static bool finish_last_row(struct table_stream *stream)
{
    if (csv_fini(&stream->parser, append_parsed_cell, mark_row_complete, stream)) {
        fail_or_skip_row(stream, "a quoted cell has no end");
        return true;
    }
    if (stream->row_is_complete) {
        process_complete_row(stream);
        return true;
    }
    return false;
}

static void process_line(struct table_stream *stream, size_t length)
{
    refuse_bad_line(stream, length);
    if (stream->row_is_open || !is_blank_or_comment(stream->content + stream->position, length)) {
        parse_line(stream, length);
    } else {
        stream->position += length;
        stream->line++;
    }
}

/* Reads on to the next row, or with to_header to the header. */
static enum table_stream_found parse_to_row(struct table_stream *stream, bool to_header)
{
    if (stream->asterix) {
        if (to_header) {
            return TABLE_STREAM_ROW; /* the header of a recording is there from the start */
        }
        if (!stream->is_whole) {
            stream->table->num_rows = 0;
        }
        stream->is_end = !asterix_plot_rows_next(stream->asterix, stream->table);
        return stream->is_end ? TABLE_STREAM_END : TABLE_STREAM_ROW;
    }
    stream->has_row = false;
    while (!stream->has_row && !(to_header && stream->table->names)) {
        size_t length;
        enum table_stream_found found = find_line(stream, &length);

        if (found == TABLE_STREAM_WAITS) {
            return found;
        }
        if (found == TABLE_STREAM_ROW) {
            process_line(stream, length);
        } else if (!finish_last_row(stream)) {
            return found;
        }
    }
    return TABLE_STREAM_ROW;
}

static void need_header(const struct table_stream *stream)
{
    if (stream->table->names) {
        return;
    }
    if (stream->offset + stream->bytes == 0) {
        fail_at_line(stream, 1, "the file is empty");
    }
    fail_at_line(stream, stream->line - 1, "no header row");
}

/* Exit 2 where the file has no header, or rows of which none is good. */
static void fail_if_all_rows_bad(const struct table_stream *stream)
{
    const struct table *table = stream->table;

    need_header(stream);
    if (!table->num_rows && table->rows_skipped) {
        fail_at_line(stream, table->header_line, "no valid row after the header");
    }
}

static struct table_stream *open_stream(const char *path, const struct parameters *parameters,
                                        bool keep_going, bool follow)
{
    bool is_standard = !strcmp(path, "-");
    struct table_stream *stream = must_calloc(1, sizeof *stream);
    struct stat status;

    stream->table = must_calloc(1, sizeof *stream->table);
    stream->table->path = must_copy_text(is_standard ? "standard input" : path);
    stream->own = is_standard ? NULL : stream->table->path;
    stream->parameters = parameters;
    stream->keep_going = keep_going;
    stream->line = 1;
    stream->follow = follow;
    stream->capacity = FIRST_CAPACITY;
    stream->content = must_alloc(stream->capacity);
    restart_csv_parser(stream);
    stream->file = -1;
    if (!is_standard && asterix_file_is_asterix(path)) {
        if (stream->follow) {
            fail(EXIT_USAGE, "%s: --follow takes CSV files, but this is an ASTERIX recording",
                 path);
        }
        stream->asterix = asterix_plot_rows_open(path, parameters, stream->keep_going);
        table_free(stream->table);
        stream->table =
            asterix_plot_rows_empty_table(path, asterix_plot_rows_columns(stream->asterix));
        return stream;
    }
    stream->file = is_standard ? dup(STDIN_FILENO) : open(path, O_RDONLY | O_CLOEXEC);
    if (stream->file < 0) {
        fail(EXIT_USAGE, "%s: %s", stream->table->path, strerror(errno));
    }
    stream->is_plain = fstat(stream->file, &status) == 0 && S_ISREG(status.st_mode);
    return stream;
}

/* Frees the stream without its table. */
static void free_stream_not_table(struct table_stream *stream)
{
    if (stream->file >= 0) {
        close(stream->file);
    }
    asterix_plot_rows_close(stream->asterix);
    csv_free(&stream->parser);
    free(stream->row);
    free(stream->joined);
    free(stream->content);
    free(stream);
}

/* Parses the whole content to rows, and frees the stream. */
static struct table *parse_whole_and_free_stream(struct table_stream *stream)
{
    struct table *table = stream->table;

    /* a cell is never longer than its text in the file */
    stream->text_capacity = stream->bytes + 2;
    table->text = must_alloc(stream->text_capacity);
    while (parse_to_row(stream, false) == TABLE_STREAM_ROW) {
    }
    fail_if_all_rows_bad(stream);
    free_stream_not_table(stream);
    return table;
}

struct table *table_read(const char *path, bool keep_going)
{
    return table_read_csv_or_asterix(path, NULL, keep_going);
}

struct table *table_read_csv_or_asterix(const char *path, const struct parameters *parameters,
                                        bool keep_going)
{
    struct table_stream *stream;

    if (strcmp(path, "-") != 0 && asterix_file_has_only_tracks(path)) {
        return asterix_track_table_read(path, parameters, keep_going);
    }
    stream = open_stream(path, parameters, keep_going, false);

    stream->is_whole = true;
    while (!stream->asterix && !stream->is_end) {
        read_more(stream);
    }
    return parse_whole_and_free_stream(stream);
}

struct table_stream *table_stream_open(const char *path, const struct parameters *parameters,
                                       bool keep_going, bool follow)
{
    struct table_stream *stream = open_stream(path, parameters, keep_going, follow);

    stream->text_capacity = FIRST_TEXT;
    stream->table->text = must_alloc(stream->text_capacity);
    if (parse_to_row(stream, true) == TABLE_STREAM_END) {
        need_header(stream);
    }
    return stream;
}

enum table_stream_found table_stream_next(struct table_stream *stream)
{
    enum table_stream_found found = parse_to_row(stream, false);

    if (found == TABLE_STREAM_END) {
        need_header(stream);
    }
    return found;
}

void table_stream_set_quiet(struct table_stream *stream)
{
    if (stream->asterix) {
        asterix_plot_rows_set_quiet(stream->asterix);
    }
}

const struct table *table_stream_table(const struct table_stream *stream)
{
    return stream->table;
}

const char *table_stream_why_not_followed(const struct table_stream *stream)
{
    struct stat now, own;

    if (!stream->is_plain || fstat(stream->file, &now)) {
        return NULL;
    }
    if ((uint64_t)now.st_size < stream->offset + stream->bytes) {
        return "has become shorter";
    }
    if (stream->own && stat(stream->own, &own)) {
        return "is gone";
    }
    return stream->own && (own.st_ino != now.st_ino || own.st_dev != now.st_dev)
               ? "has been replaced by another file"
               : NULL;
}

bool table_stream_is_mid_row(const struct table_stream *stream)
{
    return stream->row_is_open || stream->position < stream->bytes;
}

uint64_t table_stream_position(const struct table_stream *stream)
{
    return stream->asterix ? asterix_plot_rows_position(stream->asterix)
                           : stream->offset + stream->position;
}

void table_stream_close(struct table_stream *stream)
{
    table_free(stream->table);
    free_stream_not_table(stream);
}

struct table *table_read_header(const char *path)
{
    struct table_stream *stream = table_stream_open(path, NULL, false, false);
    struct table *table = stream->table;

    free_stream_not_table(stream);
    return table;
}
