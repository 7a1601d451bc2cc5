/* SPDX-License-Identifier: MIT */
/*
 * learned_report: reports what the tracker has learned of its sensors (noise, pd, Doppler notch),
 * of tracks' lives, of walls, and of echoes that stand.
 */
#ifndef RHOTRACK_TOOL_LEARNED_REPORT_H
#define RHOTRACK_TOOL_LEARNED_REPORT_H

#include <stdio.h>

#include "rhotrack/reflectors.h"
#include "rhotrack/tracker.h"

/*
 * Prints learned values of sensors that differ from the stated ones, learned walls (walls NULL:
 * none), and how many echoes stand, each after a comma, as part of a summary line.
 */
void learned_report_print(const struct rho_tracker *tracker,
                          const struct rho_reflector_learning *walls, FILE *to);

/* Number of known echoes in the clutter map that stand. */
unsigned learned_report_num_standing(const struct rho_clutter_map *map);

/* Learned values of each sensor as a JSON list; the caller owns the list. */
struct cJSON;
struct cJSON *learned_report_sensors_json(const struct rho_tracker *tracker);

/*
 * Learned rates of tracks' lives, and each live track's probabilities of existence and visibility,
 * as a JSON object, with the names of life_t; the caller owns it.
 */
struct cJSON *learned_report_life_json(const struct rho_tracker *tracker);

/* Number of learned walls, and a JSON list of them; walls NULL: none are learned. */
unsigned learned_report_num_walls(const struct rho_reflector_learning *walls);
struct cJSON *learned_report_walls_json(const struct rho_reflector_learning *walls);

#endif
