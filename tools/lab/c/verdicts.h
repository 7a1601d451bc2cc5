/* SPDX-License-Identifier: MIT */
/*
 * verdicts: the figures of an experiment that have bars, as a table with its count of bars held and
 * missed.
 */
#ifndef RHOTRACK_TOOL_VERDICTS_H
#define RHOTRACK_TOOL_VERDICTS_H

#include <cjson/cJSON.h>

#include "base/text_table.h"

struct verdicts {
    struct text_table table;
    cJSON *json; /* an array of {what, value, at_least or at_most, held} */
    int held, missed;
};

struct verdicts verdicts_start(void);

/* One more figure, printf of what it is. A value that is no number is missed. */
void verdicts_at_most(struct verdicts *verdicts, double value, double bar, const char *what, ...)
    __attribute__((format(printf, 4, 5)));
void verdicts_at_least(struct verdicts *verdicts, double value, double bar, const char *what, ...)
    __attribute__((format(printf, 4, 5)));

/* The array becomes `object`'s, with the counts beside it. */
void verdicts_to_json(struct verdicts *verdicts, cJSON *object);

/* The table and "N bars held, M missed". */
void verdicts_print(const struct verdicts *verdicts, FILE *out);
void verdicts_free(struct verdicts *verdicts);

#endif
