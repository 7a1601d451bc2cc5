/* SPDX-License-Identifier: MIT */
/*
 * geojson_rows: writes rows of tracks, from a file or a log, as GeoJSON
 * (geojson_tracks_writer.h).
 */
#ifndef RHOTRACK_TOOL_GEOJSON_ROWS_H
#define RHOTRACK_TOOL_GEOJSON_ROWS_H

#include <stdio.h>

#include "io/rows/rows_in_memory.h"
#include "settings/parameters.h"

/* Writes rows of rows_kind_tracks, which it sorts by time. */
void geojson_write_rows(FILE *file, struct rows *rows, const struct parameters *parameters);

#endif
