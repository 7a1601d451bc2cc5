/* SPDX-License-Identifier: MIT */
/*
 * sensor_names: numbers of sensors that files name, as a column `station` with DF-North. A name has
 * the number of the section [sensor N] with that `name`, else the least one from 1 on that no other
 * sensor has, the same in all files of a run. A line on standard error says which.
 */
#ifndef RHOTRACK_TOOL_SENSOR_NAMES_H
#define RHOTRACK_TOOL_SENSOR_NAMES_H

#include "io/csv/row_cells.h"
#include "settings/parameters.h"

/*
 * Reads the row's sensor: a number, or a name that begins with a letter. Returns false with the
 * reason where it is neither, where other rows have the other one, or where there is no room for
 * another name.
 */
bool sensor_names_read(const struct row_check *check, const struct parameters *parameters,
                       int32_t *sensor_id);

#endif
