/* SPDX-License-Identifier: MIT */
/*
 * catch_reader_fail: runs readers of the program that may refuse their file. Such a reader calls
 * fail(), which ends the program. Here it jumps out of the reader (linked with --wrap=fail), its
 * open files are closed (streams by --wrap=fopen and the like), and the hooks of the sanitizer's
 * allocator free what it had allocated. So leaks of runs that do not fail are still found.
 */
#ifndef RHOTRACK_TESTS_FUZZ_CATCH_READER_FAIL_H
#define RHOTRACK_TESTS_FUZZ_CATCH_READER_FAIL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Called once before the first reader, after everything that the process keeps was allocated. */
void refusal_install_hooks(void);

/* Calls a reader. True if it refused its file with exit code 2 and one line. */
bool refusal_is_refused(void (*read)(void *context), void *context);

/* Writes these bytes to a file, which the next call overwrites. Returns its path. */
char *refusal_write_file(const uint8_t *data, size_t size);

#endif
