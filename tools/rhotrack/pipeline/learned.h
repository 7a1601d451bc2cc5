/* SPDX-License-Identifier: MIT */
/* learned: what a tracker has learned of the sensors that were described to it, and uses. */
#ifndef RHOTRACK_TOOL_LEARNED_H
#define RHOTRACK_TOOL_LEARNED_H

#include <stdio.h>

#include "rhotrack/tracker.h"

/* Of sensors that are not as stated, each with a comma before it: part of a summary. */
void learned_print(const struct rho_tracker *tracker, FILE *to);

/* A list, the caller's. */
struct cJSON;
struct cJSON *learned_json(const struct rho_tracker *tracker);

#endif
