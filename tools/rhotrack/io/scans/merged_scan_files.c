/* SPDX-License-Identifier: MIT */
#include "io/scans/merged_scan_files.h"

#include <stdlib.h>

#include "base/common.h"

struct merged_scan_files merged_scan_files_open(char *const *paths, int num_paths,
                                                const struct parameters *parameters,
                                                struct scan_source_options options)
{
    struct merged_scan_files files = {.list = must_calloc((size_t)num_paths, sizeof *files.list),
                                      .count = num_paths};

    for (int i = 0; i < num_paths; i++) {
        files.list[i].source = scan_source_open(paths[i], parameters, options);
    }
    return files;
}

bool merged_scan_files_next(struct merged_scan_files *files, struct sensor_scan *scan)
{
    struct scan_file *earliest = NULL;

    for (int i = 0; i < files->count; i++) {
        struct scan_file *file = &files->list[i];

        file->has_next = file->has_next || scan_source_next(file->source, &file->next);
        if (file->has_next && (!earliest || sensor_scan_time_us(&file->next) <
                                                sensor_scan_time_us(&earliest->next))) {
            earliest = file;
        }
    }
    if (!earliest) {
        return false;
    }
    *scan = earliest->next;
    earliest->has_next = false;
    return true;
}

uint64_t merged_scan_files_rows_skipped(const struct merged_scan_files *files)
{
    uint64_t rows = 0;

    for (int i = 0; i < files->count; i++) {
        rows += scan_source_rows_skipped(files->list[i].source);
    }
    return rows;
}

uint64_t merged_scan_files_bytes_read(const struct merged_scan_files *files)
{
    uint64_t bytes = 0;

    for (int i = 0; i < files->count; i++) {
        bytes += scan_source_position(files->list[i].source);
    }
    return bytes;
}

void merged_scan_files_close(struct merged_scan_files *files)
{
    for (int i = 0; i < files->count; i++) {
        if (files->list[i].has_next) {
            sensor_scan_free(&files->list[i].next);
        }
        scan_source_close(files->list[i].source);
    }
    free(files->list);
}
