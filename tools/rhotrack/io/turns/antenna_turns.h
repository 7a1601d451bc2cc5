/* SPDX-License-Identifier: MIT */
/*
 * antenna_turns: numbers the turns of rotating antennas in files whose plots have a time each,
 * where scan_interval_s is not set. The first rows of a file are collected, a rule is found for
 * each of its sensors (turn_search.h), and the rows then get the numbers of their
 * turns.
 */
#ifndef RHOTRACK_TOOL_ANTENNA_TURNS_H
#define RHOTRACK_TOOL_ANTENNA_TURNS_H

#include <stdbool.h>

#include "settings/parameters.h"

struct antenna_turns;

/*
 * Whether turns are to be searched for: the user did not set scan_interval_s, by which scans are
 * known. They are known by numbers of frames, too, where a file has these as its times.
 */
bool antenna_turns_are_wanted(const struct parameters *parameters);

struct antenna_turns *antenna_turns_start(void);

/* Notes a row without a measurement, for the search of rules. */
void antenna_turns_add_empty_row(struct antenna_turns *turns, int32_t sensor_id);

/*
 * Collects a row for the search of rules, in the order of time: a plot's place relative to its
 * sensor. Returns false once there are enough rows.
 */
bool antenna_turns_add_row(struct antenna_turns *turns, int32_t sensor_id, int64_t time_us,
                           double x_m, double y_m);

/*
 * Finds the rule of each sensor, and reports each on standard error, also for sensors whose scans
 * cannot be told. Returns false where no sensor has a rule.
 */
bool antenna_turns_find_rules(struct antenna_turns *turns, const char *path, double v_max_mps);

/*
 * Number of the turn that a row belongs to, from 1; 0 where its sensor has no rule. A sensor's
 * numbers never decrease. place_m: the plot relative to its sensor; NULL for a row without a plot.
 */
int32_t antenna_turns_number_row(struct antenna_turns *turns, int32_t sensor_id, int64_t time_us,
                                 const double place_m[2]);

void antenna_turns_free(struct antenna_turns *turns);

#endif
