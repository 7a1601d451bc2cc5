/* SPDX-License-Identifier: MIT */
/* page: one HTML page of headings, sentences, tables and pictures. Texts are escaped. */
#ifndef RHOTRACK_TOOL_PAGE_H
#define RHOTRACK_TOOL_PAGE_H

#include "base/common.h"
#include "base/grid.h"

struct page {
    struct output output;
};

struct page page_open(const char *path, const char *title);
void page_heading(struct page *page, const char *text);
void page_text(struct page *page, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Cells "ok" and "MISSED" are set off. */
void page_table(struct page *page, const struct grid *grid);

/* The picture's path is relative to the page. */
void page_figure(struct page *page, const char *picture, const char *caption);
void page_close(struct page *page);

#endif
