/* SPDX-License-Identifier: MIT */
#include "live/node_log.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"
#include "io/log/lcm_log.h"

/* The queue is some 40 s of a radar with 1000 plots a second. */
enum { QUEUE_BYTES = 4 << 20, PIECE_BYTES = 64 << 10, OPEN_US = 500000, LOOK_US = 100000 };

struct node_log {
    const char *path;
    bool is_live, is_failure_said, is_full_said; /* the tracking's alone */
    pthread_t thread;
    pthread_mutex_t mutex;  /* for all below */
    pthread_cond_t changed; /* any of it */
    uint8_t *queue;         /* QUEUE_BYTES, round and round */
    /*
     * bytes since the start: put into the queue, written, and up to the end of the last event that
     * is written
     */
    uint64_t put, written, whole;
    uint64_t events_put, events_whole, events_left_out;
    bool is_open;  /* the file */
    bool is_ended; /* nothing is put any more */
    bool is_done;  /* the thread has ended */
    int error;     /* errno of what the disk refused; 0: nothing */
};

/* ---- The thread ---- */

static unsigned byte_at(const struct node_log *log, uint64_t at)
{
    return log->queue[at % QUEUE_BYTES];
}

static uint64_t number_at(const struct node_log *log, uint64_t at)
{
    uint64_t number = 0;

    for (unsigned i = 0; i < 4; i++) {
        number = number << 8 | byte_at(log, at + i);
    }
    return number;
}

/* Events that are written to their end make room. */
static void count_whole(struct node_log *log)
{
    while (log->written - log->whole >= LCM_LOG_HEADER_BYTES) {
        const uint64_t bytes = lcm_log_bytes(number_at(log, log->whole + LCM_LOG_CHANNEL_AT),
                                             number_at(log, log->whole + LCM_LOG_DATA_AT));

        if (log->written - log->whole < bytes) {
            return;
        }
        log->whole += bytes;
        log->events_whole++;
    }
}

/* Bytes from `written` on that lie in one piece, once there are some; 0: it is over. */
static size_t wait_for_piece(struct node_log *log)
{
    uint64_t bytes;

    while (log->written == log->put && !log->is_ended) {
        pthread_cond_wait(&log->changed, &log->mutex);
    }
    bytes = log->put - log->written;
    if (bytes > QUEUE_BYTES - log->written % QUEUE_BYTES) {
        bytes = QUEUE_BYTES - log->written % QUEUE_BYTES;
    }
    return (size_t)(bytes < PIECE_BYTES ? bytes : PIECE_BYTES);
}

static void write_pieces(struct node_log *log, int file)
{
    size_t bytes;

    while (!log->error && (bytes = wait_for_piece(log)) > 0) {
        const uint8_t *piece = log->queue + log->written % QUEUE_BYTES;
        ssize_t done;
        int reason;

        pthread_mutex_unlock(&log->mutex);
        done = write(file, piece, bytes);
        reason = errno;
        pthread_mutex_lock(&log->mutex);
        if (done >= 0) {
            log->written += (uint64_t)done;
            count_whole(log);
        } else if (reason != EINTR) {
            log->error = reason;
        }
        pthread_cond_broadcast(&log->changed);
    }
}

/*
 * Half an event at the end of a file goes; where it does not, readers skip it. Returns errno of
 * what the disk refused.
 */
static int end_file(int file, uint64_t written, uint64_t whole)
{
    struct stat status;

    if (written > whole && fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
        (void)!ftruncate(file, (off_t)whole);
    }
    return close(file) ? errno : 0;
}

static void *write_queue(void *object)
{
    struct node_log *log = object;
    const int file = open(log->path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    const int reason = errno;

    pthread_mutex_lock(&log->mutex);
    log->is_open = file >= 0;
    log->error = file >= 0 ? 0 : reason;
    pthread_cond_broadcast(&log->changed);
    if (log->is_open) {
        uint64_t written, whole;
        int refused;

        write_pieces(log, file);
        written = log->written;
        whole = log->whole;
        pthread_mutex_unlock(&log->mutex);
        refused = end_file(file, written, whole);
        pthread_mutex_lock(&log->mutex);
        log->error = log->error ? log->error : refused;
    }
    log->is_done = true;
    pthread_cond_broadcast(&log->changed);
    pthread_mutex_unlock(&log->mutex);
    return NULL;
}

/* ---- The tracking ---- */

static void wait_until(struct node_log *log, int64_t until_us)
{
    const struct timespec until = {until_us / 1000000, until_us % 1000000 * 1000};

    pthread_cond_timedwait(&log->changed, &log->mutex, &until);
}

struct node_log *node_log_open(const char *path, bool is_live)
{
    const int64_t until_us = clock_us() + OPEN_US;
    struct node_log *log;
    pthread_condattr_t attributes;

    if (!path) {
        return NULL;
    }
    log = must_calloc(1, sizeof *log);
    log->path = path;
    log->is_live = is_live;
    log->queue = must_calloc(QUEUE_BYTES, 1);
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&log->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&log->mutex, NULL);
    if (pthread_create(&log->thread, NULL, write_queue, log) != 0) {
        fail(EXIT_RUNTIME, "%s: no thread to write it", path);
    }
    pthread_mutex_lock(&log->mutex);
    while (!log->is_open && !log->error && clock_us() < until_us) {
        wait_until(log, until_us);
    }
    if (log->error) {
        fail(EXIT_RUNTIME, "%s: %s", path, strerror(log->error));
    }
    if (!log->is_open) {
        fprintf(stderr, "rhotrack: %s: does not open; tracks go on, the log begins when it does\n",
                path);
    }
    pthread_mutex_unlock(&log->mutex);
    return log;
}

static void put_bytes(struct node_log *log, const void *bytes, size_t size)
{
    const uint8_t *from = bytes;
    const size_t at = (size_t)(log->put % QUEUE_BYTES);
    const size_t first = size < QUEUE_BYTES - at ? size : QUEUE_BYTES - at;

    if (size > 0) {
        memcpy(log->queue + at, from, first);
        memcpy(log->queue, from + first, size - first);
        log->put += size;
    }
}

static bool has_room(const struct node_log *log, uint64_t bytes)
{
    return QUEUE_BYTES - (log->put - log->whole) >= bytes;
}

void node_log_put(struct node_log *log, int64_t time_us, const char *channel, const uint8_t *data,
                  size_t size)
{
    const size_t length = strlen(channel);
    const uint64_t bytes = lcm_log_bytes(length, size);
    uint8_t header[LCM_LOG_HEADER_BYTES];

    if (!log) {
        return;
    }
    pthread_mutex_lock(&log->mutex);
    while (!log->is_live && !log->error && bytes <= QUEUE_BYTES && !has_room(log, bytes) &&
           !is_told_to_end()) {
        wait_until(log, clock_us() + LOOK_US);
    }
    if (log->error || !has_room(log, bytes)) {
        log->events_left_out++;
    } else {
        lcm_log_header(header, (int64_t)log->events_put++, time_us, length, size);
        put_bytes(log, header, sizeof header);
        put_bytes(log, channel, length);
        put_bytes(log, data, size);
        pthread_cond_broadcast(&log->changed);
    }
    pthread_mutex_unlock(&log->mutex);
}

static uint64_t count_left_out(const struct node_log *log)
{
    return log->events_left_out +
           (log->error || log->is_ended ? log->events_put - log->events_whole : 0);
}

uint64_t node_log_left_out(struct node_log *log)
{
    uint64_t count;

    if (!log) {
        return 0;
    }
    pthread_mutex_lock(&log->mutex);
    count = count_left_out(log);
    pthread_mutex_unlock(&log->mutex);
    return count;
}

bool node_log_watch(struct node_log *log)
{
    int error;
    uint64_t left_out;

    if (!log) {
        return true;
    }
    pthread_mutex_lock(&log->mutex);
    error = log->error;
    left_out = count_left_out(log);
    pthread_mutex_unlock(&log->mutex);
    if (error && !log->is_failure_said) {
        log->is_failure_said = true;
        fprintf(stderr, "rhotrack: %s: %s; it goes on without the log\n", log->path,
                strerror(error));
    } else if (!error && left_out > 0 && !log->is_full_said) {
        log->is_full_said = true;
        fprintf(stderr, "rhotrack: %s: the disk takes no more; events are left out, tracks go on\n",
                log->path);
    }
    return !error;
}

void node_log_end(struct node_log *log, int64_t until_us)
{
    if (!log) {
        return;
    }
    pthread_mutex_lock(&log->mutex);
    log->is_ended = true;
    pthread_cond_broadcast(&log->changed);
    while (!log->is_done && clock_us() < until_us) {
        wait_until(log, until_us);
    }
    pthread_mutex_unlock(&log->mutex);
}

void node_log_close(struct node_log *log)
{
    bool is_done;

    if (!log) {
        return;
    }
    pthread_mutex_lock(&log->mutex);
    is_done = log->is_done;
    pthread_mutex_unlock(&log->mutex);
    if (is_done) {
        pthread_join(log->thread, NULL);
        pthread_cond_destroy(&log->changed);
        pthread_mutex_destroy(&log->mutex);
        free(log->queue);
        free(log);
    }
}
