/* SPDX-License-Identifier: MIT */
/*
 * stderr_time_stamps: standard error of a long-running program. After
 * error_lines_stamp_stderr every line written to stderr begins with a time stamp, and
 * sensors that have a name ([sensor N] name) are printed with it:
 *
 *     2026-11-22T09:14:03.250Z rhotrack: sensor 1 (north) is silent: ...
 *
 * The systemd journal has its own time stamps, so its lines get none. Writes do not wait for a full
 * pipe or terminal: lines that do not fit are lost.
 */
#ifndef RHOTRACK_TOOL_STDERR_TIME_STAMPS_H
#define RHOTRACK_TOOL_STDERR_TIME_STAMPS_H

#include <stdbool.h>
#include <stdint.h>

#include "settings/parameters.h"

/*
 * Replaces the stream stderr by one that adds time stamps and sensor names. The parameters must
 * stay at their address.
 *   is_live  time stamps are the time of day; else the time of error_lines_set_time, and none
 *            before its first call
 */
void error_lines_stamp_stderr(const struct parameters *parameters, bool is_live);

/* Sets the time stamp of later lines in a replay: the time of the last message, us since 1970. */
void error_lines_set_time(int64_t time_us);

/*
 * Writes a line directly to the descriptor of standard error, without the lock of stderr, which a
 * blocked thread may hold for ever.
 */
void error_lines_write_directly(const char *text);

/* True where lines of standard error were lost. */
bool error_lines_were_lost(void);

#endif
