/* SPDX-License-Identifier: MIT */
/*
 * scans_of_one_file: reads the scans of one CSV file, ASTERIX recording or LCM log, plots or
 * bearings, in the order of time, in memory that does not grow with the file.
 */
#ifndef RHOTRACK_TOOL_SCANS_OF_ONE_FILE_H
#define RHOTRACK_TOOL_SCANS_OF_ONE_FILE_H

#include <stdbool.h>

#include "io/csv/measurement_row.h"
#include "io/scans/check_passive_sensors_fixed.h"
#include "io/scans/reorder_buffer.h"
#include "settings/parameters.h"

struct scans_of_one_file;

struct scans_of_one_file_options {
    enum record_kind kind; /* kind of scans wanted: a log may have both */
    bool keep_going;       /* bad rows are skipped and counted, not an error */
    bool follow;           /* the file may grow; a log or bearings are refused, exit 2 */
    bool may_lack_sensor;  /* plots without a column sensor_id are of sensor 0 */
    struct fixed_passive_sensors *known; /* for bearings: the sensors of all files */
};

/*
 * Opens a file; plot_scan_reader.h and bearing_frame_reader.h describe its content. Errors as
 * `rhotrack: FILE:LINE: what is wrong`, exit 2. The path must outlive the source.
 */
struct scans_of_one_file *scans_of_one_file_open(const char *path,
                                                 const struct parameters *parameters,
                                                 struct scans_of_one_file_options options);

/* Reads the next scan. Returns false after the last, and where a followed file has no more yet. */
bool scans_of_one_file_next(struct scans_of_one_file *source, struct sensor_scan *scan);

/* Starts again at the beginning of a file of bearings. */
void scans_of_one_file_rewind(struct scans_of_one_file *source);

/* State of a followed file, as plot_scan_reader.h describes it. */
bool scans_of_one_file_waits_for_rows(const struct scans_of_one_file *source);
const char *scans_of_one_file_why_cannot_be_followed(const struct scans_of_one_file *source);
bool scans_of_one_file_is_mid_row(const struct scans_of_one_file *source);

/* Takes all rows of a followed file so far as complete scans; rows to come begin new ones. */
void scans_of_one_file_complete_scans_so_far(struct scans_of_one_file *source);

/* Stops reading rows of a followed file. */
void scans_of_one_file_end_reading(struct scans_of_one_file *source);

uint64_t scans_of_one_file_rows_skipped(const struct scans_of_one_file *source);

/* Number of bytes of the file that have been read. */
uint64_t scans_of_one_file_position(const struct scans_of_one_file *source);
void scans_of_one_file_close(struct scans_of_one_file *source);

#endif
