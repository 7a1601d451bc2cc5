/* SPDX-License-Identifier: MIT */
/*
 * lab_limits: collects figures of an experiment that have a bar (an upper or lower
 * limit), as a table and JSON with the numbers of bars held and missed.
 */
#ifndef RHOTRACK_TOOL_LIMITS_HELD_OR_MISSED_H
#define RHOTRACK_TOOL_LIMITS_HELD_OR_MISSED_H

#include <cjson/cJSON.h>

#include "base/text_table.h"

struct verdicts {
    struct text_table table;
    cJSON *json; /* an array of {what, value, at_least or at_most, held} */
    int held, missed;
};

struct verdicts verdicts_start(void);

/* Adds a figure with its bar; `what` is a printf format of its name. NAN misses its bar. */
void verdicts_add_at_most(struct verdicts *verdicts, double value, double bar, const char *what,
                          ...) __attribute__((format(printf, 4, 5)));
void verdicts_add_at_least(struct verdicts *verdicts, double value, double bar, const char *what,
                           ...) __attribute__((format(printf, 4, 5)));

/* Moves the array into `object` and adds the counts; afterwards no figure can be added. */
void verdicts_move_to_json(struct verdicts *verdicts, cJSON *object);

/* Prints the table and "N bars held, M missed". */
void verdicts_print(const struct verdicts *verdicts, FILE *out);
void verdicts_free(struct verdicts *verdicts);

#endif
