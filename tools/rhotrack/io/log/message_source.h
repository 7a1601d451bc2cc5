/* SPDX-License-Identifier: MIT */
/*
 * message_source: files in, LCM messages out, in the order of time.
 *
 * A CSV file of plots, polar plots, bearings, truth or tracks (told apart by its columns) gives its
 * messages, at the times of their scans, or where it says so (received_s) when these were received;
 * long scans come in parts, one after the other. An LCM log gives its events as they are, of any
 * channel and content, at the times that stand in the log, in the log's own order. Several files
 * are merged by time; of one time the first file's come first.
 */
#ifndef RHOTRACK_TOOL_MESSAGE_SOURCE_H
#define RHOTRACK_TOOL_MESSAGE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "settings/parameters.h"

struct message_source;

/* Valid until the next call. */
struct message_event {
    int64_t utime;       /* us: of the scan or its reception, or as the log has it */
    const char *channel; /* 1 to 63 characters */
    const uint8_t *data; /* of a CSV file: a message of rhotrack that is valid */
    size_t size;
};

/*
 * Opens the files. Of the parameters, which are not kept, scan_interval_s makes scans of rows with
 * times of their own, and sensor.N.x_m and so on place radars that the file does not place. A CSV
 * file is read and checked as a whole: errors as `rhotrack: FILE:LINE: what is wrong`, exit 2; with
 * keep_going bad rows are skipped and counted instead. A log is read as it is used, damaged places
 * are skipped and counted; no event in it at all: exit 2.
 */
struct message_source *message_source_open(char *const *paths, int num_paths,
                                           const struct parameters *parameters, bool keep_going);

/* The next message. Returns false after the last. */
bool message_source_next(struct message_source *source, struct message_event *event);

/* Tells on standard error what was skipped so far, if anything. */
void message_source_report(const struct message_source *source);
void message_source_close(struct message_source *source);

#endif
