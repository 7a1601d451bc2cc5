/* SPDX-License-Identifier: MIT */
/*
 * antenna_turns: rows of plots that have a time each, gathered into the turns of their antennas,
 * without being asked. Rows of a file are looked at first, a rule is found for each of its sensors
 * (turn_search.h), and the rows then get the numbers of their turns.
 */
#ifndef RHOTRACK_TOOL_ANTENNA_TURNS_H
#define RHOTRACK_TOOL_ANTENNA_TURNS_H

#include <stdbool.h>

#include "settings/parameters.h"

struct antenna_turns;

/* Nobody said how rows become scans: scan_interval_s is as it is by default. */
bool antenna_turns_are_wanted(const struct parameters *parameters);

struct antenna_turns *antenna_turns_start(void);

/*
 * A row that is looked at, in the order of time: a plot as its sensor sees it. Returns false where
 * there were enough.
 */
bool antenna_turns_look_at_row(struct antenna_turns *turns, int32_t sensor_id, int64_t time_us,
                               double x_m, double y_m);

/*
 * Finds the rules; a line for each on standard error, and for each sensor whose rows are parts of
 * looks, and it is not known which. Returns false where no row gets a number.
 */
bool antenna_turns_find_rules(struct antenna_turns *turns, const char *path, double v_max_mps);

/*
 * The number of the turn that a row belongs to, from 1; 0: its sensor has no turns. Numbers do not
 * go back. A row that saw nothing has no place (NULL).
 */
int32_t antenna_turns_number_row(struct antenna_turns *turns, int32_t sensor_id, int64_t time_us,
                                 const double place_m[2]);

void antenna_turns_free(struct antenna_turns *turns);

#endif
