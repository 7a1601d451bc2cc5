/* SPDX-License-Identifier: MIT */
/*
 * common: shared by all commands: errors and exit, memory, output files, JSON, progress.
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

/*
 * Thread's own handler of errors: fail() calls it with the message in place of exiting; it must not
 * return.
 */
extern _Thread_local void (*fail_handler)(int exit_code, const char *message);

/* Replaces control characters by ?, so that the text is one line wherever it is written. */
void mask_control_characters(char *text);

/* malloc, calloc, realloc that end the program with exit 1 when memory is out. */
void *must_alloc(size_t bytes);
void *must_calloc(size_t count, size_t size);
void *must_realloc(void *memory, size_t bytes);

/* Returns the array, reallocated if needed, with room for one element more than `count`. */
void *must_make_room_for_one(void *array, size_t count, size_t *capacity, size_t size);

/* Copy of a text in new memory. */
char *must_copy_text(const char *text);

/*
 * Output file that appears under its name only when it is complete: a temporary file beside it is
 * renamed at the end. path NULL, "-", or a link to its file, as /dev/stdout is: standard output.
 * Devices, pipes and files without a name, as /dev/fd/3 may be, are written directly. A link to
 * another file is kept.
 * fail(), SIGINT and SIGTERM remove unfinished temporary files; OUTPUTS_MAX can be open at a time.
 */
#define OUTPUTS_MAX 64
struct output {
    FILE *file;
    char *path, *temporary_path;
};
struct output output_open(const char *path);
/* checks for write errors, and gives the finished file its name */
void output_close(struct output *output);

/*
 * Opens an output file under its own name from the start: readers see what is flushed, and the file
 * stays even if the program fails.
 */
struct output output_open_in_place(const char *path);
void output_flush(struct output *output); /* flushes the file; exit 1 on a write error */

/* True where the signal is ignored, as under nohup; a handler should then not be installed. */
bool is_signal_ignored(int number);

/* True where a blocked SIGTERM or SIGINT is pending. */
bool is_end_signal_pending(void);

/* Creates a folder and its missing parents; exit 1 with the reason on failure. */
void make_folder_with_parents(const char *path);

/* Prints a JSON object (cJSON) to standard output with a newline, and deletes the object. */
struct cJSON;
void json_print_and_delete(struct cJSON *object);

/* Adds a number to a JSON object, or null where the number is not finite. */
void json_add_number_or_null(struct cJSON *object, const char *name, double value);

/* Adds a tracker's counts of work: work, work_worst, partial_steps, plots_not_tried. */
struct rho_tracker_work;
void json_add_work(struct cJSON *object, const struct rho_tracker_work *work);

/* Sorts the values in descending order, in place, and returns them as a JSON list. */
struct cJSON *sort_descending_into_json_list(int *values, int count);

/* Writes a float with the fewest digits that read back as the same float; "0" for -0. */
#define FLOAT_TEXT_BYTES 24
const char *shortest_float_text(float value, char text[FLOAT_TEXT_BYTES]);

/* Writes a time in seconds with six decimals. */
#define TIME_TEXT_BYTES 24
const char *decimal_seconds_text(int64_t time_us, char text[TIME_TEXT_BYTES]);

bool text_begins_with(const char *text, const char *prefix);

/* True where a path ends with a suffix, ignoring case: "NAME.LCM" ends with ".lcm". */
bool path_ends_with(const char *path, const char *suffix);

/*
 * Exit 2 where an output's name ends as files of another format do, as NAME.kml: it would hold
 * something else.
 *   known  the formats that there are, for the message
 */
void output_refuse_other_format(const char *path, const char *known);

/* FNV-1a of so many bytes. */
uint64_t hash_bytes(const void *data, size_t size);

/* Size of a regular file in bytes; 0 for anything else. */
uint64_t regular_file_size_or_zero(const char *path);

/* True where both paths name the same regular file. */
bool is_same_file(const char *path, const char *other);

/* "folder/name" in new memory. */
char *path_join(const char *folder, const char *name);

/*
 * Notes on standard error: that only the last `taken` of `total` things are used, and how many bad
 * rows were skipped; print nothing where nothing was left out.
 */
void print_if_only_last_taken(uint64_t taken, uint64_t total, const char *what);
void print_rows_skipped(uint64_t rows);

/* Prints `rhotrack: PATH: COUNT WHAT` on standard error, and nothing where the count is 0. */
void print_count_unless_zero(const char *path, uint64_t count, const char *what);

/* Monotonic clock, in microseconds. */
int64_t monotonic_clock_us(void);

/*
 * Progress line on standard error, only on a terminal and only for work of more than two seconds.
 * `what` names the units of work ("scans", "runs").
 */
struct progress {
    const char *what;
    int64_t start_us, shown_us;
    uint64_t total; /* units of work; 0: unknown */
};
struct progress progress_start(const char *what, uint64_t total);
void progress_show(struct progress *progress, uint64_t done);

/*
 * Shows progress of work whose total is unknown, by the share of the input that was read: `bytes`
 * of `total_bytes`, 0 where that is unknown, too.
 */
void progress_show_by_bytes(struct progress *progress, uint64_t done, uint64_t bytes,
                            uint64_t total_bytes);
void progress_end(struct progress *progress);

/* Order of two doubles, for qsort. */
int compare_doubles(const void *a, const void *b);

/* Exit 1 with `what` and the status where a call of the library failed. */
void must_succeed(enum rho_status status, const char *what);

#endif
