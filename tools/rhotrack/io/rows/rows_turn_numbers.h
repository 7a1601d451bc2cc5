/* SPDX-License-Identifier: MIT */
/*
 * rows_turn_numbers: numbers a file's rows of plots by the turns of their antennas
 * (antenna_turns.h).
 */
#ifndef RHOTRACK_TOOL_ROWS_TURN_NUMBERS_H
#define RHOTRACK_TOOL_ROWS_TURN_NUMBERS_H

#include "io/rows/rows_from_csv.h"

/*
 * Sets the rows' turn numbers, where they are plots without scan numbers, sectors or reception
 * times, and scan_interval_s is not set.
 */
void rows_number_turns(struct rows_file *file, const struct parameters *parameters);

#endif
