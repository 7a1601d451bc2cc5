/* SPDX-License-Identifier: MIT */
/*
 * track_rows_to_geojson: writes rows of tracks, from a file or a log, as GeoJSON
 * (geojson_tracks_writer.h).
 */
#ifndef RHOTRACK_TOOL_TRACK_ROWS_TO_GEOJSON_H
#define RHOTRACK_TOOL_TRACK_ROWS_TO_GEOJSON_H

#include <stdio.h>

#include "io/rows/rows_in_memory.h"
#include "settings/parameters.h"

/* Writes rows of rows_kind_tracks, which it sorts by time. */
void geojson_write_rows(FILE *file, struct rows *rows, const struct parameters *parameters);

#endif
