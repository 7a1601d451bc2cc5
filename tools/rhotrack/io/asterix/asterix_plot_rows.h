/* SPDX-License-Identifier: MIT */
/*
 * asterix_plot_rows: an ASTERIX recording of radars as rows of polar plots
 * (csv_table.h). Readers of tables read recordings through it, and `convert` writes
 * the rows to a CSV file: the line number in an error message is the line of that file.
 *
 * Columns: t_s, sensor_id, range_m, azimuth_rad, alt_m, range_rate_mps; where a radar states its
 * place sensor_lat_deg, sensor_lon_deg, sensor_alt_m; where one reports antenna crossings
 * sector_from_rad, sector_to_rad, scan. A numbered scan begins with a row without a plot. Rows come
 * in the order of time.
 */
#ifndef RHOTRACK_TOOL_ASTERIX_PLOT_ROWS_H
#define RHOTRACK_TOOL_ASTERIX_PLOT_ROWS_H

#include "io/asterix/asterix_scans.h"
#include "io/csv/csv_table.h"
#include "settings/parameters.h"

struct asterix_plot_rows;

/*
 * Opens a recording, and reads the whole file once for its columns and radars. Of the parameters,
 * asterix_scans chooses sectors or turns as scans, and scan_interval_s gathers plots of radars
 * without crossings; NULL: their defaults. After the last row, standard error names each radar
 * whose place neither the recording nor the parameters give, where there are several radars or an
 * origin is set. Errors: exit 2, as asterix_file.h has them, and for a file without any plot or
 * crossing.
 */
struct asterix_plot_rows *
asterix_plot_rows_open(const char *path, const struct parameters *parameters, bool keep_going);

/* Suppresses all reports on standard error at the end of the file. */
void asterix_plot_rows_set_quiet(struct asterix_plot_rows *records);

/* Error message for tracks (CAT062) given as input where plots are needed. */
extern const char asterix_plot_rows_no_tracks[];

/* Which optional columns the recording's table has: the radars' places; scan and sector. */
struct asterix_columns {
    bool has_place, has_scan;
};
const struct asterix_columns *asterix_plot_rows_columns(const struct asterix_plot_rows *records);
struct table *asterix_plot_rows_empty_table(const char *path,
                                            const struct asterix_columns *columns);

/*
 * Adds the next row to the table. Returns false after the last row, and then reports once, on
 * standard error, what was left out.
 */
bool asterix_plot_rows_next(struct asterix_plot_rows *records, struct table *table);

/* Number of bytes of the file that have been read. */
uint64_t asterix_plot_rows_position(const struct asterix_plot_rows *records);
void asterix_plot_rows_close(struct asterix_plot_rows *records);

/*
 * Adds a scan's rows to a table: one without a plot that begins the scan, then one for each plot.
 */
void asterix_plot_rows_add_scan(struct table *table, const struct asterix_scan *scan);

/* The rules for forming scans, from the parameters and the two waiting times. */
struct asterix_rules asterix_plot_rows_scan_rules(const struct parameters *parameters,
                                                  double hold_s, double wait_s);

/* Suggests a radar's place as the origin in the parameters, and reports it on standard error. */
void asterix_set_default_origin(const char *path, const struct asterix_place *place,
                                struct parameters *parameters);

/* Reports the numbers of plots and messages left out, by reason, in one line on standard error. */
void asterix_plot_rows_report(const char *path, const struct asterix_counts *counts);

#endif
