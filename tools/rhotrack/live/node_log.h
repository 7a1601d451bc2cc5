/* SPDX-License-Identifier: MIT */
/*
 * node_log: a node's LCM log. A thread writes it, from a queue: no disk stops the tracking, full or
 * stalled. Where the queue is full, events are left out whole, and counted; where the disk refuses
 * them the file ends behind the last whole event, and once a minute it is tried whether it takes
 * more. Of a record, which waits, none are left out that the queue could hold (4 MiB).
 *
 * Where the log is cut into several files (node_log_files.h), each holds whole events, and whoever
 * reads one to its end once it is put away, and goes on with the next name, misses none.
 */
#ifndef RHOTRACK_TOOL_NODE_LOG_H
#define RHOTRACK_TOOL_NODE_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "live/node_log_files.h"

/* All of the functions below take NULL for: there is no log. */
struct node_log;

/*
 * A file of that name is written over, or put away where the log has limits. A file that cannot be
 * opened: exit 1. One that does not open by now (a FIFO that nobody reads) is
 * waited for beside the tracking.
 *   path     NULL: no log
 *   is_live  what comes in does not wait for what goes out
 */
struct node_log *node_log_open(const char *path, bool is_live,
                               const struct node_log_limits *limits);

/*
 * Closes the file and opens its name again, where somebody has put it away, or has made room. A
 * file that is there still is added to.
 */
void node_log_reopen(struct node_log *log);

/* channel: 1 to LCM_LOG_MAX_CHANNEL characters. */
void node_log_put_event(struct node_log *log, int64_t time_us, const char *channel,
                        const uint8_t *data, size_t size);

/* Events so far that are not in the log, and will not be. */
uint64_t node_log_events_left_out(struct node_log *log);

/* Says once on standard error what is wrong, and tries again. False: the disk refuses events. */
bool node_log_report_errors(struct node_log *log);

/*
 * Writes the rest of the queue until until_us of clock_us; events that are left then count as left
 * out.
 */
void node_log_finish_queue(struct node_log *log, int64_t until_us);

/* A log whose disk does not answer stays as it is, until the program ends. */
void node_log_close(struct node_log *log);

#endif
