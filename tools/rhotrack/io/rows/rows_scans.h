/* SPDX-License-Identifier: MIT */
/*
 * rows_scans: a file's rows as scans and lists in the order of time, or as they were received, and
 * these as messages.
 *
 * Rows of a sensor are one scan where they have the same scan and epoch (columns of these names),
 * else the same t_s, or are within scan_interval_s of the first. Its time is that of its first row,
 * or, with a column scan, of the row that saw nothing, if it has one. Truth and tracks of one t_s
 * are one list; with a column scan of one scan, else a track that is named again begins the next
 * one. What has no number is counted from 1, for each sensor; epoch is 1.
 */
#ifndef RHOTRACK_TOOL_ROWS_SCANS_H
#define RHOTRACK_TOOL_ROWS_SCANS_H

#include "io/rows/rows_read.h"

struct rows_scans {
    struct rows_file *file;
    struct rows_scan *list; /* in the order in which they are due */
    size_t count, capacity;
};

/*
 * Sorts the file's rows. What cannot be one scan is refused as rows_read_csv does: other heights,
 * sectors, places, sigmas.
 */
void rows_scans_make(struct rows_scans *scans, struct rows_file *file, int64_t interval_us);
void rows_scans_free(struct rows_scans *scans);

/* Where to go on: zeros at first. */
struct rows_at {
    size_t scan, row;
    int16_t part;
};

#define ROWS_CHANNEL_BYTES 64

/* A message in the caller's memory. */
struct rows_output {
    int64_t utime; /* of the scan, or when it was received */
    char channel[ROWS_CHANNEL_BYTES];
    uint8_t data[ROWS_MESSAGE_BYTES];
    size_t size;
};

/* The next message. Returns false after the last. */
bool rows_scans_next_message(const struct rows_scans *scans, struct rows_at *at,
                             struct rows_output *output);

#endif
