/* SPDX-License-Identifier: MIT */
/*
 * page_parts: the files of tools/rhotrack/picture/page, compiled into the program (the Makefile
 * writes them).
 */
#ifndef RHOTRACK_TOOL_PAGE_PARTS_H
#define RHOTRACK_TOOL_PAGE_PARTS_H

extern const char page_licence[], page_d3[], page_html[], page_style[], page_script[];

#endif
