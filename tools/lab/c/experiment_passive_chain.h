/* SPDX-License-Identifier: MIT */
/*
 * experiment_passive_chain: bearings through the tracker: targets found, followed, and false
 * tracks, beside an extended Kalman filter in double precision that knows which bearings are the
 * target's.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_PASSIVE_CHAIN_H
#define RHOTRACK_TOOL_EXPERIMENT_PASSIVE_CHAIN_H

#include <cjson/cJSON.h>
#include <stddef.h>
#include <stdint.h>

#include "base/grid.h"
#include "verdicts.h"

#define PASSIVE_CHAIN_RUNS 200 /* of a case, unless asked otherwise */

struct passive_chain_case {
    const char *name;
    size_t sensors, targets, frames;
    double pd, false_mean;         /* bearings a look */
    double tracked_min, false_max; /* bars; NAN: none */
};

/* Means over the runs; NAN where there is nothing to take one of. */
struct passive_chain_summary {
    double tracked;      /* share of the targets, at the last frame */
    double confirmed_at; /* frame, counted from 1; of the targets that were found at all */
    double false_tracks; /* a run: confirmed, and near a target in less than half of their frames */
    double rms_m,
        filter_rms_m; /* over the frames of tracks near their targets: theirs, and the filter's */
    double frame_us;
};

extern const struct passive_chain_case passive_chain_cases[];
extern const size_t passive_num_chain_cases;

/* num_runs of every case on all cores: passive_num_chain_cases summaries in new memory. */
struct passive_chain_summary *passive_chain_make(uint64_t seed, size_t num_runs);

void passive_chain_judge(const struct passive_chain_summary *summaries, struct verdicts *verdicts);
struct grid passive_chain_grid(const struct passive_chain_summary *summaries);
cJSON *passive_chain_json(const struct passive_chain_summary *summaries);

#endif
