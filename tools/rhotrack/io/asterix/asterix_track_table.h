/* SPDX-License-Identifier: MIT */
/*
 * asterix_track_table: reads the tracks of an ASTERIX recording (CAT062) as a table like a
 * tracks CSV.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_TRACK_TABLE_H
#define RHOTRACK_TOOL_ASTERIX_TRACK_TABLE_H

#include "io/csv/csv_table.h"
#include "settings/parameters.h"

/* Whether the recording has tracks, and no radar records. */
bool asterix_file_has_only_tracks(const char *path);

/*
 * Reads one row a record: positions from latitude and longitude (I062/105) where the origin is set,
 * else from the system's own plane (I062/100). Records with the bit TSE, of ended tracks, get the
 * status "deleted"; records without time, number or place are left out and counted on standard
 * error. Errors: exit 2, as asterix_file.h has them, and where no record has a place.
 */
struct table *asterix_track_table_read(const char *path, const struct parameters *parameters,
                                       bool keep_going);

#endif
