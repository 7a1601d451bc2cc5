/* SPDX-License-Identifier: MIT */
/*
 * experiment_initiation_page: the tables and pictures of the track-initiation experiment as a page.
 */
#ifndef RHOTRACK_TOOL_EXPERIMENT_INITIATION_PAGE_H
#define RHOTRACK_TOOL_EXPERIMENT_INITIATION_PAGE_H

#include "base/grid.h"
#include "experiment_classic.h"
#include "experiment_initiation.h"

struct initiation_score {
    int held, missed;
};

/* All cases, num_runs each: initiation_num_cases() summaries in new memory. */
struct initiation_summary *initiation_summaries(uint64_t seed, size_t num_runs);

struct grid initiation_grid(const struct initiation_summary *summaries, size_t count);
struct grid initiation_work_grid(const struct initiation_summary *summaries);

/* The work figures against their bars. Returns 3. */
size_t initiation_work(const struct initiation_summary *summaries,
                       struct initiation_verdict verdicts[3]);

/* Bars over all cases and the work figures. */
struct initiation_score initiation_score(const struct initiation_summary *summaries);

/*
 * FOLDER/index.html and its pictures: the paper's experiments, then the bars; either may be NULL.
 */
void initiation_page(const struct initiation_summary *summaries, const struct classic_report *paper,
                     size_t num_runs, uint64_t seed, const char *folder);

#endif
