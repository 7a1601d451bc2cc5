/* SPDX-License-Identifier: MIT */
/* zones_output: who enters and leaves zones, as CSV; what they have counted, in words and JSON. */
#ifndef RHOTRACK_TOOL_ZONES_OUTPUT_H
#define RHOTRACK_TOOL_ZONES_OUTPUT_H

#include <cjson/cJSON.h>

#include "base/common.h"
#include "rhotrack/zones.h"

struct zones_output {
    struct output output;
};

/* path NULL: no file. */
struct zones_output zones_output_open(const char *path);

/* The events of the zones' last step. */
void zones_output_write_events(const struct zones_output *output, const struct rho_zones *zones);
void zones_output_close(struct zones_output *output);

/* A line a zone on standard error. */
void zones_print_counts(const struct rho_zones *zones);

/* An array with an object a zone. */
cJSON *zones_counts_json(const struct rho_zones *zones);

#endif
