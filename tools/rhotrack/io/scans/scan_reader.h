/* SPDX-License-Identifier: MIT */
/*
 * scan_reader: plot files in, scans out, merged by time. LCM logs are read as log_scans.h has it,
 * and of CSV files
 *
 * columns by name: t_s,sensor_id,x_m,y_m[,z_m][,vx_mps,vy_mps,vz_mps][,sigma_m][,sigma_mps], or
 * polar:
 * t_s,sensor_id,range_m,azimuth_rad[,elevation_rad][,range_rate_mps]
 *     [,sensor_x_m,sensor_y_m,sensor_z_m]
 * [,sigma_range_m,...]; azimuth_deg (clockwise from north) and elevation_deg may stand for the
 * radians, latitudes and longitudes for metres (geodetic.h). Others are ignored. Rows of one sensor
 * with the same t_s (or within scan_interval_s) are one scan; with a column scan those of the same
 * scan and epoch, up to a minute apart (scan_gather.h). A row whose measurement columns are empty
 * is a scan that saw nothing.
 *
 * Files are read once, row by row; memory does not grow with them. A path "-" is standard input, as
 * CSV.
 */
#ifndef RHOTRACK_TOOL_SCAN_READER_H
#define RHOTRACK_TOOL_SCAN_READER_H

#include <stdbool.h>

#include "rhotrack/types.h"
#include "settings/parameters.h"

struct scan_reader;

struct scan_reader_counts {
    uint64_t scans, plots, rows_skipped; /* skipped: with keep_going */
};

/*
 * Opens the files. Errors as `rhotrack: FILE:LINE: what is wrong`, exit 2, some of them only when
 * reading gets there; with keep_going bad rows are skipped and counted instead.
 */
struct scan_reader *scan_reader_open(char *const *paths, int num_paths,
                                     const struct parameters *parameters, bool keep_going);

/* The same of one CSV file that may grow. A pipe is not waited for. */
struct scan_reader *scan_reader_follow(char *path, const struct parameters *parameters,
                                       bool keep_going);

/*
 * The same of files that may lack a column sensor_id: all is sensor 0's then. For pictures, which
 * track nothing.
 */
struct scan_reader *scan_reader_open_without_sensors(char *const *paths, int num_paths,
                                                     const struct parameters *parameters);

/*
 * The next scan, or NULL after the last; valid until the next call. Scans come in the order of
 * time. Of a file that is followed NULL is no end as long as scan_reader_waits_for_rows.
 */
const struct rho_scan *scan_reader_next(struct scan_reader *reader);

/* A file that is followed had no further complete scan; rows may still come. */
bool scan_reader_waits_for_rows(const struct scan_reader *reader);

/* The end of what is there is in the middle of a row. */
bool scan_reader_is_mid_row(const struct scan_reader *reader);

/* The rows that are there are complete scans: those to come begin others; or no more are read. */
void scan_reader_complete_scans(struct scan_reader *reader);
void scan_reader_end_reading(struct scan_reader *reader);

/* Why nothing more can come of a file that is followed ("has become shorter"), or NULL. */
const char *scan_reader_why_ended(const struct scan_reader *reader);

/*
 * The sensor of the last scan that was handed out; NULL where it was not described. Valid as long
 * as the scan is.
 */
const struct rho_sensor *scan_reader_sensor(const struct scan_reader *reader);

/* Bytes that were taken of all files (for progress bars). */
uint64_t scan_reader_position(const struct scan_reader *reader);

/* Counts of what was read so far. */
struct scan_reader_counts scan_reader_counts(const struct scan_reader *reader);

/* Bad rows that were skipped, if any, on standard error. */
void scan_reader_report_skipped(const struct scan_reader *reader);
void scan_reader_close(struct scan_reader *reader);

#endif
