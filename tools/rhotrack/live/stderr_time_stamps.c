/* SPDX-License-Identifier: MIT */
#include "live/stderr_time_stamps.h"

#include <ctype.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "base/common.h"

#define TIME_BYTES 32
/* longest piece that is formatted at once; longer lines come in several pieces */
#define LINE_BYTES 8192

static struct {
    const struct parameters *parameters;
    bool is_live, has_time, is_journal, is_lossy;
    bool is_within; /* the last piece written did not end its line */
    int64_t time_us;
} lines;

/* ---- Text ---- */

static int64_t system_time_us(void)
{
    struct timespec now;

    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}

/* Formats the time stamp of a line; "" for the journal, and while no time is known. */
static void format_time_stamp(char text[TIME_BYTES])
{
    const int64_t time_us = lines.is_live ? system_time_us() : lines.time_us;
    const int64_t within_us = (time_us % 1000000 + 1000000) % 1000000;
    const time_t seconds = (time_t)((time_us - within_us) / 1000000);
    struct tm date;
    size_t length;

    text[0] = '\0';
    if (!lines.is_journal && (lines.is_live || lines.has_time) && gmtime_r(&seconds, &date)) {
        length = strftime(text, TIME_BYTES, "%Y-%m-%dT%H:%M:%S", &date);
        snprintf(text + length, TIME_BYTES - length, ".%03dZ ", (int)(within_us / 1000));
    }
}

/*
 * Name of the sensor where the text continues with "sensor N", and *end behind N; NULL elsewhere.
 */
static const char *name_of_sensor_number_in_text(const char *text, const char *begin,
                                                 const char **end)
{
    static const char word[] = "sensor ";
    char *behind;
    long id;

    if ((text > begin && text[-1] != ' ') || strncmp(text, word, sizeof word - 1) != 0) {
        return NULL;
    }
    text += sizeof word - 1;
    if (!isdigit((unsigned char)*text) && !(*text == '-' && isdigit((unsigned char)text[1]))) {
        return NULL;
    }
    id = strtol(text, &behind, 10);
    *end = behind;
    return id == (int32_t)id && strchr(" ,:;'\n", *behind)
               ? parameters_sensor_name(lines.parameters, (int32_t)id)
               : NULL;
}

/* Writes a line, or a piece of one, with its time stamp and with names behind sensors' numbers. */
static void write_stamped_line(FILE *out, const char *text)
{
    char time[TIME_BYTES] = "";

    if (!lines.is_within) {
        format_time_stamp(time);
    }
    fputs(time, out);
    for (const char *at = text; *at;) {
        const char *end;
        const char *name = name_of_sensor_number_in_text(at, text, &end);

        if (name) {
            fprintf(out, "%.*s (%s)", (int)(end - at), at, name);
            at = end;
        } else {
            fputc(*at++, out);
        }
    }
}

/* ---- The stream ---- */

static void write_to_stderr_or_note_loss(const char *text, size_t bytes)
{
    lines.is_lossy |= write(STDERR_FILENO, text, bytes) != (ssize_t)bytes;
}

static ssize_t write_stamped_lines_to_stderr(void *cookie, const char *text, size_t size)
{
    (void)cookie;
    for (size_t at = 0, bytes; at < size; at += bytes) {
        const char *newline = memchr(text + at, '\n', size - at);
        char piece[LINE_BYTES], *whole = NULL;
        size_t length;
        FILE *out;

        bytes = newline ? (size_t)(newline - text) + 1 - at : size - at;
        bytes = bytes < LINE_BYTES ? bytes : LINE_BYTES - 1;
        memcpy(piece, text + at, bytes);
        piece[bytes] = '\0';
        out = open_memstream(&whole, &length);
        if (out) {
            write_stamped_line(out, piece);
            fclose(out);
            write_to_stderr_or_note_loss(whole, length);
            free(whole);
        } else {
            write_to_stderr_or_note_loss(piece, bytes);
        }
        lines.is_within = piece[bytes - 1] != '\n';
    }
    /* text that did not fit is lost; claiming success avoids a second attempt */
    return (ssize_t)size;
}

/*
 * Makes writes to standard error non-blocking by opening it anew: setting the flag on the shared
 * descriptor would affect other programs on the same pipe.
 */
static void make_stderr_nonblocking(const struct stat *status)
{
    const struct timeval little = {.tv_usec = 1000};

    if ((S_ISFIFO(status->st_mode) || S_ISCHR(status->st_mode))) {
        const int descriptor = open("/dev/fd/2", O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);

        if (descriptor >= 0) {
            dup2(descriptor, STDERR_FILENO);
            close(descriptor);
        }
    } else if (S_ISSOCK(status->st_mode)) { /* a service's socket cannot be opened anew */
        (void)setsockopt(STDERR_FILENO, SOL_SOCKET, SO_SNDTIMEO, &little, sizeof little);
    }
}

/* True where standard error is the systemd journal: JOURNAL_STREAM has its device and inode. */
static bool is_systemd_journal(const struct stat *status)
{
    const char *journal = getenv("JOURNAL_STREAM");
    char own[48];

    snprintf(own, sizeof own, "%ju:%ju", (uintmax_t)status->st_dev, (uintmax_t)status->st_ino);
    return journal && strcmp(journal, own) == 0;
}

void error_lines_stamp_stderr(const struct parameters *parameters, bool is_live)
{
    const cookie_io_functions_t functions = {.write = write_stamped_lines_to_stderr};
    struct stat status;
    FILE *stream = fopencookie(NULL, "w", functions);

    if (!stream) {
        fail(EXIT_RUNTIME, "out of memory");
    }
    setvbuf(stream, NULL, _IOLBF, LINE_BYTES);
    lines.parameters = parameters;
    lines.is_live = is_live;
    if (fstat(STDERR_FILENO, &status) == 0) {
        make_stderr_nonblocking(&status);
        lines.is_journal = is_systemd_journal(&status);
    }
    fflush(stderr);
    stderr = stream;
}

void error_lines_set_time(int64_t time_us)
{
    lines.time_us = time_us;
    lines.has_time = true;
}

void error_lines_write_directly(const char *text)
{
    char time[TIME_BYTES], line[LINE_BYTES];

    format_time_stamp(time);
    write_to_stderr_or_note_loss(line,
                                 (size_t)snprintf(line, sizeof line, "%s%.1000s", time, text));
}

bool error_lines_were_lost(void)
{
    return lines.is_lossy;
}
