/* SPDX-License-Identifier: MIT */
/*
 * node_log_writer: the LCM log of a live node. A thread writes it from a queue, so that a full
 * or stalled disk does not stop the tracking. Where the queue is full, whole events are left out
 * and counted. Where the disk refuses events, the file ends behind its last whole event, and
 * writing is tried again once a minute. Replays, which can wait, lose no event that fits the queue
 * (4 MiB).
 *
 * Where the log is rotated (node_log_rotation.h), each file holds whole events, and a reader that
 * reads each file to its end and continues with the next name misses none.
 */
#ifndef RHOTRACK_TOOL_NODE_LOG_WRITER_H
#define RHOTRACK_TOOL_NODE_LOG_WRITER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "live/node_log_rotation.h"

/* All functions below accept NULL, a node without a log. */
struct node_log;

/*
 * Opens the log; an existing file is overwritten, or renamed first where the log has limits. Exit 1
 * where the file cannot be opened, but not where that is as a disk is full, read-only or broken and
 * the input is live. A file that takes long to open (a FIFO without a reader) is opened in the
 * background.
 *   path     NULL: no log
 *   is_live  full queues drop events; else node_log_put_event waits for room
 */
struct node_log *node_log_open(const char *path, bool is_live,
                               const struct node_log_limits *limits);

/*
 * Closes the file and opens its name anew, after a log rotation or when the disk has room again. A
 * file that still has its name is appended to.
 */
void node_log_reopen(struct node_log *log);

/* Queues an event; channels have 1 to LCM_LOG_MAX_CHANNEL characters. */
void node_log_put_event(struct node_log *log, int64_t time_us, const char *channel,
                        const uint8_t *data, size_t size);

/* Number of events so far that were not logged. */
uint64_t node_log_events_left_out(struct node_log *log);

/*
 * Prints new errors once on standard error, and reopens the file where it was removed or the disk
 * refused events. Returns false while the disk refuses events.
 */
bool node_log_report_and_retry(struct node_log *log);

/*
 * Writes the rest of the queue until the monotonic time until_us; remaining events count as left
 * out.
 */
void node_log_finish_queue(struct node_log *log, int64_t until_us);

/* Frees the log. Where a write still blocks, its memory is left to the writer thread. */
void node_log_free_if_written(struct node_log *log);

#endif
