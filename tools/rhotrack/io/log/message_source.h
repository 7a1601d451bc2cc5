/* SPDX-License-Identifier: MIT */
/*
 * message_source: reads CSV files and LCM logs as one stream of LCM messages in the order
 * of time.
 *
 * A CSV file of plots, polar plots, bearings, truth or tracks (told apart by its columns) gives its
 * messages at the times of their scans, or at their reception times where it has a column
 * received_s; long scans are split into parts, one after the other. An LCM log gives its events
 * unchanged, of any channel and content, at their times in the log, in the log's own order. Several
 * files are merged by time; at equal times the file named first comes first.
 */
#ifndef RHOTRACK_TOOL_MESSAGE_SOURCE_H
#define RHOTRACK_TOOL_MESSAGE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "settings/parameters.h"

struct message_source;

/* One message with its time and channel, valid until the next call. */
struct message_event {
    int64_t utime;       /* us: time of the scan or of its reception; of a log, the event's time */
    const char *channel; /* name of the channel, 1 to 63 characters */
    /* the encoded message; from a CSV file always a valid message of rhotrack */
    const uint8_t *data;
    size_t size;
};

/*
 * Opens the files. The parameters are used during the call alone: scan_interval_s gathers rows with
 * times of their own into scans, and sensor.N.x_m and so on give the places of radars that the file
 * does not place. A CSV file is read and checked as a whole: errors as `rhotrack: FILE:LINE: what
 * is wrong`, exit 2; with keep_going bad rows are skipped and counted instead. A log is read while
 * it is used, damaged places are skipped and counted; a log without events: exit 2.
 */
struct message_source *message_source_open(char *const *paths, int num_paths,
                                           const struct parameters *parameters, bool keep_going);

/* Takes the next message of all files. Returns false after the last one. */
bool message_source_next(struct message_source *source, struct message_event *event);

/* Reports on standard error the bytes and rows that were skipped so far, if any. */
void message_source_report_skipped(const struct message_source *source);
void message_source_close(struct message_source *source);

#endif
