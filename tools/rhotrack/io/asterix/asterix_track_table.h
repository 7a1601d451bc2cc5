/* SPDX-License-Identifier: MIT */
/* asterix_track_table: the tracks of a recording in ASTERIX (CAT062) as the table of a CSV file. */
#ifndef RHOTRACK_TOOL_ASTERIX_TRACK_TABLE_H
#define RHOTRACK_TOOL_ASTERIX_TRACK_TABLE_H

#include "io/csv/table.h"
#include "settings/parameters.h"

/* The recording has tracks, and nothing of radars before them. */
bool asterix_file_has_only_tracks(const char *path);

/*
 * A row a record: places by latitude and longitude (105) where the origin is set, else in the
 * system's own plane (100). Records with TSE are of tracks that are no more ("deleted"); those
 * without time, number or place are left out and counted on standard error. Errors: exit 2, as
 * asterix_file.h has them, and where no record has a place.
 */
struct table *asterix_track_table_read(const char *path, const struct parameters *parameters,
                                       bool keep_going);

#endif
