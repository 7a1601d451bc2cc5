/* SPDX-License-Identifier: MIT */
/*
 * rows_to_messages: groups a file's rows into scans and lists, in the order of time or of
 * reception, and encodes these as messages.
 *
 * Rows of a sensor form one scan where they have the same scan and epoch (columns of these names),
 * else the same t_s, or are within scan_interval_s of the first row. The time of a scan is that of
 * its first row, or, with a column scan, of its row without a measurement, if there is one. Truth
 * and tracks of one t_s form one list; with a column scan those of one scan, else a track that is
 * named again begins the next list. Scans and lists without numbers are counted from 1, for each
 * sensor; epoch is 1.
 */
#ifndef RHOTRACK_TOOL_ROWS_TO_MESSAGES_H
#define RHOTRACK_TOOL_ROWS_TO_MESSAGES_H

#include "io/rows/rows_from_csv.h"

struct rows_to_messages {
    struct rows_file *file;
    struct rows_scan *list; /* scans in the order in which they are due */
    size_t count, capacity;
};

/*
 * Sorts the file's rows and groups them. Rows that cannot be in one scan (other sectors, positions,
 * sigmas, or measured quantities) are refused as rows_read_csv_or_asterix does.
 */
void rows_to_messages_make_scans(struct rows_to_messages *scans, struct rows_file *file,
                                 int64_t interval_us);
void rows_to_messages_free(struct rows_to_messages *scans);

/* Position of the next message. Initialised with zeros. */
struct rows_at {
    size_t scan, row;
    int16_t part;
};

#define ROWS_CHANNEL_BYTES 64

/* An encoded message in the caller's memory. */
struct rows_output {
    int64_t utime; /* time of the scan, or of its reception */
    char channel[ROWS_CHANNEL_BYTES];
    uint8_t data[ROWS_MESSAGE_BYTES];
    size_t size;
};

/* Encodes the next message. Returns false after the last. */
bool rows_to_messages_next_message(const struct rows_to_messages *scans, struct rows_at *at,
                                   struct rows_output *output);

#endif
