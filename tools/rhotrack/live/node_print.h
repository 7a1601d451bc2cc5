/* SPDX-License-Identifier: MIT */
/*
 * node_print: tracks on standard output as they come. On a terminal a table in one place, renewed
 * at most 10 times a second; else rows as `track` writes them. A slow reader does not stop the
 * tracking: while standard output takes no more, reports are left out whole, and counted. Of a
 * record, which waits, none are.
 */
#ifndef RHOTRACK_TOOL_NODE_PRINT_H
#define RHOTRACK_TOOL_NODE_PRINT_H

#include <stdbool.h>
#include <stdint.h>

#include "live/node_core.h"

struct node_print {
    bool is_on, is_terminal, is_live, is_changed;
    int error;      /* errno of standard output that takes no more; 0: it does */
    int64_t due_us; /* clock_us: when the table may be renewed */
    /* what standard output has not taken yet: of one text, from `at` on */
    char *text;
    size_t size, at;
    uint64_t left_out; /* reports */
};

/* is_on false: all others do nothing. is_live: what comes in does not wait for what goes out. */
struct node_print node_print_start(bool is_on, bool is_live);

/* A step was made. */
void node_print_note_step(struct node_print *print, const struct rho_report *report);

/*
 * Renews the table where it is time, or at the end, and hands all on.
 * False: standard output takes no more; errno says why.
 */
bool node_print_show(struct node_print *print, const struct node_core *core, const char *url,
                     bool is_end);

/*
 * Writes the rest until until_us of clock_us; reports that are left then count as left out.
 */
void node_print_finish(struct node_print *print, int64_t until_us);

/* When node_print_show is wanted, on clock_us; INT64_MAX: not before a step. */
int64_t node_print_due_us(const struct node_print *print);

#endif
