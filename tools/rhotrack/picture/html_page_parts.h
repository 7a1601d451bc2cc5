/* SPDX-License-Identifier: MIT */
/*
 * html_page_parts: the texts of the HTML page (licence, d3, HTML, style, script), compiled into the
 * program from picture/html_page by the Makefile.
 */
#ifndef RHOTRACK_TOOL_HTML_PAGE_PARTS_H
#define RHOTRACK_TOOL_HTML_PAGE_PARTS_H

extern const char page_licence[], page_d3[], page_html[], page_style[], page_script[];

#endif
