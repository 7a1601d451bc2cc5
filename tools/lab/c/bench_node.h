/* SPDX-License-Identifier: MIT */
/* bench_node: what the parts of `bench node` share. */
#ifndef RHOTRACK_TOOL_BENCH_NODE_H
#define RHOTRACK_TOOL_BENCH_NODE_H

#include "base/text_table.h"
#include "bench.h"
#include "verdicts.h"

/* Rows `message|bytes|encode ns|decode ns|validate ns` of full messages; json may be NULL. */
void bench_codec(cJSON *json, struct text_table *table, struct verdicts *verdicts);

#endif
