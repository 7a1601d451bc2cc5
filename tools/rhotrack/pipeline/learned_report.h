/* SPDX-License-Identifier: MIT */
/*
 * learned_report: reports what the tracker has learned of its sensors (noise, pd, Doppler notch)
 * and of walls.
 */
#ifndef RHOTRACK_TOOL_LEARNED_REPORT_H
#define RHOTRACK_TOOL_LEARNED_REPORT_H

#include <stdio.h>

#include "rhotrack/reflectors.h"
#include "rhotrack/tracker.h"

/*
 * Prints learned values of sensors that differ from the stated ones, and learned walls (walls NULL:
 * none), each after a comma, as part of a summary line.
 */
void learned_report_print(const struct rho_tracker *tracker,
                          const struct rho_reflector_learning *walls, FILE *to);

/* Learned values of each sensor as a JSON list; the caller owns the list. */
struct cJSON;
struct cJSON *learned_report_sensors_json(const struct rho_tracker *tracker);

/* Number of learned walls, and a JSON list of them; walls NULL: none are learned. */
unsigned learned_report_num_walls(const struct rho_reflector_learning *walls);
struct cJSON *learned_report_walls_json(const struct rho_reflector_learning *walls);

#endif
