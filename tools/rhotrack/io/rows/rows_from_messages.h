/* SPDX-License-Identifier: MIT */
/*
 * rows_from_messages: messages of one kind, in any order, as rows in the order of time, or of
 * reception.
 *
 * The parts of a scan come together, in their order; its plots in the order of their own times. A
 * scan without plots, and one whose first plot is not at the scan's time, begins with a row that
 * saw nothing. A list without elements has no row.
 */
#ifndef RHOTRACK_TOOL_ROWS_FROM_MESSAGES_H
#define RHOTRACK_TOOL_ROWS_FROM_MESSAGES_H

#include "io/log/lcm_log.h"
#include "io/rows/rows.h"

struct rows_collection {
    struct rows rows;
    bool
        /* the times of a log's events count, where they are not those of the scans */
        with_received;
    struct rows_message *messages;
    size_t count, capacity;
    uint64_t messages_bad;     /* left out */
    uint64_t messages_again;   /* parts that were there before: left out */
    uint64_t scans_incomplete; /* scans and lists that lack parts */
    uint64_t lists_empty;
};

void rows_from_messages_start(struct rows_collection *collection, const struct rows_kind *kind);

/*
 * Takes the message of an event of a log, if it is of the kind. A bad one: exit 2, with file, event
 * and byte; with keep_going it is counted in messages_bad instead.
 */
void rows_from_messages_add_event(struct rows_collection *collection, const char *path,
                                  const struct lcm_log_event *event, bool keep_going);

/* Takes a message. Returns NULL, or why it is bad, in constant memory or reason. */
#define ROWS_FROM_MESSAGES_REASON_BYTES 120
const char *rows_from_messages_add(struct rows_collection *collection, const char *channel,
                                   const uint8_t *data, size_t size,
                                   char reason[ROWS_FROM_MESSAGES_REASON_BYTES]);

/* Puts the rows in order. */
void rows_from_messages_finish(struct rows_collection *collection);
void rows_from_messages_free(struct rows_collection *collection);

#endif
