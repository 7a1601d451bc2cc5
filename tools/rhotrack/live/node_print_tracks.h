/* SPDX-License-Identifier: MIT */
/*
 * node_print_tracks: prints a live node's tracks on standard output: on a terminal as a table in
 * place, refreshed at most 10 times a second; else as rows, as the command track writes them. A
 * slow reader does not stop the tracking: while standard output is full, whole reports are left out
 * and counted. Replays, which can wait, lose none.
 */
#ifndef RHOTRACK_TOOL_NODE_PRINT_TRACKS_H
#define RHOTRACK_TOOL_NODE_PRINT_TRACKS_H

#include <stdbool.h>
#include <stdint.h>

#include "live/node_core.h"

struct node_print {
    bool is_on, is_terminal, is_live, is_changed;
    int error;      /* errno of a failed write to standard output; 0: none */
    int64_t due_us; /* monotonic time at which the table may be refreshed */
    /* text that standard output has not taken yet, from offset `at` on */
    char *text;
    size_t size, at;
    uint64_t left_out; /* reports that were not printed */
};

/*
 * Starts printing. is_on false: the other functions do nothing. is_live false: printing waits for a
 * slow reader, as a replay can wait.
 */
struct node_print node_print_start_rows_or_table(bool is_on, bool is_live);

/* Takes the report of a step: prints its rows, or marks the table as changed. */
void node_print_rows(struct node_print *print, const struct rho_report *report);

/*
 * Refreshes the table where it is due or at the end, and writes pending text. Returns false with
 * errno where standard output failed.
 */
bool node_print_refresh(struct node_print *print, const struct node_core *core, const char *url,
                        bool is_end);

/*
 * Writes pending text until the monotonic time until_us; a report that remains counts as left out.
 */
void node_print_finish(struct node_print *print, int64_t until_us);

/*
 * Monotonic time at which node_print_refresh has work; INT64_MAX: not before
 * the next step.
 */
int64_t node_print_due_us(const struct node_print *print);

#endif
