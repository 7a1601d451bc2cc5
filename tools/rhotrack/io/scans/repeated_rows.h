/* SPDX-License-Identifier: MIT */
/*
 * repeated_rows: rows that say again what another row has said, of the same sensor and time, as in
 * recordings of two lines of one radar: a target would have two tracks. They are left out. And rows
 * at 0, 0 of a sensor that has shown several of these at once: slots of its list that are empty.
 * They tell a look alone. Both are counted.
 */
#ifndef RHOTRACK_TOOL_REPEATED_ROWS_H
#define RHOTRACK_TOOL_REPEATED_ROWS_H

#include "io/csv/measurement_row.h"

struct repeated_rows;

struct repeated_rows *repeated_rows_open(void);

/*
 * Whether a row is to be left out; repeats are looked for among some thousand rows before it. An
 * empty slot becomes a row without a measurement.
 */
bool repeated_rows_leaves_out(struct repeated_rows *rows, struct measurement_row *row);

/* Prints how many rows were left out, and nothing where none was. */
void repeated_rows_report(const struct repeated_rows *rows, const char *path);

void repeated_rows_free(struct repeated_rows *rows); /* NULL is allowed */

#endif
