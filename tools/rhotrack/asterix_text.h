/* SPDX-License-Identifier: MIT */
/*
 * asterix_text: a recording in ASTERIX as the CSV file of polar plots that says the same. Whatever reads such files reads
 * recordings through it, and `convert` writes it to a file: a line number in a message is the line of that file.
 *
 * Columns: t_s, sensor_id, range_m, azimuth_rad, alt_m, range_rate_mps; where a radar tells its place sensor_lat_deg,
 * sensor_lon_deg, sensor_alt_m; where one tells its antenna's crossings sector_from_rad, sector_to_rad, scan. A scan begins
 * with a row that saw nothing. Rows come in the order of time.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_TEXT_H
#define RHOTRACK_TOOL_ASTERIX_TEXT_H

#include <stdio.h>

#include "asterix_scans.h"
#include "parameters.h"

/* ---- Recordings ---- */

struct asterix_text;

/*
 * Looks at the whole file once. At the end a line each on standard error names radars that do not say where they stand, beside
 * others or an origin that is set, and for which the parameters do not say it either. Of the parameters asterix_scans says what a scan is, scan_interval_s of radars without
 * crossings; NULL: their defaults. Errors: exit 2, as asterix_file.h has them, and a file without one plot or crossing.
 */
struct asterix_text *asterix_text_open(const char *path, const struct parameters *parameters,
                                       bool keep_going);

/* What is said of tracks that are given as input. */
extern const char asterix_text_no_tracks[];

/* The next line with its end; false: no more. What was left out goes to standard error then, once. */
#define ASTERIX_LINE_BYTES 512
bool asterix_text_next(struct asterix_text *text, char line[ASTERIX_LINE_BYTES], size_t *length);

/* How many bytes of the file are taken. */
uint64_t asterix_text_position(const struct asterix_text *text);
void asterix_text_close(struct asterix_text *text);

/* ---- Their parts ---- */

struct asterix_columns {
    bool has_place, has_scan;
};

/* A row of a scan: its opening (NULL), or a plot. */
void asterix_text_header(const struct asterix_columns *columns, char line[ASTERIX_LINE_BYTES]);
void asterix_text_row(const struct asterix_columns *columns, const struct asterix_scan *scan,
                      const struct asterix_mark *mark, char line[ASTERIX_LINE_BYTES]);

/* The rules for scans that the parameters say. */
struct asterix_rules asterix_text_rules(const struct parameters *parameters, double hold_s,
                                        double wait_s);

/* The place of a radar becomes the origin; a line on standard error says so. */
void asterix_text_suggest_origin(const char *path, const struct asterix_place *place,
                                 struct parameters *parameters);

/* What became of records, where there is anything to say, on standard error in one line. */
void asterix_text_report(const char *path, const struct asterix_counts *counts);

#endif
