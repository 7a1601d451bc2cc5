/* SPDX-License-Identifier: MIT */
/*
 * error_lines: standard error of a program that runs for months. From error_lines_open on each
 * line, whichever part of the program writes it, begins with its time, and sensors that have a name
 * ([sensor N] name) are called by it:
 *
 *     2026-11-22T09:14:03.250Z rhotrack: sensor 1 (north) is silent: ...
 *
 * The journal of systemd has times of its own, so its lines get none. Nobody waits for a full pipe
 * or terminal: lines that do not fit are missing.
 */
#ifndef RHOTRACK_TOOL_ERROR_LINES_H
#define RHOTRACK_TOOL_ERROR_LINES_H

#include <stdbool.h>
#include <stdint.h>

#include "settings/parameters.h"

/*
 * The parameters' address is kept.
 *   is_live  the time is that of the day; else that of error_lines_set_time, none before
 */
void error_lines_open(const struct parameters *parameters, bool is_live);

/* Of a record: the time of what was read last, us since 1970. */
void error_lines_set_time(int64_t time_us);

/* A line past the stream, whose lock another thread may hold for good. */
void error_lines_write(const char *text);

/* Lines are missing. */
bool error_lines_is_lossy(void);

#endif
