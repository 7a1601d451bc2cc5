/* SPDX-License-Identifier: MIT */
/*
 * rows_from_messages: converts messages of one kind, in any order, to rows in the order of time, or
 * of reception.
 *
 * The parts of a scan are joined in their order; its plots are in the order of their own times. A
 * scan without plots, and one whose first plot is not at the scan's time, begins with a row without
 * a measurement. A list without elements gives no row.
 */
#ifndef RHOTRACK_TOOL_ROWS_FROM_MESSAGES_H
#define RHOTRACK_TOOL_ROWS_FROM_MESSAGES_H

#include "io/log/lcm_log.h"
#include "io/rows/rows_in_memory.h"

struct rows_collection {
    struct rows rows;
    /* a log's event times are reception times where they differ from the scans' times */
    bool with_received;
    struct rows_message *messages;
    size_t count, capacity;
    uint64_t messages_bad;     /* bad messages left out */
    uint64_t messages_again;   /* repeated parts left out */
    uint64_t scans_incomplete; /* scans and lists with missing parts */
    uint64_t lists_empty;
};

void rows_from_messages_start(struct rows_collection *collection, const struct rows_kind *kind);

/*
 * Adds the message of a log's event, if it is of the kind. A bad message: exit 2, with file, event
 * and byte; with keep_going it is counted in messages_bad instead.
 */
void rows_from_messages_add_event(struct rows_collection *collection, const char *path,
                                  const struct lcm_log_event *event, bool keep_going);

/* Adds a message. Returns NULL, or why it is bad: a constant text, or `reason`. */
#define ROWS_FROM_MESSAGES_REASON_BYTES 120
const char *rows_from_messages_add(struct rows_collection *collection, const char *channel,
                                   const uint8_t *data, size_t size,
                                   char reason[ROWS_FROM_MESSAGES_REASON_BYTES]);

/* Joins the parts of scans and sorts the rows; no message may be added after it. */
void rows_from_messages_sort(struct rows_collection *collection);
void rows_from_messages_free(struct rows_collection *collection);

#endif
