/* SPDX-License-Identifier: MIT */
/*
 * page: plots and tracks as one self-contained HTML page: a map to zoom, a slider of time, tracks
 * with their history. tools/rhotrack/picture/page has its text, and d3, which draws it.
 */
#ifndef RHOTRACK_TOOL_PAGE_H
#define RHOTRACK_TOOL_PAGE_H

#include <stdbool.h>

#include "picture/plot_data.h"
#include "settings/parameters.h"

bool page_path_is_html(const char *path);

/*
 * Writes it. The plots are read once more, scan by scan, for a track names its plots by their rows
 * in a scan. 11 bytes a plot and 75 a row of a track.
 */
void page_write(const char *path, const struct plot_data *data,
                const struct parameters *parameters);

#endif
