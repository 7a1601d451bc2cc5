/* SPDX-License-Identifier: MIT */
/*
 * log_scans: the sensors' scans of an LCM log, assembled as rhotrack node does live
 * (rhotrack/scan_assembler.h), with the times of the log's events as reception times.
 */
#ifndef RHOTRACK_TOOL_LOG_SCANS_H
#define RHOTRACK_TOOL_LOG_SCANS_H

#include <stdbool.h>
#include <stdint.h>

#include "rhotrack/scan_assembler.h"
#include "settings/parameters.h"

/*
 * Kinds of sensor scans that a log has channels of, LOG_HAS_... or-ed. Exit 2 where the path is a
 * pipe: logs are read twice.
 */
#define LOG_HAS_PLOTS 1u
#define LOG_HAS_BEARINGS 2u
unsigned log_scans_kinds(const char *path);

/*
 * Opens a log to take its scans one by one, in the order in which the tracker would step them, in
 * memory that does not grow with the log: opening reads the whole log once.
 *
 * reports_faults: skipped bytes, and in one line all faults that the assembler counted, are
 * reported on standard error. Exit 2 where the log has no scan, or where the sensors' common clock
 * is set back (two recordings in one file); with keep_going the scans before are left out instead.
 * After a long pause the scans go on, but for the follow_scans - 1 scans until the assembler
 * accepts the new time. caller_holds_scans: scans are given as soon as they are whole, since the
 * caller delays them by log_scans_hold_us itself.
 */
struct log_scans;
struct log_scans *log_scans_open(const char *path, const struct parameters *parameters,
                                 bool keep_going, bool reports_faults, bool caller_holds_scans);

/* Takes the next scan, valid until the next call. Returns false after the last scan. */
bool log_scans_next(struct log_scans *scans, struct rho_scan_assembler_item *item);

/* Starts again at the beginning of the log. */
void log_scans_rewind(struct log_scans *scans);

/*
 * Reception times: the latest time of the log's events so far, and the time at which the last part
 * of the newest scan that was given arrived.
 */
int64_t log_scans_latest_event_us(const struct log_scans *scans);
int64_t log_scans_scan_received_us(const struct log_scans *scans);

/*
 * Time that scans wait for earlier ones: hold_ms plus the largest difference of sensors' time
 * biases. The assembler's buffers may be too small for such a wait.
 */
int64_t log_scans_hold_us(const struct parameters *parameters);

/* Number of bytes of the log that have been read. */
uint64_t log_scans_position(const struct log_scans *scans);
void log_scans_close(struct log_scans *scans);

#endif
