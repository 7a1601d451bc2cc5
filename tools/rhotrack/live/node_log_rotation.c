/* SPDX-License-Identifier: MIT */
#include "live/node_log_rotation.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"

#define STAMP "-00000000T000000.000Z" /* pattern of a stamp; 0 stands for any digit */
#define STAMP_BYTES (sizeof STAMP - 1)
#define US_PER_MS 1000

bool node_log_has_rotation_limit(const struct node_log_limits *limits)
{
    return limits->bytes_max > 0 || limits->period_us > 0;
}

static int64_t period_number(int64_t time_us, int64_t period_us)
{
    return time_us / period_us - (time_us % period_us < 0);
}

bool node_log_limits_reached(const struct node_log_limits *limits, uint64_t file_bytes,
                             int64_t begin_us, uint64_t event_bytes, int64_t time_us)
{
    return file_bytes > 0 &&
           ((limits->bytes_max > 0 && file_bytes + event_bytes > limits->bytes_max) ||
            (limits->period_us > 0 && period_number(time_us, limits->period_us) !=
                                          period_number(begin_us, limits->period_us)));
}

/* ---- Names ---- */

/* Index in the path at which the time stamp is inserted: before the ending of the file's name. */
static size_t stamp_position(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');

    return dot && dot > name ? (size_t)(dot - path) : strlen(path);
}

/* The path with a time stamp before its ending, in new memory. */
static char *path_with_stamp(const char *path, int64_t time_us)
{
    const int64_t within_us = (time_us % 1000000 + 1000000) % 1000000;
    const time_t seconds = (time_t)((time_us - within_us) / 1000000);
    const size_t at = stamp_position(path), bytes = strlen(path) + 64;
    char *name = must_alloc(bytes), date[32] = "";
    struct tm parts;

    if (gmtime_r(&seconds, &parts)) {
        (void)!strftime(date, sizeof date, "%Y%m%dT%H%M%S", &parts);
    }
    snprintf(name, bytes, "%.*s-%s.%03dZ%s", (int)at, path, date, (int)(within_us / US_PER_MS),
             path + at);
    return name;
}

/* ---- Files that are too many ---- */

static bool begins_with_stamp(const char *text)
{
    for (size_t i = 0; i < STAMP_BYTES; i++) {
        if (STAMP[i] == '0' ? !isdigit((unsigned char)text[i]) : text[i] != STAMP[i]) {
            return false;
        }
    }
    return true;
}

/* True where `file` is the name of an earlier file of the log `name`: the name with a stamp. */
static bool is_earlier_log_file(const char *file, const char *name)
{
    const size_t at = stamp_position(name), length = strlen(name);

    return strlen(file) == length + STAMP_BYTES && strncmp(file, name, at) == 0 &&
           begins_with_stamp(file + at) && strcmp(file + at + STAMP_BYTES, name + at) == 0;
}

static int remove_oldest_files(const char *path, unsigned files_max)
{
    const char *slash = strrchr(path, '/');
    const size_t length = slash ? (size_t)(slash - path) + 1 : 0;
    char *folder = must_calloc(length + 2, 1);
    struct dirent **files;
    int count, refused = 0;
    unsigned earlier = 0;

    memcpy(folder, length ? path : "./", length ? length : 2);
    count = scandir(folder, &files, NULL, alphasort);
    refused = count < 0 ? errno : 0;
    for (int i = count - 1; i >= 0; i--) { /* names sort by time: newest first */
        if (is_earlier_log_file(files[i]->d_name, path + length) && ++earlier > files_max) {
            char *file = path_join(folder, files[i]->d_name);

            refused = unlink(file) ? errno : refused;
            free(file);
        }
        free(files[i]);
    }
    if (count >= 0) {
        free(files);
    }
    free(folder);
    return refused;
}

int node_log_files_rotate(const char *path, int64_t begin_us, unsigned files_max)
{
    struct stat status;
    char *name;
    int refused;

    if (stat(path, &status) || !S_ISREG(status.st_mode)) {
        return 0;
    }
    name = path_with_stamp(path, begin_us);
    while (lstat(name, &status) == 0) {
        free(name);
        begin_us += US_PER_MS;
        name = path_with_stamp(path, begin_us);
    }
    refused = rename(path, name) ? errno : 0;
    free(name);
    return refused == 0 && files_max > 0 ? remove_oldest_files(path, files_max) : refused;
}

int64_t node_log_files_file_span_us(const char *path)
{
    struct stat status;

    return stat(path, &status) == 0
               ? (int64_t)status.st_mtim.tv_sec * 1000000 + status.st_mtim.tv_nsec / 1000
               : 0;
}
