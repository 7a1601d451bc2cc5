/* SPDX-License-Identifier: MIT */
/*
 * map_page_parts: the texts of the HTML page (licence, d3, HTML, style, script),
 * compiled into the program from picture/interactive_map_page by the Makefile.
 */
#ifndef RHOTRACK_TOOL_MAP_PAGE_PARTS_H
#define RHOTRACK_TOOL_MAP_PAGE_PARTS_H

extern const char page_licence[], page_d3[], page_html[], page_style[], page_script[];

#endif
