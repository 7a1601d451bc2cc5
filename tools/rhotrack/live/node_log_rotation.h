/* SPDX-License-Identifier: MIT */
/*
 * node_log_rotation: rotation of a node's log files. FILE.lcm is being written; earlier files are
 * named by the time of their first event, FILE-20261122T091403.250Z.lcm, so that names sort by
 * time.
 */
#ifndef RHOTRACK_TOOL_NODE_LOG_ROTATION_H
#define RHOTRACK_TOOL_NODE_LOG_ROTATION_H

#include <stdbool.h>
#include <stdint.h>

/*
 * Limits of a log file: it ends before the event that would exceed bytes_max, and where a new
 * multiple of period_us since 1970 begins; 0: no such limit. The newest files_max earlier files are
 * kept; 0: all of them.
 */
struct node_log_limits {
    uint64_t bytes_max;
    int64_t period_us;
    unsigned files_max;
};

bool node_log_has_rotation_limit(const struct node_log_limits *limits);

/*
 * True where an event must go into a new file, as the current file of file_bytes that began at
 * begin_us would exceed a limit.
 */
bool node_log_limits_reached(const struct node_log_limits *limits, uint64_t file_bytes,
                             int64_t begin_us, uint64_t event_bytes, int64_t time_us);

/*
 * Renames a regular file by its time stamp, to a name that is free, and removes the oldest files
 * beyond files_max. Returns the errno of a failed rename or removal; 0: none failed.
 */
int node_log_files_rotate(const char *path, int64_t begin_us, unsigned files_max);

/*
 * Time of a file's last change: stamps the log of an earlier run, whose first event is not known.
 */
int64_t node_log_files_file_span_us(const char *path);

#endif
