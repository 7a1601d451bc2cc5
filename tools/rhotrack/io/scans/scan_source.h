/* SPDX-License-Identifier: MIT */
/*
 * scan_source: the scans of one file or LCM log, plots or bearings, in the order of time, in memory
 * that does not grow with the file.
 */
#ifndef RHOTRACK_TOOL_SCAN_SOURCE_H
#define RHOTRACK_TOOL_SCAN_SOURCE_H

#include <stdbool.h>

#include "io/csv/record.h"
#include "io/scans/known_sensors.h"
#include "io/scans/reorder_buffer.h"
#include "settings/parameters.h"

struct scan_source;

struct scan_source_options {
    enum record_kind kind;       /* wanted: a log may have both */
    bool keep_going;             /* bad rows are skipped and counted */
    bool follow;                 /* the file may grow: no log, and no bearings (exit 2) */
    bool may_lack_sensor;        /* plots without a column sensor_id are all sensor 0's */
    struct known_sensors *known; /* of bearings: in all files */
};

/*
 * Opens a file; scan_reader.h and bearing_frame_reader.h say what may be in it. Errors as
 * `rhotrack: FILE:LINE: what is wrong`, exit 2. The path must outlive the source.
 */
struct scan_source *scan_source_open(const char *path, const struct parameters *parameters,
                                     struct scan_source_options options);

/*
 * The next scan. Returns false after the last, and where a file that is followed has no more yet.
 */
bool scan_source_next(struct scan_source *source, struct sensor_scan *scan);

/* A file of bearings, which do not wait for one another here, from its beginning again. */
void scan_source_rewind(struct scan_source *source);

/* Of a file that is followed. */
bool scan_source_waits_for_rows(
    const struct scan_source *source); /* false: there is an end, behind it */
const char *scan_source_why_ended(const struct scan_source *source); /* as table_stream.h has it */
bool scan_source_is_mid_row(const struct scan_source *source);
void scan_source_complete_scans(
    struct scan_source *source); /* no scan gets more of the rows to come */
void scan_source_end_reading(struct scan_source *source); /* no more rows are read */

uint64_t scan_source_rows_skipped(const struct scan_source *source);

/* Bytes of the file that are taken. */
uint64_t scan_source_position(const struct scan_source *source);
void scan_source_close(struct scan_source *source);

#endif
