/* SPDX-License-Identifier: MIT */
/* bench_codec: the bench of the codec, a part of `bench node`. */
#ifndef RHOTRACK_TOOL_BENCH_CODEC_H
#define RHOTRACK_TOOL_BENCH_CODEC_H

#include "base/text_table.h"
#include "bench.h"
#include "lab_limits.h"

/*
 * Adds a row `message|bytes|encode ns|decode ns|validate ns` for each full message to the table,
 * its bars to the verdicts and, unless json is NULL, its times to json.
 */
void bench_codec(cJSON *json, struct text_table *table, struct verdicts *verdicts);

#endif
