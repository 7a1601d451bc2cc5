/* SPDX-License-Identifier: MIT */
#include "live/node_log_writer.h"

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

/*
 * QUEUE_BYTES hold some 40 s of a radar with 1000 plots a second; PIECE_BYTES go to the disk at a
 * time; OPEN_US: longest wait for the file to open; LOOK_US: interval of checks for a signal to
 * end.
 */
enum { QUEUE_BYTES = 4 << 20, PIECE_BYTES = 64 << 10, OPEN_US = 500000, LOOK_US = 100000 };
enum { AGAIN_US = 60000000 }; /* interval of attempts to write to a disk that refused events */

#define NO_CUT UINT64_MAX

struct node_log {
    const char *path;
    struct node_log_limits limits;
    /* used by the tracking thread alone */
    bool is_live, is_full_said;
    int error_said; /* errno that was printed; 0: none, or its end was printed */
    /* events_whole at the last reopening; a larger count shows that the disk takes events again */
    uint64_t whole_then;
    int refusal_said; /* value of `refusal` that was printed */
    int64_t again_us; /* monotonic time of the next attempt to write */
    int64_t begin_us; /* time of the first event of the file that events are now queued for */
    /*
     * byte 0 of the file that events are now queued for, as an offset in the stream of all queued
     * bytes; wraps below 0 where the file had contents (also set by the writer thread)
     */
    uint64_t begin;
    pthread_t thread;
    pthread_mutex_t mutex;  /* protects all fields below */
    pthread_cond_t changed; /* signalled when a field below changes */
    uint8_t *queue;         /* ring buffer of QUEUE_BYTES */
    /*
     * stream offsets: end of the queued bytes, end of the written bytes, and end of the last event
     * that is completely written
     */
    uint64_t put, written, whole;
    uint64_t events_put, events_whole, events_left_out;
    /*
     * stream offset, between two events, at which the writer thread closes the file and opens the
     * next one; NO_CUT: none
     */
    uint64_t cut;
    bool is_put_away;     /* at the cut the file is renamed by its time (log rotation) */
    int64_t cut_begin_us; /* time of the first event of the file that ends at the cut */
    bool is_open;         /* the writer thread has a file open */
    /* the open file was unlinked by another program, so what is written to it is lost */
    bool is_removed;
    bool is_ended; /* no more events will be queued */
    bool is_done;  /* the writer thread has ended */
    int error;     /* errno of the last write or open that failed; 0: none */
    int refusal;   /* errno of a rename or removal of earlier files that failed; 0: none */
};

/* ---- The thread ---- */

static unsigned queue_byte_at(const struct node_log *log, uint64_t at)
{
    return log->queue[at % QUEUE_BYTES];
}

static uint64_t queue_u32_at(const struct node_log *log, uint64_t at)
{
    uint64_t number = 0;

    for (unsigned i = 0; i < 4; i++) {
        number = number << 8 | queue_byte_at(log, at + i);
    }
    return number;
}

/* Frees the queue space of events that are written to their end. */
static void free_written_events(struct node_log *log)
{
    while (log->written - log->whole >= LCM_LOG_HEADER_BYTES) {
        const uint64_t bytes =
            lcm_log_event_bytes(queue_u32_at(log, log->whole + LCM_LOG_CHANNEL_AT),
                                queue_u32_at(log, log->whole + LCM_LOG_DATA_AT));

        if (log->written - log->whole < bytes) {
            return;
        }
        log->whole += bytes;
        log->events_whole++;
    }
}

/*
 * Size of the next write: contiguous in the ring buffer, within one file, and PIECE_BYTES at most.
 */
static size_t next_piece_bytes(const struct node_log *log)
{
    const uint64_t end = log->cut < log->put ? log->cut : log->put;
    uint64_t bytes = end - log->written;

    if (bytes > QUEUE_BYTES - log->written % QUEUE_BYTES) {
        bytes = QUEUE_BYTES - log->written % QUEUE_BYTES;
    }
    return (size_t)(bytes < PIECE_BYTES ? bytes : PIECE_BYTES);
}

/* Counts all queued events as left out and empties the queue, as no file can take them. */
static void drop_queue(struct node_log *log, int reason)
{
    log->error = reason;
    log->events_left_out += log->events_put - log->events_whole;
    log->events_whole = log->events_put;
    log->written = log->whole = log->put;
}

/* The log file that is open for writing; used by the writer thread alone. */
struct file {
    int descriptor;
    /* stream offset of the file's byte 0; wraps below 0 where the file had contents before */
    uint64_t begin;
};

static void write_piece(struct node_log *log, const struct file *file, size_t bytes)
{
    const uint8_t *piece = log->queue + log->written % QUEUE_BYTES;
    struct stat status;
    bool is_removed;
    ssize_t done;
    int reason;

    pthread_mutex_unlock(&log->mutex);
    done = write(file->descriptor, piece, bytes);
    reason = errno;
    is_removed =
        fstat(file->descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_nlink == 0;
    pthread_mutex_lock(&log->mutex);
    log->is_removed = is_removed;
    if (done >= 0) {
        log->written += (uint64_t)done;
        free_written_events(log);
    } else if (reason != EINTR) {
        log->error = reason;
    }
    pthread_cond_broadcast(&log->changed);
}

/*
 * Closes the file, and first truncates an incomplete event at its end; in a pipe it stays, and
 * readers skip it.
 */
static void close_file_without_torn_event(struct node_log *log, struct file *file)
{
    const bool is_torn = log->written > log->whole;
    const off_t length = (off_t)(log->whole - file->begin);
    struct stat status;
    int refused = 0;

    pthread_mutex_unlock(&log->mutex);
    if (file->descriptor >= 0) {
        if (is_torn && fstat(file->descriptor, &status) == 0 && S_ISREG(status.st_mode)) {
            (void)!ftruncate(file->descriptor, length);
        }
        refused = close(file->descriptor) ? errno : 0;
    }
    pthread_mutex_lock(&log->mutex);
    file->descriptor = -1;
    log->error = log->error ? log->error : refused;
    if (log->error) {
        drop_queue(log, log->error);
    }
}

/* Opens the log's file with O_TRUNC or O_APPEND in flags; drops the queue where that fails. */
static void open_file(struct node_log *log, struct file *file, int flags)
{
    struct stat status;
    uint64_t bytes = 0;
    int reason;

    pthread_mutex_unlock(&log->mutex);
    file->descriptor = open(log->path, O_WRONLY | O_CREAT | O_CLOEXEC | flags, 0666);
    reason = errno;
    if (file->descriptor >= 0 && fstat(file->descriptor, &status) == 0 && S_ISREG(status.st_mode)) {
        bytes = (uint64_t)status.st_size;
    }
    pthread_mutex_lock(&log->mutex);
    log->is_open = file->descriptor >= 0;
    log->is_removed = false;
    log->error = 0;
    if (!log->is_open) {
        drop_queue(log, reason);
    }
    file->begin = log->written - bytes;
    if (!log->refusal) {
        /*
         * old contents count for the size limit, unless rotation fails: it would be retried at each
         * event
         */
        log->begin -= bytes;
    }
    pthread_cond_broadcast(&log->changed);
}

static void stamp_file_and_remove_oldest(struct node_log *log, int64_t begin_us)
{
    int refused;

    pthread_mutex_unlock(&log->mutex);
    refused = node_log_files_rotate(log->path, begin_us, log->limits.files_max);
    pthread_mutex_lock(&log->mutex);
    log->refusal = refused;
}

/* Closes the file at the cut, renames it if it is rotated, and opens the next one. */
static void switch_to_next_file(struct node_log *log, struct file *file)
{
    close_file_without_torn_event(log, file);
    if (log->is_put_away) {
        stamp_file_and_remove_oldest(log, log->cut_begin_us);
    }
    log->cut = NO_CUT;
    open_file(log, file, O_APPEND);
}

static void *run_writer_thread(void *object)
{
    struct node_log *log = object;
    struct file file;

    pthread_mutex_lock(&log->mutex);
    if (node_log_has_rotation_limit(&log->limits)) { /* keeps the log of an earlier run */
        stamp_file_and_remove_oldest(log, node_log_files_file_span_us(log->path));
    }
    open_file(log, &file, log->refusal ? O_APPEND : O_TRUNC);
    while (!log->is_ended || log->written < log->put) {
        const size_t bytes = file.descriptor >= 0 ? next_piece_bytes(log) : 0;

        if (log->cut <= log->written) {
            switch_to_next_file(log, &file);
        } else if (bytes > 0) {
            write_piece(log, &file, bytes);
        } else {
            pthread_cond_wait(&log->changed, &log->mutex);
        }
        if (log->error && file.descriptor >= 0) {
            close_file_without_torn_event(log, &file);
        }
    }
    close_file_without_torn_event(log, &file);
    log->is_done = true;
    pthread_cond_broadcast(&log->changed);
    pthread_mutex_unlock(&log->mutex);
    return NULL;
}

/* ---- The tracking ---- */

static void wait_for_change_until(struct node_log *log, int64_t until_us)
{
    const struct timespec until = {until_us / 1000000, until_us % 1000000 * 1000};

    pthread_cond_timedwait(&log->changed, &log->mutex, &until);
}

/*
 * Whether the error is the disk's, which may pass, and not one of the command line, which a user
 * is there to read.
 */
static bool is_fault_of_disk(int error)
{
    return error == ENOSPC || error == EDQUOT || error == EROFS || error == EIO;
}

struct node_log *node_log_open(const char *path, bool is_live, const struct node_log_limits *limits)
{
    const int64_t until_us = monotonic_clock_us() + OPEN_US;
    struct node_log *log;
    pthread_condattr_t attributes;

    if (!path) {
        return NULL;
    }
    log = must_calloc(1, sizeof *log);
    log->path = path;
    log->is_live = is_live;
    log->limits = *limits;
    log->cut = NO_CUT;
    log->queue = must_calloc(QUEUE_BYTES, 1);
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_cond_init(&log->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    pthread_mutex_init(&log->mutex, NULL);
    if (pthread_create(&log->thread, NULL, run_writer_thread, log) != 0) {
        fail(EXIT_RUNTIME, "%s: the thread that writes it cannot be started", path);
    }
    pthread_mutex_lock(&log->mutex);
    while (!log->is_open && !log->error && monotonic_clock_us() < until_us) {
        wait_for_change_until(log, until_us);
    }
    if (log->error && !(is_live && is_fault_of_disk(log->error))) {
        fail(EXIT_RUNTIME, "%s: %s", path, strerror(log->error));
    }
    if (!log->is_open && !log->error) {
        fprintf(stderr,
                "rhotrack: %s: cannot be opened yet; tracking goes on, and the log begins once it "
                "can\n",
                path);
    }
    pthread_mutex_unlock(&log->mutex);
    return log;
}

static void queue_bytes(struct node_log *log, const void *bytes, size_t size)
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

static bool queue_has_room(const struct node_log *log, uint64_t bytes)
{
    return QUEUE_BYTES - (log->put - log->whole) >= bytes;
}

/* Ends the file behind the event that was queued last, unless a cut is already pending. */
static void set_file_cut(struct node_log *log, bool is_put_away)
{
    if (log->cut == NO_CUT) {
        log->cut = log->put;
        log->is_put_away = is_put_away;
        log->cut_begin_us = log->begin_us;
        log->begin = log->put;
        pthread_cond_broadcast(&log->changed);
    }
}

static void end_file_if_limits_reached(struct node_log *log, uint64_t bytes, int64_t time_us)
{
    if (node_log_limits_reached(&log->limits, log->put - log->begin, log->begin_us, bytes,
                                time_us)) {
        set_file_cut(log, true);
    }
    if (log->put == log->begin) {
        log->begin_us = time_us;
    }
}

void node_log_put_event(struct node_log *log, int64_t time_us, const char *channel,
                        const uint8_t *data, size_t size)
{
    const size_t length = strlen(channel);
    const uint64_t bytes = lcm_log_event_bytes(length, size);
    uint8_t header[LCM_LOG_HEADER_BYTES];

    if (!log) {
        return;
    }
    pthread_mutex_lock(&log->mutex);
    while (!log->is_live && !log->error && bytes <= QUEUE_BYTES && !queue_has_room(log, bytes) &&
           !is_end_signal_pending()) {
        wait_for_change_until(log, monotonic_clock_us() + LOOK_US);
    }
    if (log->error || !queue_has_room(log, bytes)) {
        log->events_left_out++;
    } else {
        end_file_if_limits_reached(log, bytes, time_us);
        lcm_log_put_header(header, (int64_t)log->events_put++, time_us, length, size);
        queue_bytes(log, header, sizeof header);
        queue_bytes(log, channel, length);
        queue_bytes(log, data, size);
        pthread_cond_broadcast(&log->changed);
    }
    pthread_mutex_unlock(&log->mutex);
}

static uint64_t count_events_left_out(const struct node_log *log)
{
    return log->events_left_out + (log->is_ended ? log->events_put - log->events_whole : 0);
}

uint64_t node_log_events_left_out(struct node_log *log)
{
    uint64_t count;

    if (!log) {
        return 0;
    }
    pthread_mutex_lock(&log->mutex);
    count = count_events_left_out(log);
    pthread_mutex_unlock(&log->mutex);
    return count;
}

void node_log_reopen(struct node_log *log)
{
    if (!log) {
        return;
    }
    pthread_mutex_lock(&log->mutex);
    log->whole_then = log->events_whole;
    set_file_cut(log, false);
    pthread_mutex_unlock(&log->mutex);
}

/* Prints an error of the disk once, and its end once the disk has taken an event again. */
static void print_disk_error_change(struct node_log *log, int error, uint64_t whole)
{
    if (error && error != log->error_said) {
        log->error_said = error;
        log->is_full_said = true;
        fprintf(stderr,
                "rhotrack: %s: %s; tracking goes on without the log; the next attempt is in %d s\n",
                log->path, strerror(error), AGAIN_US / 1000000);
    } else if (!error && log->error_said && whole > log->whole_then) {
        log->error_said = 0;
        fprintf(stderr, "rhotrack: %s: the log goes on\n", log->path);
    }
}

static void print_rotation_error(struct node_log *log, int refusal)
{
    if (refusal && refusal != log->refusal_said) {
        fprintf(stderr,
                "rhotrack: %s: cannot be renamed, or an earlier file cannot be removed: %s\n",
                log->path, strerror(refusal));
    }
    log->refusal_said = refusal;
}

static void print_log_leaves_out(struct node_log *log)
{
    if (!log->is_full_said) {
        log->is_full_said = true;
        fprintf(
            stderr,
            "rhotrack: %s: the disk is too slow or full; events are left out, tracking goes on\n",
            log->path);
    }
}

static void reopen_if_removed_or_due(struct node_log *log, bool is_removed, int error)
{
    const int64_t now_us = monotonic_clock_us();

    if (is_removed) {
        fprintf(stderr, "rhotrack: %s: was removed; the log begins anew\n", log->path);
        node_log_reopen(log);
    } else if (error && now_us >= log->again_us) {
        node_log_reopen(log);
        log->again_us = now_us + AGAIN_US;
    } else if (!error) {
        log->again_us = now_us + AGAIN_US;
    }
}

bool node_log_report_and_retry(struct node_log *log)
{
    int error, refusal;
    uint64_t left_out, whole;
    bool is_removed;

    if (!log) {
        return true;
    }
    pthread_mutex_lock(&log->mutex);
    error = log->error;
    refusal = log->refusal;
    left_out = count_events_left_out(log);
    whole = log->events_whole;
    is_removed = log->is_removed && log->cut == NO_CUT;
    pthread_mutex_unlock(&log->mutex);
    print_disk_error_change(log, error, whole);
    print_rotation_error(log, refusal);
    if (!error && left_out > 0) {
        print_log_leaves_out(log);
    }
    reopen_if_removed_or_due(log, is_removed, error);
    return !error;
}

void node_log_finish_queue(struct node_log *log, int64_t until_us)
{
    if (!log) {
        return;
    }
    pthread_mutex_lock(&log->mutex);
    log->is_ended = true;
    pthread_cond_broadcast(&log->changed);
    while (!log->is_done && monotonic_clock_us() < until_us) {
        wait_for_change_until(log, until_us);
    }
    pthread_mutex_unlock(&log->mutex);
}

void node_log_free_if_written(struct node_log *log)
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
