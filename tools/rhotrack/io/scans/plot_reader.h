/* SPDX-License-Identifier: MIT */
/*
 * plot_reader: reads files of plots as scans, merged by time. LCM logs are read as log_scans.h
 * describes, CSV files by these columns:
 * t_s,sensor_id,x_m,y_m[,z_m][,vx_mps,vy_mps,vz_mps][,sigma_m][,sigma_mps], or polar:
 * t_s,sensor_id,range_m,azimuth_rad[,elevation_rad][,range_rate_mps]
 * [,sensor_x_m,sensor_y_m,sensor_z_m][,sigma_range_m,...];
 * degrees (columns.h) may stand for the angles in radians, latitudes and longitudes for metres
 * (geodetic_columns.h), the number of a frame for t_s (frame_gaps.h). Other columns are ignored.
 * Rows of one sensor with the same t_s (or within scan_interval_s) form one scan; with a column
 * scan, rows of the same scan and epoch, up to a minute apart (rows_to_scans.h). A row whose
 * measurement columns are empty is a scan without detections.
 *
 * Files are read once, row by row; memory does not grow with them. The path "-" is standard input,
 * as CSV.
 */
#ifndef RHOTRACK_TOOL_PLOT_READER_H
#define RHOTRACK_TOOL_PLOT_READER_H

#include <stdbool.h>

#include "rhotrack/types.h"
#include "settings/parameters.h"

struct plot_reader;

struct plot_reader_counts {
    uint64_t scans, plots, rows_skipped; /* rows_skipped: bad rows, with keep_going */
};

/*
 * Opens the files. Errors as `rhotrack: FILE:LINE: what is wrong`, exit 2, some of them only when
 * reading gets there; with keep_going bad rows are skipped and counted instead.
 */
struct plot_reader *plot_reader_open(char *const *paths, int num_paths,
                                     const struct parameters *parameters, bool keep_going);

/* Opens one CSV file that may grow, or a pipe, which is never waited for. */
struct plot_reader *plot_reader_follow(char *path, const struct parameters *parameters,
                                       bool keep_going);

/*
 * Opens files that may lack a column sensor_id: all plots are then of sensor 0. For pictures,
 * without tracking.
 */
struct plot_reader *plot_reader_open_sensorless(char *const *paths, int num_paths,
                                                const struct parameters *parameters);

/*
 * Reads the next scan, valid until the next call, or returns NULL after the last. Scans come in the
 * order of time. For a followed file, NULL is not the end while plot_reader_waits.
 */
const struct rho_scan *plot_reader_next(struct plot_reader *reader);

/* Whether a followed file has no further complete scan, but may still get rows. */
bool plot_reader_waits(const struct plot_reader *reader);

/* Whether the bytes read of a followed file end in the middle of a row. */
bool plot_reader_is_mid_row(const struct plot_reader *reader);

/* For a followed file: takes all rows so far as complete scans; stops reading rows. */
void plot_reader_complete_scans(struct plot_reader *reader);
void plot_reader_end_reading(struct plot_reader *reader);

/* Why a followed file cannot get more rows ("has become shorter"), or NULL. */
const char *plot_reader_why_not_followed(const struct plot_reader *reader);

/*
 * Sensor of the scan handed out last; NULL where no description was given. Valid as long as the
 * scan.
 */
const struct rho_sensor *plot_reader_sensor(const struct plot_reader *reader);

/* Bytes read of all files, for progress bars. */
uint64_t plot_reader_position(const struct plot_reader *reader);

/* Counts of what was read so far. */
struct plot_reader_counts plot_reader_counts(const struct plot_reader *reader);

/* Reports skipped bad rows on standard error, if any. */
void plot_reader_report_skipped(const struct plot_reader *reader);
void plot_reader_close(struct plot_reader *reader);

#endif
