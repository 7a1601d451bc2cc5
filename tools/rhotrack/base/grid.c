/* SPDX-License-Identifier: MIT */
#include "base/grid.h"

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

static void add_row(struct grid *grid, const char *text)
{
    grid->cells =
        must_realloc(grid->cells, (grid->num_rows + 1) * grid->num_columns * sizeof *grid->cells);
    char **row = &grid->cells[grid->num_rows++ * grid->num_columns];
    for (size_t column = 0; column < grid->num_columns; column++) {
        size_t length = strcspn(text, "|");
        row[column] = copy_text(text, length);
        text += text[length] == '|' ? length + 1 : length;
    }
}

struct grid grid_start(size_t left_columns, const char *head)
{
    struct grid grid = {.num_columns = 1, .left_columns = left_columns};
    for (const char *at = head; *at != '\0'; at++) {
        grid.num_columns += *at == '|';
    }
    add_row(&grid, head);
    return grid;
}

void grid_row(struct grid *grid, const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    if (length < 0) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    add_row(grid, text);
    free(text);
}

const char *grid_cell(const struct grid *grid, size_t row, size_t column)
{
    return grid->cells[row * grid->num_columns + column];
}

/* Characters of UTF-8 text. */
static size_t width_of(const char *text)
{
    size_t width = 0;
    for (; *text != '\0'; text++) {
        width += ((unsigned char)*text & 0xc0u) != 0x80u;
    }
    return width;
}

static size_t column_width(const struct grid *grid, size_t column)
{
    size_t width = 0;
    for (size_t row = 0; row < grid->num_rows; row++) {
        size_t needed = width_of(grid_cell(grid, row, column));
        width = needed > width ? needed : width;
    }
    return width;
}

static void print_cell(const struct grid *grid, size_t row, size_t column, size_t width, FILE *out)
{
    const char *text = grid_cell(grid, row, column);
    int padding = (int)(width - width_of(text));
    const char *gap = column == 0 ? "" : "  ";
    if (column >= grid->left_columns) {
        fprintf(out, "%s%*s%s", gap, padding, "", text);
    } else if (column + 1 < grid->num_columns) {
        fprintf(out, "%s%s%*s", gap, text, padding, "");
    } else {
        fprintf(out, "%s%s", gap, text);
    }
}

static void print_rule(const struct grid *grid, const size_t *widths, FILE *out)
{
    for (size_t column = 0; column < grid->num_columns; column++) {
        fputs(column == 0 ? "" : "  ", out);
        for (size_t i = widths[column]; i > 0; i--) {
            fputc('-', out);
        }
    }
    fputc('\n', out);
}

void grid_print(const struct grid *grid, FILE *out)
{
    size_t *widths = must_calloc(grid->num_columns, sizeof *widths);
    for (size_t column = 0; column < grid->num_columns; column++) {
        widths[column] = column_width(grid, column);
    }
    for (size_t row = 0; row < grid->num_rows; row++) {
        for (size_t column = 0; column < grid->num_columns; column++) {
            print_cell(grid, row, column, widths[column], out);
        }
        fputc('\n', out);
        if (row == 0) {
            print_rule(grid, widths, out);
        }
    }
    free(widths);
}

void grid_free(struct grid *grid)
{
    for (size_t i = 0; i < grid->num_rows * grid->num_columns; i++) {
        free(grid->cells[i]);
    }
    free(grid->cells);
    grid->cells = NULL;
}

const char *grid_number(char text[GRID_NUMBER], int digits, double value)
{
    snprintf(text, GRID_NUMBER, "%.*f", digits, value);
    return isnan(value) ? "-" : text;
}
