/* SPDX-License-Identifier: MIT */
/* Reads tables, whole ones and row by row. */
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "asterix_file.h"
#include "common.h"
#include "table_parse.h"

#define FIRST_CAPACITY (1u << 16)
#define FIRST_TEXT 1024u

/* ---- The file ---- */

/* What is no longer wanted goes. */
static void drop_parsed(struct table_stream *stream)
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

/* With follow a pipe is not waited for. */
static bool is_silent(const struct table_stream *stream)
{
    struct pollfd ready = {.fd = stream->file, .events = POLLIN};

    return stream->follow && !stream->is_plain && poll(&ready, 1, 0) <= 0;
}

/* Room for some bytes more than there are. */
static void need_room(struct table_stream *stream, size_t bytes)
{
    while (stream->capacity - stream->bytes < bytes) {
        stream->capacity *= 2;
        stream->content = must_realloc(stream->content, stream->capacity);
    }
}

/* The next line of a recording. */
static void fill_from_asterix(struct table_stream *stream)
{
    size_t length;

    need_room(stream, ASTERIX_LINE_BYTES);
    if (asterix_text_next(stream->asterix, stream->content + stream->bytes, &length)) {
        stream->bytes += length;
    } else {
        stream->is_end = true;
    }
}

bool table_stream_fill(struct table_stream *stream)
{
    ssize_t got;

    if (is_silent(stream)) {
        return false;
    }
    drop_parsed(stream);
    if (stream->asterix) {
        fill_from_asterix(stream);
        return true;
    }
    need_room(stream, 1);
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

static void check_header(const struct table_stream *stream)
{
    if (stream->table->names) {
        return;
    }
    if (stream->offset + stream->bytes == 0) {
        table_parse_fail(stream, 1, "the file is empty");
    }
    table_parse_fail(stream, stream->line - 1, "no header row");
}

static void check_content(const struct table_stream *stream)
{
    const struct table *table = stream->table;

    check_header(stream);
    if (!table->num_rows && table->rows_skipped) {
        table_parse_fail(stream, table->header_line, "not one good row after the header");
    }
}

/* ---- Whole files ---- */

static void open_asterix(struct table_stream *stream, const char *path,
                         const struct parameters *parameters)
{
    if (stream->follow) {
        fail(EXIT_USAGE, "%s: --follow takes CSV files, and this is a recording in ASTERIX", path);
    }
    stream->asterix = asterix_text_open(path, parameters, stream->keep_going);
}

static struct table_stream *open_stream(const char *path, const struct parameters *parameters,
                                        bool keep_going, bool follow)
{
    bool is_standard = !strcmp(path, "-");
    struct table_stream *stream = must_calloc(1, sizeof *stream);
    struct stat status;

    stream->table = must_calloc(1, sizeof *stream->table);
    stream->table->path = must_copy(is_standard ? "standard input" : path);
    stream->own = is_standard ? NULL : stream->table->path;
    stream->keep_going = keep_going;
    stream->line = 1;
    stream->follow = follow;
    stream->capacity = FIRST_CAPACITY;
    stream->content = must_alloc(stream->capacity);
    table_parse_start(stream);
    stream->file = -1;
    if (!is_standard && asterix_file_is_asterix(path)) {
        open_asterix(stream, path, parameters);
        return stream;
    }
    stream->file = is_standard ? dup(STDIN_FILENO) : open(path, O_RDONLY | O_CLOEXEC);
    if (stream->file < 0) {
        fail(EXIT_USAGE, "%s: %s", stream->table->path, strerror(errno));
    }
    stream->is_plain = fstat(stream->file, &status) == 0 && S_ISREG(status.st_mode);
    return stream;
}

/* All but the table. */
static void free_stream(struct table_stream *stream)
{
    if (stream->file >= 0) {
        close(stream->file);
    }
    asterix_text_close(stream->asterix);
    csv_free(&stream->parser);
    free(stream->row);
    free(stream->content);
    free(stream);
}

/* The content as rows; the stream is freed. */
static struct table *parse_whole(struct table_stream *stream)
{
    struct table *table = stream->table;

    stream->text_capacity = stream->bytes + 2; /* a cell is not longer than its text in the file */
    table->text = must_alloc(stream->text_capacity);
    while (table_parse(stream, false) == TABLE_STREAM_ROW) {
    }
    check_content(stream);
    free_stream(stream);
    return table;
}

struct table *table_from_text(const char *path, const char *text, size_t bytes, bool keep_going)
{
    struct table_stream *stream = must_calloc(1, sizeof *stream);

    *stream = (struct table_stream){.table = must_calloc(1, sizeof *stream->table),
                                    .keep_going = keep_going,
                                    .is_whole = true,
                                    .file = -1,
                                    .content = must_alloc(bytes + 1),
                                    .bytes = bytes,
                                    .is_end = true,
                                    .line = 1};
    memcpy(stream->content, text, bytes);
    stream->table->path = must_copy(path);
    table_parse_start(stream);
    return parse_whole(stream);
}

struct table *table_read(const char *path, bool keep_going)
{
    return table_read_as(path, NULL, keep_going);
}

struct table *table_read_as(const char *path, const struct parameters *parameters, bool keep_going)
{
    struct table_stream *stream = open_stream(path, parameters, keep_going, false);

    stream->is_whole = true;
    while (!stream->is_end) {
        table_stream_fill(stream);
    }
    return parse_whole(stream);
}

/* ---- Row by row ---- */

struct table_stream *table_stream_open(const char *path, const struct parameters *parameters,
                                       bool keep_going, bool follow)
{
    struct table_stream *stream = open_stream(path, parameters, keep_going, follow);

    stream->text_capacity = FIRST_TEXT;
    stream->table->text = must_alloc(stream->text_capacity);
    if (table_parse(stream, true) == TABLE_STREAM_END) {
        check_header(stream);
    }
    return stream;
}

enum table_stream_found table_stream_next(struct table_stream *stream)
{
    enum table_stream_found found = table_parse(stream, false);

    if (found == TABLE_STREAM_END) {
        check_header(stream);
    }
    return found;
}

const struct table *table_stream_table(const struct table_stream *stream)
{
    return stream->table;
}

const char *table_stream_why_over(const struct table_stream *stream)
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
    return stream->asterix ? asterix_text_position(stream->asterix)
                           : stream->offset + stream->position;
}

uint64_t table_stream_size(const struct table_stream *stream)
{
    struct stat status;

    return stream->is_plain && fstat(stream->file, &status) == 0 ? (uint64_t)status.st_size : 0;
}

void table_stream_close(struct table_stream *stream)
{
    table_free(stream->table);
    free_stream(stream);
}

struct table *table_read_header(const char *path)
{
    struct table_stream *stream = table_stream_open(path, NULL, false, false);
    struct table *table = stream->table;

    free_stream(stream);
    return table;
}
