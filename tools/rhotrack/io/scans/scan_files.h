/* SPDX-License-Identifier: MIT */
/*
 * scan_files: the scans of several files of one kind, merged by time; at equal times the scan of
 * the file named first comes first.
 */
#ifndef RHOTRACK_TOOL_SCAN_FILES_H
#define RHOTRACK_TOOL_SCAN_FILES_H

#include "io/scans/scan_source.h"

/* One file, and its next scan read ahead. */
struct scan_file {
    struct scan_source *source;
    struct sensor_scan next;
    bool has_next;
};

struct scan_files {
    struct scan_file *list;
    int count;
};

/* Opens the files. Errors as scan_source.h has them. */
struct scan_files scan_files_open(char *const *paths, int num_paths,
                                  const struct parameters *parameters,
                                  struct scan_source_options options);

/* Takes the next scan, which the caller then owns. Returns false after the last. */
bool scan_files_next(struct scan_files *files, struct sensor_scan *scan);

uint64_t scan_files_rows_skipped(const struct scan_files *files);

/* Bytes read of all files, for progress bars. */
uint64_t scan_files_position(const struct scan_files *files);
void scan_files_close(struct scan_files *files);

#endif
