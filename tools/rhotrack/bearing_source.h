/* SPDX-License-Identifier: MIT */
/*
 * bearing_source: the scans of one bearings file or LCM log, in the order of time, in memory that does not grow with the
 * file. What holds across files, the sensors and their places, is checked against one list.
 */
#ifndef RHOTRACK_TOOL_BEARING_SOURCE_H
#define RHOTRACK_TOOL_BEARING_SOURCE_H

#include <stdbool.h>

#include "frame_reader.h"
#include "parameters.h"

/* Sensors in the order in which they were first named, and where. */
struct known_sensor {
    struct frame_sensor sensor;
    const char *path;
    uint32_t line;
};
struct known_sensors {
    struct known_sensor list[RHO_MAX_SENSORS];
    size_t count;
    bool is_closed; /* the files were read once: there are no others */
};

struct bearing_source;

/* A scan, and where its first row is. The bearings are its own: to be freed by bearing_scan_free. */
struct bearing_scan {
    struct rho_bearing_scan scan;
    const char *path;
    uint32_t line;
};
void bearing_scan_free(struct bearing_scan *scan);

/* Opens a file, frame_reader.h says what may be in it. Errors: exit 2; with keep_going bad rows are skipped and counted. */
struct bearing_source *bearing_source_open(const char *path, const struct parameters *parameters,
                                           bool keep_going, struct known_sensors *known);

/* The next scan. Returns false after the last. */
bool bearing_source_next(struct bearing_source *source, struct bearing_scan *scan);

/* The file from its beginning again. */
void bearing_source_rewind(struct bearing_source *source);

uint64_t bearing_source_rows_skipped(const struct bearing_source *source);

/* Bytes of the file that are taken. */
uint64_t bearing_source_position(const struct bearing_source *source);
void bearing_source_close(struct bearing_source *source);

#endif
