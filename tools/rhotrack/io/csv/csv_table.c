/* SPDX-License-Identifier: MIT */
#include "io/csv/csv_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"
#include "base/parse.h"

void table_need_rows(const struct table *table)
{
    if (!table->num_rows) {
        table_fail_at_row(table, TABLE_HEADER, "no rows after the header");
    }
}

void table_free(struct table *table)
{
    if (!table) {
        return;
    }
    free(table->path);
    free((void *)table->names);
    free(table->columns);
    free(table->numbers);
    free(table->factors);
    free(table->offsets);
    free(table->times_us);
    free(table->cells);
    free(table->lines);
    free(table->text);
    free(table);
}

/* The cell's text; NULL in a table of numbers. */
static const char *cell_text(const struct table *table, size_t row, int column)
{
    return table->cells ? table->cells[row * table->num_columns + (size_t)column] : NULL;
}

static double cell_number(const struct table *table, size_t row, int column)
{
    return table->numbers[row * table->num_columns + (size_t)column];
}

/* Whether the cell's number is in another unit than the column's. */
static bool column_has_unit_factor(const struct table *table, int column)
{
    return table->factors && (table->factors[column] < 0 || table->factors[column] > 0);
}

bool table_is_cell_empty(const struct table *table, size_t row, int column)
{
    const char *text = cell_text(table, row, column);

    return text ? !*text : column != 0 && isnan(cell_number(table, row, column));
}

const char *table_cell_text(const struct table *table, size_t row, int column,
                            char buffer[TABLE_TEXT_BYTES])
{
    const char *text = cell_text(table, row, column);
    const struct table_column *described;
    double number;

    if (text) {
        return text;
    }
    described = &table->columns[column];
    number = cell_number(table, row, column);
    *buffer = '\0';
    if (column == 0) {
        return decimal_seconds_text(table->times_us[row], buffer);
    }
    if (!isnan(number) && described->word) {
        return described->word((int)number);
    }
    if (!isnan(number) && described->decimals == TABLE_SHORTEST) {
        return shortest_float_text((float)number, buffer);
    }
    if (!isnan(number)) {
        snprintf(buffer, TABLE_TEXT_BYTES, "%.*f", described->decimals, number);
    }
    return buffer;
}

bool table_is_word(const struct table *table, size_t row, int column, const char *word)
{
    char buffer[TABLE_TEXT_BYTES];

    return !strcmp(table_cell_text(table, row, column, buffer), word);
}

const char *table_read_number(const struct table *table, size_t row, int column, double *value)
{
    const char *text = cell_text(table, row, column);

    if (text) {
        const char *why = parse_number_or_give_reason(text, value);

        if (!why && column_has_unit_factor(table, column)) {
            *value = *value * table->factors[column] + table->offsets[column];
        }
        return why;
    }
    *value = column == 0 ? (double)table->times_us[row] * 1e-6 : cell_number(table, row, column);
    return isnan(*value) ? "is empty" : NULL;
}

const char *table_read_float(const struct table *table, size_t row, int column, float *value)
{
    const char *text = cell_text(table, row, column);
    double number = 0.0;
    const char *why = table_read_number(table, row, column, &number);

    *value = why                                              ? 0.0f
             : text && !column_has_unit_factor(table, column) ? strtof(text, NULL)
                                                              : (float)number;
    return why;
}

/*
 * Parses a time in seconds, scaled by a factor above 0, or in ISO 8601. Returns NULL, or why it is
 * bad.
 */
static const char *parse_time_us(const char *text, double factor, int64_t *time_us)
{
    double seconds;
    const char *why = parse_time_us_or_give_reason(text, time_us);

    if (why) {
        return iso_time_to_us(text, time_us) ? NULL : why;
    }
    if (!(factor > 0)) {
        return NULL;
    }
    why = parse_number_or_give_reason(text, &seconds);
    *time_us = why ? 0 : (int64_t)llround(seconds * factor * 1e6);
    return why;
}

bool table_is_frame_number(const struct table *table, int column)
{
    return table->frame_rate_hz > 0 && strcmp(table->names[column], "frame") == 0;
}

const char *table_read_time_us(const struct table *table, size_t row, int column, int64_t *time_us)
{
    const char *text = cell_text(table, row, column);
    int32_t frame = 0;

    if (text && table_is_frame_number(table, column)) {
        const char *why = parse_int32_or_give_reason(text, &frame);

        *time_us = llround((double)frame * 1e6 / table->frame_rate_hz);
        return why;
    }
    if (text) {
        return parse_time_us(
            text, column_has_unit_factor(table, column) ? table->factors[column] : 0, time_us);
    }
    *time_us = table->times_us[row]; /* the only column of times in a table of numbers */
    return NULL;
}

const char *table_read_int32(const struct table *table, size_t row, int column, int32_t *value)
{
    const char *text = cell_text(table, row, column);
    const char *why;
    double number = 0.0;

    if (text) {
        return parse_int32_or_give_reason(text, value);
    }
    why = table_read_number(table, row, column, &number);
    if (!why && (number < INT32_MIN || number > INT32_MAX)) {
        why = "is out of range";
    }
    *value = why ? 0 : (int32_t)number;
    return why;
}

struct table *table_make_empty_of_numbers(const char *path, const struct table_column *columns,
                                          size_t num_columns)
{
    struct table *table = must_calloc(1, sizeof *table);

    table->path = must_copy_text(path);
    table->num_columns = num_columns;
    table->names = must_alloc(num_columns * sizeof *table->names);
    table->columns = must_alloc(num_columns * sizeof *table->columns);
    memcpy(table->columns, columns, num_columns * sizeof *table->columns);
    table->header_line = 1;
    for (size_t i = 0; i < num_columns; i++) {
        table->names[i] = columns[i].name;
    }
    return table;
}

double *table_add_row_of_numbers(struct table *table, int64_t time_us, uint32_t line)
{
    double *numbers;

    if (table->num_rows == table->capacity) {
        table->capacity = 2 * table->capacity + 1;
        table->times_us = must_realloc(table->times_us, table->capacity * sizeof *table->times_us);
        table->lines = must_realloc(table->lines, table->capacity * sizeof *table->lines);
        table->numbers = must_realloc(table->numbers, table->capacity * table->num_columns *
                                                          sizeof *table->numbers);
    }
    table->times_us[table->num_rows] = time_us;
    table->lines[table->num_rows] = line;
    numbers = table->numbers + table->num_rows++ * table->num_columns;
    for (size_t i = 0; i < table->num_columns; i++) {
        numbers[i] = (double)NAN;
    }
    return numbers;
}

void table_write_header(FILE *file, const struct table *table)
{
    for (size_t i = 0; i < table->num_columns; i++) {
        fprintf(file, "%s%s", i > 0 ? "," : "", table->names[i]);
    }
    fputc('\n', file);
}

void table_write_row(FILE *file, const struct table *table, size_t row)
{
    char buffer[TABLE_TEXT_BYTES];

    for (size_t i = 0; i < table->num_columns; i++) {
        fprintf(file, "%s%s", i > 0 ? "," : "", table_cell_text(table, row, (int)i, buffer));
    }
    fputc('\n', file);
}

void table_fail_at_row(const struct table *table, size_t row, const char *format, ...)
{
    uint32_t line = row == TABLE_HEADER ? table->header_line : table->lines[row];
    char message[512];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    fail(EXIT_USAGE, "%s:%u: %s", table->path, (unsigned)line, message);
}

double table_number_at(const struct table *table, size_t row, int column)
{
    double value = 0.0;
    const char *reason = table_read_number(table, row, column, &value);
    char buffer[TABLE_TEXT_BYTES];

    if (reason) {
        table_fail_at_row(table, row, "%s '%s' %s", table->names[column],
                          table_cell_text(table, row, column, buffer), reason);
    }
    return value;
}

double table_number_or(const struct table *table, size_t row, int column, double otherwise)
{
    return column < 0 || table_is_cell_empty(table, row, column)
               ? otherwise
               : table_number_at(table, row, column);
}
