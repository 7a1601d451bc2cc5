/* SPDX-License-Identifier: MIT */
#include "table.h"

#include <csv.h>
#include <errno.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common.h"

/*
 * libcsv knows no lines, so the file is given to it line by line, and each row keeps the line that
 * it began on.
 */
struct reading {
    struct table *table;
    bool keep_going, header_only;
    struct csv_parser parser;
    char *content; /* the whole file */
    size_t bytes, position;
    uint32_t line; /* the current one, 1-based */
    size_t text_used;
    char **row; /* cells of the row under way */
    size_t row_cells, row_capacity, row_text;
    uint32_t row_line;
    size_t row_next; /* place of the line after the row's first */
    bool row_is_open, row_is_complete;
    size_t rows_capacity;
};

static _Noreturn void fail_at(const char *path, uint32_t line, const char *what)
{
    fail(EXIT_USAGE, "%s:%u: %s", path, (unsigned)line, what);
}

/* ---- The file ---- */

static void read_all(struct reading *reading, FILE *file)
{
    size_t capacity = 1 << 16, got;

    reading->content = must_alloc(capacity);
    while ((got = fread(reading->content + reading->bytes, 1, capacity - reading->bytes, file)) >
           0) {
        reading->bytes += got;
        if (reading->bytes == capacity) {
            reading->content = must_realloc(reading->content, capacity *= 2);
        }
    }
    if (ferror(file)) {
        fail(EXIT_USAGE, "%s: %s", reading->table->path, strerror(errno));
    }
}

static void read_file(struct reading *reading)
{
    static const char byte_order_mark[3] = "\xEF\xBB\xBF";
    FILE *file = fopen(reading->table->path, "rb");

    if (!file) {
        fail(EXIT_USAGE, "%s: %s", reading->table->path, strerror(errno));
    }
    read_all(reading, file);
    fclose(file);
    if (!reading->bytes) {
        fail_at(reading->table->path, 1, "the file is empty");
    }
    if (reading->bytes >= 3 && !memcmp(reading->content, byte_order_mark, 3)) {
        reading->position = 3;
    }
}

/* Length of the line at the current position with its end. */
static size_t line_length(const struct reading *reading)
{
    const char *start = reading->content + reading->position, *c = start;
    const char *end = reading->content + reading->bytes;

    while (c < end && *c != '\n' && *c != '\r') {
        c++;
    }
    if (c < end && *c++ == '\r' && c < end && *c == '\n') {
        c++;
    }
    return (size_t)(c - start);
}

static void check_binary(const struct reading *reading, size_t length)
{
    if (memchr(reading->content + reading->position, '\0', length)) {
        fail_at(reading->table->path, reading->line, "not a text file: it has a NUL byte");
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

static void on_cell(void *cell, size_t bytes, void *user)
{
    struct reading *reading = user;
    char *text = reading->table->text + reading->text_used;

    if (reading->row_cells == reading->row_capacity) {
        reading->row_capacity = 2 * reading->row_capacity + 16;
        reading->row = must_realloc(reading->row, reading->row_capacity * sizeof *reading->row);
    }
    memcpy(text, cell, bytes); /* a cell is never longer than its text in the file */
    text[bytes] = '\0';
    reading->text_used += bytes + 1;
    reading->row[reading->row_cells++] = text;
}

static void on_row_end(int end, void *user)
{
    (void)end;
    ((struct reading *)user)->row_is_complete = true;
}

static void start_parser(struct reading *reading)
{
    if (csv_init(&reading->parser, CSV_STRICT | CSV_STRICT_FINI)) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    csv_set_blk_size(&reading->parser, 4096);
    reading->row_is_open = reading->row_is_complete = false;
}

static void begin_row(struct reading *reading, size_t length)
{
    reading->row_is_open = true;
    reading->row_line = reading->line;
    reading->row_cells = 0;
    reading->row_text = reading->text_used;
    reading->row_next = reading->position + length;
}

/*
 * A bad row is the end, or with keep_going forgotten: reading goes on behind its first line, since
 * the others may belong to it only by a wrong quotation mark. The header must be good.
 */
static void refuse_row(struct reading *reading, const char *what)
{
    if (!reading->keep_going || !reading->table->names) {
        fail_at(reading->table->path, reading->row_line, what);
    }
    reading->table->rows_skipped++;
    reading->text_used = reading->row_text;
    reading->position = reading->row_next;
    reading->line = reading->row_line + 1;
    csv_free(&reading->parser);
    start_parser(reading);
}

static void keep_header(struct reading *reading)
{
    struct table *table = reading->table;
    double number;

    table->header_line = reading->row_line;
    table->num_columns = reading->row_cells;
    table->names = must_alloc(reading->row_cells * sizeof *table->names);
    memcpy(table->names, reading->row, reading->row_cells * sizeof *table->names);
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

static void keep_row(struct reading *reading)
{
    struct table *table = reading->table;

    if (table->num_rows == reading->rows_capacity) {
        reading->rows_capacity = 2 * reading->rows_capacity + 64;
        table->lines = must_realloc(table->lines, reading->rows_capacity * sizeof *table->lines);
        table->cells = must_realloc(table->cells, reading->rows_capacity * table->num_columns *
                                                      sizeof *table->cells);
    }
    table->lines[table->num_rows] = reading->row_line;
    memcpy(table->cells + table->num_rows * table->num_columns, reading->row,
           table->num_columns * sizeof *table->cells);
    table->num_rows++;
}

static void end_row(struct reading *reading)
{
    size_t expected = reading->table->num_columns;
    char what[80];

    reading->row_is_open = reading->row_is_complete = false;
    if (!reading->table->names) {
        keep_header(reading);
        return;
    }
    if (reading->row_cells == expected) {
        keep_row(reading);
        return;
    }
    snprintf(what, sizeof what, "%s row: %zu cells, the header has %zu",
             reading->row_cells < expected ? "short" : "long", reading->row_cells, expected);
    refuse_row(reading, what);
}

/* Gives the line at the current position to libcsv. */
static void parse_line(struct reading *reading, size_t length)
{
    const char *line = reading->content + reading->position;

    if (!reading->row_is_open) {
        begin_row(reading, length);
    }
    reading->position += length;
    reading->line++;
    if (csv_parse(&reading->parser, line, length, on_cell, on_row_end, reading) != length) {
        if (csv_error(&reading->parser) != CSV_EPARSE) {
            fail(EXIT_RUNTIME, "%s: %s", reading->table->path,
                 csv_strerror(csv_error(&reading->parser)));
        }
        refuse_row(reading, "a quotation mark inside a cell");
    } else if (reading->row_is_complete) {
        end_row(reading);
    }
}

static bool is_wanted(const struct reading *reading)
{
    return reading->position < reading->bytes && !(reading->header_only && reading->table->names);
}

static void parse_lines(struct reading *reading)
{
    while (is_wanted(reading)) {
        size_t length = line_length(reading);

        check_binary(reading, length);
        if (reading->row_is_open || !is_idle(reading->content + reading->position, length)) {
            parse_line(reading, length);
        } else {
            reading->position += length;
            reading->line++;
        }
    }
}

/* The last row may have no line end, or no end of its quotes. */
static void finish_rows(struct reading *reading)
{
    if (csv_fini(&reading->parser, on_cell, on_row_end, reading)) {
        refuse_row(reading, "a quoted cell has no end");
    } else if (reading->row_is_complete) {
        end_row(reading);
    }
}

static void check_content(const struct reading *reading)
{
    const struct table *table = reading->table;

    if (!table->names) {
        fail_at(table->path, reading->line - 1, "no header row");
    }
    if (!table->num_rows && table->rows_skipped) {
        fail_at(table->path, table->header_line, "not one good row after the header");
    }
}

void table_need_rows(const struct table *table)
{
    if (!table->num_rows) {
        fail_at(table->path, table->header_line, "no rows after the header");
    }
}

/* The content as rows; it is freed. */
static struct table *parse(struct reading *reading)
{
    struct table *table = reading->table;

    table->text = must_alloc(reading->bytes + 2);
    start_parser(reading);
    do {
        parse_lines(reading);
        finish_rows(reading);
    } while (is_wanted(reading));
    csv_free(&reading->parser);
    check_content(reading);
    free(reading->row);
    free(reading->content);
    return table;
}

static struct table *read_table(const char *path, bool keep_going, bool header_only)
{
    struct reading reading = {.table = must_calloc(1, sizeof *reading.table),
                              .keep_going = keep_going,
                              .header_only = header_only,
                              .line = 1};

    reading.table->path = must_copy(path);
    read_file(&reading);
    return parse(&reading);
}

struct table *table_from_text(const char *path, const char *text, size_t bytes, bool keep_going)
{
    struct reading reading = {.table = must_calloc(1, sizeof *reading.table),
                              .keep_going = keep_going,
                              .line = 1,
                              .content = must_alloc(bytes + 1),
                              .bytes = bytes};

    memcpy(reading.content, text, bytes);
    reading.table->path = must_copy(path);
    return parse(&reading);
}

struct table *table_read(const char *path, bool keep_going)
{
    return read_table(path, keep_going, false);
}

struct table *table_read_header(const char *path)
{
    return read_table(path, false, true);
}

void table_free(struct table *table)
{
    if (!table) {
        return;
    }
    free(table->path);
    free(table->names);
    free(table->cells);
    free(table->lines);
    free(table->text);
    free(table);
}

/* ---- Columns and cells ---- */

int table_find(const struct table *table, const char *name)
{
    for (size_t i = 0; i < table->num_columns; i++) {
        if (!strcmp(table->names[i], name)) {
            return (int)i;
        }
    }
    return -1;
}

int table_need(const struct table *table, const char *name)
{
    int column = table_find(table, name);

    if (column < 0) {
        table_fail(table, TABLE_HEADER, "no column '%s'", name);
    }
    return column;
}

const char *table_cell(const struct table *table, size_t row, int column)
{
    return table->cells[row * table->num_columns + (size_t)column];
}

static const char *skip_digits(const char *c)
{
    while (*c >= '0' && *c <= '9') {
        c++;
    }
    return c;
}

/* True for [+-]digits[.digits][e[+-]digits] with a digit before the exponent. */
static bool is_decimal(const char *cell)
{
    const char *start = cell + (*cell == '+' || *cell == '-');
    const char *c = skip_digits(start);
    bool has_digits = c > start;

    if (*c == '.') {
        start = ++c;
        c = skip_digits(c);
        has_digits |= c > start;
    }
    if (has_digits && (*c == 'e' || *c == 'E')) {
        c++;
        start = c += *c == '+' || *c == '-';
        c = skip_digits(c);
        has_digits = c > start;
    }
    return has_digits && !*c;
}

static const char *why_not_decimal(const char *cell)
{
    const char *word = cell + (*cell == '+' || *cell == '-');

    if (!*cell) {
        return "is empty";
    }
    if (!strcasecmp(word, "nan") || !strcasecmp(word, "inf") || !strcasecmp(word, "infinity")) {
        return "is not finite";
    }
    return "is not a number";
}

const char *table_number(const char *cell, double *value)
{
    double number;

    if (!is_decimal(cell)) {
        return why_not_decimal(cell);
    }
    number = strtod(cell, NULL);
    if (!(fabs(number) <= (double)FLT_MAX)) {
        return "is out of the range of float32";
    }
    *value = number;
    return NULL;
}

/* Seconds without exponent, digit by digit; the caller has checked form and range. */
static int64_t exact_time_us(const char *cell)
{
    const char *c = cell + (*cell == '+' || *cell == '-');
    int64_t time_us = 0;

    for (; *c >= '0' && *c <= '9'; c++) {
        time_us = 10 * time_us + (*c - '0');
    }
    if (*c == '.') {
        c++;
    }
    for (int i = 0; i < 6; i++) {
        time_us = 10 * time_us + (*c ? *c++ - '0' : 0);
    }
    if (*c >= '5') {
        time_us++;
    }
    return *cell == '-' ? -time_us : time_us;
}

const char *table_time_us(const char *cell, int64_t *time_us)
{
    double seconds;
    const char *reason = table_number(cell, &seconds);

    if (reason) {
        return reason;
    }
    if (!(fabs(seconds) <= 4e12)) {
        return "is beyond 4e12 s";
    }
    *time_us = strpbrk(cell, "eE") ? (int64_t)llround(seconds * 1e6) : exact_time_us(cell);
    return NULL;
}

const char *table_int32(const char *cell, int32_t *value)
{
    const char *digits = cell + (*cell == '+' || *cell == '-');
    long number;

    if (!*cell) {
        return "is empty";
    }
    if (digits == skip_digits(digits) || *skip_digits(digits)) {
        return "is not an integer";
    }
    errno = 0;
    number = strtol(cell, NULL, 10);
    if (errno || number < INT32_MIN || number > INT32_MAX) {
        return "is out of the range of a 32-bit integer";
    }
    *value = (int32_t)number;
    return NULL;
}

void table_fail(const struct table *table, size_t row, const char *format, ...)
{
    uint32_t line = row == TABLE_HEADER ? table->header_line : table->lines[row];
    char message[512];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    fail_at(table->path, line, message);
}

double table_number_at(const struct table *table, size_t row, int column)
{
    double value = 0.0;
    const char *cell = table_cell(table, row, column);
    const char *reason = table_number(cell, &value);

    if (reason) {
        table_fail(table, row, "%s '%s' %s", table->names[column], cell, reason);
    }
    return value;
}

double table_number_or(const struct table *table, size_t row, int column, double otherwise)
{
    return column < 0 || !*table_cell(table, row, column) ? otherwise
                                                          : table_number_at(table, row, column);
}
