/* SPDX-License-Identifier: MIT */
#include "base/common.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "rhotrack/tracker.h"

/*
 * Temporary files of outputs that are not finished, which fail() and the signal handler remove.
 * Forked children do not remove their parent's.
 */
static char *volatile unfinished[OUTPUTS_MAX];
static volatile pid_t unfinished_owner;
static volatile sig_atomic_t progress_visible;

static void remove_unfinished_outputs(void)
{
    if (unfinished_owner != getpid()) {
        return;
    }
    for (int i = 0; i < OUTPUTS_MAX; i++) {
        if (unfinished[i]) {
            unlink(unfinished[i]);
        }
    }
}

static void clean_up_and_end_by_signal(int number)
{
    remove_unfinished_outputs();
    signal(number, SIG_DFL);
    raise(number);
}

bool is_signal_ignored(int number)
{
    struct sigaction action;

    return sigaction(number, NULL, &action) == 0 && action.sa_handler == SIG_IGN;
}

bool is_end_signal_pending(void)
{
    sigset_t pending;

    return sigpending(&pending) == 0 &&
           (sigismember(&pending, SIGTERM) == 1 || sigismember(&pending, SIGINT) == 1);
}

_Thread_local void (*fail_handler)(int exit_code, const char *message);

void mask_control_characters(char *text)
{
    for (; *text; text++) {
        if ((unsigned char)*text < ' ' || *text == 127) {
            *text = '?';
        }
    }
}

void fail(int exit_code, const char *format, ...)
{
    char message[8192];
    va_list arguments;

    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    mask_control_characters(message);
    if (fail_handler) {
        fail_handler(exit_code, message);
    }
    fprintf(stderr, "%srhotrack: %s\n", progress_visible ? "\r\033[K" : "", message);
    remove_unfinished_outputs();
    exit(exit_code);
}

static void *memory_or_fail(void *memory, size_t bytes)
{
    if (!memory) {
        fail(EXIT_RUNTIME, "out of memory: %zu more bytes cannot be allocated", bytes);
    }
    return memory;
}

void *must_alloc(size_t bytes)
{
    return memory_or_fail(malloc(bytes ? bytes : 1), bytes);
}

void *must_calloc(size_t count, size_t size)
{
    return memory_or_fail(calloc(count ? count : 1, size ? size : 1), count * size);
}

void *must_realloc(void *memory, size_t bytes)
{
    return memory_or_fail(realloc(memory, bytes ? bytes : 1), bytes);
}

void *must_make_room_for_one(void *array, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity) {
        return array;
    }
    *capacity = 2 * *capacity + 16;
    return must_realloc(array, *capacity * size);
}

char *must_copy_text(const char *text)
{
    size_t bytes = strlen(text) + 1;

    return memcpy(must_alloc(bytes), text, bytes);
}

static void remember_unfinished_output(char *path)
{
    if (!unfinished_owner) {
        signal(SIGINT, clean_up_and_end_by_signal);
        signal(SIGTERM, clean_up_and_end_by_signal);
        unfinished_owner = getpid();
    }
    for (int i = 0; i < OUTPUTS_MAX; i++) {
        if (!unfinished[i]) {
            unfinished[i] = path;
            return;
        }
    }
    unlink(path);
    fail(EXIT_RUNTIME, "more than %d output files are open", OUTPUTS_MAX);
}

static FILE *open_output_directly(const char *path)
{
    FILE *file = fopen(path, "w");

    if (!file) {
        fail(EXIT_RUNTIME, "%s: %s", path, strerror(errno));
    }
    return file;
}

/* Opens a temporary file beside output->path, with the permissions that the finished file gets. */
static void open_temporary_beside(struct output *output, mode_t mode)
{
    size_t bytes = strlen(output->path) + sizeof ".XXXXXX";
    int descriptor;

    output->temporary_path = must_alloc(bytes);
    snprintf(output->temporary_path, bytes, "%s.XXXXXX", output->path);
    descriptor = mkstemp(output->temporary_path);
    if (descriptor < 0) {
        fail(EXIT_RUNTIME, "%s: %s", output->path, strerror(errno));
    }
    remember_unfinished_output(output->temporary_path);
    output->file = fchmod(descriptor, mode) ? NULL : fdopen(descriptor, "w");
    if (!output->file) {
        fail(EXIT_RUNTIME, "%s: %s", output->path, strerror(errno));
    }
}

static mode_t new_file_mode(void)
{
    mode_t mask = umask(0);

    umask(mask);
    return 0666 & ~mask;
}

/* Whether the path is a link, such as /dev/stdout, to standard output's own file. */
static bool is_link_to_standard_output(const char *path)
{
    struct stat link, file, own;

    return lstat(path, &link) == 0 && S_ISLNK(link.st_mode) && stat(path, &file) == 0 &&
           fstat(STDOUT_FILENO, &own) == 0 && own.st_dev == file.st_dev &&
           own.st_ino == file.st_ino;
}

struct output output_open(const char *path)
{
    struct output output = {stdout, NULL, NULL};
    struct stat status;
    char *real_path;

    if (!path || !strcmp(path, "-") || is_link_to_standard_output(path)) {
        return output;
    }
    if (stat(path, &status)) {
        output.path = must_copy_text(path);
        open_temporary_beside(&output, new_file_mode());
        return output;
    }
    if (S_ISDIR(status.st_mode)) {
        fail(EXIT_RUNTIME, "%s: %s", path, strerror(EISDIR));
    }
    /*
     * a symbolic link is kept: the file that it points to is replaced; a file without a name, such
     * as /dev/fd/3 to a deleted one, is written itself
     */
    real_path = realpath(path, NULL);
    output.path = must_copy_text(real_path ? real_path : path);
    if (S_ISREG(status.st_mode) && real_path) {
        open_temporary_beside(&output, status.st_mode & 07777);
    } else {
        output.file = open_output_directly(path);
    }
    free(real_path);
    return output;
}

struct output output_open_in_place(const char *path)
{
    struct output output = {stdout, NULL, NULL};

    if (path && strcmp(path, "-") != 0 && !is_link_to_standard_output(path)) {
        output.path = must_copy_text(path);
        output.file = open_output_directly(path);
    }
    return output;
}

static const char *output_name(const struct output *output)
{
    return output->path ? output->path : "standard output";
}

void output_flush(struct output *output)
{
    if (fflush(output->file)) {
        fail(EXIT_RUNTIME, "%s: cannot be written: %s", output_name(output), strerror(errno));
    }
}

void output_close(struct output *output)
{
    const char *name = output_name(output);
    int is_bad = ferror(output->file);

    if (output->file == stdout) {
        is_bad |= fflush(stdout);
    } else {
        is_bad |= fclose(output->file);
    }
    if (is_bad) {
        fail(EXIT_RUNTIME, "%s: cannot be written: %s", name, strerror(errno));
    }
    if (output->temporary_path) {
        if (rename(output->temporary_path, output->path)) {
            fail(EXIT_RUNTIME, "%s: %s", name, strerror(errno));
        }
        for (int i = 0; i < OUTPUTS_MAX; i++) {
            if (unfinished[i] == output->temporary_path) {
                unfinished[i] = NULL;
            }
        }
    }
    free(output->temporary_path);
    free(output->path);
    *output = (struct output){NULL, NULL, NULL};
}

void make_folder_with_parents(const char *path)
{
    char *partial = must_copy_text(path);
    struct stat status;

    for (char *c = partial + 1; *partial; c++) {
        char end = *c;

        if (end != '/' && end != '\0') {
            continue;
        }
        *c = '\0';
        if (mkdir(partial, 0777) && errno != EEXIST) {
            fail(EXIT_RUNTIME, "%s: %s", partial, strerror(errno));
        }
        *c = end;
        if (!end) {
            break;
        }
    }
    if (stat(path, &status) || !S_ISDIR(status.st_mode)) {
        fail(EXIT_RUNTIME, "%s: %s", path, strerror(*path ? ENOTDIR : ENOENT));
    }
    free(partial);
}

uint64_t regular_file_size_or_zero(const char *path)
{
    struct stat status;

    return stat(path, &status) == 0 && S_ISREG(status.st_mode) ? (uint64_t)status.st_size : 0;
}

bool is_same_file(const char *path, const char *other)
{
    struct stat one, two;

    return stat(path, &one) == 0 && stat(other, &two) == 0 && S_ISREG(one.st_mode) &&
           one.st_dev == two.st_dev && one.st_ino == two.st_ino;
}

bool text_begins_with(const char *text, const char *prefix)
{
    return strncmp(text, prefix, strlen(prefix)) == 0;
}

bool path_ends_with(const char *path, const char *suffix)
{
    size_t length = strlen(path), end = strlen(suffix);

    return length >= end && strcasecmp(path + length - end, suffix) == 0;
}

void output_refuse_other_format(const char *path, const char *known)
{
    static const char *const others[] = {
        ".mcap", ".kml",  ".kmz",     ".gpx", ".json", ".xml", ".pcap", ".pcapng", ".bag", ".db3",
        ".mat",  ".xlsx", ".parquet", ".h5",  ".npz",  ".shp", ".gpkg", ".zip",    ".gz"};

    for (size_t i = 0; path && i < sizeof others / sizeof *others; i++) {
        if (path_ends_with(path, others[i])) {
            fail(EXIT_USAGE, "%s: %s is no format that is written here; there are %s", path,
                 others[i], known);
        }
    }
}

uint64_t hash_bytes(const void *data, size_t size)
{
    const unsigned char *bytes = data;
    uint64_t hash = 14695981039346656037u;

    for (size_t i = 0; i < size; i++) {
        hash = (hash ^ bytes[i]) * 1099511628211u;
    }
    return hash;
}

char *path_join(const char *folder, const char *name)
{
    size_t length = strlen(folder), bytes = length + strlen(name) + 2;
    char *path = must_alloc(bytes);
    const char *slash = length && folder[length - 1] == '/' ? "" : "/";

    snprintf(path, bytes, "%s%s%s", folder, slash, name);
    return path;
}

const char *shortest_float_text(float value, char text[FLOAT_TEXT_BYTES])
{
    if (value == 0.0f) {
        value = 0.0f; /* -0 becomes 0 */
    }
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, FLOAT_TEXT_BYTES, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) {
            break;
        }
    }
    return text;
}

const char *decimal_seconds_text(int64_t time_us, char text[TIME_TEXT_BYTES])
{
    uint64_t magnitude = time_us < 0 ? 0 - (uint64_t)time_us : (uint64_t)time_us;

    snprintf(text, TIME_TEXT_BYTES, "%s%" PRIu64 ".%06" PRIu64, time_us < 0 ? "-" : "",
             magnitude / 1000000, magnitude % 1000000);
    return text;
}

static int compare_descending(const void *a, const void *b)
{
    return *(const int *)b - *(const int *)a;
}

struct cJSON *sort_descending_into_json_list(int *values, int count)
{
    cJSON *list;

    qsort(values, (size_t)count, sizeof *values, compare_descending);
    list = cJSON_CreateIntArray(values, count);
    if (!list) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    return list;
}

void json_add_number_or_null(struct cJSON *object, const char *name, double value)
{
    cJSON_AddItemToObject(object, name,
                          isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
}

void json_add_work(struct cJSON *object, const struct rho_tracker_work *work)
{
    cJSON_AddNumberToObject(object, "work", work->work);
    cJSON_AddNumberToObject(object, "work_worst", work->work_worst);
    cJSON_AddNumberToObject(object, "partial_steps", work->partial_steps);
    cJSON_AddNumberToObject(object, "plots_not_tried", work->plots_not_tried);
}

void json_print_and_delete(struct cJSON *object)
{
    struct output output = output_open(NULL);
    char *text = cJSON_Print(object);

    if (!text) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    fprintf(output.file, "%s\n", text);
    output_close(&output);
    cJSON_free(text);
    cJSON_Delete(object);
}

void print_if_only_last_taken(uint64_t taken, uint64_t total, const char *what)
{
    if (total > taken) {
        fprintf(stderr, "rhotrack: the last %" PRIu64 " of %" PRIu64 " %s are used\n", taken, total,
                what);
    }
}

void print_rows_skipped(uint64_t rows)
{
    if (rows > 0) {
        fprintf(stderr, "rhotrack: %" PRIu64 " bad rows skipped\n", rows);
    }
}

void print_count_unless_zero(const char *path, uint64_t count, const char *what)
{
    if (count > 0) {
        fprintf(stderr, "rhotrack: %s: %" PRIu64 " %s\n", path, count, what);
    }
}

int64_t monotonic_clock_us(void)
{
    struct timespec now;

    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

struct progress progress_start(const char *what, uint64_t total)
{
    struct progress progress = {what, monotonic_clock_us(), 0, total};

    if (!isatty(STDERR_FILENO)) {
        progress.shown_us = INT64_MAX; /* not a terminal: progress is never due */
    }
    return progress;
}

static void print_bar(double fraction)
{
    enum { WIDTH = 20 };
    int filled = (int)(fraction * WIDTH);

    fputc('[', stderr);
    for (int i = 0; i < WIDTH; i++) {
        fputc(i < filled ? '#' : '.', stderr);
    }
    fprintf(stderr, "] %3.0f %%  ", 100 * fraction);
}

static void print_time_left(double seconds)
{
    if (seconds < 120) {
        fprintf(stderr, ", %.0f s left", seconds);
    } else if (seconds < 7200) {
        fprintf(stderr, ", %.0f min left", seconds / 60);
    } else {
        fprintf(stderr, ", %.1f h left", seconds / 3600);
    }
}

/* True at most once per PERIOD_US, after QUIET_US of work; then notes the time as shown. */
static bool note_progress_time_if_due(struct progress *progress)
{
    enum { QUIET_US = 2000000, PERIOD_US = 200000 };
    int64_t now_us;

    if (progress->shown_us == INT64_MAX) {
        return false;
    }
    now_us = monotonic_clock_us();
    if (now_us - progress->start_us < QUIET_US || now_us - progress->shown_us < PERIOD_US) {
        return false;
    }
    progress->shown_us = now_us;
    return true;
}

/* Prints the progress line; fraction: share of the work that is done, 0 where it is not known. */
static void print_progress(const struct progress *progress, uint64_t done, double fraction)
{
    double seconds = (double)(progress->shown_us - progress->start_us) * 1e-6;
    double rate = (double)done / seconds;

    progress_visible = 1;
    fputs("\r\033[K", stderr);
    if (fraction > 0) {
        print_bar(fraction);
    }
    fprintf(stderr, "%" PRIu64, done);
    if (progress->total >= done && progress->total > 0) {
        fprintf(stderr, " of %" PRIu64, progress->total);
    }
    fprintf(stderr, " %s, %.*f a second", progress->what, rate < 10 ? 1 : 0, rate);
    if (fraction > 0) {
        print_time_left(seconds * (1 - fraction) / fraction);
    }
}

static double fraction_done_or_0_if_unknown(uint64_t done, uint64_t total)
{
    return total > 0 && done <= total ? (double)done / (double)total : 0;
}

void progress_show(struct progress *progress, uint64_t done)
{
    if (note_progress_time_if_due(progress)) {
        print_progress(progress, done, fraction_done_or_0_if_unknown(done, progress->total));
    }
}

void progress_show_by_bytes(struct progress *progress, uint64_t done, uint64_t bytes,
                            uint64_t total_bytes)
{
    if (note_progress_time_if_due(progress)) {
        print_progress(progress, done, fraction_done_or_0_if_unknown(bytes, total_bytes));
    }
}

void progress_end(struct progress *progress)
{
    if (progress_visible) {
        fputs("\r\033[K", stderr);
    }
    progress_visible = 0;
    progress->shown_us = INT64_MAX;
}

void must_succeed(enum rho_status status, const char *what)
{
    if (status != RHO_OK) {
        fail(EXIT_RUNTIME, "%s: the library says '%s'", what, rho_status_name(status));
    }
}

int compare_doubles(const void *a, const void *b)
{
    const double one = *(const double *)a, other = *(const double *)b;

    return (one > other) - (one < other);
}
