/* SPDX-License-Identifier: MIT */
#include "base/text_table.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/common.h"

static char *copy_text(const char *text, size_t length)
{
    char *copy = must_alloc(length + 1);
    memcpy(copy, text, length);
    copy[length] = '\0';
    return copy;
}

static void append_row_split_at_bars(struct text_table *table, const char *text)
{
    table->cells = must_realloc(table->cells,
                                (table->num_rows + 1) * table->num_columns * sizeof *table->cells);
    char **row = &table->cells[table->num_rows++ * table->num_columns];
    for (size_t column = 0; column < table->num_columns; column++) {
        size_t length = strcspn(text, "|");
        row[column] = copy_text(text, length);
        text += text[length] == '|' ? length + 1 : length;
    }
}

struct text_table text_table_start(size_t left_columns, const char *head)
{
    struct text_table table = {.num_columns = 1, .left_columns = left_columns};
    for (const char *at = head; *at != '\0'; at++) {
        table.num_columns += *at == '|';
    }
    append_row_split_at_bars(&table, head);
    return table;
}

void text_table_add_row(struct text_table *table, const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    if (length < 0) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    append_row_split_at_bars(table, text);
    free(text);
}

const char *text_table_cell(const struct text_table *table, size_t row, size_t column)
{
    return table->cells[row * table->num_columns + column];
}

/* Number of characters of a UTF-8 text. */
static size_t text_width(const char *text)
{
    size_t width = 0;
    for (; *text != '\0'; text++) {
        width += ((unsigned char)*text & 0xc0u) != 0x80u;
    }
    return width;
}

static size_t column_width(const struct text_table *table, size_t column)
{
    size_t width = 0;
    for (size_t row = 0; row < table->num_rows; row++) {
        size_t needed = text_width(text_table_cell(table, row, column));
        width = needed > width ? needed : width;
    }
    return width;
}

static void print_cell(const struct text_table *table, size_t row, size_t column, size_t width,
                       FILE *out)
{
    const char *text = text_table_cell(table, row, column);
    int padding = (int)(width - text_width(text));
    const char *gap = column == 0 ? "" : "  ";
    if (column >= table->left_columns) {
        fprintf(out, "%s%*s%s", gap, padding, "", text);
    } else if (column + 1 < table->num_columns) {
        fprintf(out, "%s%s%*s", gap, text, padding, "");
    } else {
        fprintf(out, "%s%s", gap, text);
    }
}

static void print_rule(const struct text_table *table, const size_t *widths, FILE *out)
{
    for (size_t column = 0; column < table->num_columns; column++) {
        fputs(column == 0 ? "" : "  ", out);
        for (size_t i = widths[column]; i > 0; i--) {
            fputc('-', out);
        }
    }
    fputc('\n', out);
}

void text_table_print(const struct text_table *table, FILE *out)
{
    size_t *widths = must_calloc(table->num_columns, sizeof *widths);
    for (size_t column = 0; column < table->num_columns; column++) {
        widths[column] = column_width(table, column);
    }
    for (size_t row = 0; row < table->num_rows; row++) {
        for (size_t column = 0; column < table->num_columns; column++) {
            print_cell(table, row, column, widths[column], out);
        }
        fputc('\n', out);
        if (row == 0) {
            print_rule(table, widths, out);
        }
    }
    free(widths);
}

void text_table_free(struct text_table *table)
{
    for (size_t i = 0; i < table->num_rows * table->num_columns; i++) {
        free(table->cells[i]);
    }
    free(table->cells);
    table->cells = NULL;
}

const char *text_table_number_or_dash(char text[TEXT_TABLE_NUMBER], int digits, double value)
{
    snprintf(text, TEXT_TABLE_NUMBER, "%.*f", digits, value);
    return isnan(value) ? "-" : text;
}
