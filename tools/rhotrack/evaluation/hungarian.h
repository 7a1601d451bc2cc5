/* SPDX-License-Identifier: MIT */
/*
 * hungarian: assigns each row of a cost matrix a column of its own so that the sum of costs is
 * least.
 */
#ifndef RHOTRACK_TOOL_HUNGARIAN_H
#define RHOTRACK_TOOL_HUNGARIAN_H

#include <stddef.h>

/*
 * Fills column_of[row] for cost[row * columns + column]; rows <= columns. Time grows with rows^2 x
 * columns.
 */
void hungarian_assign(size_t rows, size_t columns, const double *cost, size_t *column_of);

#endif
