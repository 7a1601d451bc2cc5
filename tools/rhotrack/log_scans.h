/* SPDX-License-Identifier: MIT */
/*
 * log_scans: the sensors' scans of an LCM log, put together as rhotrack node does it live (rhotrack/feed.h), with the times
 * of the log's events as the reception clock.
 */
#ifndef RHOTRACK_TOOL_LOG_SCANS_H
#define RHOTRACK_TOOL_LOG_SCANS_H

#include <stdbool.h>
#include <stddef.h>

#include "parameters.h"
#include "rhotrack/feed.h"

/* Which sensors' channels a log has; values to be or-ed. Logs are looked at twice: exit 2 where it is a pipe. */
#define LOG_HAS_PLOTS 1u
#define LOG_HAS_BEARINGS 2u
unsigned log_scans_kinds(const char *path);

/* In the order in which the tracker would step them. The plots and bearings are the items' own. */
struct log_scans {
    struct rho_feed_item *items;
    size_t count, capacity;
};

/*
 * Reads all scans of a log. With is_told, what was skipped goes to standard error, and in one line every counter of the
 * feed that tells of something wrong. Exit 2 where there is no scan, or the sensors' common clock starts anew at a time
 * before (two recordings in one): with keep_going what came before is left out instead. Where it goes on at a later time
 * (a long pause) so do the scans, but for the follow_scans - 1 that it takes to be believed.
 */
struct log_scans log_scans_read(const char *path, const struct parameters *parameters,
                                bool keep_going, bool is_told);
void log_scans_free(struct log_scans *scans);

#endif
