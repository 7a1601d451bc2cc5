/* SPDX-License-Identifier: MIT */
/*
 * evaluation_tables: feeds the rows of a truth and a tracks table to an evaluation,
 * time by time.
 */
#ifndef RHOTRACK_TOOL_EVALUATION_TABLES_H
#define RHOTRACK_TOOL_EVALUATION_TABLES_H

#include "evaluation/evaluation.h"
#include "io/csv/csv_table.h"
#include "settings/parameters.h"

/*
 * Evaluates the confirmed and coasting rows of tracks at the times of the truth or, where it lacks
 * some of theirs, the truth at the times of the tracks (truth_times.h). Bad cells, and tracks of
 * which no time is within the truth's, end the program with `rhotrack: FILE:LINE: what is wrong`,
 * exit 2. The parameters give the origin for positions in latitude and longitude.
 */
struct evaluation *evaluation_of_tables(const struct table *truth, const struct table *tracks,
                                        const struct parameters *parameters, double cutoff_m);

#endif
