/* SPDX-License-Identifier: MIT */
/*
 * hungarian: which column each row takes, so that the sum of the costs is least; one row a column
 * at most.
 */
#ifndef RHOTRACK_TOOL_HUNGARIAN_H
#define RHOTRACK_TOOL_HUNGARIAN_H

#include <stddef.h>

/*
 * Fills column_of[row]; rows <= columns, cost[row * columns + column]. Time grows with rows^2 x
 * columns.
 */
void hungarian_assign(size_t rows, size_t columns, const double *cost, size_t *column_of);

#endif
