/* SPDX-License-Identifier: MIT */
/* learned_report: what a tracker has learned of the sensors that were described to it, and uses. */
#ifndef RHOTRACK_TOOL_LEARNED_REPORT_H
#define RHOTRACK_TOOL_LEARNED_REPORT_H

#include <stdio.h>

#include "rhotrack/reflectors.h"
#include "rhotrack/tracker.h"

/*
 * Of sensors that are not as stated, and of walls that are learned (NULL: none are), each with a
 * comma before it: part of a summary.
 */
void learned_report_print(const struct rho_tracker *tracker,
                          const struct rho_reflector_learning *walls, FILE *to);

/* A list, the caller's. */
struct cJSON;
struct cJSON *learned_report_sensors_json(const struct rho_tracker *tracker);

/* How many walls are learned (NULL: none are), and a list of them. */
unsigned learned_report_num_walls(const struct rho_reflector_learning *walls);
struct cJSON *learned_report_walls_json(const struct rho_reflector_learning *walls);

#endif
