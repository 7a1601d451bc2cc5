/* SPDX-License-Identifier: MIT */
/*
 * common: what all commands share: how they end, memory, output files, progress.
 *
 * Exit codes: 0 success, 1 a run-time failure, 2 bad usage or bad input.
 */
#ifndef RHOTRACK_TOOL_COMMON_H
#define RHOTRACK_TOOL_COMMON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "rhotrack/types.h"

#define EXIT_RUNTIME 1
#define EXIT_USAGE 2

/*
 * Prints `rhotrack: ` and the message as one line on standard error (control characters as ?),
 * removes unfinished outputs, and exits.
 */
_Noreturn void fail(int exit_code, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Called by fail() instead, with the message, where a thread has set it; it does not return. */
extern _Thread_local void (*fail_handler)(int exit_code, const char *message);

/* malloc, calloc, realloc that end the program with exit 1 when memory is out. */
void *must_alloc(size_t bytes);
void *must_calloc(size_t count, size_t size);
void *must_realloc(void *memory, size_t bytes);

/* The array with room for one element more than count. */
void *must_grow(void *array, size_t count, size_t *capacity, size_t size);

/* The text in new memory. */
char *must_copy_text(const char *text);

/*
 * Output file that appears under its name only when it is complete: written beside, then renamed.
 * path NULL or "-": standard output. A device or pipe is written directly. Unfinished ones are
 * removed by fail() and on SIGINT and SIGTERM; OUTPUTS_MAX can be open at a time.
 */
#define OUTPUTS_MAX 64
struct output {
    FILE *file;
    char *path, *temporary_path;
};
struct output output_open(const char *path);
void output_close(struct output *output); /* checks for write errors, renames */

/*
 * The same, but the file is there from the start, what is flushed can be read at once, and stays
 * whatever happens.
 */
struct output output_open_in_place(const char *path);
void output_flush(struct output *output); /* checks for write errors */

/* Whether the signal is ignored, as nohup has it; it should stay so. */
bool is_signal_ignored(int number);

/* Whether SIGTERM or SIGINT has come where they are blocked. */
bool is_end_signal_pending(void);

/* mkdir -p. Exit 1 with the reason. */
void make_folder(const char *path);

/* Writes a JSON object (cJSON) to standard output with a newline, and deletes it. */
struct cJSON;
void json_print(struct cJSON *object);

/*
 * A new object that begins with an experiment's name, how many runs it took, and where they
 * started.
 */
struct cJSON *json_begin_experiment(const char *name, size_t num_runs, uint64_t seed);

/* Adds a number, or null where it is not finite. */
void json_add_number(struct cJSON *object, const char *name, double value);

/* work, work_worst, partial_steps, plots_not_tried. */
struct rho_tracker_work;
void json_add_work(struct cJSON *object, const struct rho_tracker_work *work);

/* Sorts the values, the largest first, and makes a list of them. */
struct cJSON *json_list_descending(int *values, int count);

/* A float32 in the fewest digits that read back as the same float32; "0" for -0. */
#define FLOAT_TEXT_BYTES 24
const char *float_text(float value, char text[FLOAT_TEXT_BYTES]);

bool text_begins_with(const char *text, const char *prefix);

/* A name that ends so, in capitals or not: "NAME.lcm" and "NAME.LCM" with ".lcm". */
bool path_ends_with(const char *path, const char *suffix);

/* Length of a plain file; 0 of anything else. */
uint64_t plain_file_size(const char *path);

/* Two names of one plain file. */
bool is_same_file(const char *path, const char *other);

/* "folder/name" in new memory. */
char *path_join(const char *folder, const char *name);

/*
 * On standard error: that only the last so many are taken, that bad rows were skipped; nothing
 * where all are.
 */
void say_only_last_taken(uint64_t taken, uint64_t total, const char *what);
void say_rows_skipped(uint64_t rows);

/* Monotonic clock, microseconds. */
int64_t clock_us(void);

/*
 * Progress on standard error: only on a terminal, only after two seconds. `what` names the work
 * ("scans", "runs").
 */
struct progress {
    const char *what;
    int64_t start_us, shown_us;
    uint64_t total; /* 0: unknown */
};
struct progress progress_start(const char *what, uint64_t total);
void progress_show(struct progress *progress, uint64_t done);

/*
 * The same where the total is not known, but how many bytes of the input were read, of how many; 0:
 * that neither.
 */
void progress_show_bytes(struct progress *progress, uint64_t done, uint64_t bytes,
                         uint64_t total_bytes);
void progress_end(struct progress *progress);

/* Exit 1 naming what the library refused, and why. */
void must_succeed(enum rho_status status, const char *what);

#endif
