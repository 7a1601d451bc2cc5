/* SPDX-License-Identifier: MIT */
/*
 * scan_source: reads the scans of one CSV file, ASTERIX recording or LCM log, plots or
 * bearings, in the order of time, in memory that does not grow with the file.
 */
#ifndef RHOTRACK_TOOL_SCAN_SOURCE_H
#define RHOTRACK_TOOL_SCAN_SOURCE_H

#include <stdbool.h>

#include "io/csv/measurement_row.h"
#include "io/scans/passive_sensors.h"
#include "io/scans/reorder_buffer.h"
#include "settings/parameters.h"

struct scan_source;

struct scan_source_options {
    enum record_kind kind;         /* kind of scans wanted: a log may have both */
    bool keep_going;               /* bad rows are skipped and counted, not an error */
    bool follow;                   /* the file may grow; a log or bearings are refused, exit 2 */
    bool may_lack_sensor;          /* plots without a column sensor_id are of sensor 0 */
    struct passive_sensors *known; /* for bearings: the sensors of all files */
};

/*
 * Opens a file; plot_reader.h and bearing_reader.h describe its content. Errors as
 * `rhotrack: FILE:LINE: what is wrong`, exit 2. The path must outlive the source.
 */
struct scan_source *scan_source_open(const char *path, const struct parameters *parameters,
                                     struct scan_source_options options);

/* Reads the next scan. Returns false after the last, and where a followed file has no more yet. */
bool scan_source_next(struct scan_source *source, struct sensor_scan *scan);

/* Starts again at the beginning of a file of bearings. */
void scan_source_rewind(struct scan_source *source);

/* State of a followed file, as plot_reader.h describes it. */
bool scan_source_waits(const struct scan_source *source);
const char *scan_source_why_not_followed(const struct scan_source *source);
bool scan_source_is_mid_row(const struct scan_source *source);

/* Takes all rows of a followed file so far as complete scans; rows to come begin new ones. */
void scan_source_complete_scans(struct scan_source *source);

/* Stops reading rows of a followed file. */
void scan_source_end_reading(struct scan_source *source);

uint64_t scan_source_rows_skipped(const struct scan_source *source);

/* Number of bytes of the file that have been read. */
uint64_t scan_source_position(const struct scan_source *source);
void scan_source_close(struct scan_source *source);

#endif
