/* SPDX-License-Identifier: MIT */
#include "experiment_polar_page.h"
void polar_page(const struct polar_summary *summaries, const struct verdicts *verdicts,
                size_t num_runs, uint64_t seed, const char *folder)
{
    (void)summaries;
    (void)verdicts;
    (void)num_runs;
    (void)seed;
    (void)folder;
}
