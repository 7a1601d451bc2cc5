/* SPDX-License-Identifier: MIT */
#include "catch_reader_fail.h"

#include <pcap/pcap.h>
#include <sanitizer/allocator_interface.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/common.h"
#include "check.h"

/* ---- memory that a run allocates ------------------------------------------------------------- */

#define KEPT_MAX 65536

static const volatile void *kept[KEPT_MAX];
static size_t num_kept;
static bool is_keeping;

static void on_malloc(const volatile void *memory, size_t size)
{
    (void)size;
    if (is_keeping && memory) {
        CHECK(num_kept < KEPT_MAX);
        kept[num_kept++] = memory;
    }
}

static void on_free(const volatile void *memory)
{
    for (size_t i = num_kept; is_keeping && i > 0; i--) {
        if (kept[i - 1] == memory) {
            kept[i - 1] = kept[--num_kept];
            /* cleared, so that the leak search does not count it as a pointer to the memory */
            kept[num_kept] = NULL;
            return;
        }
    }
}

static void free_allocations_of_run(void)
{
    is_keeping = false;
    while (num_kept > 0) {
        free((void *)(uintptr_t)kept[--num_kept]);
    }
}

/*
 * The lowest free file descriptor: files that a run leaves open have this number or a higher one.
 */
static int first_free_descriptor(void)
{
    int file = dup(STDERR_FILENO);

    CHECK(file >= 0 && close(file) == 0);
    return file;
}

/* ---- streams that a run holds open ----------------------------------------------------------- */

/*
 * Lists the open streams. The C library lists them, too: if the memory of an open stream is freed,
 * its list is broken, and the program may loop forever at exit.
 */
#define STREAMS_MAX 16

static FILE *streams[STREAMS_MAX];
static size_t num_streams;

static FILE *list_open_stream(FILE *stream)
{
    if (stream && is_keeping) {
        CHECK(num_streams < STREAMS_MAX);
        streams[num_streams++] = stream;
    }
    return stream;
}

FILE *__real_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode);
FILE *__wrap_fopen(const char *path, const char *mode)
{
    return list_open_stream(__real_fopen(path, mode));
}

FILE *__real_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size);
FILE *__wrap_open_memstream(char **text, size_t *size)
{
    return list_open_stream(__real_open_memstream(text, size));
}

int __real_fclose(FILE *stream);
int __wrap_fclose(FILE *stream);
int __wrap_fclose(FILE *stream)
{
    for (size_t i = 0; i < num_streams; i++) {
        if (streams[i] == stream) {
            streams[i] = streams[--num_streams];
            break;
        }
    }
    return __real_fclose(stream);
}

static void close_streams(void)
{
    while (num_streams > 0) {
        CHECK(__real_fclose(streams[--num_streams]) == 0);
    }
}

/* ---- network recordings, which open streams of their own ------------------------------------- */

static pcap_t *capture; /* the recording that a run has open, one at a time */

pcap_t *__real_pcap_open_offline(const char *path, char *reason);
pcap_t *__wrap_pcap_open_offline(const char *path, char *reason);
pcap_t *__wrap_pcap_open_offline(const char *path, char *reason)
{
    CHECK(!capture);
    capture = __real_pcap_open_offline(path, reason);
    return capture;
}

void __real_pcap_close(pcap_t *open);
void __wrap_pcap_close(pcap_t *open);
void __wrap_pcap_close(pcap_t *open)
{
    capture = NULL;
    __real_pcap_close(open);
}

static void close_capture(void)
{
    if (capture) {
        __wrap_pcap_close(capture);
    }
}

/* ---- the replaced fail() --------------------------------------------------------------------- */

static jmp_buf refused;

_Noreturn void __wrap_fail(int exit_code, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Replaces fail(): checks for exit code 2 and one line that names the file or the fault. */
_Noreturn void __wrap_fail(int exit_code, const char *format, ...)
{
    char message[8192];
    va_list arguments;

    va_start(arguments, format);
    CHECK(vsnprintf(message, sizeof message, format, arguments) > 0);
    va_end(arguments);
    CHECK(exit_code == EXIT_USAGE);
    /* closed before the jump, as the stream writes to variables of the function that opened it */
    close_streams();
    close_capture();
    longjmp(refused, 1);
}

/* ---- One run ---- */

void refusal_install_hooks(void)
{
    CHECK(__sanitizer_install_malloc_and_free_hooks(on_malloc, on_free) != 0);
}

static void forget_allocations_of_run(void)
{
    is_keeping = false;
    while (num_kept > 0) {
        kept[--num_kept] = NULL;
    }
}

bool refusal_is_refused(void (*read)(void *context), void *context)
{
    const int first_free = first_free_descriptor();

    is_keeping = true;
    if (setjmp(refused) == 0) {
        read(context);
        forget_allocations_of_run();
        CHECK(num_streams == 0 && !capture);
        return false;
    }
    free_allocations_of_run();
    CHECK(close_range((unsigned)first_free, (unsigned)first_free + 8, 0) == 0);
    return true;
}

char *refusal_write_file(const uint8_t *data, size_t size)
{
    static int file = -1;
    static char path[64];

    if (file < 0) {
        file = memfd_create("fuzz", 0);
        CHECK(file >= 0);
        snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    }
    CHECK(ftruncate(file, 0) == 0 && pwrite(file, data, size, 0) == (ssize_t)size);
    return path;
}
