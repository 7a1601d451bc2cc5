/* SPDX-License-Identifier: MIT */
#include "page.h"

#include <stdarg.h>
#include <string.h>

static const char style[] =
    "body{font:16px/1.5 "
    "system-ui,Helvetica,Arial,sans-serif;color:#222;max-width:76rem;margin:2rem auto;padding:0 "
    "1rem}"
    "h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.2rem;border-bottom:1px solid #ccc}"
    "table{border-collapse:collapse;font-size:.9rem;margin:1rem 0}"
    "th,td{padding:.2rem .7rem;border-bottom:1px solid #e4e4e4;text-align:right}"
    "th{border-bottom:2px solid #888}.l{text-align:left}"
    ".ok{color:#00663f}.missed{color:#a33c00;font-weight:bold}"
    "figure{margin:1.5rem 0}figure "
    "img{max-width:100%;height:auto}figcaption{color:#555;font-size:.95rem}";

static void put_escaped(FILE *file, const char *text)
{
    for (; *text; text++) {
        switch (*text) {
        case '<':
            fputs("&lt;", file);
            break;
        case '>':
            fputs("&gt;", file);
            break;
        case '&':
            fputs("&amp;", file);
            break;
        case '"':
            fputs("&quot;", file);
            break;
        default:
            fputc(*text, file);
        }
    }
}

struct page page_open(const char *path, const char *title)
{
    struct page page = {.output = output_open(path)};
    FILE *file = page.output.file;
    fprintf(file, "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>");
    put_escaped(file, title);
    fprintf(file, "</title>\n<style>%s</style></head>\n<body>\n<h1>", style);
    put_escaped(file, title);
    fprintf(file, "</h1>\n");
    return page;
}

void page_heading(struct page *page, const char *text)
{
    fprintf(page->output.file, "<h2>");
    put_escaped(page->output.file, text);
    fprintf(page->output.file, "</h2>\n");
}

void page_text(struct page *page, const char *format, ...)
{
    char text[2000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fprintf(page->output.file, "<p>");
    put_escaped(page->output.file, text);
    fprintf(page->output.file, "</p>\n");
}

static const char *class_of(const char *cell, bool is_left)
{
    if (strcmp(cell, "ok") == 0) {
        return "ok";
    }
    if (strcmp(cell, "MISSED") == 0) {
        return "missed";
    }
    return is_left ? "l" : "";
}

static void put_row(FILE *file, const struct grid *grid, size_t row)
{
    const char *tag = row == 0 ? "th" : "td";
    fprintf(file, "<tr>");
    for (size_t column = 0; column < grid->num_columns; column++) {
        const char *cell = grid_cell(grid, row, column);
        fprintf(file, "<%s class=\"%s\">", tag, class_of(cell, column < grid->left_columns));
        put_escaped(file, cell);
        fprintf(file, "</%s>", tag);
    }
    fprintf(file, "</tr>\n");
}

void page_table(struct page *page, const struct grid *grid)
{
    fprintf(page->output.file, "<table>\n");
    for (size_t row = 0; row < grid->num_rows; row++) {
        put_row(page->output.file, grid, row);
    }
    fprintf(page->output.file, "</table>\n");
}

void page_figure(struct page *page, const char *picture, const char *caption)
{
    FILE *file = page->output.file;
    fprintf(file, "<figure><img src=\"");
    put_escaped(file, picture);
    fprintf(file, "\" alt=\"");
    put_escaped(file, caption);
    fprintf(file, "\"><figcaption>");
    put_escaped(file, caption);
    fprintf(file, "</figcaption></figure>\n");
}

void page_close(struct page *page)
{
    fprintf(page->output.file, "</body></html>\n");
    output_close(&page->output);
}
