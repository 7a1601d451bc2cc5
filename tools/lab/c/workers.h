/* SPDX-License-Identifier: MIT */
/* workers: independent jobs on all cores. */
#ifndef RHOTRACK_TOOL_WORKERS_H
#define RHOTRACK_TOOL_WORKERS_H

#include <stddef.h>

#define WORKERS_MAX 64

/* Cores of this machine, at most WORKERS_MAX. */
size_t workers_count(void);

/*
 * Calls job(context, worker, index) for every index below num_jobs, in any order; worker <
 * workers_count() tells which thread calls, so that each can have memory of its own. Shows progress
 * in `what`.
 */
void workers_run(size_t num_jobs, const char *what,
                 void (*job)(void *context, size_t worker, size_t index), void *context);

#endif
