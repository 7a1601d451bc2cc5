/* SPDX-License-Identifier: MIT */
/* plot_source: the scans of one plot file or LCM log, in the order of time, in memory that does not grow with the file. */
#ifndef RHOTRACK_TOOL_PLOT_SOURCE_H
#define RHOTRACK_TOOL_PLOT_SOURCE_H

#include <stdbool.h>

#include "parameters.h"
#include "rhotrack/types.h"

struct plot_source;

/* A scan and who saw it. The plots are its own: to be freed by plot_scan_free. */
struct plot_scan {
    struct rho_scan scan;
    bool has_sensor; /* something was said of it */
    struct rho_sensor sensor;
};
void plot_scan_free(struct plot_scan *scan);

struct plot_source_options {
    bool keep_going;      /* bad rows are skipped and counted */
    bool follow;          /* the file may grow: no log, and no bearings (exit 2) */
    bool may_lack_sensor; /* without a column sensor_id all is sensor 0's */
};

/* Opens a file (scan_reader.h says what may be in it). Errors as `rhotrack: FILE:LINE: what is wrong`, exit 2. */
struct plot_source *plot_source_open(const char *path, const struct parameters *parameters,
                                     struct plot_source_options options);

/* The next scan. Returns false after the last, and where a file that is followed has no more yet. */
bool plot_source_next(struct plot_source *source, struct plot_scan *scan);

/* Of a file that is followed. */
bool plot_source_waits(const struct plot_source *source); /* false: there is an end, behind it */
const char *plot_source_why_over(const struct plot_source *source); /* as table_stream.h has it */
bool plot_source_is_mid_row(const struct plot_source *source);
void plot_source_complete(struct plot_source *source); /* no scan gets more of the rows to come */
void plot_source_end(struct plot_source *source);      /* no more rows are read */

uint64_t plot_source_rows_skipped(const struct plot_source *source);

/* Bytes of the file that are taken. */
uint64_t plot_source_position(const struct plot_source *source);
void plot_source_close(struct plot_source *source);

#endif
