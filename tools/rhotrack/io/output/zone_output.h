/* SPDX-License-Identifier: MIT */
/*
 * zone_output: writes the events of tracks that enter and leave zones as CSV, and
 * the zones' counts as text and JSON.
 */
#ifndef RHOTRACK_TOOL_ZONE_OUTPUT_H
#define RHOTRACK_TOOL_ZONE_OUTPUT_H

#include <cjson/cJSON.h>

#include "base/common.h"
#include "rhotrack/zones.h"

struct zone_events_output {
    struct output output;
};

/* Opens the events file; path NULL: no file. */
struct zone_events_output zone_events_output_open(const char *path);

/* Writes the events of the zones' last step. */
void zone_events_output_write(const struct zone_events_output *output,
                              const struct rho_zones *zones);
void zone_events_output_close(struct zone_events_output *output);

/* Prints the counts on standard error, one line a zone. */
void zones_print_counts(const struct rho_zones *zones);

/* The counts as a JSON array with one object a zone. */
cJSON *zones_counts_json(const struct rho_zones *zones);

#endif
