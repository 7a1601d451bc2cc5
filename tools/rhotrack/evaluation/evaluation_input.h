/* SPDX-License-Identifier: MIT */
/*
 * evaluation_input: the rows of a truth and of a tracks file, brought to an evaluation time by
 * time.
 */
#ifndef RHOTRACK_TOOL_EVALUATION_INPUT_H
#define RHOTRACK_TOOL_EVALUATION_INPUT_H

#include "evaluation/evaluation.h"
#include "io/csv/table.h"
#include "settings/parameters.h"

/*
 * The times are those of the truth; confirmed and coasting rows count. Errors as `rhotrack:
 * FILE:LINE: what is wrong`, exit 2: bad cells, a tracks time that is not a truth time within 1 ms.
 * The parameters say where the origin is of a truth in latitude and longitude.
 */
struct evaluation *evaluation_of_tables(const struct table *truth, const struct table *tracks,
                                        const struct parameters *parameters, double cutoff_m);

#endif
