/* SPDX-License-Identifier: MIT */
#include "workers.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

#include "base/common.h"

struct crew {
    void (*job)(void *context, size_t worker, size_t index);
    void *context;
    size_t num_jobs;
    atomic_size_t next, done;
};

struct worker {
    struct crew *crew;
    struct progress *progress; /* of the first worker only */
    size_t number;
    pthread_t thread;
};

size_t workers_count(void)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    return cores < 1 ? 1 : cores > WORKERS_MAX ? WORKERS_MAX : (size_t)cores;
}

static void *work(void *argument)
{
    struct worker *worker = argument;
    struct crew *crew = worker->crew;
    size_t index;
    while ((index = atomic_fetch_add(&crew->next, 1)) < crew->num_jobs) {
        crew->job(crew->context, worker->number, index);
        size_t done = atomic_fetch_add(&crew->done, 1) + 1;
        if (worker->progress != NULL) {
            progress_show(worker->progress, done);
        }
    }
    return NULL;
}

void workers_run(size_t num_jobs, const char *what,
                 void (*job)(void *context, size_t worker, size_t index), void *context)
{
    struct crew crew = {.job = job, .context = context, .num_jobs = num_jobs};
    struct progress progress = progress_start(what, num_jobs);
    struct worker workers[WORKERS_MAX];
    size_t count = workers_count();
    for (size_t i = 0; i < count; i++) {
        workers[i] =
            (struct worker){.crew = &crew, .number = i, .progress = i == 0 ? &progress : NULL};
    }
    for (size_t i = 1; i < count; i++) {
        if (pthread_create(&workers[i].thread, NULL, work, &workers[i]) != 0) {
            fail(EXIT_RUNTIME, "cannot start a thread");
        }
    }
    work(&workers[0]);
    for (size_t i = 1; i < count; i++) {
        pthread_join(workers[i].thread, NULL);
    }
    progress_end(&progress);
}
