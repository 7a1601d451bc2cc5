/* SPDX-License-Identifier: MIT */
/*
 * interactive_map_page: writes plots and tracks as one self-contained HTML page: a map with zoom, a
 * time slider and the history of each track. Its script, style and the library d3 are in
 * picture/interactive_map_page.
 */
#ifndef RHOTRACK_TOOL_INTERACTIVE_MAP_PAGE_H
#define RHOTRACK_TOOL_INTERACTIVE_MAP_PAGE_H

#include <stdbool.h>

#include "picture/picture_data.h"
#include "settings/parameters.h"

bool html_page_path_is_html(const char *path);

/*
 * Writes the page. The plots' files are read once more, scan by scan, as a track names its plots by
 * their row in a scan. The page takes 16 bytes a plot and 80 a row of a track.
 */
void html_page_write(const char *path, const struct picture_data *data,
                     const struct parameters *parameters);

#endif
