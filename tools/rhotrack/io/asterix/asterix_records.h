/* SPDX-License-Identifier: MIT */
/*
 * asterix_records: a recording in ASTERIX as records of polar plots (table.h). Readers of tables
 * read recordings through it, and `convert` writes the records to a CSV file: a line number in a
 * message is the line of that file.
 *
 * Columns: t_s, sensor_id, range_m, azimuth_rad, alt_m, range_rate_mps; where a radar tells its
 * place sensor_lat_deg, sensor_lon_deg, sensor_alt_m; where one tells its antenna's crossings
 * sector_from_rad, sector_to_rad, scan. A scan begins with a row that saw nothing. Rows come in the
 * order of time.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_RECORDS_H
#define RHOTRACK_TOOL_ASTERIX_RECORDS_H

#include "io/asterix/asterix_scans.h"
#include "io/csv/table.h"
#include "settings/parameters.h"

struct asterix_records;

/*
 * Looks at the whole file once. At the end a line each on standard error names radars that do not
 * say where they stand, beside others or an origin that is set, and for which the parameters do not
 * say it either. Of the parameters asterix_scans says what a scan is, scan_interval_s of radars
 * without crossings; NULL: their defaults. Errors: exit 2, as
 * asterix_file.h has them, and a file without one plot or crossing.
 */
struct asterix_records *asterix_records_open(const char *path, const struct parameters *parameters,
                                             bool keep_going);

/* Nothing is said at the end. */
void asterix_records_report_nothing(struct asterix_records *records);

/* The refusal of tracks that are given as input. */
extern const char asterix_records_no_tracks[];

/* The columns of the recording's table. */
struct asterix_columns {
    bool has_place, has_scan;
};
const struct asterix_columns *asterix_records_columns(const struct asterix_records *records);
struct table *asterix_records_empty_table(const char *path, const struct asterix_columns *columns);

/* Adds the next record to the table; false: no more. Reports on standard error then, once. */
bool asterix_records_next_row(struct asterix_records *records, struct table *table);

/* How many bytes of the file are taken. */
uint64_t asterix_records_position(const struct asterix_records *records);
void asterix_records_close(struct asterix_records *records);

/* ---- Of what is heard live ---- */

/* Adds the rows of one scan to a table: its opening, and its plots. */
void asterix_records_add_scan(struct table *table, const struct asterix_scan *scan);

/* The rules for scans that the parameters say. */
struct asterix_rules asterix_records_scan_rules(const struct parameters *parameters, double hold_s,
                                                double wait_s);

/* The place of a radar becomes the origin; a line on standard error says so. */
void asterix_records_suggest_origin(const char *path, const struct asterix_place *place,
                                    struct parameters *parameters);

/* The fates of records, where there is anything to say, on standard error in one line. */
void asterix_records_report_left_out(const char *path, const struct asterix_counts *counts);

#endif
