/* SPDX-License-Identifier: MIT */
/*
 * log_scans: the sensors' scans of an LCM log, put together as rhotrack node does it live
 * (rhotrack/scan_assembler.h), with the times of the log's events as the reception clock.
 */
#ifndef RHOTRACK_TOOL_LOG_SCANS_H
#define RHOTRACK_TOOL_LOG_SCANS_H

#include <stdbool.h>
#include <stdint.h>

#include "rhotrack/scan_assembler.h"
#include "settings/parameters.h"

/*
 * Which sensors' channels a log has; values to be or-ed. Logs are looked at twice: exit 2 where it
 * is a pipe.
 */
#define LOG_HAS_PLOTS 1u
#define LOG_HAS_BEARINGS 2u
unsigned log_scans_kinds(const char *path);

/*
 * A log's scans one by one, in the order in which the tracker would step them, in memory that does
 * not grow with the log: opening looks at all of them once. With is_reported, what was skipped goes
 * to standard error, and in one line every counter of the assembler that tells of a fault. Exit 2
 * where there is no scan, or the sensors' common clock starts anew at a time before (two recordings
 * in one): with keep_going what came before is left out instead. Where it goes on at a later time
 * (a long pause) so do the scans, but for the follow_scans - 1 that it takes to be believed. With
 * is_held they come as they are whole: the caller holds them for log_scans_hold_us.
 */
struct log_scans;
struct log_scans *log_scans_open(const char *path, const struct parameters *parameters,
                                 bool keep_going, bool is_reported, bool is_held);

/* The next one, valid until the next call. Returns false after the last. */
bool log_scans_next(struct log_scans *scans, struct rho_scan_assembler_item *item);

/* The log from its beginning again. */
void log_scans_rewind(struct log_scans *scans);

/*
 * The latest time of the events so far, and when the last part of the scan that was given last was
 * received.
 */
int64_t log_scans_clock_us(const struct log_scans *scans);
int64_t log_scans_heard_us(const struct log_scans *scans);

/*
 * hold_ms, and as long as sensors' clocks may be apart: so long scans wait for earlier ones. The
 * assembler's room may not last for it.
 */
int64_t log_scans_hold_us(const struct parameters *parameters);

/* How many bytes of the log are taken. */
uint64_t log_scans_position(const struct log_scans *scans);
void log_scans_close(struct log_scans *scans);

#endif
