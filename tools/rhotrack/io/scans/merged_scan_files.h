/* SPDX-License-Identifier: MIT */
/*
 * merged_scan_files: the scans of several files of one kind, merged by time; at equal times the
 * scan of the file named first comes first.
 */
#ifndef RHOTRACK_TOOL_MERGED_SCAN_FILES_H
#define RHOTRACK_TOOL_MERGED_SCAN_FILES_H

#include "io/scans/scan_source.h"

/* One file, and its next scan read ahead. */
struct scan_file {
    struct scan_source *source;
    struct sensor_scan next;
    bool has_next;
};

struct merged_scan_files {
    struct scan_file *list;
    int count;
};

/* Opens the files. Errors as scan_source.h has them. */
struct merged_scan_files merged_scan_files_open(char *const *paths, int num_paths,
                                                const struct parameters *parameters,
                                                struct scan_source_options options);

/* Takes the next scan, which the caller then owns. Returns false after the last. */
bool merged_scan_files_next(struct merged_scan_files *files, struct sensor_scan *scan);

uint64_t merged_scan_files_rows_skipped(const struct merged_scan_files *files);

/* Bytes read of all files, for progress bars. */
uint64_t merged_scan_files_bytes_read(const struct merged_scan_files *files);
void merged_scan_files_close(struct merged_scan_files *files);

#endif
