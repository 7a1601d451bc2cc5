/* SPDX-License-Identifier: MIT */
/*
 * node_log_files: the files of a node's log, where it is cut into several. FILE.lcm is the one that
 * is written; earlier ones are FILE-20261122T091403.250Z.lcm, by the time of their first event, so
 * that names in order are files in order.
 */
#ifndef RHOTRACK_TOOL_NODE_LOG_FILES_H
#define RHOTRACK_TOOL_NODE_LOG_FILES_H

#include <stdbool.h>
#include <stdint.h>

/*
 * Where a file ends: at the event that would go beyond bytes_max, or that is of another period_us
 * since 1970 than the first one; 0: there. files_max earlier files are kept, the newest; 0: all.
 */
struct node_log_limits {
    uint64_t bytes_max;
    int64_t period_us;
    unsigned files_max;
};

bool node_log_limits_are_set(const struct node_log_limits *limits);

/* The event may not go into the file, which has so many bytes and began at begin_us. */
bool node_log_limits_reached(const struct node_log_limits *limits, uint64_t file_bytes,
                             int64_t begin_us, uint64_t event_bytes, int64_t time_us);

/*
 * Renames the file, if there is one and it is no device or pipe, and removes those that are too
 * many. The name is never one that is taken. Returns errno of what was refused; 0: nothing.
 */
int node_log_files_put_away(const char *path, int64_t begin_us, unsigned files_max);

/* Of a file of an earlier run, which is put away at the start: when it was written to last. */
int64_t node_log_files_last_write_us(const char *path);

#endif
